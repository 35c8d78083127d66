#include "common/dataset/keypoints/keypoint_collector.h"

#include <algorithm>
#include <cmath>

#include "common/dataset/keypoint_file.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

std::string CountsOf(const std::vector<ForeignLayout>& layouts) {
  std::string text;
  for (const ForeignLayout layout : layouts) {
    text += (text.empty() ? "" : ", ") + std::to_string(3 * NumJoints(layout)) + " (" +
            NameOf(layout) + ")";
  }
  return text;
}

template <class Act>
void ForEachSeen(std::vector<ForeignImage>* images, const Act& act) {
  for (ForeignImage& image : *images) {
    for (PersonKeypoints& person : image.people) {
      for (Keypoint& joint : person) {
        if (joint.confidence > 0) act(&joint);
      }
    }
  }
}

}  // namespace

KeypointCollector::KeypointCollector(const std::string& path, const std::string& program,
                                     const std::vector<ForeignLayout>& possible)
    : possible_(possible) {
  result_.path = path;
  result_.program = program;
}

ForeignImage* KeypointCollector::ImageOf(const std::string& name) {
  const auto [place, is_new] = place_of_.emplace(name, result_.images.size());
  if (is_new) result_.images.push_back({name, {}});
  return &result_.images[place->second];
}

void KeypointCollector::AddImage(const std::string& name) { ImageOf(name); }

void KeypointCollector::AddPerson(const std::string& image, const std::string& where,
                                  const std::vector<float>& numbers) {
  ForeignImage* const found = ImageOf(image);
  if (numbers.empty()) {
    ++num_empty_;
    return;
  }
  const std::optional<ForeignLayout> layout = LayoutOfCount(numbers.size(), possible_);
  if (!layout) {
    throw InputError(where + ": holds " + std::to_string(numbers.size()) + " numbers a person" +
                     ExplainKeypointCount(numbers.size()) + "; read are " + CountsOf(possible_) +
                     ", u v confidence of each joint");
  }
  if (result_.layout && result_.layout != layout) {
    throw InputError(where + ": holds a person in " + NameOf(*layout) + ", those before are in " +
                     NameOf(*result_.layout) + "; all must have the same layout");
  }
  result_.layout = layout;
  if (*layout == ForeignLayout::kBody25) {
    undecided_.push_back(numbers);
    images_of_undecided_.push_back(place_of_.at(image));
    return;
  }
  Keep(ToCoco18(*layout, numbers), found);
}

void KeypointCollector::DecideBody25() {
  if (AreInBody25B(undecided_)) result_.layout = ForeignLayout::kBody25B;
  for (std::size_t i = 0; i < undecided_.size(); ++i) {
    Keep(ToCoco18(*result_.layout, undecided_[i]), &result_.images[images_of_undecided_[i]]);
  }
  undecided_.clear();
}

void KeypointCollector::Keep(PersonKeypoints person, ForeignImage* image) {
  const bool is_seen = std::any_of(person.begin(), person.end(),
                                   [](const Keypoint& joint) { return joint.confidence > 0; });
  if (is_seen) {
    image->people.push_back(std::move(person));
  } else {
    ++num_empty_;
  }
}

void KeypointCollector::RefuseNormalized() const {
  constexpr float kLargest = 2;   // of what is relative to the image's size, -1..1 or 0..1
  constexpr int kFewJoints = 10;  // could be in a corner
  int num_seen = 0;
  for (const ForeignImage& image : result_.images) {
    for (const PersonKeypoints& person : image.people) {
      for (const Keypoint& joint : person) {
        if (joint.confidence <= 0) continue;
        ++num_seen;
        if (std::abs(joint.u_px) > kLargest || std::abs(joint.v_px) > kLargest) return;
      }
    }
  }
  if (num_seen < kFewJoints) return;
  throw InputError(result_.path +
                   ": its coordinates lie within 2 px of 0: they are relative to the image's size, "
                   "wanted are px (OpenPose: --keypoint_scale 0)");
}

void KeypointCollector::LimitConfidences() {
  std::size_t num_seen = 0;
  std::size_t num_above = 0;
  float highest = 0;
  ForEachSeen(&result_.images, [&](const Keypoint* joint) {
    ++num_seen;
    num_above += joint->confidence > 1 ? 1 : 0;
    highest = std::max(highest, joint->confidence);
  });
  if (num_above == 0) return;
  const bool is_other_scale = 2 * num_above > num_seen;
  const float divisor = is_other_scale ? highest : 1;
  ForEachSeen(&result_.images, [&](Keypoint* joint) {
    joint->confidence = std::min(1.F, joint->confidence / divisor);
  });
  const std::string what = result_.path + ": " + std::to_string(num_above) + " of " +
                           std::to_string(num_seen) + " joints have a confidence above 1, up to " +
                           Format("%.3g", static_cast<double>(highest));
  result_.notes.push_back(what + (is_other_scale ? ": all are divided by that" : ": taken as 1"));
}

ForeignKeypoints KeypointCollector::Finish() {
  DecideBody25();
  RefuseNormalized();
  LimitConfidences();
  if (num_empty_ > 0) {
    result_.notes.push_back(result_.path + ": " + std::to_string(num_empty_) +
                            (num_empty_ == 1 ? " person has" : " people have") +
                            " no joint that is seen: left out");
  }
  return std::move(result_);
}

}  // namespace airdos
