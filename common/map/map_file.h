#ifndef AIRDOS_COMMON_MAP_MAP_FILE_H_
#define AIRDOS_COMMON_MAP_MAP_FILE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace airdos {

// The container of the 4-D map: a crash-safe file of chunks. All numbers are little-endian.
//
//   file  = "AIRDOSM\n" (8 bytes), version (u32), chunk*
//   chunk = "CHNK" (4 bytes), raw size (u32), packed size (u32), payload
//
// The payload is one zstd frame, with zstd's content checksum, of the chunk's type (u32) and
// content. Each chunk is handed to the operating system in a single write and never changed
// afterwards, so however the writer ends, at most the last chunk of the file is incomplete.

inline constexpr std::uint32_t kMapFileVersion = 1;
/// Limit for a chunk, both uncompressed (including its type) and compressed. The recorder closes a
/// chunk at 8 MB; a compressed chunk of 1 kB may claim to hold this much.
inline constexpr std::size_t kMaxChunkBytes = 16u << 20;

/// A chunk's type and uncompressed content.
struct MapChunk {
  std::uint32_t type = 0;
  std::vector<std::uint8_t> bytes;
};

/// Appends chunks to a file: a new one, which replaces any existing file, or an existing one.
class MapFileWriter {
 public:
  /// Throws InputError naming the file if it cannot be created.
  explicit MapFileWriter(const std::string& path);
  /// Continues after the first `num_bytes` of a file, which ReadMapFile() found to be valid
  /// (num_bytes_used); whatever follows them is cut off.
  MapFileWriter(const std::string& path, std::int64_t num_bytes);
  ~MapFileWriter();
  MapFileWriter(const MapFileWriter&) = delete;
  MapFileWriter& operator=(const MapFileWriter&) = delete;

  /// Hands one chunk to the operating system; once this returns, killing the process cannot lose
  /// it. Throws InputError naming the file and the cause (such as a full disk) if that fails.
  /// Whatever was written of the chunk is then cut off again, and the writer remains usable.
  void Append(const MapChunk& chunk);
  std::int64_t num_bytes() const { return num_bytes_; }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::int64_t num_bytes_ = 0;
};

/// How much of a file could be read: up to the last chunk that is complete and has a valid
/// checksum.
struct MapFileSummary {
  std::int64_t num_chunks = 0;
  std::int64_t num_bytes_used = 0;
  std::int64_t num_bytes_dropped = 0;  ///< after the last valid chunk
  std::string drop_reason;             ///< empty if nothing was dropped
};

/// Passes on the chunks in order. Throws InputError naming the file if it cannot be read, is not a
/// map file or has another version. Any damage after the header costs only the rest of the file; no
/// length in the file is trusted before it has been checked.
MapFileSummary ReadMapFile(const std::string& path,
                           const std::function<void(const MapChunk&)>& handle);

/// The same for the bytes of a file; `name` stands for it in messages.
MapFileSummary ParseMapFile(const std::vector<std::uint8_t>& bytes, const std::string& name,
                            const std::function<void(const MapChunk&)>& handle);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_MAP_FILE_H_
