#ifndef AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_
#define AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_

#include <string>
#include <vector>

namespace airdos {

/// Files that look like input, but that nobody reads.
struct UnreadFiles {
  std::string where;  ///< the folder or file
  std::string what;   ///< in words, with the remedy
  /// The data set has no file that is read in its place: a folder of ours holds nothing but other
  /// kinds of files.
  bool is_error = false;
};

/// Looks through a data set of known layout for what it holds and is not read: folders of people,
/// masks and images of other names (mask_0, keypoints_0, image_2), files of other kinds in the
/// folders of images and keypoints (OpenPose's and AlphaPose's .json, .npy), times, poses and
/// calibrations of other names. A folder that cannot be read holds nothing.
std::vector<UnreadFiles> FindUnreadFiles(const std::string& folder);

/// What a folder without known layout is, and the remedy: the data set or data sets in it (up to
/// two levels below), the data set that it lies in, another layout (EuRoC, KITTI raw, TartanAir,
/// ..) or which folders are missing. Without the folder's name.
std::string ExplainFolder(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_
