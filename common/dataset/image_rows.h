#ifndef AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_
#define AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/dataset/image_names.h"

namespace airdos {

/// For each image, its row in a file that has one row per image but no times. With as many rows as
/// images, in order. With more rows, by the number in the image's name, where the first row is
/// number 0, or number 1 if only that fits; the assumption is added to `notes`.
///
/// `what` names the content of a row ("times"). Throws InputError with both counts and the first
/// image concerned if neither fits, or if there are fewer rows than images.
std::vector<std::size_t> RowsOfImages(const std::string& path, const std::string& what,
                                      std::size_t num_rows, const ImageNames& images,
                                      std::vector<std::string>* notes);

/// "5 is missing" or "5 and 3 more are missing" if integer numbers have gaps; otherwise empty.
std::string GapsOf(const std::vector<std::uint64_t>& numbers);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_
