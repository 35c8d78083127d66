#ifndef AIRDOS_PROCESSES_MAP_RECORDER_EARLIER_MAPS_H_
#define AIRDOS_PROCESSES_MAP_RECORDER_EARLIER_MAPS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/map/four_d_map.h"
#include "processes/node/message/header.h"

namespace airdos {

// Maps that the recorder finds in its folder: whether they are continued, kept or replaced.

inline constexpr char kMapName[] = "map.airdos";
inline constexpr char kNotesName[] = "map.airdos.open";

/// Prefix of a session's files in the folder, counting from 1: "", "session_2/", ...
std::string SessionPrefix(int number);
std::string SessionDirectory(const std::string& directory, int number);

/// The names that a run may write, for every session with a folder.
std::vector<std::string> NamesToBeWritten(const std::string& directory);

/// Number of frames with a live pose.
std::size_t CountLive(const FourDMap& map);

/// A map that was not closed.
struct UnfinishedMap {
  std::int64_t num_bytes = 0;
  std::size_t num_live = 0;
  FourDMap notes;  ///< what was noted beside it
};
/// The unfinished map in the directory that belongs to the header's session and ends before its
/// image, if there is one.
std::optional<UnfinishedMap> FindUnfinishedMap(const std::string& directory, const Header& header);

/// Whether there is a file that is not a closed map.
bool IsUnfinished(const std::string& path);

/// Takes a line for the user.
using SayLine = std::function<void(const std::string&)>;

/// Renames the map, if there is one, and reports it. Throws InputError.
void KeepMap(const std::string& path, const SayLine& say);

/// An interrupted run must not be lost to the next one in the same folder: renames its maps,
/// including the closed ones of its earlier sessions.
void KeepMapsOfACutRun(const std::string& directory, const SayLine& say);

/// Reports which map, if there is one, is being replaced.
void SayWhatIsReplaced(const std::string& path, const SayLine& say);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_EARLIER_MAPS_H_
