#include "common/perception/person_masker.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "common/human/body_mask.h"
#include "common/perception/network_input.h"
#include "common/util/error.h"

namespace airdos {
namespace {

constexpr double kWidening = 1.3;        // hands, hair and clothes are beyond the joints
constexpr double kMinProbability = 0.3;  // who is missed costs more than what is marked too much
constexpr int kInputStep_px = 32;

/// A square about the middle of the box.
cv::Rect SquareAround(const cv::Rect2d& box) {
  const double side = kWidening * std::max(box.width, box.height);
  const double u = box.x + box.width / 2 - side / 2;
  const double v = box.y + box.height / 2 - side / 2;
  return {cv::Point(cvRound(u), cvRound(v)), cv::Size(cvRound(side), cvRound(side))};
}

NetworkInputOptions UnitInput() {
  NetworkInputOptions input;
  input.mean_red = input.mean_green = input.mean_blue = 0;
  input.scale_red = input.scale_green = input.scale_blue = 255;
  return input;
}

/// Where the network sees a person in `crop`, whose size the result has, if it looks at it with
/// `input_size`.
cv::Mat PersonIn(const cv::Mat& crop, const cv::Size& input_size, DnnNetwork* net) {
  cv::Mat input;
  cv::resize(crop, input, input_size, 0, 0, cv::INTER_LINEAR);
  const std::vector<cv::Mat> outputs = net->Process(ToBlob(UnitInput(), input));
  const cv::Mat& output = outputs.front();
  const bool is_image =
      output.dims == 4 && output.size[0] == 1 && output.size[1] == 1 && output.type() == CV_32F;
  if (!is_image) throw InputError(net->file() + ": its output must be an image of one channel");
  const cv::Mat small(output.size[2], output.size[3], CV_32F,
                      const_cast<float*>(output.ptr<float>()));
  cv::Mat probability;
  cv::resize(small, probability, crop.size(), 0, 0, cv::INTER_LINEAR);
  return probability > kMinProbability;
}

}  // namespace

PersonMasker::PersonMasker(const PersonMaskerOptions& options) : options_(options) {
  if (!options_.use_network) return;
  net_of_people_ = std::make_unique<DnnNetwork>(options_.network);
  if (options_.image_short_side_px > 0)
    net_of_image_ = std::make_unique<DnnNetwork>(options_.network);
}

cv::Mat PersonMasker::Process(const cv::Mat& bgr, const std::vector<PersonPose>& people) {
  std::vector<BodyKeypoints> bodies;
  for (const PersonPose& person : people) bodies.push_back(ToBody(person));
  cv::Mat mask = DrawBodyMask(bodies, bgr.size(), options_.min_score);
  if (net_of_people_ == nullptr) return mask;
  if (net_of_image_ != nullptr) PaintImage(bgr, &mask);
  for (const PersonPose& person : people) {
    const cv::Rect2d box = BoxOfJoints(person, options_.min_score);
    if (box.height >= options_.min_height_px) PaintWithin(bgr, box, &mask);
  }
  return mask;
}

void PersonMasker::PaintWithin(const cv::Mat& bgr, const cv::Rect2d& box, cv::Mat* mask) {
  const cv::Rect square = SquareAround(box);
  const cv::Rect seen = square & cv::Rect({}, bgr.size());
  if (seen.empty() || square.width > 16384) return;
  cv::Mat crop(square.size(), CV_8UC3, cv::Scalar::all(0));
  const cv::Rect within(seen.tl() - square.tl(), seen.size());
  bgr(seen).copyTo(crop(within));
  const cv::Mat person = PersonIn(crop, {options_.side_px, options_.side_px}, net_of_people_.get());
  mask->operator()(seen).setTo(255, person(within));
}

void PersonMasker::PaintImage(const cv::Mat& bgr, cv::Mat* mask) {
  const cv::Size size = ChooseInputSize(bgr.size(), options_.image_short_side_px, kInputStep_px);
  mask->setTo(255, PersonIn(bgr, size, net_of_image_.get()));
}

}  // namespace airdos
