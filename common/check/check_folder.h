#ifndef AIRDOS_COMMON_CHECK_FOLDER_H_
#define AIRDOS_COMMON_CHECK_FOLDER_H_

#include <string>

#include "common/check/check_input.h"

namespace airdos {

/// Checks a folder of a recorded sequence (stereo_sequence.h), with the readers that the player
/// uses: what they refuse is an error that names file and line, and ends the check. Throws
/// InputError only where the folder is none or has no known layout.
void CheckFolder(const std::string& folder, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FOLDER_H_
