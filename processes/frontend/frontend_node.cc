#include "processes/frontend/frontend_node.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "common/human/body_mask.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/keypoint_messages.h"

namespace airdos {
namespace {

std::int8_t ToMessage(TrackingState state) {
  switch (state) {
    case TrackingState::kInitializing:
      return static_features_t::STATE_INITIALIZING;
    case TrackingState::kTracking:
      return static_features_t::STATE_TRACKING;
    case TrackingState::kWeak:
      return static_features_t::STATE_WEAK;
    case TrackingState::kCoasting:
      return static_features_t::STATE_COASTING;
  }
  return static_features_t::STATE_INVALID;
}

static_features_t ToMessage(const Header& header, std::int64_t odometry_start_seq,
                            const OdometryFrame& frame) {
  auto message = MessageOf<static_features_t>(header);
  message.tracking_state = ToMessage(frame.state);
  FromSe3(frame.T_O_C, message.position_O_C, message.orientation_O_C);
  message.odometry_start_seq = odometry_start_seq;
  FromSe3(frame.T_W_C, message.position_W_C, message.orientation_W_C);
  message.sigma_position_m = frame.prior_sigma_position_m;
  message.sigma_orientation_rad = frame.prior_sigma_orientation_rad;
  message.num_detected = frame.num_detected;
  message.num_masked = frame.num_masked;
  message.num_matched = frame.num_matched;
  message.num_features = static_cast<std::int32_t>(frame.sightings.size());
  for (const LandmarkSighting& sighting : frame.sightings) {
    message.landmark_id.push_back(sighting.id.value);
    message.u_left_px.push_back(static_cast<float>(sighting.uvu_px.x()));
    message.v_px.push_back(static_cast<float>(sighting.uvu_px.y()));
    message.u_right_px.push_back(static_cast<float>(sighting.uvu_px.z()));
    message.has_right.push_back(sighting.has_right);
    message.sigma_px.push_back(static_cast<float>(sighting.sigma_px));
  }
  return message;
}

/// The frame has no pose, and nothing was looked at.
static_features_t WithoutPose(const Header& header, std::int64_t odometry_start_seq) {
  static_features_t message = ToMessage(header, odometry_start_seq, OdometryFrame());
  message.tracking_state = static_features_t::STATE_INVALID;
  return message;
}

void AddTo(const map_update_t& part, MapCorrection* correction) {
  for (const frame_pose_t& frame : part.frames) {
    correction->frames.emplace_back(FrameId{frame.seq},
                                    ToSe3(frame.position_W_C, frame.orientation_W_C));
  }
  for (std::size_t i = 0; i < part.landmark_id.size(); ++i) {
    correction->landmarks_W_m.emplace_back(
        LandmarkId{part.landmark_id[i]},
        Eigen::Vector3d(part.x_W_m[i], part.y_W_m[i], part.z_W_m[i]));
  }
  for (const std::int64_t id : part.removed_landmark_id)
    correction->removed.push_back(LandmarkId{id});
}

}  // namespace

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
  if (options_.feedback_lag > 0) {
    Subscribe<map_update_t>(channel::kMapUpdate, [this](map_update_t&& message) {
      return ReceiveUpdate(std::move(message));
    });
  }
}

std::string FrontendNode::ReceiveUpdate(map_update_t&& message) {
  if (!session_ || message.session != *session_) return "of another session";
  const std::int64_t seq = message.seq;
  const bool is_expected = std::find(published_.begin(), published_.end(), seq) != published_.end();
  // The optimizer gave up a frame that is still to be published, so what that frame waits for got
  // lost. Only the next ones: no single wrong number may end the waiting.
  const std::int64_t ahead = published_.empty() ? 0 : seq - published_.back();
  if (ahead > 0 && ahead <= options_.feedback_lag) is_feedback_silent_ = true;
  if (!is_expected) return "too late, or of a frame that was not published";
  PartSet<map_update_t>& update = updates_[seq];
  const std::string refusal = update.Add(std::move(message));
  if (update.is_complete()) {
    newest_update_ = std::max(newest_update_, seq);
    is_feedback_silent_ = false;
  }
  return refusal;
}

std::optional<std::int64_t> FrontendNode::RequiredUpdate() const {
  const auto lag = static_cast<std::size_t>(options_.feedback_lag);
  if (options_.feedback_lag == 0 || published_.size() < lag) return std::nullopt;
  return published_[published_.size() - lag];
}

std::vector<std::string> FrontendNode::MissingFeedback(const Header& header) const {
  if (!session_ || header.session != *session_ || is_feedback_silent_) return {};
  const std::optional<std::int64_t> required = RequiredUpdate();
  if (!required || newest_update_ >= *required) return {};
  return {channel::kMapUpdate};
}

void FrontendNode::StartSession(const Header& header) {
  constexpr std::int64_t kMostPerFrame = 1000000;  // more than an image has corners
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

std::vector<PersonMeasurement> FrontendNode::People(const FrontendInputs& inputs) {
  std::vector<PersonMeasurement> people;
  if (!inputs.humans) return people;
  for (const human_observation_t& human : inputs.humans->humans) {
    PersonMeasurement person{HumanId{human.track_id}, {}};
    for (std::size_t i = 0; i < human.joint_id.size(); ++i) {
      PersonMeasurement::Joint joint;
      joint.joint = human.joint_id[i];
      joint.p_C = {human.x_C_m[i], human.y_C_m[i], human.z_C_m[i]};
      joint.covariance_C = ToCovariance(human.covariance_C[i]);
      const bool is_covariance =
          Eigen::LLT<Eigen::Matrix3d>(joint.covariance_C).info() == Eigen::Success;
      if (joint.p_C.allFinite() && joint.covariance_C.allFinite() && is_covariance) {
        person.joints.push_back(joint);
      }
    }
    people.push_back(std::move(person));
  }
  return people;
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
  // Images of other times are no pair, rectified or not; that is said of their numbers.
  constexpr std::int64_t kMaxApart_us = 20000;
  const bool is_pair = has_right && inputs.right->utime <= inputs.left->utime + kMaxApart_us &&
                       inputs.left->utime <= inputs.right->utime + kMaxApart_us;
  if (is_pair) watches_.input.AddPair(*left, *right);
  // A blank right image holds no corner: the landmarks are tracked in the left one alone.
  if (!has_right) right = cv::Mat::zeros(left->size(), CV_8UC1);
  return StereoImagePair{FrameId{header.seq},
                         static_cast<double>(header.utime - first_.utime) * 1e-6,
                         *left,
                         *right,
                         Mask(inputs),
                         People(inputs)};
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
  return ToMessage(header, first_.seq,
                   images ? odometry_->Process(camera(), *images)
                          : odometry_->Coast(FrameId{header.seq}, time_s));
}

void FrontendNode::ProcessFrame(const Header& header, FrontendInputs inputs) {
  ApplyUpdates();
  WatchNumbers(inputs);
  std::optional<StereoImagePair> images = Images(header, inputs);
  // Its time is that of another image: of a camera that counts otherwise, say.
  const bool is_new = images || (newest_utime_ && header.utime > *newest_utime_);
  static_features_t message = is_new ? Track(header, images) : WithoutPose(header, first_.seq);
  if (!Validate(message).empty()) {
    // Blind for so long that the motion before leads beyond all bounds: begin as after a restart.
    StartSession(header);
    if (images) images->time_s = 0;
    message = Track(header, images);
  }
  if (is_new) newest_utime_ = header.utime;
  for (const std::string& warning : watches_.input.TakeWarnings()) Warn(warning);
  Publish(channel::kStaticFeatures, message);
  published_.push_back(header.seq);
  if (published_.size() > static_cast<std::size_t>(std::max(options_.feedback_lag, 1))) {
    published_.erase(published_.begin());
  }
}

FrontendOptions ReadFrontendOptions(ConfigReader* config) {
  FrontendOptions options;
  VisualOdometryOptions& odometry = options.odometry;
  config->Read("masks.use", &options.use_masks);
  config->Read("masks.dilation_px", &options.mask_dilation_px, 0, 100);
  config->Read("feedback.lag_frames", &options.feedback_lag, 0, 20);
  config->Read("features.num_levels", &odometry.extractor.num_levels, 1, 12);
  config->Read("features.fast_threshold", &odometry.extractor.fast_threshold, 1, 100);
  config->Read("features.cell_size_px", &odometry.extractor.cell_size_px, 8, 256);
  config->Read("features.max_per_cell", &odometry.extractor.max_features_per_cell, 1, 100);
  config->Read("stereo.min_depth_m", &odometry.stereo.min_depth_m, 0.05, 100);
  config->Read("stereo.min_disparity_px", &odometry.stereo.min_disparity_px, 0.01, 50);
  config->Read("stereo.max_row_error_px", &odometry.stereo.max_row_error_px, 0.5, 10);
  config->Read("stereo.max_hamming_bits", &odometry.stereo.max_hamming, 1, 256);
  config->Read("stereo.min_correlation", &odometry.stereo.min_correlation, 0, 1);
  config->Read("stereo.rich_observations", &odometry.rich_observations, 1, 100000);
  config->Read("stereo.rich_min_correlation", &odometry.rich_min_correlation, 0, 1);
  config->Read("map.max_landmarks", &odometry.map.max_landmarks, 100, 100000);
  config->Read("map.max_frames_unconfirmed", &odometry.map.max_frames_unconfirmed, 1, 1000);
  config->Read("map.min_found_ratio", &odometry.map.min_found_ratio, 0, 1);
  config->Read("tracking.wide_radius_px", &odometry.wide_radius_px, 1, 500);
  config->Read("tracking.wide_max_hamming_bits", &odometry.wide_max_hamming, 1, 256);
  config->Read("tracking.narrow_max_hamming_bits", &odometry.narrow_max_hamming, 1, 256);
  config->Read("tracking.min_inliers_tracking", &odometry.min_inliers_tracking, 3, 1000);
  config->Read("tracking.min_inliers_weak", &odometry.min_inliers_weak, 1, 1000);
  config->Read("tracking.min_correlation", &odometry.min_correlation, 0, 1);
  config->Read("tracking.aligned_sigma_px", &odometry.aligned_sigma_px, 0.01, 10);
  config->Read("tracking.corner_sigma_px", &odometry.corner_sigma_px, 0.01, 10);
  config->Read("tracking.max_observations", &odometry.max_observations, 3, 5000);
  config->Read("tracking.observation_cell_px", &odometry.observation_cell_px, 4, 256);
  config->Read("motion.linear_start_m_s2", &odometry.motion.linear_start_m_s2, 1e-3, 1000);
  config->Read("motion.angular_start_rad_s2", &odometry.motion.angular_start_rad_s2, 1e-3, 1000);
  config->Read("motion.linear_floor_m_s2", &odometry.motion.linear_floor_m_s2, 1e-3, 1000);
  config->Read("motion.linear_ceiling_m_s2", &odometry.motion.linear_ceiling_m_s2, 1e-3, 1000);
  config->Read("motion.angular_floor_rad_s2", &odometry.motion.angular_floor_rad_s2, 1e-3, 1000);
  config->Read("motion.angular_ceiling_rad_s2", &odometry.motion.angular_ceiling_rad_s2, 1e-3,
               1000);
  config->Read("motion.initial_speed_m_s", &odometry.motion.initial_speed_m_s, 1e-3, 1000);
  config->Read("motion.initial_turn_rad_s", &odometry.motion.initial_turn_rad_s, 1e-3, 1000);
  config->Read("motion.memory_s", &odometry.motion.memory_s, 0.01, 1e6);
  config->Read("people.use", &options.use_people);
  config->Read("people.min_keypoint_confidence", &options.min_keypoint_confidence, 0, 1);
  config->Read("people.max_static", &odometry.max_static_for_people, 0, 10000);
  config->Read("people.acceleration_m_s2", &odometry.people.acceleration_m_s2, 1e-3, 100);
  config->Read("people.initial_speed_m_s", &odometry.people.initial_speed_m_s, 1e-3, 100);
  config->Read("people.wobble_m", &odometry.people.wobble_m, 1e-4, 10);
  config->Read("people.max_joint_sigmas", &odometry.people.max_joint_sigmas, 0.1, 100);
  config->Read("people.max_missed_frames", &odometry.people.max_missed_frames, 0, 1000);
  config->Read("people.min_seen_frames", &odometry.people.min_seen_frames, 1, 1000);
  return options;
}

std::unique_ptr<Node> MakeFrontendNode(ConfigReader* config) {
  return std::make_unique<FrontendNode>(ReadFrontendOptions(config));
}

}  // namespace airdos
