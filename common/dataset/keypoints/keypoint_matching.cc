#include "common/dataset/keypoints/keypoint_matching.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "common/dataset/file_name.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Without folder and ending; "1403636579.763555" has no ending.
std::string StemOf(const std::string& name) {
  const std::string file = fs::path(name).filename().string();
  const std::string ending = fs::path(file).extension().string();
  const bool is_ending = ending.size() > 1 && !IsDigit(ending[1]);
  return is_ending ? file.substr(0, file.size() - ending.size()) : file;
}

std::string LastNumberOf(const std::string& stem) {
  auto end = stem.size();
  while (end > 0 && !IsDigit(stem[end - 1])) --end;
  auto first = end;
  while (first > 0 && IsDigit(stem[first - 1])) --first;
  while (first + 1 < end && stem[first] == '0') ++first;
  return stem.substr(first, end - first);
}

/// The number that counts the images, as text without leading zeros, or empty: where all names
/// differ only in numbers that of the series, otherwise the last one, if it is different in each.
std::vector<std::string> NumbersOfNames(const std::vector<std::string>& stems) {
  std::vector<std::string> numbers;
  std::set<std::string> last;
  for (const std::string& stem : stems) {
    numbers.push_back(LastNumberOf(stem));
    last.insert(numbers.back());
  }
  if (last.size() == stems.size()) return numbers;
  std::vector<std::string> names;
  for (const std::string& stem : stems) names.push_back(stem + ".x");  // which TakeApart() removes
  const std::vector<NameSeries> series = GroupNames(names);
  if (series.size() != 1 || series[0].counting < 0) return std::vector<std::string>(stems.size());
  for (std::size_t i = 0; i < names.size(); ++i) numbers[i] = series[0].KeyOf(TakeApart(names[i]));
  return numbers;
}

std::vector<std::string> StemsOf(const std::vector<std::string>& names) {
  std::vector<std::string> stems;
  for (const std::string& name : names) stems.push_back(StemOf(name));
  return stems;
}

class Matcher {
 public:
  Matcher(const std::string& path, const std::vector<ForeignImage>& theirs,
          const std::vector<std::string>& ours)
      : path_(path), theirs_(theirs), our_names_(ours), our_stems_(StemsOf(ours)) {
    for (const ForeignImage& image : theirs) their_stems_.push_back(StemOf(image.name));
    result_.image_of.resize(ours.size());
  }

  KeypointMatching Match() {
    std::vector<std::size_t> left;
    MatchBy(our_stems_, their_stems_, AllOfTheirs(), &left);
    const std::vector<std::string> our_numbers = NumbersOfNames(our_stems_);
    std::vector<std::size_t> unknown;
    MatchBy(our_numbers, NumbersOfNames(their_stems_), left, &unknown);
    NoteUnknown(unknown, our_numbers);
    return std::move(result_);
  }

 private:
  std::vector<std::size_t> AllOfTheirs() const {
    std::vector<std::size_t> all(theirs_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }

  void MatchBy(const std::vector<std::string>& our_keys, const std::vector<std::string>& their_keys,
               const std::vector<std::size_t>& theirs, std::vector<std::size_t>* left) {
    std::map<std::string, std::size_t> place_of;
    for (std::size_t i = 0; i < our_keys.size(); ++i) {
      if (!our_keys[i].empty()) place_of.emplace(our_keys[i], i);
    }
    for (const std::size_t index : theirs) {
      const auto place = place_of.find(their_keys[index]);
      if (place == place_of.end()) {
        left->push_back(index);
        continue;
      }
      std::optional<std::size_t>& image = result_.image_of[place->second];
      if (image) {
        throw InputError(path_ + ": '" + Shown(theirs_[*image].name) + "' and '" +
                         Shown(theirs_[index].name) + "' are both the image '" +
                         Shown(our_names_[place->second]) + "'");
      }
      image = index;
    }
  }

  void NoteUnknown(const std::vector<std::size_t>& unknown,
                   const std::vector<std::string>& our_numbers) {
    if (unknown.empty()) return;
    std::vector<std::string> names;
    for (const std::size_t index : unknown) names.push_back(Shown(theirs_[index].name));
    if (unknown.size() == theirs_.size()) {
      throw InputError(path_ + ": none of its images, such as '" + names[0] +
                       "', is one of ours, such as '" + Shown(our_names_[0]) +
                       "': names or numbers must be the same");
    }
    std::string note = path_ + ": " + std::to_string(unknown.size()) + " of its " +
                       std::to_string(theirs_.size()) + " images " +
                       (unknown.size() == 1 ? "is" : "are") + " none of ours: " + FirstFew(names);
    if (SeemsToCountFromOne(unknown, our_numbers)) {
      note += "; does it count from 1 where the images count from 0?";
    }
    result_.notes.push_back(note);
  }

  /// One is left over behind the last of ours, and our first has none.
  bool SeemsToCountFromOne(const std::vector<std::size_t>& unknown,
                           const std::vector<std::string>& our_numbers) const {
    return unknown.size() == 1 && our_numbers.front() == "0" && !result_.image_of.front() &&
           LastNumberOf(their_stems_[unknown[0]]) == std::to_string(our_numbers.size());
  }

  const std::string& path_;
  const std::vector<ForeignImage>& theirs_;
  const std::vector<std::string>& our_names_;
  std::vector<std::string> our_stems_;
  std::vector<std::string> their_stems_;
  KeypointMatching result_;
};

}  // namespace

KeypointMatching MatchKeypoints(const std::string& path, const std::vector<ForeignImage>& theirs,
                                const std::vector<std::string>& ours) {
  if (ours.empty()) return {};
  return Matcher(path, theirs, ours).Match();
}

}  // namespace airdos
