#include "processes/node/check/check_log_sizes.h"

#include <algorithm>

#include "common/util/image_header.h"
#include "processes/node/message/channels.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxSizes = 10;  // limit: a hostile log may have a new size in each message

std::string OfAll(std::int64_t count, std::int64_t all) {
  return "; so " + std::to_string(count) + " of " + std::to_string(all) + " messages";
}

}  // namespace

void LogSizes::Add(const std::string& channel, const image_t& message) {
  Take(channel, message,
       message.encoding == image_t::ENCODING_JPEG || message.encoding == image_t::ENCODING_PNG);
}

void LogSizes::Add(const std::string& channel, const person_mask_t& message) {
  if (message.encoding == person_mask_t::ENCODING_NONE) return;
  Take(channel, message, message.encoding == person_mask_t::ENCODING_PNG);
}

template <class Message>
void LogSizes::Take(const std::string& name, const Message& message, bool is_file) {
  Channel& channel = channels_[name];
  ++channel.num;
  const auto count = [&](Group* group) {
    if (group->num++ == 0) group->first_seq = message.seq;
  };
  const Size said{message.width, message.height};
  Size size = said;
  if (is_file) {
    const auto header = ReadImageHeader(message.data.data(), message.data.size());
    if (!header) return count(&channel.unreadable);
    size = {header->width, header->height};
  }
  if (!(size == said)) {
    if (channel.contradicted.num == 0) {
      channel.said = said;
      channel.of_file = size;
    }
    count(&channel.contradicted);
  }
  if (channel.sizes.size() < kMaxSizes || channel.sizes.count(size) > 0)
    count(&channel.sizes[size]);
}

void LogSizes::Report(const std::string& path, const std::optional<StereoCamera>& camera,
                      FindingList* findings) const {
  for (const auto& [name, channel] : channels_) {
    const std::string where = path + ": " + name + " ";
    const std::string kind = name == channel::kPersonMask ? "masks.file" : "images.file";
    if (channel.unreadable.num > 0) {
      findings->Fail(kind, where + std::to_string(channel.unreadable.first_seq),
                     "does not begin as a JPEG or PNG file, or claims too many pixels" +
                         OfAll(channel.unreadable.num, channel.num));
    }
    if (channel.contradicted.num > 0) {
      const bool is_exchanged = channel.said == channel.of_file.Exchanged();
      findings->Fail(kind, where + std::to_string(channel.contradicted.first_seq),
                     "the message says " + channel.said.Text() + ", the file in it has " +
                         channel.of_file.Text() +
                         (is_exchanged ? ": width and height are exchanged" : "") +
                         OfAll(channel.contradicted.num, channel.num));
    }
    ReportSizes(path, name, channel, camera, findings);
  }
}

void LogSizes::ReportSizes(const std::string& path, const std::string& name, const Channel& channel,
                           const std::optional<StereoCamera>& camera, FindingList* findings) const {
  if (channel.sizes.empty()) return;
  // The expected size: that of the calibration, otherwise that of the first image.
  const auto oldest = std::min_element(
      channel.sizes.begin(), channel.sizes.end(),
      [](const auto& a, const auto& b) { return a.second.first_seq < b.second.first_seq; });
  const Size wanted = camera ? Size{camera->width, camera->height} : oldest->first;
  const std::string of_wanted = camera ? "CALIBRATION is for " : "the first one is of ";
  const std::string kind = name == channel::kPersonMask ? "masks.size" : "images.size";
  for (const auto& [size, group] : channel.sizes) {
    if (size == wanted) continue;
    std::string text = "is of " + size.Text() + ", " + of_wanted + wanted.Text();
    if (size == wanted.Exchanged()) {
      text += ": width and height are exchanged";
    } else if (camera && size.width * wanted.height == size.height * wanted.width) {
      text += ": another resolution; publish the calibration of the images as they are";
    }
    findings->Fail(kind, path + ": " + name + " " + std::to_string(group.first_seq),
                   text + OfAll(group.num, channel.num));
  }
}

}  // namespace airdos
