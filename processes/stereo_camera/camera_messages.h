#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_MESSAGES_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_MESSAGES_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/calibration/stereo_rectifier.h"
#include "common/check/row_watch.h"
#include "processes/node/message/header.h"
#include "processes/node/node.h"
#include "processes/stereo_camera/frame_grabber.h"

namespace airdos {

/// What the messages of a camera hold.
struct CameraMessageOptions {
  int max_image_bytes = 120000;
  std::vector<int> jpeg_qualities = {95, 92, 90, 85, 80, 70, 60, 50, 40, 30};  ///< best first
  bool is_lossless = false;       ///< PNG instead, whatever the size
  bool publishes_nobody = false;  ///< empty messages on the channels of people
  std::int64_t session = 0;
};

/// Rectifies pairs and makes them messages, as docs/clients.md wants them of a camera driver:
/// images are counted without gaps, the calibration comes first and then once a second of capture
/// time. No clock, no LCM; the same pairs give the same bytes.
///
/// An image is encoded with the quality that the one before needed to fit, and now and then a
/// better one is tried: trying all of them each time would cost more than the rest.
class CameraMessages {
 public:
  /// The rectifier is not owned.
  CameraMessages(const StereoRectifier* rectifier, const CameraMessageOptions& options);

  /// Nothing for a pair that does not fit at any quality; a note says so. Throws InputError where
  /// the images are not of the rig's size.
  std::vector<Envelope> Pack(const CapturedPair& pair);
  /// Of the pair packed last.
  const std::optional<Header>& newest() const { return newest_; }
  std::int64_t num_packed() const { return num_packed_; }
  /// For the user; also what RowWatch warns of, as nobody checks a camera before it runs.
  std::vector<std::string> TakeNotes();

 private:
  void WatchRows(const cv::Mat& left, const cv::Mat& right);
  std::optional<std::vector<std::uint8_t>> Encoded(const cv::Mat& image);
  std::optional<std::vector<std::uint8_t>> AsJpeg(const cv::Mat& image);
  void AddImage(const char* channel, const cv::Mat& image, std::vector<std::uint8_t> bytes,
                std::vector<Envelope>* messages) const;
  void AddCalibrationIfDue(std::vector<Envelope>* messages);
  void AddNobody(std::vector<Envelope>* messages) const;

  const StereoRectifier* rectifier_;
  RowWatch rows_;  // of the rectified images
  CameraMessageOptions options_;
  Header next_;
  std::optional<Header> newest_;
  std::int64_t num_packed_ = 0;
  std::optional<std::int64_t> calibration_utime_;
  std::size_t quality_ = 0;  // index of the one in use
  std::size_t worst_said_ = 0;
  bool is_large_said_ = false;
  bool is_misfit_said_ = false;
  std::vector<std::string> notes_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_MESSAGES_H_
