// Keypoints as other programs write them: each format and layout joint by joint, and what is
// refused.
#include "common/dataset/keypoints/foreign_keypoints.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

using Json = nlohmann::json;

/// Joint j at (10 + j, 100 + 2 j) with confidence 0.3 + 0.001 j.
Json Joints(int num_joints) {
  Json numbers = Json::array();
  for (int j = 0; j < num_joints; ++j) {
    numbers.push_back(10 + j);
    numbers.push_back(100 + 2 * j);
    numbers.push_back(0.3 + 0.001 * j);
  }
  return numbers;
}

Json AlphaPosePerson(const Json& image, int num_joints) {
  return {{"image_id", image}, {"category_id", 1},          {"keypoints", Joints(num_joints)},
          {"score", 3.03},     {"box", {1.5, 2.5, 30, 40}}, {"idx", {0.0}}};
}

Json OpenPosePerson(int num_joints) {
  return {{"person_id", {-1}}, {"pose_keypoints_2d", Joints(num_joints)}};
}

/// The same in BODY_25, with the nose where joint 16 is, an eye.
Json Body25Person() {
  Json person = OpenPosePerson(25);
  for (std::size_t i = 0; i < 3; ++i) {
    person["pose_keypoints_2d"][i] = person["pose_keypoints_2d"][3 * 16 + i];
  }
  return person;
}

class ForeignKeypointsTest : public ::testing::Test {
 protected:
  ForeignKeypoints Read(const Json& json) const {
    return ReadForeignKeypoints(folder_.Write("results.json", json.dump()));
  }
  std::string Refusal(const std::string& text) const {
    const std::string path = folder_.Write("results.json", text);
    return ErrorOf([&] { ReadForeignKeypoints(path); });
  }
  /// That joint of COCO-18 is the joint at this place of the layout.
  static void ExpectJoint(const PersonKeypoints& person, std::size_t joint, int place) {
    EXPECT_FLOAT_EQ(person[joint].u_px, 10.F + static_cast<float>(place)) << joint;
    EXPECT_FLOAT_EQ(person[joint].v_px, 100.F + 2.F * static_cast<float>(place)) << joint;
    EXPECT_FLOAT_EQ(person[joint].confidence, 0.3F + 0.001F * static_cast<float>(place)) << joint;
  }
  static void ExpectJoints(const ForeignKeypoints& read, const std::vector<int>& places) {
    ASSERT_EQ(read.images.size(), 1u);
    ASSERT_EQ(read.images[0].people.size(), 1u);
    ASSERT_EQ(read.images[0].people[0].size(), 18u);
    for (std::size_t joint = 0; joint < 18; ++joint) {
      if (places[joint] >= 0) ExpectJoint(read.images[0].people[0], joint, places[joint]);
    }
  }
  ScratchFolder folder_{"foreign_keypoints"};
};

// Nose, neck, right arm, left arm, right leg, left leg, eyes and ears (right, left).
const std::vector<int> kOfCoco17 = {0, -1, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15, 2, 1, 4, 3};
const std::vector<int> kOfHalpe = {0, 18, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15, 2, 1, 4, 3};
const std::vector<int> kOfBody25 = {0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18};
const std::vector<int> kOfCoco18 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};

TEST_F(ForeignKeypointsTest, AlphaPoseInEachLayout) {
  struct Case {
    int num_joints;
    ForeignLayout layout;
    const char* name;
    const std::vector<int>* places;
  };
  for (const Case& c : {Case{17, ForeignLayout::kCoco17, "COCO-17", &kOfCoco17},
                        Case{26, ForeignLayout::kHalpe26, "Halpe-26", &kOfHalpe},
                        Case{136, ForeignLayout::kHalpe136, "Halpe-136", &kOfHalpe},
                        Case{133, ForeignLayout::kWholeBody133, "COCO-WholeBody", &kOfCoco17}}) {
    const ForeignKeypoints read = Read(Json::array({AlphaPosePerson("000012.jpg", c.num_joints)}));
    EXPECT_EQ(read.program, "AlphaPose");
    ASSERT_TRUE(read.layout);
    EXPECT_EQ(*read.layout, c.layout);
    EXPECT_EQ(NameOf(*read.layout), c.name);
    EXPECT_TRUE(read.notes.empty());
    ExpectJoints(read, *c.places);
  }
}

// The neck that COCO-17 lacks is the middle of the shoulders, and only where both are seen.
TEST_F(ForeignKeypointsTest, NeckOfCoco17) {
  Json person = AlphaPosePerson("a.jpg", 17);
  const Keypoint neck = Read(Json::array({person})).images[0].people[0][1];
  EXPECT_FLOAT_EQ(neck.u_px, 15.5F);
  EXPECT_FLOAT_EQ(neck.v_px, 111.F);
  EXPECT_FLOAT_EQ(neck.confidence, 0.305F) << "the lower one, of the left shoulder";
  for (int i = 0; i < 3; ++i) person["keypoints"][3 * 6 + i] = 0;
  const PersonKeypoints one_sided = Read(Json::array({person})).images[0].people[0];
  EXPECT_EQ(one_sided[1].confidence, 0);
  EXPECT_EQ(one_sided[2].confidence, 0);
  EXPECT_EQ(one_sided[2].u_px, 0);
  EXPECT_GT(one_sided[5].confidence, 0);
}

TEST_F(ForeignKeypointsTest, PeopleOfAnImageStayTogetherWhateverTheirIdentity) {
  Json list = Json::array();
  for (const Json& idx : {Json("1"), Json(2), Json({{0.0}, {1.0}}), Json()}) {
    list.push_back(AlphaPosePerson("b.jpg", 17));
    list.back()["idx"] = idx;
  }
  list.insert(list.begin() + 1, AlphaPosePerson("a.jpg", 17));
  list.push_back(AlphaPosePerson(7, 17));
  const ForeignKeypoints read = Read(list);
  ASSERT_EQ(read.images.size(), 3u);
  EXPECT_EQ(read.images[0].name, "b.jpg");
  EXPECT_EQ(read.images[0].people.size(), 4u);
  EXPECT_EQ(read.images[1].name, "a.jpg");
  EXPECT_EQ(read.images[2].name, "7");
}

TEST_F(ForeignKeypointsTest, CocoResultsHaveNumbersAndNoBoxes) {
  const Json person = {
      {"image_id", 42}, {"category_id", 1}, {"keypoints", Joints(17)}, {"score", 0.9}};
  const ForeignKeypoints read = Read(Json::array({person}));
  EXPECT_EQ(read.program, "COCO results");
  ExpectJoints(read, kOfCoco17);
  EXPECT_EQ(read.images[0].name, "42");
  EXPECT_TRUE(Read(Json::array()).images.empty());
}

TEST_F(ForeignKeypointsTest, OpenPoseHasAFileAnImage) {
  const auto file = [](const Json& people) {
    return Json({{"version", 1.3}, {"people", people}}).dump();
  };
  folder_.Write("pose/cam_000000000003_keypoints.json", file(Json::array({Body25Person()})));
  folder_.Write("pose/cam_000000000004_keypoints.json",
                file({{{"pose_keypoints_2d", Json::array()}}, Body25Person()}));
  folder_.Write("pose/cam_000000000005_keypoints.json", file(Json::array()));
  folder_.Write("pose/.hidden.json", "no JSON");
  const ForeignKeypoints read = ReadForeignKeypoints(folder_.PathOf("pose"));
  EXPECT_EQ(read.program, "OpenPose");
  EXPECT_EQ(read.layout, ForeignLayout::kBody25);
  ASSERT_EQ(read.images.size(), 3u);
  EXPECT_EQ(read.images[0].name, "cam_000000000003");
  ASSERT_EQ(read.images[1].people.size(), 1u);
  EXPECT_TRUE(read.images[2].people.empty());
  ExpectJoint(read.images[0].people[0], 0, 16);
  for (std::size_t joint = 1; joint < 18; ++joint) {
    ExpectJoint(read.images[0].people[0], joint, kOfBody25[joint]);
  }
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_TRUE(Holds(read.notes[0], "1 person has no joint that is seen"));
}

TEST_F(ForeignKeypointsTest, OpenPoseInCoco18AndAsItWasBefore) {
  ExpectJoints(Read({{"people", Json::array({OpenPosePerson(18)})}}), kOfCoco18);
  ExpectJoints(Read({{"people", Json::array({{{"pose_keypoints", Joints(18)}}})}}), kOfCoco18);
}

/// Somebody upright, by the places of eyes, ears, neck, shoulders and hips in the layout; all else
/// is not seen.
Json Upright(const std::vector<std::array<double, 3>>& places_and_uv) {
  Json numbers = std::vector<double>(75, 0);
  for (const auto& [place, u_px, v_px] : places_and_uv) {
    const auto at = 3 * static_cast<std::size_t>(place);
    numbers[at] = u_px;
    numbers[at + 1] = v_px;
    numbers[at + 2] = 0.7;
  }
  return {{"pose_keypoints_2d", numbers}};
}

// Both have 75 numbers; whose joints lie around the nose tells which it is.
TEST_F(ForeignKeypointsTest, Body25AndBody25BAreToldApart) {
  const Json body25 = Upright({{0, 100, 50},
                               {15, 95, 45},
                               {16, 105, 45},
                               {17, 90, 48},
                               {1, 100, 80},
                               {2, 80, 80},
                               {3, 75, 120},
                               {9, 90, 150}});
  const Json body25b = Upright({{0, 100, 50},
                                {2, 95, 45},
                                {1, 105, 45},
                                {4, 90, 48},
                                {17, 100, 70},
                                {18, 100, 20},
                                {6, 80, 80},
                                {5, 120, 82},
                                {12, 90, 150}});
  const Json unclear = Upright({{0, 100, 50}, {1, 300, 50}, {15, 101, 50}});
  const ForeignKeypoints first = Read({{"people", Json::array({body25, body25, body25b})}});
  EXPECT_EQ(first.layout, ForeignLayout::kBody25);
  EXPECT_EQ(first.images[0].people[0][8].u_px, 90) << "right hip";
  EXPECT_EQ(first.images[0].people[0][1].v_px, 80) << "neck";
  const ForeignKeypoints second = Read({{"people", Json::array({unclear, body25b})}});
  EXPECT_EQ(second.layout, ForeignLayout::kBody25B);
  ASSERT_EQ(second.images[0].people.size(), 2u);
  const PersonKeypoints& person = second.images[0].people[1];
  EXPECT_EQ(person[8].u_px, 90) << "right hip";
  EXPECT_EQ(person[1].u_px, 100) << "neck: the middle of the shoulders";
  EXPECT_EQ(person[1].v_px, 81);
  EXPECT_EQ(person[14].u_px, 95) << "right eye";
  EXPECT_EQ(person[16].u_px, 90) << "right ear";
  EXPECT_EQ(Read({{"people", Json::array({unclear})}}).layout, ForeignLayout::kBody25);
}

TEST_F(ForeignKeypointsTest, FilesLikeOpenPoseHaveOtherLayoutsToo) {
  ExpectJoints(Read({{"people", Json::array({OpenPosePerson(17)})}}), kOfCoco17);
  ExpectJoints(Read({{"people", Json::array({OpenPosePerson(26)})}}), kOfHalpe);
}

TEST_F(ForeignKeypointsTest, LinesOfNumbersInEachLayout) {
  for (const auto& [num_joints, places] :
       {std::make_pair(18, &kOfCoco18), {17, &kOfCoco17}, {26, &kOfHalpe}}) {
    std::string row;
    for (const Json& number : Joints(num_joints)) row += number.dump() + " ";
    folder_.Write("lines/000007.txt", row + "\n");
    const ForeignKeypoints read = ReadForeignKeypoints(folder_.PathOf("lines"));
    EXPECT_EQ(read.program, "lines of numbers");
    EXPECT_EQ(read.images[0].name, "000007");
    ExpectJoints(read, *places);
  }
}

TEST_F(ForeignKeypointsTest, AFolderWithOneListIsThatList) {
  folder_.Write("out/alphapose-results.json", Json::array({AlphaPosePerson("3.jpg", 26)}).dump());
  const ForeignKeypoints read = ReadForeignKeypoints(folder_.PathOf("out"));
  EXPECT_EQ(read.program, "AlphaPose");
  EXPECT_EQ(read.images[0].name, "3.jpg");
}

TEST_F(ForeignKeypointsTest, AFewConfidencesAboveOneAreOne) {
  Json person = AlphaPosePerson("a.jpg", 17);
  person["keypoints"][2] = 1.4;
  person["keypoints"][5] = -0.5;
  const ForeignKeypoints read = Read(Json::array({person}));
  EXPECT_EQ(read.images[0].people[0][0].confidence, 1.F);
  EXPECT_EQ(read.images[0].people[0][15].confidence, 0.F) << "the left eye";
  ExpectJoint(read.images[0].people[0], 14, 2);
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_TRUE(Holds(read.notes[0], "1 of 17 joints have a confidence above 1, up to 1.4: taken"));
}

// Percent, or COCO's visibility of 0, 1 and 2.
TEST_F(ForeignKeypointsTest, OtherScalesOfConfidenceAreDivided) {
  Json person = AlphaPosePerson("a.jpg", 17);
  for (std::size_t j = 0; j < 17; ++j) person["keypoints"][3 * j + 2] = j == 0 ? 0 : j == 5 ? 1 : 2;
  const ForeignKeypoints read = Read(Json::array({person}));
  EXPECT_EQ(read.images[0].people[0][0].confidence, 0.F);
  EXPECT_EQ(read.images[0].people[0][5].confidence, 0.5F);
  EXPECT_EQ(read.images[0].people[0][4].confidence, 1.F);
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_TRUE(Holds(read.notes[0], "up to 2: all are divided by that"));
}

TEST_F(ForeignKeypointsTest, CoordinatesRelativeToTheImageAreRefused) {
  Json person = AlphaPosePerson("a.jpg", 17);
  for (std::size_t j = 0; j < 17; ++j) {
    person["keypoints"][3 * j] = 0.02 * static_cast<double>(j);
    person["keypoints"][3 * j + 1] = -0.9;
  }
  EXPECT_TRUE(Holds(Refusal(Json::array({person}).dump()), "are relative to the image's size"));
  person["keypoints"][0] = 31;  // one in px is enough
  EXPECT_EQ(Refusal(Json::array({person}).dump()), "");
}

TEST_F(ForeignKeypointsTest, WhatIsRefusedSaysWhereAndWhy) {
  const auto expect = [this](const std::string& text, const std::string& part) {
    const std::string said = Refusal(text);
    EXPECT_TRUE(Holds(said, folder_.PathOf("results.json"))) << said;
    EXPECT_TRUE(Holds(said, part)) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  };
  expect("[\n {\"image_id\": \"1\", \"keypoints\": [1, NaN]}]", ":2: column 37: NaN is not JSON");
  expect("[{\"score\": ,}]", ":1: column 12: this is not JSON at the character ','");
  expect("[{\"image_id\": \"1.jpg\", \"keypoi", "cut short?");
  expect(Json::array({AlphaPosePerson("1", 16)}).dump(),
         "entry 0: holds 48 numbers a person: this looks like MPII");
  expect(Json::array({AlphaPosePerson("1", 17), AlphaPosePerson("1", 26)}).dump(),
         "entry 1: holds a person in Halpe-26, those before are in COCO-17");
  expect(R"([{"image_id": [1], "keypoints": []}])", "entry 0: its image_id is neither");
  expect(R"([{"keypoints": []}])", "entry 0: has no 'image_id'");
  expect(R"([{"image_id": 1}])", "entry 0: has no 'keypoints'");
  expect(R"([{"image_id": 1, "keypoints": [1, 2, "3"]}])", "a value of type string");
  expect(R"([{"image_id": 1, "keypoints": [[1, 2]]}])", "joints of 2 numbers");
  expect(R"([{"image_id": 1, "keypoints": 3}])", "not a list of numbers");
  expect("[7]", "entry 0 of the list is not an object");
  expect("[[]]", "entry 0 of the list is not an object");
  expect("[{\"image_id\": 1, \"keypoints\": [1e999]}]", "too large");
  expect(std::string(100000, '['), "entry 0 of the list is not an object");
  expect("{\"a\":" + std::string(100000, '['), "nested more than 12 deep");
  expect(R"({"images": [], "annotations": []})", "COCO annotations, not results");
  expect(R"({"1.jpg": [{"keypoints": []}]})", "has neither 'people'");
  expect(R"({"people": 3})", "its people are not a list");
  expect(R"({"people": [3]})", "person 0: is not an object");
  expect(R"({"people": [{}]})", "person 0: has no 'pose_keypoints_2d'");
  expect(Json({{"people", Json::array({OpenPosePerson(15)})}}).dump(),
         "this looks like OpenPose's MPI");
  expect("1 2 3\n", "is not JSON");
  EXPECT_TRUE(Holds(ErrorOf([&] { ReadForeignKeypoints(folder_.Write("a.txt", "1 2 3\n")); }),
                    "give their folder"));
  EXPECT_TRUE(Holds(ErrorOf([&] { ReadForeignKeypoints(folder_.PathOf("none.json")); }), "none"));
}

TEST_F(ForeignKeypointsTest, FoldersThatAreNotClearAreRefused) {
  const std::string person = Json({{"people", Json::array({OpenPosePerson(25)})}}).dump();
  folder_.Write("empty/image.png", "");
  folder_.Write("both/1.json", person);
  folder_.Write("both/1.txt", "");
  folder_.Write("lists/1.json", Json::array({AlphaPosePerson("1", 17)}).dump());
  folder_.Write("lists/2.json", person);
  folder_.Write("mixed/1.json", person);
  folder_.Write("mixed/2.json", Json({{"people", Json::array({OpenPosePerson(18)})}}).dump());
  const auto said = [this](const std::string& name) {
    return ErrorOf([&] { ReadForeignKeypoints(folder_.PathOf(name)); });
  };
  EXPECT_TRUE(Holds(said("empty"), "holds no .json or .txt file")) << said("empty");
  EXPECT_TRUE(Holds(said("both"), "which are the keypoints?")) << said("both");
  EXPECT_TRUE(Holds(said("lists"), "a list of people beside 1 other")) << said("lists");
  EXPECT_TRUE(Holds(said("mixed"), "2.json: person 0: holds a person in COCO-18")) << said("mixed");
}

}  // namespace
}  // namespace airdos
