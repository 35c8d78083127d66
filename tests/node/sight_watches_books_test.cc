// What is said of pictures, masks and people while a run goes on: from which frames, and how often.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "processes/frontend/input_watch.h"
#include "processes/human_tracker/people_watch.h"

namespace airdos {
namespace {

std::string Joined(InputWatch* watch) {
  std::string all;
  for (const std::string& line : watch->TakeWarnings()) all += line + "\n";
  return all;
}

/// Blurred noise: corners everywhere.
const cv::Mat& Texture() {
  static const cv::Mat texture = [] {
    cv::Mat image(192, 320, CV_8UC1);
    cv::RNG random(3);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(image, image, {9, 9}, 2);
    cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
    return image;
  }();
  return texture;
}

/// The texture `shift_px` further to the left, as the right image has it.
cv::Mat Moved(int shift_px) {
  cv::Mat moved = cv::Mat::zeros(Texture().size(), CV_8UC1);
  Texture().colRange(shift_px, 320).copyTo(moved.colRange(0, 320 - shift_px));
  return moved;
}

// Three of the first ten pairs are measured and every hundredth; two of the last three must agree.
TEST(InputWatchBooksTest, APairThatBecomesWrongIsNoticedAtTheSecondHundredth) {
  const cv::Mat right = Moved(8);
  InputWatch watch;
  for (int pair = 1; pair <= 10; ++pair) watch.AddPair(Texture(), right);
  for (int pair = 11; pair <= 199; ++pair) watch.AddPair(right, Texture());
  EXPECT_EQ(Joined(&watch), "");
  watch.AddPair(right, Texture());
  EXPECT_EQ(Joined(&watch).find("left and right images are exchanged: "), 0u);
  for (int pair = 201; pair <= 500; ++pair) watch.AddPair(right, Texture());
  EXPECT_EQ(Joined(&watch), "") << "said once";
}

TEST(InputWatchBooksTest, TimesAreJudgedOnce) {
  InputWatch watch;
  for (std::int64_t k = 0; k < 300; ++k) watch.AddTime(5000 + 40 * k);
  EXPECT_EQ(Joined(&watch),
            "according to utime, the left images are 4e-05 s apart (median): it is in ms; utime "
            "must be the capture time in us\n");
}

/// Joints in a column at u = 100, every 5 px from v = 40 on; the first `num_seen` are seen.
BodyKeypoints Person(std::size_t num_seen, double confidence = 0.9) {
  BodyKeypoints person;
  for (std::size_t i = 0; i < person.size(); ++i)
    person[i] = {100, 40 + 5.0 * static_cast<double>(i), i < num_seen ? confidence : 0.0};
  return person;
}

TEST(InputWatchBooksTest, OnlyWhatIsSeenAndOnlySinceTheLastLookCountsForMasks) {
  const cv::Mat empty = cv::Mat::zeros(192, 320, CV_8UC1);
  cv::Mat marked = empty.clone();
  marked(cv::Rect(95, 30, 10, 120)) = cv::Scalar(255);
  {
    InputWatch watch;
    for (int k = 0; k < 10; ++k) watch.AddMask(empty, {Person(14, 0.1)});
    EXPECT_EQ(Joined(&watch), "") << "hardly seen";
  }
  {
    InputWatch watch;
    for (int k = 0; k < 10; ++k) watch.AddMask(empty, {Person(4)});
    EXPECT_EQ(Joined(&watch), "") << "40 joints are few";
  }
  InputWatch watch;
  for (int k = 0; k < 10; ++k) watch.AddMask(marked, {Person(14)});
  for (int k = 10; k < 100; ++k) watch.AddMask(empty, {Person(k < 20 ? 4 : 0)});
  EXPECT_EQ(Joined(&watch), "") << "the 140 before were judged";
  for (int k = 100; k < 600; ++k) watch.AddMask(empty, {Person(1)});
  EXPECT_EQ(Joined(&watch),
            "the person masks do not mark people: 0 of 100 keypoints are on them; are they "
            "inverted, empty or from another camera?\n")
      << "once";
}

TEST(InputWatchBooksTest, AKeypointLiesOnAMaskByItsColumnAndRow) {
  cv::Mat marked = cv::Mat::zeros(192, 320, CV_8UC1);
  marked(cv::Rect(145, 55, 10, 10)) = cv::Scalar(255);
  BodyKeypoints person;
  person.fill({150, 60, 0.9});
  InputWatch watch;
  for (int k = 0; k < 10; ++k) watch.AddMask(marked, {person});
  EXPECT_EQ(Joined(&watch), "");
}

// ---- People ----

/// Two people, one beside the other, of a shape that nothing else has; all joints are seen.
std::vector<BodyKeypoints> TwoPeople() {
  std::vector<BodyKeypoints> people(2);
  for (std::size_t p = 0; p < people.size(); ++p) {
    for (std::size_t i = 0; i < people[p].size(); ++i) {
      const auto k = static_cast<double>(i);
      people[p][i] = {60.0 + 130.0 * static_cast<double>(p) + 6.0 * static_cast<double>(i % 4),
                      50 + 7 * k + (p == 0 ? 3 * k : 0), 0.8};
    }
  }
  return people;
}

std::vector<BodyKeypoints> Shifted(std::vector<BodyKeypoints> people, double du_px,
                                   double dv_px = 0) {
  for (BodyKeypoints& person : people) {
    for (BodyKeypoint& joint : person) {
      joint.u_px += du_px;
      joint.v_px += dv_px;
    }
  }
  return people;
}

std::string Watch(const std::vector<BodyKeypoints>& left, const std::vector<BodyKeypoints>& right,
                  int num_frames, PeopleWatch* watch) {
  std::string all;
  for (int k = 0; k < num_frames; ++k) all += watch->Add(left, right);
  return all;
}

std::string WatchTen(const std::vector<BodyKeypoints>& left,
                     const std::vector<BodyKeypoints>& right) {
  PeopleWatch watch;
  return Watch(left, right, 10, &watch);
}

constexpr char kExchanged[] =
    "left and right keypoints are exchanged: 20 of 20 people have a negative disparity";

TEST(PeopleWatchBooksTest, PeopleAreComparedWithWhoeverIsMostLikeThem) {
  std::vector<BodyKeypoints> right = Shifted(TwoPeople(), 9);
  std::swap(right[0], right[1]);
  EXPECT_EQ(WatchTen(TwoPeople(), right), kExchanged);
  EXPECT_EQ(WatchTen(TwoPeople(), Shifted(TwoPeople(), 9, 20)), "") << "20 px lower: others";
  EXPECT_EQ(WatchTen({TwoPeople()[0], TwoPeople()[0]}, {Shifted(TwoPeople(), 9)[1]}), "")
      << "of another shape";
}

TEST(PeopleWatchBooksTest, ADisparityOfAFewTenthsHasNoSign) {
  EXPECT_EQ(WatchTen(TwoPeople(), Shifted(TwoPeople(), -0.1)), "");
  EXPECT_EQ(WatchTen(TwoPeople(), Shifted(TwoPeople(), 0.1)), "");
  EXPECT_EQ(WatchTen(TwoPeople(), Shifted(TwoPeople(), 0.5)), kExchanged);
}

TEST(PeopleWatchBooksTest, FiveJointsThatBothSeeAreCompared) {
  for (const std::size_t num_common : {4, 5}) {
    std::vector<BodyKeypoints> right = Shifted(TwoPeople(), 9);
    for (BodyKeypoints& person : right) {
      for (std::size_t i = num_common; i < person.size(); ++i) person[i] = {0, 0, 0.1};
    }
    EXPECT_EQ(WatchTen(TwoPeople(), right), num_common == 5 ? kExchanged : "");
  }
}

TEST(PeopleWatchBooksTest, EachLookIsOfThePeopleSinceTheOneBefore) {
  PeopleWatch watch;
  EXPECT_EQ(Watch(TwoPeople(), Shifted(TwoPeople(), -9), 10, &watch), "");
  EXPECT_EQ(Watch(TwoPeople(), Shifted(TwoPeople(), 9), 10, &watch), "") << "not yet";
  EXPECT_EQ(Watch({}, {}, 80, &watch), kExchanged);
  EXPECT_EQ(Watch(TwoPeople(), Shifted(TwoPeople(), 9), 300, &watch), "") << "said once";
}

TEST(PeopleWatchBooksTest, NobodyOnOneSideIsSaid) {
  EXPECT_EQ(WatchTen({}, TwoPeople()),
            "nobody in the left keypoints, 20 people in the right ones: only people in the left "
            "image are tracked");
  EXPECT_EQ(WatchTen(TwoPeople(), {}).find("nobody in the right keypoints, 20 people"), 0u);
  EXPECT_EQ(WatchTen({}, {TwoPeople()[0]}), "") << "ten are few";
}

}  // namespace
}  // namespace airdos
