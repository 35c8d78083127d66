#include "common/check/check_people.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/dataset/image_file.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kMinConfidence = 0.2;  // of joints that count for a person's shape
constexpr double kMargin = 0.1;       // of the image size: detectors extrapolate beyond the border
constexpr int kMinPeople = 5;         // fewer shapes are not significant
constexpr std::size_t kMaxFlags = 3;  // distinct confidences that may be flags
constexpr double kMaxCoverage = 0.9;  // share of the image covered by people
constexpr double kMaxRippled = 0.03;  // of the marked pixels (RippledShare())
constexpr int kMinMaskPoints = 50;    // fewer keypoints cannot test a mask

bool IsSeen(const BodyKeypoint& joint) { return joint.confidence > kMinConfidence; }

/// How far the lengths of the visible segments are from an adult's proportions: median deviation of
/// log(length / typical length) from its median, so that a single misplaced joint has no effect.
/// About 0.4 for the right joint order, 1 for a wrong one. Nothing for fewer than six segments.
std::optional<double> Disproportion(const BodyKeypoints& person) {
  std::vector<double> ratios;
  for (const Segment& segment : kSegments) {
    const BodyKeypoint& a = person[static_cast<std::size_t>(segment.joint_a)];
    const BodyKeypoint& b = person[static_cast<std::size_t>(segment.joint_b)];
    if (!IsSeen(a) || !IsSeen(b)) continue;
    const double length_px = std::max(1.0, (a.uv_px() - b.uv_px()).norm());
    ratios.push_back(std::log(length_px / segment.typical_length_m));
  }
  if (ratios.size() < 6) return std::nullopt;
  const double middle = Quantile(ratios, 0.5);
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  return Quantile(ratios, 0.5);
}

/// Whether the neck is closer to the middle of the shoulders than half their distance or, for a
/// person seen from the side, than a fifth of the trunk.
bool IsNeckBetweenShoulders(const BodyKeypoints& person) {
  const Eigen::Vector2d neck = person[kNeck].uv_px();
  const Eigen::Vector2d right = person[kRightShoulder].uv_px();
  const Eigen::Vector2d left = person[kLeftShoulder].uv_px();
  double allowed_px = 0.5 * (right - left).norm();
  for (const Joint hip : {kRightHip, kLeftHip}) {
    if (!IsSeen(person[hip])) continue;
    allowed_px = std::max(allowed_px, 0.2 * (person[hip].uv_px() - neck).norm());
  }
  return (neck - 0.5 * (right + left)).norm() <= std::max(allowed_px, 1.5);
}

}  // namespace

void KeypointCheck::Add(const CheckedPeople& people, FindingList* findings) {
  ++num_images_;
  num_people_ += static_cast<int>(people.people.size());
  AddPoints(people, findings);
  for (const std::vector<BodyKeypoint>& person : people.people) AddShape(people.layout, person);
}

void KeypointCheck::AddPoints(const CheckedPeople& people, FindingList* findings) {
  double worst = 0;
  int num_outside = 0;
  for (const std::vector<BodyKeypoint>& person : people.people) {
    for (const BodyKeypoint& point : person) {
      if (std::abs(point.confidence - 0.5) > std::abs(worst - 0.5)) worst = point.confidence;
      if (confidences_.size() <= kMaxFlags) confidences_.insert(point.confidence);
      if (!(point.confidence > 0)) continue;
      ++num_points_;
      u_shares_.push_back(point.u_px / camera_.width);
      v_shares_.push_back(point.v_px / camera_.height);
      const Eigen::Vector2d distance(std::abs(point.u_px / camera_.width - 0.5),
                                     std::abs(point.v_px / camera_.height - 0.5));
      num_outside += distance.maxCoeff() > 0.5 + kMargin ? 1 : 0;
      num_below_two_ += std::abs(point.u_px) <= 2 && std::abs(point.v_px) <= 2 ? 1 : 0;
    }
  }
  if (num_outside > 0 && num_outside_ == 0) first_outside_ = people.where;
  num_outside_ += num_outside;
  // The scores of some detectors slightly exceed 1; the readers clamp them.
  if (worst < 0 || worst > 2) {
    findings->Fail("keypoints.confidence", people.where,
                   "a confidence of " + Brief(worst) + " is not within 0..1" +
                       (worst > 2 && worst <= 100 ? " (percent?)" : ""));
  }
}

void KeypointCheck::AddShape(KeypointLayout layout, const std::vector<BodyKeypoint>& person) {
  const std::optional<BodyKeypoints> body = MapToBody(layout, person);
  if (!body) return;
  const auto is_seen = [&](Joint joint) { return IsSeen((*body)[joint]); };
  if (is_seen(kNeck) && is_seen(kRightShoulder) && is_seen(kLeftShoulder)) {
    ++num_necks_;
    num_good_necks_ += IsNeckBetweenShoulders(*body) ? 1 : 0;
  }
  if (is_seen(kNose) && is_seen(kRightHip) && is_seen(kLeftHip)) {
    ++num_heads_;
    const double hip_px = 0.5 * ((*body)[kRightHip].v_px + (*body)[kLeftHip].v_px);
    num_good_heads_ += (*body)[kNose].v_px < hip_px ? 1 : 0;
  }
  if (layout != KeypointLayout::kCoco18) return;
  AddBody25(person);
  const std::optional<BodyKeypoints> as_coco17 =
      MapToBody(KeypointLayout::kCoco17, {person.begin(), person.begin() + 17});
  const std::optional<double> own = Disproportion(*body);
  const std::optional<double> as17 = Disproportion(*as_coco17);
  if (own && as17) coco17_ratios_.push_back(*as17 / std::max(*own, 1e-3));
}

void KeypointCheck::AddBody25(const std::vector<BodyKeypoint>& person) {
  if (!IsSeen(person[1]) || !IsSeen(person[8]) || !IsSeen(person[9]) || !IsSeen(person[12])) return;
  ++num_body25_shapes_;
  const double trunk_px = std::max(1.0, (person[8].uv_px() - person[1].uv_px()).norm());
  const Eigen::Vector2d middle = 0.5 * (person[9].uv_px() + person[12].uv_px());
  num_body25_ += (person[8].uv_px() - middle).norm() < 0.15 * trunk_px ? 1 : 0;
}

void KeypointCheck::Report(const std::string& where, FindingList* findings) const {
  if (num_people_ == 0) {
    findings->Note("keypoints.people", where,
                   "nobody in " + std::to_string(num_images_) + " images");
    return;
  }
  findings->Note(
      "keypoints.people", where,
      std::to_string(num_people_) + " people in " + std::to_string(num_images_) + " images");
  if (num_points_ == 0) {
    findings->Warn("keypoints.confidence", where, "every keypoint has confidence 0 (not seen)");
    return;
  }
  ReportConfidences(where, findings);
  const double num_points = num_points_;
  if (num_below_two_ > 0.5 * num_points) {
    findings->Fail("keypoints.normalised", where,
                   "coordinates are fractions of the image size; they are expected in px");
  } else if (num_outside_ > 0.2 * num_points) {
    findings->Fail(
        "keypoints.scale", where,
        Percent(num_outside_ / num_points) +
            " of the keypoints are outside the image: they belong to another image size, "
            "about " +
            Brief(std::max(Quantile(u_shares_, 0.99), Quantile(v_shares_, 0.99))) +
            " times as large");
  } else {
    ReportExtent(where, findings);
    ReportLayout(where, findings);
  }
}

void KeypointCheck::ReportConfidences(const std::string& where, FindingList* findings) const {
  const auto is_one_of = [&](std::set<double> flags) {
    return std::includes(flags.begin(), flags.end(), confidences_.begin(), confidences_.end());
  };
  if (is_one_of({0, 1})) {
    findings->Note("keypoints.flags", where,
                   "all confidences are 0 or 1: all visible joints have the same weight");
  } else if (is_one_of({0, 1, 2})) {
    findings->Warn("keypoints.flags", where,
                   "all confidences are 0, 1 or 2, like COCO's visibility flags (1: hidden, 2: "
                   "visible): hidden joints would count like visible ones; confidences of 0..1 are "
                   "wanted");
  }
}

void KeypointCheck::ReportExtent(const std::string& where, FindingList* findings) const {
  constexpr int kManyPeople = 40;
  const double u = Quantile(u_shares_, 0.995);
  const double v = Quantile(v_shares_, 0.995);
  if (num_people_ < kManyPeople || u > 0.55 || v > 0.55) return;
  findings->Warn("keypoints.extent", where,
                 "all keypoints lie in the upper left " + Percent(u) + " x " + Percent(v) +
                     " of the image: do they belong to an image about " + Brief(std::max(u, v)) +
                     " times as large?");
}

void KeypointCheck::ReportLayout(const std::string& where, FindingList* findings) const {
  constexpr double kUsualOutside = 0.01;  // detectors extrapolate people cut off by the border
  if (num_outside_ > 0) {
    findings->Add(num_outside_ > kUsualOutside * num_points_ ? Severity::kWarning : Severity::kNote,
                  "keypoints.outside", first_outside_,
                  "here first, " + std::to_string(num_outside_) + " of " +
                      std::to_string(num_points_) + " keypoints are far outside the image of " +
                      std::to_string(camera_.width) + " x " + std::to_string(camera_.height) +
                      " px");
  }
  const double necks = num_necks_ > 0 ? 1.0 * num_good_necks_ / num_necks_ : 1;
  const double heads = num_heads_ > 0 ? 1.0 * num_good_heads_ / num_heads_ : 1;
  const std::string shape = "the neck lies between the shoulders in " + Percent(necks) + " of " +
                            std::to_string(num_necks_) + " people, the nose above the hips in " +
                            Percent(heads) + " of " + std::to_string(num_heads_);
  // Measured medians: 1.4 to 2.8 for COCO-18; 0.30 to 0.35 for the same people in COCO-17 order.
  constexpr double kClearlyBetter = 0.7;
  if (coco17_ratios_.size() >= kMinPeople && Quantile(coco17_ratios_, 0.5) < kClearlyBetter) {
    findings->Fail("keypoints.layout", where,
                   "the order of the joints is not COCO-18, it looks like COCO-17, or like the "
                   "first 18 of Halpe-26: " +
                       shape);
  } else if (num_body25_shapes_ >= kMinPeople && num_body25_ > 0.7 * num_body25_shapes_) {
    findings->Fail(
        "keypoints.layout", where,
        "the order of the joints is not COCO-18, it looks like the first 18 of OpenPose's "
        "BODY_25: joint 8 is midway between 9 and 12 in " +
            Percent(1.0 * num_body25_ / num_body25_shapes_) + " of " +
            std::to_string(num_body25_shapes_) +
            " people; provide all 25, or convert them to COCO-18");
  } else if (num_necks_ >= kMinPeople && necks < 0.5) {
    findings->Fail("keypoints.layout", where,
                   "the order of the joints is not the layout's: " + shape);
  } else if (num_heads_ >= kMinPeople && heads < 0.7) {
    findings->Warn("keypoints.layout", where, "is the image upside down? " + shape);
  } else {
    findings->Note("keypoints.layout", where, shape);
  }
}

void MaskCheck::Add(const CheckedPictures& pictures, FindingList* findings) {
  const cv::Mat& mask = pictures.mask.pixels;
  if (mask.empty()) return;
  if (mask.cols != camera_.width || mask.rows != camera_.height) {
    findings->Fail(
        "masks.size", pictures.where_mask,
        SizeMismatchText(mask.cols, mask.rows, "the images", camera_.width, camera_.height));
    return;
  }
  if (!pictures.mask.doubt.empty())
    findings->Warn("masks.palette", pictures.where_mask, pictures.mask.doubt);
  kinds_.insert(pictures.mask.kind);
  const double coverage = cv::countNonZero(mask) / static_cast<double>(mask.total());
  coverages_.push_back(coverage);
  if (coverage > kMaxCoverage && num_full_++ == 0) first_full_ = pictures.where_mask;
  if (RippledShare(pictures.mask) > kMaxRippled && num_rippled_++ == 0)
    first_rippled_ = pictures.where_mask;
  AddPoints(pictures, coverage);
  AddValues(pictures);
}

void MaskCheck::AddPoints(const CheckedPictures& pictures, double coverage) {
  const auto is_marked = [&](const Eigen::Vector2d& uv_px) {
    return camera_.IsInImage(uv_px) &&
           pictures.mask.pixels.at<unsigned char>(static_cast<int>(uv_px.y()),
                                                  static_cast<int>(uv_px.x())) != 0;
  };
  for (const std::vector<BodyKeypoint>& person : pictures.people_left.people) {
    for (const BodyKeypoint& point : person) {
      if (!IsSeen(point)) continue;
      for (std::size_t i = 0; i < kFactors.size(); ++i)
        num_inside_scaled_[i] += is_marked(point.uv_px() / kFactors[i]) ? 1 : 0;
      ++num_seen_;
      if (!camera_.IsInImage(point.uv_px())) continue;
      ++num_points_;
      chance_ += coverage;
      num_inside_ += is_marked(point.uv_px()) ? 1 : 0;
    }
  }
}

void MaskCheck::AddValues(const CheckedPictures& pictures) {
  if (pictures.mask.kind.find("RGB") != std::string::npos) return;
  cv::Mat values;
  pictures.mask.values.convertTo(values, CV_32S);
  std::vector<int> counts(1 << 16);
  for (int row = 0; row < values.rows; ++row) {
    for (int column = 0; column < values.cols; ++column)
      ++counts[static_cast<std::size_t>(values.at<int>(row, column))];
  }
  for (std::size_t value = 1; value < counts.size(); ++value) {
    if (counts[value] == 0) continue;
    values_[static_cast<int>(value)].area += counts[value] / static_cast<double>(values.total());
  }
  for (const std::vector<BodyKeypoint>& person : pictures.people_left.people) {
    for (const BodyKeypoint& point : person) {
      if (!IsSeen(point) || !camera_.IsInImage(point.uv_px())) continue;
      ++values_[values.at<int>(static_cast<int>(point.v_px), static_cast<int>(point.u_px))]
            .num_points;
    }
  }
}

void MaskCheck::Report(const std::string& where, FindingList* findings) const {
  if (coverages_.empty()) return;
  for (const std::string& kind : kinds_) {
    if (kind == "8-bit grey") continue;
    findings->Note("masks.kind", where,
                   "masks are stored as " + kind + ": " +
                       (kind == "palette"                       ? "index 0"
                        : kind.find("RGB") != std::string::npos ? "black"
                                                                : "0") +
                       " is the background, anything else a person");
  }
  if (num_rippled_ > 0.5 * static_cast<double>(coverages_.size())) {
    findings->Fail("masks.jpeg", first_rippled_,
                   "here first, the values ripple around edges in " + std::to_string(num_rippled_) +
                       " of " + std::to_string(coverages_.size()) +
                       " masks: they were once JPEG, which blurs them; save the masks as PNG at "
                       "once");
    return;
  }
  if (ReportInverted(where, findings) || ReportFull(where, findings)) return;
  ReportFit(where, findings);
  ReportClasses(where, findings);
}

std::string MaskCheck::FitText() const {
  std::string text = "masks cover " + Percent(Quantile(coverages_, 0.5)) + " of the image (median)";
  if (num_points_ < kMinMaskPoints) return text;
  return text + ", " + Percent(1.0 * num_inside_ / num_points_) + " of the keypoints lie in them";
}

bool MaskCheck::ReportInverted(const std::string& where, FindingList* findings) const {
  if (num_points_ < kMinMaskPoints || Quantile(coverages_, 0.5) <= 0.3) return false;
  if (num_inside_ >= 0.8 * chance_ || num_inside_ >= 0.5 * num_points_) return false;
  findings->Fail(
      "masks.polarity", where,
      "fewer keypoints than by chance are on people: inverted (0 is background), or from "
      "other images: " +
          FitText());
  return true;
}

bool MaskCheck::ReportFull(const std::string& where, FindingList* findings) const {
  const double coverage = Quantile(coverages_, 0.5);
  if (coverage > kMaxCoverage) {
    findings->Fail("masks.coverage", where,
                   "masks cover " + Percent(coverage) +
                       " of the image (median): a class map, or inverted; everything "
                       "that is not a person must be 0");
    return true;
  }
  if (num_full_ > 0) {
    findings->Warn("masks.full", first_full_,
                   "here first, the mask covers more than " + Percent(kMaxCoverage) +
                       " of the image in " + std::to_string(num_full_) + " of " +
                       std::to_string(coverages_.size()) + " masks");
  }
  return false;
}

void MaskCheck::ReportFit(const std::string& where, FindingList* findings) const {
  const double coverage = Quantile(coverages_, 0.5);
  const bool has_points = num_points_ >= kMinMaskPoints;
  const double inside = has_points ? 1.0 * num_inside_ / num_points_ : 0;
  const std::string text = FitText();
  const auto best = static_cast<std::size_t>(
      std::max_element(num_inside_scaled_.begin(), num_inside_scaled_.end()) -
      num_inside_scaled_.begin());
  const double inside_scaled = num_seen_ > 0 ? 1.0 * num_inside_scaled_[best] / num_seen_ : 0;
  if (!has_points && coverage > 0.6) {
    findings->Warn("masks.polarity", where, "people are the minority; inverted? " + text);
  } else if (has_points && Quantile(coverages_, 1) == 0) {
    findings->Fail(
        "masks.empty", where,
        "no mask marks anybody, although there are keypoints of people: is everything 0?");
  } else if (has_points && inside < 0.5 && inside_scaled > 0.65 && inside_scaled > 2 * coverage) {
    findings->Fail("keypoints.resolution", where,
                   "the keypoints fit the masks (" + Percent(inside_scaled) +
                       " in them) only as those of an image " + Brief(kFactors[best]) +
                       " times as large: " + text);
  } else if (has_points && inside < 0.4) {
    findings->Warn("masks.keypoints", where, "masks and keypoints do not fit together: " + text);
  } else {
    findings->Note("masks.polarity", where, text);
  }
}

void MaskCheck::ReportClasses(const std::string& where, FindingList* findings) const {
  if (num_points_ < kMinMaskPoints) return;
  constexpr double kMaxWithout = 0.25;  // of the image
  constexpr double kMaxDensity = 0.25;  // density of randomly scattered keypoints
  double area_without = 0;
  std::string names;
  for (const auto& [value, seen] : values_) {
    const double area = seen.area / static_cast<double>(coverages_.size());
    if (value == 0 || area < 0.01 || seen.num_points > kMaxDensity * area * num_points_) continue;
    area_without += area;
    names += (names.empty() ? "" : ", ") + std::to_string(value);
  }
  if (area_without < kMaxWithout) return;
  findings->Warn("masks.classes", where,
                 "the numbers " + names + " mark " + Percent(area_without) +
                     " of the image, but hardly any keypoint: a class map? Only people (and "
                     "anything else that moves) may be marked");
}

}  // namespace airdos
