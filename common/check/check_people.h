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

/// Checks whether keypoints are those of people in the joint order of their layout: inside the
/// image; confidences in 0..1, and not mere visibility flags; the neck between the shoulders, the
/// nose above the hips; segment lengths closer to human proportions than if the rows were COCO-17
/// (which has no neck); joint 8 a hip, rather than the middle of the hips as in BODY_25; and spread
/// over the whole image, rather than only a part of it, as they would be for a smaller image.
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
  int num_outside_ = 0;  // keypoints outside the image plus its margin
  std::string first_outside_;
  int num_below_two_ = 0;  // keypoints with both coordinates in 0..2
  int num_necks_ = 0;      // people with visible neck and shoulders
  int num_good_necks_ = 0;
  int num_heads_ = 0;  // people with visible nose and hips
  int num_good_heads_ = 0;
  std::vector<double> coco17_ratios_;  // disproportion as COCO-17 / as given, per person
  int num_body25_shapes_ = 0;          // people with visible joints 8, 9 and 12 of BODY_25
  int num_body25_ = 0;                 // of these, those with 8 midway between 9 and 12
  std::set<double> confidences_;       // the first few distinct ones
  std::vector<double> u_shares_;       // u of visible keypoints / width; v / height likewise
  std::vector<double> v_shares_;
};

/// Checks whether masks mark people: not most of the image, and where the keypoints are. Inverted
/// masks contain fewer keypoints than chance would; class maps also mark things without keypoints;
/// keypoints for another image size fit once they are scaled. Also detects JPEG ripples.
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
  /// Each returns true if it has reported what is wrong with the masks as a whole.
  bool ReportInverted(const std::string& where, FindingList* findings) const;
  bool ReportFull(const std::string& where, FindingList* findings) const;
  void ReportFit(const std::string& where, FindingList* findings) const;
  void ReportClasses(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  std::set<std::string> kinds_;
  std::vector<double> coverages_;  // share of the pixels marked as people
  int num_full_ = 0;               // masks that cover nearly the whole image
  std::string first_full_;
  int num_rippled_ = 0;
  std::string first_rippled_;
  /// What is known about one value in the masks.
  struct Value {
    double area = 0;  // sum of its shares of the masks
    int num_points = 0;
  };
  std::map<int, Value> values_;                           // in grey and palette masks
  std::array<int, kFactors.size()> num_inside_scaled_{};  // keypoints divided by the factor
  double chance_ = 0;   // sum over the keypoints of their image's coverage
  int num_seen_ = 0;    // keypoints
  int num_points_ = 0;  // of these, inside the image
  int num_inside_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_PEOPLE_H_
