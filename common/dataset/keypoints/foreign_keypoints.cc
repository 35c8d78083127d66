#include "common/dataset/keypoints/foreign_keypoints.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/dataset/file_name.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/keypoints/foreign_json.h"
#include "common/dataset/keypoints/keypoint_collector.h"
#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMaxListBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxImageBytes = 10000000;
constexpr const char* kRead =
    "read are AlphaPose's and COCO's results (one file) and, a file an image in a folder, "
    "OpenPose's and lines of numbers";

/// OpenPose's own, and those that others write into files like its.
const std::vector<ForeignLayout>& LayoutsOfOpenPose() {
  static const std::vector<ForeignLayout> layouts = {
      ForeignLayout::kBody25,  ForeignLayout::kCoco18,       ForeignLayout::kCoco17,
      ForeignLayout::kHalpe26, ForeignLayout::kWholeBody133, ForeignLayout::kHalpe136};
  return layouts;
}

std::string EntryText(const std::string& path, std::size_t number) {
  return path + ": entry " + std::to_string(number);
}

const Json& MemberOf(const Json& object, const char* name, const std::string& where) {
  const auto member = object.find(name);
  if (member == object.end()) throw InputError(where + ": has no '" + name + "'; " + kRead);
  return *member;
}

std::string ImageIdOf(const Json& entry, const std::string& where) {
  const Json& id = MemberOf(entry, "image_id", where);
  if (id.is_string()) return id.get<std::string>();
  if (id.is_number_integer()) return id.dump();
  throw InputError(where + ": its image_id is neither a name nor a whole number");
}

/// AlphaPose's results have a box, or a number of the person, and names of images; COCO's have not.
bool IsOfAlphaPose(const Json& entry) {
  return entry.contains("box") || entry.contains("idx") || entry["image_id"].is_string();
}

/// What an object at the top is, if not one image of OpenPose.
std::string ExplainObject(const std::string& path, const Json& object) {
  if (object.contains("annotations")) {
    return path + ": looks like COCO annotations, not results; " + kRead;
  }
  if (object.contains("instance_info")) return path + ": looks like MMPose's output; " + kRead;
  return path + ": has neither 'people' (OpenPose) nor is it a list (AlphaPose, COCO); " + kRead;
}

void AddOpenPoseImage(const std::string& path, const Json& object, KeypointCollector* collector) {
  std::string name = fs::path(path).stem().string();
  constexpr char kEnding[] = "_keypoints";
  constexpr std::size_t kEndingSize = sizeof(kEnding) - 1;
  if (name.size() > kEndingSize &&
      name.compare(name.size() - kEndingSize, kEndingSize, kEnding) == 0) {
    name.resize(name.size() - kEndingSize);
  }
  collector->AddImage(name);
  const Json& people = MemberOf(object, "people", path);
  if (!people.is_array()) throw InputError(path + ": its people are not a list");
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::string where = path + ": person " + std::to_string(i);
    if (!people[i].is_object()) throw InputError(where + ": is not an object");
    const bool is_old = people[i].contains("pose_keypoints");  // before OpenPose 1.3
    const Json& joints =
        MemberOf(people[i], is_old ? "pose_keypoints" : "pose_keypoints_2d", where);
    collector->AddPerson(name, where, NumbersOf(joints, where));
  }
}

ForeignKeypoints ReadJsonFile(const std::string& path) {
  KeypointCollector list(path, "AlphaPose or COCO results",
                         {ForeignLayout::kCoco17, ForeignLayout::kHalpe26, ForeignLayout::kHalpe136,
                          ForeignLayout::kWholeBody133});
  bool is_of_alphapose = false;
  const Json rest =
      ParseForeignJson(path, kMaxListBytes, [&](const Json& entry, std::size_t number) {
        const std::string where = EntryText(path, number);
        const std::string image = ImageIdOf(entry, where);
        is_of_alphapose = is_of_alphapose || IsOfAlphaPose(entry);
        list.AddPerson(image, where, NumbersOf(MemberOf(entry, "keypoints", where), where));
        list.SetProgram(is_of_alphapose ? "AlphaPose" : "COCO results");
      });
  if (rest.is_array()) return list.Finish();
  if (!rest.is_object() || !rest.contains("people")) {
    throw InputError(ExplainObject(path, rest));
  }
  KeypointCollector image(path, "OpenPose", LayoutsOfOpenPose());
  AddOpenPoseImage(path, rest, &image);
  return image.Finish();
}

ForeignKeypoints ReadJsonFolder(const std::string& folder, const std::vector<std::string>& names) {
  KeypointCollector collector(folder, "OpenPose", LayoutsOfOpenPose());
  for (const std::string& name : names) {
    const std::string path = folder + "/" + name;
    const Json object = ParseForeignJson(path, kMaxImageBytes, [&](const Json&, std::size_t) {
      throw InputError(path + ": a list of people beside " + std::to_string(names.size() - 1) +
                       " other .json files; give one of them");
    });
    if (!object.is_object() || !object.contains("people")) {
      throw InputError(ExplainObject(path, object));
    }
    AddOpenPoseImage(path, object, &collector);
  }
  return collector.Finish();
}

ForeignKeypoints ReadTextFolder(const std::string& folder, const std::vector<std::string>& names) {
  KeypointCollector collector(
      folder, "lines of numbers",
      {ForeignLayout::kCoco18, ForeignLayout::kCoco17, ForeignLayout::kHalpe26});
  for (const std::string& name : names) {
    const std::string path = folder + "/" + name;
    const KeypointFile file = ReadRawKeypoints(path);
    const std::string image = fs::path(name).stem().string();
    collector.AddImage(image);
    for (const PersonKeypoints& person : file.people) {
      std::vector<float> numbers;
      for (const Keypoint& joint : person) {
        numbers.insert(numbers.end(), {joint.u_px, joint.v_px, joint.confidence});
      }
      collector.AddPerson(image, path, numbers);
    }
  }
  return collector.Finish();
}

std::vector<std::string> VisibleFiles(const std::string& folder, const std::string& ending) {
  std::vector<std::string> names = ListFiles(folder, {ending});
  names.erase(std::remove_if(names.begin(), names.end(), IsHidden), names.end());
  return names;
}

ForeignKeypoints ReadFolder(const std::string& folder) {
  const std::vector<std::string> json = VisibleFiles(folder, ".json");
  const std::vector<std::string> text = VisibleFiles(folder, ".txt");
  if (json.empty() && text.empty()) {
    throw InputError(folder + ": holds no .json or .txt file with keypoints; " + kRead);
  }
  if (!json.empty() && !text.empty()) {
    throw InputError(folder + ": holds .json and .txt files, such as '" + json[0] + "' and '" +
                     text[0] + "': which are the keypoints?");
  }
  if (json.size() == 1) return ReadJsonFile(folder + "/" + json[0]);
  return json.empty() ? ReadTextFolder(folder, text) : ReadJsonFolder(folder, json);
}

/// Whether the first character that is no blank begins a JSON value of several parts.
bool LooksLikeJson(const std::string& path) {
  RequireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";
  char c = '\0';
  while (file.get(c)) {
    const bool is_mark = std::find(kByteOrderMark, kByteOrderMark + 3, c) != kByteOrderMark + 3;
    if (!is_mark && c != ' ' && c != '\t' && c != '\r' && c != '\n') break;
  }
  return c == '[' || c == '{';
}

}  // namespace

ForeignKeypoints ReadForeignKeypoints(const std::string& path) {
  if (fs::is_directory(path)) return ReadFolder(path);
  if (LooksLikeJson(path)) return ReadJsonFile(path);
  if (EndingOf(path) == ".txt") {
    throw InputError(path + ": of lines of numbers there is a file an image: give their folder");
  }
  throw InputError(path + ": is not JSON; " + kRead);
}

}  // namespace airdos
