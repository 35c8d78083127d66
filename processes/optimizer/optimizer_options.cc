#include "processes/optimizer/optimizer_options.h"

namespace airdos {
namespace {

constexpr double kMinSigma = 1e-6;

void AddPeopleFactors(SlidingWindowOptions* window, OptionTable* table) {
  BundleOptions* bundle = &window->bundle;
  table->Add("people.rigidity", &bundle->use_rigidity, "segments keep their length (eq. 3)");
  table->Add("people.motion", &bundle->use_motion, "joints follow a shared motion (eq. 4, 5)");
  table->AddChoice<MotionForm>(
      "people.motion_form", &bundle->motion_form,
      {{"velocity", MotionForm::kVelocity,
        "torso and head share one velocity per frame pair, smoothed over time"},
       {"velocity_track", MotionForm::kVelocityTrack,
        "one velocity per person over the whole window"},
       {"se3_parts", MotionForm::kSe3Parts,
        "the paper's form, one rigid motion per rigid part and frame pair"}});
}

void AddPeopleRange(HumanTracksOptions* people, OptionTable* table) {
  table->Add("people.window_frames", &people->window_frames, {2, 100}, "frames",
             "the newest, whose people are in the adjustment; at most window.frames");
  table->Add("people.forget_after_frames", &people->forget_after_frames, {1, 1000000}, "frames",
             "segment lengths of a person not seen for longer are forgotten");
  table->Add("people.min_disparity_px", &people->min_disparity_px, {0.01, 100}, "px",
             "a joint with less disparity is left out");
  table->Add("people.max_depth_m", &people->max_depth_m, {0.1, 1e4}, "m",
             "a joint further away is left out");
}

void AddPeopleNoise(SlidingWindowOptions* window, OptionTable* table) {
  BundleOptions* bundle = &window->bundle;
  table->Add("people.huber_sigmas", &bundle->huber_dynamic_sigmas, {kMinSigma, 1e6}, "sigmas",
             "Huber kernel of joints, rigidity and motion");
  table->Add("people.rigidity_sigma_m", &bundle->rigidity_sigma_m, {kMinSigma, 100}, "m",
             "how well a segment keeps its length");
  table->Add("people.segment_length_sigma_m", &bundle->segment_length_sigma_m, {kMinSigma, 100},
             "m", "how well a length told by the track holds, on top of how well it was told");
  table->Add("people.motion_sigma_m", &bundle->motion_sigma_m, {kMinSigma, 100}, "m",
             "how well a joint follows the shared motion");
  table->Add("people.learn_track_noise", &window->learn_track_noise,
             "how steadily each person moves is learnt; motion_sigma_m and "
             "person_acceleration_m_s2 are where it starts");
  table->Add("people.motion_max_gap_s", &bundle->motion_max_gap_s, {0, 100}, "s",
             "no motion across a longer gap in a track");
  table->Add("people.person_acceleration_m_s2", &bundle->person_acceleration_m_s2, {kMinSigma, 1e4},
             "m/s^2", "how much a person's velocity changes (motion_form: velocity)");
  table->Add("people.person_speed_m_s", &bundle->person_speed_m_s, {0, 1000}, "m/s",
             "how fast people are (motion_form: velocity); 0: not known");
  table->Add("people.free_rotation_sigma_rad", &bundle->free_rotation_sigma_rad, {kMinSigma, 100},
             "rad", "damping of the rotation that two points leave free (motion_form: se3_parts)");
  table->Add("people.reject_joint_sigmas", &bundle->reject_joint_sigmas, {kMinSigma, 1e9}, "sigmas",
             "a joint observation with more error is rejected");
  table->Add("people.reject_rigidity_sigmas", &bundle->reject_rigidity_sigmas, {kMinSigma, 1e9},
             "sigmas", "a segment whose length is further off is rejected");
  table->Add("people.reject_motion_sigmas", &bundle->reject_motion_sigmas, {kMinSigma, 1e9},
             "sigmas", "a joint further from the shared motion is rejected");
}

void AddPeople(OptimizerOptions* options, OptionTable* table) {
  table->AddSection("people");
  table->AddChoice<PeopleMode>(
      "people.mode", &options->people,
      {{"off", PeopleMode::kOff, "people are ignored"},
       {"mask_only", PeopleMode::kMaskOnly,
        "they only mask static features (the frontend does); here the same as off"},
       {"on", PeopleMode::kOn, "their joints are part of the adjustment"}});
  AddPeopleFactors(&options->window, table);
  AddPeopleRange(&options->window.people, table);
  AddPeopleNoise(&options->window, table);
}

void AddTrust(TrustOptions* trust, OptionTable* table) {
  table->AddSection("trust", "when the camera pose with people is believed over the one without");
  table->Add("trust.min_static_observations", &trust->min_static_observations, {0, 100000},
             "observations", "never where the newest frame has this many static ones or more");
  table->Add("trust.min_motion_factors", &trust->min_motion_factors, {1, 1000000}, "factors",
             "people must bring this many of motion ...");
  table->Add("trust.max_rejected_share", &trust->max_rejected_share, {0, 1}, "0..1",
             "... of which at most this share was rejected ...");
  table->Add("trust.max_relative_sigma", &trust->max_relative_sigma, {0, 1}, "0..1",
             "... bring the position's sigma down to this share of that without them ...");
  table->Add("trust.max_shift_chi2", &trust->max_shift_chi2, {0, 1e12}, "squared sigmas",
             "... and shift the pose by at most this (Mahalanobis distance, 6 dof)");
}

void AddWindow(WindowMapOptions* map, OptionTable* table) {
  table->AddSection("window");
  table->Add("window.frames", &map->window_frames, {2, 100}, "frames",
             "the newest, whose poses are free");
  table->Add("window.max_fixed_key_frames", &map->max_fixed_key_frames, {0, 100}, "key frames",
             "older ones that share most with the window, held fixed");
  table->Add("window.min_shared_landmarks", &map->min_shared_landmarks, {1, 10000}, "landmarks",
             "a key frame that shares fewer with the window is not used");
  table->Add("window.key_frame_max_shared", &map->key_frame_max_shared, {0, 1}, "0..1",
             "share of landmarks with the last key frame below which a frame becomes one");
  table->Add("window.key_frame_interval", &map->key_frame_interval, {1, 1000}, "frames",
             "there is another key frame after this many at the latest");
  table->Add("window.max_key_frames", &map->max_key_frames, {1, 10000}, "key frames",
             "at most this many are kept in memory");
  table->Add("window.forget_after_frames", &map->forget_after_frames, {1, 1000000}, "frames",
             "a landmark in no kept frame that was not seen for longer is forgotten");
  table->Add("window.min_disparity_px", &map->min_disparity_px, {0.01, 100}, "px",
             "an observation with less disparity cannot start a landmark");
  table->Add("window.max_rejections", &map->max_rejections, {1, 100}, "adjustments",
             "an observation rejected in this many in a row is dropped for good");
}

void AddSolver(BundleOptions* bundle, OptionTable* table) {
  table->AddSection("solver");
  table->AddChoice<BundleSolver>(
      "solver.method", &bundle->solver,
      {{"structured", BundleSolver::kStructured, "our own, made for these graphs"},
       {"ceres", BundleSolver::kCeres, "the reference: same steps, slower"}});
  table->Add("solver.max_iterations", &bundle->max_iterations, {1, 1000}, "iterations",
             "of Levenberg-Marquardt before outliers are rejected");
  table->Add("solver.max_iterations_after_rejection", &bundle->max_iterations_after_rejection,
             {0, 1000}, "iterations", "after it; 0: no outlier is rejected");
  table->Add("solver.function_tolerance", &bundle->function_tolerance, {0, 1}, "",
             "relative change of cost that ends a pass");
  table->Add("solver.huber_static_sigmas", &bundle->huber_static_sigmas, {kMinSigma, 1e6}, "sigmas",
             "Huber kernel of landmark observations");
  table->Add("solver.reject_static_sigmas", &bundle->reject_static_sigmas, {kMinSigma, 1e9},
             "sigmas", "a landmark observation with more error is rejected");
}

void AddRest(SlidingWindowOptions* window, OptionTable* table) {
  table->AddSection("camera_motion");
  table->Add("camera_motion.use_acceleration", &window->camera_motion.use_acceleration,
             "factor on the change of velocity between three consecutive frames");
  table->Add("camera_motion.sigma_factor", &window->camera_motion.sigma_factor, {0, 1000}, "times",
             "its sigma, relative to the one that the frontend predicts with (STATIC_FEATURES)");
  table->AddSection("output");
  table->Add("output.publish_moved_m", &window->publish_moved_m, {0, 1}, "m",
             "a landmark that moved less since it was last published is left out of MAP_UPDATE");
}

}  // namespace

OptionTable TableOf(OptimizerOptions* options) {
  OptionTable table(
      "optimizer",
      "airdos-optimizer: bundle adjustment on every frame. Sigmas are standard deviations.");
  AddPeople(options, &table);
  AddTrust(&options->window.trust, &table);
  AddWindow(&options->window.map, &table);
  AddSolver(&options->window.bundle, &table);
  AddRest(&options->window, &table);
  table.SetRenamed({
      {"people.huber", "people.huber_sigmas"},
      {"people.eliminate_joint", "people.reject_joint_sigmas"},
      {"people.eliminate_rigidity", "people.reject_rigidity_sigmas"},
      {"people.eliminate_motion", "people.reject_motion_sigmas"},
      {"trust.max_eliminated_share", "trust.max_rejected_share"},
      {"window.max_eliminations", "window.max_rejections"},
      {"solver.max_iterations_after_elimination", "solver.max_iterations_after_rejection"},
      {"solver.huber_static", "solver.huber_static_sigmas"},
      {"solver.eliminate_static", "solver.reject_static_sigmas"},
  });
  return table;
}

OptimizerOptions ReadOptimizerOptions(ConfigReader* config) {
  OptimizerOptions options = ReadOptions<OptimizerOptions>(config);
  options.window.bundle.use_people = options.people == PeopleMode::kOn;
  return options;
}

}  // namespace airdos
