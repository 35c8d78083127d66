#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <system_error>

#include "common/calibration/rig_formats.h"
#include "common/util/error.h"

namespace airdos {
namespace {

struct Resolution {
  const char* name;
  int width;  // px, of one image
  int height;
};

constexpr Resolution kResolutions[] = {{"2K", 2208, 1242},      {"FHD", 1920, 1080},
                                       {"FHD1200", 1920, 1200}, {"HD", 1280, 720},
                                       {"SVGA", 960, 600},      {"VGA", 672, 376}};

/// The file's "key=value" lines as "SECTION.key", in capitals.
class ZedValues {
 public:
  explicit ZedValues(const CalibrationText& file) : path_(file.path) {
    std::istringstream lines(file.text);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
      while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0)
        line.pop_back();
      if (line.size() > 2 && line.front() == '[' && line.back() == ']') {
        section = line.substr(1, line.size() - 2);
      } else if (const std::size_t equals = line.find('='); equals != std::string::npos) {
        values_[Capitals(section + "." + line.substr(0, equals))] = line.substr(equals + 1);
      }
    }
  }
  bool Has(const std::string& key) const { return values_.count(Capitals(key)) > 0; }
  double Number(const std::string& key) const {
    const auto value = values_.find(Capitals(key));
    const std::string where = path_ + ": key '" + key + "'";
    if (value == values_.end()) throw InputError(where + " is missing");
    const std::string& text = value->second;
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
      throw InputError(where + " with value '" + text + "': is no finite number");
    }
    return number;
  }
  double NumberOr(const std::string& key, double otherwise) const {
    return Has(key) ? Number(key) : otherwise;
  }
  const std::string& path() const { return path_; }

 private:
  static std::string Capitals(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
  }
  std::string path_;
  std::map<std::string, std::string> values_;
};

/// The section for the images' size.
Resolution Choose(const ZedValues& values, std::pair<int, int> image_size) {
  std::string there;
  for (const Resolution& resolution : kResolutions) {
    const std::string name = resolution.name;
    if (!values.Has("LEFT_CAM_" + name + ".fx")) continue;
    if (image_size == std::make_pair(resolution.width, resolution.height)) return resolution;
    there += (there.empty() ? "" : ", ") + std::to_string(resolution.width) + "x" +
             std::to_string(resolution.height);
  }
  if (image_size.first == 0) {
    throw InputError(values.path() + ": is for images of " + there +
                     " px: say which with --size WIDTHxHEIGHT");
  }
  throw InputError(values.path() + ": is for images of " + there + " px, not of " +
                   std::to_string(image_size.first) + "x" + std::to_string(image_size.second) +
                   " px");
}

CameraIntrinsics ReadCamera(const ZedValues& values, const std::string& section,
                            const Resolution& resolution) {
  CameraIntrinsics camera;
  camera.width = resolution.width;
  camera.height = resolution.height;
  camera.fx_px = values.Number(section + ".fx");
  camera.fy_px = values.Number(section + ".fy");
  camera.cx_px = values.Number(section + ".cx");
  camera.cy_px = values.Number(section + ".cy");
  camera.lens = LensModel::kRadialTangential;
  camera.distortion = {values.Number(section + ".k1"), values.Number(section + ".k2"),
                       values.NumberOr(section + ".p1", 0), values.NumberOr(section + ".p2", 0),
                       values.NumberOr(section + ".k3", 0)};
  if (values.NumberOr(section + ".k4", 0) != 0) {
    throw InputError(values.path() + ": key '" + section +
                     ".k4': this is another lens model, which is not supported");
  }
  return camera;
}

}  // namespace

bool IsZed(const CalibrationText& file) {
  return file.text.find("[LEFT_CAM_") != std::string::npos &&
         file.text.find("[STEREO]") != std::string::npos;
}

StereoRig ReadZed(const CalibrationText& file, const FormatOptions& options) {
  const ZedValues values(file);
  const Resolution resolution = Choose(values, options.chosen_size());
  const std::string name = resolution.name;
  const auto stereo = [&](const std::string& key) {
    return values.Has("STEREO." + key + "_" + name) ? values.Number("STEREO." + key + "_" + name)
                                                    : values.NumberOr("STEREO." + key, 0);
  };
  StereoRig rig;
  rig.format = "ZED factory calibration (" + name + ")";
  rig.left = ReadCamera(values, "LEFT_CAM_" + name, resolution);
  rig.right = ReadCamera(values, "RIGHT_CAM_" + name, resolution);
  // As the maker's own tools rectify: p_R = R p_L + t, R of the rotation vector (RX, CV, RZ), the
  // translation in mm and from the right camera to the left one.
  constexpr double kMetresPerMillimetre = 1e-3;
  Se3 T_R_L;
  T_R_L.rotation = ExpSo3({stereo("RX"), stereo("CV"), stereo("RZ")});
  T_R_L.translation = -kMetresPerMillimetre *
                      Eigen::Vector3d(values.Number("STEREO.Baseline"), stereo("TY"), stereo("TZ"));
  rig.T_L_R = T_R_L.inverse();
  rig.notes.push_back("Baseline is read in mm, as ZED files have it");
  return rig;
}

}  // namespace airdos
