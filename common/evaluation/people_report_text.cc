// Formats people's errors as text and JSON.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/evaluation/people_matching.h"
#include "common/evaluation/people_report.h"
#include "common/util/format.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr std::array<const char*, kNumSegments> kSegmentNames = {"neck - right shoulder",
                                                                 "neck - left shoulder",
                                                                 "right shoulder - hip",
                                                                 "left shoulder - hip",
                                                                 "hip - hip",
                                                                 "right upper arm",
                                                                 "right forearm",
                                                                 "left upper arm",
                                                                 "left forearm",
                                                                 "right thigh",
                                                                 "right shin",
                                                                 "left thigh",
                                                                 "left shin",
                                                                 "neck - nose"};

std::string JointRow(const char* name, const JointErrors& errors) {
  return Format("  %-24s %8zu %9.4f %9.4f %6.1f %% %9.4f %9.4f %6.1f %%\n", name,
                errors.optimized.count, errors.measured.mean, errors.optimized.mean,
                errors.mean_improvement_percent(), errors.measured.median, errors.optimized.median,
                errors.median_improvement_percent());
}

std::string LengthRow(const char* name, const LengthErrors& errors) {
  if (errors.relative_percent.count == 0) return Format("  %-24s %8d\n", name, 0);
  return Format("  %-24s %8zu %9.2f %9.2f %+9.2f %9.1f\n", name, errors.relative_percent.count,
                errors.relative_percent.median, errors.relative_percent.mean,
                errors.median_signed_percent, errors.within_5_percent);
}

json ToJson(const Statistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count},   {"rmse", s.rmse}, {"mean", s.mean},
          {"median", s.median}, {"max", s.max},   {"std", s.std}};
}

json ToJson(const JointErrors& errors) {
  return {{"measured_m", ToJson(errors.measured)},
          {"optimized_m", ToJson(errors.optimized)},
          {"mean_improvement_percent", errors.mean_improvement_percent()},
          {"median_improvement_percent", errors.median_improvement_percent()}};
}

json ToJson(const LengthErrors& errors) {
  return {{"relative_percent", ToJson(errors.relative_percent)},
          {"median_signed_percent", errors.median_signed_percent},
          {"within_5_percent", errors.within_5_percent}};
}

}  // namespace

std::string ToTable(const PeopleReport& r) {
  std::string text = Format("%zu states of %zu tracks, %zu matched with %zu people\n", r.num_states,
                            r.num_tracks, r.num_matched, r.num_people);
  text += Format(
      "to be seen (%d joints in each image, %.1f to %.0f m away): %d people in %zu states, %zu of "
      "these found\n",
      kMinVisibleJoints, kMinPersonDepthM, kMaxPersonDepthM, r.identity.num_people,
      r.num_to_be_seen, r.num_seen);
  const double num_people = std::max(r.identity.num_people, 1);
  text +=
      Format("identity: %d switches, %.2f per person; IDF1 %.3f (precision %.3f, recall %.3f)\n\n",
             r.identity.num_switches, r.identity.num_switches / num_people, r.identity.idf1,
             r.identity.id_precision, r.identity.id_recall);
  text += Format("  %-24s %8s %9s %9s %8s %9s %9s %8s\n", "error of the joints (m)", "joints",
                 "mean", "optimized", "better", "median", "optimized", "better");
  text += JointRow("all matched people", r.joint_errors);
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    text += JointRow(kDepthBandNames[i], r.joint_errors_by_depth[i]);
  }
  text += Format("\n  %-24s %8s %9s %9s %9s %9s\n", "error of the lengths (%)", "lengths", "median",
                 "mean", "bias", "within 5");
  text += LengthRow("all segments", r.lengths);
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    text += LengthRow(kDepthBandNames[i], r.lengths_by_depth[i]);
  }
  for (std::size_t i = 0; i < kNumSegments; ++i) {
    text += LengthRow(kSegmentNames[i], r.lengths_by_segment[i]);
  }
  return text;
}

json ToJson(const PeopleReport& r) {
  json joints_by_depth;
  json lengths_by_depth;
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    joints_by_depth[kDepthBandNames[i]] = ToJson(r.joint_errors_by_depth[i]);
    lengths_by_depth[kDepthBandNames[i]] = ToJson(r.lengths_by_depth[i]);
  }
  json lengths_by_segment;
  for (std::size_t i = 0; i < kNumSegments; ++i) {
    lengths_by_segment[kSegmentNames[i]] = ToJson(r.lengths_by_segment[i]);
  }
  return {{"states", r.num_states},
          {"states_matched", r.num_matched},
          {"tracks", r.num_tracks},
          {"people_matched", r.num_people},
          {"people_to_be_seen", r.identity.num_people},
          {"states_to_be_seen", r.num_to_be_seen},
          {"states_to_be_seen_found", r.num_seen},
          {"identity_switches", r.identity.num_switches},
          {"identity_switches_per_person",
           r.identity.num_switches / static_cast<double>(std::max(r.identity.num_people, 1))},
          {"idf1", r.identity.idf1},
          {"id_precision", r.identity.id_precision},
          {"id_recall", r.identity.id_recall},
          {"joint_error", ToJson(r.joint_errors)},
          {"joint_error_by_depth", joints_by_depth},
          {"segment_length_error", ToJson(r.lengths)},
          {"segment_length_error_by_depth", lengths_by_depth},
          {"segment_length_error_by_segment", lengths_by_segment}};
}

}  // namespace airdos
