#include "common/dataset/sequence_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "common/dataset/image_file.h"
#include "common/util/error.h"
#include "common/util/image_header.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 32u << 20;  // of an image

[[noreturn]] void Fail(const std::string& path, int line, const std::string& why) {
  throw InputError(path + ":" + std::to_string(line) + ": " + why);
}

/// The number that a file name starts with; names without one come last.
std::uint64_t LeadingNumber(const std::string& name) {
  constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) == 0) return kNone;
  return std::strtoull(name.c_str(), nullptr, 10);
}

bool IsImageName(const fs::path& name) {
  std::string extension = name.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

bool AllDigits(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Splits "12.5e-3" into its digits 125 and the number of them before the decimal point (-1).
bool SplitDecimal(std::string text, std::string* digits, int* num_integer_digits) {
  int exponent = 0;
  const std::size_t e = text.find_first_of("eE");
  if (e != std::string::npos) {
    std::string power = text.substr(e + 1);
    const bool is_negative = !power.empty() && power[0] == '-';
    if (!power.empty() && (power[0] == '-' || power[0] == '+')) power.erase(0, 1);
    if (power.empty() || power.size() > 3 || !AllDigits(power)) return false;
    exponent = (is_negative ? -1 : 1) * std::atoi(power.c_str());
    text.erase(e);
  }
  const std::size_t point = text.find('.');
  const std::string integer = text.substr(0, point);
  const std::string fraction = point == std::string::npos ? "" : text.substr(point + 1);
  *digits = integer + fraction;
  *num_integer_digits = static_cast<int>(integer.size()) + exponent;
  return !digits->empty() && digits->size() <= 100 && AllDigits(*digits);
}

}  // namespace

std::vector<std::uint8_t> ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);  // fails for what is no plain file
  if (!file || error) throw InputError(path + ": cannot be read");
  if (size > kMaxFileBytes) {
    throw InputError(path + ": holds " + std::to_string(size) + " bytes, at most " +
                     std::to_string(kMaxFileBytes) + " are read");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(file.gcount()) != size)
    throw InputError(path + ": cannot be read");
  return bytes;
}

std::vector<std::uint8_t> ReadImageFile(const std::string& path) {
  std::vector<std::uint8_t> bytes = ReadBytes(path);
  const std::string why = WhyNoPicture(bytes.data(), bytes.size());
  if (!why.empty()) throw InputError(path + ": " + why);
  return bytes;
}

std::pair<int, int> ReadImageSize(const std::string& path) {
  const std::vector<std::uint8_t> bytes = ReadImageFile(path);
  cv::Mat image;
  try {
    if (ReadImageHeader(bytes.data(), bytes.size()))  // before there is room for what it claims
      image = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(path + ": cannot be decoded as an image");
  return {image.cols, image.rows};
}

std::vector<std::string> ListImages(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsImageName(it->path())) names.push_back(it->path().filename().string());
  }
  if (error) throw InputError(folder + ": " + error.message());
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return std::make_pair(LeadingNumber(a), a) < std::make_pair(LeadingNumber(b), b);
  });
  return names;
}

bool ParseMicroseconds(const std::string& seconds, std::int64_t* utime) {
  const bool is_negative = !seconds.empty() && seconds[0] == '-';
  const bool is_signed = is_negative || (!seconds.empty() && seconds[0] == '+');
  std::string digits;
  int num_integer_digits = 0;
  if (!SplitDecimal(seconds.substr(is_signed ? 1 : 0), &digits, &num_integer_digits)) return false;

  const int num_kept = num_integer_digits + 6;
  const auto digit = [&](int i) {
    return i >= 0 && i < static_cast<int>(digits.size()) ? digits[static_cast<std::size_t>(i)] - '0'
                                                         : 0;
  };
  constexpr std::int64_t kLimit = std::numeric_limits<std::int64_t>::max() / 100;
  std::int64_t value = 0;
  for (int i = 0; i < num_kept; ++i) {
    if (value > kLimit) return false;
    value = 10 * value + digit(i);
  }
  if (num_kept >= 0 && digit(num_kept) >= 5) ++value;
  *utime = is_negative ? -value : value;
  return true;
}

std::vector<std::int64_t> ReadTimes(const std::string& path) {
  std::vector<std::int64_t> times;
  for (const TextLine& line : ReadTextLines(path)) {
    std::int64_t utime = 0;
    if (line.words.size() != 1 || !ParseMicroseconds(line.words[0], &utime)) {
      Fail(path, line.number, "must hold one time in s, holds '" + line.words[0] + "' ...");
    }
    if (!times.empty() && utime <= times.back()) {
      Fail(path, line.number, "time '" + line.words[0] + "' does not come after the one before");
    }
    times.push_back(utime);
  }
  return times;
}

std::vector<PersonKeypoints> ReadRawKeypoints(const std::string& path) {
  std::vector<PersonKeypoints> people;
  if (!fs::exists(path)) return people;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> numbers = ParseNumbers(path, line, 0);
    PersonKeypoints person;
    if (numbers.size() != 3 * person.size()) {
      Fail(path, line.number,
           "must hold 54 numbers (18 x u v confidence), holds " + std::to_string(numbers.size()));
    }
    for (std::size_t j = 0; j < person.size(); ++j) {
      person[j] = {static_cast<float>(numbers[3 * j]), static_cast<float>(numbers[3 * j + 1]),
                   static_cast<float>(numbers[3 * j + 2])};
    }
    people.push_back(person);
  }
  return people;
}

std::vector<PersonKeypoints> ReadKeypoints(const std::string& path) {
  std::vector<PersonKeypoints> people = ReadRawKeypoints(path);
  for (PersonKeypoints& person : people) {
    for (Keypoint& keypoint : person)
      keypoint.confidence = std::clamp(keypoint.confidence, 0.F, 1.F);
  }
  return people;
}

std::vector<Se3> ReadKittiPoses(const std::string& path) {
  std::vector<Se3> poses;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> m = ParseNumbers(path, line, 0);
    if (m.size() != 12) {
      Fail(path, line.number, "must hold 12 numbers (3 x 4), holds " + std::to_string(m.size()));
    }
    Eigen::Matrix3d R;
    R << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    constexpr double kRoundingOfFiles = 1e-2;
    if (!(R * R.transpose()).isIdentity(kRoundingOfFiles) || R.determinant() < 0) {
      Fail(path, line.number, "columns 1-3, 5-7 and 9-11 are no rotation");
    }
    poses.push_back({Eigen::Quaterniond(R).normalized(), {m[3], m[7], m[11]}});
  }
  return poses;
}

}  // namespace airdos
