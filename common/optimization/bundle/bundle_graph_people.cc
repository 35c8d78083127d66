#include <Eigen/Core>
#include <Eigen/SVD>
#include <cmath>
#include <utility>

#include "common/optimization/bundle/bundle_graph.h"
#include "common/optimization/factors/human_factors.h"

namespace airdos {
namespace {

/// A shared motion takes two steps to be equally long if their durations differ by less than this,
/// relatively.
constexpr double kSameStep = 0.01;

}  // namespace

/// The joints among `wanted` that were seen both before and after.
std::vector<BundleGraph::Pair> BundleGraph::SharedJoints(const std::vector<int>& wanted,
                                                         const Sighting& before,
                                                         const Sighting& after) {
  std::vector<Pair> shared;
  for (const int joint : wanted) {
    const auto j = static_cast<std::size_t>(joint);
    if (before.joints[j].state != nullptr && after.joints[j].state != nullptr) {
      shared.emplace_back(before.joints[j], after.joints[j]);
    }
  }
  return shared;
}

Eigen::Vector3d BundleGraph::Centroid(const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [before, after] : pairs) sum += before.state->p_W;
  return sum / static_cast<double>(pairs.size());
}

Eigen::Vector3d BundleGraph::MeanStep(const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [before, after] : pairs) sum += after.state->p_W - before.state->p_W;
  return sum / static_cast<double>(pairs.size());
}

/// The rigid motion that maps the first points of the pairs to the second (least squares). Two
/// points leave the rotation about the line through them free, so their motion starts without a
/// rotation.
BundleProblem::PartMotion BundleGraph::StartMotion(const BundleProblem::Human& human, int part,
                                                   const std::vector<Pair>& pairs) {
  for (const BundleProblem::PartMotion& start : human.start_motions) {
    if (start.part == part) return start;
  }
  const Eigen::Vector3d centroid_W = Centroid(pairs);
  const Eigen::Vector3d step = MeanStep(pairs);
  Se3 motion_W{Eigen::Quaterniond::Identity(), step};
  if (pairs.size() > 2) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& [before, after] : pairs) {
      covariance +=
          (after.state->p_W - centroid_W - step) * (before.state->p_W - centroid_W).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
    motion_W.rotation =
        Eigen::Matrix3d(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose());
  }
  return {0, part, centroid_W, motion_W};
}

void BundleGraph::AddHuman(BundleProblem::Human* human) {
  if (human->joints.empty()) return;
  ++summary_.num_people;
  ++num_tracks_;
  const std::vector<Sighting> sightings = AddJoints(human);
  if (options_.use_rigidity) AddRigidity(sightings, human);
  if (!options_.use_motion) return;
  const MotionForm form = human->motion_form.value_or(options_.motion_form);
  switch (form) {
    case MotionForm::kVelocity:
    case MotionForm::kVelocityTrack:
      AddVelocities(sightings, human);
      break;
    case MotionForm::kSe3Parts:
    case MotionForm::kSe3Smooth:
      AddSe3Motions(form == MotionForm::kSe3Smooth, sightings, human);
      break;
    case MotionForm::kSe3Track:
      AddTrackMotions(sightings, human);
      break;
  }
}

int BundleGraph::AddTrackBlock(double* values, int size, int slice) {
  FactorGraph::Block block;
  block.values = values;
  block.size = size;
  block.kind = FactorGraph::Kind::kTrack;
  block.track = num_tracks_;
  block.slice = slice;
  return graph_.AddBlock(block);
}

std::vector<BundleGraph::Sighting> BundleGraph::AddJoints(BundleProblem::Human* human) {
  const auto num_points = static_cast<std::size_t>(human->model->num_points);
  std::vector<Sighting> sightings;
  for (JointState& joint : human->joints) {
    if (sightings.empty() || sightings.back().frame != joint.frame) {
      sightings.push_back({joint.frame, std::vector<Point>(num_points)});
    }
    const int block = AddTrackBlock(joint.p_W.data(), 3, joint.frame);
    sightings.back().joints[static_cast<std::size_t>(joint.joint)] = {&joint, block};
    AddReprojection(&joint, /*has_right=*/true, block, Kind::kJoint);
  }
  return sightings;
}

/// Time in s between two consecutive sightings; zero if a motion factor between them would carry no
/// information.
double BundleGraph::StepBetween(const Sighting& before, const Sighting& after,
                                const BundleProblem::Human& human) const {
  if (human.track_breaks.count(after.frame) > 0) return 0;
  const double step_s = problem_->frames[static_cast<std::size_t>(after.frame)].time_s -
                        problem_->frames[static_cast<std::size_t>(before.frame)].time_s;
  return step_s > 0 && step_s <= options_.motion_max_gap_s ? step_s : 0;
}

void BundleGraph::AddRigidity(const std::vector<Sighting>& sightings, BundleProblem::Human* human) {
  const std::vector<ArticulatedModel::Segment>& segments = human->model->segments;
  for (std::size_t segment = 0; segment < segments.size(); ++segment) {
    std::optional<double>& length_m = human->segment_length_m[segment];
    if (!length_m) continue;
    const int length = AddTrackBlock(&*length_m, 1, FactorGraph::Block::kWholeTrack);
    int num_factors = 0;
    for (const Sighting& sighting : sightings) {
      const Point& a = sighting.joints[static_cast<std::size_t>(segments[segment].point_a)];
      const Point& b = sighting.joints[static_cast<std::size_t>(segments[segment].point_b)];
      if (a.state == nullptr || b.state == nullptr) continue;
      const int index =
          graph_.AddFactor(std::make_unique<RigidityFactor>(options_.rigidity_sigma_m),
                           &dynamic_loss_, a.block, b.block, length);
      factors_.push_back({index, Kind::kRigidity, nullptr, &human->num_rigidity_rejected});
      ++num_factors;
    }
    summary_.num_rigidity += num_factors;
    if (num_factors > 0 && human->known_length_m[segment]) {
      graph_.AddFactor(
          std::make_unique<LengthPriorFactor>(
              *human->known_length_m[segment],
              std::hypot(human->known_length_sigma_m[segment], options_.segment_length_sigma_m)),
          nullptr, length);
    }
  }
}

void BundleGraph::AddMotionFactor(std::unique_ptr<ceres::CostFunction> cost, const Pair& pair,
                                  int motion, BundleProblem::Human* human) {
  const int index = graph_.AddFactor(std::move(cost), &dynamic_loss_, pair.first.block,
                                     pair.second.block, motion);
  factors_.push_back({index, Kind::kMotion, nullptr, &human->num_motion_rejected});
  ++summary_.num_motion;
}

void BundleGraph::AddVelocities(const std::vector<Sighting>& sightings,
                                BundleProblem::Human* human) {
  const MotionNoise noise = NoiseOf(*human);
  const bool is_whole_track =
      human->motion_form.value_or(options_.motion_form) == MotionForm::kVelocityTrack;
  int velocity_before = -1;  // block of the previous pair of frames
  double step_before_s = 0;
  for (std::size_t i = 1; i < sightings.size(); ++i) {
    const double step_s = StepBetween(sightings[i - 1], sightings[i], *human);
    const std::vector<Pair> pairs =
        SharedJoints(human->model->body_points, sightings[i - 1], sightings[i]);
    if (step_s == 0 || pairs.empty()) {
      const bool is_break = human->track_breaks.count(sightings[i].frame) > 0;
      if (!is_whole_track || is_break) velocity_before = -1;
      continue;
    }
    int velocity = velocity_before;
    if (!is_whole_track || velocity < 0) {
      velocities_.push_back(MeanStep(pairs) / step_s);
      const int slice = is_whole_track ? FactorGraph::Block::kWholeTrack : sightings[i].frame;
      velocity = AddTrackBlock(velocities_.back().data(), 3, slice);
      if (velocity_before < 0 && options_.person_speed_m_s > 0) {
        graph_.AddFactor(std::make_unique<VelocityPriorFactor>(options_.person_speed_m_s),
                         smoothness_loss_.get(), velocity);
      } else if (velocity_before >= 0) {
        const double sigma_m_s = noise.acceleration_m_s2 * 0.5 * (step_s + step_before_s);
        graph_.AddFactor(std::make_unique<VelocitySmoothnessFactor>(sigma_m_s),
                         smoothness_loss_.get(), velocity_before, velocity);
      }
    }
    for (const Pair& pair : pairs) {
      AddMotionFactor(std::make_unique<VelocityFactor>(step_s, noise.motion_sigma_m), pair,
                      velocity, human);
    }
    found_motions_.push_back({human, sightings[i].frame, kTorsoPart, Centroid(pairs), nullptr,
                              graph_.block(velocity).values, step_s});
    velocity_before = velocity;
    step_before_s = step_s;
  }
}

void BundleGraph::AddSe3Motions(bool is_smooth, const std::vector<Sighting>& sightings,
                                BundleProblem::Human* human) {
  const MotionNoise noise = NoiseOf(*human);
  PartBlocks blocks_before(human->model->parts.size(), -1);
  double step_before_s = 0;
  for (std::size_t i = 1; i < sightings.size(); ++i) {
    const double step_s = StepBetween(sightings[i - 1], sightings[i], *human);
    PartBlocks blocks(human->model->parts.size(), -1);
    if (step_s > 0) blocks = AddPartMotions(sightings[i - 1], sightings[i], human);
    for (std::size_t part = 0; is_smooth && part < blocks.size(); ++part) {
      if (blocks[part] < 0 || blocks_before[part] < 0) continue;
      const double mean_step_s = 0.5 * (step_s + step_before_s);
      graph_.AddFactor(std::make_unique<PartSmoothnessFactor>(
                           step_before_s, step_s, noise.acceleration_m_s2 * mean_step_s,
                           noise.angular_acceleration_rad_s2 * mean_step_s),
                       smoothness_loss_.get(), blocks_before[part], blocks[part]);
    }
    blocks_before = std::move(blocks);
    step_before_s = step_s;
  }
}

BundleGraph::PartBlocks BundleGraph::AddPartMotions(const Sighting& before, const Sighting& after,
                                                    BundleProblem::Human* human) {
  PartBlocks blocks(human->model->parts.size(), -1);
  const double sigma_m = NoiseOf(*human).motion_sigma_m;
  for (int part = 0; part < static_cast<int>(human->model->parts.size()); ++part) {
    const std::vector<Pair> pairs =
        SharedJoints(human->model->parts[static_cast<std::size_t>(part)], before, after);
    if (pairs.size() < 2) continue;  // a single point does not determine a rotation
    const Eigen::Vector3d centroid_W = Centroid(pairs);
    motions_.push_back(ToPoseBlock({Eigen::Quaterniond::Identity(), MeanStep(pairs)}));
    const int motion = AddTrackBlock(motions_.back().data(), kPoseBlockSize, after.frame);
    blocks[static_cast<std::size_t>(part)] = motion;
    std::vector<const JointState*> points;
    for (const Pair& pair : pairs) {
      AddMotionFactor(std::make_unique<PartMotionFactor>(centroid_W, sigma_m), pair, motion, human);
      points.push_back(pair.first.state);
    }
    AddRotationDamping(points, motion);
    found_motions_.push_back(
        {human, after.frame, part, centroid_W, motions_.back().data(), nullptr, 0});
  }
  return blocks;
}

/// One motion per part for the whole track, about the part's centroid where it was first seen in
/// two consecutive frames. It is the motion over the track's first step; later steps of a different
/// duration (after a missed frame) get no factor.
void BundleGraph::AddTrackMotions(const std::vector<Sighting>& sightings,
                                  BundleProblem::Human* human) {
  const double sigma_m = NoiseOf(*human).motion_sigma_m;
  for (int part = 0; part < static_cast<int>(human->model->parts.size()); ++part) {
    int motion = -1;
    double unit_s = 0;
    Eigen::Vector3d centroid_W;
    for (std::size_t i = 1; i < sightings.size(); ++i) {
      const double step_s = StepBetween(sightings[i - 1], sightings[i], *human);
      const std::vector<Pair> pairs = SharedJoints(
          human->model->parts[static_cast<std::size_t>(part)], sightings[i - 1], sightings[i]);
      if (human->track_breaks.count(sightings[i].frame) > 0) motion = -1;
      if (step_s == 0 || pairs.empty()) continue;
      if (motion < 0) {
        if (pairs.size() < 2) continue;  // a single point does not determine a rotation
        BundleProblem::PartMotion start = StartMotion(*human, part, pairs);
        centroid_W = start.centroid_W;
        motions_.push_back(ToPoseBlock(start.motion_W));
        motion =
            AddTrackBlock(motions_.back().data(), kPoseBlockSize, FactorGraph::Block::kWholeTrack);
        unit_s = step_s;
        std::vector<const JointState*> points;
        for (const Pair& pair : pairs) points.push_back(pair.first.state);
        if (points.size() == 2) AddRotationDamping(points, motion);
      }
      if (std::abs(step_s - unit_s) > kSameStep * unit_s) continue;
      for (const Pair& pair : pairs) {
        AddMotionFactor(std::make_unique<PartMotionFactor>(centroid_W, sigma_m), pair, motion,
                        human);
      }
      found_motions_.push_back(
          {human, sightings[i].frame, part, centroid_W, graph_.block(motion).values, nullptr, 0});
    }
  }
}

MotionNoise BundleGraph::NoiseOf(const BundleProblem::Human& human) const {
  return human.motion_noise.value_or(
      MotionNoise{options_.motion_sigma_m, options_.person_acceleration_m_s2, 1.0});
}

/// Two points leave the rotation about the line through them free. Three or more may lie nearly on
/// a line, and rejection may remove some, so they are damped too, ten times less.
void BundleGraph::AddRotationDamping(const std::vector<const JointState*>& points, int motion) {
  const double weight = 1 / options_.free_rotation_sigma_rad;
  Eigen::Matrix3d sqrt_information = 0.1 * weight * Eigen::Matrix3d::Identity();
  if (points.size() == 2) {
    const Eigen::Vector3d axis = (points[1]->p_W - points[0]->p_W).normalized();
    sqrt_information += weight * axis * axis.transpose();
  }
  graph_.AddFactor(std::make_unique<RotationDampingFactor>(sqrt_information), nullptr, motion);
}

}  // namespace airdos
