#ifndef AIRDOS_COMMON_CHECK_FOLDER_H_
#define AIRDOS_COMMON_CHECK_FOLDER_H_

#include <string>

#include "common/check/check_input.h"

namespace airdos {

/// Checks the folder of a recorded sequence (stereo_sequence.h), using the same readers as the
/// player: what they refuse is an error that names file and line, and ends the check. Throws
/// InputError only if the folder does not exist or has no known layout.
void CheckFolder(const std::string& folder, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FOLDER_H_
