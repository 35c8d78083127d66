#include "common/calibration/calibration_yaml.h"

#include <cctype>
#include <cmath>
#include <sstream>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxNumbers = 1000;
constexpr int kMaxDepth = 8;

/// Where a blank is missing after the key of a line ("data:[1, 2]", "PointSize:2"), which only
/// OpenCV's own reader takes.
std::size_t MissingBlank(const std::string& line) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string::npos) return std::string::npos;
  while (at < line.size() && (std::isalnum(static_cast<unsigned char>(line[at])) != 0 ||
                              line[at] == '_' || line[at] == '.')) {
    ++at;
  }
  const bool is_key = at + 1 < line.size() && line[at] == ':' && line[at + 1] != ' ';
  return is_key ? at + 1 : std::string::npos;
}

/// OpenCV's YAML as others read it: without its head, and with a blank after each key.
std::string Plain(const std::string& text) {
  std::string plain;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.rfind("%YAML", 0) == 0) line.clear();
    const std::size_t at = MissingBlank(line);
    if (at != std::string::npos) line.insert(at, " ");
    plain += line + "\n";
  }
  return plain;
}

void Collect(const YAML::Node& node, const std::string& where, int depth,
             std::vector<double>* numbers) {
  if (depth > kMaxDepth) throw InputError(where + ": is nested too deeply");
  if (numbers->size() > kMaxNumbers) throw InputError(where + ": holds too many numbers");
  if (node.IsSequence()) {
    for (const YAML::Node& element : node) Collect(element, where, depth + 1, numbers);
    return;
  }
  if (node.IsMap() && node["data"]) return Collect(node["data"], where, depth + 1, numbers);
  double number = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, number) || !std::isfinite(number)) {
    throw InputError(where + (node.IsScalar() ? " with value '" + node.Scalar() + "'" : "") +
                     ": must hold finite numbers only");
  }
  numbers->push_back(number);
}

}  // namespace

CalibrationYaml CalibrationYaml::Parse(const std::string& text, const std::string& path) {
  try {
    YAML::Node root = YAML::Load(Plain(text));
    if (!root.IsMap()) throw InputError(path + ": is no YAML file of keys and values");
    return CalibrationYaml(path, "", root);
  } catch (const YAML::Exception& error) {
    throw InputError(path + ": line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

YAML::Node CalibrationYaml::At(const std::string& key) const {
  // Only of a const node is a missing key not made.
  const YAML::Node& node = node_;
  YAML::Node value = node[key];
  if (!value.IsDefined() || value.IsNull()) throw InputError(Where(key) + " is missing");
  return value;
}

std::string CalibrationYaml::Where(const std::string& key) const {
  return path_ + ": key '" + prefix_ + key + "'";
}

bool CalibrationYaml::Has(const std::string& key) const {
  const YAML::Node& node = node_;
  return node[key].IsDefined() && !node[key].IsNull();
}

CalibrationYaml CalibrationYaml::Section(const std::string& key) const {
  YAML::Node section = At(key);
  if (!section.IsMap()) throw InputError(Where(key) + " must be a section");
  return CalibrationYaml(path_, prefix_ + key + ".", section);
}

std::string CalibrationYaml::Text(const std::string& key) const {
  const YAML::Node value = At(key);
  if (!value.IsScalar()) throw InputError(Where(key) + " must be one word");
  return value.Scalar();
}

double CalibrationYaml::Number(const std::string& key) const { return Numbers(key, 1).front(); }

std::vector<double> CalibrationYaml::Numbers(const std::string& key) const {
  std::vector<double> numbers;
  Collect(At(key), Where(key), 0, &numbers);
  return numbers;
}

std::vector<double> CalibrationYaml::Numbers(const std::string& key, std::size_t count) const {
  std::vector<double> numbers = Numbers(key);
  if (numbers.size() != count) {
    throw InputError(Where(key) + " must hold " + std::to_string(count) + " number" +
                     (count == 1 ? "" : "s") + ", holds " + std::to_string(numbers.size()));
  }
  return numbers;
}

Eigen::Matrix3d CalibrationYaml::Matrix3(const std::string& key) const {
  const std::vector<double> numbers = Numbers(key, 9);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

Eigen::Matrix4d CalibrationYaml::Transform(const std::string& key) const {
  const std::vector<double> numbers = Numbers(key);
  if (numbers.size() != 12 && numbers.size() != 16) {
    throw InputError(Where(key) + " must hold 3 x 4 or 4 x 4 numbers, holds " +
                     std::to_string(numbers.size()));
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
  return matrix;
}

}  // namespace airdos
