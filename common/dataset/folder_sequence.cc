#include "common/dataset/folder_sequence.h"

#include <algorithm>
#include <filesystem>

#include "common/dataset/image_rows.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/mask_file.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/times_file.h"
#include "common/util/check.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kAssumedPeriodUs = 100000;  // both public data sets have 10 Hz

/// The usual step between consecutive numbers: 5 if every fifth image was kept.
std::uint64_t UsualStep(const std::vector<std::uint64_t>& numbers) {
  std::vector<std::uint64_t> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) steps.push_back(numbers[i] - numbers[i - 1]);
  if (steps.empty()) return 1;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// 10 Hz; a missing image leaves a gap, unless that would be years long.
void AssumeTimes(const std::string& path, FolderSequence::Contents* contents) {
  const std::vector<std::uint64_t>& numbers = contents->left.numbers;
  const std::uint64_t step = UsualStep(numbers);
  constexpr std::uint64_t kMaxSteps = 1000000;
  const bool are_counts =
      !numbers.empty() && (numbers.back() - numbers.front()) / step <= kMaxSteps;
  bool has_gaps = false;
  for (std::size_t i = 0; i < contents->left.files.size(); ++i) {
    const auto in_order = static_cast<std::int64_t>(i) * kAssumedPeriodUs;
    const std::int64_t by_number = are_counts
                                       ? static_cast<std::int64_t>(numbers[i] - numbers[0]) *
                                             kAssumedPeriodUs / static_cast<std::int64_t>(step)
                                       : in_order;
    has_gaps = has_gaps || by_number != in_order;
    contents->utimes.push_back(by_number);
  }
  contents->notes.push_back(path + " is not there: the images are assumed to be 0.1 s apart" +
                            (has_gaps ? ", more where numbers are missing" : ""));
}

void FillTimes(FolderSequence::Contents* contents) {
  const std::string path = contents->folder + "/times.txt";
  if (fs::exists(path)) {
    const std::vector<std::int64_t> utimes = ReadTimes(path);
    for (const std::size_t row :
         RowsOfImages(path, "times", utimes.size(), contents->left, &contents->notes)) {
      contents->utimes.push_back(utimes[row]);
    }
    return;
  }
  const std::optional<NamedTimes> named = TimesFromNames(contents->left);
  if (!named) return AssumeTimes(path, contents);
  contents->utimes = named->utimes;
  contents->notes.push_back(path + " is not there: the times are those in the images' names, in " +
                            named->unit);
}

/// Refuses a mask of another format in place of `png`, so that it is not silently ignored.
void RefuseOtherMask(const std::string& png) {
  for (const char* ending : {".jpg", ".jpeg", ".JPG", ".PNG", ".npy", ".npz", ".bmp", ".tif",
                             ".tiff", ".gif", ".webp", ".pgm", ".exr"}) {
    const std::string other = fs::path(png).replace_extension(ending).string();
    if (!fs::exists(other)) continue;
    throw InputError(other + ": masks are read from .png only, so this one would be ignored; " +
                     (std::string(ending).find("j") == 1 || std::string(ending) == ".JPG"
                          ? "JPEG blurs their values: "
                          : "") +
                     "save them as PNG, 0 for the background, or move the folder away");
  }
}

}  // namespace

FolderSequence::FolderSequence(Contents contents) : contents_(std::move(contents)) {
  const std::size_t num_images = contents_.left.files.size();
  AIRDOS_CHECK(num_images == contents_.right.files.size());
  AIRDOS_CHECK(num_images == contents_.utimes.size());
  contents_.ground_truth.resize(num_images);

  const std::vector<std::string> masks = PeopleFiles("rcnnseg_image_0", ".png");
  const std::vector<std::string> left = PeopleFiles("alphapose_0", ".txt");
  const std::vector<std::string> right = PeopleFiles("alphapose_1", ".txt");
  for (std::size_t i = 0; i < num_images; ++i) {
    files_.push_back({contents_.left.folder + "/" + contents_.left.files[i],
                      contents_.right.folder + "/" + contents_.right.files[i], masks[i], left[i],
                      right[i]});
  }
  has_people_ = fs::is_directory(fs::path(left[0]).parent_path());
  std::vector<std::string> keypoints = left;
  keypoints.insert(keypoints.end(), right.begin(), right.end());
  keypoint_layout_ = FindLayout(keypoints).value_or(KeypointLayout::kCoco18);
}

/// One name per image; if there is no such file, the name that it would have.
std::vector<std::string> FolderSequence::PeopleFiles(const std::string& name,
                                                     const std::string& ending) const {
  std::string folder = contents_.folder + "/" + name;
  if (!contents_.people_subfolder.empty()) folder += "/" + contents_.people_subfolder;
  std::vector<std::string> files = FindPartners(folder, ending, contents_.left, contents_.right);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].empty()) files[i] = fs::path(contents_.left.files[i]).stem().string() + ending;
    files[i] = folder + "/" + files[i];
  }
  return files;
}

FrameFiles FolderSequence::files(std::size_t index) const {
  AIRDOS_CHECK(index < num_frames());
  return files_[index];
}

SequenceFrame FolderSequence::Load(std::size_t index) const {
  const FrameFiles& names = files_[index];
  SequenceFrame frame;
  frame.utime = contents_.utimes[index];
  frame.left_image_file = ReadImageFile(names.left_image);
  frame.right_image_file = ReadImageFile(names.right_image);
  if (fs::exists(names.person_mask)) {
    frame.person_mask_file = ReadMaskFile(names.person_mask, camera().width, camera().height);
  } else {
    RefuseOtherMask(names.person_mask);
  }
  frame.keypoint_layout = keypoint_layout_;
  const auto read_people = [&](const std::string& path) {
    KeypointFile file = ReadKeypoints(path);
    if (file.layout && file.layout != keypoint_layout_) {  // the files have changed since
      throw InputError(path + ": holds people in " + NameOf(*file.layout) + ", others are in " +
                       NameOf(keypoint_layout_));
    }
    return std::move(file.people);
  };
  frame.keypoints_left = read_people(names.keypoints_left);
  frame.keypoints_right = read_people(names.keypoints_right);
  frame.ground_truth = contents_.ground_truth[index];
  return frame;
}

void FillImagesAndTimes(FolderSequence::Contents* contents) {
  contents->left = ListImages(contents->folder + "/" + contents->left_folder);
  contents->right = ListImages(contents->folder + "/" + contents->right_folder);
  CheckPairs(contents->left, contents->right);
  for (const ImageNames* names : {&contents->left, &contents->right}) {
    contents->notes.insert(contents->notes.end(), names->notes.begin(), names->notes.end());
  }
  FillTimes(contents);
}

void FillPosesByRow(const std::string& path, const std::string& what, const std::vector<Se3>& poses,
                    FolderSequence::Contents* contents) {
  contents->ground_truth.clear();
  for (const std::size_t row :
       RowsOfImages(path, what, poses.size(), contents->left, &contents->notes)) {
    contents->ground_truth.emplace_back(poses[row]);
  }
}

}  // namespace airdos
