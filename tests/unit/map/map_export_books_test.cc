// What an export makes of a map: each pose in its file, each number in its column, worked out by
// hand.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "common/human/skeleton.h"
#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

Se3 Pose(double x) { return {Eigen::Quaterniond(0.1, 0.5, -0.5, 0.7), {x, x + 0.25, -x}}; }

std::string Row(const std::string& time_s, const std::string& x, const std::string& y,
                const std::string& z) {
  return time_s + " " + x + "000000 " + y + "000000 " + z +
         "000000 0.500000000000 -0.500000000000 0.700000000000 0.100000000000\n";
}

class MapExportBooksTest : public ::testing::Test {
 protected:
  MapExportBooksTest()
      : folder_(testing::TempDir() + "airdos_map_export_" + std::to_string(getpid())) {
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/a.map") << "stands for the map";
  }
  ~MapExportBooksTest() override { fs::remove_all(folder_); }
  int Export(const FourDMap& map, bool force = false) const {
    int num_replaced = 0;
    ExportMap(map, folder_ + "/a.map", folder_ + "/out", force, &num_replaced);
    return num_replaced;
  }
  std::string Text(const std::string& name) const {
    std::ifstream file(folder_ + "/out/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  bool Has(const std::string& name) const { return fs::exists(folder_ + "/out/" + name); }

  std::string folder_;
};

/// Live alone, both, refined alone, none but the truth, and two whose times do not go on.
FourDMap Frames() {
  FourDMap map;
  map.frames[{1}].utime = 1000001;
  map.frames[{1}].live = Pose(1);
  map.frames[{2}].utime = 2000002;
  map.frames[{2}].live = Pose(2);
  map.frames[{2}].refined = Pose(3);
  map.frames[{2}].ground_truth = Pose(8);
  map.frames[{3}].utime = 3000003;
  map.frames[{3}].refined = Pose(4);
  map.frames[{3}].ground_truth = Pose(9);
  map.frames[{4}].utime = 3500000;
  map.frames[{5}].utime = 3000003;
  map.frames[{5}].refined = Pose(5);
  map.frames[{6}].utime = 2500000;
  map.frames[{6}].live = Pose(6);
  return map;
}

TEST_F(MapExportBooksTest, EachPoseStandsInItsFile) {
  FourDMap map = Frames();
  map.ground_truth_axes = 1;
  Export(map);
  EXPECT_EQ(Text("trajectory.tum"),
            "# left out: 2 poses whose time is not later than that of an earlier image\n" +
                Row("1.000001", "1.000", "1.250", "-1.000") +
                Row("2.000002", "3.000", "3.250", "-3.000") +
                Row("3.000003", "4.000", "4.250", "-4.000"));
  EXPECT_EQ(Text("trajectory_live.tum"), Row("1.000001", "1.000", "1.250", "-1.000") +
                                             Row("2.000002", "2.000", "2.250", "-2.000") +
                                             Row("2.500000", "6.000", "6.250", "-6.000"));
  EXPECT_EQ(Text("ground_truth.tum"), "# axes: optical (x right, y down, z forward)\n" +
                                          Row("2.000002", "8.000", "8.250", "-8.000") +
                                          Row("3.000003", "9.000", "9.250", "-9.000"));
  map.ground_truth_axes = 2;
  Export(map);
  EXPECT_EQ(Text("ground_truth.tum").substr(0, 41), "# axes: NED (x forward, y right, z down)\n");
  map.ground_truth_axes = 0;
  Export(map);
  EXPECT_EQ(Text("ground_truth.tum").substr(0, 16), "# axes: unknown\n");
}

// Row by row the rotation of (w, x, y, z) = (0.1, 0.5, -0.5, 0.7), by the textbook, and the place.
TEST_F(MapExportBooksTest, AKittiRowIsTheMatrixRowByRow) {
  FourDMap map;
  map.frames[{1}].live = Pose(2);
  Export(map);
  std::istringstream row(Text("trajectory.kitti"));
  const double expected[] = {-0.48, -0.64, 0.6, 2, -0.36, -0.48, -0.8, 2.25, 0.8, -0.6, 0, -2};
  for (const double value : expected) {
    double read = 99;
    row >> read;
    EXPECT_NEAR(read, value, 1e-9);
  }
  std::string rest;
  EXPECT_FALSE(row >> rest);
  const std::string kitti = Text("trajectory.kitti");
  EXPECT_EQ(std::count(kitti.begin(), kitti.end(), '\n'), 1);
}

MapHuman Person(const std::vector<int>& joints) {
  MapHuman human;
  human.utime = 1500000;
  for (const int joint : joints) {
    const auto k = static_cast<float>(joint);
    human.joints[joint] = {{k, 2 * k, 3 * k}, {100 + k, 200 + k, 300 + k}};
  }
  return human;
}

// A person who is not seen whole is where what is seen of the torso is: neck 1, right shoulder 2.
TEST_F(MapExportBooksTest, ATorsoIsTheMeanOfWhatIsSeenOfIt) {
  const std::optional<Se3> pose = TorsoPose(Person({kNose, kNeck, kRightShoulder}));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->translation, Eigen::Vector3d(1.5, 3, 4.5));
  EXPECT_EQ(pose->rotation.w(), 1);
}

// Neck above the middle of the hips; the right hip lies in the world's z, so the person looks along
// x.
TEST_F(MapExportBooksTest, ATorsoLooksAcrossItsHips) {
  MapHuman human;
  human.joints[kNeck].p_W = {1, 2, 3};
  human.joints[kRightHip].p_W = {1, 3, 3.25F};
  human.joints[kLeftHip].p_W = {1, 3, 2.75F};
  const Se3 T_W_H = *TorsoPose(human);
  EXPECT_EQ(T_W_H.translation, Eigen::Vector3d(1, 2.5, 3));
  Eigen::Matrix3d R_W_H;  // columns: to the right, down, forward
  R_W_H << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  EXPECT_NEAR((T_W_H.rotation.toRotationMatrix() - R_W_H).norm(), 0, 1e-12);

  FourDMap map;
  human.utime = 7000000;
  map.humans[{{1}, {3}}] = human;
  Export(map);
  EXPECT_EQ(Text("people/3.tum").substr(0, 46), "7.000000 1.000000000 2.500000000 3.000000000 0");
  std::istringstream row(Text("people/3.tum"));
  std::vector<double> numbers{std::istream_iterator<double>(row), {}};
  ASSERT_EQ(numbers.size(), 8u);
  EXPECT_NEAR(numbers[5], -std::sqrt(0.5), 1e-9) << "a quarter turn about y, to the left";
  EXPECT_NEAR(numbers[7], std::sqrt(0.5), 1e-9);
}

TEST_F(MapExportBooksTest, JointsAndMeasuredJointsKeepTheirPlaces) {
  EXPECT_EQ(HumanToJson({17}, {3}, Person({2, 5})),
            R"({"seq":17,"utime":1500000,"track":3,"joints":{"2":[2.0,4.0,6.0],)"
            R"("5":[5.0,10.0,15.0]},"measured":{"2":[102.0,202.0,302.0],)"
            R"("5":[105.0,205.0,305.0]},"segment_lengths_m":{}})");
}

// The map's floats, to the bit, and no digit more than that takes.
TEST_F(MapExportBooksTest, NumbersOfPeopleAreThoseOfTheMap) {
  MapHuman human;
  human.utime = (std::int64_t{1} << 53) + 1;  // no double
  human.joints[kNeck].p_W = {1.0F / 3, -123.4567F, 1e-7F};
  human.segment_lengths_m[2] = 0.1F;
  const std::string line = HumanToJson({17}, {3}, human);
  const nlohmann::json json = nlohmann::json::parse(line);
  EXPECT_EQ(json["utime"].get<std::int64_t>(), human.utime);
  const auto p_W = json["joints"]["1"].get<std::vector<float>>();
  EXPECT_EQ(Eigen::Vector3f(p_W.at(0), p_W.at(1), p_W.at(2)), human.joints[kNeck].p_W) << line;
  EXPECT_NE(line.find("[0.33333334,-123.4567,1e-07]"), std::string::npos) << line;
  EXPECT_NE(line.find("{\"2\":0.1}"), std::string::npos) << line;
}

// What an earlier export left goes, what others have there stays.
TEST_F(MapExportBooksTest, AnExportReplacesTheOneBeforeAndNothingElse) {
  FourDMap map;
  map.humans[{{1}, {3}}] = map.humans[{{1}, {4}}] = Person({kNeck});
  map.frames[{1}].ground_truth = Pose(1);
  EXPECT_EQ(Export(map), 0);
  std::ofstream(folder_ + "/out/people/notes.tum") << "mine";
  EXPECT_TRUE(Has("people/4.tum") && Has("ground_truth.tum"));
  map.humans.erase({{1}, {4}});
  map.frames.clear();
  EXPECT_EQ(Export(map), 8) << "four of the camera, map, people and the two of them";
  EXPECT_TRUE(Has("people/3.tum"));
  EXPECT_FALSE(Has("people/4.tum"));
  EXPECT_FALSE(Has("ground_truth.tum"));
  EXPECT_TRUE(Has("people/notes.tum"));
}

TEST_F(MapExportBooksTest, AForeignFileInTheWayIsNotReplaced) {
  FourDMap map;
  map.humans[{{1}, {3}}] = Person({kNeck});
  for (const char* name : {"trajectory.kitti", "people/77.tum"}) {
    fs::remove_all(folder_ + "/out");
    fs::create_directories(folder_ + "/out/people");
    std::ofstream(folder_ + "/out/" + name) << "mine";
    EXPECT_THROW(Export(map), InputError) << name;
    EXPECT_EQ(Text(name), "mine");
    EXPECT_FALSE(Has("trajectory.tum")) << "nothing is begun";
  }
}

}  // namespace
}  // namespace airdos
