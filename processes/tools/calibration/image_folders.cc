#include "processes/tools/calibration/image_folders.h"

#include <numeric>
#include <opencv2/imgproc.hpp>

#include "common/util/error.h"

namespace airdos {
namespace {

cv::Mat Grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Times do not matter here.
FolderRecordingOptions OptionsOf(const std::string& left, const std::string& right) {
  return {left, right, "", 1.0};
}

}  // namespace

ImageFolders::ImageFolders(const std::string& left, const std::string& right)
    : recording_(std::make_unique<FolderRecording>(OptionsOf(left, right))) {}

std::optional<RawPair> ImageFolders::Read(std::size_t index) const {
  const std::optional<RecordedPair> pair = recording_->Load(index);
  if (!pair) return std::nullopt;
  return RawPair{Grey(pair->left), Grey(pair->right)};
}

std::vector<RawPair> ImageFolders::Sample(std::size_t count) const {
  std::vector<RawPair> pairs;
  for (const std::size_t index : SampleEvenly(size(), count)) {
    const std::optional<RawPair> pair = Read(index);
    if (pair) pairs.push_back(*pair);
  }
  if (pairs.empty()) throw InputError(recording_->name() + ": none of its pairs can be used");
  return pairs;
}

RectifiedFolders::RectifiedFolders(const ImageFolders& folders, const StereoRectifier& rectifier)
    : folders_(folders),
      rectifier_(rectifier),
      utimes_(folders.size()),
      ground_truth_(folders.size()) {
  std::iota(utimes_.begin(), utimes_.end(), 0);
}

std::vector<CheckedPictures> RectifiedFolders::Load(const std::vector<std::size_t>& frames,
                                                    FindingList* findings) const {
  std::vector<CheckedPictures> all;
  for (const std::size_t frame : frames) {
    CheckedPictures pictures;
    pictures.where_left = folders_.LeftPath(frame);
    pictures.where_right = folders_.RightPath(frame);
    const std::optional<RawPair> pair = folders_.Read(frame);
    if (pair) {
      pictures.left = rectifier_.Left(pair->left);
      pictures.right = rectifier_.Right(pair->right);
    } else {
      findings->Fail("images.unreadable", pictures.where_left, "this pair cannot be used");
    }
    all.push_back(pictures);
  }
  return all;
}

std::vector<StereoPeople> RectifiedFolders::LoadPeople(
    const std::vector<std::size_t>& frames) const {
  return std::vector<StereoPeople>(frames.size());
}

}  // namespace airdos
