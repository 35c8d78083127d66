#include "common/perception/person_detector.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "common/perception/movenet.h"
#include "common/perception/simcc_pose.h"
#include "common/perception/yolo_pose.h"

namespace airdos {
namespace {

std::unique_ptr<PoseNetwork> MakeNetwork(const PersonDetectorOptions& options) {
  switch (options.head) {
    case PersonDetectorOptions::Head::kYolo:
      return std::make_unique<YoloPose>(options.pose);
    case PersonDetectorOptions::Head::kSimcc:
      return std::make_unique<SimccPose>(options.pose, std::make_unique<YoloPose>(options.boxes));
    case PersonDetectorOptions::Head::kMoveNet:
      break;
  }
  return std::make_unique<MoveNet>(options.pose);
}

constexpr std::size_t kMinFollowed = 2;  // joints; one alone may have slipped
constexpr double kCarried = 0.9;         // confidence of a joint that goes along with the others

/// Moves each joint to its place in the next image; one that was lost moves as the others do in the
/// median, with a little less confidence. If most are lost, so is the person.
void Carry(const std::vector<std::optional<Eigen::Vector2d>>& places, PersonPose* person) {
  std::vector<double> du_px, dv_px;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const BodyKeypoint& joint = person->joints[i];
    if (joint.confidence <= 0 || !places[i]) continue;
    du_px.push_back(places[i]->x() - joint.u_px);
    dv_px.push_back(places[i]->y() - joint.v_px);
  }
  if (du_px.size() < kMinFollowed) {
    person->joints = {};
    return;
  }
  const Eigen::Vector2d shift_px(*Median(du_px), *Median(dv_px));
  for (std::size_t i = 0; i < places.size(); ++i) {
    BodyKeypoint& joint = person->joints[i];
    if (joint.confidence <= 0) continue;
    const Eigen::Vector2d place = places[i].value_or(joint.uv_px() + shift_px);
    joint = {place.x(), place.y(), places[i] ? joint.confidence : kCarried * joint.confidence};
  }
}

}  // namespace

PersonDetector::PersonDetector(const PersonDetectorOptions& options)
    : PersonDetector(options, MakeNetwork(options)) {}

PersonDetector::PersonDetector(const PersonDetectorOptions& options,
                               std::unique_ptr<PoseNetwork> network)
    : options_(options), network_(std::move(network)) {
  if (options_.use_masks) masker_ = std::make_unique<PersonMasker>(options_.masks);
  Reset();
}

void PersonDetector::Reset() {
  for (View* view : {&left_, &right_}) {
    *view = View();
    view->flow = std::make_unique<ImageFlow>(options_.flow);
  }
  num_since_detection_ = 0;
}

void PersonDetector::SetImage(const cv::Mat& image, View* view) const {
  const bool is_followed = options_.detect_every > 1;
  view->gray = cv::Mat();
  if (image.channels() == 1) {
    view->gray = image;
  } else if (is_followed || options_.right == PersonDetectorOptions::Right::kRows) {
    cv::cvtColor(image, view->gray, cv::COLOR_BGR2GRAY);
  }
  if (is_followed) view->flow->SetImage(view->gray);
}

std::vector<PersonPose> PersonDetector::Credible(std::vector<PersonPose> people) const {
  for (PersonPose& person : people) {
    for (BodyKeypoint& joint : person.joints) {
      if (joint.confidence < options_.min_joint_score) joint = {};
    }
  }
  const auto is_nobody = [this](const PersonPose& person) {
    const auto num_seen =
        std::count_if(person.joints.begin(), person.joints.end(),
                      [](const BodyKeypoint& joint) { return joint.confidence > 0; });
    return num_seen < options_.min_joints;
  };
  people.erase(std::remove_if(people.begin(), people.end(), is_nobody), people.end());
  return people;
}

void PersonDetector::Detect(const cv::Mat& bgr, View* view) {
  view->people.clear();
  if (!bgr.empty()) view->people = Credible(network_->Process(bgr));
}

void PersonDetector::Follow(View* view) const {
  std::vector<Eigen::Vector2d> from, guess;
  for (const PersonPose& person : view->people) {
    for (const BodyKeypoint& joint : person.joints) {
      from.push_back(joint.uv_px());
      guess.push_back(joint.uv_px() + view->flow->shift_px());
    }
  }
  const auto to = view->flow->Follow(from, guess);
  auto next = to.begin();
  for (PersonPose& person : view->people) {
    Carry({next, next + kNumPoseJoints}, &person);
    next += kNumPoseJoints;
    person.box_px = BoxOfJoints(person, options_.min_joint_score);
  }
  view->people = Credible(std::move(view->people));
}

DetectedPeople PersonDetector::Process(const cv::Mat& left, const cv::Mat& right) {
  SetImage(left, &left_);
  SetImage(right, &right_);
  const bool is_due = num_since_detection_ == 0;
  num_since_detection_ = (num_since_detection_ + 1) % options_.detect_every;
  if (is_due) {
    Detect(left, &left_);
    if (options_.right == PersonDetectorOptions::Right::kNetwork) Detect(right, &right_);
  } else {
    Follow(&left_);
    if (options_.right == PersonDetectorOptions::Right::kNetwork) Follow(&right_);
  }
  if (options_.right == PersonDetectorOptions::Right::kRows) {
    right_.people.clear();
    for (const PersonPose& person : left_.people) {
      const auto found = FindInRightImage(options_.rows, left_.gray, right_.gray, person);
      if (found) right_.people.push_back(*found);
    }
  }
  DetectedPeople result{left_.people, right_.people, cv::Mat()};
  if (masker_ != nullptr && !left.empty()) result.mask = masker_->Process(left, result.left);
  return result;
}

}  // namespace airdos
