#include "common/perception/yolo_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr int kInputStep_px = 32;

/// What stands in the columns of a candidate.
struct Columns {
  int number;
  bool has_object_score;
  int first_joint;  // 0: none
};
constexpr std::array<Columns, 6> kColumns = {
    {{56, false, 5}, {57, true, 6}, {5, false, 0}, {84, false, 0}, {6, true, 0}, {85, true, 0}}};

const Columns* FindColumns(int number) {
  const auto* found = std::find_if(kColumns.begin(), kColumns.end(),
                                   [number](const Columns& c) { return c.number == number; });
  return found == kColumns.end() ? nullptr : found;
}

/// A row for each candidate.
cv::Mat Candidates(const cv::Mat& output, const Columns** columns) {
  const bool is_list = output.dims == 3 && output.size[0] == 1 && output.type() == CV_32F;
  if (is_list) {
    const cv::Mat list(output.size[1], output.size[2], CV_32F, output.data);
    // Of two numbers that both are known the smaller one: there are hundreds of candidates.
    const bool is_transposed = FindColumns(list.rows) != nullptr &&
                               (FindColumns(list.cols) == nullptr || list.rows < list.cols);
    *columns = FindColumns(is_transposed ? list.rows : list.cols);
    if (*columns != nullptr) return is_transposed ? cv::Mat(list.t()) : list;
  }
  std::string shape;
  for (int i = 0; i < output.dims; ++i)
    shape += (i == 0 ? "" : " x ") + std::to_string(output.size[i]);
  throw InputError(
      "the output must be a list of 56 or 57 columns (people with joints) or of 5, 6, "
      "84 or 85 (boxes), is " +
      shape);
}

double ScoreOf(const float* row, const Columns& columns) {
  const double score = row[4];
  return columns.has_object_score ? score * row[5] : score;
}

/// Scores are probabilities, whatever the network says.
double Probability(double score) { return score > 0 ? std::min(score, 1.0) : 0; }

PersonPose ToPerson(const float* row, const Columns& columns, const InputPlace& place) {
  PersonPose person;
  person.score = Probability(ScoreOf(row, columns));
  const double half_width = row[2] / 2.0;
  const double half_height = row[3] / 2.0;
  person.box_px = cv::Rect2d(place.ToImage(row[0] - half_width, row[1] - half_height),
                             place.ToImage(row[0] + half_width, row[1] + half_height));
  if (columns.first_joint == 0) return person;
  const float* values = row + columns.first_joint;
  for (BodyKeypoint& joint : person.joints) {
    const cv::Point2d pixel = place.ToImage(values[0], values[1]);
    if (std::isfinite(pixel.x) && std::isfinite(pixel.y))
      joint = {pixel.x, pixel.y, Probability(values[2])};
    values += 3;
  }
  return person;
}

}  // namespace

std::vector<PersonPose> YoloPose::Process(const cv::Mat& bgr) {
  cv::Size size(options_.input.width_px, options_.input.height_px);
  if (size.width <= 0 || size.height <= 0)
    size = ChooseInputSize(bgr.size(), options_.short_side_px, kInputStep_px);
  InputPlace place;
  const cv::Mat input = FitIntoInput(bgr, size, Fill::kAround, &place);
  const std::vector<cv::Mat> outputs = net_.Process(ToBlob(options_.input, input));
  const Columns* columns = nullptr;
  cv::Mat candidates;
  try {
    candidates = Candidates(outputs.front(), &columns);
  } catch (const InputError& error) {
    throw InputError(net_.file() + ": " + error.what());
  }
  std::vector<PersonPose> people;
  for (int i = 0; i < candidates.rows; ++i) {
    const auto* row = candidates.ptr<float>(i);
    const bool is_box = std::isfinite(row[0]) && std::isfinite(row[1]) && row[2] > 0 &&
                        row[3] > 0 && std::isfinite(row[2]) && std::isfinite(row[3]);
    if (is_box && ScoreOf(row, *columns) >= options_.min_score)
      people.push_back(ToPerson(row, *columns, place));
  }
  KeepBest(options_.max_overlap, &people);
  if (people.size() > static_cast<std::size_t>(options_.max_people))
    people.resize(static_cast<std::size_t>(options_.max_people));
  return people;
}

}  // namespace airdos
