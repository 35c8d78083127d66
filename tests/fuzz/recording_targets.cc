#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/image_pairing.h"
#include "common/dataset/recording/recording_times.h"
#include "common/util/error.h"
#include "tests/fuzz/fuzz_input.h"

// Recordings as cameras and users leave them: folders of any names, and files of times.

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::string TinyPng() {
  static const std::string file = [] {
    FuzzBytes bytes;
    cv::imencode(".png", cv::Mat(3, 4, CV_8UC1, cv::Scalar(77)), bytes);
    return std::string(bytes.begin(), bytes.end());
  }();
  return file;
}

template <class Number>
void CheckIncrease(const std::vector<Number>& utimes) {
  for (std::size_t i = 1; i < utimes.size(); ++i)
    FuzzCheck(utimes[i] > utimes[i - 1], "times that do not increase");
}

// --- times
void RunRecordingTimes(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("times.csv", data, size);
  try {
    const RecordingTimes times = ReadRecordingTimes(path);
    FuzzCheck(!times.utimes.empty(), "a file without times was read");
    FuzzCheck(times.stems.empty() || times.stems.size() == times.utimes.size(),
              "names and times differ in number");
    CheckIncrease(times.utimes);
  } catch (const InputError&) {
  }
}

constexpr char kEurocTimes[] =
    "#timestamp [ns],filename\n1403636579763555584,1403636579763555584.png\r\n"
    "1403636579813555584,1403636579813555584.png\r\n";
constexpr char kDates[] =
    "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074389445\n2011/12/31 23:59:59.9\n";

std::vector<FuzzBytes> RecordingTimesSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const std::string text :
       {kEurocTimes, kDates, "0.0\n0.1\n0.2\n", "timestamp;file\n1403636579763556; l/000000.png\n",
        "1.403636579763555584e+18\n1.403636579813555584e+18\n", "100 a.jpg\n200 b.JPEG\n"}) {
    seeds.emplace_back(text.begin(), text.end());
  }
  return seeds;
}

// --- folders
/// Each image has a partner, and each pair comes after the one before it.
void CheckRecording(const FolderRecordingOptions& options) {
  try {
    FolderRecording recording(options);
    FuzzCheck(recording.num_pairs() > 0, "a recording without pairs");
    std::vector<std::int64_t> utimes;
    for (std::size_t i = 0; i < recording.num_pairs(); ++i) {
      const PairNames names = recording.names(i);
      FuzzCheck(fs::exists(names.left) && fs::exists(names.right), "an image that is not there");
      FuzzCheck(names.left != names.right, "an image is its own partner");
      utimes.push_back(recording.utime(i));
    }
    CheckIncrease(utimes);
    FuzzCheck(recording.Load(0).has_value(), "a good pair is not loaded");
    recording.TakeNotes();
  } catch (const InputError&) {
  }
}

/// What is known of the times, then the names in both folders, and the file of times.
void RunRecordingFolders(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const int flags = input.U8();
  FuzzFolder::MakeFiles("recording/l", input.Block(), TinyPng());
  FuzzFolder::MakeFiles("recording/r", input.Block(), TinyPng());
  const FuzzBytes times = input.Block();
  FuzzFolder::Write("recording/times.txt", times.data(), times.size());
  const std::string root = FuzzFolder::Path() + "/recording";
  FolderRecordingOptions options{root + "/l", root + "/r", "", {}};
  if ((flags & 1) != 0) options.times = root + "/times.txt";
  if ((flags & 2) != 0) options.rate_hz = 20;
  CheckRecording(options);
  options.right = "";
  CheckRecording(options);
  options.left = root;
  CheckRecording(options);
  fs::remove_all(root);
}

FuzzBytes FoldersSeed(int flags, const std::string& left, const std::string& right,
                      const std::string& times = "") {
  FuzzOutput seed;
  seed.U8(flags);
  seed.Block(left);
  seed.Block(right);
  seed.Block(times);
  return seed.Take();
}

std::vector<FuzzBytes> RecordingFoldersSeeds() {
  return {
      FoldersSeed(2, "0000000001.png\n0000000003.png\n", "frame1.png\nframe2.png\nframe3.png\n"),
      FoldersSeed(2, "a_l_1.png\na_r_1.png\nleft2.png\nright2.png\n", "x.png\n"),
      FoldersSeed(0, "1403636579763555584.png\n1403636579813555584.png\n",
                  "1403636579764555584.png\n1403636579814555584.png\n"),
      FoldersSeed(0, "1.500.jpg\n1.600.JPG\n1.700.jpeg\n", "1.501.jpg\n1.602.jpg\n1.7.jpg\n"),
      FoldersSeed(1, "1.png\n2.png\n4.png\n", "1.png\n3.png\n4.png\n", "0.1\n0.2\n0.3\n0.4\n"),
      FoldersSeed(0, "1.png\n2.png\n", "1.png\n2.png\n", kDates),
      FoldersSeed(1, "1403636579763555584.png\n1403636579813555584.png\n",
                  "1403636579763555584.png\n1403636579813555584.png\n", kEurocTimes),
      FoldersSeed(0, "1403636579.png\n1403636580.png\n1403636581.png\n",
                  "1403636579.png\n1403636580.png\n1403636581.png\n")};
}

}  // namespace

std::vector<FuzzTarget> RecordingTargets() {
  return {{"recording_times", RunRecordingTimes, RecordingTimesSeeds, 2048},
          {"recording_folders", RunRecordingFolders, RecordingFoldersSeeds, 2048}};
}

}  // namespace airdos
