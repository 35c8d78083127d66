#include "common/check/check_images.h"

#include <map>
#include <string>

namespace airdos {
namespace {

/// Files that have something in common.
struct Group {
  int num = 0;
  std::string first;
};
using Groups = std::map<std::string, Group>;

void Count(const std::string& key, const std::string& path, Groups* groups) {
  Group& group = (*groups)[key];
  if (group.num++ == 0) group.first = path;
}

std::string OfAll(const Group& group, std::size_t num_images) {
  return std::to_string(group.num) + " of " + std::to_string(num_images) + " images";
}

std::string KindOf(const ImageHeader& header) {
  if (header.is_palette) return "palette PNG";
  const char* channels[] = {"", "grey", "grey and alpha", "RGB", "RGBA"};
  return (header.is_png && header.bits != 8 ? std::to_string(header.bits) + "-bit " : "") +
         (header.num_channels >= 1 && header.num_channels <= 4 ? channels[header.num_channels]
                                                               : "unknown");
}

void ReportOrientation(const Groups& orientations, std::size_t num_images, FindingList* findings) {
  for (const auto& [wish, group] : orientations) {
    if (wish == OrientationText(1)) continue;
    findings->Note("images.orientation", group.first,
                   "EXIF data want " + OfAll(group, num_images) + " " + wish +
                       ": ignored, pixels are used as stored");
  }
}

void ReportKinds(const Groups& kinds, std::size_t num_images,
                 const std::optional<SixteenBitRange>& range, FindingList* findings) {
  for (const auto& [kind, group] : kinds) {
    const std::string text = OfAll(group, num_images) + " are " + kind;
    if (kind.find("16-bit") == 0 && range) {
      findings->Note("images.bits", group.first, RangeText(*range));
    }
    if (kind.find("1-bit") == 0 || kind.find("2-bit") == 0 || kind.find("4-bit") == 0) {
      findings->Warn("images.bits", group.first, text + ": too few grey levels for corners");
    } else if (kind.find("alpha") != std::string::npos || kind.find("RGBA") != std::string::npos) {
      findings->Note("images.alpha", group.first, text + ": the alpha channel is not used");
    }
  }
  if (kinds.size() <= 1) return;
  std::string list;
  for (const auto& [kind, group] : kinds) {
    list += (list.empty() ? "" : ", ") + std::to_string(group.num) + " " + kind + " (first " +
            group.first + ")";
  }
  findings->Warn("images.kinds", kinds.begin()->second.first,
                 "the images have different formats: " + list);
}

}  // namespace

void CheckImageFiles(const std::vector<SurveyedImage>& images, const StereoCamera& camera,
                     const std::optional<SixteenBitRange>& range, FindingList* findings) {
  Groups orientations;
  Groups kinds;
  for (const SurveyedImage& image : images) {
    if (!image.error.empty()) {
      findings->FailFrom("images.file", image.error);
      continue;
    }
    const ImageHeader& header = *image.header;
    if (header.width != camera.width || header.height != camera.height) {
      findings->Fail(
          "images.size", image.path,
          SizeMismatchText(header.width, header.height, "the camera", camera.width, camera.height));
    }
    Count(OrientationText(header.orientation), image.path, &orientations);
    Count(KindOf(header), image.path, &kinds);
  }
  ReportOrientation(orientations, images.size(), findings);
  ReportKinds(kinds, images.size(), range, findings);
}

}  // namespace airdos
