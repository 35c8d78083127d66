#ifndef AIRDOS_COMMON_CHECK_PEOPLE_H_
#define AIRDOS_COMMON_CHECK_PEOPLE_H_

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/check/check_input.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Whether keypoints are those of people in the order that their layout says: in the image, with
/// confidences in 0..1, the neck between the shoulders, the nose above the hips, and the lengths
/// of segments nearer to a person's proportions than if the rows were COCO-17 (which has no neck),
/// joint 8 a hip, not the middle of the hips as in BODY_25; confidences no flags of visibility; all
/// of the image used, not a part as if it was smaller.
class KeypointCheck {
 public:
  explicit KeypointCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const CheckedPeople& people, FindingList* findings);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  void AddPoints(const CheckedPeople& people, FindingList* findings);
  void AddShape(KeypointLayout layout, const std::vector<BodyKeypoint>& person);
  void AddBody25(const std::vector<BodyKeypoint>& person);
  void ReportLayout(const std::string& where, FindingList* findings) const;
  void ReportConfidences(const std::string& where, FindingList* findings) const;
  void ReportExtent(const std::string& where, FindingList* findings) const;

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
  int num_body25_shapes_ = 0;          // people who show what BODY_25 has at 8, 9 and 12
  int num_body25_ = 0;                 // of those, with 8 in the middle of 9 and 12
  std::set<double> confidences_;       // different ones, the first few
  std::vector<double> u_shares_;       // of the width, of seen keypoints; likewise the next
  std::vector<double> v_shares_;
};

/// Whether masks mark people: not most of the image, and where the keypoints are. Masks whose
/// polarity is inverted have fewer keypoints in them than chance; maps of classes mark what has no
/// keypoints, too; keypoints of another size of the image fit once they are scaled; JPEG ripples.
class MaskCheck {
 public:
  explicit MaskCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const CheckedPictures& pictures, FindingList* findings);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  static constexpr std::array<double, 8> kFactors = {0.25, 1.0 / 3, 0.5, 2.0 / 3, 1.5, 2, 3, 4};

  void AddPoints(const CheckedPictures& pictures, double coverage);
  void AddValues(const CheckedPictures& pictures);
  std::string FitText() const;
  /// Each is true where it has said what is wrong with the masks as a whole.
  bool ReportInverted(const std::string& where, FindingList* findings) const;
  bool ReportFull(const std::string& where, FindingList* findings) const;
  void ReportFit(const std::string& where, FindingList* findings) const;
  void ReportClasses(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  std::set<std::string> kinds_;
  std::vector<double> coverages_;  // share of the pixels that are people's
  int num_full_ = 0;               // masks that cover nearly everything
  std::string first_full_;
  int num_rippled_ = 0;
  std::string first_rippled_;
  struct Value {
    double area = 0;  // sum of the shares of the masks
    int num_points = 0;
  };
  std::map<int, Value> values_;                           // of grey and palette masks
  std::array<int, kFactors.size()> num_inside_scaled_{};  // keypoints divided by the factor
  double chance_ = 0;   // sum over keypoints of their image's coverage
  int num_seen_ = 0;    // keypoints
  int num_points_ = 0;  // of those, in the image
  int num_inside_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_PEOPLE_H_
