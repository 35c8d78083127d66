#include "processes/frontend/frontend_node.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/human/body_mask.h"
#include "processes/frontend/frontend_messages.h"
#include "processes/node/message/figures.h"
#include "processes/node/message/header.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/keypoint_messages.h"

namespace airdos {

FrontendNode::FrontendNode(const FrontendOptions& options)
    : FrameNode("frontend"), options_(options) {
  Join<image_t>(channel::kCameraLeft, &FrontendInputs::left);
  Join<image_t>(channel::kCameraRight, &FrontendInputs::right);
  if (options_.use_people) {
    Join<human_observations_t>(channel::kHumanObservations, &FrontendInputs::humans);
    Join<person_keypoints_t>(channel::kPersonKeypointsLeft, &FrontendInputs::keypoints);
  }
  if (options_.use_masks) Join<person_mask_t>(channel::kPersonMask, &FrontendInputs::mask);
  JoinCalibration();
  DeclareOutput(channel::kStaticFeatures);
  if (options_.feedback_lag_frames > 0) {
    Subscribe<map_update_t>(channel::kMapUpdate, [this](map_update_t&& message) {
      return ReceiveUpdate(std::move(message));
    });
  }
}

std::string FrontendNode::ReceiveUpdate(map_update_t&& message) {
  if (!session_ || message.session != *session_) return "of another session";
  const std::int64_t seq = message.seq;
  const bool is_expected = std::find(published_.begin(), published_.end(), seq) != published_.end();
  // The optimizer has given up a frame that is yet to be published, so whatever that frame waits
  // for was lost. Only for the next few frames: a single wrong number must not end the waiting.
  const std::int64_t ahead = published_.empty() ? 0 : seq - published_.back();
  if (ahead > 0 && ahead <= options_.feedback_lag_frames) is_feedback_silent_ = true;
  if (!is_expected) return "too late, or for a frame that was not published";
  PartSet<map_update_t>& update = updates_[seq];
  const std::string refusal = update.Add(std::move(message));
  if (update.is_complete()) {
    newest_update_ = std::max(newest_update_, seq);
    is_feedback_silent_ = false;
  }
  return refusal;
}

std::optional<std::int64_t> FrontendNode::RequiredUpdate() const {
  const auto lag = static_cast<std::size_t>(options_.feedback_lag_frames);
  if (options_.feedback_lag_frames == 0 || published_.size() < lag) return std::nullopt;
  return published_[published_.size() - lag];
}

std::vector<std::string> FrontendNode::MissingFeedback(const Header& header) const {
  if (!session_ || header.session != *session_ || is_feedback_silent_) return {};
  const std::optional<std::int64_t> required = RequiredUpdate();
  if (!required || newest_update_ >= *required) return {};
  return {channel::kMapUpdate};
}

void FrontendNode::StartSession(const Header& header) {
  constexpr std::int64_t kMostPerFrame = 1000000;  // an image has fewer corners
  odometry_ = std::make_unique<VisualOdometry>(
      options_.odometry, LandmarkId{FirstRunningNumber(header.seq, kMostPerFrame)});
  first_ = header;
  if (!session_ || *session_ != header.session) {
    newest_utime_.reset();
    watches_ = Watches();
  }
  session_ = header.session;
  published_.clear();
  updates_.clear();
  newest_update_ = -1;
  is_feedback_silent_ = false;
}

void FrontendNode::ApplyUpdates() {
  const std::optional<std::int64_t> required = RequiredUpdate();
  if (!required) return;
  if (newest_update_ < *required) is_feedback_silent_ = true;
  const auto of_required = updates_.find(*required);
  if (of_required == updates_.end() || !of_required->second.is_complete()) {
    ++counters(channel::kMapUpdate).num_missing;
  }
  while (!updates_.empty() && updates_.begin()->first <= *required) {
    auto& [seq, update] = *updates_.begin();
    if (update.is_complete()) {
      MapCorrection correction;
      correction.newest = FrameId{seq};
      for (const map_update_t& part : update.Take()) AddTo(part, &correction);
      odometry_->Apply(correction);
    }
    updates_.erase(updates_.begin());
  }
}

cv::Mat FrontendNode::Mask(const FrontendInputs& inputs) {
  cv::Mat mask;
  if (inputs.mask && inputs.mask->encoding != person_mask_t::ENCODING_NONE) {
    std::string reason;
    const std::optional<cv::Mat> decoded = DecodeMask(*inputs.mask, &reason);
    if (Fits(decoded, channel::kPersonMask, reason)) mask = *decoded;
  }
  const std::vector<BodyKeypoints> people =
      inputs.keypoints ? ToPeople(*inputs.keypoints) : std::vector<BodyKeypoints>();
  if (!mask.empty()) watches_.input.AddMask(mask, people);
  if (mask.empty() && inputs.keypoints) {
    mask =
        DrawBodyMask(people, {camera().width, camera().height}, options_.min_keypoint_confidence);
  }
  if (mask.empty()) return mask;
  const int diameter = 2 * options_.mask_dilation_px + 1;
  cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {diameter, diameter}));
  return mask;
}

std::optional<StereoImagePair> FrontendNode::Images(const Header& header,
                                                    const FrontendInputs& inputs) {
  if (!inputs.left) return std::nullopt;
  std::string reason_left;
  std::string reason_right;
  const std::optional<cv::Mat> left = DecodeGray(*inputs.left, &reason_left);
  std::optional<cv::Mat> right;
  if (inputs.right) right = DecodeGray(*inputs.right, &reason_right);
  const bool has_right = inputs.right && Fits(right, channel::kCameraRight, reason_right);
  if (!Fits(left, channel::kCameraLeft, reason_left)) return std::nullopt;
  // Images taken at different times are no stereo pair, rectified or not; WatchNumbers() warns of
  // them.
  constexpr std::int64_t kMaxApart_us = 20000;
  const bool is_pair = has_right && inputs.right->utime <= inputs.left->utime + kMaxApart_us &&
                       inputs.left->utime <= inputs.right->utime + kMaxApart_us;
  if (is_pair) WatchPair(*left, *right);
  // A blank right image has no corners, so landmarks are tracked in the left image only.
  if (!has_right) right = cv::Mat::zeros(left->size(), CV_8UC1);
  return StereoImagePair{
      FrameId{header.seq},
      static_cast<double>(header.utime - first_.utime) * 1e-6,
      *left,
      *right,
      Mask(inputs),
      inputs.humans ? ToHumanMeasurements(*inputs.humans) : std::vector<HumanMeasurement>()};
}

void FrontendNode::WatchPair(const cv::Mat& left, const cv::Mat& right) {
  watches_.input.AddPair(left, right);
  const std::optional<double> row_error_px = watches_.input.row_error_px();
  if (row_error_px) {
    counters(figure::kRowError_millipx).num_received = std::llround(1e3 * *row_error_px);
  }
}

void FrontendNode::WatchNumbers(const FrontendInputs& inputs) {
  if (!inputs.left) return;
  const Header left = HeaderOf(*inputs.left);
  const StrayWatch& left_numbers = numbers_of(channel::kCameraLeft);
  const auto watch = [&](const auto& partner, const char* channel, PartnerWatch* numbers) {
    std::optional<Header> header;
    if (partner) header = HeaderOf(*partner);
    const std::string warning = numbers->Add(left, header, left_numbers, numbers_of(channel));
    if (!warning.empty()) Warn(warning);
  };
  watch(inputs.right, channel::kCameraRight, &watches_.right);
  if (options_.use_masks) watch(inputs.mask, channel::kPersonMask, &watches_.mask);
  if (options_.use_people) {
    watch(inputs.keypoints, channel::kPersonKeypointsLeft, &watches_.keypoints);
  }
  watches_.input.AddTime(left.utime);
}

static_features_t FrontendNode::Track(const Header& header,
                                      const std::optional<StereoImagePair>& images) {
  const double time_s = static_cast<double>(header.utime - first_.utime) * 1e-6;
  return ToStaticFeatures(header, first_.seq,
                          images ? odometry_->Process(camera(), *images)
                                 : odometry_->Coast(FrameId{header.seq}, time_s));
}

void FrontendNode::ProcessFrame(const Header& header, FrontendInputs inputs) {
  ApplyUpdates();
  WatchNumbers(inputs);
  std::optional<StereoImagePair> images = Images(header, inputs);
  // Otherwise its time belongs to another image, for example of a camera with a different
  // numbering.
  const bool is_new = images || (newest_utime_ && header.utime > *newest_utime_);
  static_features_t message =
      is_new ? Track(header, images) : UnknownStaticFeatures(header, first_.seq);
  if (!Validate(message).empty()) {
    // After too many frames without images, the predicted pose exceeds all bounds: start afresh, as
    // after a restart.
    StartSession(header);
    if (images) images->time_s = 0;
    message = Track(header, images);
  }
  if (is_new) newest_utime_ = header.utime;
  for (const std::string& warning : watches_.input.TakeWarnings()) Warn(warning);
  Publish(channel::kStaticFeatures, message);
  published_.push_back(header.seq);
  if (published_.size() > static_cast<std::size_t>(std::max(options_.feedback_lag_frames, 1))) {
    published_.erase(published_.begin());
  }
}

std::unique_ptr<Node> MakeFrontendNode(ConfigReader* config) {
  return std::make_unique<FrontendNode>(ReadFrontendOptions(config));
}

}  // namespace airdos
