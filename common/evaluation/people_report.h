#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/evaluation/identity.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory.h"
#include "common/human/skeleton.h"

namespace airdos {

/// The same joints before and after the optimization, m.
struct JointErrors {
  Statistics measured;   ///< as triangulated
  Statistics optimized;  ///< of the same joints
  /// How much smaller the mean is after the optimization, %; negative: greater.
  double mean_improvement_percent() const;
  double median_improvement_percent() const;
};

/// Of the lengths of segments against the true ones, %.
struct LengthErrors {
  Statistics relative_percent;       ///< |estimate - truth| / truth
  double median_signed_percent = 0;  ///< above 0: too long
  double within_5_percent = 0;       ///< share of the segments, %
};

/// True depth of a person below 6 m, 6 to 12 m, from 12 m on.
constexpr std::size_t kNumDepthBands = 3;
constexpr std::array<const char*, kNumDepthBands> kDepthBandNames = {"below 6 m", "6 to 12 m",
                                                                     "from 12 m"};

/// A track's lengths count once it was on the same person in so many frames.
constexpr int kMinFramesForLengths = 10;

struct PeopleReport {
  std::size_t num_states = 0;   ///< estimated people, summed over the frames with both camera poses
  std::size_t num_matched = 0;  ///< of these, on a true person (see MatchPeople)
  std::size_t num_tracks = 0;
  std::size_t num_people = 0;      ///< true people that were matched at least once
  std::size_t num_to_be_seen = 0;  ///< true people to be seen (see IsToBeSeen), over the frames
  std::size_t num_seen = 0;        ///< of these, matched
  IdentityScore identity;          ///< against the people to be seen
  JointErrors joint_errors;        ///< of all matched people
  std::array<JointErrors, kNumDepthBands> joint_errors_by_depth;
  /// One length a segment of each track on a person for at least kMinFramesForLengths frames: that
  /// of the last of these frames, against the true mean over them.
  LengthErrors lengths;
  std::array<LengthErrors, kNumSegments> lengths_by_segment;
  std::array<LengthErrors, kNumDepthBands> lengths_by_depth;  ///< by the least depth of the person
};

/// Estimated joints are carried into the true camera frame by frame: errors of the camera's path do
/// not count.
PeopleReport EvaluatePeople(const std::vector<PersonState>& estimate,
                            const std::vector<TruePeople>& truth,
                            const MatchedTrajectories& cameras);

std::string ToTable(const PeopleReport& report);
nlohmann::json ToJson(const PeopleReport& report);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_
