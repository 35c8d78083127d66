#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/human/skeleton.h"
#include "common/map/byte_io.h"
#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/map/map_file.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string TextOf(const std::string& path) {
  const std::vector<std::uint8_t> bytes = BytesOf(path);
  return {bytes.begin(), bytes.end()};
}

class MapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        (fs::temp_directory_path() / ("airdos_map_test_" + std::to_string(getpid()))).string();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ + "/map.airdos";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string folder_;
  std::string path_;
};

Se3 PoseAt(double x) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * x, Eigen::Vector3d::UnitY())), {x, 2, -3}};
}

MapFrame LiveFrame(std::int64_t utime, double x) {
  MapFrame frame;
  frame.utime = utime;
  frame.live = PoseAt(x);
  frame.status = 2;
  frame.is_trusted_with_people = true;
  return frame;
}

MapFrame RefinedFrame(double x) {
  MapFrame frame;
  frame.refined = PoseAt(x);
  return frame;
}

MapHuman Person(float x) {
  MapHuman human;
  human.utime = 1500000;
  human.joints[kNeck] = {{x, 0, 5}, {x + 1, 0, 5}};
  human.joints[kRightHip] = {{x + 0.1f, 0.5f, 5}, {x, 0, 0}};
  human.joints[kLeftHip] = {{x - 0.1f, 0.5f, 5}, {x, 0, 0}};
  human.segment_lengths_m[4] = 0.2f;
  human.part_motions[0] = {{0.1f, 0, 0}, Eigen::Quaternionf(0.6f, 0, 0.8f, 0)};
  return human;
}

/// Four chunks: head, two of changes, end.
void WriteSmallMap(const std::string& path) {
  MapFileWriter writer(path);
  writer.Append(HeadChunk(77, "test 1"));
  MapDelta changes;
  changes.SetFrame({0}, LiveFrame(1000001, 0));
  changes.SetFrame({1}, LiveFrame(1100000, 1));
  changes.SetFrame({0}, RefinedFrame(0.5));
  changes.SetLandmark({5}, {{1, 2, 3}, 0.1f, 4});
  changes.SetLandmark({6}, {{4, 5, 6}, 0.2f, 2});
  changes.SetHuman({0}, {3}, Person(1));
  writer.Append(changes.ToChunk());
  changes = MapDelta();
  changes.SetFrame({0}, RefinedFrame(0.7));
  changes.SetLandmark({5}, {{1.5f, 2, 3}, 0.05f, 9});
  changes.RemoveLandmark({6});
  changes.SetHuman({0}, {3}, Person(2));
  MapFrame truth;
  truth.utime = 1100000;
  truth.ground_truth = PoseAt(9);
  changes.SetFrame({1}, truth);
  writer.Append(changes.ToChunk());
  StereoCamera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx_px = camera.fy_px = 700;
  camera.baseline_m = 0.25;
  writer.Append(EndChunk(camera, 2));
}

TEST_F(MapTest, LastOneWins) {
  WriteSmallMap(path_);
  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(path_, &summary);
  EXPECT_EQ(summary.num_chunks, 4);
  EXPECT_EQ(summary.num_bytes_dropped, 0);
  EXPECT_EQ(summary.drop_reason, "");
  EXPECT_EQ(map.session, 77);
  EXPECT_EQ(map.program, "test 1");
  EXPECT_TRUE(map.is_closed);
  EXPECT_EQ(map.ground_truth_axes, 2);
  ASSERT_TRUE(map.camera);
  EXPECT_EQ(map.camera->baseline_m, 0.25);

  ASSERT_EQ(map.frames.size(), 2u);
  const MapFrame& first = map.frames.at({0});
  EXPECT_EQ(first.utime, 1000001);
  EXPECT_EQ(first.status, 2);
  EXPECT_TRUE(first.is_trusted_with_people);
  EXPECT_EQ(first.live->translation, PoseAt(0).translation);
  EXPECT_EQ(first.refined->translation, PoseAt(0.7).translation);
  EXPECT_EQ(first.refined->rotation.coeffs(), PoseAt(0.7).rotation.coeffs());
  EXPECT_EQ(first.best()->translation.x(), 0.7);
  EXPECT_EQ(map.frames.at({1}).best()->translation.x(), 1);
  EXPECT_EQ(map.frames.at({1}).ground_truth->translation.x(), 9);

  ASSERT_EQ(map.landmarks.size(), 1u);
  EXPECT_EQ(map.landmarks.at({5}).p_W, Eigen::Vector3f(1.5f, 2, 3));
  EXPECT_EQ(map.landmarks.at({5}).num_observations, 9);
  ASSERT_EQ(map.humans.size(), 1u);
  const MapHuman& human = map.humans.at({{0}, {3}});
  EXPECT_EQ(human.joints.at(kNeck).p_W.x(), 2);
  EXPECT_EQ(human.joints.at(kNeck).p_W_measured.x(), 3);
  EXPECT_EQ(human.segment_lengths_m.at(4), 0.2f);
  EXPECT_EQ(human.part_motions.at(0).R_W.y(), 0.8f);
  EXPECT_EQ(human.part_motions.at(0).t_W.x(), 0.1f);
}

TEST_F(MapTest, ALandmarkMayComeBackAfterItWasRemoved) {
  MapDelta changes;
  changes.SetLandmark({1}, {});
  changes.RemoveLandmark({1});
  changes.SetLandmark({1}, {{7, 0, 0}, 0, 1});
  changes.SetLandmark({2}, {});
  changes.RemoveLandmark({2});
  FourDMap map;
  map.landmarks[{2}] = {};
  changes.Apply(&map);
  ASSERT_EQ(map.landmarks.size(), 1u);
  EXPECT_EQ(map.landmarks.at({1}).p_W.x(), 7);
}

TEST_F(MapTest, TruncationAtEveryByteKeepsTheWholeChunks) {
  WriteSmallMap(path_);
  const std::vector<std::uint8_t> whole = BytesOf(path_);
  std::vector<std::size_t> ends;  // of the chunks
  {
    std::size_t position = 12;
    while (position < whole.size()) {
      ByteReader head(whole.data() + position + 8, 4);
      position += 12 + head.U32();
      ends.push_back(position);
    }
  }
  ASSERT_EQ(ends.size(), 4u);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + static_cast<long>(size));
    if (size < 12) {
      EXPECT_THROW(ParseMapFile(cut, "cut", [](const MapChunk&) {}), InputError) << size;
      continue;
    }
    std::int64_t num_whole = 0;
    std::size_t used = 12;
    for (const std::size_t end : ends) {
      if (end > size) break;
      ++num_whole;
      used = end;
    }
    const MapFileSummary summary = ParseMapFile(cut, "cut", [](const MapChunk&) {});
    EXPECT_EQ(summary.num_chunks, num_whole) << size;
    EXPECT_EQ(summary.num_bytes_used, static_cast<std::int64_t>(used)) << size;
    EXPECT_EQ(summary.num_bytes_dropped, static_cast<std::int64_t>(size - used)) << size;
    EXPECT_EQ(summary.drop_reason.empty(), size == used) << size;
  }
}

TEST_F(MapTest, AFlippedBitNeverChangesTheContentUnnoticed) {
  WriteSmallMap(path_);
  const std::vector<std::uint8_t> whole = BytesOf(path_);
  std::vector<std::vector<std::uint8_t>> chunks;
  ParseMapFile(whole, "whole", [&](const MapChunk& chunk) { chunks.push_back(chunk.bytes); });
  int num_harmless = 0;
  for (std::size_t bit = 8 * 12; bit < 8 * whole.size(); ++bit) {
    std::vector<std::uint8_t> flipped = whole;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1u << (bit % 8)));
    std::size_t next = 0;
    const MapFileSummary summary = ParseMapFile(flipped, "flipped", [&](const MapChunk& chunk) {
      ASSERT_LT(next, chunks.size());
      EXPECT_EQ(chunk.bytes, chunks[next]) << "bit " << bit;
      ++next;
    });
    if (!summary.drop_reason.empty()) continue;
    ++num_harmless;
    EXPECT_EQ(next, chunks.size()) << "bit " << bit;
  }
  // A few bits of a zstd frame mean nothing (one of its head, padding): the content stays the same.
  EXPECT_LT(num_harmless, static_cast<int>(whole.size()) / 10);
}

TEST_F(MapTest, DoesNotBelieveLengths) {
  WriteSmallMap(path_);
  std::vector<std::uint8_t> bytes = BytesOf(path_);
  for (std::size_t i = 16; i < 24; ++i) bytes[i] = 0xFF;  // both sizes of the first chunk
  const MapFileSummary summary = ParseMapFile(bytes, "hostile", [](const MapChunk&) {});
  EXPECT_EQ(summary.num_chunks, 0);
  EXPECT_EQ(summary.drop_reason, "a chunk is too large");

  // Counts inside a chunk whose checksum is right.
  ByteWriter writer;
  writer.U32(0xFFFFFFFF);
  MapChunk chunk = MapDelta().ToChunk();
  chunk.bytes = writer.Take();
  EXPECT_FALSE(MapDelta().FromChunk(chunk));
  MapFileWriter file(path_);
  file.Append(HeadChunk(1, ""));
  file.Append(chunk);
  MapFileSummary read;
  EXPECT_EQ(ReadFourDMap(path_, &read).session, 1);
  EXPECT_NE(read.drop_reason.find("invalid one"), std::string::npos);
}

TEST_F(MapTest, AKillLosesNothingThatWasAppended) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    MapFileWriter writer(path_);
    writer.Append(HeadChunk(5, "killed"));
    MapDelta changes;
    changes.SetFrame({1}, LiveFrame(1, 1));
    writer.Append(changes.ToChunk());
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(path_, &summary);
  EXPECT_EQ(summary.drop_reason, "");
  EXPECT_FALSE(map.is_closed);
  EXPECT_EQ(map.frames.size(), 1u);
}

TEST_F(MapTest, NamesWhatIsNoMap) {
  std::ofstream(path_) << "something else altogether";
  MapFileSummary summary;
  EXPECT_THROW(ReadFourDMap(path_, &summary), InputError);
  EXPECT_THROW(ReadFourDMap(folder_ + "/none", &summary), InputError);
  EXPECT_THROW(MapFileWriter(folder_ + "/none/map.airdos"), InputError);
}

TEST_F(MapTest, AFullDiskCostsOnlyTheChunkThatDidNotFit) {
  std::signal(SIGXFSZ, SIG_IGN);  // then write() fails as on a full disk
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  MapFileWriter writer(path_);
  writer.Append(HeadChunk(1, "fits"));
  const auto size = static_cast<std::int64_t>(fs::file_size(path_));
  EXPECT_EQ(writer.num_bytes(), size);
  rlimit limit = before;
  limit.rlim_cur = static_cast<rlim_t>(size) + 20;
  setrlimit(RLIMIT_FSIZE, &limit);
  MapDelta changes;
  for (int i = 0; i < 100; ++i) changes.SetFrame({i}, LiveFrame(i, i));
  EXPECT_THROW(writer.Append(changes.ToChunk()), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(static_cast<std::int64_t>(fs::file_size(path_)), size);
  writer.Append(changes.ToChunk());
  MapFileSummary summary;
  EXPECT_EQ(ReadFourDMap(path_, &summary).frames.size(), 100u);
  EXPECT_EQ(summary.drop_reason, "");
}

TEST(TumRowTest, WritesTheWholeTime) {
  EXPECT_EQ(TumRow(1311868164363181, Se3()),
            "1311868164.363181 0.000000000 0.000000000 0.000000000 0.000000000000 0.000000000000 "
            "0.000000000000 1.000000000000\n");
  EXPECT_EQ(TumRow(-1500000, Se3()).substr(0, 9), "-1.500000");
}

TEST(TorsoPoseTest, LooksWhereThePersonLooks) {
  MapHuman human = Person(1);  // right hip at larger x, hips below the neck (y down)
  const Se3 T_W_H = *TorsoPose(human);
  EXPECT_NEAR((T_W_H.translation - Eigen::Vector3d(1, 0.25, 5)).norm(), 0, 1e-6);
  EXPECT_NEAR((T_W_H.rotation.toRotationMatrix() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-6);
  std::swap(human.joints[kRightHip], human.joints[kLeftHip]);  // now turned to the camera
  EXPECT_NEAR((TorsoPose(human)->rotation * Eigen::Vector3d::UnitZ()).z(), -1, 1e-6);
  human.joints.erase(kLeftHip);
  EXPECT_EQ(TorsoPose(human)->rotation.w(), 1);
  human.joints.clear();
  human.joints[kNose] = {};
  EXPECT_FALSE(TorsoPose(human));
}

TEST_F(MapTest, ExportsEverything) {
  WriteSmallMap(path_);
  MapFileSummary summary;
  const std::vector<std::string> paths =
      ExportMap(ReadFourDMap(path_, &summary), path_, folder_ + "/out", false, nullptr);
  EXPECT_EQ(paths.size(), 7u);
  for (const std::string& path : paths) EXPECT_TRUE(fs::exists(path)) << path;
  const std::string out = folder_ + "/out/";
  EXPECT_EQ(TextOf(out + "trajectory.tum").substr(0, 21), "1.000001 0.700000000 ");
  EXPECT_EQ(TextOf(out + "trajectory_live.tum").substr(0, 21), "1.000001 0.000000000 ");
  EXPECT_EQ(TextOf(out + "ground_truth.tum").substr(0, 46),
            "# axes: NED (x forward, y right, z down)\n1.100");
  EXPECT_EQ(TextOf(out + "trajectory.kitti").substr(0, 16), "9.975510003e-01 ");
  EXPECT_EQ(TextOf(out + "people/3.tum").substr(0, 15), "1.500000 1.9999");  // float: 2 - 3e-8
  EXPECT_EQ(TextOf(out + "people.jsonl"),
            R"({"seq":0,"utime":1500000,"track":3,"joints":{"1":[2.0,0.0,5.0],"8":[2.1,0.5,5.0],)"
            R"("11":[1.9,0.5,5.0]},"measured":{"1":[3.0,0.0,5.0],"8":[2.0,0.0,0.0],)"
            R"("11":[2.0,0.0,0.0]},"segment_lengths_m":{"4":0.2}})"
            "\n");
  const std::string ply = TextOf(out + "map.ply");
  const std::size_t body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), body + 20);
  ByteReader vertex(reinterpret_cast<const std::uint8_t*>(ply.data()) + body, 20);
  EXPECT_EQ(vertex.F32(), 1.5f);
  EXPECT_EQ(vertex.F32(), 2);
  EXPECT_EQ(vertex.F32(), 3);
  EXPECT_EQ(vertex.F32(), 0.05f);
  EXPECT_EQ(vertex.U32(), 9u);
}

TEST_F(MapTest, SaysWhichExportCannotBeWritten) {
  std::ofstream(folder_ + "/file") << "";
  EXPECT_THROW(ExportMap(FourDMap(), path_, folder_ + "/file", false, nullptr), InputError);
}

}  // namespace
}  // namespace airdos
