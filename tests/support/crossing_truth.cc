#include "tests/support/crossing_truth.h"

#include <zlib.h>

#include <cstddef>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"

namespace airdos {
namespace {

std::string ReadGzip(const std::string& path) {
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) throw InputError(path + ": cannot be read");
  std::string text;
  std::array<char, 1 << 16> block;
  int size = 0;
  while ((size = gzread(file, block.data(), block.size())) > 0) {
    text.append(block.data(), static_cast<std::size_t>(size));
  }
  gzclose(file);
  if (size < 0) throw InputError(path + ": is damaged");
  return text;
}

std::vector<Se3> ReadPoses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<Se3> poses;
  double t, x, y, z, qx, qy, qz, qw;
  while (file >> t >> x >> y >> z >> qx >> qy >> qz >> qw) {
    poses.push_back({Eigen::Quaterniond(qw, qx, qy, qz).normalized(), Eigen::Vector3d(x, y, z)});
  }
  return poses;
}

TruePerson ToPerson(const nlohmann::json& human, const Se3& T_C_W) {
  TruePerson person;
  for (int joint = 0; joint < kNumJoints; ++joint) {
    const nlohmann::json& p = human.at("joints_w").at(std::to_string(joint));
    const std::size_t i = static_cast<std::size_t>(joint);
    person.p_C[i] = T_C_W * Eigen::Vector3d(p.at(0), p.at(1), p.at(2));
    person.is_plain[i] = human.at("vis0").at(i).get<int>() == 2;
  }
  for (const auto& visibility : human.at("vis0")) person.num_visible_left += visibility > 0;
  for (const auto& visibility : human.at("vis1")) person.num_visible_right += visibility > 0;
  return person;
}

std::vector<std::int64_t> ReadIdentities(const std::string& folder, std::size_t frame) {
  std::array<char, 32> name;
  std::snprintf(name.data(), name.size(), "/%06zu.txt", frame);
  std::ifstream file(folder + "/track_id_alpha" + name.data());
  std::vector<std::int64_t> identities;
  std::int64_t identity = 0;
  while (file >> identity) identities.push_back(identity);
  return identities;
}

}  // namespace

std::vector<TrueFrame> ReadCrossingTruth(const std::string& folder) {
  const std::vector<Se3> T_W_C = ReadPoses(folder + "/gt_tum_optical.txt");
  const nlohmann::json joints = nlohmann::json::parse(ReadGzip(folder + "/joints_gt.json.gz"));
  if (joints.size() != T_W_C.size())
    throw InputError(folder + ": joints and poses differ in number");
  std::vector<TrueFrame> frames(T_W_C.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (const auto& human : joints.at(k).at("humans")) {
      frames[k].people[human.at("id").get<std::int64_t>()] = ToPerson(human, T_W_C[k].inverse());
    }
    frames[k].identity_left = ReadIdentities(folder, k);
  }
  return frames;
}

}  // namespace airdos
