// What one frame costs the front end, beside a naive one on the same images: OpenCV's ORB with as
// many levels, the same threshold and at least as many features on both images, brute-force
// matching of left to right and of left to the left image before. The two take turns frame by
// frame, so other work on the machine strikes both alike. Processor time, medians over the frames;
// decoding the images is in neither.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/features/visual_odometry.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxFrames = 50;
constexpr std::size_t kNumWarmUpFrames = 10;  // until the map has its landmarks
constexpr int kMaskDilation_px = 8;           // as frontend.yaml has it

struct Sequence {
  StereoCamera camera;
  std::vector<StereoImagePair> frames;
};

std::string SequenceFolder(const std::string& name) {
  const char* const data = std::getenv("AIRDOS_DATA_DIR");
  return (data != nullptr ? data : AIRDOS_SOURCE_DIR "/../shared/data") + ("/" + name);
}

Sequence LoadSequence(const std::string& folder) {
  const auto source = OpenStereoSequence(folder);
  Sequence sequence{source->camera(), {}};
  for (std::size_t k = 0; k < std::min(kMaxFrames, source->num_frames()); ++k) {
    const SequenceFrame frame = source->Load(k);
    StereoImagePair images;
    images.id = FrameId{static_cast<std::int64_t>(k)};
    images.time_s = static_cast<double>(frame.utime) * 1e-6;
    images.left = cv::imdecode(frame.left_image_file, cv::IMREAD_GRAYSCALE);
    images.right = cv::imdecode(frame.right_image_file, cv::IMREAD_GRAYSCALE);
    if (!frame.person_mask_file.empty()) {
      constexpr int kDiameter_px = 2 * kMaskDilation_px + 1;
      images.mask = cv::imdecode(frame.person_mask_file, cv::IMREAD_GRAYSCALE);
      cv::dilate(images.mask, images.mask,
                 cv::getStructuringElement(cv::MORPH_ELLIPSE, {kDiameter_px, kDiameter_px}));
    }
    sequence.frames.push_back(images);
  }
  return sequence;
}

class NaiveFrontEnd {
 public:
  explicit NaiveFrontEnd(const FeatureExtractorOptions& options) : options_(options) {}

  /// `num_features` are asked for in each image; returns how many it got in the left one.
  std::size_t Process(const StereoImagePair& images, int num_features) {
    constexpr int kBorder_px = 20;  // as ours
    constexpr int kPatch_px = 31;
    const cv::Ptr<cv::ORB> orb = cv::ORB::create(
        num_features, static_cast<float>(ImagePyramid::kScaleFactor), options_.num_levels,
        kBorder_px, 0, 2, cv::ORB::HARRIS_SCORE, kPatch_px, options_.fast_threshold);
    std::vector<cv::KeyPoint> left;
    std::vector<cv::KeyPoint> right;
    cv::Mat left_descriptors;
    cv::Mat right_descriptors;
    cv::Mat allowed;
    if (!images.mask.empty()) allowed = images.mask == 0;
    orb->detectAndCompute(images.left, allowed, left, left_descriptors);
    orb->detectAndCompute(images.right, cv::noArray(), right, right_descriptors);
    const cv::BFMatcher matcher(cv::NORM_HAMMING);
    std::vector<cv::DMatch> matches;
    matcher.match(left_descriptors, right_descriptors, matches);
    if (!last_.empty()) matcher.match(left_descriptors, last_, matches);
    last_ = left_descriptors;
    return left.size();
  }

 private:
  FeatureExtractorOptions options_;
  cv::Mat last_;
};

double ProcessorTime_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of the left or the right image, whichever has more.
int NumFeatures(const StereoImagePair& images, const FeatureExtractorOptions& options) {
  const FeatureExtractor extractor(options);
  int num_masked = 0;
  const ImagePyramid left(images.left, options.num_levels);
  const ImagePyramid right(images.right, options.num_levels);
  return static_cast<int>(std::max(extractor.Extract(left, images.mask, &num_masked).size(),
                                   extractor.Extract(right, cv::Mat(), &num_masked).size()));
}

void BM_FrontEnd(benchmark::State& state, const std::string& name) {
  cv::setNumThreads(1);
  const std::string folder = SequenceFolder(name);
  if (!std::filesystem::is_directory(folder)) {
    state.SkipWithError(("no sequence at " + folder + " (AIRDOS_DATA_DIR)").c_str());
    return;
  }
  const Sequence sequence = LoadSequence(folder);
  const VisualOdometryOptions options;
  std::vector<double> ours_ms;
  std::vector<double> naive_ms;
  double num_ours = 0;
  double num_naive = 0;
  for (auto _ : state) {
    VisualOdometry odometry(options);
    NaiveFrontEnd naive(options.extractor);
    double sum_s = 0;
    for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
      const StereoImagePair& images = sequence.frames[k];
      const int num_features = NumFeatures(images, options.extractor);
      const double start_s = ProcessorTime_s();
      odometry.Process(sequence.camera, images);
      const double between_s = ProcessorTime_s();
      const std::size_t num_found = naive.Process(images, num_features);
      const double end_s = ProcessorTime_s();
      if (k < kNumWarmUpFrames) continue;
      sum_s += between_s - start_s;
      ours_ms.push_back(1e3 * (between_s - start_s));
      naive_ms.push_back(1e3 * (end_s - between_s));
      num_ours += num_features;
      num_naive += static_cast<double>(num_found);
    }
    state.SetIterationTime(sum_s / static_cast<double>(sequence.frames.size() - kNumWarmUpFrames));
  }
  const auto num_frames = static_cast<double>(ours_ms.size());
  state.counters["front_end_ms"] = Quantile(ours_ms, 0.5);
  state.counters["naive_ms"] = Quantile(naive_ms, 0.5);
  state.counters["ratio"] = Quantile(ours_ms, 0.5) / Quantile(naive_ms, 0.5);
  state.counters["features"] = num_ours / num_frames;
  state.counters["naive_features"] = num_naive / num_frames;
}
BENCHMARK_CAPTURE(BM_FrontEnd, RoadCrossing03, "crossing/RoadCrossing03")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(BM_FrontEnd, RoadCrossing06, "crossing/RoadCrossing06")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);
BENCHMARK_CAPTURE(BM_FrontEnd, kitti_odo_seq1, "kitti_odo_seq1")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(1);

}  // namespace
}  // namespace airdos
