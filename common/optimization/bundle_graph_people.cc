#include <Eigen/Core>
#include <cmath>

#include "common/optimization/bundle_graph.h"
#include "common/optimization/human_factors.h"

namespace airdos {
namespace {

/// The joints that share one velocity: torso and head. Limbs swing.
constexpr std::array<int, 6> kBodyJoints = {kNeck,     kRightShoulder, kLeftShoulder,
                                            kRightHip, kLeftHip,       kNose};

using Pair = std::pair<BundleProblem::JointState*, BundleProblem::JointState*>;

/// The joints of `wanted` (-1: none) that were seen before and after.
template <class Joints, class Sighting>
std::vector<Pair> SharedJoints(const Joints& wanted, const Sighting& before,
                               const Sighting& after) {
  std::vector<Pair> shared;
  for (const int joint : wanted) {
    if (joint < 0) continue;
    const auto j = static_cast<std::size_t>(joint);
    if (before.joints[j] != nullptr && after.joints[j] != nullptr) {
      shared.emplace_back(before.joints[j], after.joints[j]);
    }
  }
  return shared;
}

Eigen::Vector3d Centroid(const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [before, after] : pairs) sum += before->p_W;
  return sum / static_cast<double>(pairs.size());
}

Eigen::Vector3d MeanStep(const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [before, after] : pairs) sum += after->p_W - before->p_W;
  return sum / static_cast<double>(pairs.size());
}

}  // namespace

void BundleGraph::AddHuman(BundleProblem::Human* human) {
  if (human->joints.empty()) return;
  ++summary_.num_people;
  for (JointState& joint : human->joints) {
    people_blocks_.push_back(joint.p_W.data());
    AddReprojection(&joint, /*has_right=*/true, joint.p_W.data(), Kind::kJoint);
  }
  const std::vector<Sighting> sightings = Sightings(human);
  if (options_.use_rigidity) AddRigidity(sightings, human);
  if (!options_.use_motion) return;
  if (options_.motion_form != MotionForm::kSe3Parts) {
    AddVelocities(sightings, human);
    return;
  }
  for (std::size_t i = 1; i < sightings.size(); ++i) {
    if (StepBetween(sightings[i - 1], sightings[i]) > 0) {
      AddPartMotions(sightings[i - 1], sightings[i], human);
    }
  }
}

std::vector<BundleGraph::Sighting> BundleGraph::Sightings(BundleProblem::Human* human) const {
  std::vector<Sighting> sightings;
  for (JointState& joint : human->joints) {
    if (sightings.empty() || sightings.back().frame != joint.frame) {
      sightings.push_back({joint.frame, {}});
    }
    sightings.back().joints[static_cast<std::size_t>(joint.joint)] = &joint;
  }
  return sightings;
}

/// Time in s from one sighting to the next; zero where a motion factor between them would say
/// nothing.
double BundleGraph::StepBetween(const Sighting& before, const Sighting& after) const {
  const double step_s = problem_->frames[static_cast<std::size_t>(after.frame)].time_s -
                        problem_->frames[static_cast<std::size_t>(before.frame)].time_s;
  return step_s > 0 && step_s <= options_.motion_max_gap_s ? step_s : 0;
}

void BundleGraph::AddRigidity(const std::vector<Sighting>& sightings, BundleProblem::Human* human) {
  for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
    std::optional<double>& length_m = human->segment_length_m[segment];
    if (!length_m) continue;
    int num_factors = 0;
    for (const Sighting& sighting : sightings) {
      JointState* a = sighting.joints[static_cast<std::size_t>(kSegments[segment].joint_a)];
      JointState* b = sighting.joints[static_cast<std::size_t>(kSegments[segment].joint_b)];
      if (a == nullptr || b == nullptr) continue;
      const ceres::ResidualBlockId id =
          ceres_problem_.AddResidualBlock(new RigidityFactor(options_.rigidity_sigma_m),
                                          &dynamic_loss_, a->p_W.data(), b->p_W.data(), &*length_m);
      factors_.push_back({id, Kind::kRigidity, nullptr, &human->num_rigidity_eliminated});
      ++num_factors;
    }
    summary_.num_rigidity += num_factors;
    people_blocks_.push_back(&*length_m);
    if (num_factors > 0 && human->known_length_m[segment]) {
      ceres_problem_.AddResidualBlock(
          new LengthPriorFactor(
              *human->known_length_m[segment],
              std::hypot(human->known_length_sigma_m[segment], options_.segment_length_sigma_m)),
          nullptr, &*length_m);
    }
  }
}

void BundleGraph::AddMotionFactor(ceres::CostFunction* cost, JointState* before, JointState* after,
                                  double* motion, BundleProblem::Human* human) {
  const ceres::ResidualBlockId id = ceres_problem_.AddResidualBlock(
      cost, &dynamic_loss_, before->p_W.data(), after->p_W.data(), motion);
  factors_.push_back({id, Kind::kMotion, nullptr, &human->num_motion_eliminated});
  ++summary_.num_motion;
}

void BundleGraph::AddVelocities(const std::vector<Sighting>& sightings,
                                BundleProblem::Human* human) {
  double* velocity_before = nullptr;  // of the pair just before this one
  double step_before_s = 0;
  for (std::size_t i = 1; i < sightings.size(); ++i) {
    const double step_s = StepBetween(sightings[i - 1], sightings[i]);
    const std::vector<Pair> pairs = SharedJoints(kBodyJoints, sightings[i - 1], sightings[i]);
    const bool is_whole_track = options_.motion_form == MotionForm::kVelocityTrack;
    if (step_s == 0 || pairs.empty()) {
      if (!is_whole_track) velocity_before = nullptr;
      continue;
    }
    double* velocity = velocity_before;
    if (!is_whole_track || velocity == nullptr) {
      velocities_.push_back(MeanStep(pairs) / step_s);
      velocity = velocities_.back().data();
      people_blocks_.push_back(velocity);
      if (velocity_before != nullptr) {
        const double sigma_m_s = options_.person_acceleration_m_s2 * 0.5 * (step_s + step_before_s);
        ceres_problem_.AddResidualBlock(new VelocitySmoothnessFactor(sigma_m_s), nullptr,
                                        velocity_before, velocity);
      }
    }
    for (const auto& [before, after] : pairs) {
      AddMotionFactor(new VelocityFactor(step_s, options_.motion_sigma_m), before, after, velocity,
                      human);
    }
    found_motions_.push_back(
        {human, sightings[i].frame, kTorsoPart, Centroid(pairs), nullptr, velocity, step_s});
    velocity_before = velocity;
    step_before_s = step_s;
  }
}

void BundleGraph::AddPartMotions(const Sighting& before, const Sighting& after,
                                 BundleProblem::Human* human) {
  for (int part = 0; part < kNumParts; ++part) {
    const std::vector<Pair> pairs =
        SharedJoints(kParts[static_cast<std::size_t>(part)].joints, before, after);
    if (pairs.size() < 2) continue;  // one point has no rotation
    const Eigen::Vector3d centroid_W = Centroid(pairs);
    motions_.push_back(ToPoseBlock({Eigen::Quaterniond::Identity(), MeanStep(pairs)}));
    double* motion = motions_.back().data();
    people_blocks_.push_back(motion);
    ceres_problem_.AddParameterBlock(motion, kPoseBlockSize, &manifold_);
    std::vector<const JointState*> points;
    for (const auto& [joint_before, joint_after] : pairs) {
      AddMotionFactor(new PartMotionFactor(centroid_W, options_.motion_sigma_m), joint_before,
                      joint_after, motion, human);
      points.push_back(joint_before);
    }
    AddRotationDamping(points, motion);
    found_motions_.push_back({human, after.frame, part, centroid_W, motion, nullptr, 0});
  }
}

/// Two points leave the rotation about the line through them free; three or more may still lie
/// nearly on a line, and elimination may take some away, so that these are damped ten times less.
void BundleGraph::AddRotationDamping(const std::vector<const JointState*>& points, double* motion) {
  const double weight = 1 / options_.free_rotation_sigma_rad;
  Eigen::Matrix3d sqrt_information = 0.1 * weight * Eigen::Matrix3d::Identity();
  if (points.size() == 2) {
    const Eigen::Vector3d axis = (points[1]->p_W - points[0]->p_W).normalized();
    sqrt_information += weight * axis * axis.transpose();
  }
  ceres_problem_.AddResidualBlock(new RotationDampingFactor(sqrt_information), nullptr, motion);
}

}  // namespace airdos
