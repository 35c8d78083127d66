#ifndef AIRDOS_PROCESSES_MAP_RECORDER_SESSION_FILES_H_
#define AIRDOS_PROCESSES_MAP_RECORDER_SESSION_FILES_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/geometry/stereo_camera.h"
#include "common/map/four_d_map.h"
#include "common/map/map_file.h"
#include "common/util/output_folder.h"
#include "processes/map_recorder/earlier_maps.h"
#include "processes/node/message/header.h"

namespace airdos {

/// The files of one run of the recorder, session by session: the map, the notes beside it until it
/// is closed, and the exports made from it. The first session lies in the folder itself, the next
/// in session_2, and so on. Maps that an earlier run left in the folder are continued, kept or
/// replaced (earlier_maps.h). Errors are InputErrors that name the file.
class SessionFiles {
 public:
  /// Each session has a folder; Open() throws beyond this number.
  static constexpr int kMaxSessions = 1000;

  /// Locks the folder for its lifetime. Throws if the folder is not named, cannot be created or
  /// written to, or is in use by another run, or if files of other programs are in the way.
  /// `say` takes lines for the user.
  SessionFiles(const std::string& directory, const OutputRules& rules, SayLine say);

  /// Begins the map of the next session, whose first frame has this header; the previous one must
  /// be closed. If a recorder that was killed left an unfinished map of this session, that map is
  /// continued, and what it holds is returned.
  std::optional<UnfinishedMap> Open(const Header& header);
  /// Whether there is a map to append to: not before the first session, and not after a failure.
  bool is_open() const { return file_ != nullptr; }

  /// Throws, once, if the chunk cannot be written or the disk is nearly full; no map is open from
  /// then on, and what was written before is kept.
  void Append(const MapChunk& chunk);
  /// Writes ground truth and camera beside the open map, so that a kill does not lose them. Says
  /// nothing of a full disk; Append() does.
  void Note(std::int64_t session, const MapDelta& ground_truth,
            const std::optional<StereoCamera>& camera, std::int8_t ground_truth_axes);
  /// What was recorded.
  struct Recorded {
    std::int64_t session = 0;
    std::size_t num_live = 0;  ///< frames with a live pose
  };
  /// Ends the map with `end`, reads it back, compares it with what was recorded, and exports it if
  /// `has_exports`.
  void Close(const MapChunk& end, const Recorded& recorded, bool has_exports);

  /// Why writing failed, told once; empty if it did not.
  std::string TakeFailure();

  /// Of the current session; empty before the first.
  const std::string& session_directory() const { return session_directory_; }
  /// For other files of this run that belong into the folder.
  OutputFolder* results() { return &results_; }

 private:
  /// Makes this session the current one.
  void Enter(int number);
  /// Continues the map of a recorder that was killed, if there is one.
  std::optional<UnfinishedMap> Resume(const Header& header);
  /// Takes the folder over from an earlier run.
  void ReplaceEarlierResults();
  /// Opens the map of the current session, after its first `num_bytes`.
  void OpenMap(std::int64_t num_bytes);
  /// Throws if the map, as read back, is not what was recorded.
  void CompareWithRecorded(const FourDMap& map, const MapFileSummary& summary,
                           std::int64_t num_bytes, const Recorded& recorded) const;
  void Export(const FourDMap& map);
  std::string PathOf(const std::string& name) const { return results_.PathOf(prefix_ + name); }

  std::string directory_;
  SayLine say_;
  OutputFolder results_;
  std::string prefix_;  // of the session's files in the folder: "" or "session_2/"
  std::string session_directory_;
  int num_sessions_ = 0;
  std::unique_ptr<MapFileWriter> file_;
  std::unique_ptr<MapFileWriter> notes_;  // map.airdos.open
  std::string failure_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_SESSION_FILES_H_
