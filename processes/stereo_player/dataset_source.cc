#include "processes/stereo_player/dataset_source.h"

#include <algorithm>
#include <utility>

#include "common/util/error.h"

namespace airdos {

DatasetSource::DatasetSource(const std::string& folder, std::int64_t first, std::int64_t last,
                             std::int64_t session, const ImagePackerOptions& options,
                             const std::string& calibration)
    : DatasetSource(OpenStereoSequence(folder, {calibration}), folder, first, last, session,
                    options) {}

DatasetSource::DatasetSource(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                             std::int64_t first, std::int64_t last, std::int64_t session,
                             const ImagePackerOptions& options)
    : sequence_(std::move(sequence)),
      player_(sequence_.get(), session, options),
      assumed_(sequence_->notes()) {
  const auto newest = static_cast<std::int64_t>(sequence_->num_frames()) - 1;
  const std::int64_t from = std::max<std::int64_t>(0, first);
  const std::int64_t to = std::min(last, newest);
  if (from > to) {
    throw InputError(name + ": has frames 0 to " + std::to_string(newest) +
                     ", so there is none from --first to --last");
  }
  first_ = static_cast<std::size_t>(from);
  end_ = static_cast<std::size_t>(to) + 1;
  next_ = first_;
}

std::vector<Envelope> DatasetSource::NextFrame() {
  while (next_ != end_) {
    std::vector<Envelope> messages = player_.Load(next_++).messages;
    if (!messages.empty()) return messages;
  }
  return {};
}

std::vector<std::string> DatasetSource::TakeNotes() {
  std::vector<std::string> notes = std::exchange(assumed_, {});
  for (std::string& note : player_.TakeNotes()) notes.push_back(std::move(note));
  return notes;
}

double DatasetSource::fraction_done() const {
  return static_cast<double>(next_ - first_) / static_cast<double>(end_ - first_);
}

}  // namespace airdos
