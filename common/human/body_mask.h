#ifndef AIRDOS_COMMON_HUMAN_BODY_MASK_H_
#define AIRDOS_COMMON_HUMAN_BODY_MASK_H_

#include <opencv2/core.hpp>
#include <vector>

#include "common/human/body_keypoints.h"

namespace airdos {

/// Where people are in an image, judging by their joints: limbs and trunk as thick lines, the trunk
/// filled, the head a disc, each as thick as a person of that size, including clothes. CV_8UC1 of
/// `size`, 255 on people, 0 elsewhere. Joints with a confidence below `min_confidence` are ignored,
/// and a person with fewer than three other joints is left out.
cv::Mat DrawBodyMask(const std::vector<BodyKeypoints>& people, const cv::Size& size,
                     double min_confidence);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_BODY_MASK_H_
