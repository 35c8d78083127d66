#ifndef AIRDOS_TESTS_UNIT_DATASET_RECORDING_RECORDING_FIXTURE_H_
#define AIRDOS_TESTS_UNIT_DATASET_RECORDING_RECORDING_FIXTURE_H_

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/dataset/recording/folder_recording.h"
#include "common/util/format.h"
#include "tests/support/folder_test.h"
#include "tests/support/input_errors.h"

namespace airdos {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Each image is of one grey value, 10 times its number, the right ones 5 more.
inline cv::Mat Plain(int number, bool is_left, int width = kWidth) {
  return cv::Mat(kHeight, width, CV_8UC1, cv::Scalar(10 * number + (is_left ? 0 : 5)));
}

class RecordingTest : public FolderTest {
 protected:
  RecordingTest() : FolderTest("recording_test") {}

  void WriteLeft(const std::string& name, int number) const {
    scratch_.WritePicture(name, Plain(number, true));
  }
  void WriteRight(const std::string& name, int number) const {
    scratch_.WritePicture(name, Plain(number, false));
  }
  /// Folders l and r with 000000.png, ...
  void WriteNumbered(int count) const {
    for (int i = 0; i < count; ++i) {
      WriteLeft(Format("l/%06d.png", i), i);
      WriteRight(Format("r/%06d.png", i), i);
    }
  }
  FolderRecordingOptions Numbered() const { return {Path("l"), Path("r"), "", 20.0}; }
  std::string Refusal(const FolderRecordingOptions& options) const {
    return ErrorOf([&] { FolderRecording recording(options); });
  }
};

/// The numbers of the pairs that can be loaded, by their grey values; -1 if left and right differ.
inline std::vector<int> NumbersOf(StereoRecording* recording) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < recording->num_pairs(); ++i) {
    const auto pair = recording->Load(i);
    if (!pair) continue;
    const double left = cv::mean(pair->left)[0] / 10;
    const double right = (cv::mean(pair->right)[0] - 5) / 10;
    numbers.push_back(std::lround(left) == std::lround(right) ? static_cast<int>(std::lround(left))
                                                              : -1);
  }
  return numbers;
}

inline std::vector<std::int64_t> TimesOf(StereoRecording* recording) {
  std::vector<std::int64_t> utimes;
  for (std::size_t i = 0; i < recording->num_pairs(); ++i) utimes.push_back(recording->utime(i));
  return utimes;
}

inline std::string Notes(StereoRecording* recording) {
  std::string text;
  for (const std::string& note : recording->TakeNotes()) text += note + "\n";
  return text;
}

using Numbers = std::vector<int>;
using Times = std::vector<std::int64_t>;

}  // namespace airdos

#endif  // AIRDOS_TESTS_UNIT_DATASET_RECORDING_RECORDING_FIXTURE_H_
