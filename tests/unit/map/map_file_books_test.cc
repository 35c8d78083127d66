// The file of a map on a disk that is full, cut or gone on with: sizes as the system has them,
// chunks by their bytes.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "common/map/map_file.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kHeadBytes = 12;  // "AIRDOSM\n" and the version

/// Bytes that nothing packs smaller, other ones for each seed.
MapChunk Chunk(std::uint32_t type, std::size_t size) {
  MapChunk chunk;
  chunk.type = type;
  std::mt19937 random(type);
  for (std::size_t i = 0; i < size; ++i)
    chunk.bytes.push_back(static_cast<std::uint8_t>(random() & 0xFF));
  return chunk;
}

class MapFileBooksTest : public ::testing::Test {
 protected:
  MapFileBooksTest() : path_(testing::TempDir() + "airdos_map_file_" + std::to_string(getpid())) {
    std::signal(SIGXFSZ, SIG_IGN);  // then write() fails as on a full disk
    getrlimit(RLIMIT_FSIZE, &before_);
  }
  ~MapFileBooksTest() override {
    Limit(before_.rlim_cur);
    fs::remove(path_);
  }
  void Limit(rlim_t num_bytes) const {
    const rlimit limit{num_bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::int64_t FileSize() const { return static_cast<std::int64_t>(fs::file_size(path_)); }
  /// What can be read of the file is this, chunk by chunk.
  void ExpectChunks(const std::vector<MapChunk>& expected) {
    std::vector<MapChunk> chunks;
    summary_ = ReadMapFile(path_, [&](const MapChunk& chunk) { chunks.push_back(chunk); });
    ASSERT_EQ(chunks.size(), expected.size());
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      EXPECT_EQ(chunks[i].type, expected[i].type) << i;
      EXPECT_EQ(chunks[i].bytes, expected[i].bytes) << i;
    }
    EXPECT_EQ(summary_.num_chunks, static_cast<std::int64_t>(expected.size()));
  }
  /// As the file's own heads of chunks say: 12 bytes each and what they say of the packed size.
  std::int64_t SizeByHeads(int num_chunks) const {
    std::ifstream file(path_, std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    std::size_t place = static_cast<std::size_t>(kHeadBytes);
    for (int i = 0; i < num_chunks; ++i) {
      const std::uint8_t* size = &bytes.at(place + 8);
      place += 12u + size[0] + 256u * size[1] + 65536u * size[2];
    }
    return static_cast<std::int64_t>(place);
  }

  std::string path_;
  rlimit before_ = {};
  MapFileSummary summary_;
};

TEST_F(MapFileBooksTest, TheSizeIsThatOfTheFile) {
  MapFileWriter writer(path_);
  EXPECT_EQ(writer.num_bytes(), 12);
  EXPECT_EQ(FileSize(), 12);
  for (int i = 1; i <= 3; ++i) {
    writer.Append(Chunk(static_cast<std::uint32_t>(i), static_cast<std::size_t>(1000 * i)));
    EXPECT_EQ(writer.num_bytes(), FileSize());
    EXPECT_EQ(FileSize(), SizeByHeads(i));
    EXPECT_GT(FileSize(), kHeadBytes + 1000 * i * (i + 1) / 2) << "noise packs no smaller";
  }
}

// The disk is full in the middle of the fourth chunk, twice; then there is room again.
TEST_F(MapFileBooksTest, AFullDiskAfterSeveralChunksCostsNoneOfThem) {
  MapFileWriter writer(path_);
  std::vector<MapChunk> chunks = {Chunk(1, 700), Chunk(2, 900), Chunk(3, 40)};
  for (const MapChunk& chunk : chunks) writer.Append(chunk);
  const std::int64_t size = SizeByHeads(3);
  ASSERT_EQ(FileSize(), size);
  for (const rlim_t room : {500, 0}) {
    Limit(static_cast<rlim_t>(size) + room);
    try {
      writer.Append(Chunk(4, 5000));
      ADD_FAILURE() << "there is no room for it";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path_ + ": cannot be written: File too large");
    }
    EXPECT_EQ(FileSize(), size);
    EXPECT_EQ(writer.num_bytes(), size);
    ExpectChunks(chunks);
    EXPECT_EQ(summary_.drop_reason, "");
  }
  Limit(before_.rlim_cur);
  chunks.push_back(Chunk(5, 300));
  writer.Append(chunks.back());
  ExpectChunks(chunks);
  EXPECT_EQ(summary_.num_bytes_used, FileSize());
  EXPECT_EQ(summary_.num_bytes_dropped, 0);
}

TEST_F(MapFileBooksTest, WhatIsGoneOnWithBeginsBehindTheGoodChunks) {
  std::vector<MapChunk> chunks = {Chunk(1, 700), Chunk(2, 900)};
  {
    MapFileWriter writer(path_);
    for (const MapChunk& chunk : chunks) writer.Append(chunk);
  }
  const std::int64_t size = FileSize();
  std::ofstream(path_, std::ios::app | std::ios::binary) << std::string(5000, 'x');
  ExpectChunks(chunks);
  EXPECT_EQ(summary_.num_bytes_used, size);
  EXPECT_EQ(summary_.num_bytes_dropped, 5000);
  {
    MapFileWriter writer(path_, size);
    EXPECT_EQ(writer.num_bytes(), size);
    EXPECT_EQ(FileSize(), size) << "what lay behind them is cut off";
    Limit(static_cast<rlim_t>(size) + 30);
    EXPECT_THROW(writer.Append(Chunk(3, 400)), InputError);
    Limit(before_.rlim_cur);
    ExpectChunks(chunks);
    chunks.push_back(Chunk(4, 400));
    writer.Append(chunks.back());
    EXPECT_EQ(writer.num_bytes(), FileSize());
  }
  ExpectChunks(chunks);
  EXPECT_EQ(summary_.num_bytes_dropped, 0);
}

// A reader would not believe it, however small it packs.
TEST_F(MapFileBooksTest, AChunkThatIsTooLargeIsNotWritten) {
  MapFileWriter writer(path_);
  MapChunk chunk;
  chunk.type = 1;
  chunk.bytes.assign(kMaxChunkBytes - 4, 0);  // and four of the type
  writer.Append(chunk);
  const std::int64_t size = FileSize();
  ExpectChunks({chunk});
  chunk.bytes.push_back(0);
  EXPECT_THROW(writer.Append(chunk), InputError);
  EXPECT_EQ(FileSize(), size);
}

}  // namespace
}  // namespace airdos
