#ifndef AIRDOS_COMMON_CALIBRATION_CALIBRATION_YAML_H_
#define AIRDOS_COMMON_CALIBRATION_CALIBRATION_YAML_H_

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace airdos {

/// A map of a YAML file that others wrote: Kalibr's, ROS', OpenCV's with its own head and matrices.
/// Each reading function throws InputError naming file, key and value.
class CalibrationYaml {
 public:
  /// Takes OpenCV's dialect as well ("%YAML:1.0", "data:[1, 2]"). `path` stands for the file in
  /// messages. Throws InputError where the text is no YAML, or no map.
  static CalibrationYaml Parse(const std::string& text, const std::string& path);

  bool Has(const std::string& key) const;
  /// The map below a key.
  CalibrationYaml Section(const std::string& key) const;
  std::string Text(const std::string& key) const;
  double Number(const std::string& key) const;
  /// All numbers below a key in the order of the file: a list, a list of lists, an OpenCV matrix
  /// (rows, cols, data), or a single number.
  std::vector<double> Numbers(const std::string& key) const;
  /// The same; there must be exactly `count`.
  std::vector<double> Numbers(const std::string& key, std::size_t count) const;
  Eigen::Matrix3d Matrix3(const std::string& key) const;
  /// A rigid transform of 12 or 16 numbers, row major.
  Eigen::Matrix4d Transform(const std::string& key) const;

  /// "FILE: key 'cam0.intrinsics'", the beginning of messages.
  std::string Where(const std::string& key) const;
  const std::string& path() const { return path_; }

 private:
  CalibrationYaml(std::string path, std::string prefix, const YAML::Node& node)
      : path_(std::move(path)), prefix_(std::move(prefix)), node_(node) {}
  YAML::Node At(const std::string& key) const;

  std::string path_;
  std::string prefix_;  // of keys, for messages
  YAML::Node node_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CALIBRATION_YAML_H_
