#ifndef AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_
#define AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/dataset/image_names.h"

namespace airdos {

/// Which row of a file that has one row an image, but no times, belongs to each image. As many rows
/// as images: one after the other. More: by the number in the names, the first row being number 0,
/// or number 1 where only that fits; what was assumed goes to `notes`.
///
/// `what` says what a row holds ("times"). Throws InputError with both counts and the first image
/// concerned where neither fits, and where there are fewer rows than images.
std::vector<std::size_t> RowsOfImages(const std::string& path, const std::string& what,
                                      std::size_t num_rows, const ImageNames& images,
                                      std::vector<std::string>* notes);

/// "5 is missing" or "5 and 3 more are missing" where whole numbers have gaps; else empty.
std::string GapsOf(const std::vector<std::uint64_t>& numbers);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_ROWS_H_
