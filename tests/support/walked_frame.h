#ifndef AIRDOS_TESTS_SUPPORT_WALKED_FRAME_H_
#define AIRDOS_TESTS_SUPPORT_WALKED_FRAME_H_

#include <map>
#include <opencv2/core.hpp>

#include "common/features/local_mapping.h"
#include "common/features/stereo_frame.h"
#include "tests/support/rendered_scene.h"

namespace airdos {

/// Frame k of SwayingPath() through one rendered scene, as the parts of the odometry get it.
class WalkedFrame {
 public:
  explicit WalkedFrame(int k, const cv::Mat& mask = cv::Mat())
      : images_{FrameId{k}, 0.1 * k, Rendered(k).left, Rendered(k).right, mask, {}},
        frame_(camera_, images_, FeatureExtractor({}), {}) {}

  static const RenderedScene& Scene() {
    static const RenderedScene scene(11);
    return scene;
  }
  /// In W, which is the left camera of frame 0.
  static Se3 Truth(int k) { return SwayingPath(0).inverse() * SwayingPath(k); }

  const StereoFrame& operator*() const { return frame_; }
  const StereoFrame* operator->() const { return &frame_; }

 private:
  /// Each is rendered once, when a test first asks for it.
  static const StereoPair& Rendered(int k) {
    static std::map<int, StereoPair> pairs;
    if (pairs.count(k) == 0) pairs[k] = Scene().Render(SmallStereoCamera(), SwayingPath(k));
    return pairs.at(k);
  }

  const StereoCamera camera_ = SmallStereoCamera();
  const StereoImagePair images_;
  const StereoFrame frame_;
};

/// The landmarks that frame 0 makes, which defines W.
inline LocalMap MapOfFirstFrame() {
  LocalMap map({});
  std::vector<LandmarkSighting> sightings;
  CreateLandmarks({}, *WalkedFrame(0), Se3(), Matrix6d::Zero(), TrustField(0.7), &sightings, &map);
  return map;
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_WALKED_FRAME_H_
