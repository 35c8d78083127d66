// The sample scene as a camera of one's own would have recorded it: unrectified, with lenses that
// bend lines, in videos or folders, with the calibration file of this tool or that. What the
// estimator makes of it must be about as good as of the rectified originals.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/calibration/calibration_file.h"
#include "common/calibration/rig_writer.h"
#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "common/dataset/recording/video_recording.h"
#include "common/util/format.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/image_codec.h"
#include "tests/support/chain_run.h"
#include "tests/support/distorted_rig.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

constexpr char kLog[] = AIRDOS_SOURCE_DIR "/logs/road_crossing06.lcm";
constexpr double kRate_hz = 10;

template <class Message>
Message DecodeEvent(const LogEvent& event) {
  Message message{};
  EXPECT_TRUE(Decode(event.payload.data(), event.payload.size(), &message)) << event.channel;
  return message;
}

StereoCamera CameraOf(const std::vector<LogEvent>& events) {
  for (const LogEvent& event : events) {
    if (event.channel == channel::kCalibration)
      return ToStereoCamera(DecodeEvent<stereo_calibration_t>(event));
  }
  return {};
}

class OwnCameraTest : public testing::Test {
 protected:
  struct Images {
    std::vector<cv::Mat> left;
    std::vector<cv::Mat> right;
  };

  OwnCameraTest() : scratch_("own_camera"), events_(ReadEvents()), distorted_(CameraOf(events_)) {
    for (const LogEvent& event : events_) {
      if (event.channel != channel::kCameraLeft && event.channel != channel::kCameraRight) continue;
      const bool is_left = event.channel == channel::kCameraLeft;
      const cv::Mat image = DecodeColor(DecodeEvent<image_t>(event)).value();
      (is_left ? images_.left : images_.right)
          .push_back(is_left ? distorted_.Left(image, cv::INTER_CUBIC)
                             : distorted_.Right(image, cv::INTER_CUBIC));
    }
  }

  static std::vector<LogEvent> ReadEvents() {
    std::vector<LogEvent> events;
    EventLogReader reader(kLog);
    while (auto event = reader.Next()) events.push_back(std::move(*event));
    return events;
  }

  /// Empty if OpenCV has no encoder for it on this machine.
  std::string WriteVideo(const std::string& name, const std::vector<cv::Mat>& images) const {
    const std::string path = scratch_.PathOf(name);
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                           kRate_hz, images[0].size(), true);
    for (const cv::Mat& image : images) {
      if (writer.isOpened()) writer.write(image);
    }
    return writer.isOpened() ? path : "";
  }
  std::unique_ptr<StereoRecording> Videos() const {
    const std::string left = WriteVideo("left.mp4", images_.left);
    const std::string right = WriteVideo("right.mp4", images_.right);
    if (left.empty() || right.empty()) return Folders();
    return std::make_unique<VideoRecording>(VideoRecordingOptions{left, right});
  }
  std::unique_ptr<StereoRecording> Folders() const {
    for (std::size_t i = 0; i < images_.left.size(); ++i) {
      scratch_.WritePicture(Format("left/%010zu.png", i), images_.left[i]);
      scratch_.WritePicture(Format("right/frame%zu.png", i), images_.right[i]);
    }
    return std::make_unique<FolderRecording>(
        FolderRecordingOptions{scratch_.PathOf("left"), scratch_.PathOf("right"), "", kRate_hz});
  }
  std::unique_ptr<StereoRecording> OneFolder() const {
    for (std::size_t i = 0; i < images_.left.size(); ++i) {
      scratch_.WritePicture(Format("both/frame%zu_l.png", i), images_.left[i]);
      scratch_.WritePicture(Format("both/frame%zu_r.png", i), images_.right[i]);
    }
    return std::make_unique<FolderRecording>(
        FolderRecordingOptions{scratch_.PathOf("both"), "", "", kRate_hz});
  }

  /// As opened by a user who has the rig's calibration in this format.
  std::unique_ptr<RectifiedSequence> Open(std::unique_ptr<StereoRecording> recording,
                                          const std::string& format) const {
    std::vector<std::string> paths;
    for (const NamedText& file :
         WriteRig(distorted_.rig(), StereoRectifier(distorted_.rig()), format))
      paths.push_back(scratch_.Write(format + "/" + file.name, file.text));
    CalibrationOptions options;
    options.format.image_size = recording->image_size();
    const StereoRig rig = ReadStereoRig(paths, options);
    return std::make_unique<RectifiedSequence>(std::move(recording), rig);
  }

  LogEvent Rectified(LogEvent event, const RectifiedSequence& sequence) {
    const std::string& name = event.channel;
    if (name == channel::kCameraLeft || name == channel::kCameraRight) {
      event.payload = Encode(ImageOf(event, sequence));
    } else if (name == channel::kCalibration) {
      auto message = DecodeEvent<stereo_calibration_t>(event);
      FromStereoCamera(sequence.camera(), &message);
      event.payload = Encode(message);
    } else if (name == channel::kPersonKeypointsLeft || name == channel::kPersonKeypointsRight) {
      event.payload = Encode(KeypointsOf(event, sequence.rectifier()));
    } else if (name == channel::kPersonMask) {
      event.payload = Encode(MaskOf(event, sequence.rectifier()));
    }
    return event;
  }
  image_t ImageOf(const LogEvent& event, const RectifiedSequence& sequence) {
    auto message = DecodeEvent<image_t>(event);
    if (frame_seq_ != message.seq) frame_ = sequence.Load(static_cast<std::size_t>(message.seq));
    frame_seq_ = message.seq;
    message.encoding = image_t::ENCODING_PNG;
    cv::imencode(".png",
                 event.channel == channel::kCameraLeft ? frame_.left_pixels : frame_.right_pixels,
                 message.data);
    message.num_bytes = static_cast<std::int32_t>(message.data.size());
    return message;
  }
  /// Where a detector would find the same joints in the rectified images.
  person_keypoints_t KeypointsOf(const LogEvent& event, const StereoRectifier& rectifier) const {
    auto message = DecodeEvent<person_keypoints_t>(event);
    const bool is_left = event.channel == channel::kPersonKeypointsLeft;
    for (std::size_t i = 0; i < message.u_px.size(); ++i) {
      for (std::size_t j = 0; j < message.u_px[i].size(); ++j) {
        const Eigen::Vector2d original(message.u_px[i][j], message.v_px[i][j]);
        const Eigen::Vector2d uv = is_left ? rectifier.RectifyLeft(distorted_.Left(original))
                                           : rectifier.RectifyRight(distorted_.Right(original));
        const bool is_seen = message.confidence[i][j] > 0 && rectifier.camera().IsInImage(uv);
        message.u_px[i][j] = is_seen ? static_cast<float>(uv.x()) : 0;
        message.v_px[i][j] = is_seen ? static_cast<float>(uv.y()) : 0;
        if (!is_seen) message.confidence[i][j] = 0;
      }
    }
    return message;
  }
  person_mask_t MaskOf(const LogEvent& event, const StereoRectifier& rectifier) const {
    auto message = DecodeEvent<person_mask_t>(event);
    if (message.encoding == person_mask_t::ENCODING_NONE) return message;
    const cv::Mat mask =
        rectifier.Left(distorted_.Left(DecodeMask(message).value(), cv::INTER_NEAREST)) > 127;
    message.encoding = person_mask_t::ENCODING_RAW_GRAY8;
    message.data.assign(mask.datastart, mask.dataend);
    message.num_bytes = static_cast<std::int32_t>(message.data.size());
    return message;
  }

  /// Runs the estimator on the rectified images, with the log's people or with those whom the
  /// detector finds.
  ChainRun Run(const RectifiedSequence& sequence, bool detects = false) {
    frame_seq_ = -1;
    const std::string path = scratch_.PathOf("rectified.lcm");
    EventLogWriter writer(path);
    for (const LogEvent& event : events_) {
      const bool is_of_people = event.channel == channel::kPersonKeypointsLeft ||
                                event.channel == channel::kPersonKeypointsRight ||
                                event.channel == channel::kPersonMask;
      if (detects && is_of_people) continue;
      const LogEvent changed = Rectified(event, sequence);
      writer.Append(changed.utime, changed.channel, changed.payload.data(), changed.payload.size());
    }
    return RunChain({path, "on", true, {}, detects});
  }

  const ScratchFolder scratch_;
  const std::vector<LogEvent> events_;
  const DistortedRig distorted_;
  Images images_;
  SequenceFrame frame_;
  std::int64_t frame_seq_ = -1;
};

/// Of where the corners and some other pixels of the images come to lie.
double LargestDifference_px(const StereoRectifier& a, const StereoRectifier& b) {
  double largest = 0;
  for (int u = 0; u < a.camera().width; u += 71) {
    for (int v = 0; v < a.camera().height; v += 51) {
      const Eigen::Vector2d uv(u, v);
      largest = std::max({largest, (a.RectifyLeft(uv) - b.RectifyLeft(uv)).norm(),
                          (a.RectifyRight(uv) - b.RectifyRight(uv)).norm()});
    }
  }
  return largest;
}

TEST_F(OwnCameraTest, IsAsGoodAsRectifiedOriginals) {
  const ChainRun originals = RunChain({kLog, "on", true, {}});
  const double original_ate_m = originals.trajectory.ate_se3_m.rmse;
  const StereoRectifier expected(distorted_.rig());
  using Recording = std::unique_ptr<StereoRecording>;
  std::map<std::string, Recording> recordings;
  recordings["kalibr"] = Videos();
  recordings["opencv"] = Folders();
  recordings["ros"] = OneFolder();
  for (auto& [format, recording] : recordings) {
    SCOPED_TRACE(format + ", " + recording->name());
    ASSERT_EQ(recording->num_pairs(), static_cast<std::size_t>(originals.result.num_frames));
    const auto sequence = Open(std::move(recording), format);
    EXPECT_LT(LargestDifference_px(sequence->rectifier(), expected), 0.02);
    const ChainRun run = Run(*sequence);
    std::cout << "ATE, m: " << run.trajectory.ate_se3_m.rmse << " by " << format
              << ", of the originals " << original_ate_m << "\n";
    EXPECT_EQ(run.result.num_posed, originals.result.num_frames);
    EXPECT_TRUE(run.result.remarks.empty()) << run.result.remarks.front();
    EXPECT_EQ(run.trajectory.num_lost, originals.trajectory.num_lost);
    EXPECT_LT(run.trajectory.ate_se3_m.rmse, 2 * original_ate_m);
    EXPECT_GT(run.use.joints_seen, 0.8 * originals.use.joints_seen) << "the image shows less";
  }
}

// All that a user has: two videos and a calibration.
TEST_F(OwnCameraTest, PeopleMayBeFoundByTheNetworks) {
  if (!std::filesystem::exists(AIRDOS_BINARY_DIR "/networks/movenet-multipose.json")) {
    GTEST_SKIP() << "no networks in the build folder: launch_scripts/fetch_networks.sh";
  }
  const ChainRun originals = RunChain({kLog, "on", true, {}});
  const double original_ate_m = originals.trajectory.ate_se3_m.rmse;
  const auto sequence = Open(Videos(), "kalibr");
  const ChainRun run = Run(*sequence, true);
  std::cout << "ATE, m: " << run.trajectory.ate_se3_m.rmse << ", of the originals "
            << original_ate_m << "\n";
  EXPECT_EQ(run.result.num_posed, originals.result.num_frames);
  EXPECT_TRUE(run.result.remarks.empty()) << run.result.remarks.front();
  EXPECT_LT(run.trajectory.ate_se3_m.rmse, 2 * original_ate_m);
  EXPECT_GT(run.use.joints_seen, 0.3 * originals.use.joints_seen);
}

}  // namespace
}  // namespace airdos
