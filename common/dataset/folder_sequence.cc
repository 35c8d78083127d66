#include "common/dataset/folder_sequence.h"

#include <filesystem>

#include "common/dataset/mask_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/check.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kAssumedPeriodUs = 100000;  // both public sets run at 10 Hz

void CheckSameNames(const FolderSequence::Contents& contents) {
  const std::string left = contents.folder + "/" + contents.left_folder;
  const std::string right = contents.folder + "/" + contents.right_folder;
  if (contents.left_names.empty()) throw InputError(left + ": holds no .png or .jpg image");
  if (contents.left_names.size() != contents.right_names.size()) {
    throw InputError(right + ": holds " + std::to_string(contents.right_names.size()) +
                     " images, but " + left + " holds " +
                     std::to_string(contents.left_names.size()));
  }
  for (std::size_t i = 0; i < contents.left_names.size(); ++i) {
    if (fs::path(contents.left_names[i]).stem() != fs::path(contents.right_names[i]).stem()) {
      throw InputError(left + "/" + contents.left_names[i] + ": has no partner in " + right);
    }
  }
}

/// A mask of another kind in the place of `png` must not be passed over in silence.
void RefuseOtherMask(const std::string& png) {
  for (const char* ending : {".jpg", ".jpeg", ".JPG", ".PNG", ".npy", ".npz", ".bmp", ".tif",
                             ".tiff", ".gif", ".webp", ".pgm", ".exr"}) {
    const std::string other = fs::path(png).replace_extension(ending).string();
    if (!fs::exists(other)) continue;
    throw InputError(other + ": masks are read as .png only, this one would be passed over; " +
                     (std::string(ending).find("j") == 1 || std::string(ending) == ".JPG"
                          ? "JPEG smears their numbers: "
                          : "") +
                     "save them as PNG, 0 for the background, or move the folder away");
  }
}

}  // namespace

FolderSequence::FolderSequence(Contents contents)
    : contents_(std::move(contents)), has_people_(fs::is_directory(PeopleFolder("alphapose_0"))) {
  AIRDOS_CHECK(contents_.left_names.size() == contents_.right_names.size());
  AIRDOS_CHECK(contents_.left_names.size() == contents_.utimes.size());
  contents_.ground_truth.resize(contents_.left_names.size());
}

std::string FolderSequence::PeopleFolder(const std::string& name) const {
  const std::string folder = contents_.folder + "/" + name;
  return contents_.people_subfolder.empty() ? folder : folder + "/" + contents_.people_subfolder;
}

FrameFiles FolderSequence::files(std::size_t index) const {
  AIRDOS_CHECK(index < num_frames());
  const std::string& folder = contents_.folder;
  const std::string stem = fs::path(contents_.left_names[index]).stem().string();
  FrameFiles files;
  files.left_image = folder + "/" + contents_.left_folder + "/" + contents_.left_names[index];
  files.right_image = folder + "/" + contents_.right_folder + "/" + contents_.right_names[index];
  files.person_mask = PeopleFolder("rcnnseg_image_0") + "/" + stem + ".png";
  files.keypoints_left = PeopleFolder("alphapose_0") + "/" + stem + ".txt";
  files.keypoints_right = PeopleFolder("alphapose_1") + "/" + stem + ".txt";
  return files;
}

SequenceFrame FolderSequence::Load(std::size_t index) const {
  const FrameFiles names = files(index);
  SequenceFrame frame;
  frame.utime = contents_.utimes[index];
  frame.left_image_file = ReadImageFile(names.left_image);
  frame.right_image_file = ReadImageFile(names.right_image);
  if (fs::exists(names.person_mask)) {
    frame.person_mask_file = ReadMaskFile(names.person_mask, camera().width, camera().height);
  } else {
    RefuseOtherMask(names.person_mask);
  }
  frame.keypoints_left = ReadKeypoints(names.keypoints_left);
  frame.keypoints_right = ReadKeypoints(names.keypoints_right);
  frame.ground_truth = contents_.ground_truth[index];
  return frame;
}

void FillImagesAndTimes(FolderSequence::Contents* contents) {
  contents->left_names = ListImages(contents->folder + "/" + contents->left_folder);
  contents->right_names = ListImages(contents->folder + "/" + contents->right_folder);
  CheckSameNames(*contents);

  const std::size_t num_images = contents->left_names.size();
  const std::string path = contents->folder + "/times.txt";
  if (!fs::exists(path)) {
    contents->notes.push_back(path + " is not there: the images are taken to be 0.1 s apart");
    for (std::size_t i = 0; i < num_images; ++i) {
      contents->utimes.push_back(static_cast<std::int64_t>(i) * kAssumedPeriodUs);
    }
    return;
  }
  contents->utimes = ReadTimes(path);
  const std::string counts = path + ": holds " + std::to_string(contents->utimes.size()) +
                             " times for " + std::to_string(num_images) + " images";
  if (contents->utimes.size() < num_images) throw InputError(counts);
  if (contents->utimes.size() > num_images) {
    contents->notes.push_back(counts + ": the last ones are not used");
    contents->utimes.resize(num_images);
  }
}

}  // namespace airdos
