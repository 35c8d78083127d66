#ifndef AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_MESSAGES_H_
#define AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_MESSAGES_H_

#include <opencv2/core.hpp>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "common/perception/person_pose.h"
#include "processes/node/message/header.h"

namespace airdos {

/// The joints of all people, as COCO-17.
person_keypoints_t ToPersonKeypoints(const Header& header, const std::vector<PersonPose>& people);

/// A mask (CV_8UC1, 255 on people) as PNG; if it is empty, the message of no mask.
person_mask_t ToPersonMask(const Header& header, const cv::Mat& mask);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_MESSAGES_H_
