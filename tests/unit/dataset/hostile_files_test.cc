#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/dataset/mask_file.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/stereo_sequence.h"
#include "common/map/four_d_map.h"
#include "common/util/error.h"
#include "common/util/free_disk.h"
#include "common/util/text_file.h"
#include "tests/support/allocation_watch.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAllocationBytes = 64u << 20;

class HostileFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("airdos_hostile_") + info->name());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Write(const std::string& name, const std::string& bytes) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  fs::path folder_;
};

/// The reader refuses, in one line that has the text, and without much room.
void ExpectRefused(const std::string& part, const std::function<void()>& read) {
  ResetLargestAllocation();
  try {
    read();
    ADD_FAILURE() << "was read; expected: " << part;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
  EXPECT_LE(LargestAllocation(), kMaxAllocationBytes);
}

TEST_F(HostileFilesTest, YamlThatMultipliesItself) {
  std::string text = "a0: &a0 {k: 1, l: 2}\n";
  for (int i = 1; i < 7; ++i) {
    const std::string n = std::to_string(i), last = std::to_string(i - 1);
    text += "a" + n + ": &a" + n + " {";
    for (char c = 'a'; c < 'k'; ++c) text += std::string(1, c) + ": *a" + last + ", ";
    text += "z: 1}\n";
  }
  ExpectRefused("too many keys", [&] { ConfigReader::FromString(text, "x.yaml"); });
}

TEST_F(HostileFilesTest, YamlThatHoldsItself) {
  ExpectRefused("nested too deeply",
                [] { ConfigReader::FromString("a: &a\n  b: *a\n", "x.yaml"); });
}

TEST_F(HostileFilesTest, YamlThatIsTooLong) {
  ExpectRefused("more than 100000 bytes",
                [] { ConfigReader::FromString(std::string(100001, '#'), "x.yaml"); });
  const std::string path = Write("hole.yaml", "");
  fs::resize_file(path, 1u << 30);  // a hole
  ExpectRefused("more than 100000 bytes", [&] { ConfigReader::FromFile(path); });
  ExpectRefused("is a pipe, device or socket", [] { ConfigReader::FromFile("/dev/zero"); });
}

// A palette PNG of 1 x 8388610 px, of which a few are there: a pointer a row would be 64 MB.
TEST_F(HostileFilesTest, AMaskOfOneColumn) {
  const std::vector<std::uint8_t> png = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x80, 0x00, 0x02, 0x08, 0x03, 0x00, 0x00,
      0x00, 0xfd, 0x64, 0xc3, 0xcf, 0x00, 0x00, 0x00, 0x09, 0x50, 0x4c, 0x54, 0x45, 0x00,
      0x00, 0x00, 0xc8, 0x00, 0xfb, 0x00, 0x00, 0x7d, 0x01, 0x0b, 0xe9, 0x3e, 0x00, 0x00,
      0x00, 0x10, 0x49, 0x44, 0x41, 0x54, 0x08, 0x99, 0x63, 0x60, 0x60, 0x64, 0x62, 0x60,
      0x60, 0x60, 0x04, 0x00, 0x00, 0x19, 0x00, 0x05, 0x19, 0x85, 0xa3, 0x79, 0x00, 0x00,
      0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  ExpectRefused("cannot be decoded as a mask",
                [&] { DecodePersonMask(png.data(), png.size(), "m.png"); });
}

TEST_F(HostileFilesTest, TextWithoutEnd) {
  const std::string hole = Write("hole.txt", "");
  fs::resize_file(hole, 1u << 30);
  ExpectRefused("a line of more than", [&] { ReadTextLines(hole); });
  ExpectRefused("is a pipe, device or socket", [] { ReadTextLines("/dev/zero"); });
  std::string many;
  for (int i = 0; i <= 1000000; ++i) many += "1\n";
  const std::string path = Write("many.txt", many);
  ExpectRefused("more than 1000000 lines", [&] { ReadTextLines(path); });
}

TEST_F(HostileFilesTest, AZeroByteEndsNoNumber) {
  const std::string path = Write("zero.txt", std::string("1\0002 3\n", 6));
  const std::vector<TextLine> lines = ReadTextLines(path);
  ExpectRefused("is not a finite number", [&] { ParseNumbers(path, lines.at(0), 0); });
}

TEST_F(HostileFilesTest, AFileThatIsNoImageFile) {
  ExpectRefused("is a pipe, device or socket", [] { ReadBytes("/dev/zero"); });
  const std::string path = Write("large.png", "");
  fs::resize_file(path, 33u << 20);  // a hole
  ExpectRefused("at most 33554432 are allowed", [&] { ReadBytes(path); });
}

TEST_F(HostileFilesTest, AnImageThatClaimsFourGigapixels) {
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x8\0\0\0\0", 29);
  png += std::string(40, '\0') + std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  const std::string path = Write("bomb.png", png);
  ExpectRefused("cannot be decoded", [&] { ReadImageSize(path); });
}

TEST_F(HostileFilesTest, DeepJson) {
  const std::string deep = std::string(40000, '[') + std::string(40000, ']');
  for (const char* side : {"image_0", "image_1"}) {
    std::ifstream from(std::string(AIRDOS_SOURCE_DIR) + "/docs/images/people_help.png");
    const std::string image(std::istreambuf_iterator<char>(from), {});
    Write(std::string(side) + "/000000.png", image);
  }
  Write("calib.json", "{\"fx\": " + deep + "}");
  ExpectRefused("key 'fx' with a value of type array",
                [&] { OpenStereoSequence(folder_.string()); });
  Write("calib.json", std::string(100001, ' '));
  ExpectRefused("more than 100000 bytes", [&] { OpenStereoSequence(folder_.string()); });
}

// A thousand zeros are packed into a few bytes.
TEST_F(HostileFilesTest, AMapChunkThatUnpacksToMore) {
  const std::string path = (folder_ / "map.airdos").string();
  fs::create_directories(folder_);
  {
    MapFileWriter writer(path);
    writer.Append({99, std::vector<std::uint8_t>(kMaxChunkBytes - 4)});
    ExpectRefused("is too large", [&] {
      writer.Append({99, std::vector<std::uint8_t>(kMaxChunkBytes - 3)});
    });
  }
  MapFileSummary summary;
  ResetLargestAllocation();
  ReadFourDMap(path, &summary);
  EXPECT_EQ(summary.num_chunks, 1);
  EXPECT_LE(LargestAllocation(), kMaxAllocationBytes);
}

TEST_F(HostileFilesTest, RecordersLeaveRoomOnTheDisk) {
  EXPECT_EQ(DiskReserveBytes(std::int64_t{1} << 40), 100000000);
  EXPECT_EQ(DiskReserveBytes(1000000), 10000);
  EXPECT_EQ(WhyDiskIsFull("/nonexistent"), "") << "nobody knows";
}

}  // namespace
}  // namespace airdos
