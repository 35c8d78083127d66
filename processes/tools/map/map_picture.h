#ifndef AIRDOS_PROCESSES_TOOLS_MAP_MAP_PICTURE_H_
#define AIRDOS_PROCESSES_TOOLS_MAP_MAP_PICTURE_H_

#include <opencv2/core.hpp>
#include <string>

#include "common/map/four_d_map.h"

namespace airdos {

/// Draws the map from above (x right, z forward of the first camera, m): static points near the
/// camera's path, the path itself, and the path of each person seen often enough, each in its own
/// colour. 8-bit BGR.
cv::Mat DrawMap(const FourDMap& map);

/// Throws InputError if the file cannot be written.
void WriteMapPicture(const FourDMap& map, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_MAP_MAP_PICTURE_H_
