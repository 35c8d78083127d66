#include <nlohmann/json.hpp>

#include "common/evaluation/trajectory_report.h"
#include "common/util/format.h"

namespace airdos {
namespace {

/// `none_because`: why the figure is missing; empty if it is not.
std::string Row(const char* name, const char* unit, const Statistics& s,
                const std::string& none_because = "") {
  if (!none_because.empty()) {
    return Format("  %-24s %-6s n/a: ", name, unit) + none_because + "\n";
  }
  if (s.count == 0) return Format("  %-24s %-6s (no such motion)\n", name, unit);
  return Format("  %-24s %-6s %9.4f %9.4f %9.4f %9.4f %9.4f\n", name, unit, s.rmse, s.mean,
                s.median, s.max, s.std);
}

std::string CountsToText(const TrajectoryReport& r) {
  std::string text =
      Format("%zu poses estimated, %zu in the ground truth, %zu matched: %.1f %% complete\n",
             r.num_estimate, r.num_ground_truth, r.num_matched, 100 * r.completeness);
  if (r.has_truth_higher_rate && !r.are_frames_given) {
    text += Format(
        "the truth has a higher rate, so the %zu frames are those of the estimate "
        "(--frames gives all images)\n",
        r.num_frames);
  }
  if (r.num_without_truth > 0) {
    text += Format("%zu estimated poses have no true one at their time; they are not lost\n",
                   r.num_without_truth);
  }
  text += Format("%zu of %zu frames lost (no pose, or a step wrong by over %.2f m", r.num_lost,
                 r.num_frames, kLostTranslationM);
  return text + (r.no_rotations_because.empty() ? Format(" or %.0f deg)\n", kLostRotationDeg)
                                                : ", rotations unknown)\n");
}

std::string ErrorsToText(const TrajectoryReport& r) {
  const std::string& none_because = r.no_rotations_because;
  std::string text = Format("  %-24s %-6s %9s %9s %9s %9s %9s\n", "error", "unit", "rmse", "mean",
                            "median", "max", "std");
  text += Row("ATE, SE(3) aligned", "m", r.ate_se3_m);
  text += Row("ATE, Sim(3) aligned", "m", r.ate_sim3_m);
  text += Row("ATE, not aligned", "m", r.ate_none_m);
  text += Row("RPE per frame", "m", r.rpe_translation_per_frame_m, none_because);
  text += Row("RPE per frame", "deg", r.rpe_rotation_per_frame_deg, none_because);
  text += Row("RPE per metre travelled", "m/m", r.rpe_translation_per_metre_m, none_because);
  text += Row("RPE per metre travelled", "deg/m", r.rpe_rotation_per_metre_deg, none_because);
  text += Format("\n  Sim(3) scale %.6f", r.sim3_scale);
  text += none_because.empty()
              ? Format("; drift of the end point %.3f %% of the path\n", r.end_point_drift_percent)
              : "\n";
  for (const SegmentDrift& drift : r.segment_drifts) {
    text += Format("  drift over %3.0f m: %.3f %%, %.5f deg/m (%zu segments)\n", drift.length_m,
                   drift.translation_percent, drift.rotation_deg_per_m, drift.num_segments);
  }
  return text;
}

nlohmann::json StatisticsToJson(const Statistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count},   {"rmse", s.rmse}, {"mean", s.mean},
          {"median", s.median}, {"max", s.max},   {"std", s.std}};
}

}  // namespace

std::string ToLine(const Remark& remark) {
  return (remark.is_warning ? "WARNING: " : "NOTE: ") + remark.text;
}

nlohmann::json RemarksToJson(const Remarks& remarks) {
  nlohmann::json lines = nlohmann::json::array();
  for (const Remark& remark : remarks) lines.push_back(ToLine(remark));
  return lines;
}

std::string ToTable(const TrajectoryReport& r) {
  std::string text = CountsToText(r);
  text += Format("path %.3f m", r.path_m);
  if (r.has_times) text += Format(" in %.3f s", r.duration_s);
  text += "\nground truth axes: " + r.axes.Name() + ", " + r.axes_reason + "\n";
  for (const AxesAlternative& other : r.alternatives) {
    text += "  AMBIGUOUS: the motion fits axes " + other.axes.Name() +
            (other.axes.is_right_handed() ? " (right-handed)" : " (left-handed)") +
            Format(" as well, with ATE %.4f m\n", other.ate_se3_m.rmse);
  }
  text += "\n" + ErrorsToText(r);
  if (!r.remarks.empty()) text += "\n";
  for (const bool is_warning : {false, true}) {
    for (const Remark& remark : r.remarks) {
      if (remark.is_warning == is_warning) text += ToLine(remark) + "\n";
    }
  }
  return text;
}

nlohmann::json ToJson(const TrajectoryReport& r) {
  nlohmann::json segments = nlohmann::json::array();
  for (const SegmentDrift& drift : r.segment_drifts) {
    segments.push_back({{"length_m", drift.length_m},
                        {"num_segments", drift.num_segments},
                        {"translation_percent", drift.translation_percent},
                        {"rotation_deg_per_m", drift.rotation_deg_per_m}});
  }
  nlohmann::json alternatives = nlohmann::json::array();
  for (const AxesAlternative& other : r.alternatives) {
    alternatives.push_back({{"axes", other.axes.Name()},
                            {"right_handed", other.axes.is_right_handed()},
                            {"ate_se3_m", StatisticsToJson(other.ate_se3_m)}});
  }
  const bool has_rotations = r.no_rotations_because.empty();
  return {{"poses_estimated", r.num_estimate},
          {"poses_ground_truth", r.num_ground_truth},
          {"poses_matched", r.num_matched},
          {"completeness", r.completeness},
          {"frames", r.num_frames},
          {"frames_lost", r.num_lost},
          {"path_m", r.path_m},
          {"duration_s", r.has_times ? nlohmann::json(r.duration_s) : nlohmann::json(nullptr)},
          {"ground_truth_axes", r.axes.Name()},
          {"ground_truth_right_handed", r.axes.is_right_handed()},
          {"ground_truth_axes_alternatives", alternatives},
          {"ground_truth_axes_reason", r.axes_reason},
          {"ate_none_m", StatisticsToJson(r.ate_none_m)},
          {"ate_se3_m", StatisticsToJson(r.ate_se3_m)},
          {"ate_sim3_m", StatisticsToJson(r.ate_sim3_m)},
          {"sim3_scale", r.sim3_scale},
          {"rpe_translation_per_frame_m", StatisticsToJson(r.rpe_translation_per_frame_m)},
          {"rpe_rotation_per_frame_deg", StatisticsToJson(r.rpe_rotation_per_frame_deg)},
          {"rpe_translation_per_metre_m", StatisticsToJson(r.rpe_translation_per_metre_m)},
          {"rpe_rotation_per_metre_deg", StatisticsToJson(r.rpe_rotation_per_metre_deg)},
          {"end_point_drift_percent",
           has_rotations ? nlohmann::json(r.end_point_drift_percent) : nlohmann::json(nullptr)},
          {"segment_drifts", segments},
          {"has_rotation_figures", has_rotations},
          {"truth_has_higher_rate", r.has_truth_higher_rate},
          {"remarks", RemarksToJson(r.remarks)}};
}

}  // namespace airdos
