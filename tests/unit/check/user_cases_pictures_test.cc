// What users' pictures, masks and keypoints are like, and what the check and the readers say.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "common/check/check_folder.h"
#include "common/dataset/image_file.h"
#include "common/dataset/mask_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

SmallSequence Sound() {
  static const SmallSequence rendered = SmallSequence::Make();
  SmallSequence sequence = rendered;
  for (auto* pictures : {&sequence.left, &sequence.right, &sequence.masks}) {
    for (cv::Mat& picture : *pictures) picture = picture.clone();
  }
  return sequence;
}

Bytes Png(const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(".png", image, bytes);
  return bytes;
}

PersonMask Decode(const Bytes& bytes) { return DecodePersonMask(bytes.data(), bytes.size(), "f"); }

std::string Refusal(const Bytes& bytes) {
  try {
    Decode(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The APP1 block of a camera that was held otherwise.
Bytes WithOrientation(const Bytes& jpeg, std::uint8_t wish) {
  const Bytes exif = {0xFF, 0xE1, 0, 34,   'E', 'x', 'i', 'f', 0, 0, 'M', 'M',  0, '*', 0, 0, 0, 8,
                      0,    1,    1, 0x12, 0,   3,   0,   0,   0, 1, 0,   wish, 0, 0,   0, 0, 0, 0};
  Bytes result(jpeg.begin(), jpeg.begin() + 2);
  result.insert(result.end(), exif.begin(), exif.end());
  result.insert(result.end(), jpeg.begin() + 2, jpeg.end());
  return result;
}

void WriteBytes(const fs::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

class UserCases : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_user_pictures_" + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Check(CheckOptions::Depth depth = CheckOptions::Depth::kFull) {
    CheckOptions options;
    options.max_frames = 5;
    options.odometry_frames = 0;
    options.depth = depth;
    findings_ = FindingList();
    CheckFolder(folder_.string(), options, &findings_);
    std::ostringstream text;
    findings_.Print(folder_.string(), &text);
    return text.str();
  }
  /// In both depths there is a finding of this kind and severity whose place and words hold these
  /// texts, and no error of another kind.
  void Expect(Severity severity, const std::string& kind, const std::string& place,
              const std::string& words) {
    for (const auto depth : {CheckOptions::Depth::kFull, CheckOptions::Depth::kQuick}) {
      const std::string text = Check(depth);
      const auto& all = findings_.findings();
      EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                              [&](const Finding& finding) {
                                return finding.severity == severity && finding.kind == kind &&
                                       finding.where.find(place) != std::string::npos &&
                                       finding.what.find(words) != std::string::npos;
                              }))
          << kind << "\n"
          << text;
      for (const Finding& finding : all) {
        EXPECT_TRUE(finding.severity != Severity::kError || finding.kind == kind) << text;
      }
      EXPECT_EQ(findings_.has_errors(), severity == Severity::kError) << text;
    }
  }
  fs::path Mask(int i) const { return folder_ / "rcnnseg_image_0" / Number(i, ".png"); }
  static std::string Number(int i, const std::string& ending) {
    std::ostringstream name;
    name.width(6);
    name.fill('0');
    name << i << ending;
    return name.str();
  }
  /// Every mask as `change` makes it of the sound one.
  template <class Change>
  void RewriteMasks(Change change) {
    sequence_.Write(folder_);
    for (int i = 0; i < SmallSequence::kNumFrames; ++i)
      WriteBytes(Mask(i), change(sequence_.masks[static_cast<std::size_t>(i)]));
  }

  fs::path folder_;
  SmallSequence sequence_ = Sound();
  FindingList findings_;
};

TEST_F(UserCases, PicturesASoundSequenceHasNothingButNotes) {
  sequence_.Write(folder_);
  for (const auto depth : {CheckOptions::Depth::kFull, CheckOptions::Depth::kQuick}) {
    const std::string text = Check(depth);
    EXPECT_EQ(findings_.count(Severity::kError) + findings_.count(Severity::kWarning), 0) << text;
    EXPECT_EQ(text.find("pictures of 5 of 14 frames were checked") != std::string::npos,
              depth == CheckOptions::Depth::kFull);
    EXPECT_NE(text.find("100 % have a positive disparity"), std::string::npos) << text;
  }
}

TEST_F(UserCases, Case45MasksOf16BitsAreReadAsTheyAre) {
  RewriteMasks([](const cv::Mat& mask) {
    cv::Mat ids;
    mask.convertTo(ids, CV_16U, 40.0 / 255);
    return Png(ids);
  });
  Expect(Severity::kNote, "masks.kind", "", "16-bit grey");
  const auto frame = OpenStereoSequence(folder_.string())->Load(3);
  const cv::Mat handed_on = cv::imdecode(frame.person_mask_file, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(handed_on.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(handed_on, sequence_.masks[3], cv::NORM_INF), 0);
}

TEST_F(UserCases, Case45bAMaskOf8BitsTravelsByteForByte) {
  sequence_.Write(folder_);
  EXPECT_EQ(OpenStereoSequence(folder_.string())->Load(3).person_mask_file,
            ReadBytes(Mask(3).string()));
}

TEST_F(UserCases, Case47bRgbMasksWithTheClassInBlue) {
  RewriteMasks([](const cv::Mat& mask) {
    cv::Mat rgb(mask.size(), CV_8UC3, cv::Scalar(0, 0, 0));
    rgb.setTo(cv::Scalar(1, 0, 0), mask);
    return Png(rgb);
  });
  Expect(Severity::kNote, "masks.kind", "", "RGB");
  const auto frame = OpenStereoSequence(folder_.string())->Load(3);
  EXPECT_EQ(cv::norm(cv::imdecode(frame.person_mask_file, cv::IMREAD_UNCHANGED), sequence_.masks[3],
                     cv::NORM_INF),
            0);
}

TEST_F(UserCases, Case47cMasksOfOneBit) {
  Bytes bytes;
  cv::imencode(".png", sequence_.masks[0], bytes, {cv::IMWRITE_PNG_BILEVEL, 1});
  EXPECT_EQ(Decode(bytes).kind, "1-bit grey");
  EXPECT_EQ(cv::norm(Decode(bytes).pixels, sequence_.masks[0], cv::NORM_INF), 0);
}

TEST_F(UserCases, Case47dAnAlphaChannelIsRefused) {
  RewriteMasks([](const cv::Mat& mask) {
    cv::Mat rgba(mask.size(), CV_8UC4, cv::Scalar(0, 0, 0, 255));
    rgba.setTo(cv::Scalar(255, 255, 255, 255), mask);
    return Png(rgba);
  });
  Expect(Severity::kError, "masks.file", "000000.png", "alpha channel (RGBA)");
  EXPECT_THROW(OpenStereoSequence(folder_.string())->Load(0), InputError);
}

TEST_F(UserCases, Case49MasksAsJpegAreNotPassedOver) {
  sequence_.Write(folder_);
  for (int i = 0; i < SmallSequence::kNumFrames; ++i) {
    cv::imwrite(fs::path(Mask(i)).replace_extension(".jpg").string(), sequence_.masks[0]);
    fs::remove(Mask(i));
  }
  Expect(Severity::kError, "masks.other_files", "rcnnseg_image_0", "000000.jpg");
  EXPECT_THROW(OpenStereoSequence(folder_.string())->Load(0), InputError);
}

TEST_F(UserCases, Case49bAJpegThatWasMadeIntoAPng) {
  for (const int quality : {50, 90, 98}) {
    RewriteMasks([&](const cv::Mat& mask) {
      Bytes jpeg;
      cv::imencode(".jpg", mask, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
      return Png(cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE));
    });
    Expect(Severity::kError, "masks.jpeg", "rcnnseg_image_0/0000", "JPEG");
  }
  RewriteMasks([](const cv::Mat& mask) {  // as resizing leaves it
    cv::Mat smooth;
    cv::resize(mask, smooth, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::resize(smooth, smooth, mask.size(), 0, 0, cv::INTER_LINEAR);
    return Png(smooth);
  });
  Expect(Severity::kNote, "masks.polarity", "", "of the keypoints lie in them");
}

TEST_F(UserCases, Case50MasksAsNumpyArrays) {
  sequence_.Write(folder_);
  for (int i = 0; i < SmallSequence::kNumFrames; ++i)
    fs::rename(Mask(i), fs::path(Mask(i)).replace_extension(".npy"));
  Expect(Severity::kError, "masks.other_files", "rcnnseg_image_0", "000000.npy");
  EXPECT_THROW(OpenStereoSequence(folder_.string())->Load(0), InputError);
  sequence_.Write(folder_);
  std::ofstream(Mask(4)) << "\x93NUMPY of an array";
  Expect(Severity::kError, "masks.file", "000004.png", "NumPy");
}

TEST_F(UserCases, Case51MasksOfEverythingOrNothing) {
  for (cv::Mat& mask : sequence_.masks) mask.setTo(1, mask == 0);
  sequence_.Write(folder_);
  Expect(Severity::kError, "masks.coverage", "", "a class map");
  for (cv::Mat& mask : sequence_.masks) mask.setTo(0);
  sequence_.Write(folder_);
  Expect(Severity::kError, "masks.empty", "", "no mask marks anybody");
  sequence_ = Sound();
  sequence_.masks[9].setTo(255);  // of those that both depths decode
  sequence_.Write(folder_);
  Expect(Severity::kWarning, "masks.full", "000009.png", "1 of");
}

TEST_F(UserCases, Case52MasksOfAnotherSizeNameBothSizes) {
  cv::resize(sequence_.masks[7], sequence_.masks[7], {}, 0.5, 0.5, cv::INTER_NEAREST);
  sequence_.Write(folder_);
  Expect(Severity::kError, "masks.size", "000007.png", "0.5 times as large");
  EXPECT_THROW(OpenStereoSequence(folder_.string())->Load(7), InputError);
}

TEST_F(UserCases, Case54PicturesOf12BitsIn16) {
  const SmallSequence sound = sequence_;
  sequence_.Write(folder_);
  for (auto* pictures : {&sequence_.left, &sequence_.right}) {
    for (cv::Mat& picture : *pictures) picture.convertTo(picture, CV_16U, 16);
  }
  sequence_.Write(folder_);
  Expect(Severity::kNote, "images.bits", "000000.png", "12 significant bits: divided by 16");
  const auto sequence = OpenStereoSequence(folder_.string());
  const auto range = FindSixteenBitRange(*sequence);
  ASSERT_TRUE(range);
  const Bytes file = sequence->Load(3).left_image_file;
  const Picture picture = DecodePicture(file, "f", PictureColor::kGrey, *range);
  EXPECT_EQ(cv::norm(picture.pixels, sound.left[3], cv::NORM_INF), 0);
  EXPECT_EQ(picture.saturated, 0);
  EXPECT_GT(DecodePicture(file, "f", PictureColor::kGrey, {9}).saturated, 0.5);
}

TEST_F(UserCases, Case55ExifRotationIsIgnoredAndSaid) {
  sequence_.image_ending = ".jpg";
  sequence_.Write(folder_);
  for (int i = 0; i < SmallSequence::kNumFrames; ++i) {
    const fs::path path = folder_ / "image_1" / Number(i, ".jpg");
    const Bytes jpeg = ReadBytes(path.string());
    const Bytes turned = WithOrientation(jpeg, 6);
    WriteBytes(path, turned);
    ASSERT_EQ(ReadImageHeader(turned.data(), turned.size())->orientation, 6);
    const cv::Mat pixels = DecodePicture(turned, "f", PictureColor::kGrey, {}).pixels;
    ASSERT_EQ(cv::norm(pixels, cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0);
  }
  Expect(Severity::kNote, "images.orientation", "image_1/000000.jpg", "turned by 90 degrees");
}

TEST_F(UserCases, Case57bOneImageOfAnotherSizeAmongMany) {
  cv::resize(sequence_.left[5], sequence_.left[5], {}, 0.5, 0.5);
  sequence_.Write(folder_);
  Expect(Severity::kError, "images.size", "image_0/000005.png", "0.5 times as large");
}

TEST_F(UserCases, Case58And58dFilesThatAreCutShort) {
  for (const char* ending : {".jpg", ".png"}) {
    sequence_.image_ending = ending;
    sequence_.Write(folder_);
    const fs::path path = folder_ / "image_1" / Number(5, ending);
    fs::resize_file(path, fs::file_size(path) / 2);
    Expect(Severity::kError, "images.file", Number(5, ending), "is cut short");
    try {
      OpenStereoSequence(folder_.string())->Load(5);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": is cut short"), 0U)
          << error.what();
    }
  }
}

TEST_F(UserCases, Case58bWhatFollowsTheEndOfAPictureDoesNotMatter) {
  for (const char* ending : {".jpg", ".png"}) {
    Bytes file;
    cv::imencode(ending, sequence_.left[0], file);
    EXPECT_FALSE(IsCutShort(file.data(), file.size()));
    for (std::size_t size = 64; size < file.size() - 1; size += 97)
      EXPECT_TRUE(IsCutShort(file.data(), size)) << ending << size;
    file.insert(file.end(), 1000, 0);
    EXPECT_FALSE(IsCutShort(file.data(), file.size()));
  }
  Bytes progressive;
  cv::imencode(".jpg", sequence_.left[0], progressive, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  EXPECT_FALSE(IsCutShort(progressive.data(), progressive.size()));
  EXPECT_TRUE(IsCutShort(progressive.data(), progressive.size() * 3 / 4));
}

TEST_F(UserCases, Case58cADamagedPngIsNoPicture) {
  Bytes file = Png(sequence_.left[0]);
  file[file.size() / 2] ^= 0x10;
  EXPECT_THROW(DecodePicture(file, "f", PictureColor::kGrey, {}), InputError);
  Bytes mask = Png(sequence_.masks[0]);
  mask[mask.size() / 2] ^= 0x10;
  EXPECT_NE(Refusal(mask).find("damaged"), std::string::npos);
}

TEST_F(UserCases, Case60cRightImagesOfTheNextFrame) {
  std::rotate(sequence_.right.begin(), sequence_.right.begin() + 1, sequence_.right.end());
  sequence_.Write(folder_);
  Expect(Severity::kError, "images.shifted", "", "one frame early");
  sequence_ = Sound();
  std::rotate(sequence_.left.begin(), sequence_.left.begin() + 2, sequence_.left.end());
  sequence_.Write(folder_);
  Expect(Severity::kError, "images.shifted", "", "two frames late");
}

TEST_F(UserCases, Case70hKeypointsOfOneCameraOnly) {
  sequence_.Write(folder_);
  fs::remove_all(folder_ / "alphapose_1");
  Expect(Severity::kWarning, "keypoints.one_side", "", "no keypoints in the right");
  sequence_.Write(folder_);
  fs::remove_all(folder_ / "alphapose_0");
  Expect(Severity::kWarning, "keypoints.one_side", "", "no keypoints in the left");
}

TEST_F(UserCases, Case76KeypointsOfLeftAndRightExchanged) {
  std::swap(sequence_.people_left, sequence_.people_right);
  sequence_.Write(folder_);
  Expect(Severity::kError, "keypoints.swapped", "", "exchanged");
}

TEST_F(UserCases, Case76bKeypointsThatAreNoStereoPair) {
  sequence_.people_right = sequence_.people_left;
  sequence_.Write(folder_);
  Expect(Severity::kError, "keypoints.identical", "alphapose_1", "the same in");
  sequence_ = Sound();
  for (auto& people : sequence_.people_right) {
    for (auto& row : people) {
      for (auto& point : row) point = {0.5 * point[0], 0.5 * point[1], point[2]};
    }
  }
  sequence_.Write(folder_);
  Expect(Severity::kError, "keypoints.resolution", "", "times as large as in the left");
  sequence_ = Sound();
  for (auto& people : sequence_.people_right) {
    for (auto& row : people) {
      for (auto& point : row) point[1] += 25;
    }
  }
  sequence_.Write(folder_);
  Expect(Severity::kWarning, "keypoints.rows", "", "different rows");
}

TEST_F(UserCases, Case70iFlagsAndOtherOrdersOfJoints) {
  const auto change = [&](auto&& change_row) {
    sequence_ = Sound();
    for (auto* side : {&sequence_.people_left, &sequence_.people_right}) {
      for (auto& people : *side) {
        for (auto& row : people) change_row(&row);
      }
    }
    sequence_.Write(folder_);
  };
  change([](SmallSequence::Row* row) {
    for (std::size_t j = 0; j < row->size(); ++j) (*row)[j][2] = j % 3 == 0 ? 1 : 2;
  });
  Expect(Severity::kWarning, "keypoints.flags", "alphapose_0", "visibility flags");
  change([](SmallSequence::Row* row) {
    for (auto& point : *row) point[2] = 1;
  });
  Expect(Severity::kNote, "keypoints.flags", "alphapose_0", "0 or 1");
  change([](SmallSequence::Row* row) {  // BODY_25: the middle of the hips is its joint 8
    row->insert(row->begin() + 8, {0.5 * ((*row)[8][0] + (*row)[11][0]), (*row)[8][1], 0.9});
    row->pop_back();
  });
  Expect(Severity::kError, "keypoints.layout", "alphapose_0", "BODY_25");
}

}  // namespace
}  // namespace airdos
