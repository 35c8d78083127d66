#include "common/dataset/image_rows.h"

#include <numeric>

#include "common/util/error.h"

namespace airdos {
namespace {

std::vector<std::size_t> OneAfterTheOther(std::size_t num_rows) {
  std::vector<std::size_t> rows(num_rows);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

}  // namespace

std::string GapsOf(const std::vector<std::uint64_t>& numbers) {
  if (numbers.empty()) return "";
  const std::uint64_t num_missing = numbers.back() - numbers.front() + 1 - numbers.size();
  if (num_missing == 0) return "";
  std::size_t i = 1;
  while (numbers[i] == numbers[i - 1] + 1) ++i;
  const std::string first = std::to_string(numbers[i - 1] + 1);
  if (num_missing == 1) return first + " is missing";
  return first + " and " + std::to_string(num_missing - 1) + " more are missing";
}

std::vector<std::size_t> RowsOfImages(const std::string& path, const std::string& what,
                                      std::size_t num_rows, const ImageNames& images,
                                      std::vector<std::string>* notes) {
  const std::size_t num_images = images.files.size();
  const std::vector<std::uint64_t>& numbers = images.numbers;
  const std::string counts = path + ": holds " + std::to_string(num_rows) + " " + what + " for " +
                             std::to_string(num_images) + " images";
  if (num_rows == num_images) {
    const std::string gaps = numbers.empty() ? "" : GapsOf(numbers);
    if (!gaps.empty() && !TimesFromNames(images)) {
      notes->push_back(counts + " with gaps in their numbers (" + gaps + "): used in order");
    }
    return OneAfterTheOther(num_rows);
  }
  const std::string range =
      " '" + images.files.front() + "' .. '" + images.files.back() + "' in " + images.folder;
  if (num_rows < num_images) {
    throw InputError(counts + range + ": '" + images.files[num_rows] +
                     "' and those after it have none; one row per image is expected");
  }
  const bool is_from_zero = !numbers.empty() && numbers.back() < num_rows;
  const bool is_from_one = !numbers.empty() && numbers.front() > 0 && numbers.back() == num_rows;
  if (!is_from_zero && !is_from_one) {
    throw InputError(counts + range + ", whose names do not tell which row belongs to which: the " +
                     "first row and '" + images.files.front() + "' may be of different images; " +
                     "one row per image is expected");
  }
  const std::size_t base = is_from_zero ? 0 : 1;
  std::vector<std::size_t> rows;
  for (const std::uint64_t number : numbers)
    rows.push_back(static_cast<std::size_t>(number) - base);
  const bool may_be_either = is_from_zero && numbers.front() == 1;
  notes->push_back(counts + ": by the numbers in the names, row " + std::to_string(rows[0] + 1) +
                   " is that of '" + images.files.front() + "' (numbers from " +
                   std::to_string(base) + (may_be_either ? "; they may be from 1" : "") + ")");
  return rows;
}

}  // namespace airdos
