#include "common/check/check_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kMinConfidence = 0.2;
constexpr int kMinJoints = 6;           // visible, for a person's shape to be informative
constexpr std::size_t kMinPairs = 10;   // fewer are not significant
constexpr std::size_t kMinPeople = 15;  // per camera, to compare sizes

bool IsSeen(const BodyKeypoint& joint) { return joint.confidence > kMinConfidence; }

/// RMS distance (px) of the visible joints from their mean; nothing if there are too few.
std::optional<double> SizeOf(const BodyKeypoints& person) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0;
  int num = 0;
  for (const BodyKeypoint& joint : person) {
    if (!IsSeen(joint)) continue;
    sum += joint.uv_px();
    squares += joint.uv_px().squaredNorm();
    ++num;
  }
  if (num < kMinJoints) return std::nullopt;
  return std::sqrt(std::max(1.0, squares / num - (sum / num).squaredNorm()));
}

/// A pair of detections as views of the same person.
struct Pairing {
  double cost = std::numeric_limits<double>::infinity();  // relative to their size
  double disparity_px = 0;
  double row_step_px = 0;
};

Pairing Compare(const BodyKeypoints& left, const BodyKeypoints& right, double size_px) {
  std::vector<double> du_px;
  std::vector<double> dv_px;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!IsSeen(left[i]) || !IsSeen(right[i])) continue;
    du_px.push_back(left[i].uv_px().x() - right[i].uv_px().x());
    dv_px.push_back(right[i].uv_px().y() - left[i].uv_px().y());
  }
  Pairing pairing;
  if (du_px.size() < kMinJoints) return pairing;
  pairing.disparity_px = Quantile(du_px, 0.5);
  pairing.row_step_px = Quantile(dv_px, 0.5);
  double deviation_px = 0;
  for (std::size_t i = 0; i < du_px.size(); ++i) {
    deviation_px += std::min(
        0.5 * size_px, std::hypot(du_px[i] - pairing.disparity_px, dv_px[i] - pairing.row_step_px));
  }
  // A common row offset must not outweigh the shape: it is what we are looking for.
  const double shape = deviation_px / static_cast<double>(du_px.size()) / size_px;
  pairing.cost = shape + 0.2 * std::min(2.0, std::abs(pairing.row_step_px) / size_px);
  return pairing;
}

std::vector<BodyKeypoints> BodiesOf(const CheckedPeople& people) {
  std::vector<BodyKeypoints> bodies;
  for (const std::vector<BodyKeypoint>& person : people.people) {
    const std::optional<BodyKeypoints> body = MapToBody(people.layout, person);
    if (body && SizeOf(*body)) bodies.push_back(*body);
  }
  return bodies;
}

/// Index of the lowest cost if it is clearly lower than the second lowest; otherwise nothing.
std::optional<std::size_t> ClearlyBest(const std::vector<double>& costs) {
  constexpr double kMaxCost = 0.25;
  constexpr double kMaxRatio = 0.7;
  const auto best = std::min_element(costs.begin(), costs.end());
  if (best == costs.end() || *best > kMaxCost) return std::nullopt;
  for (auto it = costs.begin(); it != costs.end(); ++it) {
    if (it != best && *best > kMaxRatio * *it) return std::nullopt;
  }
  return static_cast<std::size_t>(std::distance(costs.begin(), best));
}

bool AreEqual(const CheckedPeople& a, const CheckedPeople& b) {
  if (a.people.size() != b.people.size()) return false;
  for (std::size_t i = 0; i < a.people.size(); ++i) {
    const auto is_equal = [](const BodyKeypoint& x, const BodyKeypoint& y) {
      return x.u_px == y.u_px && x.v_px == y.v_px;
    };
    if (!std::equal(a.people[i].begin(), a.people[i].end(), b.people[i].begin(), b.people[i].end(),
                    is_equal)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void PeoplePairCheck::Add(const StereoPeople& people) {
  num_left_ += static_cast<int>(people.left.people.size());
  num_right_ += static_cast<int>(people.right.people.size());
  if (first_left_.empty()) first_left_ = people.left.where;
  if (first_right_.empty()) first_right_ = people.right.where;
  if (people.left.people.empty() || people.right.people.empty()) return;
  ++num_frames_;
  num_identical_ += AreEqual(people.left, people.right) ? 1 : 0;

  const std::vector<BodyKeypoints> left = BodiesOf(people.left);
  const std::vector<BodyKeypoints> right = BodiesOf(people.right);
  for (const BodyKeypoints& body : left) sizes_left_px_.push_back(*SizeOf(body));
  for (const BodyKeypoints& body : right) sizes_right_px_.push_back(*SizeOf(body));
  std::vector<std::vector<Pairing>> pairings(left.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (const BodyKeypoints& other : right)
      pairings[i].push_back(Compare(left[i], other, *SizeOf(left[i])));
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    std::vector<double> costs;
    for (const Pairing& pairing : pairings[i]) costs.push_back(pairing.cost);
    const std::optional<std::size_t> partner = ClearlyBest(costs);
    if (!partner) continue;
    costs.clear();
    for (const std::vector<Pairing>& row : pairings) costs.push_back(row[*partner].cost);
    if (ClearlyBest(costs) != i) continue;
    disparities_px_.push_back(pairings[i][*partner].disparity_px);
    row_steps_px_.push_back(pairings[i][*partner].row_step_px);
  }
}

bool PeoplePairCheck::ReportMissing(const std::string& where, FindingList* findings) const {
  const auto say = [&](const std::string& there, const std::string& missing, int num) {
    findings->Warn("keypoints.one_side", where,
                   std::to_string(num) + " people in the " + there +
                       " images, no keypoints in the " + missing +
                       ": people cannot be triangulated, they are only masked out");
  };
  if (num_left_ > 0 && num_right_ == 0) say("left", "right", num_left_);
  if (num_right_ > 0 && num_left_ == 0) say("right", "left", num_right_);
  if (num_frames_ >= 2 && num_identical_ > num_frames_ / 2) {
    findings->Fail("keypoints.identical", first_right_,
                   "left and right keypoints are the same in " + std::to_string(num_identical_) +
                       " of " + std::to_string(num_frames_) +
                       " images: one of the two is a copy of the other");
    return true;
  }
  return num_frames_ == 0;
}

bool PeoplePairCheck::ReportResolution(const std::string& where, FindingList* findings) const {
  constexpr double kMaxFactor = 1.2;
  if (std::min(sizes_left_px_.size(), sizes_right_px_.size()) < kMinPeople) return false;
  const double factor = Quantile(sizes_right_px_, 0.5) / Quantile(sizes_left_px_, 0.5);
  if (std::max(factor, 1 / factor) < kMaxFactor) return false;
  // People seen by only one camera change the sizes, but not as long as pairs still fit.
  if (static_cast<double>(disparities_px_.size()) > 0.3 * std::min(num_left_, num_right_))
    return false;
  findings->Fail("keypoints.resolution", where,
                 "people in the right images are " + Brief(factor) +
                     " times as large as in the left ones: detected in images of different sizes?");
  return true;
}

void PeoplePairCheck::Report(const std::string& where, FindingList* findings) const {
  if (ReportMissing(where, findings) || ReportResolution(where, findings)) return;
  if (disparities_px_.size() < kMinPairs) return;
  const auto num = static_cast<double>(disparities_px_.size());
  const double num_negative = static_cast<double>(std::count_if(
      disparities_px_.begin(), disparities_px_.end(), [](double d) { return d < 0; }));
  const double row_step_px = Quantile(row_steps_px_, 0.5);
  std::vector<double> absolute_px;
  for (const double step_px : row_steps_px_) absolute_px.push_back(std::abs(step_px));
  const std::string pairs = std::to_string(disparities_px_.size()) +
                            " people seen in both images: " + Percent(1 - num_negative / num) +
                            " have a positive disparity, median " +
                            Brief(Quantile(disparities_px_, 0.5)) + " px; rows differ by " +
                            Brief(Quantile(absolute_px, 0.5)) + " px (median), overall by " +
                            Brief(row_step_px) + " px";
  // A detector's rows vary by a few px from image to image, with either sign.
  const double allowed_px = std::max(3.0, 0.01 * camera_.height);
  if (num_negative > 0.7 * num) {
    findings->Fail("keypoints.swapped", where, "left and right keypoints are exchanged: " + pairs);
  } else if (std::abs(row_step_px) > allowed_px || Quantile(absolute_px, 0.5) > 2 * allowed_px) {
    findings->Warn("keypoints.rows", where,
                   "left and right keypoints are on different rows (from another size of the "
                   "image, not rectified, or from other frames?): " +
                       pairs);
  } else {
    findings->Note("keypoints.pairs", where, pairs);
  }
}

}  // namespace airdos
