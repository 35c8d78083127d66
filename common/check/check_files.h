#ifndef AIRDOS_COMMON_CHECK_FILES_H_
#define AIRDOS_COMMON_CHECK_FILES_H_

#include <string>

#include "common/check/check_findings.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// What the reader assumed of a folder (StereoSequence::notes()), as warnings of this kind.
inline constexpr char kAssumedKind[] = "folder.assumed";
void ReportNotes(const StereoSequence& sequence, FindingList* findings);

/// What lies in a folder like input and is not read (folder_survey.h), kind "folder.unread".
void ReportUnreadFiles(const std::string& folder, FindingList* findings);

/// The order of joints that keypoints are read in.
void ReportLayout(const StereoSequence& sequence, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FILES_H_
