#include "processes/map_recorder/earlier_maps.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "common/map/map_export.h"
#include "common/util/error.h"

namespace airdos {

namespace fs = std::filesystem;

std::size_t CountLive(const FourDMap& map) {
  std::size_t num = 0;
  for (const auto& [id, frame] : map.frames) num += frame.live ? 1 : 0;
  return num;
}

std::optional<UnfinishedMap> FindUnfinishedMap(const std::string& directory, const Header& header) {
  UnfinishedMap found;
  try {
    MapFileSummary summary;
    const FourDMap map = ReadFourDMap(directory + "/" + kMapName, &summary);
    const bool is_earlier = map.frames.empty() || map.frames.rbegin()->first.value < header.seq;
    if (map.is_closed || map.session != header.session || !is_earlier) return std::nullopt;
    found.num_bytes = summary.num_bytes_used;
    found.num_live = CountLive(map);
  } catch (const InputError&) {  // missing or unreadable
    return std::nullopt;
  }
  try {
    MapFileSummary summary;
    FourDMap notes = ReadFourDMap(directory + "/" + kNotesName, &summary);
    if (notes.session == header.session) found.notes = std::move(notes);
  } catch (const InputError&) {  // then the notes are lost
  }
  return found;
}

std::string SessionPrefix(int number) {
  return number == 1 ? "" : "session_" + std::to_string(number) + "/";
}

std::string SessionDirectory(const std::string& directory, int number) {
  return number == 1 ? directory : directory + "/session_" + std::to_string(number);
}

std::vector<std::string> NamesToBeWritten(const std::string& directory) {
  std::vector<std::string> names;
  for (int number = 1; fs::exists(SessionDirectory(directory, number)); ++number) {
    const std::string prefix = SessionPrefix(number);
    names.push_back(prefix + kMapName);
    names.push_back(prefix + kNotesName);
    for (const std::string& name : ExportNames(directory, prefix)) names.push_back(name);
  }
  return names;
}

bool IsUnfinished(const std::string& path) {
  if (!fs::exists(path)) return false;
  try {
    MapFileSummary summary;
    return !ReadFourDMap(path, &summary).is_closed;
  } catch (const InputError&) {  // not a map, so it may matter to somebody
    return true;
  }
}

void SayWhatIsReplaced(const std::string& path, const SayLine& say) {
  if (!fs::exists(path)) return;
  try {
    MapFileSummary summary;
    const FourDMap map = ReadFourDMap(path, &summary);
    say(path + ": replaces the map of session " + std::to_string(map.session) + ", " +
        std::to_string(map.frames.size()) + " frames");
  } catch (const InputError&) {  // not a map: reported elsewhere if it is in the way
  }
}

void KeepMap(const std::string& path, const SayLine& say) {
  if (!fs::exists(path)) return;
  const std::string ending = IsUnfinished(path) ? ".unfinished_" : ".closed_";
  int number = 1;
  while (fs::exists(path + ending + std::to_string(number))) ++number;
  std::error_code error;
  fs::rename(path, path + ending + std::to_string(number), error);
  if (error) throw InputError(path + ": cannot be renamed: " + error.message());
  say(path + ": is kept as " + path + ending + std::to_string(number) + ": its run was cut short");
}

void KeepMapsOfACutRun(const std::string& directory, const SayLine& say) {
  int num_sessions = 0;  // of that run, as far as it got
  for (int number = 1; fs::exists(SessionDirectory(directory, number)); ++number) {
    if (IsUnfinished(SessionDirectory(directory, number) + "/" + kMapName)) num_sessions = number;
  }
  for (int number = 1; number <= num_sessions; ++number) {
    KeepMap(SessionDirectory(directory, number) + "/" + kMapName, say);
  }
}

}  // namespace airdos
