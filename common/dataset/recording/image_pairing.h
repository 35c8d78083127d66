#ifndef AIRDOS_COMMON_DATASET_RECORDING_IMAGE_PAIRING_H_
#define AIRDOS_COMMON_DATASET_RECORDING_IMAGE_PAIRING_H_

#include <string>
#include <vector>

#include "common/dataset/image_names.h"

namespace airdos {

/// The images of both cameras; element i of one belongs to element i of the other.
struct PairedImages {
  ImageNames left;
  ImageNames right;
  std::vector<std::string> notes;
};

/// Pairs images by the number in their names; where these are times of each camera's own, with the
/// nearest one up to a quarter of the usual step away. Never by rank, but for a single image each.
/// Images without partner are left out, with a note. Throws InputError where half of the images or
/// more have none.
PairedImages PairImages(const ImageNames& left, const ImageNames& right);

/// The images of one folder that holds both cameras': names with left and right, or l and r, as a
/// word ("frame-left-0001", "left12", "000003_l"), in any case. Throws InputError where a name has
/// neither or both.
void SplitFolder(const std::string& folder, ImageNames* left, ImageNames* right);

/// The folder itself if it holds images, else its folder "data" (EuRoC, KITTI raw) if that does.
/// Throws InputError that names the folders below it that hold images, if it is neither.
std::string FolderOfImages(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_IMAGE_PAIRING_H_
