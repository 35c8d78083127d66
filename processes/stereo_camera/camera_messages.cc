#include "processes/stereo_camera/camera_messages.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/dataset/image_file.h"
#include "common/util/check.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/conversions.h"

namespace airdos {
namespace {

constexpr std::int64_t kCalibrationPeriod_us = 1000000;
constexpr std::int64_t kTryBetterEvery = 30;  // pairs
constexpr char kHowToExamine[] =
    "the calibration does not fit the camera, look at it with airdos-calibration check FILE "
    "--images LEFT RIGHT";

cv::Mat Grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace

CameraMessages::CameraMessages(const StereoRectifier* rectifier,
                               const CameraMessageOptions& options)
    : rectifier_(rectifier), rows_(kHowToExamine), options_(options) {
  AIRDOS_CHECK(!options.jpeg_qualities.empty());
  next_.session = options.session;
}

std::vector<std::string> CameraMessages::TakeNotes() { return std::exchange(notes_, {}); }

void CameraMessages::WatchRows(const cv::Mat& left, const cv::Mat& right) {
  if (!rows_.IsDue()) return;
  rows_.Add(Grey(left), Grey(right));
  for (const std::string& warning : rows_.TakeWarnings()) notes_.push_back("warning: " + warning);
}

std::optional<std::vector<std::uint8_t>> CameraMessages::AsJpeg(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  for (; quality_ < options_.jpeg_qualities.size(); ++quality_) {
    const int quality = options_.jpeg_qualities[quality_];
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    if (static_cast<int>(bytes.size()) > options_.max_image_bytes) continue;
    if (quality_ > worst_said_) {
      worst_said_ = quality_;
      notes_.push_back("images are encoded as JPEG with quality " + std::to_string(quality) +
                       " to fit into " + std::to_string(options_.max_image_bytes) + " bytes");
    }
    return bytes;
  }
  quality_ = options_.jpeg_qualities.size() - 1;
  if (!is_misfit_said_) {
    notes_.push_back("warning: an image does not fit into " +
                     std::to_string(options_.max_image_bytes) +
                     " bytes at any of the JPEG qualities: left out, as are others like it");
  }
  is_misfit_said_ = true;
  return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> CameraMessages::Encoded(const cv::Mat& image) {
  if (!options_.is_lossless) return AsJpeg(image);
  std::vector<std::uint8_t> bytes = EncodePng(image);
  if (static_cast<int>(bytes.size()) > options_.max_image_bytes && !is_large_said_) {
    is_large_said_ = true;
    notes_.push_back("PNG images above the limit: receivers need a large socket buffer");
  }
  return bytes;
}

void CameraMessages::AddImage(const char* channel, const cv::Mat& image,
                              std::vector<std::uint8_t> bytes,
                              std::vector<Envelope>* messages) const {
  auto message = MessageOf<image_t>(next_);
  message.width = image.cols;
  message.height = image.rows;
  message.encoding = options_.is_lossless ? image_t::ENCODING_PNG : image_t::ENCODING_JPEG;
  message.num_bytes = static_cast<std::int32_t>(bytes.size());
  message.data = std::move(bytes);
  messages->push_back({channel, Encode(message)});
}

void CameraMessages::AddCalibrationIfDue(std::vector<Envelope>* messages) {
  if (calibration_utime_ && next_.utime - *calibration_utime_ < kCalibrationPeriod_us) return;
  calibration_utime_ = next_.utime;
  auto message = MessageOf<stereo_calibration_t>(next_);
  FromStereoCamera(rectifier_->camera(), &message);
  messages->push_back({channel::kCalibration, Encode(message)});
}

void CameraMessages::AddNobody(std::vector<Envelope>* messages) const {
  auto keypoints = MessageOf<person_keypoints_t>(next_);
  keypoints.layout = person_keypoints_t::LAYOUT_COCO17;
  messages->push_back({channel::kPersonKeypointsLeft, Encode(keypoints)});
  messages->push_back({channel::kPersonKeypointsRight, Encode(keypoints)});
  auto mask = MessageOf<person_mask_t>(next_);
  mask.encoding = person_mask_t::ENCODING_NONE;
  mask.width = rectifier_->camera().width;
  mask.height = rectifier_->camera().height;
  messages->push_back({channel::kPersonMask, Encode(mask)});
}

std::vector<Envelope> CameraMessages::Pack(const CapturedPair& pair) {
  if (quality_ > 0 && num_packed_ % kTryBetterEvery == 0) --quality_;
  const cv::Mat left = rectifier_->Left(pair.left);
  const cv::Mat right = rectifier_->Right(pair.right);
  WatchRows(left, right);
  std::optional<std::vector<std::uint8_t>> left_bytes = Encoded(left);
  if (!left_bytes) return {};
  std::optional<std::vector<std::uint8_t>> right_bytes = Encoded(right);
  if (!right_bytes) return {};
  next_.utime = pair.utime;
  std::vector<Envelope> messages;
  AddCalibrationIfDue(&messages);
  AddImage(channel::kCameraLeft, left, std::move(*left_bytes), &messages);
  AddImage(channel::kCameraRight, right, std::move(*right_bytes), &messages);
  if (options_.publishes_nobody) AddNobody(&messages);
  newest_ = next_;
  ++next_.seq;
  ++num_packed_;
  return messages;
}

}  // namespace airdos
