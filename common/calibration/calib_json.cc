#include "common/calibration/calib_json.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "common/calibration/camera_causes.h"
#include "common/calibration/camera_matrix.h"
#include "common/util/error.h"
#include "common/util/input_file.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxJsonBytes = 100000;

/// "LINE" and "column COLUMN" of a byte.
std::pair<std::string, std::string> PlaceOf(const std::string& text, std::size_t byte) {
  const std::string before = text.substr(0, byte);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t last_end = before.rfind('\n');
  const std::size_t column = 1 + before.size() - (last_end == std::string::npos ? 0 : last_end + 1);
  return {std::to_string(line), "column " + std::to_string(column)};
}

/// The likely mistake at the byte where parsing stopped.
std::string ExplainJson(const std::string& text, std::size_t byte) {
  if (byte >= text.size()) return "the file ends before its last brace";
  const std::size_t last =
      byte == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", byte - 1);
  const char before = last == std::string::npos ? '\0' : text[last];
  switch (text[byte]) {
    case '#':
    case '/':
      return "JSON has no comments";
    case '}':
    case ']':
      if (before == ',') return "a comma before the closing brace";
      break;
    case '\'':
      return "JSON has double quotes, not single ones";
    case '%':
      return "this is YAML, not JSON";
    case '"':
      if (before != '{' && before != ',' && before != ':') return "a comma is missing before this";
      break;
    case '\0':
      return "this is UTF-16, not UTF-8";
    default:
      break;
  }
  if (static_cast<unsigned char>(text[byte]) >= 0xFE) return "this is UTF-16, not UTF-8";
  const unsigned char c = static_cast<unsigned char>(text[byte]);
  return c < 0x20 || c >= 0x7f
             ? "this is not JSON"
             : std::string("this is not JSON at the character '") + text[byte] + "'";
}

nlohmann::json ParseJson(const std::string& path) {
  const std::string text = ReadWholeFile(path, kMaxJsonBytes);
  try {
    nlohmann::json json = nlohmann::json::parse(text);
    if (!json.is_object()) {
      throw InputError(path + ": is not a JSON object; expected is " + kCalibJsonForm);
    }
    return json;
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    const auto [line, column] = PlaceOf(text, byte);
    throw InputError(path + ":" + line + ": " + column + ": " + ExplainJson(text, byte) +
                     "; expected is " + kCalibJsonForm);
  } catch (const nlohmann::json::exception&) {
    throw InputError(path + ": holds a number that is too large");
  }
}

const std::vector<std::string>& KnownKeys() {
  static const std::vector<std::string> keys = {"fx",         "fy",    "cx",    "cy",
                                                "baseline_m", "width", "height"};
  return keys;
}

std::string Plain(const std::string& key) {
  std::string plain;
  for (const char c : key) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalnum(code) != 0) plain += static_cast<char>(std::tolower(code));
  }
  return plain;
}

/// The key that a misspelt key stands for, or empty.
std::string MeantBy(const std::string& key) {
  static const std::map<std::string, std::string> kOthers = {{"baseline", "baseline_m"},
                                                             {"baselinemm", "baseline_m"},
                                                             {"b", "baseline_m"},
                                                             {"bf", "baseline_m"},
                                                             {"baselinecm", "baseline_m"},
                                                             {"tx", "baseline_m"},
                                                             {"focallengthx", "fx"},
                                                             {"focallengthy", "fy"},
                                                             {"focallength", "fx"},
                                                             {"focalx", "fx"},
                                                             {"focaly", "fy"},
                                                             {"f", "fx"},
                                                             {"focal", "fx"},
                                                             {"ppx", "cx"},
                                                             {"ppy", "cy"},
                                                             {"principalpointx", "cx"},
                                                             {"principalpointy", "cy"},
                                                             {"u0", "cx"},
                                                             {"v0", "cy"},
                                                             {"x0", "cx"},
                                                             {"y0", "cy"},
                                                             {"imagewidth", "width"},
                                                             {"imageheight", "height"},
                                                             {"w", "width"},
                                                             {"h", "height"},
                                                             {"cols", "width"},
                                                             {"rows", "height"}};
  const std::string plain = Plain(key);
  for (const std::string& known : KnownKeys()) {
    const std::string known_plain = Plain(known);
    if (plain == known_plain || plain == known_plain + "px" || plain == "camera" + known_plain) {
      return known;
    }
  }
  const auto other = kOthers.find(plain);
  return other == kOthers.end() ? "" : other->second;
}

/// "; did you mean 'baseline_m' by 'baseline'?" if there is a similar key; otherwise empty.
std::string DidYouMean(const nlohmann::json& json, const std::string& key) {
  for (const auto& item : json.items()) {
    if (item.key() != key && MeantBy(item.key()) == key) {
      return "; '" + item.key() + "' is there: it is spelt '" + key + "'";
    }
  }
  return "";
}

double ReadNumber(const nlohmann::json& json, const std::string& path, const std::string& key) {
  if (!json.contains(key)) {
    const std::string meant = DidYouMean(json, key);
    throw InputError(path + ": key '" + key + "' is missing" +
                     (meant.empty() ? std::string("; expected is ") + kCalibJsonForm : meant));
  }
  if (!json[key].is_number()) {
    // The value may be nested too deeply for dump().
    throw InputError(path + ": key '" + key + "' with a value of type " + json[key].type_name() +
                     ": must be a number" + (json[key].is_string() ? ", without quotes" : ""));
  }
  return json[key].get<double>();
}

void CheckSize(const nlohmann::json& json, const std::string& path, std::pair<int, int> size) {
  std::map<std::string, double> said;
  for (const char* key : {"width", "height"}) {
    if (json.contains(key)) {
      said[key] = ReadNumber(json, path, key);
    } else if (const std::string meant = DidYouMean(json, key); !meant.empty()) {
      throw InputError(path + ": " + meant.substr(2));
    }
  }
  for (const auto& [key, actual] : {std::make_pair("width", size.first), {"height", size.second}}) {
    if (said.count(key) == 0 || said[key] == actual) continue;
    std::string cause;
    if (said.size() == 2) {
      const double factor = said["width"] / size.first;
      if (said["width"] == size.second && said["height"] == size.first) {
        cause = "; width and height are exchanged";
      } else if (factor > 0 && std::abs(said["height"] / size.second / factor - 1) < 0.02) {
        cause = "; the camera was calibrated for images " + TimesAsLarge(factor) +
                ": divide all but baseline_m by the factor, or take the images as they were";
      }
    }
    throw InputError(path + ": key '" + key + "' with value '" + json[key].dump() +
                     "': the first image has " + std::to_string(actual) + " px" + cause);
  }
}

}  // namespace

std::pair<int, int> ReadCalibJsonSize(const std::string& path) {
  const nlohmann::json json = ParseJson(path);
  if (!json.contains("width") || !json.contains("height")) return {0, 0};
  return ToImageSize(ReadNumber(json, path, "width"), ReadNumber(json, path, "height"),
                     path + ": keys 'width' and 'height'");
}

StereoCamera ReadCalibJson(const std::string& path, std::pair<int, int> size) {
  const nlohmann::json json = ParseJson(path);
  StereoCamera camera;
  std::tie(camera.width, camera.height) = size;
  CheckSize(json, path, size);
  camera.fx_px = ReadNumber(json, path, "fx");
  camera.fy_px = ReadNumber(json, path, "fy");
  camera.cx_px = ReadNumber(json, path, "cx");
  camera.cy_px = ReadNumber(json, path, "cy");
  camera.baseline_m = ReadNumber(json, path, "baseline_m");
  if (!camera.IsValid()) {
    throw InputError(path + ": not a pinhole stereo camera for images of " +
                     std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                     " px: " + WhyNoCamera(camera));
  }
  return camera;
}

}  // namespace airdos
