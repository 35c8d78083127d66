#ifndef AIRDOS_TESTS_SUPPORT_CHAIN_RUN_H_
#define AIRDOS_TESTS_SUPPORT_CHAIN_RUN_H_

#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/people_report.h"
#include "common/evaluation/trajectory_report.h"
#include "processes/tools/replay/replay.h"
#include "tests/support/bands.h"

namespace airdos {

/// Figures about people from the messages of a run.
struct PeopleUse {
  double joints_seen = 0;      ///< per frame, in HUMAN_OBSERVATIONS
  double joints_adjusted = 0;  ///< per frame, for the newest frame in MAP_UPDATE
  double people = 0;           ///< in the window, per frame, like the next two
  double rigidity_factors = 0;
  double motion_factors = 0;
  double rigidity_eliminated_percent = 0;
  double motion_eliminated_percent = 0;
  double reprojection_eliminated = 0;  ///< per frame, landmarks and joints
};

/// Errors of the speeds of torsos in the map, m/s.
struct VelocityErrors {
  std::size_t num = 0;
  double median_m_s = 0;        ///< of the magnitude of the velocity error
  double median_speed_m_s = 0;  ///< estimated speed of the same people
};

/// Where the true people of a run are recorded; an empty name if unknown.
struct PeopleTruth {
  std::string joints;  ///< joints_gt.json, possibly compressed
  std::string camera;  ///< TUM rows in optical axes, in the same world
};

/// The results of a run.
struct ChainRun {
  ReplayResult result;
  TrajectoryReport trajectory;
  std::size_t num_landmarks = 0;  ///< in the map
  bool is_closed = false;
  PeopleUse use;
  std::optional<PeopleReport> people;
  std::optional<VelocityErrors> velocity;
};

/// The figures that have bands; without those of people if their truth is unknown.
Figures FiguresOf(const ChainRun& run);

/// What RunChain() runs on.
struct ChainInput {
  std::string path;    ///< log or folder of a data set
  std::string people;  ///< off, mask_only, on
  bool has_ned_truth = false;
  PeopleTruth truth;
  bool detects = false;  ///< the person detector runs, too; the input must have no people
};

/// Runs the four nodes with the committed configuration, and TestOverrides(), in a temporary
/// folder.
ChainRun RunChain(const ChainInput& input);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_CHAIN_RUN_H_
