#include "common/optimization/solver/structured_minimizer.h"

#include <algorithm>
#include <cmath>

#include "common/optimization/solver/elimination_order.h"
#include "common/util/check.h"

namespace airdos {
namespace {

// As in Ceres.
constexpr double kMaxRadius = 1e16;
constexpr double kMinRadius = 1e-32;
constexpr double kMinDiagonal = 1e-6;
constexpr double kMaxDiagonal = 1e32;
constexpr double kMinQuality = 1e-3;  // of an accepted step
// Our own. A group stays linearized if its cost followed the prediction to within this many
// tolerances.
constexpr double kKeptTolerance = 100;
constexpr int kMaxInvalidSteps = 5;  // in a row

std::vector<int> Flatten(const std::vector<std::vector<int>>& fronts) {
  std::vector<int> flat;
  for (const std::vector<int>& front : fronts) flat.insert(flat.end(), front.begin(), front.end());
  return flat;
}

}  // namespace

StructuredMinimizer::StructuredMinimizer(FactorGraph* graph, std::vector<double>* memory)
    : graph_(graph) {
  const EliminationOrder elimination_order = OrderForElimination(*graph);
  order_ = Flatten(elimination_order.fronts);
  std::vector<int> dims;
  std::size_t num_values = 0;
  for (const int block : order_) {
    dims.push_back(graph->block(block).tangent_size());
    value_begins_.push_back(num_values);
    num_values += static_cast<std::size_t>(graph->block(block).size);
  }
  std::vector<int> front_begins = {0};
  for (const std::vector<int>& front : elimination_order.fronts) {
    front_begins.push_back(front_begins.back() + static_cast<int>(front.size()));
  }
  for (const int front : elimination_order.group_begins) {
    group_begins_.push_back(front_begins[front]);
  }
  H_.emplace(dims, group_begins_);
  linearizer_.emplace(*graph, order_, &*H_);
  elimination_.emplace(*H_, front_begins, elimination_order.group_begins, memory);
  value_begins_.push_back(num_values);
  saved_.resize(num_values);
  for (auto* values : {&costs_, &new_costs_, &caution_, &caution_step_}) {
    values->resize(group_begins_.size() - 1);
  }
  for (Eigen::VectorXd* vector : {&diagonal_, &scale_, &damping_}) {
    vector->setZero(H_->num_scalars());
  }
  for (Eigen::VectorXd* vector : {&gradient_, &step_}) {
    vector->setZero(elimination_->vector_size());
  }
  is_kept_.resize(num_groups());
}

void StructuredMinimizer::TrustRegion::Accept(double quality) {
  radius = std::min(kMaxRadius, radius / std::max(1.0 / 3, 1 - std::pow(2 * quality - 1, 3)));
  decrease_factor = 2;
}

void StructuredMinimizer::TrustRegion::Reject() {
  radius /= decrease_factor;
  decrease_factor *= 2;
}

/// Ceres damps the diagonal of the Hessian in scaled unknowns, with the scale fixed at the start.
void StructuredMinimizer::SetDamping(double radius) {
  damping_ = (diagonal_.array() * scale_.array().square()).max(kMinDiagonal).min(kMaxDiagonal) /
             (radius * scale_.array().square());
  for (int group = 0; group < num_groups(); ++group) {
    if (caution_[group] == 1) continue;
    const int begin = H_->begin(group_begins_[group]);
    damping_.segment(begin, H_->begin(group_begins_[group + 1]) - begin) *= caution_[group];
  }
}

double StructuredMinimizer::Linearize() {
  double sum = 0;
  for (int group = 0; group < num_groups(); ++group) {
    if (!is_kept_[group]) costs_[group] = linearizer_->Linearize(group, &gradient_);
    sum += costs_[group];
  }
  H_->ReadDiagonal(&diagonal_);
  return sum;
}

double StructuredMinimizer::MaxGradient() const {
  double largest = 0;
  const int num_poses = H_->num_pose_scalars();
  Eigen::VectorXd::ConstSegmentReturnType own = gradient_.segment(0, H_->first_pose_scalar());
  largest = own.size() > 0 ? own.lpNorm<Eigen::Infinity>() : 0;
  for (int i = 0; i < num_poses; ++i) {
    double sum = gradient_[H_->first_pose_scalar() + i];
    for (int group = 0; group + 1 < num_groups(); ++group) {
      sum += gradient_[elimination_->share_begin(group) + i];
    }
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

/// Returns false if the step is unusable.
bool StructuredMinimizer::ComputeStep() {
  const int poses = H_->first_pose_scalar(), num_poses = H_->num_pose_scalars();
  step_.segment(poses, num_poses) = -gradient_.segment(poses, num_poses);
  double gain = 0;  // -(g d + d H d / 2) of the model; with (H + D) d = -g it is (d D d - g d) / 2
  for (int group = 0; group + 1 < num_groups(); ++group) {
    const int share = elimination_->share_begin(group);
    if (is_kept_[group]) {
      step_.segment(ScalarBegin(group), NumScalars(group)).setZero();
      continue;
    }
    if (!elimination_->Eliminate(*H_, damping_, group)) return false;
    step_.segment(ScalarBegin(group), NumScalars(group)) =
        -gradient_.segment(ScalarBegin(group), NumScalars(group));
    step_.segment(share, num_poses) = -gradient_.segment(share, num_poses);
    elimination_->SolveForward(group, &step_);
  }
  if (!elimination_->FactorisePoses(*H_, damping_)) return false;
  elimination_->SolveBackward(&step_);
  const auto d_poses = step_.segment(poses, num_poses).array();
  for (int group = 0; group + 1 < num_groups(); ++group) {
    const int share = elimination_->share_begin(group);
    if (is_kept_[group]) {
      gain += (d_poses * step_.segment(share, num_poses).array()).sum();
      continue;
    }
    const auto d = step_.segment(ScalarBegin(group), NumScalars(group)).array();
    gain += (d * (damping_.segment(ScalarBegin(group), NumScalars(group)).array() * d -
                  gradient_.segment(ScalarBegin(group), NumScalars(group)).array()))
                .sum();
    gain -= (d_poses * gradient_.segment(share, num_poses).array()).sum();
  }
  gain += (d_poses * (damping_.segment(poses, num_poses).array() * d_poses -
                      gradient_.segment(poses, num_poses).array()))
              .sum();
  model_cost_change_ = 0.5 * gain;
  return std::isfinite(model_cost_change_) && model_cost_change_ > 0;
}

double StructuredMinimizer::PredictAndMoveShare(int group) {
  const int poses = H_->first_pose_scalar(), num_poses = H_->num_pose_scalars();
  const int share = elimination_->share_begin(group);
  const auto d_poses = step_.segment(poses, num_poses);
  double gain = 0;
  if (is_kept_[group]) {
    gain += d_poses.dot(step_.segment(share, num_poses));
  } else {
    const auto d = step_.segment(ScalarBegin(group), NumScalars(group)).array();
    gain += (d * (damping_.segment(ScalarBegin(group), NumScalars(group)).array() * d -
                  gradient_.segment(ScalarBegin(group), NumScalars(group)).array()))
                .sum();
    gain -= d_poses.dot(gradient_.segment(share, num_poses));
  }
  elimination_->MoveShare(group, step_, &step_);
  return 0.5 * (gain + d_poses.dot(step_.segment(share, num_poses)));
}

void StructuredMinimizer::KeepPredictedGroups(double tolerance) {
  for (int group = 0; group + 1 < num_groups(); ++group) {
    const double predicted = PredictAndMoveShare(group);
    const double fall = costs_[group] - new_costs_[group];
    const double error = std::min(std::abs(fall), std::abs(fall - predicted));
    is_kept_[group] = error <= tolerance * costs_[group] && caution_[group] == 1;
  }
}

void StructuredMinimizer::SaveValues() {
  double* saved = saved_.data();
  for (const int index : order_) {
    const FactorGraph::Block& block = graph_->block(index);
    saved = std::copy_n(block.values, block.size, saved);
  }
}

void StructuredMinimizer::RestoreValues(int group) {
  for (int i = group_begins_[group]; i < group_begins_[group + 1]; ++i) {
    const FactorGraph::Block& block = graph_->block(order_[i]);
    std::copy_n(saved_.data() + value_begins_[i], block.size, block.values);
  }
}

void StructuredMinimizer::RestoreValues() {
  for (int group = 0; group < num_groups(); ++group) RestoreValues(group);
}

double StructuredMinimizer::Evaluate() {
  double sum = 0;
  for (int group = 0; group < num_groups(); ++group) {
    new_costs_[group] = linearizer_->Cost(group);
    sum += new_costs_[group];
  }
  return sum;
}

double StructuredMinimizer::RestoreWorseTracks() {
  double sum = 0;
  for (int group = 1; group + 1 < num_groups(); ++group) {
    caution_[group] = std::max(1.0, caution_[group] / 3);
    if (new_costs_[group] <= costs_[group]) {
      caution_step_[group] = 2;
      continue;
    }
    RestoreValues(group);
    const double cost = linearizer_->Cost(group);
    if (cost < new_costs_[group]) {
      sum += new_costs_[group] - cost;
      new_costs_[group] = cost;
      caution_[group] *= 3 * caution_step_[group];
      caution_step_[group] *= 2;
    } else {  // worse there too, because its cameras have moved
      ApplyStep(group);
    }
  }
  return sum;
}

void StructuredMinimizer::ApplyStep(int group) {
  for (int i = group_begins_[group]; i < group_begins_[group + 1]; ++i) {
    const FactorGraph::Block& block = graph_->block(order_[i]);
    const double* const saved = saved_.data() + value_begins_[i];
    const double* const step = step_.data() + H_->begin(i);
    if (block.is_on_manifold()) {
      manifold_.Plus(saved, step, block.values);
    } else {
      for (int k = 0; k < block.size; ++k) block.values[k] = saved[k] + step[k];
    }
  }
}

StructuredMinimizer::Norms StructuredMinimizer::MeasureStep() const {
  Norms squared;
  const double* saved = saved_.data();
  for (const int index : order_) {
    const FactorGraph::Block& block = graph_->block(index);
    for (int i = 0; i < block.size; ++i) {
      const double moved = block.values[i] - saved[i];
      squared.step += moved * moved;
      squared.values += saved[i] * saved[i];
    }
    saved += block.size;
  }
  return {std::sqrt(squared.values), std::sqrt(squared.step)};
}

MinimizerSummary StructuredMinimizer::Minimize(const MinimizerOptions& options) {
  if (!options.steps_by_track) std::fill(is_kept_.begin(), is_kept_.end(), false);
  linearizer_->DropRemovedFactors(&is_kept_);
  std::fill(caution_.begin(), caution_.end(), 1.0);
  std::fill(caution_step_.begin(), caution_step_.end(), 2.0);
  MinimizerSummary summary;
  const double fixed_cost = linearizer_->FixedCost();
  double cost = Linearize();
  summary.initial_cost = summary.final_cost = fixed_cost + cost;
  if (!std::isfinite(summary.initial_cost)) {
    summary.initial_cost = summary.final_cost = 0;
    return summary;
  }
  scale_ = (1 + diagonal_.array().sqrt()).inverse();
  SaveValues();
  TrustRegion region;
  summary.num_iterations = 1;  // the start counts
  int num_invalid_steps = 0;
  bool is_linearized = true;
  summary.has_converged = order_.empty() || MaxGradient() <= options.gradient_tolerance;
  for (int i = 0; i < options.max_iterations && !summary.has_converged; ++i) {
    if (!is_linearized) {
      Linearize();
      is_linearized = true;
      summary.has_converged = MaxGradient() <= options.gradient_tolerance;
      if (summary.has_converged) break;
    }
    SetDamping(region.radius);
    if (!ComputeStep()) {
      if (++num_invalid_steps >= kMaxInvalidSteps) break;
      region.Reject();
      ++summary.num_iterations;
      continue;
    }
    num_invalid_steps = 0;
    for (int group = 0; group < num_groups(); ++group) ApplyStep(group);
    double new_cost = Evaluate();
    if (options.steps_by_track) new_cost -= RestoreWorseTracks();
    const Norms norms = MeasureStep();
    const double cost_change = cost - new_cost;
    summary.has_converged =
        norms.step <= options.parameter_tolerance * (norms.values + options.parameter_tolerance) ||
        std::abs(cost_change) <= options.function_tolerance * cost;
    if (summary.has_converged) {
      RestoreValues();
      break;
    }
    ++summary.num_iterations;
    const double quality = cost_change / model_cost_change_;
    if (!(quality > kMinQuality)) {
      RestoreValues();
      region.Reject();
      if (region.radius < kMinRadius) summary.has_converged = true;
      continue;
    }
    region.Accept(quality);
    if (options.steps_by_track) KeepPredictedGroups(kKeptTolerance * options.function_tolerance);
    SaveValues();
    costs_ = new_costs_;
    cost = new_cost;
    is_linearized = false;
  }
  summary.final_cost = fixed_cost + cost;
  return summary;
}

std::optional<Matrix6d> StructuredMinimizer::PoseCovariance(int block, double prior_sigma) {
  const auto place = std::find(order_.begin(), order_.end(), block);
  if (place == order_.end()) {  // no factor depends on it
    return Matrix6d(prior_sigma * prior_sigma * Matrix6d::Identity());
  }
  LinearizeAll();
  damping_.setConstant(1 / (prior_sigma * prior_sigma));
  if (!elimination_->Factorise(*H_, damping_)) return std::nullopt;
  const Matrix6d covariance =
      elimination_->InverseBlock(H_->begin(static_cast<int>(place - order_.begin())), 6);
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

void StructuredMinimizer::LinearizeAll() {
  linearizer_->DropRemovedFactors(&is_kept_);
  std::fill(is_kept_.begin(), is_kept_.end(), false);
  Linearize();
}

std::optional<Eigen::VectorXd> StructuredMinimizer::LinearStep(const Eigen::VectorXd& damping) {
  LinearizeAll();
  damping_ = damping;
  if (!elimination_->Factorise(*H_, damping_)) return std::nullopt;
  step_ = -gradient_;
  elimination_->Solve(&step_);
  return Eigen::VectorXd(step_.head(H_->num_scalars()));
}

}  // namespace airdos
