// The map file byte by byte, worked by hand, and every field of the map by its own value.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/map/byte_io.h"
#include "common/map/four_d_map.h"
#include "common/map/map_file.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Se3 Pose(double x) { return {Eigen::Quaterniond(0.1, 0.5, -0.5, 0.7), {x, x + 0.25, -x - 0.5}}; }

void ExpectPose(const std::optional<Se3>& pose, double x) {
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->translation, Eigen::Vector3d(x, x + 0.25, -x - 0.5));
  EXPECT_EQ(pose->rotation.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.7, 0.1));
}

/// Little endian, as the file has it.
class ByHand {
 public:
  ByHand& Byte(int value) {
    bytes.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  ByHand& Int(std::uint64_t value, int num_bytes) {
    for (int i = 0; i < num_bytes; ++i) Byte(static_cast<int>((value >> (8 * i)) & 0xFF));
    return *this;
  }
  ByHand& Single(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, 4);
    return Int(bits, 4);
  }
  ByHand& Real(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, 8);
    return Int(bits, 8);
  }
  ByHand& PoseAt(double x) {
    for (const double value : {x, x + 0.25, -x - 0.5, 0.1, 0.5, -0.5, 0.7}) Real(value);
    return *this;
  }
  Bytes bytes;
};

MapHuman Human() {
  MapHuman human;
  human.utime = 1234567;
  human.joints[3] = {{1, 2, 3}, {4, 5, 6}};
  human.segment_lengths_m[7] = 0.25F;
  human.part_motions[5] = {{7, 8, 9}, Eigen::Quaternionf(0.1F, 0.5F, -0.5F, 0.7F)};
  return human;
}

MapDelta Changes() {
  MapFrame frame;
  frame.utime = 0x0102030405;
  frame.live = Pose(1);
  frame.refined = Pose(2);
  frame.ground_truth = Pose(3);
  frame.status = 3;
  frame.is_trusted_with_people = true;
  MapDelta changes;
  changes.SetFrame({17}, frame);
  changes.SetLandmark({-5}, {{1.5F, 2.5F, 3.5F}, 0.125F, 19});
  changes.RemoveLandmark({23});
  changes.SetHuman({17}, {29}, Human());
  return changes;
}

Bytes ChangesByHand() {
  ByHand by_hand;
  by_hand.Int(1, 4).Int(17, 8).Int(0x0102030405, 8);
  by_hand.Byte(1 + 2 + 4 + 8).Byte(3).PoseAt(1).PoseAt(2).PoseAt(3);
  by_hand.Int(1, 4).Int(static_cast<std::uint64_t>(-5), 8);
  by_hand.Single(1.5F).Single(2.5F).Single(3.5F).Single(0.125F).Int(19, 4);
  by_hand.Int(1, 4).Int(23, 8);
  by_hand.Int(1, 4).Int(17, 8).Int(29, 8).Int(1234567, 8);
  by_hand.Int(1, 4).Byte(3);
  for (const float value : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F}) by_hand.Single(value);
  by_hand.Int(1, 4).Byte(7).Single(0.25F);
  by_hand.Int(1, 4).Byte(5);
  for (const float value : {7.F, 8.F, 9.F, 0.1F, 0.5F, -0.5F, 0.7F}) by_hand.Single(value);
  return by_hand.bytes;
}

TEST(MapValuesTest, ChangesAreTheseBytes) {
  EXPECT_EQ(Changes().ToChunk().bytes, ChangesByHand());
  EXPECT_EQ(Changes().ToChunk().type, 2u);
}

TEST(MapValuesTest, TheseBytesAreTheChanges) {
  MapDelta changes;
  ASSERT_TRUE(changes.FromChunk({2, ChangesByHand()}));
  FourDMap map;
  map.landmarks[{23}] = {};
  map.landmarks[{24}] = {};
  changes.Apply(&map);
  const MapFrame& frame = map.frames.at({17});
  EXPECT_EQ(frame.utime, 0x0102030405);
  ExpectPose(frame.live, 1);
  ExpectPose(frame.refined, 2);
  ExpectPose(frame.ground_truth, 3);
  EXPECT_EQ(frame.status, 3);
  EXPECT_TRUE(frame.is_trusted_with_people);
  ASSERT_EQ(map.landmarks.size(), 2u) << "23 was removed";
  EXPECT_EQ(map.landmarks.at({-5}).p_W, Eigen::Vector3f(1.5F, 2.5F, 3.5F));
  EXPECT_EQ(map.landmarks.at({-5}).sigma_m, 0.125F);
  EXPECT_EQ(map.landmarks.at({-5}).num_observations, 19);
  const MapHuman& human = map.humans.at({{17}, {29}});
  EXPECT_EQ(human.utime, 1234567);
  EXPECT_EQ(human.joints.at(3).p_W, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(human.joints.at(3).p_W_measured, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(human.segment_lengths_m.at(7), 0.25F);
  EXPECT_EQ(human.part_motions.at(5).t_W, Eigen::Vector3f(7, 8, 9));
  EXPECT_EQ(human.part_motions.at(5).R_W.coeffs(), Eigen::Vector4f(0.5F, -0.5F, 0.7F, 0.1F));
}

TEST(MapValuesTest, ChangesThatAreTooShortTooLongOrOfAnotherTypeAreNone) {
  const Bytes whole = ChangesByHand();
  MapDelta changes;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(changes.FromChunk({2, part})) << size;
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(changes.FromChunk({2, longer}));
  EXPECT_FALSE(changes.FromChunk({1, whole}));
}

// Each flag of a frame by itself: which of the poses there are, and whom the live one trusts.
TEST(MapValuesTest, EachPartOfAFrameIsThereOrNot) {
  for (int flags = 0; flags < 16; ++flags) {
    MapFrame frame;
    frame.utime = 1 + flags;
    if ((flags & 1) != 0) frame.live = Pose(1);
    if ((flags & 2) != 0) frame.refined = Pose(2);
    if ((flags & 4) != 0) frame.ground_truth = Pose(3);
    frame.is_trusted_with_people = (flags & 8) != 0 && (flags & 1) != 0;
    MapDelta changes;
    changes.SetFrame({1}, frame);
    MapDelta read;
    ASSERT_TRUE(read.FromChunk(changes.ToChunk()));
    FourDMap map;
    read.Apply(&map);
    const MapFrame& got = map.frames.at({1});
    EXPECT_EQ(got.live.has_value(), (flags & 1) != 0);
    EXPECT_EQ(got.refined.has_value(), (flags & 2) != 0);
    EXPECT_EQ(got.ground_truth.has_value(), (flags & 4) != 0);
    EXPECT_EQ(got.is_trusted_with_people, frame.is_trusted_with_people);
    if (got.refined) ExpectPose(got.refined, 2);
    if (got.ground_truth) ExpectPose(got.ground_truth, 3);
  }
}

// What a later message does not speak of stays as it was.
TEST(MapValuesTest, WhatComesLaterReplacesOnlyWhatItHas) {
  FourDMap map;
  Changes().Apply(&map);
  MapFrame refined;
  refined.refined = Pose(9);  // no time, no status: they are of the live pose
  MapDelta later;
  later.SetFrame({17}, refined);
  later.Apply(&map);
  MapFrame frame = map.frames.at({17});
  ExpectPose(frame.live, 1);
  ExpectPose(frame.refined, 9);
  ExpectPose(frame.ground_truth, 3);
  EXPECT_EQ(frame.utime, 0x0102030405);
  EXPECT_EQ(frame.status, 3);
  EXPECT_TRUE(frame.is_trusted_with_people);
  MapFrame live;
  live.utime = 77;
  live.live = Pose(8);
  live.status = 1;
  later = MapDelta();
  later.SetFrame({17}, live);
  later.Apply(&map);
  frame = map.frames.at({17});
  ExpectPose(frame.live, 8);
  ExpectPose(frame.refined, 9);
  ExpectPose(frame.ground_truth, 3);
  EXPECT_EQ(frame.utime, 77);
  EXPECT_EQ(frame.status, 1);
  EXPECT_FALSE(frame.is_trusted_with_people);
}

// The optimizer's last word on a person comes without motions, as the frame before has left its
// window: within a chunk and over the border of two.
TEST(MapValuesTest, APersonsMotionsStayWhereTheRefinedStateHasNone) {
  MapHuman refined = Human();
  refined.part_motions.clear();
  refined.joints[3].p_W = {10, 20, 30};
  for (const bool is_one_chunk : {true, false}) {
    FourDMap map;
    MapDelta changes = Changes();
    if (!is_one_chunk) {
      changes.Apply(&map);
      changes = MapDelta();
    }
    changes.SetHuman({17}, {29}, refined);
    changes.Apply(&map);
    const MapHuman& human = map.humans.at({{17}, {29}});
    EXPECT_EQ(human.joints.at(3).p_W, Eigen::Vector3f(10, 20, 30));
    ASSERT_EQ(human.part_motions.size(), 1u);
    EXPECT_EQ(human.part_motions.at(5).t_W, Eigen::Vector3f(7, 8, 9));
  }
  FourDMap map;
  Changes().Apply(&map);
  MapDelta changes;
  MapHuman moved = Human();
  moved.part_motions = {{2, {{1, 1, 1}, Eigen::Quaternionf::Identity()}}};
  changes.SetHuman({17}, {29}, moved);
  changes.Apply(&map);
  EXPECT_EQ(map.humans.at({{17}, {29}}).part_motions.count(5), 0u) << "new ones replace the old";
}

TEST(MapValuesTest, ALandmarkIsSetOrRemovedAsTheLastWordHasIt) {
  FourDMap map;
  map.landmarks[{1}] = map.landmarks[{2}] = {{9, 9, 9}, 1, 1};
  MapDelta changes;
  changes.RemoveLandmark({1});
  changes.SetLandmark({1}, {{1, 2, 3}, 0.5F, 4});
  changes.SetLandmark({2}, {{1, 2, 3}, 0.5F, 4});
  changes.RemoveLandmark({2});
  const Bytes bytes = changes.ToChunk().bytes;
  changes.Apply(&map);
  ASSERT_EQ(map.landmarks.size(), 1u);
  EXPECT_EQ(map.landmarks.at({1}).num_observations, 4);
  ByHand by_hand;  // neither is in both lists
  by_hand.Int(0, 4).Int(1, 4).Int(1, 8).Single(1).Single(2).Single(3).Single(0.5F).Int(4, 4);
  by_hand.Int(1, 4).Int(2, 8).Int(0, 4);
  EXPECT_EQ(bytes, by_hand.bytes);
}

// The estimate decides when a chunk is written: at least the true size, and for people who have all
// joints not twice that.
TEST(MapValuesTest, TheSizeIsEstimatedFromAbove) {
  MapHuman whole = Human();
  for (int joint = 0; joint < 14; ++joint) whole.joints[joint] = {};
  for (int segment = 0; segment < 14; ++segment) whole.segment_lengths_m[segment] = 1;
  for (int part = 0; part < 9; ++part) whole.part_motions[part] = {};
  MapFrame frame;
  frame.live = frame.refined = frame.ground_truth = Se3();
  MapDelta frames, landmarks, removed, humans;
  for (int i = 0; i < 100; ++i) {
    frames.SetFrame({i}, frame);
    landmarks.SetLandmark({i}, {});
    removed.RemoveLandmark({i});
    humans.SetHuman({1}, {i}, whole);
  }
  for (const MapDelta* changes : {&frames, &landmarks, &removed, &humans}) {
    const std::size_t size = changes->ToChunk().bytes.size() - 16;  // less the four counts
    EXPECT_GE(changes->ApproximateBytes(), size);
    EXPECT_LE(changes->ApproximateBytes(), size + size / 100);
    EXPECT_FALSE(changes->empty());
  }
  EXPECT_TRUE(MapDelta().empty());
}

TEST(MapValuesTest, HeadAndEndAreTheseBytes) {
  const MapChunk head = HeadChunk(0x1122334455667788, "ab");
  EXPECT_EQ(head.type, 1u);
  EXPECT_EQ(head.bytes, ByHand().Int(0x1122334455667788, 8).Int(2, 4).Byte('a').Byte('b').bytes);
  const MapChunk end = EndChunk(StereoCamera{641, 363, 701.5, 688.25, 322.75, 177.5, 0.2375}, 2);
  EXPECT_EQ(end.type, 3u);
  ByHand by_hand;
  by_hand.Byte(2).Byte(1).Int(641, 4).Int(363, 4);
  for (const double value : {701.5, 688.25, 322.75, 177.5, 0.2375}) by_hand.Real(value);
  EXPECT_EQ(end.bytes, by_hand.bytes);
  EXPECT_EQ(EndChunk(std::nullopt, 1).bytes, ByHand().Byte(1).Byte(0).bytes);
}

class MapFileValuesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ =
        (fs::temp_directory_path() / ("airdos_map_values_" + std::to_string(getpid()))).string();
  }
  void TearDown() override { fs::remove(path_); }
  FourDMap Read() { return ReadFourDMap(path_, &summary_); }

  std::string path_;
  MapFileSummary summary_;
};

TEST_F(MapFileValuesTest, AClosedMapHasEachValueInItsPlace) {
  const StereoCamera camera{641, 363, 701.5, 688.25, 322.75, 177.5, 0.2375};
  {
    MapFileWriter writer(path_);
    writer.Append(HeadChunk(-7, "program 1.2"));
    writer.Append(Changes().ToChunk());
    EXPECT_FALSE(Read().is_closed);
    writer.Append(EndChunk(camera, 2));
  }
  const FourDMap map = Read();
  EXPECT_EQ(map.session, -7);
  EXPECT_EQ(map.program, "program 1.2");
  ASSERT_TRUE(map.camera);
  EXPECT_EQ(map.camera->width, 641);
  EXPECT_EQ(map.camera->height, 363);
  EXPECT_EQ(map.camera->fx_px, 701.5);
  EXPECT_EQ(map.camera->fy_px, 688.25);
  EXPECT_EQ(map.camera->cx_px, 322.75);
  EXPECT_EQ(map.camera->cy_px, 177.5);
  EXPECT_EQ(map.camera->baseline_m, 0.2375);
  EXPECT_EQ(map.ground_truth_axes, 2);
  EXPECT_TRUE(map.is_closed);
  EXPECT_EQ(summary_.num_chunks, 3);
  EXPECT_EQ(summary_.num_bytes_used, static_cast<std::int64_t>(fs::file_size(path_)));
  EXPECT_EQ(summary_.num_bytes_dropped, 0);
  EXPECT_EQ(summary_.drop_reason, "");
}

// An end that breaks off does not close; and nothing behind a chunk that makes no sense counts.
TEST_F(MapFileValuesTest, NothingBehindAChunkWithoutSenseCounts) {
  {
    MapFileWriter writer(path_);
    writer.Append(HeadChunk(7, "x"));
    writer.Append({3, {2, 1, 0, 0}});
    writer.Append(Changes().ToChunk());
  }
  const FourDMap map = Read();
  EXPECT_FALSE(map.is_closed);
  EXPECT_TRUE(map.frames.empty());
  EXPECT_EQ(summary_.drop_reason, "2 chunks, starting at the first invalid one");
}

TEST_F(MapFileValuesTest, EveryFlippedBitOfAChunkIsNoticed) {
  {
    MapFileWriter writer(path_);
    writer.Append(HeadChunk(7, "x"));
  }
  const std::int64_t end_of_head = static_cast<std::int64_t>(fs::file_size(path_));
  {
    MapFileWriter writer(path_, end_of_head);
    writer.Append(Changes().ToChunk());
  }
  std::ifstream file(path_, std::ios::binary);
  const Bytes good{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  for (std::size_t i = static_cast<std::size_t>(end_of_head); i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bytes = good;
      bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ (1 << bit));
      // The frame's head of zstd has one bit that means nothing.
      Bytes content;
      const MapFileSummary summary = ParseMapFile(bytes, "x", [&](const MapChunk& chunk) {
        if (chunk.type == 2) content = chunk.bytes;
      });
      if (summary.num_chunks == 2) {
        EXPECT_EQ(content, ChangesByHand()) << i << " " << bit;
        continue;
      }
      EXPECT_EQ(summary.num_bytes_used, end_of_head) << i << " " << bit;
      EXPECT_EQ(summary.num_bytes_dropped, static_cast<std::int64_t>(good.size()) - end_of_head);
    }
  }
}

TEST_F(MapFileValuesTest, TheHeadIsTheseBytesAndOtherVersionsAreRefused) {
  { MapFileWriter writer(path_); }
  std::ifstream file(path_, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string magic = "AIRDOSM\n";
  ASSERT_EQ(bytes.size(), 12u);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 8), Bytes(magic.begin(), magic.end()));
  EXPECT_EQ(ParseMapFile(bytes, "x", [](const MapChunk&) {}).num_bytes_used, 12);
  for (const int change : {-1, 1}) {
    Bytes other = bytes;
    other[8] = static_cast<std::uint8_t>(other[8] + change);
    EXPECT_THROW(ParseMapFile(other, "x", [](const MapChunk&) {}), InputError) << change;
  }
}

TEST(ByteIoTest, NumbersAreLittleEndian) {
  ByteWriter writer;
  writer.U8(0xAB);
  writer.U32(0x01020304);
  writer.I64(-2);
  writer.F32(1.5F);
  writer.F64(-0.1);
  writer.Text("xyz");
  const Bytes bytes = writer.Take();
  ByHand by_hand;
  by_hand.Byte(0xAB).Byte(4).Byte(3).Byte(2).Byte(1).Int(static_cast<std::uint64_t>(-2), 8);
  by_hand.Single(1.5F).Real(-0.1).Int(3, 4).Byte('x').Byte('y').Byte('z');
  EXPECT_EQ(bytes, by_hand.bytes);
  ByteReader reader(bytes.data(), bytes.size());
  EXPECT_EQ(reader.U8(), 0xAB);
  EXPECT_EQ(reader.U32(), 0x01020304u);
  EXPECT_EQ(reader.I64(), -2);
  EXPECT_EQ(reader.F32(), 1.5F);
  EXPECT_EQ(reader.F64(), -0.1);
  EXPECT_EQ(reader.Text(), "xyz");
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.num_left(), 0u);
}

// Ten bytes can be five of two, not six.
TEST(ByteIoTest, ACountIsBelievedOnlyAsFarAsTheBytesReach) {
  for (const std::uint32_t count : {5u, 6u}) {
    const Bytes bytes = ByHand().Int(count, 4).Int(0, 8).Int(0, 2).bytes;
    ByteReader reader(bytes.data(), bytes.size());
    EXPECT_EQ(reader.Count(2), count == 5 ? 5u : 0u);
    EXPECT_EQ(reader.ok(), count == 5);
  }
}

}  // namespace
}  // namespace airdos
