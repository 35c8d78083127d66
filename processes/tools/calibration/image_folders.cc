#include "processes/tools/calibration/image_folders.h"

#include <filesystem>
#include <numeric>

#include "common/dataset/image_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"

namespace airdos {
namespace {

std::string PathOf(const ImageNames& names, std::size_t index) {
  return (std::filesystem::path(names.folder) / names.files.at(index)).string();
}

cv::Mat ReadGrey(const std::string& path) {
  return DecodePicture(ReadImageFile(path), path, PictureColor::kGrey, {}).pixels;
}

std::string SizeText(const cv::Mat& image) {
  return std::to_string(image.cols) + "x" + std::to_string(image.rows) + " px";
}

}  // namespace

ImageFolders::ImageFolders(const std::string& left, const std::string& right)
    : left_(ListImages(left)), right_(ListImages(right)) {
  CheckPairs(left_, right_);
}

std::string ImageFolders::LeftPath(std::size_t index) const { return PathOf(left_, index); }
std::string ImageFolders::RightPath(std::size_t index) const { return PathOf(right_, index); }

RawPair ImageFolders::Read(std::size_t index) const {
  RawPair pair = {ReadGrey(LeftPath(index)), ReadGrey(RightPath(index))};
  if (pair.left.size() != pair.right.size()) {
    throw InputError(RightPath(index) + ": has " + SizeText(pair.right) + ", the left image " +
                     SizeText(pair.left));
  }
  return pair;
}

std::vector<RawPair> ImageFolders::Sample(std::size_t count) const {
  std::vector<RawPair> pairs;
  for (const std::size_t index : SampleEvenly(size(), count)) {
    pairs.push_back(Read(index));
    if (pairs.back().left.size() != pairs.front().left.size()) {
      throw InputError(LeftPath(index) + ": has " + SizeText(pairs.back().left) +
                       ", the first image " + SizeText(pairs.front().left));
    }
  }
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
    try {
      const RawPair pair = folders_.Read(frame);
      pictures.left = rectifier_.Left(pair.left);
      pictures.right = rectifier_.Right(pair.right);
    } catch (const InputError& error) {
      findings->FailFrom("images.unreadable", error.what());
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
