#include "common/dataset/recording/image_pairing.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "common/dataset/file_name.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// Keeps the images at these indices.
ImageNames Selected(const ImageNames& names, const std::vector<std::size_t>& indices) {
  ImageNames selected;
  selected.folder = names.folder;
  for (const std::size_t i : indices) {
    selected.files.push_back(names.files[i]);
    selected.keys.push_back(names.keys[i]);
    if (!names.numbers.empty()) selected.numbers.push_back(names.numbers[i]);
  }
  return selected;
}

/// Indices of the images that are paired, as many on each side.
struct Matches {
  std::vector<std::size_t> left;
  std::vector<std::size_t> right;
};

Matches MatchKeys(const ImageNames& left, const ImageNames& right) {
  std::map<std::string, std::size_t> in_right;
  for (std::size_t i = 0; i < right.keys.size(); ++i) in_right[right.keys[i]] = i;
  Matches matches;
  for (std::size_t i = 0; i < left.keys.size(); ++i) {
    const auto it = in_right.find(left.keys[i]);
    if (it == in_right.end()) continue;
    matches.left.push_back(i);
    matches.right.push_back(it->second);
  }
  return matches;
}

double MedianStep(const std::vector<std::int64_t>& utimes) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    steps.push_back(static_cast<double>(utimes[i] - utimes[i - 1]));
  }
  return steps.empty() ? 0 : Quantile(std::move(steps), 0.5);
}

/// Index of the element of an increasing list that is nearest to a time.
std::size_t Nearest(const std::vector<std::int64_t>& utimes, std::int64_t utime) {
  const auto after = std::lower_bound(utimes.begin(), utimes.end(), utime);
  if (after == utimes.begin()) return 0;
  const auto before = after - 1;
  const bool is_after = after != utimes.end() && *after - utime < utime - *before;
  return static_cast<std::size_t>((is_after ? after : before) - utimes.begin());
}

/// Each other's nearest ones. `largest_us` receives the largest difference.
Matches MatchTimes(const std::vector<std::int64_t>& left, const std::vector<std::int64_t>& right,
                   std::int64_t* largest_us) {
  const double max_difference_us = 0.25 * std::max(MedianStep(left), MedianStep(right));
  Matches matches;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::size_t j = Nearest(right, left[i]);
    const std::int64_t difference_us = std::abs(right[j] - left[i]);
    if (static_cast<double>(difference_us) > max_difference_us || Nearest(left, right[j]) != i) {
      continue;
    }
    matches.left.push_back(i);
    matches.right.push_back(j);
    *largest_us = std::max(*largest_us, difference_us);
  }
  return matches;
}

bool IsEnough(const Matches& matches, const ImageNames& left, const ImageNames& right) {
  return 2 * matches.left.size() > std::min(left.files.size(), right.files.size());
}

/// Notes the images that are not among those at `indices`.
void NoteAlone(const ImageNames& names, const std::vector<std::size_t>& indices,
               const std::string& other_side, std::vector<std::string>* notes) {
  std::vector<bool> is_paired(names.files.size(), false);
  for (const std::size_t i : indices) is_paired[i] = true;
  std::vector<std::string> alone;
  for (std::size_t i = 0; i < names.files.size(); ++i) {
    if (!is_paired[i]) alone.push_back(names.files[i]);
  }
  if (alone.empty()) return;
  notes->push_back(names.folder + ": " + FirstFew(alone) + (alone.size() == 1 ? " has" : " have") +
                   " no " + other_side + " image: skipped");
}

enum class Side { kNone, kLeft, kRight, kBoth };

/// Which camera a name speaks of.
Side SideOf(const std::string& name) {
  const auto starts = [](const std::string& word, const std::string& part) {
    return word.rfind(part, 0) == 0;
  };
  const auto ends = [](const std::string& word, const std::string& part) {
    return word.size() >= part.size() && word.substr(word.size() - part.size()) == part;
  };
  bool is_left = false;
  bool is_right = false;
  std::string word;
  for (const char c : fs::path(name).stem().string() + "_") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    is_left = is_left || word == "l" || starts(word, "left") || ends(word, "left");
    is_right = is_right || word == "r" || starts(word, "right") || ends(word, "right");
    word.clear();
  }
  if (is_left && is_right) return Side::kBoth;
  return is_left ? Side::kLeft : is_right ? Side::kRight : Side::kNone;
}

}  // namespace

PairedImages PairImages(const ImageNames& left, const ImageNames& right) {
  PairedImages result;
  Matches matches = MatchKeys(left, right);
  if (left.files.size() == 1 && right.files.size() == 1) matches = {{0}, {0}};
  if (!IsEnough(matches, left, right)) {
    const auto left_times = TimesFromNames(left);
    const auto right_times = TimesFromNames(right);
    if (left_times && right_times) {
      std::int64_t largest_us = 0;
      matches = MatchTimes(left_times->utimes, right_times->utimes, &largest_us);
      result.notes.push_back(left.folder + ", " + right.folder +
                             Format(": paired by the times in the names, which differ by up to "
                                    "%.3g ms",
                                    1e-3 * static_cast<double>(largest_us)));
    }
  }
  if (!IsEnough(matches, left, right)) {
    CheckPairs(left, right);  // says which
    throw InputError(right.folder + ": its images do not belong to those of " + left.folder);
  }
  NoteAlone(left, matches.left, "right", &result.notes);
  NoteAlone(right, matches.right, "left", &result.notes);
  result.left = Selected(left, matches.left);
  result.right = Selected(right, matches.right);
  return result;
}

void SplitFolder(const std::string& folder, ImageNames* left, ImageNames* right) {
  std::vector<std::string> left_files, right_files, others;
  for (const std::string& name : ListImageFiles(folder)) {
    const Side side = SideOf(name);
    if (IsHidden(name)) continue;
    (side == Side::kLeft    ? left_files
     : side == Side::kRight ? right_files
                            : others)
        .push_back(name);
  }
  const std::size_t num_sided = std::min(left_files.size(), right_files.size());
  if (num_sided == 0 || others.size() > num_sided) {
    const std::string of =
        others.empty() ? FirstFew(left_files.empty() ? right_files : left_files) : FirstFew(others);
    throw InputError(folder + ": which images are left and which right is not in their names (" +
                     of + "): give two folders, or names with _l and _r, or left and right");
  }
  *left = OrderImages(folder, left_files);
  *right = OrderImages(folder, right_files);
  if (!others.empty()) {
    left->notes.push_back(folder + ": " + FirstFew(others) + (others.size() == 1 ? " is" : " are") +
                          " neither of the left nor of the right camera by name: skipped");
  }
}

std::string FolderOfImages(const std::string& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder + (fs::exists(folder) ? ": is not a folder; a video is given by --video"
                                                  : ": is not there"));
  }
  if (HoldsImages(folder)) return folder;
  const std::string data = (fs::path(folder) / "data").string();
  if (fs::is_directory(data) && HoldsImages(data)) return data;
  std::vector<std::string> below;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error) && HoldsImages(it->path().string())) {
      below.push_back(it->path().filename().string());
    }
  }
  std::sort(below.begin(), below.end());
  if (!below.empty()) {
    throw InputError(folder + ": holds no image, but folders with images: " + FirstFew(below) +
                     "; give the left and the right one");
  }
  ListImages(folder);  // says what it holds instead
  throw InputError(folder + ": holds no image");
}

}  // namespace airdos
