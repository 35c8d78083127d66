// The checks of keypoints and masks: what they count, where their limits lie, which frame they
// name.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "common/check/check_pairs.h"
#include "common/check/check_people.h"
#include "tests/support/input_errors.h"
#include "tests/support/standing_person.h"

namespace airdos {
namespace {

Finding FirstOf(const FindingList& list, const std::string& kind) {
  for (const Finding& finding : list.findings()) {
    if (finding.kind == kind) return finding;
  }
  return {};
}

/// "error", "warning" or "note" of the first finding of a kind; "" for none.
std::string SeverityOf(const FindingList& list, const std::string& kind) {
  const Finding finding = FirstOf(list, kind);
  return finding.kind.empty() ? "" : NameOf(finding.severity);
}

StereoCamera Camera(int width, int height) {
  StereoCamera camera;
  camera.width = width;
  camera.height = height;
  return camera;
}

using Person = std::vector<BodyKeypoint>;

/// Somebody who faces the camera, COCO-18, the neck at (u, v); in proportion to `size`.
Person Standing(double u_px, double v_px, double size = 1) {
  Person person;
  for (const auto& place : kStanding)
    person.push_back({u_px + size * place[0], v_px + size * place[1], 0.9});
  return person;
}

CheckedPeople People(const std::string& where, const std::vector<Person>& people) {
  return {where, KeypointLayout::kCoco18, people};
}

/// What is found of some images in a camera of 1000 x 500 px.
FindingList OfPeople(const std::vector<CheckedPeople>& images) {
  KeypointCheck check(Camera(1000, 500));
  FindingList list;
  for (const CheckedPeople& image : images) check.Add(image, &list);
  check.Report("k", &list);
  return list;
}

/// Forty people of whom the last reaches to (u, v), the others to less.
FindingList UpTo(double u_px, double v_px) {
  std::vector<Person> people(39, Standing(100, 50));
  for (Person& person : people) person[10] = {u_px, v_px, 0.9};
  people.push_back(people[0]);
  return OfPeople({People("f", people)});
}

TEST(KeypointCheckValuesTest, AnExtentInTheUpperLeftOfBothSides) {
  EXPECT_EQ(SeverityOf(UpTo(540, 270), "keypoints.extent"), "warning");
  EXPECT_EQ(SeverityOf(UpTo(560, 270), "keypoints.extent"), "");
  EXPECT_EQ(SeverityOf(UpTo(540, 280), "keypoints.extent"), "");
  EXPECT_EQ(SeverityOf(OfPeople({People("f", std::vector<Person>(39, Standing(100, 50)))}),
                       "keypoints.extent"),
            "");
}

TEST(KeypointCheckValuesTest, OutsideIsBeyondAMarginAndTheFirstImageIsNamed) {
  const auto with = [](double u_px, double v_px) {
    Person person = Standing(300, 200);
    person[4] = {u_px, v_px, 0.9};
    return person;
  };
  for (const auto& [u, v] :
       {std::make_pair(1099.0, 200.0), {-99.0, 200.0}, {300.0, 549.0}, {300.0, -49.0}}) {
    EXPECT_EQ(SeverityOf(OfPeople({People("f", {with(u, v)})}), "keypoints.outside"), "") << u << v;
  }
  for (const auto& [u, v] :
       {std::make_pair(1101.0, 200.0), {-101.0, 200.0}, {300.0, 551.0}, {300.0, -51.0}}) {
    EXPECT_EQ(SeverityOf(OfPeople({People("f", {with(u, v)})}), "keypoints.outside"), "warning");
  }
  const Person inside = Standing(300, 200);
  const std::vector<Person> ten(10, inside);
  const FindingList few = OfPeople(
      {People("f0", ten), People("f1", {with(1200, 200)}), People("f2", {with(1200, 200)})});
  const Finding finding = FirstOf(few, "keypoints.outside");
  EXPECT_EQ(finding.severity, Severity::kNote);  // 2 of 216
  EXPECT_EQ(finding.where, "f1");
  EXPECT_TRUE(Holds(finding.what, "2 of 216 keypoints")) << finding.what;
}

TEST(KeypointCheckValuesTest, MoreThanAFifthOutsideIsAnotherSizeOfTheImage) {
  const auto with = [](int num) {
    Person person = Standing(300, 200);
    for (int i = 0; i < num; ++i) person[static_cast<std::size_t>(i)].u_px = 1500;
    return OfPeople({People("f", {person, person})});
  };
  EXPECT_EQ(SeverityOf(with(3), "keypoints.scale"), "");
  EXPECT_EQ(SeverityOf(with(4), "keypoints.scale"), "error");
}

TEST(KeypointCheckValuesTest, ConfidencesAndFlags) {
  const auto with = [](const std::vector<double>& confidences) {
    Person person = Standing(300, 200);
    for (std::size_t i = 0; i < person.size(); ++i)
      person[i].confidence = confidences[i % confidences.size()];
    return OfPeople({People("f", {person})});
  };
  EXPECT_EQ(SeverityOf(with({0.5, 1.9}), "keypoints.confidence"), "");
  EXPECT_EQ(SeverityOf(with({0.5, 2.1}), "keypoints.confidence"), "error");
  EXPECT_EQ(SeverityOf(with({0.5, -0.1}), "keypoints.confidence"), "error");
  EXPECT_EQ(SeverityOf(with({0, 1}), "keypoints.flags"), "note");
  EXPECT_EQ(SeverityOf(with({0, 1, 2}), "keypoints.flags"), "warning");
  EXPECT_EQ(SeverityOf(with({0, 1, 2, 0.5}), "keypoints.flags"), "");
}

/// A picture's mask, of which the first `num_columns` are marked, in an image of 100 x 50 px.
CheckedPictures Masked(const std::string& where, int num_columns,
                       const std::vector<Person>& people = {}) {
  CheckedPictures pictures;
  pictures.where_mask = where;
  pictures.mask.kind = "8-bit grey";
  pictures.mask.values = cv::Mat(50, 100, CV_8UC1, cv::Scalar(0));
  pictures.mask.values.colRange(0, num_columns).setTo(1);
  pictures.mask.pixels = pictures.mask.values != 0;
  pictures.people_left.people = people;
  return pictures;
}

FindingList OfMasks(const std::vector<CheckedPictures>& all) {
  MaskCheck check(Camera(100, 50));
  FindingList list;
  for (const CheckedPictures& pictures : all) check.Add(pictures, &list);
  check.Report("m", &list);
  return list;
}

TEST(MaskCheckValuesTest, TheFirstFullMaskIsNamed) {
  const Finding full = FirstOf(OfMasks({Masked("m0", 10), Masked("m1", 91), Masked("m2", 10),
                                        Masked("m3", 91), Masked("m4", 90)}),
                               "masks.full");
  EXPECT_EQ(full.severity, Severity::kWarning);
  EXPECT_EQ(full.where, "m1");
  EXPECT_TRUE(Holds(full.what, "in 2 of 5 masks")) << full.what;
  EXPECT_EQ(SeverityOf(OfMasks({Masked("m0", 91)}), "masks.coverage"), "error");
  EXPECT_EQ(SeverityOf(OfMasks({Masked("m0", 90)}), "masks.coverage"), "");
}

TEST(MaskCheckValuesTest, FewerKeypointsThanByChanceAreInverted) {
  const auto with = [](int num_inside) {  // of 60 keypoints; half of the image is marked
    Person person;
    for (int i = 0; i < 60; ++i) person.push_back({i < num_inside ? 20.0 : 80.0, 25, 0.9});
    return OfMasks({Masked("m0", 50, {person})});
  };
  EXPECT_EQ(SeverityOf(with(23), "masks.polarity"), "error");
  EXPECT_NE(SeverityOf(with(24), "masks.polarity"), "error");  // 0.8 of the 30 by chance
}

TEST(MaskCheckValuesTest, BothSidesAreThoseOfTheImage) {
  for (const cv::Size& size : {cv::Size(100, 51), cv::Size(101, 50)}) {
    CheckedPictures pictures = Masked("m0", 10);
    pictures.mask.values = pictures.mask.pixels = cv::Mat(size, CV_8UC1, cv::Scalar(0));
    const Finding finding = FirstOf(OfMasks({pictures}), "masks.size");
    EXPECT_EQ(finding.severity, Severity::kError);
    EXPECT_EQ(finding.where, "m0");
  }
}

/// So many frames with one person each, in a camera of 1200 x 400 px.
FindingList OfPairs(int num, double disparity_px, double rows_px, double size_right = 1) {
  PeoplePairCheck check(Camera(1200, 400));
  for (int i = 0; i < num; ++i) {
    const std::string frame = std::to_string(i);
    check.Add(
        {People("l" + frame, {Standing(300 + 20 * i, 150)}),
         People("r" + frame, {Standing(300 + 20 * i - disparity_px, 150 + rows_px, size_right)})});
  }
  FindingList list;
  check.Report("p", &list);
  return list;
}

TEST(PeoplePairValuesTest, TenPairsSayWhichSideIsWhich) {
  EXPECT_TRUE(OfPairs(9, 12, 0).findings().empty());
  const Finding pairs = FirstOf(OfPairs(10, 12, 0), "keypoints.pairs");
  EXPECT_TRUE(Holds(pairs.what, "10 people seen in both images: 100 % have a positive"))
      << pairs.what;
  EXPECT_TRUE(Holds(pairs.what, "median 12 px")) << pairs.what;
  EXPECT_EQ(SeverityOf(OfPairs(10, -12, 0), "keypoints.swapped"), "error");
}

// A hundredth of the height is 4 px.
TEST(PeoplePairValuesTest, RowsByTheHeightOfTheImage) {
  EXPECT_EQ(SeverityOf(OfPairs(12, 12, 3.9), "keypoints.rows"), "");
  EXPECT_EQ(SeverityOf(OfPairs(12, 12, 4.1), "keypoints.rows"), "warning");
  EXPECT_EQ(SeverityOf(OfPairs(12, 12, -4.1), "keypoints.rows"), "warning");
}

TEST(PeoplePairValuesTest, OtherResolutionsOnEitherSide) {
  EXPECT_EQ(SeverityOf(OfPairs(15, 12, 0, 0.5), "keypoints.resolution"), "error");
  EXPECT_EQ(SeverityOf(OfPairs(15, 12, 0, 2), "keypoints.resolution"), "error");
  EXPECT_EQ(SeverityOf(OfPairs(14, 12, 0, 2), "keypoints.resolution"), "");
  EXPECT_EQ(SeverityOf(OfPairs(15, 12, 0, 1.1), "keypoints.resolution"), "");
}

TEST(PeoplePairValuesTest, ACopyIsThatOfMostFramesAndTheFirstIsNamed) {
  const auto copies = [](int num_same, int num_frames) {
    PeoplePairCheck check(Camera(1200, 400));
    for (int i = 0; i < num_frames; ++i) {
      const Person left = Standing(300, 150);
      const Person right = i < num_same ? left : Standing(290, 150);
      check.Add(
          {People("l" + std::to_string(i), {left}), People("r" + std::to_string(i), {right})});
    }
    FindingList list;
    check.Report("p", &list);
    return list;
  };
  EXPECT_EQ(SeverityOf(copies(2, 4), "keypoints.identical"), "");
  EXPECT_EQ(SeverityOf(copies(3, 4), "keypoints.identical"), "error");
  EXPECT_EQ(FirstOf(copies(3, 4), "keypoints.identical").where, "r0");
  EXPECT_EQ(SeverityOf(copies(1, 1), "keypoints.identical"), "");
}

TEST(PeoplePairValuesTest, PeopleOnOneSideOnly) {
  for (const bool is_left : {true, false}) {
    PeoplePairCheck check(Camera(1200, 400));
    const CheckedPeople some = People("s", {Standing(300, 150), Standing(500, 150)});
    const CheckedPeople none = People("n", {});
    check.Add(is_left ? StereoPeople{some, none} : StereoPeople{none, some});
    FindingList list;
    check.Report("p", &list);
    const Finding finding = FirstOf(list, "keypoints.one_side");
    EXPECT_EQ(finding.severity, Severity::kWarning);
    EXPECT_TRUE(Holds(finding.what, is_left
                                        ? "2 people in the left images, no keypoints in the right"
                                        : "2 people in the right images, no keypoints in the left"))
        << finding.what;
  }
}

}  // namespace
}  // namespace airdos
