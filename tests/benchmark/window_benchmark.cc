#include <benchmark/benchmark.h>

#include "common/optimization/window/sliding_window.h"
#include "tests/support/synthetic_scene.h"

// What one frame costs the sliding window: processor time (other work must not count) of the frames
// with a full window. `Time` and `CPU` are those of one frame; the counters are means over these
// frames.

namespace airdos {
namespace {

constexpr std::size_t kNumWarmUpFrames = 20;  // until the window is full

void ProcessFrames(const SlidingWindowOptions& options, const SyntheticSceneOptions& scene_options,
                   benchmark::State* state) {
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  double num_frames = 0, num_iterations = 0, num_landmarks = 0, num_people = 0, num_motion = 0;
  while (state->KeepRunningBatch(
      static_cast<benchmark::IterationCount>(scene.frames.size() - kNumWarmUpFrames))) {
    state->PauseTiming();
    SlidingWindowOptimizer optimizer(options, scene.camera);
    for (std::size_t k = 0; k < kNumWarmUpFrames; ++k) optimizer.Process(scene.frames[k]);
    state->ResumeTiming();
    for (std::size_t k = kNumWarmUpFrames; k < scene.frames.size(); ++k) {
      const FrameEstimate estimate = optimizer.Process(scene.frames[k]).estimate;
      num_frames += 1;
      num_iterations += estimate.summary.num_iterations;
      num_landmarks += estimate.num_static_landmarks;
      num_people += estimate.summary.num_people;
      num_motion += estimate.summary.num_motion;
    }
  }
  state->counters["iterations"] = num_iterations / num_frames;
  state->counters["landmarks"] = num_landmarks / num_frames;
  state->counters["people"] = num_people / num_frames;
  state->counters["motions"] = num_motion / num_frames;
}

void BM_StaticScene(benchmark::State& state) {
  SyntheticSceneOptions scene;
  scene.num_frames = 50;
  scene.outlier_ratio = 0.02;
  SlidingWindowOptions options;
  options.bundle.use_people = false;
  ProcessFrames(options, scene, &state);
}
BENCHMARK(BM_StaticScene)->Unit(benchmark::kMillisecond);

void BM_People(benchmark::State& state) {
  SyntheticSceneOptions scene;
  scene.num_frames = 40;
  scene.num_people = 15;
  scene.outlier_ratio = 0.02;
  ProcessFrames(SlidingWindowOptions(), scene, &state);
}
BENCHMARK(BM_People)->Unit(benchmark::kMillisecond);

void BM_PeopleAndFewStaticPoints(benchmark::State& state) {
  SyntheticSceneOptions scene;
  scene.num_frames = 40;
  scene.num_people = 15;
  scene.max_static_per_frame = 8;
  ProcessFrames(SlidingWindowOptions(), scene, &state);
}
BENCHMARK(BM_PeopleAndFewStaticPoints)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace airdos
