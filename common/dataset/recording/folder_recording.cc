#include "common/dataset/recording/folder_recording.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>

#include "common/dataset/file_name.h"
#include "common/dataset/recording/image_pairing.h"
#include "common/dataset/recording/recording_times.h"
#include "common/dataset/sequence_files.h"
#include "common/util/check.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

void Append(const std::vector<std::string>& lines, std::vector<std::string>* to) {
  to->insert(to->end(), lines.begin(), lines.end());
}

/// Every image number that either camera has, so that a row of a file of times is found although
/// one of the images is missing.
ImageNames AllNumbers(const ImageNames& left, const ImageNames& right) {
  if (left.numbers.empty() || right.numbers.empty()) return left;
  std::map<std::uint64_t, std::string> files;
  for (const ImageNames* names : {&right, &left}) {
    for (std::size_t i = 0; i < names->files.size(); ++i) {
      files[names->numbers[i]] = names->files[i];
    }
  }
  ImageNames all;
  all.folder = left.folder;
  for (const auto& [number, file] : files) {
    all.files.push_back(file);
    all.keys.push_back(std::to_string(number));
    all.numbers.push_back(number);
  }
  return all;
}

using OptionalTimes = std::vector<std::optional<std::int64_t>>;

/// The times that a file gives to the left images of the pairs.
OptionalTimes TimesFromFile(const std::string& path, const ImageNames& all,
                            const ImageNames& paired_left, std::vector<std::string>* notes) {
  const RecordingTimes times = ReadRecordingTimes(path);
  if (times.unit != "s") notes->push_back(path + ": the times are in " + times.unit);
  if (!times.stems.empty()) return TimesOfImages(times, paired_left, notes);
  const OptionalTimes of_all = TimesOfImages(times, all, notes);
  std::map<std::string, std::optional<std::int64_t>> by_key;
  for (std::size_t i = 0; i < all.keys.size(); ++i) by_key[all.keys[i]] = of_all[i];
  OptionalTimes of_pairs;
  for (const std::string& key : paired_left.keys) of_pairs.push_back(by_key.at(key));
  return of_pairs;
}

/// By number where a number is missing, so that the gap stays.
OptionalTimes TimesByRate(const ImageNames& left, double rate_hz) {
  OptionalTimes utimes;
  constexpr std::uint64_t kMaxNumber = 1000000000;
  const bool are_counts =
      !left.numbers.empty() && left.numbers.back() < kMaxNumber && !TimesFromNames(left);
  for (std::size_t i = 0; i < left.files.size(); ++i) {
    const std::size_t index =
        are_counts ? static_cast<std::size_t>(left.numbers[i] - left.numbers[0]) : i;
    utimes.emplace_back(TimeAtRate(index, rate_hz));
  }
  return utimes;
}

/// A file that cameras' recorders leave beside the images; empty if there is none.
std::string TimesFileBeside(const std::string& folder) {
  const fs::path parent = fs::path(folder).parent_path();
  for (const fs::path& path : {parent / "data.csv", parent / "timestamps.txt",
                               fs::path(folder) / "times.txt", parent / "times.txt"}) {
    if (fs::is_regular_file(path)) return path.string();
  }
  return "";
}

OptionalTimes FindTimes(const FolderRecordingOptions& options, const ImageNames& all,
                        const ImageNames& left, std::vector<std::string>* notes) {
  if (!options.times.empty()) return TimesFromFile(options.times, all, left, notes);
  if (options.rate_hz) return TimesByRate(left, *options.rate_hz);
  const std::optional<NamedTimes> named = TimesFromNames(left);
  if (named) {
    notes->push_back(left.folder + ": the times are those in the images' names, in " + named->unit);
    return {named->utimes.begin(), named->utimes.end()};
  }
  const std::string beside = TimesFileBeside(left.folder);
  if (!beside.empty()) {
    notes->push_back(left.folder + ": the times are those of " + beside);
    return TimesFromFile(beside, all, left, notes);
  }
  throw InputError(left.folder +
                   ": the images have no times: give a file with --times FILE, or how many there "
                   "are in a second with --rate HZ");
}

std::string PathOf(const ImageNames& names, std::size_t index) {
  return (fs::path(names.folder) / names.files[index]).string();
}

using Sizes = std::map<std::pair<int, int>, std::size_t>;

std::pair<int, int> Commonest(const Sizes& sizes) {
  return std::max_element(sizes.begin(), sizes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::string IsOrAre(const std::vector<std::string>& files) {
  return FirstFew(files) + (files.size() == 1 ? " is " : " are ");
}

}  // namespace

/// Both images of a pair by their headers.
struct FolderRecording::Surveyed {
  SurveyedImage left;
  SurveyedImage right;
  static std::pair<int, int> SizeOf(const SurveyedImage& image) {
    return {static_cast<int>(image.header->width), static_cast<int>(image.header->height)};
  }
};

FolderRecording::FolderRecording(const FolderRecordingOptions& options) {
  if (options.rate_hz) TimesAtRate(0, *options.rate_hz);  // refuses what is no rate
  ImageNames left, right;
  const std::string left_folder = FolderOfImages(options.left);
  if (options.right.empty()) {
    SplitFolder(left_folder, &left, &right);
  } else {
    const std::string right_folder = FolderOfImages(options.right);
    if (fs::equivalent(left_folder, right_folder)) {
      throw InputError(right_folder + ": is given for the left and for the right images");
    }
    left = ListImages(left_folder);
    right = ListImages(right_folder);
  }
  name_ = left_folder;
  Append(left.notes, &notes_);
  Append(right.notes, &notes_);
  const PairedImages paired = PairImages(left, right);
  Append(paired.notes, &notes_);
  const OptionalTimes utimes = FindTimes(options, AllNumbers(left, right), paired.left, &notes_);
  for (std::size_t i = 0; i < utimes.size(); ++i) {
    if (utimes[i])
      pairs_.push_back({{PathOf(paired.left, i), PathOf(paired.right, i)}, *utimes[i]});
  }
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [](const Pair& a, const Pair& b) { return a.utime < b.utime; });
  if (pairs_.empty()) throw InputError(name_ + ": no pair of images has a time");
  Survey();
}

/// Leaves out the pairs that cannot be used, and finds the size of the others.
void FolderRecording::Survey() {
  std::vector<Surveyed> surveyed;
  Sizes left_sizes, right_sizes;
  std::vector<std::string> unusable;
  std::string first_error;
  for (const Pair& pair : pairs_) {
    surveyed.push_back({SurveyImage(pair.paths.left, true), SurveyImage(pair.paths.right, false)});
    for (const SurveyedImage* image : {&surveyed.back().left, &surveyed.back().right}) {
      if (image->error.empty()) {
        ++(image->is_left ? left_sizes : right_sizes)[Surveyed::SizeOf(*image)];
        continue;
      }
      if (first_error.empty()) first_error = image->error;
      unusable.push_back(image->path);
    }
  }
  if (left_sizes.empty() || right_sizes.empty()) throw InputError(first_error);
  size_ = Commonest(left_sizes);
  if (Commonest(right_sizes) != size_) {
    throw InputError(pairs_[0].paths.right + ": the right images have " +
                     SizeText(Commonest(right_sizes)) + ", the left ones " + SizeText(size_));
  }
  if (!unusable.empty()) {
    notes_.push_back(first_error + ": skipped" +
                     (unusable.size() == 1 ? ""
                                           : ", and so are " + std::to_string(unusable.size() - 1) +
                                                 " more that cannot be used"));
  }
  std::vector<std::string> other_size;
  std::vector<Pair> kept;
  std::vector<Surveyed> kept_surveyed;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    bool is_kept = true;
    for (const SurveyedImage* image : {&surveyed[i].left, &surveyed[i].right}) {
      const bool is_fit = image->error.empty() && Surveyed::SizeOf(*image) == size_;
      if (image->error.empty() && !is_fit) other_size.push_back(image->path);
      is_kept = is_kept && is_fit;
    }
    if (!is_kept) continue;
    kept.push_back(pairs_[i]);
    kept_surveyed.push_back(surveyed[i]);
  }
  if (!other_size.empty()) {
    notes_.push_back(IsOrAre(other_size) + "not of the size of the others, " + SizeText(size_) +
                     ": skipped");
  }
  if (kept.empty()) throw InputError(name_ + ": no pair of images is left that can be used");
  pairs_ = kept;
  NoteFormats(kept_surveyed);
}

/// Says what of depth and colour is mixed, and finds the range of 16-bit images.
void FolderRecording::NoteFormats(const std::vector<Surveyed>& surveyed) {
  std::vector<std::string> sixteen, grey, coloured;
  for (const Surveyed& pair : surveyed) {
    for (const SurveyedImage* image : {&pair.left, &pair.right}) {
      if (image->header->bits == 16) sixteen.push_back(image->path);
      const bool is_grey = image->header->num_channels < 3 && !image->header->is_palette;
      (is_grey ? grey : coloured).push_back(image->path);
    }
  }
  if (!sixteen.empty()) {
    range_ = FindSixteenBitRange(sixteen).value_or(SixteenBitRange());
    const bool are_all = sixteen.size() == 2 * surveyed.size();
    notes_.push_back(are_all ? name_ + ": " + RangeText(range_)
                             : IsOrAre(sixteen) +
                                   "of 16 bits, the others of 8: grey values may differ (" +
                                   RangeText(range_) + ")");
  }
  if (grey.empty() || coloured.empty()) return;
  const bool are_few_grey = grey.size() <= coloured.size();
  notes_.push_back(IsOrAre(are_few_grey ? grey : coloured) +
                   (are_few_grey ? "grey, the others in colour" : "in colour, the others grey") +
                   ": a pair of both is used in grey");
}

cv::Mat FolderRecording::Read(const std::string& path) const {
  cv::Mat image = DecodePicture(ReadImageFile(path), path, PictureColor::kAsStored, range_).pixels;
  if (image.cols != size_.first || image.rows != size_.second) {
    throw InputError(path + ": has " + SizeText({image.cols, image.rows}) + ", the others " +
                     SizeText(size_));
  }
  return image;
}

std::optional<RecordedPair> FolderRecording::Load(std::size_t index) {
  AIRDOS_CHECK(index < pairs_.size());
  const Pair& pair = pairs_[index];
  RecordedPair loaded;
  loaded.utime = pair.utime;
  try {
    loaded.left = Read(pair.paths.left);
    loaded.right = Read(pair.paths.right);
  } catch (const InputError& error) {
    notes_.push_back(error.what() + std::string(": skipped"));
    return std::nullopt;
  }
  for (auto [image, other] :
       {std::make_pair(&loaded.left, &loaded.right), std::make_pair(&loaded.right, &loaded.left)}) {
    if (image->channels() == 3 && other->channels() == 1) {
      cv::cvtColor(*image, *image, cv::COLOR_BGR2GRAY);
    }
  }
  return loaded;
}

}  // namespace airdos
