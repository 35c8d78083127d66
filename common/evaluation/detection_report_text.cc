// Formats the figures about detections as text and JSON.
#include <nlohmann/json.hpp>

#include "common/evaluation/detection_report.h"
#include "common/evaluation/people_matching.h"
#include "common/human/person_pairing.h"
#include "common/util/format.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr std::array<const char*, kNumImages> kImageNames = {"left", "right"};

std::string RecallCells(const char* name, const Recall& recall) {
  return Format("  %-24s %8zu %8zu %7.1f %%", name, recall.num_people, recall.num_found,
                recall.percent());
}

std::string ErrorCells(const ErrorSpread& error) {
  if (error.count == 0) return Format(" %8d %9s %9s", 0, "-", "-");
  return Format(" %8zu %9.2f %9.2f", error.count, error.median, error.percentile_90);
}

std::string ImageTable(const std::string& title, const ImageScore& s) {
  std::string text = Format("  %-24s %8s %8s %9s %8s %9s %9s\n", title.c_str(), "people", "found",
                            "recall", "joints", "median px", "90 % px");
  text += RecallCells("all to be seen", s.recall) + ErrorCells(s.joint_px) + "\n";
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    text += RecallCells(kDepthBandNames[i], s.recall_by_depth[i]) +
            ErrorCells(s.joint_px_by_depth[i]) + "\n";
  }
  for (std::size_t i = 0; i < kNumSights; ++i) {
    text += RecallCells(kSightNames[i], s.recall_by_sight[i]) + "\n";
  }
  text += Format(
      "  %zu detections in %zu images, %zu of them on people not to be seen; %zu of too few "
      "joints\n",
      s.num_detections, s.num_images, s.num_on_others, s.num_unusable);
  text += Format(
      "  false: %.2f an image, %zu in all: %zu second ones of a person, %zu on a person but with "
      "joints\n  elsewhere, %zu on nobody; sides exchanged: %zu\n\n",
      s.false_per_image(), s.num_false, s.num_doubles, s.num_astray, s.num_on_nobody(),
      s.num_exchanged);
  return text;
}

std::string DisparityTable(const DetectorScore& s) {
  const auto row = [](const char* name, const ErrorSpread& error) {
    return Format("  %-24s", name) + ErrorCells(error) + "\n";
  };
  std::string text =
      Format("  %-24s %8s %9s %9s\n", "error of the disparity", "joints", "median px", "90 % px");
  text += row(Format("%zu in both images", s.num_pairs).c_str(), s.disparity_px);
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    text += row(kDepthBandNames[i], s.disparity_px_by_depth[i]);
  }
  return text + "\n";
}

std::string DetectorTables(const std::string& who, const DetectorScore& score) {
  std::string text = who + " people, against the true ones\n";
  for (std::size_t side = 0; side < kNumImages; ++side) {
    if (score.images[side].num_images == 0) continue;
    text += ImageTable(Format("%s image", kImageNames[side]), score.images[side]);
  }
  return text + DisparityTable(score);
}

std::string AgreementTable(const std::array<AgreementScore, kNumImages>& scores) {
  std::string text = "detected people, against the given ones (depth as their size lets expect)\n";
  for (std::size_t side = 0; side < kNumImages; ++side) {
    const AgreementScore& s = scores[side];
    if (s.num_images == 0) continue;
    text += Format("  %-24s %8s %8s %9s\n", Format("%s image", kImageNames[side]).c_str(), "given",
                   "found", "recall");
    text += RecallCells("all given", s.recall) + "\n";
    for (std::size_t i = 0; i < kNumDepthBands; ++i) {
      text += RecallCells(kDepthBandNames[i], s.recall_by_depth[i]) + "\n";
    }
    text += Format("  %zu detections in %zu images: %zu without a given one, %.2f an image\n\n",
                   s.num_detections, s.num_images, s.num_without_partner,
                   s.without_partner_per_image());
  }
  return text;
}

json ToJson(const Recall& r) {
  return {{"people", r.num_people},
          {"found", r.num_found},
          {"recall_percent", r.num_people > 0 ? json(r.percent()) : json(nullptr)}};
}

json ToJson(const ErrorSpread& e) {
  if (e.count == 0) return nullptr;
  return {{"count", e.count}, {"median", e.median}, {"percentile_90", e.percentile_90}};
}

json ToJson(const ImageScore& score);
json ToJson(const AgreementScore& score);

template <class Value, std::size_t kSize>
json ToJson(const std::array<Value, kSize>& values, const std::array<const char*, kSize>& names) {
  json object;
  for (std::size_t i = 0; i < kSize; ++i) object[names[i]] = ToJson(values[i]);
  return object;
}

json ToJson(const ImageScore& s) {
  return {{"images", s.num_images},
          {"detections", s.num_detections},
          {"detections_with_too_few_joints", s.num_unusable},
          {"to_be_seen", ToJson(s.recall)},
          {"to_be_seen_by_depth", ToJson(s.recall_by_depth, kDepthBandNames)},
          {"to_be_seen_by_sight", ToJson(s.recall_by_sight, kSightNames)},
          {"on_people_not_to_be_seen", s.num_on_others},
          {"false", s.num_false},
          {"false_per_image", s.false_per_image()},
          {"false_as_second_of_a_person", s.num_doubles},
          {"false_on_a_person_with_joints_elsewhere", s.num_astray},
          {"false_on_nobody", s.num_on_nobody()},
          {"sides_exchanged", s.num_exchanged},
          {"joint_error_px", ToJson(s.joint_px)},
          {"joint_error_px_by_depth", ToJson(s.joint_px_by_depth, kDepthBandNames)}};
}

json ToJson(const AgreementScore& s) {
  return {{"images", s.num_images},
          {"detections", s.num_detections},
          {"given", ToJson(s.recall)},
          {"given_by_depth", ToJson(s.recall_by_depth, kDepthBandNames)},
          {"without_given", s.num_without_partner},
          {"without_given_per_image", s.without_partner_per_image()}};
}

json ToJson(const std::optional<DetectorScore>& score) {
  if (!score) return nullptr;
  json object = ToJson(score->images, kImageNames);
  object["found_in_both_images"] = score->num_pairs;
  object["disparity_error_px"] = ToJson(score->disparity_px);
  object["disparity_error_px_by_depth"] = ToJson(score->disparity_px_by_depth, kDepthBandNames);
  return object;
}

}  // namespace

std::string ToTable(const DetectionReport& r) {
  const PersonPairingOptions usable;
  std::string text =
      Format("%zu frames; a detection has %d joints or more with confidence %.1f or more\n",
             r.num_frames, usable.min_joints, usable.min_confidence);
  if (r.detected) {
    text += Format(
        "%zu frames with a truth; to be seen: %d joints in the image, %.1f to %.0f m away\n\n",
        r.num_frames_with_truth, kMinVisibleJoints, kMinPersonDepthM, kMaxPersonDepthM);
    text += DetectorTables("detected", *r.detected);
  } else {
    text += "\n";
  }
  if (r.given) text += DetectorTables("given", *r.given);
  if (r.agreement) text += AgreementTable(*r.agreement);
  while (text.size() > 1 && text[text.size() - 2] == '\n') text.pop_back();
  return text;
}

json ToJson(const DetectionReport& r) {
  json object = {{"frames", r.num_frames},
                 {"frames_with_truth", r.num_frames_with_truth},
                 {"detected", ToJson(r.detected)},
                 {"given", ToJson(r.given)},
                 {"detected_against_given", nullptr}};
  if (r.agreement) object["detected_against_given"] = ToJson(*r.agreement, kImageNames);
  return object;
}

}  // namespace airdos
