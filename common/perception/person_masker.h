#ifndef AIRDOS_COMMON_PERCEPTION_PERSON_MASKER_H_
#define AIRDOS_COMMON_PERCEPTION_PERSON_MASKER_H_

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "common/perception/dnn_network.h"
#include "common/perception/person_pose.h"

namespace airdos {

struct PersonMaskerOptions {
  bool use_network = true;    ///< or the joints alone
  DnnNetworkOptions network;  ///< 1 x 1 x side x side: how likely a pixel shows a person, 0..1
  int side_px = 96;           ///< of its input, which is RGB from 0 to 1
  int min_height_px = 80;     ///< people of whom less is seen are marked by their joints alone
  /// Shorter side of the input that shows the whole image; 0: the network does not look at it.
  int image_short_side_px = 224;
  double min_score = 0.1;  ///< of joints
};

/// Marks people by their joints (limbs, trunk and head as wide as a person's, DrawBodyMask()), and
/// those who are large enough also by a network that looks at their box. The same network looks at
/// the whole image, too: there it marks people who are so near that they fill much of it, whose
/// joints are often not found.
class PersonMasker {
 public:
  /// Throws InputError if the network's file cannot be used.
  explicit PersonMasker(const PersonMaskerOptions& options);

  /// CV_8UC1 of the size of `bgr`, 255 on people. Throws InputError if the network gives something
  /// else.
  cv::Mat Process(const cv::Mat& bgr, const std::vector<PersonPose>& people);

 private:
  void PaintWithin(const cv::Mat& bgr, const cv::Rect2d& box, cv::Mat* mask);
  void PaintImage(const cv::Mat& bgr, cv::Mat* mask);

  PersonMaskerOptions options_;
  // One for each size of input: a network is read anew for another one.
  std::unique_ptr<DnnNetwork> net_of_people_;
  std::unique_ptr<DnnNetwork> net_of_image_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_PERSON_MASKER_H_
