#include "common/evaluation/people_files.h"

#include <zlib.h>

#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/human/skeleton.h"
#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/json_file.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr std::int64_t kMaxId = std::int64_t{1} << 53;  // limit of exact integers in JSON
constexpr std::size_t kMaxUnpackedBytes = 256u << 20;   // about 7,000 frames

Joints ParseJoints(const json& object) {
  Joints joints;
  for (const auto& [key, place] : object.items()) {
    const int id = std::stoi(key);
    if (id < 0) throw InputError("'" + key + "' is not a joint");
    if (id >= kNumJoints) continue;  // a point of the face
    joints[id] = Eigen::Vector3d(place.at(0).get<double>(), place.at(1).get<double>(),
                                 place.at(2).get<double>());
  }
  return joints;
}

/// Reads a file, decompressing it if it is gzipped.
std::string ReadUnpacked(const std::string& path) {
  RequireRegularFile(path);
  const gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) throw InputError(path + ": cannot be read");
  std::string text;
  char buffer[1 << 16];
  int size = 0;
  while ((size = gzread(file, buffer, sizeof buffer)) > 0) {
    text.append(buffer, static_cast<std::size_t>(size));
    if (text.size() > kMaxUnpackedBytes) {
      gzclose(file);
      throw InputError(path + ": decompresses to more than " + std::to_string(kMaxUnpackedBytes) +
                       " bytes");
    }
  }
  gzclose(file);
  if (size < 0) throw InputError(path + ": cannot be decompressed");
  return text;
}

std::optional<int> CountVisible(const json& human, const char* key) {
  if (!human.contains(key)) return std::nullopt;
  int count = 0;
  for (const json& visibility : human.at(key)) count += visibility.get<double>() > 0 ? 1 : 0;
  return count;
}

/// Of the joints of our body model.
std::set<int> FindVisible(const json& human, const char* key) {
  std::set<int> visible;
  if (!human.contains(key)) return visible;
  int joint = 0;
  for (const json& visibility : human.at(key)) {
    if (joint < kNumJoints && visibility.get<double>() > 0) visible.insert(joint);
    ++joint;
  }
  return visible;
}

}  // namespace

std::vector<PersonState> ReadPeople(const std::string& path) {
  RequireRegularFile(path);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<PersonState> states;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    try {
      const json object = json::parse(line);
      PersonState state;
      state.time_s = 1e-6 * object.at("utime").get<double>();
      state.track = WholeNumber(object.at("track"), -kMaxId, kMaxId);
      state.joints_W = ParseJoints(object.at("joints"));
      state.measured_W = ParseJoints(object.at("measured"));
      for (const auto& [key, length_m] : object.at("segment_lengths_m").items()) {
        const int segment = std::stoi(key);
        if (segment < 0 || segment >= kNumSegments)
          throw InputError("'" + key + "' is not a segment");
        state.segment_length_m[segment] = length_m;
      }
      states.push_back(std::move(state));
    } catch (const std::exception& error) {
      throw InputError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  return states;
}

std::vector<TruePeople> ReadTruePeople(const std::string& path) {
  const std::string text = ReadUnpacked(path);
  std::vector<TruePeople> frames;
  try {
    for (const json& object : json::parse(text)) {
      TruePeople frame;
      frame.time_s = object.at("t");
      for (const json& human : object.at("humans")) {
        TruePersonState& person = frame.people[WholeNumber(human.at("id"), -kMaxId, kMaxId)];
        person.joints = ParseJoints(human.at("joints_w"));
        person.num_visible_left = CountVisible(human, "vis0");
        person.num_visible_right = CountVisible(human, "vis1");
        person.visible_left = FindVisible(human, "vis0");
        person.visible_right = FindVisible(human, "vis1");
      }
      frames.push_back(std::move(frame));
    }
  } catch (const std::exception& error) {
    throw InputError(path + ": " + error.what());
  }
  return frames;
}

}  // namespace airdos
