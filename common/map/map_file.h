#ifndef AIRDOS_COMMON_MAP_MAP_FILE_H_
#define AIRDOS_COMMON_MAP_MAP_FILE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace airdos {

// The container of the 4-D map: a crash-safe file of chunks. All numbers little endian.
//
//   file  = "AIRDOSM\n" (8 bytes), version (u32), chunk*
//   chunk = "CHNK" (4 bytes), raw size (u32), packed size (u32), payload
//
// The payload is one zstd frame, with zstd's own content checksum, of the chunk's type (u32) and
// its content. A chunk reaches the system in one write and is never changed afterwards, so whatever
// ends the writer leaves a file whose last chunk at most is cut short.

inline constexpr std::uint32_t kMapFileVersion = 1;
/// Raw, with type; or packed. The recorder closes a chunk at 8 MB, and a packed one of 1 kB may
/// claim as much as this.
inline constexpr std::size_t kMaxChunkBytes = 16u << 20;

struct MapChunk {
  std::uint32_t type = 0;
  std::vector<std::uint8_t> bytes;
};

/// Appends chunks to a new file; an existing one is replaced, or gone on with.
class MapFileWriter {
 public:
  /// Throws InputError naming the file where it cannot be created.
  explicit MapFileWriter(const std::string& path);
  /// Goes on behind the first `num_bytes` of a file, which ReadMapFile() found to be good
  /// (num_bytes_used); what lies behind them is cut off.
  MapFileWriter(const std::string& path, std::int64_t num_bytes);
  ~MapFileWriter();
  MapFileWriter(const MapFileWriter&) = delete;
  MapFileWriter& operator=(const MapFileWriter&) = delete;

  /// Hands one chunk to the operating system: from then on a kill of the process cannot lose it.
  /// Throws InputError naming the file and the cause (disk full) where that fails; what was written
  /// of the chunk is cut off again, and the writer may be used further.
  void Append(const MapChunk& chunk);
  std::int64_t num_bytes() const { return num_bytes_; }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::int64_t num_bytes_ = 0;
};

/// How far a file could be read: up to the last chunk that is complete and whose checksum holds.
struct MapFileSummary {
  std::int64_t num_chunks = 0;
  std::int64_t num_bytes_used = 0;
  std::int64_t num_bytes_dropped = 0;  ///< behind the last good chunk
  std::string drop_reason;             ///< empty where nothing was dropped
};

/// Hands over the chunks in order. Throws InputError naming the file where it cannot be read, is no
/// map file or is of another version. Any damage behind the head costs only the rest of the file;
/// no length in the file is believed before it is checked.
MapFileSummary ReadMapFile(const std::string& path,
                           const std::function<void(const MapChunk&)>& handle);

/// The same for the bytes of a file; `name` stands for it in messages.
MapFileSummary ParseMapFile(const std::vector<std::uint8_t>& bytes, const std::string& name,
                            const std::function<void(const MapChunk&)>& handle);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_MAP_FILE_H_
