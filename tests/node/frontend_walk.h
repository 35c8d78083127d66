#ifndef AIRDOS_TESTS_NODE_FRONTEND_WALK_H_
#define AIRDOS_TESTS_NODE_FRONTEND_WALK_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "airdos/stereo_calibration_t.hpp"
#include "processes/frontend/frontend_node.h"
#include "tests/support/rendered_scene.h"

namespace airdos {

// What the frontend's tests send it: a walk through a rendered scene, seen by SmallStereoCamera().

constexpr std::int64_t kSession = 7;
// Copies, because the generated constants have no address for EXPECT_EQ to take.
constexpr int kInitializing = static_features_t::STATE_INITIALIZING;
constexpr int kTracking = static_features_t::STATE_TRACKING;
constexpr int kCoasting = static_features_t::STATE_COASTING;

/// Frame k of the walk; each is rendered once, when a test first asks for it.
const StereoPair& Walk(int k);
/// T_W_C of frame k.
Se3 Truth(int k);

image_t ImageOf(const cv::Mat& image, std::int64_t seq, std::int64_t session = kSession);
image_t Left(int seq, std::int64_t session = kSession);
image_t Right(int seq, std::int64_t session = kSession);
stereo_calibration_t Calibration(std::int64_t session = kSession);
person_mask_t NoMask(std::int64_t seq, std::int64_t session = kSession);
/// A person fills the columns [begin, end).
person_mask_t Mask(std::int64_t seq, int begin_px, int end_px, cv::Size size);
/// The same, as large as the images.
person_mask_t Mask(std::int64_t seq, int begin_px, int end_px);

/// The optimizer's word on one frame; it changes nothing.
map_update_t Update(std::int64_t seq, std::int64_t session = kSession);
/// Adds the pose of a frame to it.
void AddFrame(std::int64_t seq, const Se3& T_W_C, map_update_t* message);

template <class Message>
void Send(const std::string& channel, const Message& message, Node* node) {
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}
human_observations_t NoHumans(std::int64_t seq, std::int64_t session = kSession);
person_keypoints_t NoKeypoints(std::int64_t seq, std::int64_t session = kSession);
/// Somebody seen from frame `seq`: body joints around `place_W`, one centimetre of deviation.
human_observation_t Human(std::int64_t track, const Eigen::Vector3d& place_W, int seq);
/// Somebody whose trunk is a rectangle of the left image, as a detector of COCO-18 gives it.
person_keypoints_t Keypoints(std::int64_t seq, const cv::Rect& trunk_px, float confidence);

/// Nobody on the channels of people, as while nobody is in view.
void SendNobody(std::int64_t seq, Node* node, std::int64_t session = kSession);
/// Both images, an empty mask and nobody.
void SendFrame(int seq, Node* node, std::int64_t session = kSession);

/// What was published since the last call; every message must be valid.
std::vector<static_features_t> Take(Node* node);
/// Works until nothing is ready.
std::vector<static_features_t> StepAll(Node* node);

double PositionError_m(const static_features_t& message, const Se3& T_O_C);

FrontendOptions WithoutFeedback();

}  // namespace airdos

#endif  // AIRDOS_TESTS_NODE_FRONTEND_WALK_H_
