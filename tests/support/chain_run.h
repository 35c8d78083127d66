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

/// What the messages of a run say about people.
struct PeopleUse {
  double joints_seen = 0;      ///< a frame, of HUMAN_OBSERVATIONS
  double joints_adjusted = 0;  ///< a frame, of the newest frame in MAP_UPDATE
  double people = 0;           ///< of the window, a frame, as are the next two
  double rigidity_factors = 0;
  double motion_factors = 0;
  double rigidity_eliminated_percent = 0;
  double motion_eliminated_percent = 0;
  double reprojection_eliminated = 0;  ///< a frame, landmarks and joints
};

/// Of the speeds of torsos in the map, m/s.
struct VelocityErrors {
  std::size_t num = 0;
  double median_m_s = 0;        ///< of the length of the difference from the true velocity
  double median_speed_m_s = 0;  ///< as estimated, of the same people
};

/// Where the true people of a run are; an empty name: not known.
struct PeopleTruth {
  std::string joints;  ///< joints_gt.json, also compressed
  std::string camera;  ///< TUM rows in optical axes, in the same world
};

struct ChainRun {
  ReplayResult result;
  TrajectoryReport trajectory;
  std::size_t num_landmarks = 0;  ///< of the map
  bool is_closed = false;
  PeopleUse use;
  std::optional<PeopleReport> people;
  std::optional<VelocityErrors> velocity;
};

/// What the bands are about; without those of people where their truth is not known.
Figures FiguresOf(const ChainRun& run);

struct ChainInput {
  std::string path;    ///< log or folder of a data set
  std::string people;  ///< off, mask_only, on
  bool has_ned_truth = false;
  PeopleTruth truth;
};

/// Runs the four nodes with the committed configuration, and TestOverrides(), in a folder of its
/// own, which is gone afterwards.
ChainRun RunChain(const ChainInput& input);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_CHAIN_RUN_H_
