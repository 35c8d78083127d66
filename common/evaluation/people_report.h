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

/// Errors of the same joints before and after the optimization, m.
struct JointErrors {
  Statistics measured;   ///< as triangulated
  Statistics optimized;  ///< of the same joints
  /// By how much the optimization reduces the mean, %; negative if it increases it.
  double mean_improvement_percent() const;
  double median_improvement_percent() const;
};

/// Errors of segment lengths relative to the true ones, %.
struct LengthErrors {
  Statistics relative_percent;       ///< |estimate - truth| / truth
  double median_signed_percent = 0;  ///< above 0 if too long
  double within_5_percent = 0;       ///< share of the segments, %
};

/// Bands of a person's true depth: below 6 m, 6 to 12 m, and 12 m or more.
constexpr std::size_t kNumDepthBands = 3;
constexpr std::array<const char*, kNumDepthBands> kDepthBandNames = {"below 6 m", "6 to 12 m",
                                                                     "from 12 m"};
std::size_t DepthBand(double depth_m);  ///< index of the band

/// A track's lengths count once it has been on the same person for this many frames.
constexpr int kMinFramesForLengths = 10;

/// All figures about people.
struct PeopleReport {
  std::size_t num_states = 0;   ///< estimated people, summed over frames with both camera poses
  std::size_t num_matched = 0;  ///< of these, matched to a true person (see MatchPeople)
  std::size_t num_tracks = 0;
  std::size_t num_people = 0;      ///< true people who were matched at least once
  std::size_t num_to_be_seen = 0;  ///< true people to be seen (see IsToBeSeen), summed over frames
  std::size_t num_seen = 0;        ///< of these, matched
  IdentityScore identity;          ///< with respect to the people to be seen
  JointErrors joint_errors;        ///< of all matched people
  std::array<JointErrors, kNumDepthBands> joint_errors_by_depth;
  /// One length per segment for each track that was on a person for at least kMinFramesForLengths
  /// frames: that of the last of these frames, compared with the true mean over them.
  LengthErrors lengths;
  std::array<LengthErrors, kNumSegments> lengths_by_segment;
  std::array<LengthErrors, kNumDepthBands> lengths_by_depth;  ///< by the person's smallest depth
};

/// Estimated joints are transformed into the true camera frame by frame, so errors of the camera's
/// trajectory do not count.
PeopleReport EvaluatePeople(const std::vector<PersonState>& estimate,
                            const std::vector<TruePeople>& truth,
                            const MatchedTrajectories& cameras);

std::string ToTable(const PeopleReport& report);
nlohmann::json ToJson(const PeopleReport& report);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_
