#ifndef AIRDOS_COMMON_PERCEPTION_PERSON_DETECTOR_H_
#define AIRDOS_COMMON_PERCEPTION_PERSON_DETECTOR_H_

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "common/human/image_flow.h"
#include "common/perception/person_masker.h"
#include "common/perception/person_pose.h"
#include "common/perception/pose_network_options.h"
#include "common/perception/row_search.h"

namespace airdos {

/// As the networks of the YOLO family want their input.
inline PoseNetworkOptions BoxNetworkOptions() {
  PoseNetworkOptions options;
  NetworkInputOptions* input = &options.input;
  input->mean_red = input->mean_green = input->mean_blue = 0;
  input->scale_red = input->scale_green = input->scale_blue = 255;
  return options;
}

struct PersonDetectorOptions {
  enum class Head { kMoveNet, kYolo, kSimcc };
  enum class Right {
    kNetwork,  ///< finds the people of the right image, too
    kRows,     ///< FindInRightImage()
  };

  Head head = Head::kMoveNet;
  PoseNetworkOptions pose;
  PoseNetworkOptions boxes =
      BoxNetworkOptions();       ///< SimCC: the network that finds the boxes (YOLO)
  double min_joint_score = 0.1;  ///< joints below it count as not seen
  int min_joints = 4;            ///< people of whom fewer joints are seen are nobody
  Right right = Right::kRows;    ///< better and cheaper: docs/people.md
  RowSearchOptions rows;
  int detect_every = 1;  ///< images; in those between, joints are followed by optical flow
  ImageFlowOptions flow;
  bool use_masks = true;
  PersonMaskerOptions masks;
};

/// The people of a pair of images, each image's in an order of its own.
struct DetectedPeople {
  std::vector<PersonPose> left;
  std::vector<PersonPose> right;
  cv::Mat mask;  ///< of the left image, CV_8UC1, 255 on people; empty if there is none
};

/// Finds people in a sequence of rectified pairs of images. What it finds depends on the images
/// alone, in their order.
class PersonDetector {
 public:
  /// Throws InputError if a file of a network cannot be used.
  explicit PersonDetector(const PersonDetectorOptions& options);
  /// With another network.
  PersonDetector(const PersonDetectorOptions& options, std::unique_ptr<PoseNetwork> network);

  /// Forgets the images so far.
  void Reset();

  /// The people in the next pair (CV_8UC3, BGR; the right one may be CV_8UC1 where the network does
  /// not look at it); an image that is missing is empty, and so are its people. Throws InputError
  /// if a network does not fit its configuration.
  DetectedPeople Process(const cv::Mat& left, const cv::Mat& right);

 private:
  struct View {
    std::unique_ptr<ImageFlow> flow;
    cv::Mat gray;
    std::vector<PersonPose> people;
  };

  void SetImage(const cv::Mat& image, View* view) const;
  void Detect(const cv::Mat& bgr, View* view);
  void Follow(View* view) const;
  /// Without joints and people of whom too little is seen.
  std::vector<PersonPose> Credible(std::vector<PersonPose> people) const;

  PersonDetectorOptions options_;
  std::unique_ptr<PoseNetwork> network_;
  std::unique_ptr<PersonMasker> masker_;
  View left_;
  View right_;
  int num_since_detection_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_PERSON_DETECTOR_H_
