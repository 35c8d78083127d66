#include <filesystem>
#include <string>
#include <vector>

#include "common/dataset/keypoints/foreign_keypoints.h"
#include "common/dataset/keypoints/keypoint_matching.h"
#include "common/util/error.h"
#include "tests/fuzz/fuzz_input.h"

// People that other programs found: their files, and which images they belong to.

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// What must hold of whatever was read.
void CheckPeople(const ForeignKeypoints& read) {
  for (const ForeignImage& image : read.images) {
    for (const PersonKeypoints& person : image.people) {
      FuzzCheck(person.size() == 18, "a person who is not in COCO-18");
      for (const Keypoint& joint : person) {
        FuzzCheck(joint.confidence >= 0 && joint.confidence <= 1, "a confidence beyond 0..1");
        FuzzCheck(joint.confidence > 0 || (joint.u_px == 0 && joint.v_px == 0),
                  "a joint that is not seen has a place");
      }
    }
  }
}

void ReadAndMatch(const std::string& path) {
  try {
    const ForeignKeypoints read = ReadForeignKeypoints(path);
    CheckPeople(read);
    const std::vector<std::string> ours = {"000000.png", "000001.png", "left2.png"};
    const KeypointMatching matching = MatchKeypoints(path, read.images, ours);
    FuzzCheck(matching.image_of.size() == ours.size(), "images were lost");
    for (const auto& image : matching.image_of) {
      FuzzCheck(!image || *image < read.images.size(), "an image that is not there");
    }
  } catch (const InputError&) {
  }
}

void RunFile(const std::uint8_t* data, std::size_t size) {
  ReadAndMatch(FuzzFolder::Write("results.json", data, size));
}

/// Each block is a file of the folder.
void RunFolder(const char* ending, const std::uint8_t* data, std::size_t size) {
  const std::string folder = FuzzFolder::Path() + "/people";
  fs::create_directories(folder);
  FuzzInput input(data, size);
  constexpr int kMaxFiles = 3;
  for (int i = 0; i < kMaxFiles && !input.empty(); ++i) {
    const FuzzBytes bytes = input.Block();
    FuzzFolder::Write("people/" + std::to_string(i) + ending, bytes.data(), bytes.size());
  }
  ReadAndMatch(folder);
  fs::remove_all(folder);
}

void RunOpenPose(const std::uint8_t* data, std::size_t size) {
  RunFolder("_keypoints.json", data, size);
}
void RunLines(const std::uint8_t* data, std::size_t size) { RunFolder(".txt", data, size); }

std::string Numbers(int num_joints, const std::string& separator) {
  std::string text;
  for (int j = 0; j < num_joints; ++j) {
    text +=
        (j == 0 ? "" : separator) + std::to_string(j + 3) + separator + "4.5" + separator + "0.9";
  }
  return text;
}

std::string AlphaPosePerson(const std::string& image, int num_joints, const std::string& idx) {
  return "{\"image_id\":" + image + ",\"category_id\":1,\"keypoints\":[" +
         Numbers(num_joints, ",") + "],\"score\":3.0,\"box\":[1,2,3,4],\"idx\":" + idx + "}";
}

FuzzBytes BytesOf(const std::string& text) { return {text.begin(), text.end()}; }

std::vector<FuzzBytes> AlphaPoseSeeds() {
  return {BytesOf("[" + AlphaPosePerson("\"0.jpg\"", 17, "[0.0]") + "," +
                  AlphaPosePerson("\"1.jpg\"", 17, "\"1\"") + "]"),
          BytesOf("[" + AlphaPosePerson("\"out2.png\"", 26, "[[0.0],[0.0]]") + "]"),
          BytesOf("[" + AlphaPosePerson("1", 136, "2") + "]")};
}

std::vector<FuzzBytes> CocoSeeds() {
  return {BytesOf("[{\"image_id\":1,\"category_id\":1,\"keypoints\":[" + Numbers(17, ",") +
                  "],\"score\":0.5},{\"image_id\":2,\"keypoints\":[],\"score\":0.1}]"),
          BytesOf("[]")};
}

std::vector<FuzzBytes> FolderSeeds(const std::vector<std::string>& files) {
  FuzzOutput seed;
  for (const std::string& file : files) seed.Block(file);
  return {seed.Take()};
}

std::vector<FuzzBytes> OpenPoseSeeds() {
  const auto file = [](int num_joints) {
    return "{\"version\":1.3,\"people\":[{\"person_id\":[-1],\"pose_keypoints_2d\":[" +
           Numbers(num_joints, ",") + "]},{\"pose_keypoints_2d\":[]}]}";
  };
  std::vector<FuzzBytes> seeds = FolderSeeds({file(25), "{\"people\":[]}"});
  for (const FuzzBytes& seed : FolderSeeds({file(18), file(18)})) seeds.push_back(seed);
  return seeds;
}

std::vector<FuzzBytes> LinesSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const int num_joints : {17, 18, 26}) {
    for (const FuzzBytes& seed : FolderSeeds({Numbers(num_joints, " ") + "\n", "# nobody\n"}))
      seeds.push_back(seed);
  }
  return seeds;
}

}  // namespace

std::vector<FuzzTarget> KeypointTargets() {
  return {{"keypoints_alphapose", RunFile, AlphaPoseSeeds, 4096},
          {"keypoints_coco", RunFile, CocoSeeds, 4096},
          {"keypoints_openpose", RunOpenPose, OpenPoseSeeds, 4096},
          {"keypoints_lines", RunLines, LinesSeeds, 4096}};
}

}  // namespace airdos
