#include "common/perception/simcc_pose.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr double kWidening = 1.25;

/// The box as the input shows it: widened, and of the input's shape.
InputPlace PlaceOf(const cv::Rect2d& box, const cv::Size& input) {
  InputPlace place;
  place.scale = std::min(input.width / box.width, input.height / box.height) / kWidening;
  place.offset_px.x = input.width / 2.0 - place.scale * (box.x + box.width / 2);
  place.offset_px.y = input.height / 2.0 - place.scale * (box.y + box.height / 2);
  return place;
}

struct Peak {
  double position = 0;
  double value = 0;
};

Peak LargestOf(const float* values, int number) {
  const float* largest = std::max_element(values, values + number);
  return {static_cast<double>(largest - values), *largest};
}

bool IsList(const cv::Mat& output) {
  return output.dims == 3 && output.size[0] == 1 && output.size[1] >= kNumPoseJoints &&
         output.type() == CV_32F;
}

}  // namespace

SimccPose::SimccPose(const PoseNetworkOptions& options, std::unique_ptr<PoseNetwork> boxes)
    : options_(options), net_(options.network), boxes_(std::move(boxes)) {
  if (options_.input.width_px <= 0 || options_.input.height_px <= 0)
    throw InputError(net_.file() + ": a SimCC network needs the width and height of its input");
}

std::vector<PersonPose> SimccPose::Process(const cv::Mat& bgr) {
  std::vector<PersonPose> people = boxes_->Process(bgr);
  if (people.size() > static_cast<std::size_t>(options_.max_people))
    people.resize(static_cast<std::size_t>(options_.max_people));
  for (PersonPose& person : people) {
    person.joints = {};  // of the other network, if it has any
    if (person.box_px.width >= 1 && person.box_px.height >= 1) FindJoints(bgr, &person);
  }
  return people;
}

void SimccPose::FindJoints(const cv::Mat& bgr, PersonPose* person) {
  const cv::Size size(options_.input.width_px, options_.input.height_px);
  const InputPlace place = PlaceOf(person->box_px, size);
  const cv::Matx23d to_input(place.scale, 0, place.offset_px.x, 0, place.scale, place.offset_px.y);
  cv::Mat input;
  cv::warpAffine(bgr, input, to_input, size, cv::INTER_LINEAR);
  std::vector<cv::Mat> outputs = net_.Process(ToBlob(options_.input, input));
  if (outputs.size() != 2 || !IsList(outputs[0]) || !IsList(outputs[1])) {
    throw InputError(net_.file() +
                     ": must have two outputs, 1 x joints x columns and 1 x joints x rows");
  }
  const auto ratio_is_same = [&](const cv::Mat& columns, const cv::Mat& rows) {
    return columns.size[2] * size.height == rows.size[2] * size.width;
  };
  if (!ratio_is_same(outputs[0], outputs[1])) std::swap(outputs[0], outputs[1]);
  if (!ratio_is_same(outputs[0], outputs[1])) {
    throw InputError(net_.file() + ": the lengths of its outputs do not fit an input of " +
                     std::to_string(size.width) + " x " + std::to_string(size.height));
  }
  const double ratio = static_cast<double>(outputs[0].size[2]) / size.width;
  for (int joint = 0; joint < kNumPoseJoints; ++joint) {
    const Peak u = LargestOf(outputs[0].ptr<float>(0, joint), outputs[0].size[2]);
    const Peak v = LargestOf(outputs[1].ptr<float>(0, joint), outputs[1].size[2]);
    const double score = std::min(u.value, v.value);
    if (!(score > 0)) continue;
    const cv::Point2d pixel = place.ToImage(u.position / ratio, v.position / ratio);
    person->joints[static_cast<std::size_t>(joint)] = {pixel.x, pixel.y, std::min(score, 1.0)};
  }
}

}  // namespace airdos
