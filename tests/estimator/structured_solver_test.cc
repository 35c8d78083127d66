// Our solver against Ceres and against plain dense algebra.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/bundle/bundle_graph.h"
#include "common/optimization/factors/human_factors.h"
#include "common/optimization/solver/ceres_minimizer.h"
#include "common/optimization/solver/structured_minimizer.h"
#include "tests/support/allocation_watch.h"
#include "tests/support/random_bundle.h"

namespace airdos {
namespace {

constexpr int kSeeds = 4;

struct Setting {
  std::string name;
  std::function<void(RandomBundleOptions*, BundleOptions*)> apply;
};

[[maybe_unused]] void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

std::vector<Setting> Settings() {
  using R = RandomBundleOptions;
  using B = BundleOptions;
  const auto with_motion = [](MotionForm person, MotionForm object) {
    return [=](R* r, B*) {
      r->person_motion = person;
      r->object_motion = object;
    };
  };
  return {
      {"Velocity", [](R*, B*) {}},
      {"VelocityOfTheTrack", with_motion(MotionForm::kVelocityTrack, MotionForm::kVelocityTrack)},
      {"Se3OfEachPart", with_motion(MotionForm::kSe3Parts, MotionForm::kSe3Parts)},
      {"Se3OfTheTrack", with_motion(MotionForm::kSe3Track, MotionForm::kSe3Track)},
      {"SmoothSe3", with_motion(MotionForm::kSe3Smooth, MotionForm::kSe3Smooth)},
      {"StaticOnly", [](R*, B* b) { b->use_people = false; }},
      {"WithoutRigidity", [](R*, B* b) { b->use_rigidity = false; }},
      {"WithoutMotion", [](R*, B* b) { b->use_motion = false; }},
      {"PeopleOnlyByMeasurement", [](R*, B* b) { b->use_motion = b->use_rigidity = false; }},
      {"PointMeasurements", [](R* r, B*) { r->has_point_measurements = true; }},
      {"Gaps",
       [](R* r, B* b) {
         r->gaps = 0.3;
         r->missing_joints = 0.2;
         b->motion_max_gap_s = 0.35;
       }},
      {"Breaks",
       [](R* r, B*) {
         r->has_track_breaks = true;
         r->object_motion = MotionForm::kSe3Smooth;
       }},
      {"FixedFrames", [](R* r, B*) { r->num_fixed_frames = 4; }},
      {"AllFramesFixed", [](R* r, B*) { r->num_fixed_frames = 200; }},
      {"FixedLandmarks", [](R* r, B*) { r->fixed_landmarks = 1; }},
      {"MonoLandmarks", [](R* r, B*) { r->mono = 0.5; }},
      {"Outliers",
       [](R* r, B*) {
         r->outliers = 0.05;
         r->has_point_measurements = true;
       }},
      {"Accelerations",
       [](R* r, B* b) {
         r->has_accelerations = true;
         r->has_known_lengths = true;
         b->huber_smoothness_sigmas = 1;
       }},
      {"UnknownSpeed", [](R*, B* b) { b->person_speed_m_s = 0; }},
      {"NoLandmarks",
       [](R* r, B*) {
         r->num_landmarks = 0;
         r->num_fixed_frames = 2;
       }},
      {"NothingFixed", [](R* r, B*) { r->num_fixed_frames = 0; }},
      {"OneLandmark",
       [](R* r, B* b) {
         r->num_landmarks = 1;
         b->use_people = false;
       }},
      {"LongTrack",
       [](R* r, B*) {
         r->num_frames = 25;
         r->num_people = 1;
       }},
  };
}

class StructuredSolverTest : public testing::TestWithParam<Setting> {
 protected:
  static BundleProblem Make(int seed, BundleOptions* options) {
    RandomBundleOptions random;
    random.seed = static_cast<std::uint64_t>(seed);
    GetParam().apply(&random, options);
    return MakeRandomBundle(random);
  }
};

TEST_P(StructuredSolverTest, EndsWhereCeresEnds) {
  for (int seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    BundleOptions options;
    options.steps_by_track = seed == 2;
    options.max_iterations = options.max_iterations_after_rejection = 300;
    options.function_tolerance = 1e-15;
    // Tighter rigidity converges in hundreds of steps where joints are far off, and rounding alone
    // then decides where a run without an end stands.
    options.rigidity_sigma_m = 0.05;
    options.solver = BundleSolver::kCeres;
    BundleProblem expected = Make(seed, &options);
    BundleProblem problem = expected;
    const BundleSummary ceres = SolveBundle(options, &expected);
    options.solver = BundleSolver::kStructured;
    const BundleSummary ours = SolveBundle(options, &problem);
    EXPECT_NEAR(ours.initial_cost, ceres.initial_cost, 1e-9 * ceres.initial_cost);
    EXPECT_NEAR(ours.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost + 1e-12);
    EXPECT_EQ(ours.num_reprojection_rejected, ceres.num_reprojection_rejected);
    EXPECT_EQ(ours.num_rigidity_rejected, ceres.num_rigidity_rejected);
    EXPECT_EQ(ours.num_motion_rejected, ceres.num_motion_rejected);
    for (std::size_t i = 0; i < problem.frames.size(); ++i) {
      // To the first frame: where none is fixed they are free to move together.
      const Se3 T_0_C = problem.frames[0].T_W_C.inverse() * problem.frames[i].T_W_C;
      const Se3 T_0_C_expected = expected.frames[0].T_W_C.inverse() * expected.frames[i].T_W_C;
      EXPECT_LT(Boxminus(T_0_C, T_0_C_expected).norm(), 1e-6) << i;
    }
  }
}

TEST_P(StructuredSolverTest, TakesTheSameStepsAsCeres) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    BundleOptions options;
    options.steps_by_track = false;
    options.max_iterations_after_rejection = 0;
    options.function_tolerance = 1e-6;
    BundleProblem start = Make(seed, &options);
    for (const int max_iterations : {0, 1, 2, 5, 50}) {
      options.max_iterations = max_iterations;
      BundleProblem expected = start, problem = start;
      options.solver = BundleSolver::kCeres;
      const BundleSummary ceres = SolveBundle(options, &expected);
      options.solver = BundleSolver::kStructured;
      const BundleSummary ours = SolveBundle(options, &problem);
      EXPECT_NEAR(ours.final_cost, ceres.final_cost, 1e-6 * ceres.final_cost + 1e-12);
      EXPECT_EQ(ours.num_iterations, ceres.num_iterations);
      EXPECT_EQ(ours.has_converged, ceres.has_converged);
      ASSERT_EQ(ours.newest_covariance.has_value(), ceres.newest_covariance.has_value());
      if (!ours.newest_covariance) continue;
      // Directions that nothing observes have a variance of 1e4.
      EXPECT_LT((*ours.newest_covariance - *ceres.newest_covariance).norm(),
                1e-6 * ceres.newest_covariance->norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, StructuredSolverTest, testing::ValuesIn(Settings()),
                         [](const auto& test) { return test.param.name; });

/// Gradient and Hessian by plain dense sums over the factors; columns as in `order`.
struct Dense {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

Dense MakeDense(const FactorGraph& graph, const std::vector<int>& order, double huber) {
  std::vector<int> column(graph.blocks().size(), -1);
  int num = 0;
  for (const int block : order) {
    column[static_cast<std::size_t>(block)] = num;
    num += graph.block(block).tangent_size();
  }
  Dense dense{Eigen::MatrixXd::Zero(num, num), Eigen::VectorXd::Zero(num)};
  for (const FactorGraph::Factor& factor : graph.factors()) {
    const int rows = factor.cost->num_residuals();
    Eigen::VectorXd r(rows);
    std::vector<std::vector<double>> values(3, std::vector<double>(100));
    std::array<double*, 3> jacobians = {};
    std::array<const double*, 3> parameters = {};
    for (std::size_t i = 0; i < static_cast<std::size_t>(factor.num_blocks); ++i) {
      jacobians[i] = values[i].data();
      parameters[i] = graph.block(factor.blocks[i]).values;
    }
    EXPECT_TRUE(factor.cost->Evaluate(parameters.data(), r.data(), jacobians.data()));
    const double norm = r.norm();
    const double weight = factor.loss != nullptr && norm > huber ? huber / norm : 1;
    const auto jacobian = [&](std::size_t i) {
      const FactorGraph::Block& block = graph.block(factor.blocks[i]);
      const Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> all(
          jacobians[i], rows, block.size);
      return Eigen::MatrixXd(all.leftCols(block.tangent_size()));
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(factor.num_blocks); ++i) {
      const int row = column[static_cast<std::size_t>(factor.blocks[i])];
      if (row < 0) continue;
      const Eigen::MatrixXd J_i = jacobian(i);
      dense.g.segment(row, J_i.cols()) += weight * J_i.transpose() * r;
      for (std::size_t j = 0; j < static_cast<std::size_t>(factor.num_blocks); ++j) {
        const int col = column[static_cast<std::size_t>(factor.blocks[j])];
        if (col < 0) continue;
        const Eigen::MatrixXd J_j = jacobian(j);
        dense.H.block(row, col, J_i.cols(), J_j.cols()) += weight * J_i.transpose() * J_j;
      }
    }
  }
  return dense;
}

TEST_P(StructuredSolverTest, OneStepSolvesTheDenseNormalEquations) {
  BundleOptions options;
  BundleProblem problem = Make(7, &options);
  options.huber_static_sigmas = options.huber_dynamic_sigmas = 2;
  if (options.huber_smoothness_sigmas > 0) options.huber_smoothness_sigmas = 2;
  BundleGraph graph(options, &problem);
  StructuredMinimizer minimizer(graph.factor_graph());
  const Dense dense = MakeDense(*graph.factor_graph(), minimizer.order(), 2);
  if (dense.g.size() == 0) return;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  Eigen::VectorXd damping(dense.g.size());
  for (double& value : damping) value = uniform(random);
  const auto step = minimizer.LinearStep(damping);
  ASSERT_TRUE(step);
  Eigen::MatrixXd H = dense.H;
  H.diagonal() += damping;
  const Eigen::VectorXd expected = -H.llt().solve(dense.g);
  EXPECT_LT((*step - expected).norm(), 1e-9 * expected.norm());
}

TEST(BlockEliminationTest, AGroupsShareFollowsThePosesAsItsSchurComplementSays) {
  // One group of four unknowns and two poses; the numbers are random.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::vector<int> dims = {3, 1, 3, 3, 6, 6};
  const std::vector<int> group_begins = {0, 4, 6};
  BlockMatrix H(dims, group_begins);
  for (const auto& [row, col] : std::vector<std::pair<int, int>>{
           {0, 1}, {0, 2}, {0, 4}, {2, 3}, {1, 3}, {2, 5}, {3, 5}, {4, 4}, {5, 5}}) {
    H.Offset(row, col, 0);
  }
  const int own = H.first_pose_scalar(), poses = H.num_pose_scalars(), all = H.num_scalars();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(all, all);  // of the group's layer
  for (int row = 0; row < H.num_blocks(); ++row) {
    for (int e = H.first_entry(row); e >= 0; e = H.entries()[static_cast<std::size_t>(e)].next) {
      const BlockMatrix::Entry& entry = H.entries()[static_cast<std::size_t>(e)];
      for (int i = 0; i < H.dim(row); ++i) {
        for (int j = row == entry.col ? i : 0; j < H.dim(entry.col); ++j) {
          const double value = uniform(random) + (row == entry.col && i == j ? 10 : 0);
          H.values()[entry.offset + i * H.dim(entry.col) + j] = value;
          if (entry.layer != 0) continue;
          dense(H.begin(row) + i, H.begin(entry.col) + j) = value;
          dense(H.begin(entry.col) + j, H.begin(row) + i) = value;
        }
      }
    }
  }
  BlockElimination elimination(H, {0, 1, 2, 4, 6}, {0, 3, 4}, nullptr);
  Eigen::VectorXd b(elimination.vector_size()), d(elimination.vector_size());
  for (Eigen::VectorXd* vector : {&b, &d}) {
    for (double& value : *vector) value = uniform(random);
  }
  const int share = elimination.share_begin(0);
  const auto H_oo = dense.topLeftCorner(own, own);
  const auto H_op = dense.topRightCorner(own, poses);
  const Eigen::MatrixXd S =
      dense.bottomRightCorner(poses, poses) - H_op.transpose() * H_oo.llt().solve(H_op);
  const Eigen::VectorXd reduced =
      b.segment(share, poses) - H_op.transpose() * H_oo.llt().solve(b.head(own));
  ASSERT_TRUE(elimination.Eliminate(H, Eigen::VectorXd::Zero(all), 0));
  const Eigen::VectorXd of_poses = b.segment(own, poses);
  elimination.SolveForward(0, &b);
  EXPECT_LT((b.segment(share, poses) - reduced).norm(), 1e-12);
  EXPECT_EQ(b.segment(own, poses), of_poses);  // the poses' own part is left alone
  elimination.MoveShare(0, d, &b);
  EXPECT_LT((b.segment(share, poses) - (reduced - S * d.segment(own, poses))).norm(), 1e-12);
}

TEST(StructuredMinimizerTest, AnIterationAllocatesNothing) {
  RandomBundleOptions random;
  random.outliers = 0.02;
  BundleProblem problem = MakeRandomBundle(random);
  BundleOptions options;
  BundleGraph graph(options, &problem);
  StructuredMinimizer minimizer(graph.factor_graph());
  MinimizerOptions solve;
  solve.max_iterations = 20;
  solve.function_tolerance = 1e-12;
  ResetLargestAllocation();
  const MinimizerSummary summary = minimizer.Minimize(solve);
  EXPECT_EQ(LargestAllocation(), 0U);
  EXPECT_GT(summary.num_iterations, 5);
}

TEST(StructuredMinimizerTest, FactorsAcrossAnySlicesAndTracksAreKept) {
  // Unlike what a bundle adjustment makes: factors between slices far apart and between tracks.
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Vector3d> points(40);
  FactorGraph graph;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {uniform(random), uniform(random), uniform(random)};
    FactorGraph::Block block;
    block.values = points[i].data();
    block.kind = FactorGraph::Kind::kTrack;
    block.track = static_cast<int>(i) % 2;
    block.slice = static_cast<int>(i) / 4;
    graph.AddBlock(block);
    graph.AddFactor(std::make_unique<VelocityPriorFactor>(2.0), nullptr, static_cast<int>(i));
  }
  for (int i = 0; i < 80; ++i) {
    const int a = static_cast<int>(random() % points.size());
    const int b = static_cast<int>(random() % points.size());
    if (a == b) continue;
    graph.AddFactor(std::make_unique<VelocitySmoothnessFactor>(0.5), nullptr, a, b);
  }
  StructuredMinimizer minimizer(&graph);
  const Dense dense = MakeDense(graph, minimizer.order(), 1);
  const auto step = minimizer.LinearStep(Eigen::VectorXd::Constant(dense.g.size(), 0.01));
  ASSERT_TRUE(step);
  Eigen::MatrixXd H = dense.H;
  H.diagonal().array() += 0.01;
  const Eigen::VectorXd expected = -H.llt().solve(dense.g);
  EXPECT_LT((*step - expected).norm(), 1e-9 * expected.norm());
}

}  // namespace
}  // namespace airdos
