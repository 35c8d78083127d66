#include "common/dataset/folder_survey.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>

#include "common/dataset/file_name.h"
#include "common/dataset/image_names.h"
#include "common/dataset/kitti_tracking_sequence.h"
#include "common/dataset/recording/euroc_sequence.h"
#include "common/dataset/stereo_sequence.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxEntries = 10000;  // examined when searching for data sets

/// Names of a folder's entries, sorted; nothing if it cannot be read.
std::vector<std::string> Entries(const std::string& folder,
                                 const std::function<bool(const fs::directory_entry&)>& is_wanted) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!IsHidden(name) && is_wanted(*it)) names.push_back(name);
    if (names.size() >= kMaxEntries) break;
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> Folders(const std::string& folder) {
  return Entries(folder, [](const fs::directory_entry& entry) {
    std::error_code error;
    return entry.is_directory(error);
  });
}

std::vector<std::string> Files(const std::string& folder) {
  return Entries(folder, [](const fs::directory_entry& entry) {
    std::error_code error;
    return !entry.is_directory(error);
  });
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool ContainsAny(const std::string& text, const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return text.find(part) != std::string::npos; });
}

bool IsDirectory(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// A folder that is read, and the extension of its files.
struct ReadFolder {
  std::string path;
  std::vector<std::string> endings;
  std::string wanted;
};

/// Finds the files in it with another extension.
void FindInReadFolder(const ReadFolder& folder, std::vector<UnreadFiles>* unread) {
  std::vector<std::string> others;
  std::size_t num_read = 0;
  for (const std::string& name : Files(folder.path)) {
    const std::string ending = EndingOf(name);
    const auto& endings = folder.endings;
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) {
      ++num_read;
    } else if (LowerCase(name) != "thumbs.db" && LowerCase(name) != "desktop.ini" &&
               !ContainsAny(LowerCase(name), {"readme", "license"})) {
      others.push_back(name);
    }
  }
  if (others.empty()) return;
  const std::string kinds = CountByEnding(others) + ", which " +
                            (others.size() == 1 ? "is" : "are") + " not read; expected is " +
                            folder.wanted;
  unread->push_back(
      {folder.path, (num_read == 0 ? "holds only " : "holds ") + kinds, num_read == 0});
}

constexpr char kImport[] = "; airdos-import --keypoints-left reads those of other programs";

std::string Keypoints() {
  return "a .txt file per image with a row `u v confidence ..` per person";
}

std::vector<ReadFolder> ReadFolders(const std::string& folder) {
  std::string root = folder;
  std::string sub;
  std::vector<ReadFolder> folders;
  const std::vector<std::string> images = {".png", ".jpg", ".jpeg"};
  if (IsKittiTrackingSequence(folder)) {
    const fs::path path = fs::absolute(folder).lexically_normal() / ".";
    sub = "/" + path.parent_path().filename().string();
    root = path.parent_path().parent_path().parent_path().string();
    folders = {{root + "/image_02" + sub, images, ".png or .jpg"},
               {root + "/image_03" + sub, images, ".png or .jpg"}};
  } else {
    const bool has_letters = IsDirectory(root + "/image_l");
    folders = {{root + (has_letters ? "/image_l" : "/image_0"), images, ".png or .jpg"},
               {root + (has_letters ? "/image_r" : "/image_1"), images, ".png or .jpg"}};
  }
  folders.push_back({root + "/alphapose_0" + sub, {".txt"}, Keypoints() + kImport});
  folders.push_back({root + "/alphapose_1" + sub, {".txt"}, Keypoints() + kImport});
  return folders;
}

/// Whether the folder has a file with this extension.
bool HoldsAny(const std::string& folder, const std::string& ending) {
  const std::vector<std::string> files = Files(folder);
  return std::any_of(files.begin(), files.end(),
                     [&](const std::string& name) { return EndingOf(name) == ending; });
}

void FindOtherFolders(const std::string& folder, std::vector<UnreadFiles>* unread) {
  const bool has_keypoints =
      HoldsAny(folder + "/alphapose_0", ".txt") && HoldsAny(folder + "/alphapose_1", ".txt");
  const bool has_masks = HoldsAny(folder + "/rcnnseg_image_0", ".png");
  const auto add = [&](const std::string& name, const std::string& what) {
    unread->push_back({folder + "/" + name, what, false});
  };
  for (const std::string& name : Folders(folder)) {
    const std::string lower = LowerCase(name);
    if (name == "alphapose_0" || name == "alphapose_1" || name == "rcnnseg_image_0" ||
        name == "rcnnseg_image_1" || name == "track_id_alpha") {
      continue;
    }
    if (!has_masks && ContainsAny(lower, {"mask", "seg", "rcnn", "instance", "panoptic", "yolact",
                                          "semantic", "matte", "silhouette"})) {
      add(name,
          "is not read; if these are masks of people in the left images, rename it "
          "rcnnseg_image_0");
    } else if (!has_keypoints &&
               ContainsAny(lower, {"keypoint", "pose", "kpt", "kps", "skeleton", "halpe", "joints",
                                   "coco", "people", "person", "body"})) {
      add(name, "is not read; if these are keypoints (" + Keypoints() +
                    "), rename those of the "
                    "left images alphapose_0, those of the right alphapose_1");
    } else if (lower == "image_2" || lower == "image_02") {
      add(name, "and " + (lower == "image_2" ? std::string("image_3") : "image_03") +
                    " are not read: the images are image_0 and image_1");
    } else if (ContainsAny(lower, {"mav0", "cam0"}) || lower == "left" || lower == "image_left") {
      add(name, "is not read: the images are image_0 and image_1");
    }
  }
}

void FindOtherFiles(const std::string& folder, std::vector<UnreadFiles>* unread) {
  const bool is_kitti = fs::exists(folder + "/calib.txt");
  const bool has_times = fs::exists(folder + "/times.txt");
  const std::string truth = is_kitti ? "poses.txt" : "gt_pose.txt";
  const bool has_truth = fs::exists(folder + "/" + truth);
  const bool has_calibration = is_kitti || fs::exists(folder + "/calib.json");
  for (const std::string& name : Files(folder)) {
    const std::string lower = LowerCase(name);
    const std::string ending = EndingOf(name);
    const auto add = [&](const std::string& what) {
      unread->push_back({folder + "/" + name, what, false});
    };
    if (name == "calib.json" || name == "calib.txt" || name == "times.txt" || name == truth ||
        lower.rfind("joints_gt", 0) == 0 || lower.rfind("gt_tum", 0) == 0) {
      continue;
    }
    const bool is_data = ending == ".json" || ending == ".txt" || ending == ".csv" ||
                         ending == ".npy" || ending == ".npz" || ending == ".pkl" ||
                         ending == ".yaml" || ending == ".yml" || ending == ".xml";
    if (!is_data) continue;
    if (ContainsAny(lower, {"keypoint", "alphapose", "openpose", "halpe", "skeleton"})) {
      add("is not read; expected are alphapose_0 and alphapose_1 with " + Keypoints() + kImport);
    } else if (!has_times && ContainsAny(lower, {"time"})) {
      add("is not read; times are read from times.txt, one per line, in s");
    } else if (!has_truth && ContainsAny(lower, {"pose", "truth", "gt.", "gt_", "trajectory"})) {
      add("is not read; ground truth is read from " + truth);
    } else if (!has_calibration &&
               ContainsAny(lower, {"calib", "camchain", "camera", "intrinsic"})) {
      add("is not read; the camera is read from calib.json");
    }
  }
}

std::string ListOf(const std::string& folder, const std::vector<std::string>& names) {
  constexpr std::size_t kMaxShown = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxShown); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kMaxShown) {
    text += " and " + std::to_string(names.size() - kMaxShown) + " more";
  }
  return "holds " + std::to_string(names.size()) + " data sets: " + text +
         "; choose one of them, " + "such as " + folder + "/" + names[0];
}

/// The data sets below a folder, named relative to it.
std::vector<std::string> SequencesBelow(const std::string& folder) {
  std::vector<std::string> found;
  for (const std::string& name : Folders(folder)) {
    if (HasSequenceLayout(folder + "/" + name)) {
      found.push_back(name);
      continue;
    }
    for (const std::string& child : Folders(folder + "/" + name)) {
      if (found.size() > kMaxEntries) return found;
      const std::string below = name + "/" + child;
      if (HasSequenceLayout(folder + "/" + below)) found.push_back(below);
    }
  }
  return found;
}

/// Recognises other layouts that users have.
std::string ExplainOtherLayout(const std::string& folder) {
  const auto has = [&](const std::string& name) { return IsDirectory(folder + "/" + name); };
  const std::string wanted =
      "image_0 and image_1 with rectified images, calib.json and times.txt are expected";
  if (has("mav0/cam0/data") || has("cam0/data")) {
    return "this is EuRoC's layout, but cam0/data and cam1/data are not both there";
  }
  if (has("image_00/data") || has("image_02/data")) {
    return "this is KITTI raw; make image_0 and image_1 from image_00/data and image_01/data, and "
           "calib.txt from the lines P_rect_00 and P_rect_01 of calib_cam_to_cam.txt, named P0: "
           "and "
           "P1:";
  }
  if (has("image_2") && has("image_3")) {
    return "image_2 and image_3 are KITTI's colour images; rename them image_0 and image_1, with a "
           "calib.txt that names their P2: and P3: P0: and P1:";
  }
  if (has("rgb") && has("depth")) return "this is an RGB-D data set (TUM); " + wanted;
  for (const auto& [left, right] : {std::make_pair("image_left", "image_right"),
                                    {"left", "right"},
                                    {"Left", "Right"},
                                    {"cam0", "cam1"},
                                    {"cam_0", "cam_1"},
                                    {"images_left", "images_right"},
                                    {"img_left", "img_right"},
                                    {"left_images", "right_images"},
                                    {"image_L", "image_R"},
                                    {"image0", "image1"},
                                    {"image_00", "image_01"},
                                    {"colored_0", "colored_1"},
                                    {"L", "R"}}) {
    if (has(left) && has(right)) {
      return std::string("if ") + left + " and " + right +
             " are the rectified images, rename them image_0 and image_1";
    }
  }
  if (has("image_0") || has("image_1")) {
    return std::string(has("image_0") ? "image_1 (right" : "image_0 (left") +
           " images) is not there";
  }
  return "";
}

}  // namespace

std::vector<UnreadFiles> FindUnreadFiles(const std::string& folder) {
  std::vector<UnreadFiles> unread;
  for (const ReadFolder& read : ReadFolders(folder)) FindInReadFolder(read, &unread);
  if (IsKittiTrackingSequence(folder)) return unread;  // its neighbours are other sequences
  if (IsEurocSequence(folder)) return unread;          // its neighbours are other sensors
  FindOtherFolders(folder, &unread);
  FindOtherFiles(folder, &unread);
  return unread;
}

std::string ExplainFolder(const std::string& folder) {
  const std::string none = "no known layout: ";
  const std::vector<std::string> below = SequencesBelow(folder);
  if (below.size() == 1) {
    return none + "the data set is the folder below it, " + folder + "/" + below[0];
  }
  if (!below.empty()) return none + ListOf(folder, below);
  const fs::path plain = fs::absolute(folder).lexically_normal() / ".";
  const fs::path parent = plain.parent_path().parent_path();
  if (plain.parent_path() != parent && HasSequenceLayout(parent.string())) {
    return none + "this is part of the data set " + parent.string() + "; use that";
  }
  const std::string other = ExplainOtherLayout(folder);
  if (!other.empty()) return none + other;
  return none +
         (HoldsImages(folder) ? "contains images, but these are expected in image_0 and image_1; "
                              : "") +
         "there is neither calib.txt (KITTI odometry) nor image_0 and image_1 (TartanAir-"
         "Shibuya), and it is not image_02/NNNN of KITTI tracking";
}

}  // namespace airdos
