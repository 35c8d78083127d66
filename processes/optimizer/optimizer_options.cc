#include "processes/optimizer/optimizer_options.h"

namespace airdos {
namespace {

constexpr double kMinSigma = 1e-6;

void ReadMap(ConfigReader* config, WindowMapOptions* map) {
  config->Read("window.frames", &map->window_frames, 2, 100);
  config->Read("window.max_fixed_key_frames", &map->max_fixed_key_frames, 0, 100);
  config->Read("window.min_shared_landmarks", &map->min_shared_landmarks, 1, 10000);
  config->Read("window.key_frame_max_shared", &map->key_frame_max_shared, 0, 1);
  config->Read("window.key_frame_interval", &map->key_frame_interval, 1, 1000);
  config->Read("window.max_key_frames", &map->max_key_frames, 1, 10000);
  config->Read("window.forget_after_frames", &map->forget_after_frames, 1, 1000000);
  config->Read("window.min_disparity_px", &map->min_disparity_px, 0.01, 100);
  config->Read("window.max_rejections", &map->max_rejections, 1, 100);
}

void ReadSolver(ConfigReader* config, BundleOptions* bundle) {
  bundle->solver =
      static_cast<BundleSolver>(config->ReadChoice("solver.method", {"structured", "ceres"}));
  config->Read("solver.max_iterations", &bundle->max_iterations, 1, 1000);
  config->Read("solver.max_iterations_after_rejection", &bundle->max_iterations_after_rejection, 0,
               1000);
  config->Read("solver.function_tolerance", &bundle->function_tolerance, 0, 1);
  config->Read("solver.huber_static_sigmas", &bundle->huber_static_sigmas, kMinSigma, 1e6);
  config->Read("solver.reject_static_sigmas", &bundle->reject_static_sigmas, kMinSigma, 1e9);
}

void ReadCameraMotion(ConfigReader* config, CameraMotionOptions* motion) {
  config->Read("camera_motion.use_acceleration", &motion->use_acceleration);
  config->Read("camera_motion.sigma_factor", &motion->sigma_factor, 0, 1000);
}

void ReadPeople(ConfigReader* config, SlidingWindowOptions* window) {
  BundleOptions* bundle = &window->bundle;
  config->Read("people.rigidity", &bundle->use_rigidity);
  config->Read("people.motion", &bundle->use_motion);
  bundle->motion_form = static_cast<MotionForm>(
      config->ReadChoice("people.motion_form", {"velocity", "velocity_track", "se3_parts"}));
  config->Read("people.window_frames", &window->people.window_frames, 2, 100);
  config->Read("people.forget_after_frames", &window->people.forget_after_frames, 1, 1000000);
  config->Read("people.min_disparity_px", &window->people.min_disparity_px, 0.01, 100);
  config->Read("people.max_depth_m", &window->people.max_depth_m, 0.1, 1e4);
  config->Read("people.huber_sigmas", &bundle->huber_dynamic_sigmas, kMinSigma, 1e6);
  config->Read("people.rigidity_sigma_m", &bundle->rigidity_sigma_m, kMinSigma, 100);
  config->Read("people.segment_length_sigma_m", &bundle->segment_length_sigma_m, kMinSigma, 100);
  config->Read("people.motion_sigma_m", &bundle->motion_sigma_m, kMinSigma, 100);
  config->Read("people.motion_max_gap_s", &bundle->motion_max_gap_s, 0, 100);
  config->Read("people.learn_track_noise", &window->learn_track_noise);
  config->Read("people.person_speed_m_s", &bundle->person_speed_m_s, 0, 1000);
  config->Read("people.person_acceleration_m_s2", &bundle->person_acceleration_m_s2, kMinSigma,
               1e4);
  config->Read("people.free_rotation_sigma_rad", &bundle->free_rotation_sigma_rad, kMinSigma, 100);
  config->Read("people.reject_joint_sigmas", &bundle->reject_joint_sigmas, kMinSigma, 1e9);
  config->Read("people.reject_rigidity_sigmas", &bundle->reject_rigidity_sigmas, kMinSigma, 1e9);
  config->Read("people.reject_motion_sigmas", &bundle->reject_motion_sigmas, kMinSigma, 1e9);
}

void ReadTrust(ConfigReader* config, TrustOptions* trust) {
  config->Read("trust.min_static_observations", &trust->min_static_observations, 0, 100000);
  config->Read("trust.min_motion_factors", &trust->min_motion_factors, 1, 1000000);
  config->Read("trust.max_rejected_share", &trust->max_rejected_share, 0, 1);
  config->Read("trust.max_relative_sigma", &trust->max_relative_sigma, 0, 1);
  config->Read("trust.max_shift_chi2", &trust->max_shift_chi2, 0, 1e12);
}

}  // namespace

OptimizerOptions ReadOptimizerOptions(ConfigReader* config) {
  OptimizerOptions options;
  options.people =
      static_cast<PeopleMode>(config->ReadChoice("people.mode", {"off", "mask_only", "on"}));
  ReadMap(config, &options.window.map);
  ReadSolver(config, &options.window.bundle);
  ReadCameraMotion(config, &options.window.camera_motion);
  ReadPeople(config, &options.window);
  ReadTrust(config, &options.window.trust);
  config->Read("output.publish_moved_m", &options.window.publish_moved_m, 0, 1);
  options.window.bundle.use_people = options.people == PeopleMode::kOn;
  return options;
}

}  // namespace airdos
