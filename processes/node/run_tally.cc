#include "processes/node/run_tally.h"

#include <cmath>

#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"

namespace airdos {
namespace {

bool HasPose(const state_estimate_t& estimate) {
  if (estimate.status == state_estimate_t::STATUS_INVALID) return false;
  double sum = 0;
  for (const double value : estimate.position_W_C) sum += value;
  for (const double value : estimate.orientation_W_C) sum += value;
  return std::isfinite(sum);
}

}  // namespace

void RunTally::Take(const std::string& channel, const void* data, std::size_t size) {
  if (channel == channel::kStaticFeatures) {
    static_features_t features = {};
    if (Decode(data, size, &features)) Take(features);
  } else if (channel == channel::kStateEstimate) {
    state_estimate_t estimate = {};
    if (Decode(data, size, &estimate)) Take(estimate);
  }
}

void RunTally::Take(const static_features_t& features) {
  if (features.num_features == 0) return;
  counts_.num_static_features += features.num_features;
  with_features_.insert({features.session, features.seq});
  if (with_features_.size() > kMaxOpenFrames) with_features_.erase(with_features_.begin());
}

void RunTally::Take(const state_estimate_t& estimate) {
  // The optimizer counts no observations in its first frame, since it has no map yet.
  const bool has_features = with_features_.erase({estimate.session, estimate.seq}) > 0;
  const bool has_people = estimate.trusted == state_estimate_t::TRUSTED_WITH_PEOPLE;
  Add(!HasPose(estimate)                                     ? Source::kNone
      : has_features || estimate.num_static_observations > 0 ? Source::kImages
      : has_people                                           ? Source::kPeople
                                                             : Source::kPrediction);
}

void RunTally::Add(Source source) {
  ++counts_.num_frames;
  counts_.num_from_images += source == Source::kImages ? 1 : 0;
  counts_.num_from_people += source == Source::kPeople ? 1 : 0;
  counts_.num_predicted += source == Source::kPrediction ? 1 : 0;
  counts_.num_without_pose += source == Source::kNone ? 1 : 0;
}

RunTally::Counts RunTally::Count() const { return counts_; }

std::string ToText(const RunTally::Counts& counts) {
  std::string text = "from images " + std::to_string(counts.num_from_images) + ", from people " +
                     std::to_string(counts.num_from_people) + ", predicted only " +
                     std::to_string(counts.num_predicted);
  if (counts.num_without_pose > 0) {
    text += ", without a pose " + std::to_string(counts.num_without_pose);
  }
  return text;
}

std::string WhyInVain(const RunTally::Counts& counts) {
  if (counts.num_frames == 0) return "";
  if (counts.num_without_pose == counts.num_frames) {
    return "none of " + std::to_string(counts.num_frames) +
           " frames has a pose: airdos-check says what is wrong with the input";
  }
  if (counts.num_static_features == 0 && counts.num_from_images == 0) {
    return "no static landmark was seen in " + std::to_string(counts.num_frames) +
           " frames, so the poses are meaningless: airdos-check says what is wrong with the input";
  }
  return "";
}

}  // namespace airdos
