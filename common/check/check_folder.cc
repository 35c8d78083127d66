#include "common/check/check_folder.h"

#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "common/check/check_files.h"
#include "common/check/check_jpeg.h"
#include "common/check/check_people.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::string FirstOf(const std::string& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::exists(folder + "/" + name)) return folder + "/" + name;
  }
  return folder;
}

/// People as a file has them. What the reader refuses is a finding.
CheckedPeople ReadPeople(const std::string& path, FindingList* findings) {
  CheckedPeople result;
  result.where = path;
  KeypointFile file;
  try {
    file = ReadRawKeypoints(path);
  } catch (const InputError& error) {
    findings->FailFrom("keypoints.file", error.what());
  }
  if (file.layout) result.layout = *file.layout;
  for (const PersonKeypoints& person : file.people) {
    std::vector<BodyKeypoint> joints;
    for (const Keypoint& point : person) {
      joints.push_back({point.u_px, point.v_px, point.confidence});
    }
    result.people.push_back(std::move(joints));
  }
  return result;
}

/// An 8-bit picture in grey as the file has it; empty, and a finding, where it cannot be read.
cv::Mat ReadPicture(const std::string& path, const std::string& kind, FindingList* findings) {
  try {
    cv::Mat picture = cv::imdecode(ReadImageFile(path), cv::IMREAD_GRAYSCALE);
    if (!picture.empty()) return picture;
    findings->Fail(kind, path, "cannot be decoded as an image");
  } catch (const InputError& error) {
    findings->FailFrom(kind, error.what());
  } catch (const cv::Exception&) {  // a header that promises more pixels than OpenCV wants to hold
    findings->Fail(kind, path, "cannot be decoded as an image");
  }
  return {};
}

class FolderInput : public CheckedInput {
 public:
  FolderInput(std::string folder, std::unique_ptr<StereoSequence> sequence)
      : folder_(std::move(folder)), sequence_(std::move(sequence)) {
    for (std::size_t i = 0; i < sequence_->num_frames(); ++i) {
      utimes_.push_back(sequence_->utime(i));
      ground_truth_.push_back(sequence_->ground_truth(i));
    }
  }

  std::string name() const override { return folder_; }
  const StereoCamera& camera() const override { return sequence_->camera(); }
  std::string where_camera() const override {
    return FirstOf(folder_, {"calib.json", "calib.txt"});
  }
  const std::vector<std::int64_t>& utimes() const override { return utimes_; }
  std::string where_times() const override { return FirstOf(folder_, {"times.txt"}); }
  const std::vector<std::optional<Se3>>& ground_truth() const override { return ground_truth_; }
  TrajectoryAxes ground_truth_axes() const override { return sequence_->ground_truth_axes(); }
  std::string where_ground_truth() const override {
    return FirstOf(folder_, {"gt_pose.txt", "poses.txt"});
  }

  std::vector<CheckedPictures> Load(const std::vector<std::size_t>& frames,
                                    FindingList* findings) const override {
    std::vector<CheckedPictures> result;
    for (const std::size_t frame : frames) {
      const FrameFiles files = sequence_->files(frame);
      CheckedPictures pictures;
      pictures.where_left = files.left_image;
      pictures.where_right = files.right_image;
      pictures.where_mask = files.person_mask;
      pictures.left = ReadPicture(files.left_image, "images.file", findings);
      pictures.right = ReadPicture(files.right_image, "images.file", findings);
      if (fs::exists(files.person_mask)) {
        pictures.mask = ReadPicture(files.person_mask, "masks.file", findings);
      }
      FindingList ignored;  // CheckKeypoints() has said it
      pictures.people_left = ReadPeople(files.keypoints_left, &ignored);
      result.push_back(std::move(pictures));
    }
    return result;
  }

  const StereoSequence& sequence() const { return *sequence_; }

 private:
  std::string folder_;
  std::unique_ptr<StereoSequence> sequence_;
  std::vector<std::int64_t> utimes_;
  std::vector<std::optional<Se3>> ground_truth_;
};

/// Files of people come one an image, or not at all.
void CheckCounts(const StereoSequence& sequence, FindingList* findings) {
  struct Kind {
    const char* name;
    std::string FrameFiles::*path;
  };
  for (const Kind& kind :
       {Kind{"keypoints", &FrameFiles::keypoints_left},
        Kind{"keypoints", &FrameFiles::keypoints_right}, Kind{"masks", &FrameFiles::person_mask}}) {
    const fs::path first = sequence.files(0).*kind.path;
    const std::string folder = first.parent_path().string();
    std::size_t num_used = 0;
    std::string missing;
    for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
      const std::string path = sequence.files(i).*kind.path;
      if (fs::exists(path)) {
        ++num_used;
      } else if (missing.empty()) {
        missing = path;
      }
    }
    std::size_t num_files = 0;
    if (fs::is_directory(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) {
        num_files += entry.path().extension() == first.extension() ? 1 : 0;
      }
    }
    const std::string count = std::to_string(num_used) + " of " +
                              std::to_string(sequence.num_frames()) + " images have " + kind.name;
    if (num_files == 0) {
      findings->Note(std::string(kind.name) + ".count", folder, "none: nobody will be known");
    } else if (num_used == 0) {
      findings->Fail(std::string(kind.name) + ".count", folder,
                     "none of its files has the name of an image");
    } else if (num_used < sequence.num_frames()) {
      findings->Warn(std::string(kind.name) + ".count", missing, "is not there: " + count);
    } else if (num_files > num_used) {
      findings->Warn(std::string(kind.name) + ".count", folder,
                     "holds " + std::to_string(num_files) + " files for " +
                         std::to_string(sequence.num_frames()) + " images");
    }
  }
}

void CheckCompression(const CheckedInput& input, const StereoSequence& sequence,
                      std::size_t max_frames, FindingList* findings) {
  for (const auto& path : {&FrameFiles::left_image, &FrameFiles::right_image}) {
    JpegCheck check;
    for (const std::size_t frame : SampleEvenly(input.utimes().size(), max_frames)) {
      check.Add(ReadBytes(sequence.files(frame).*path));
    }
    check.Report(fs::path(sequence.files(0).*path).parent_path().string(), findings);
  }
}

void CheckKeypoints(const StereoSequence& sequence, FindingList* findings) {
  if (!sequence.has_people()) return;
  for (const auto& path : {&FrameFiles::keypoints_left, &FrameFiles::keypoints_right}) {
    KeypointCheck check(sequence.camera());
    for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
      check.Add(ReadPeople(sequence.files(i).*path, findings), findings);
    }
    check.Report(fs::path(sequence.files(0).*path).parent_path().string(), findings);
  }
}

}  // namespace

void CheckFolder(const std::string& folder, const CheckOptions& options, FindingList* findings) {
  std::unique_ptr<StereoSequence> sequence;
  const bool is_sequence = fs::is_directory(folder + "/image_0") ||
                           fs::is_directory(folder + "/image_l") ||
                           fs::exists(folder + "/calib.txt");
  try {
    sequence = OpenStereoSequence(folder, {options.calibration});
  } catch (const InputError& error) {
    if (!is_sequence) throw;
    findings->FailFrom("folder", error.what());
    ReportUnreadFiles(folder, findings);  // they may be the cause
    return;
  }
  ReportNotes(*sequence, findings);
  ReportUnreadFiles(folder, findings);
  const FolderInput input(folder, std::move(sequence));
  CheckCounts(input.sequence(), findings);
  ReportLayout(input.sequence(), findings);
  CheckKeypoints(input.sequence(), findings);
  CheckCompression(input, input.sequence(), options.max_frames, findings);
  CheckFrames(input, options, findings);
}

}  // namespace airdos
