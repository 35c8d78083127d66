#include "processes/node/live/recording_cli.h"

#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/video_recording.h"
#include "common/util/error.h"

namespace airdos {

void RecordingArguments::AddTo(CommandLine* line) {
  line->Add(
          "--images", &images_,
          "in place of INPUT: folders of the left and the right images as recorded; or one folder "
          "with both, by _l and _r or left and right in the names")
      .ShownAs("LEFT [RIGHT]")
      .Words(1, 2);
  line->Add("--video", &video_,
            "in place of INPUT: videos of the left and the right camera, or one")
      .ShownAs("LEFT [RIGHT]")
      .Words(1, 2)
      .Excludes("--images");
  line->AddFlag("--side-by-side", &is_side_by_side_,
                "the one video has the left image on the left, the right one on the right");
  line->AddFlag("--over-under", &is_over_under_,
                "the one video has the left image on top, the right one below");
  line->AddFile("--times", &times_,
                "times of the images, one a line, in s, ms, us or ns; the names of the images may "
                "stand beside them");
  line->Add("--rate", &rate_hz_, "images a second, where they have no times").ShownAs("HZ");
  calibration_.AddTo("--calibration", line,
                     std::string("; of INPUT without one, by name: ") + kPublicCalibration +
                         " is that of the public set");
}

void RecordingArguments::Settle(InputOptions* input) {
  if (!is_given()) {
    const std::vector<std::string>& words = calibration_.paths();
    if (words.size() == 2 && !input->is_given()) {
      input->Give(words[1]);
    } else if (words.size() == 2) {
      throw InputError("--calibration " + words[0] + " " + words[1] +
                       ": of a data set or log there is one name at most; calibration files go "
                       "with --images or --video");
    }
    if (!words.empty()) named_calibration_ = words[0];
    RefuseWithoutRecording();
    return;
  }
  if (input->is_given()) {
    throw InputError("only one input is possible: '" + input->path() + "' or '" + name() + "'");
  }
  RefuseContradictions();
  if (!calibration_.is_given()) {
    throw InputError(std::string(images_.empty() ? "--video" : "--images") +
                     ": the calibration is missing: --calibration FILE (airdos-calibration show "
                     "FILE tells what it says)");
  }
}

void RecordingArguments::RefuseWithoutRecording() const {
  const std::string option = is_side_by_side_  ? "--side-by-side"
                             : is_over_under_  ? "--over-under"
                             : !times_.empty() ? "--times"
                             : rate_hz_        ? "--rate"
                                               : "";
  if (option.empty()) return;
  throw InputError(option + ": is for recordings, given by --images or --video" +
                   (option == "--rate" ? " (the speed of --pace realtime is --speed)" : ""));
}

void RecordingArguments::RefuseContradictions() const {
  const bool is_one_video = is_side_by_side_ || is_over_under_;
  if (is_side_by_side_ && is_over_under_) {
    throw InputError("--side-by-side and --over-under exclude each other");
  }
  if (!images_.empty() && is_one_video) {
    throw InputError("--side-by-side and --over-under are for --video");
  }
  if (video_.size() == 2 && is_one_video) {
    throw InputError("--side-by-side and --over-under are for one video, there are two: '" +
                     video_[0] + "' and '" + video_[1] + "'");
  }
  if (video_.size() == 1 && !is_one_video) {
    throw InputError(
        video_[0] + ": one video: where are the two images in it, --side-by-side or --over-under?");
  }
  if (!video_.empty() && !times_.empty()) {
    throw InputError("--times is for --images; a video has its own, or --rate");
  }
  if (!times_.empty() && rate_hz_) throw InputError("--times and --rate exclude each other");
  if (rate_hz_ && !(*rate_hz_ >= 0.01 && *rate_hz_ <= 10000)) {
    throw InputError("--rate: must lie between 0.01 and 10000 images a second");
  }
}

std::unique_ptr<StereoRecording> RecordingArguments::OpenRecording() const {
  if (!images_.empty()) {
    return std::make_unique<FolderRecording>(FolderRecordingOptions{
        images_[0], images_.size() == 2 ? images_[1] : "", times_, rate_hz_});
  }
  const VideoLayout layout = is_side_by_side_ ? VideoLayout::kSideBySide
                             : is_over_under_ ? VideoLayout::kOverUnder
                                              : VideoLayout::kTwoVideos;
  return std::make_unique<VideoRecording>(
      VideoRecordingOptions{video_[0], video_.size() == 2 ? video_[1] : "", layout, rate_hz_});
}

std::unique_ptr<RectifiedSequence> RecordingArguments::Open() const {
  std::unique_ptr<StereoRecording> recording = OpenRecording();
  const StereoRig rig = calibration_.Read(recording->image_size());
  return std::make_unique<RectifiedSequence>(std::move(recording), rig,
                                             calibration_.rectifier_options());
}

std::string RecordingArguments::name() const { return images_.empty() ? video_[0] : images_[0]; }

std::string RecordingArguments::HowToExamine() const {
  const std::string images =
      images_.size() == 2 ? images_[0] + " " + images_[1] : std::string("LEFT RIGHT");
  std::string files;
  for (const std::string& path : calibration_.paths()) files += path + " ";
  return "the calibration does not fit them, look at it with airdos-calibration check " + files +
         "--images " + images;
}

std::vector<std::string> RecordingArguments::paths() const {
  std::vector<std::string> all = images_.empty() ? video_ : images_;
  all.insert(all.end(), calibration_.paths().begin(), calibration_.paths().end());
  if (!times_.empty()) all.push_back(times_);
  return all;
}

}  // namespace airdos
