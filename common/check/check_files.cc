#include "common/check/check_files.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "common/dataset/folder_survey.h"
#include "common/dataset/keypoint_file.h"

namespace airdos {

void ReportNotes(const StereoSequence& sequence, FindingList* findings) {
  for (const std::string& note : sequence.notes()) {
    const std::size_t end = std::min(note.find(": "), note.find(" is not there"));
    findings->Warn(kAssumedKind, end == std::string::npos ? "" : note.substr(0, end),
                   end == std::string::npos ? note : note.substr(end + (note[end] == ':' ? 2 : 1)));
  }
}

void ReportUnreadFiles(const std::string& folder, FindingList* findings) {
  for (const UnreadFiles& unread : FindUnreadFiles(folder)) {
    findings->Add(unread.is_error ? Severity::kError : Severity::kWarning, "folder.unread",
                  unread.where, unread.what);
  }
}

void ReportLayout(const StereoSequence& sequence, FindingList* findings) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
    paths.push_back(sequence.files(i).keypoints_left);
    paths.push_back(sequence.files(i).keypoints_right);
  }
  const std::optional<KeypointLayout> layout = FindLayout(paths);
  if (!layout) return;
  findings->Note("keypoints.read_as", std::filesystem::path(paths[0]).parent_path().string(),
                 "read as " + NameOf(*layout));
}

}  // namespace airdos
