#ifndef AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_
#define AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_

#include <string>
#include <vector>

namespace airdos {

/// Files that look like input but are not read.
struct UnreadFiles {
  std::string where;  ///< the folder or file
  std::string what;   ///< a description, with the remedy
  /// Whether the data set lacks the files that should be there instead: one of its folders holds
  /// nothing but files of other formats.
  bool is_error = false;
};

/// Searches a data set of known layout for files that are not read: folders of people, masks and
/// images with other names (mask_0, keypoints_0, image_2), other formats in the folders of images
/// and keypoints (.json of OpenPose and AlphaPose, .npy), and times, poses and calibrations with
/// other names. Folders that cannot be read are treated as empty.
std::vector<UnreadFiles> FindUnreadFiles(const std::string& folder);

/// Explains a folder whose layout is unknown, with the remedy: data sets inside it (up to two
/// levels down), the data set that it is part of, another layout (EuRoC, KITTI raw, TartanAir,
/// ...), or the folders that are missing. The text does not repeat the folder's name.
std::string ExplainFolder(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FOLDER_SURVEY_H_
