#include "common/check/check_folder.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "common/check/check_files.h"
#include "common/check/check_images.h"
#include "common/check/check_jpeg.h"
#include "common/check/check_people.h"
#include "common/dataset/image_file.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/mask_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

bool IsJpegName(const std::string& ending) {
  return ending == ".jpg" || ending == ".jpeg" || ending == ".JPG" || ending == ".JPEG";
}

std::string FirstOf(const std::string& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::exists(folder + "/" + name)) return folder + "/" + name;
  }
  return folder;
}

/// Reads the people in a file. What the reader refuses becomes a finding.
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

/// Does not throw: what `read` throws becomes a finding.
template <class Read>
auto ReadOrSay(const std::string& kind, const std::string& path, FindingList* findings, Read read)
    -> decltype(read()) {
  try {
    return read();
  } catch (const InputError& error) {
    findings->FailFrom(kind, error.what());
  } catch (const cv::Exception&) {  // a header that claims more pixels than OpenCV accepts
    findings->Fail(kind, path, "cannot be decoded as an image");
  }
  return {};
}

/// Reads a picture in grey, as the player passes it on; if it cannot be read, adds a finding and
/// returns an empty one.
cv::Mat ReadPicture(const std::string& path, const SixteenBitRange& range, FindingList* findings) {
  return ReadOrSay("images.file", path, findings, [&] {
    return DecodePicture(ReadBytes(path), path, PictureColor::kGrey, range).pixels;
  });
}

PersonMask ReadMask(const std::string& path, FindingList* findings) {
  return ReadOrSay("masks.file", path, findings, [&] {
    const std::vector<std::uint8_t> bytes = ReadBytes(path);
    return DecodePersonMask(bytes.data(), bytes.size(), path);
  });
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
      if (sequence_->has_camera_files()) {
        pictures.left = ReadPicture(files.left_image, range_, findings);
        pictures.right = ReadPicture(files.right_image, range_, findings);
      } else {
        LoadMade(frame, &pictures, findings);
      }
      if (fs::exists(files.person_mask)) pictures.mask = ReadMask(files.person_mask, findings);
      FindingList ignored;  // CheckKeypoints() has reported them
      pictures.people_left = ReadPeople(files.keypoints_left, &ignored);
      result.push_back(std::move(pictures));
    }
    return result;
  }

  std::vector<StereoPeople> LoadPeople(const std::vector<std::size_t>& frames) const override {
    std::vector<StereoPeople> result;
    FindingList ignored;  // CheckKeypoints() has reported them
    for (const std::size_t frame : frames) {
      const FrameFiles files = sequence_->files(frame);
      result.push_back({ReadPeople(files.keypoints_left, &ignored),
                        ReadPeople(files.keypoints_right, &ignored)});
    }
    return result;
  }

  const StereoSequence& sequence() const { return *sequence_; }
  /// Sets the range of 16-bit pictures; call it before loading them.
  void set_range(const SixteenBitRange& range) { range_ = range; }

 private:
  static cv::Mat GreyOf(const cv::Mat& pixels) {
    if (pixels.channels() == 1) return pixels;
    cv::Mat grey;
    cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
    return grey;
  }
  /// Images that are made from files.
  void LoadMade(std::size_t frame, CheckedPictures* pictures, FindingList* findings) const {
    ReadOrSay("images.file", pictures->where_left, findings, [&] {
      const SequenceFrame loaded = sequence_->Load(frame);
      pictures->left = GreyOf(loaded.left_pixels);
      pictures->right = GreyOf(loaded.right_pixels);
      return true;
    });
  }
  std::string folder_;
  std::unique_ptr<StereoSequence> sequence_;
  SixteenBitRange range_;
  std::vector<std::int64_t> utimes_;
  std::vector<std::optional<Se3>> ground_truth_;
};

/// There must be one file of people per image, or none at all.
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
    if (num_files == 0 && kind.path == &FrameFiles::person_mask &&
        !ListOtherMaskFiles(folder).empty()) {
      continue;  // CheckMaskFiles() reports it
    }
    if (num_files == 0) {
      findings->Note(std::string(kind.name) + ".count", folder, "none: there will be no people");
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

/// Checks for files of other formats in place of masks, and the headers of all masks.
void CheckMaskFiles(const StereoSequence& sequence, FindingList* findings) {
  const StereoCamera& camera = sequence.camera();
  const std::string folder = fs::path(sequence.files(0).person_mask).parent_path().string();
  std::set<std::string> unmasked;  // images without a mask in the format that is read
  for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
    const std::string path = sequence.files(i).person_mask;
    if (!fs::exists(path)) {
      unmasked.insert(fs::path(path).stem().string());
      continue;
    }
    ReadOrSay("masks.file", path, findings, [&] {
      const std::vector<std::uint8_t> bytes = ReadBytes(path);
      const std::string why = WhyNoMask(bytes.data(), bytes.size());
      if (!why.empty()) throw InputError(path + ": " + why);
      const ImageHeader header = *ReadImageHeader(bytes.data(), bytes.size());
      if (header.width != camera.width || header.height != camera.height) {
        findings->Fail("masks.size", path,
                       SizeMismatchText(header.width, header.height, "the images", camera.width,
                                        camera.height));
      }
      return true;
    });
  }
  const std::vector<std::string> others = ListOtherMaskFiles(folder);
  if (others.empty()) return;
  const bool are_needed = std::any_of(others.begin(), others.end(), [&](const std::string& name) {
    return unmasked.count(fs::path(name).stem().string()) > 0;
  });
  const std::string ending = fs::path(others[0]).extension().string();
  const bool all_other = unmasked.size() == sequence.num_frames();
  findings->Add(
      are_needed || all_other ? Severity::kError : Severity::kWarning, "masks.other_files", folder,
      "holds " + std::to_string(others.size()) + " files that are not .png (" + others[0] +
          (others.size() > 1 ? " ..." : "") + "), and masks are read from .png only; " +
          (IsJpegName(ending) ? "JPEG blurs the values of masks: " : "") +
          "save them as PNG, 0 for the background, or move them away");
}

void CheckCompression(const CheckedInput& input, const StereoSequence& sequence,
                      const CheckOptions& options, FindingList* findings) {
  for (const auto& path : {&FrameFiles::left_image, &FrameFiles::right_image}) {
    JpegCheck check;
    for (const std::size_t frame : SampleOfPictures(input.utimes().size(), options)) {
      ReadOrSay("images.file", sequence.files(frame).*path, findings, [&] {
        check.Add(ReadBytes(sequence.files(frame).*path));
        return true;
      });
    }
    check.Report(fs::path(sequence.files(0).*path).parent_path().string(), findings);
  }
}

void CheckKeypoints(const StereoSequence& sequence, const CheckOptions& options,
                    FindingList* findings) {
  if (!sequence.has_people()) return;
  for (const auto& path : {&FrameFiles::keypoints_left, &FrameFiles::keypoints_right}) {
    KeypointCheck check(sequence.camera());
    const std::size_t num_frames = sequence.num_frames();
    for (const std::size_t i : options.is_quick() ? SampleOfPeople(num_frames, options)
                                                  : SampleEvenly(num_frames, num_frames)) {
      check.Add(ReadPeople(sequence.files(i).*path, findings), findings);
    }
    check.Report(fs::path(sequence.files(0).*path).parent_path().string(), findings);
  }
}

/// Checks the headers of all images and determines the range of 16-bit ones.
void CheckImages(FolderInput* input, FindingList* findings) {
  const std::vector<SurveyedImage> images = SurveyImages(input->sequence());
  const bool has_sixteen_bits = std::any_of(
      images.begin(), images.end(),
      [](const SurveyedImage& image) { return image.header && image.header->bits == 16; });
  std::optional<SixteenBitRange> range;
  if (has_sixteen_bits) range = FindSixteenBitRange(input->sequence());
  if (range) input->set_range(*range);
  CheckImageFiles(images, input->camera(), range, findings);
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
    ReportUnreadFiles(folder, findings);  // these may be the cause
    return;
  }
  ReportNotes(*sequence, findings);
  ReportUnreadFiles(folder, findings);
  FolderInput input(folder, std::move(sequence));
  CheckCounts(input.sequence(), findings);
  ReportLayout(input.sequence(), findings);
  CheckImages(&input, findings);
  CheckMaskFiles(input.sequence(), findings);
  CheckKeypoints(input.sequence(), options, findings);
  if (!options.is_quick()) CheckCompression(input, input.sequence(), options, findings);
  CheckFrames(input, options, findings);
}

}  // namespace airdos
