#ifndef AIRDOS_COMMON_CHECK_PEOPLE_H_
#define AIRDOS_COMMON_CHECK_PEOPLE_H_

#include <string>
#include <vector>

#include "common/check/check_input.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Whether keypoints are those of people in the order that their layout says: in the image, with
/// confidences in 0..1, the neck between the shoulders, the nose above the hips, and the lengths
/// of segments nearer to a person's proportions than if the rows were COCO-17 (which has no neck).
class KeypointCheck {
 public:
  explicit KeypointCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const CheckedPeople& people, FindingList* findings);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  void AddPoints(const CheckedPeople& people, FindingList* findings);
  void AddShape(KeypointLayout layout, const std::vector<BodyKeypoint>& person);
  void ReportLayout(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  int num_images_ = 0;
  int num_people_ = 0;
  int num_points_ = 0;
  int num_outside_ = 0;  // of the image and its margin
  std::string first_outside_;
  int num_below_two_ = 0;  // points whose coordinates are both in 0..2
  int num_necks_ = 0;      // people whose neck and shoulders are seen
  int num_good_necks_ = 0;
  int num_heads_ = 0;  // people whose nose and hips are seen
  int num_good_heads_ = 0;
  std::vector<double> coco17_ratios_;  // disproportion as COCO-17 / as given, per person
};

/// Whether masks mark people: not most of the image, and where the keypoints are. Masks whose
/// polarity is inverted have fewer keypoints in them than chance.
class MaskCheck {
 public:
  explicit MaskCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const CheckedPictures& pictures, FindingList* findings);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  StereoCamera camera_;
  std::vector<double> coverages_;  // share of the pixels that are people's
  double chance_ = 0;              // sum over keypoints of their image's coverage
  int num_points_ = 0;
  int num_inside_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_PEOPLE_H_
