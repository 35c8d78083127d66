#include "processes/person_detector/person_detector_messages.h"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>

#include "common/util/check.h"

namespace airdos {

person_keypoints_t ToPersonKeypoints(const Header& header, const std::vector<PersonPose>& people) {
  auto message = MessageOf<person_keypoints_t>(header);
  message.layout = person_keypoints_t::LAYOUT_COCO17;
  message.num_people = static_cast<std::int32_t>(people.size());
  message.num_joints = kNumPoseJoints;
  for (const PersonPose& person : people) {
    std::vector<float> u_px, v_px, confidence;
    for (const BodyKeypoint& joint : person.joints) {
      u_px.push_back(static_cast<float>(joint.u_px));
      v_px.push_back(static_cast<float>(joint.v_px));
      confidence.push_back(static_cast<float>(joint.confidence));
    }
    message.u_px.push_back(u_px);
    message.v_px.push_back(v_px);
    message.confidence.push_back(confidence);
  }
  return message;
}

person_mask_t ToPersonMask(const Header& header, const cv::Mat& mask) {
  auto message = MessageOf<person_mask_t>(header);
  message.encoding = person_mask_t::ENCODING_NONE;
  message.width = mask.cols;
  message.height = mask.rows;
  if (mask.empty()) return message;
  AIRDOS_CHECK(cv::imencode(".png", mask, message.data));
  message.encoding = person_mask_t::ENCODING_PNG;
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

}  // namespace airdos
