#ifndef AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_NODE_H_
#define AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_NODE_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "airdos/map_update_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "common/config/config_reader.h"
#include "common/map/four_d_map.h"
#include "common/util/output_folder.h"
#include "processes/node/frame_node.h"

namespace airdos {

struct MapRecorderOptions {
  std::string directory;      ///< made if it is not there; must be named
  int chunk_frames = 10;      ///< frames a chunk; a kill loses at most one chunk
  bool export_at_end = true;  ///< also write the exports of common/map/map_export.h
  OutputRules rules;          ///< what may be replaced; not in the configuration
  /// Takes what people are to read; by default it goes to stderr as "map_recorder: ...".
  std::function<void(const std::string&)> say = SayOnStderr;

  static void SayOnStderr(const std::string& line);
};

/// STATE_ESTIMATE and MAP_UPDATE of one frame.
struct MapRecorderInputs {
  std::optional<state_estimate_t> state;
  std::vector<map_update_t> updates;
};

/// Writes what the optimizer says into a 4-D map, `<directory>/map.airdos`, chunk by chunk, and
/// makes the exports from that file at the end. What the file holds depends on what each channel
/// carried only, not on how they interleaved: frames are joined by number, and calibration and
/// ground truth, which nothing waits for, are written late: the calibration at the end, ground
/// truth once kGroundTruthLag newer frames are done, and what is left, or comes later, at the end.
/// It publishes nothing.
///
/// A second session goes to `<directory>/session_2`, and so on. A map that was not closed (a kill)
/// is gone on with if what comes is of its session and later than all of it: what is lost are the
/// live poses of the chunk that was open and of the frames until the restart; refined poses come
/// again as long as the optimizer has them in its window. Else it is kept under another name
/// (map.airdos.unfinished_1), and so are the maps of that run's earlier sessions
/// (map.airdos.closed_1). The maps of a run that came to its end are replaced, and everything else
/// that it left in the folder goes when the first frame comes; both are said. What was
/// not written by a recorder, an export or a replay is never touched (see OutputFolder): where a
/// file would get into its way, this is said before the first frame.
///
/// At its end each map is read again and held against what was recorded.
///
/// Until a map is closed ground truth and calibration lie beside it in `map.airdos.open`, so that a
/// kill loses at most kGroundTruthPerNote poses of them.
///
/// Memory: the open chunk and the ground truth that is not written yet (at most kMaxGroundTruth
/// poses).
class MapRecorderNode : public FrameNode<MapRecorderInputs> {
 public:
  static constexpr std::size_t kMaxGroundTruth = 1000000;
  static constexpr std::size_t kGroundTruthPerNote = 10;
  static constexpr std::int64_t kGroundTruthLag = 1000;
  /// Each session has a folder: in one more nothing is recorded.
  static constexpr int kMaxSessions = 1000;
  /// Calibrations and ground truth of so many sessions wait for their first frame.
  static constexpr std::size_t kMaxSessionsAhead = 100;

  /// Locks the folder until this goes. Throws InputError where it was not named, cannot be made or
  /// written to, another run is writing there, or files of somebody else are in the way.
  explicit MapRecorderNode(const MapRecorderOptions& options);
  /// Closes the map if Finish() was not called; a failure is then said.
  ~MapRecorderNode() override;

  /// Writes the last chunks and the exports. Nothing where no frame came. Throws InputError naming
  /// the file that cannot be written, or could not be earlier, or does not hold what was recorded.
  void Finish() override;

  /// Of the session in work; empty before the first frame.
  const std::string& session_directory() const { return session_directory_; }

  /// For what else of this run is to lie in the folder.
  OutputFolder* results() { return &results_; }

 protected:
  void StartSession(const Header& header) override;
  /// Throws InputError once where the disk does not take the chunk or has hardly any room left;
  /// nothing is recorded from then on, what was is kept.
  void ProcessFrame(const Header& header, MapRecorderInputs inputs) override;

 private:
  struct GroundTruth {
    std::int8_t axes = 0;
    std::int64_t utime = 0;
    Se3 pose;
  };

  std::string AddCalibration(const stereo_calibration_t& message);
  std::string AddGroundTruth(const pose_t& message);
  /// Goes on with the map of a recorder that was killed; false if there is none.
  bool Resume(const Header& header);
  /// Writes new ground truth of the session in work beside the map.
  void NoteGroundTruth();
  void TakeOldGroundTruth(std::int64_t seq);
  void SetGroundTruth(const std::pair<const std::int64_t, GroundTruth>& pose);
  /// Warns where times do not go on.
  void WatchTime(const Header& header);
  void Append(const MapChunk& chunk);
  void WriteChunk();
  void CloseSession();
  /// Takes the folder over from an earlier run.
  void ReplaceEarlierResults();
  /// Opens the map of the session in work, at its end or where a kill left it.
  void OpenMap(std::int64_t num_bytes);
  /// Throws InputError where the map, as it was read, is not what was recorded.
  void CompareWithRecorded(const FourDMap& map, const MapFileSummary& summary,
                           std::int64_t num_bytes) const;
  std::string PathOf(const std::string& name) const { return results_.PathOf(prefix_ + name); }

  MapRecorderOptions options_;
  OutputFolder results_;
  std::string prefix_;  // of the session's files in the folder: "" or "session_2/"
  std::string session_directory_;
  int num_sessions_ = 0;
  std::int64_t session_ = 0;
  std::unique_ptr<MapFileWriter> file_;  // none before the first frame and after a failure
  std::string failure_;                  // why nothing more could be written; empty if all was
  std::optional<Header> newest_pose_;    // in time, of the session
  bool is_time_said_ = false;
  MapDelta changes_;  // of the open chunk
  int num_frames_in_chunk_ = 0;
  std::size_t num_live_ = 0;  // frames of the session in work with a live pose

  // By session, then image number.
  std::map<std::int64_t, std::map<std::int64_t, GroundTruth>> ground_truth_;
  std::map<std::int64_t, std::map<std::int64_t, StereoCamera>> cameras_;
  std::size_t num_ground_truth_ = 0;
  std::unique_ptr<MapFileWriter> notes_;  // map.airdos.open
  std::set<std::int64_t> not_noted_;      // ground truth that is not in it
};

/// Reads launch_scripts/config/map_recorder.yaml's keys; the caller calls Finish() of the reader.
MapRecorderOptions ReadMapRecorderOptions(ConfigReader* config);
std::unique_ptr<Node> MakeMapRecorderNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_NODE_H_
