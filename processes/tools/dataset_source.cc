#include "processes/tools/dataset_source.h"

#include <algorithm>

#include "common/util/error.h"

namespace airdos {

DatasetSource::DatasetSource(const std::string& folder, std::int64_t first_seq,
                             std::int64_t last_seq)
    : sequence_(OpenStereoSequence(folder)), player_(sequence_.get(), kSession, {}) {
  const auto newest = static_cast<std::int64_t>(sequence_->num_frames()) - 1;
  const std::int64_t first = std::max<std::int64_t>(0, first_seq);
  const std::int64_t last = std::min(last_seq, newest);
  if (first > last) {
    throw InputError(folder + ": has no frame between --first and --last, only 0 to " +
                     std::to_string(newest));
  }
  first_ = static_cast<std::size_t>(first);
  end_ = static_cast<std::size_t>(last) + 1;
  next_ = first_;
}

std::vector<Envelope> DatasetSource::NextFrame() {
  if (next_ == end_) return {};
  std::vector<Envelope> messages = player_.Load(next_++).messages;
  for (const std::string& note : player_.TakeNotes()) notes_ += (notes_.empty() ? "" : "; ") + note;
  return messages;
}

double DatasetSource::fraction_done() const {
  return static_cast<double>(next_ - first_) / static_cast<double>(end_ - first_);
}

}  // namespace airdos
