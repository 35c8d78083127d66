#include "common/dataset/image_names.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "common/dataset/file_name.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& ImageEndings() {
  static const std::vector<std::string> endings = {".png", ".jpg", ".jpeg"};
  return endings;
}

std::vector<std::string> TakeHidden(std::vector<std::string>* names) {
  const auto first = std::stable_partition(names->begin(), names->end(),
                                           [](const std::string& n) { return !IsHidden(n); });
  std::vector<std::string> hidden(first, names->end());
  names->erase(first, names->end());
  return hidden;
}

[[noreturn]] void FailWithoutImages(const std::string& folder) {
  std::vector<std::string> others = ListFiles(folder, {});
  TakeHidden(&others);
  std::string what = ": holds no .png or .jpg image";
  if (!others.empty()) {
    what += ", but " + CountByEnding(others) + ": convert images to .png";
  }
  throw InputError(folder + what);
}

/// Refuses two series of similar size: it is unknown which one is meant.
void CheckIsOneSeries(const std::string& folder, const std::vector<NameSeries>& series) {
  if (series.size() < 2) return;
  const NameSeries& first = series[0];
  const NameSeries& second = series[1];
  const std::string names = "'" + first.names[0].name + "' and '" + second.names[0].name + "'";
  std::size_t num_names = 0;
  for (const NameSeries& one : series) num_names += one.names.size();
  if (series.size() > 2 && 2 * first.names.size() < num_names) {
    throw InputError(folder + ": its images cannot be ordered: their names, such as " + names +
                     ", have no common pattern; rename them to 000000.png, 000001.png, ...");
  }
  const bool is_rival = second.names.size() > 1 && 4 * second.names.size() >= first.names.size();
  const bool are_two = first.names.size() == 1 && !second.names[0].numbers.empty();
  if (is_rival || are_two) {
    throw InputError(folder + ": contains images with two kinds of names, " + names + " (" +
                     std::to_string(first.names.size()) + " and " +
                     std::to_string(second.names.size()) +
                     "): remove those that do not belong to this sequence");
  }
}

/// The names without numbers, each with its own pattern, in lexicographic order.
NameSeries Unnumbered(const std::vector<std::string>& names) {
  NameSeries series;
  for (const std::string& name : names) series.names.push_back(TakeApart(name));
  return series;
}

void CheckAreUnique(const std::string& folder, const NameSeries& series) {
  std::map<std::string, std::string> seen;
  for (const FileName& name : series.names) {
    const auto [it, is_new] = seen.emplace(series.KeyOf(name), name.name);
    if (!is_new) {
      throw InputError(folder + ": two files for the same image, '" + it->second + "' and '" +
                       name.name + "': remove one of them");
    }
  }
}

std::vector<std::uint64_t> WholeNumbers(const std::vector<std::string>& keys, bool are_numbers) {
  constexpr std::size_t kMaxDigits = 19;                      // nanoseconds since 1970
  constexpr std::uint64_t kMaxNumber = 9000000000000000000U;  // fits into 64 bits with sign
  std::vector<std::uint64_t> numbers;
  for (const std::string& key : keys) {
    if (!are_numbers || key.size() > kMaxDigits || key.find('.') != std::string::npos) return {};
    numbers.push_back(std::strtoull(key.c_str(), nullptr, 10));
    if (numbers.back() > kMaxNumber) return {};
  }
  return numbers;
}

std::vector<std::string> WithoutPartner(const ImageNames& of, const ImageNames& in) {
  const std::set<std::string> keys(in.keys.begin(), in.keys.end());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < of.files.size(); ++i) {
    if (keys.count(of.keys[i]) == 0) names.push_back(of.files[i]);
  }
  return names;
}

double MedianStep(const std::vector<std::uint64_t>& numbers) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    steps.push_back(static_cast<double>(numbers[i] - numbers[i - 1]));
  }
  return Quantile(std::move(steps), 0.5);
}

struct Unit {
  const char* name;
  double per_second;
};
constexpr Unit kUnits[] = {{"s", 1}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}};

/// The unit in which integer numbers are times.
const Unit* UnitOf(const std::vector<std::uint64_t>& numbers) {
  constexpr double kYear2000_s = 946684800;
  constexpr double kYear2100_s = 4102444800;
  constexpr double kMinStep = 5000;  // nobody numbers images in such steps
  const double step = MedianStep(numbers);
  for (const Unit& unit : kUnits) {
    const double first_s = static_cast<double>(numbers[0]) / unit.per_second;
    const double step_s = step / unit.per_second;
    const double last_s = static_cast<double>(numbers.back()) / unit.per_second;
    const bool is_date = first_s > kYear2000_s && last_s < kYear2100_s && step_s < 60;
    const bool is_camera = step >= kMinStep && step_s >= 0.005 && step_s <= 1;
    if (numbers.size() > 1 && (is_date || is_camera)) return &unit;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> ListImageFiles(const std::string& folder) {
  return ListFiles(folder, ImageEndings());
}

ImageNames ListImages(const std::string& folder) {
  return OrderImages(folder, ListImageFiles(folder));
}

ImageNames OrderImages(const std::string& folder, std::vector<std::string> names) {
  ImageNames result;
  result.folder = folder;
  std::vector<std::string> strays = TakeHidden(&names);
  if (names.empty()) FailWithoutImages(folder);
  std::vector<NameSeries> groups = GroupNames(names);
  NameSeries series;
  if (groups[0].names[0].numbers.empty()) {
    series = Unnumbered(names);
    if (names.size() > 1) {
      result.notes.push_back(folder +
                             ": its names have no numbers: the images are used in "
                             "alphabetical order, from '" +
                             names.front() + "' to '" + names.back() + "'");
    }
  } else {
    CheckIsOneSeries(folder, groups);
    series = groups[0];
    for (std::size_t i = 1; i < groups.size(); ++i) {
      for (const FileName& name : groups[i].names) strays.push_back(name.name);
    }
  }
  CheckAreUnique(folder, series);
  for (const FileName& name : series.names) {
    result.files.push_back(name.name);
    result.keys.push_back(series.KeyOf(name));
  }
  result.numbers =
      WholeNumbers(result.keys, series.counting >= 0 && !series.names[0].numbers.empty());
  if (!strays.empty()) {
    result.notes.push_back(folder + ": " + FirstFew(strays) +
                           (strays.size() == 1 ? " is" : " are") +
                           " not named like the other images ('" + result.files[0] + "'): skipped");
  }
  return result;
}

void CheckPairs(const ImageNames& left, const ImageNames& right) {
  if (left.keys == right.keys) return;
  const std::string counts = right.folder + ": holds " + std::to_string(right.files.size()) +
                             " images, " + left.folder + " holds " +
                             std::to_string(left.files.size());
  const std::vector<std::string> left_alone = WithoutPartner(left, right);
  const std::vector<std::string> right_alone = WithoutPartner(right, left);
  std::string alone;
  if (!left_alone.empty()) alone += "; only on the left: " + FirstFew(left_alone);
  if (!right_alone.empty()) alone += "; only on the right: " + FirstFew(right_alone);
  if (left.files.size() == right.files.size() && TimesFromNames(left) && TimesFromNames(right)) {
    alone += "; the names are times of each camera: give both images of a pair the same name";
  }
  throw InputError(counts + ", and not all have a partner with the same number" + alone +
                   "; remove these or add their partners");
}

std::vector<std::string> FindPartners(const std::string& folder, const std::string& ending,
                                      const ImageNames& left, const ImageNames& right) {
  std::vector<std::string> partners(left.files.size());
  if (!fs::is_directory(folder)) return partners;
  std::vector<std::string> names = ListFiles(folder, {ending});
  TakeHidden(&names);
  const std::set<std::string> exact(names.begin(), names.end());
  std::map<std::string, std::string> by_number;
  const std::vector<NameSeries> groups = GroupNames(names);
  if (groups.size() == 1 && groups[0].counting >= 0) {
    for (const FileName& name : groups[0].names) {
      by_number.emplace(groups[0].KeyOf(name), name.name);
    }
  }
  for (std::size_t i = 0; i < partners.size(); ++i) {
    const std::string of_left = fs::path(left.files[i]).stem().string() + ending;
    const std::string of_right = fs::path(right.files[i]).stem().string() + ending;
    const auto of_number = by_number.find(left.keys[i]);
    if (exact.count(of_left) != 0) {
      partners[i] = of_left;
    } else if (exact.count(of_right) != 0) {
      partners[i] = of_right;
    } else if (!left.numbers.empty() && of_number != by_number.end()) {
      partners[i] = of_number->second;
    }
  }
  return partners;
}

bool HoldsImages(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    const std::vector<std::string>& endings = ImageEndings();
    if (!IsHidden(name) &&
        std::find(endings.begin(), endings.end(), EndingOf(name)) != endings.end()) {
      return true;
    }
  }
  return false;
}

std::optional<NamedTimes> TimesFromNames(const ImageNames& names) {
  NamedTimes times;
  if (!names.numbers.empty()) {
    const Unit* const unit = UnitOf(names.numbers);
    if (unit == nullptr) return std::nullopt;
    times.unit = unit->name;
    for (const std::uint64_t number : names.numbers) {
      // Exact: nanoseconds since 1970 have more digits than a double can hold.
      const auto value = static_cast<std::int64_t>(number);
      times.utimes.push_back(unit->per_second == 1e9
                                 ? (value + 500) / 1000
                                 : value * static_cast<std::int64_t>(1e6 / unit->per_second));
    }
    return times;
  }
  times.unit = "s";
  std::vector<std::uint64_t> utimes;
  for (const std::string& key : names.keys) {
    std::int64_t utime = 0;
    if (key.find('.') == std::string::npos || !ParseMicroseconds(key, &utime)) return std::nullopt;
    if (!times.utimes.empty() && utime <= times.utimes.back()) return std::nullopt;
    times.utimes.push_back(utime);
    utimes.push_back(static_cast<std::uint64_t>(utime));
  }
  const double step_us = MedianStep(utimes);
  if (step_us < 5e3 || step_us > 60e6) return std::nullopt;
  return times;
}

}  // namespace airdos
