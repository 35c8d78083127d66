#include "common/map/map_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "common/map/byte_io.h"
#include "common/util/check.h"
#include "common/util/error.h"
#include "common/util/input_file.h"

namespace airdos {
namespace {

constexpr char kMagic[] = "AIRDOSM\n";
constexpr std::size_t kHeadBytes = 12;
constexpr std::uint32_t kChunkMagic = 0x4B4E4843;  // "CHNK", little-endian
constexpr std::size_t kChunkHeadBytes = 12;
constexpr int kTypeBytes = 4;
constexpr int kCompressionLevel = 3;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

std::vector<std::uint8_t> Compress(const std::vector<std::uint8_t>& raw) {
  const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  AIRDOS_CHECK(context != nullptr);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kCompressionLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::vector<std::uint8_t> packed(ZSTD_compressBound(raw.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), raw.data(), raw.size());
  AIRDOS_CHECK(!ZSTD_isError(size));
  packed.resize(size);
  return packed;
}

/// Writes all bytes; false (see errno) if not all of them could be written.
bool WriteAll(int descriptor, const std::vector<std::uint8_t>& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

/// Parses the chunk at `position`. Returns why there is no complete chunk, or an empty text.
std::string ParseChunk(const std::vector<std::uint8_t>& bytes, std::size_t position,
                       MapChunk* chunk, std::size_t* next) {
  const std::size_t num_left = bytes.size() - position;
  if (num_left < kChunkHeadBytes) return "the file ends within the header of a chunk";
  ByteReader head(bytes.data() + position, kChunkHeadBytes);
  if (head.U32() != kChunkMagic) return "no chunk starts here";
  const std::size_t raw_size = head.U32();
  const std::size_t packed_size = head.U32();
  if (raw_size > kMaxChunkBytes || packed_size > kMaxChunkBytes) return "a chunk is too large";
  if (packed_size > num_left - kChunkHeadBytes) return "the file ends within a chunk";
  const std::uint8_t* const packed = bytes.data() + position + kChunkHeadBytes;
  if (raw_size < kTypeBytes || ZSTD_getFrameContentSize(packed, packed_size) != raw_size)
    return "a chunk's size is wrong";
  std::vector<std::uint8_t> raw(raw_size);
  const std::size_t size = ZSTD_decompress(raw.data(), raw_size, packed, packed_size);
  if (ZSTD_isError(size) || size != raw_size) return "a chunk's checksum is wrong";
  chunk->type = ByteReader(raw.data(), raw_size).U32();
  chunk->bytes.assign(raw.begin() + kTypeBytes, raw.end());
  *next = position + kChunkHeadBytes + packed_size;
  return "";
}

}  // namespace

MapFileWriter::MapFileWriter(const std::string& path) : path_(path) {
  descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw InputError(path + ": cannot be created: " + std::strerror(errno));
  ByteWriter head;
  for (std::size_t i = 0; i < 8; ++i) head.U8(static_cast<std::uint8_t>(kMagic[i]));
  head.U32(kMapFileVersion);
  if (!WriteAll(descriptor_, head.bytes())) {
    const std::string why = std::strerror(errno);
    close(descriptor_);
    throw InputError(path + ": cannot be written: " + why);
  }
  num_bytes_ = static_cast<std::int64_t>(kHeadBytes);
}

MapFileWriter::MapFileWriter(const std::string& path, std::int64_t num_bytes) : path_(path) {
  AIRDOS_CHECK(num_bytes >= static_cast<std::int64_t>(kHeadBytes));
  descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw InputError(path + ": cannot be opened: " + std::strerror(errno));
  if (ftruncate(descriptor_, num_bytes) != 0 ||
      lseek(descriptor_, num_bytes, SEEK_SET) != num_bytes) {
    const std::string why = std::strerror(errno);
    close(descriptor_);
    throw InputError(path + ": cannot be written: " + why);
  }
  num_bytes_ = num_bytes;
}

MapFileWriter::~MapFileWriter() { close(descriptor_); }

void MapFileWriter::Append(const MapChunk& chunk) {
  ByteWriter type;
  type.U32(chunk.type);
  std::vector<std::uint8_t> raw = type.Take();
  raw.insert(raw.end(), chunk.bytes.begin(), chunk.bytes.end());
  const std::vector<std::uint8_t> packed = Compress(raw);
  if (raw.size() > kMaxChunkBytes || packed.size() > kMaxChunkBytes) {
    throw InputError(path_ + ": a chunk of " + std::to_string(raw.size()) + " bytes is too large");
  }
  ByteWriter head;
  head.U32(kChunkMagic);
  head.U32(static_cast<std::uint32_t>(raw.size()));
  head.U32(static_cast<std::uint32_t>(packed.size()));
  std::vector<std::uint8_t> bytes = head.Take();
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  if (!WriteAll(descriptor_, bytes)) {
    const std::string why = std::strerror(errno);
    const bool is_cut = ftruncate(descriptor_, num_bytes_) == 0 &&
                        lseek(descriptor_, num_bytes_, SEEK_SET) == num_bytes_;
    throw InputError(path_ + ": cannot be written: " + why + (is_cut ? "" : ", nor cut back"));
  }
  num_bytes_ += static_cast<std::int64_t>(bytes.size());
}

MapFileSummary ReadMapFile(const std::string& path,
                           const std::function<void(const MapChunk&)>& handle) {
  RequireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read");
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                        std::istreambuf_iterator<char>()};
  if (file.bad()) throw InputError(path + ": cannot be read");
  return ParseMapFile(bytes, path, handle);
}

MapFileSummary ParseMapFile(const std::vector<std::uint8_t>& bytes, const std::string& name,
                            const std::function<void(const MapChunk&)>& handle) {
  if (bytes.size() < kHeadBytes || std::memcmp(bytes.data(), kMagic, 8) != 0) {
    throw InputError(name + ": is not a map file (or ends within its first 12 bytes)");
  }
  const std::uint32_t version = ByteReader(bytes.data() + 8, 4).U32();
  if (version != kMapFileVersion) {
    throw InputError(name + ": has version " + std::to_string(version) +
                     ", this program reads version " + std::to_string(kMapFileVersion));
  }
  MapFileSummary summary;
  std::size_t position = kHeadBytes;
  while (position < bytes.size()) {
    MapChunk chunk;
    std::size_t next = 0;
    summary.drop_reason = ParseChunk(bytes, position, &chunk, &next);
    if (!summary.drop_reason.empty()) break;
    handle(chunk);
    ++summary.num_chunks;
    position = next;
  }
  summary.num_bytes_used = static_cast<std::int64_t>(position);
  summary.num_bytes_dropped = static_cast<std::int64_t>(bytes.size() - position);
  return summary;
}

}  // namespace airdos
