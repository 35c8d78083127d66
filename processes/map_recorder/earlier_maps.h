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

// What the map recorder finds in its folder: maps that are gone on with, kept or replaced.

inline constexpr char kMapName[] = "map.airdos";
inline constexpr char kNotesName[] = "map.airdos.open";

/// Of a session's files in the folder, from 1 on: "", "session_2/", ...
std::string SessionPrefix(int number);
std::string SessionDirectory(const std::string& directory, int number);

/// Of all sessions that have a folder, the names that a run may write.
std::vector<std::string> NamesToBeWritten(const std::string& directory);

/// Frames that have a live pose.
std::size_t CountLive(const FourDMap& map);

/// A map that was not closed.
struct UnfinishedMap {
  std::int64_t num_bytes = 0;
  std::size_t num_live = 0;
  FourDMap notes;  ///< what lay beside it
};
/// That of the header's session which ends before its image, if one lies in the directory.
std::optional<UnfinishedMap> FindUnfinishedMap(const std::string& directory, const Header& header);

/// Whether there is a file that is no closed map.
bool IsUnfinished(const std::string& path);

/// Takes a line that people are to read.
using SayLine = std::function<void(const std::string&)>;

/// Gives the map another name, if there is one, and says so. Throws InputError.
void KeepMap(const std::string& path, const SayLine& say);

/// A run that was cut short must not be lost to the next one in the same place: its maps, the
/// closed ones of its earlier sessions, too, get other names.
void KeepMapsOfACutRun(const std::string& directory, const SayLine& say);

/// Says which map, if one lies there, is replaced.
void SayWhatIsReplaced(const std::string& path, const SayLine& say);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_EARLIER_MAPS_H_
