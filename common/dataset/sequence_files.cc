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
#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "common/util/image_header.h"
#include "common/util/input_file.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 32u << 20;  // of an image

[[noreturn]] void Fail(const std::string& path, int line, const std::string& why) {
  throw InputError(path + ":" + std::to_string(line) + ": " + why);
}

bool AllDigits(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Splits "12.5e-3" into its digits (125) and the number of digits before the decimal point (-1).
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
  RequireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);  // fails for anything but a regular file
  if (!file || error) throw InputError(path + ": cannot be read");
  if (size > kMaxFileBytes) {
    throw InputError(path + ": holds " + std::to_string(size) + " bytes, at most " +
                     std::to_string(kMaxFileBytes) + " are allowed");
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
    if (ReadImageHeader(bytes.data(), bytes.size()))  // before allocating what it claims
      image = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(path + ": cannot be decoded as an image");
  return {image.cols, image.rows};
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

std::vector<Se3> ReadKittiPoses(const std::string& path) {
  std::vector<Se3> poses;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::string separators = ExplainSeparators(line);
    if (!separators.empty()) Fail(path, line.number, "must hold 12 numbers (3 x 4)" + separators);
    const std::vector<double> m = ParseNumbers(path, line, 0);
    if (m.size() != 12) {
      const char* const rows_with_times =
          m.size() == 8 ? ": these are `t tx ty tz qx qy qz qw`, read in the layout with calib.json"
          : m.size() == 13 ? ": remove the first one, an image number or time"
                           : "";
      Fail(path, line.number,
           "must hold 12 numbers (3 x 4), holds " + std::to_string(m.size()) + rows_with_times);
    }
    Eigen::Matrix3d R;
    R << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    constexpr double kRoundingOfFiles = 1e-2;
    if (!(R * R.transpose()).isIdentity(kRoundingOfFiles) || R.determinant() < 0) {
      Fail(path, line.number, "columns 1-3, 5-7 and 9-11 are not a rotation");
    }
    poses.push_back({Eigen::Quaterniond(R).normalized(), {m[3], m[7], m[11]}});
  }
  return poses;
}

}  // namespace airdos
