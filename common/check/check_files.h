#ifndef AIRDOS_COMMON_CHECK_FILES_H_
#define AIRDOS_COMMON_CHECK_FILES_H_

#include <string>

#include "common/check/check_findings.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// What the reader assumed about a folder (StereoSequence::notes()), as warnings of this kind.
inline constexpr char kAssumedKind[] = "folder.assumed";
void ReportNotes(const StereoSequence& sequence, FindingList* findings);

/// Reports files in a folder that look like input but are not read (folder_survey.h), with kind
/// "folder.unread".
void ReportUnreadFiles(const std::string& folder, FindingList* findings);

/// Reports the joint order with which keypoints are read.
void ReportLayout(const StereoSequence& sequence, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_FILES_H_
