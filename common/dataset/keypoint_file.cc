#include "common/dataset/keypoint_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLayoutsRead =
    "54 numbers (COCO-18), 51 (COCO-17) and 78 (Halpe-26) per person are read, u v confidence of "
    "each joint";

std::optional<KeypointLayout> LayoutOfCount(std::size_t count) {
  for (const KeypointLayout layout :
       {KeypointLayout::kCoco18, KeypointLayout::kCoco17, KeypointLayout::kHalpe26}) {
    if (count == 3 * static_cast<std::size_t>(NumKeypoints(layout))) return layout;
  }
  return std::nullopt;
}

std::vector<double> ParseRow(const std::string& path, const TextLine& line) {
  try {
    return ParseNumbers(path, line, 0);
  } catch (const InputError& error) {
    throw InputError(error.what() + ExplainSeparators(line));
  }
}

/// Number of words in the first line that is neither blank nor a comment.
std::size_t CountFirstRow(const std::string& path) {
  std::ifstream file(path);
  constexpr std::size_t kMaxLines = 100;  // of comments
  std::string text;
  for (std::size_t i = 0; i < kMaxLines && std::getline(file, text); ++i) {
    std::istringstream stream(text);
    const std::vector<std::string> words(std::istream_iterator<std::string>(stream), {});
    if (!words.empty() && words[0][0] != '#') return words.size();
  }
  return 0;
}

}  // namespace

std::string ExplainKeypointCount(std::size_t count) {
  static const std::map<std::size_t, std::string> kKnown = {
      {75, "OpenPose's BODY_25: of its joints, 0-18 without 8 are COCO-18's"},
      {50, "OpenPose's BODY_25 without confidences"},
      {36, "COCO-18 without confidences"},
      {34, "COCO-17 without confidences"},
      {52, "Halpe-26 without confidences, or COCO-17 with an extra number"},
      {408, "Halpe-136: of its joints, the first 26 are Halpe-26's"},
      {399, "COCO-WholeBody: of its joints, the first 17 are COCO-17's"},
      {411, "OpenPose's body, hands and face"},
      {42, "CrowdPose"},
      {48, "MPII"},
      {45, "OpenPose's MPI"},
      {57, "COCO-18 with an extra joint"},
      {96, "Human3.6M"},
      {99, "BlazePose"},
      {132, "BlazePose with four numbers per joint"},
      {63, "a hand"},
      {55, "COCO-18 with an extra number, an identity or a score"},
      {79, "Halpe-26 with an extra number, an identity or a score"},
      {56, "COCO-17 with a box of five numbers"},
      {58, "COCO-18 with a box of four numbers"},
      {3, "one joint per line"},
      {2, "one joint per line, without confidence"}};
  const auto known = kKnown.find(count);
  return known == kKnown.end() ? "" : ": this looks like " + known->second;
}

std::string NameOf(KeypointLayout layout) {
  switch (layout) {
    case KeypointLayout::kCoco17:
      return "COCO-17";
    case KeypointLayout::kHalpe26:
      return "Halpe-26";
    case KeypointLayout::kCoco18:
      break;
  }
  return "COCO-18";
}

KeypointFile ReadRawKeypoints(const std::string& path) {
  KeypointFile file;
  if (path.empty() || !fs::exists(path)) return file;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> numbers = ParseRow(path, line);
    const std::optional<KeypointLayout> layout = LayoutOfCount(numbers.size());
    const std::string where = path + ":" + std::to_string(line.number) + ": ";
    if (!layout) {
      throw InputError(where + "holds " + std::to_string(numbers.size()) + " numbers" +
                       ExplainKeypointCount(numbers.size()) + "; " + kLayoutsRead);
    }
    if (file.layout && file.layout != layout) {
      throw InputError(where + "holds a person in " + NameOf(*layout) +
                       ", the lines before it in " + NameOf(*file.layout) +
                       "; all must have the same layout");
    }
    file.layout = layout;
    PersonKeypoints person(numbers.size() / 3);
    for (std::size_t j = 0; j < person.size(); ++j) {
      person[j] = {static_cast<float>(numbers[3 * j]), static_cast<float>(numbers[3 * j + 1]),
                   static_cast<float>(numbers[3 * j + 2])};
    }
    file.people.push_back(std::move(person));
  }
  return file;
}

KeypointFile ReadKeypoints(const std::string& path) {
  KeypointFile file = ReadRawKeypoints(path);
  for (PersonKeypoints& person : file.people) {
    for (Keypoint& keypoint : person)
      keypoint.confidence = std::clamp(keypoint.confidence, 0.F, 1.F);
  }
  return file;
}

std::optional<KeypointLayout> FindLayout(const std::vector<std::string>& paths) {
  std::optional<KeypointLayout> found;
  std::string where_found;
  for (const std::string& path : paths) {
    if (path.empty() || !fs::is_regular_file(path)) continue;
    const std::optional<KeypointLayout> layout = LayoutOfCount(CountFirstRow(path));
    if (!layout) continue;
    if (found && layout != found) {
      throw InputError(path + ": holds people in " + NameOf(*layout) + ", but " + where_found +
                       " in " + NameOf(*found) + "; all of a data set must have the same layout");
    }
    if (!found) where_found = path;
    found = layout;
  }
  return found;
}

}  // namespace airdos
