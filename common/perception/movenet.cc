#include "common/perception/movenet.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr int kInputStep_px = 32;  // the coarsest level of its pyramid
constexpr int kCell_px = 4;
constexpr int kPeakSize = 5;
constexpr double kSpread = 0.3;
// exp(-9) leaves the most certain joint behind any that is where it is expected.
constexpr double kReach = 3;
constexpr double kMinJointScore = 0.1;  // of those that the box is drawn around

double Sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

double ValueAt(const cv::Mat& plane, const cv::Point& cell) { return plane.at<float>(cell); }

/// One head: its channels as images.
using Planes = std::vector<cv::Mat>;

Planes PlanesOf(const cv::Mat& output, int num_channels, const std::string& what) {
  const bool is_image = output.dims == 4 && output.size[0] == 1 && output.type() == CV_32F;
  if (is_image && output.size[1] == num_channels) {
    Planes planes;
    for (int i = 0; i < num_channels; ++i) {
      planes.emplace_back(output.size[2], output.size[3], CV_32F,
                          const_cast<float*>(output.ptr<float>(0, i)));
    }
    return planes;
  }
  if (is_image && output.size[3] == num_channels) {
    const cv::Mat together(output.size[1], output.size[2], CV_32FC(num_channels), output.data);
    Planes planes;
    cv::split(together, planes);
    return planes;
  }
  throw InputError(what + " must be an image of " + std::to_string(num_channels) +
                   " channels, as MoveNet MultiPose gives it");
}

class Decoder {
 public:
  explicit Decoder(const std::vector<cv::Mat>& outputs)
      : centre_(PlanesOf(outputs[0], 1, "the first output (centre)")[0]),
        heat_(PlanesOf(outputs[1], kNumPoseJoints, "the second output (heatmaps)")),
        regression_(PlanesOf(outputs[2], 2 * kNumPoseJoints, "the third output (regression)")),
        offsets_(PlanesOf(outputs[3], 2 * kNumPoseJoints, "the fourth output (offsets)")) {
    for (const Planes* planes : {&heat_, &regression_, &offsets_}) {
      if (planes->front().size() != centre_.size())
        throw InputError("the outputs differ in rows and columns");
    }
    spread_ = kSpread * std::min(centre_.rows, centre_.cols);
  }

  /// Cells, the most certain first.
  std::vector<cv::Point> Peaks(double min_score) const {
    cv::Mat highest;
    cv::dilate(centre_, highest, cv::Mat::ones(kPeakSize, kPeakSize, CV_8U));
    std::vector<cv::Point> peaks;
    for (int y = 0; y < centre_.rows; ++y) {
      for (int x = 0; x < centre_.cols; ++x) {
        const float logit = centre_.at<float>(y, x);
        if (logit == highest.at<float>(y, x) && Sigmoid(logit) >= min_score)
          peaks.emplace_back(x, y);
      }
    }
    std::stable_sort(peaks.begin(), peaks.end(), [this](const cv::Point& a, const cv::Point& b) {
      return centre_.at<float>(a) > centre_.at<float>(b);
    });
    return peaks;
  }

  PersonPose Person(const cv::Point& peak, const InputPlace& place) const {
    PersonPose person;
    person.score = Sigmoid(ValueAt(centre_, peak));
    for (std::size_t joint = 0; joint < person.joints.size(); ++joint)
      person.joints[joint] = Joint(peak, joint, place);
    person.box_px = BoxOfJoints(person, kMinJointScore);
    return person;
  }

 private:
  BodyKeypoint Joint(const cv::Point& peak, std::size_t joint, const InputPlace& place) const {
    const double y_expected = peak.y + ValueAt(regression_[2 * joint], peak);
    const double x_expected = peak.x + ValueAt(regression_[2 * joint + 1], peak);
    if (!std::isfinite(y_expected) || !std::isfinite(x_expected)) return {};
    const double reach = kReach * std::sqrt(spread_);
    const auto cell = [](double position, int size) {
      return std::clamp(static_cast<int>(std::lround(std::clamp(position, -1e6, 1e6))), 0,
                        size - 1);
    };
    const cv::Mat& heat = heat_[joint];
    const int x_first = cell(x_expected - reach, heat.cols);
    const int x_last = cell(x_expected + reach, heat.cols);
    std::vector<double> column_weights;
    for (int x = x_first; x <= x_last; ++x)
      column_weights.push_back(std::exp(-std::pow(x - x_expected, 2) / spread_));
    cv::Point best(x_first, cell(y_expected, heat.rows));
    double best_value = -1;
    for (int y = cell(y_expected - reach, heat.rows); y <= cell(y_expected + reach, heat.rows);
         ++y) {
      const double row_weight = std::exp(-std::pow(y - y_expected, 2) / spread_);
      for (int x = x_first; x <= x_last; ++x) {
        const double weight = row_weight * column_weights[static_cast<std::size_t>(x - x_first)];
        if (weight <= best_value) continue;  // a sigmoid is below 1
        const double value = weight * Sigmoid(heat.at<float>(y, x));
        if (value <= best_value) continue;
        best_value = value;
        best = {x, y};
      }
    }
    const double y_px = kCell_px * (best.y + ValueAt(offsets_[2 * joint], best));
    const double x_px = kCell_px * (best.x + ValueAt(offsets_[2 * joint + 1], best));
    const cv::Point2d in_image = place.ToImage(x_px, y_px);
    return {in_image.x, in_image.y, Sigmoid(ValueAt(heat, best))};
  }

  cv::Mat centre_;
  Planes heat_;
  Planes regression_;
  Planes offsets_;
  double spread_ = 1;
};

}  // namespace

MoveNet::MoveNet(const PoseNetworkOptions& options) : options_(options), net_(options.network) {
  if (options_.network.outputs.size() == 4) return;
  throw InputError(net_.file() + ": four outputs must be named (centre, heatmaps, regression, " +
                   "offsets), not " + std::to_string(options_.network.outputs.size()));
}

std::vector<PersonPose> MoveNet::Process(const cv::Mat& bgr) {
  cv::Size size(options_.input.width_px, options_.input.height_px);
  if (size.width <= 0 || size.height <= 0)
    size = ChooseInputSize(bgr.size(), options_.short_side_px, kInputStep_px);
  InputPlace place;
  const cv::Mat input = FitIntoInput(bgr, size, Fill::kBelowAndRight, &place);
  const std::vector<cv::Mat> outputs = net_.Process(ToBlob(options_.input, input));
  try {
    const Decoder decoder(outputs);
    std::vector<PersonPose> people;
    for (const cv::Point& peak : decoder.Peaks(options_.min_score)) {
      if (people.size() == static_cast<std::size_t>(options_.max_people)) break;
      people.push_back(decoder.Person(peak, place));
    }
    KeepBest(options_.max_overlap, &people);
    return people;
  } catch (const InputError& error) {
    throw InputError(net_.file() + ": " + error.what());
  }
}

}  // namespace airdos
