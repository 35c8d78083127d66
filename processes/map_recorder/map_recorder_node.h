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
#include "processes/map_recorder/map_recorder_options.h"
#include "processes/map_recorder/session_files.h"
#include "processes/node/frame_node.h"

namespace airdos {

/// STATE_ESTIMATE and MAP_UPDATE of one frame.
struct MapRecorderInputs {
  std::optional<state_estimate_t> state;
  std::vector<map_update_t> updates;
};

/// Writes the optimizer's output to a 4-D map, `<directory>/map.airdos`, chunk by chunk, and
/// creates the exports from that file at the end. The content of the file depends only on what each
/// channel carried, not on how the channels interleaved: frames are joined by number, and
/// calibration and ground truth, which nothing waits for, are written late. The calibration is
/// written at the end; ground truth once kGroundTruthLag newer frames are done, and the rest of it,
/// or what comes later, at the end. Publishes nothing.
///
/// A second session goes to `<directory>/session_2`, and so on. If a map was not closed (after a
/// kill), recording continues in it, provided that the new frames belong to its session and are
/// later than all of its frames. What is lost then are the live poses of the chunk that was open
/// and of the frames until the restart; refined poses are reported again as long as the optimizer
/// has them in its window. Otherwise the map is kept under another name (map.airdos.unfinished_1),
/// and so are the maps of that run's earlier sessions (map.airdos.closed_1). The maps of a
/// completed run are replaced, and everything else that it left in the folder is removed when the
/// first frame arrives; both are reported. Files that were not written by a recorder, an
/// export or a replay are never touched (see OutputFolder); if one is in the way, this is reported
/// before the first frame.
///
/// At the end each map is read back and compared with what was recorded.
///
/// Until a map is closed, ground truth and calibration are kept beside it in `map.airdos.open`, so
/// a kill loses at most kGroundTruthPerNote poses of the ground truth.
///
/// Memory: the open chunk, and the ground truth that has not been written yet (at most
/// MapRecorderOptions::max_ground_truth poses).
class MapRecorderNode : public FrameNode<MapRecorderInputs> {
 public:
  static constexpr std::size_t kGroundTruthPerNote = 10;
  static constexpr std::int64_t kGroundTruthLag = 1000;
  static constexpr int kMaxSessions = SessionFiles::kMaxSessions;
  /// Limit of sessions whose calibrations and ground truth are kept while they wait for their first
  /// frame.
  static constexpr std::size_t kMaxSessionsAhead = 100;

  /// Locks the folder for the lifetime of this object. Throws InputError if no folder was named, it
  /// cannot be created or written to, another run is writing to it, or somebody else's files are in
  /// the way.
  explicit MapRecorderNode(const MapRecorderOptions& options);
  /// Closes the map if Finish() was not called; a failure is then reported.
  ~MapRecorderNode() override;

  /// Writes the last chunks and the exports. Does nothing if no frame arrived. Throws InputError
  /// naming the file that cannot be written, or could not be written earlier, or does not contain
  /// what was recorded.
  void Finish() override;

  /// Folder of the current session; empty before the first frame.
  const std::string& session_directory() const { return files_.session_directory(); }

  /// For other files of this run that belong into the folder.
  OutputFolder* results() { return files_.results(); }

 protected:
  void StartSession(const Header& header) override;
  /// Throws InputError once if the disk does not accept the chunk or is nearly full; after that
  /// nothing more is recorded, but what was recorded is kept.
  void ProcessFrame(const Header& header, MapRecorderInputs inputs) override;

 private:
  /// A pose of the ground truth.
  struct GroundTruth {
    std::int8_t axes = 0;
    std::int64_t utime = 0;
    Se3 pose;
  };

  std::string AddCalibration(const stereo_calibration_t& message);
  std::string AddGroundTruth(const pose_t& message);
  /// Takes the ground truth that lay beside the map of a recorder that was killed.
  void TakeNotes(const FourDMap& notes);
  /// Camera of the current session, if known.
  std::optional<StereoCamera> Camera() const;
  /// Writes new ground truth of the current session beside the map.
  void NoteGroundTruth();
  void TakeOldGroundTruth(std::int64_t seq);
  void SetGroundTruth(const std::pair<const std::int64_t, GroundTruth>& pose);
  /// Warns if times do not increase.
  void WatchTime(const Header& header);
  void WriteChunk();
  void CloseSession();

  MapRecorderOptions options_;
  SessionFiles files_;
  std::int64_t session_ = 0;
  std::optional<Header> newest_pose_;  // latest in the session
  bool is_time_said_ = false;
  MapDelta changes_;  // contents of the open chunk
  int num_frames_in_chunk_ = 0;
  std::size_t num_live_ = 0;  // frames with a live pose in the current session

  // By session, then by image number.
  std::map<std::int64_t, std::map<std::int64_t, GroundTruth>> ground_truth_;
  std::map<std::int64_t, std::map<std::int64_t, StereoCamera>> cameras_;
  std::size_t num_ground_truth_ = 0;
  std::set<std::int64_t> not_noted_;  // ground truth that is not yet beside the map
};

std::unique_ptr<Node> MakeMapRecorderNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_MAP_RECORDER_MAP_RECORDER_NODE_H_
