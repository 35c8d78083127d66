// A camera driver: publishes a folder of rectified pictures as a live stereo camera would. Take it
// as a start for a real one.
//
// Usage: camera_driver FOLDER [--rate HZ] [--detector]
//   FOLDER      image_0/ and image_1/, left and right pictures (8-bit PNG or JPEG) of the same
//   names, in order of their names;
//               calib.txt, as KITTI has it: lines P0: and P1: of 12 numbers, P0 with fx, cx, fy,
//               cy, P1 with -fx * baseline in m
//   --rate HZ   pictures a second (default 10)
//   --detector  a detector of people is running, and publishes what it sees; without it there is
//   nobody, and this is said
//
// The rules that it keeps are in docs/clients.md, "A camera driver in ten lines". The LCM URL is
// LCM_DEFAULT_URL, or LCM's default.

#include <airdos/channels.h>

#include <airdos/image_t.hpp>
#include <airdos/person_keypoints_t.hpp>
#include <airdos/person_mask_t.hpp>
#include <airdos/stereo_calibration_t.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <lcm/lcm-cpp.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
namespace channel = airdos::channel;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kMaxBytes = 128000;  // above it, receivers on a stock kernel lose messages

Bytes Read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.empty()) throw std::runtime_error(path.string() + ": cannot be read, or is empty");
  return bytes;
}

// Width and height in px, from the header of a PNG or JPEG file.
std::pair<int, int> SizeOf(const Bytes& file, const fs::path& path) {
  const auto big_endian = [&](std::size_t place) { return file[place] << 8 | file[place + 1]; };
  if (file.size() > 24 && file[0] == 0x89) return {big_endian(18), big_endian(22)};
  // JPEG: segments 0xFF, kind, length; the size is in a start of frame.
  for (std::size_t place = 2; place + 9 < file.size();
       place += 2 + static_cast<std::size_t>(big_endian(place + 2))) {
    const int kind = file[place + 1];
    const bool is_start_of_frame =
        kind >= 0xC0 && kind <= 0xCF && kind != 0xC4 && kind != 0xC8 && kind != 0xCC;
    if (file[place] != 0xFF) break;
    if (is_start_of_frame) return {big_endian(place + 7), big_endian(place + 5)};
  }
  throw std::runtime_error(path.string() + ": neither PNG nor JPEG");
}

airdos::stereo_calibration_t ReadCalibration(const fs::path& path) {
  std::array<std::array<double, 12>, 2> projections = {};
  int num_found = 0;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (name != "P0:" && name != "P1:") continue;
    for (double& number : projections[name == "P1:"]) words >> number;
    if (words) ++num_found;
  }
  if (num_found != 2)
    throw std::runtime_error(path.string() + ": no lines P0: and P1: of 12 numbers");
  airdos::stereo_calibration_t calibration = {};
  calibration.fx_px = projections[0][0];
  calibration.cx_px = projections[0][2];
  calibration.fy_px = projections[0][5];
  calibration.cy_px = projections[0][6];
  calibration.baseline_m = -projections[1][3] / projections[1][0];
  return calibration;
}

class Driver {
 public:
  Driver(fs::path folder, bool has_detector)
      : folder_(std::move(folder)), has_detector_(has_detector) {
    if (!lcm_.good()) throw std::runtime_error("LCM cannot be used");
    calibration_ = ReadCalibration(folder_ / "calib.txt");
    for (const auto& entry : fs::directory_iterator(folder_ / "image_0")) {
      if (fs::exists(folder_ / "image_1" / entry.path().filename()))
        names_.push_back(entry.path().filename());
    }
    std::sort(names_.begin(), names_.end());
    if (names_.empty())
      throw std::runtime_error(folder_.string() +
                               ": no pictures of the same name in image_0 and image_1");
    // Another number than any before: after a restart the pictures are counted from 0 again, which
    // is a new session.
    session_ = std::chrono::duration_cast<std::chrono::microseconds>(
                   std::chrono::system_clock::now().time_since_epoch())
                   .count();
  }

  void Run(double rate_hz) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      std::this_thread::sleep_until(
          start + std::chrono::duration<double>(static_cast<double>(i) / rate_hz));
      seq_ = static_cast<std::int64_t>(i);  // a counter: one more with each pair
      utime_ = static_cast<std::int64_t>(1e6 * static_cast<double>(i) /
                                         rate_hz);  // when it was taken; here since the start
      const airdos::image_t left = Image("image_0", names_[i]);
      PublishCalibration(left);
      Publish(channel::kCameraLeft, left);
      Publish(channel::kCameraRight, Image("image_1", names_[i]));
      if (!has_detector_) PublishNobody(left);
    }
    std::printf("published %zu pairs as session %lld\n", names_.size(),
                static_cast<long long>(session_));
  }

 private:
  template <class Message>
  Message Make() const {
    Message message = {};
    message.utime = utime_;
    message.seq = seq_;
    message.session = session_;
    return message;
  }

  template <class Message>
  void Publish(const char* channel, const Message& message) {
    if (lcm_.publish(channel, &message) != 0)
      throw std::runtime_error(std::string("cannot publish on ") + channel);
  }

  airdos::image_t Image(const char* camera, const fs::path& name) {
    const fs::path path = folder_ / camera / name;
    auto image = Make<airdos::image_t>();
    image.data = Read(path);
    if (image.data.size() > kMaxBytes && !std::exchange(has_warned_, true)) {
      std::fprintf(stderr, "%s: %zu bytes; messages above 128 kB may be lost: JPEG is smaller\n",
                   path.c_str(), image.data.size());
    }
    std::tie(image.width, image.height) = SizeOf(image.data, path);
    image.num_bytes = static_cast<std::int32_t>(image.data.size());
    image.encoding =
        image.data[0] == 0x89 ? airdos::image_t::ENCODING_PNG : airdos::image_t::ENCODING_JPEG;
    return image;
  }

  // Before the first picture, and then once a second, for whoever comes later.
  void PublishCalibration(const airdos::image_t& left) {
    if (seq_ > 0 && utime_ < next_calibration_utime_) return;
    next_calibration_utime_ = utime_ + 1000000;
    calibration_.utime = utime_;
    calibration_.seq = seq_;
    calibration_.session = session_;
    calibration_.width = left.width;
    calibration_.height = left.height;
    Publish(channel::kCalibration, calibration_);
  }

  // So that nobody waits for a detector: an empty message for each picture.
  void PublishNobody(const airdos::image_t& left) {
    auto nobody = Make<airdos::person_keypoints_t>();
    nobody.layout = airdos::person_keypoints_t::LAYOUT_COCO18;
    Publish(channel::kPersonKeypointsLeft, nobody);
    Publish(channel::kPersonKeypointsRight, nobody);
    auto mask = Make<airdos::person_mask_t>();
    mask.encoding = airdos::person_mask_t::ENCODING_NONE;
    mask.width = left.width;
    mask.height = left.height;
    Publish(channel::kPersonMask, mask);
  }

  lcm::LCM lcm_;
  fs::path folder_;
  bool has_detector_;
  bool has_warned_ = false;
  std::vector<fs::path> names_;
  airdos::stereo_calibration_t calibration_ = {};
  std::int64_t session_ = 0;
  std::int64_t seq_ = 0;
  std::int64_t utime_ = 0;
  std::int64_t next_calibration_utime_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::string folder;
  double rate_hz = 10;
  bool has_detector = false, is_right = true;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--detector") {
      has_detector = true;
    } else if (argument == "--rate" && i + 1 < argc) {
      rate_hz = std::atof(argv[++i]);
    } else {
      is_right = is_right && folder.empty() && argument[0] != '-';
      folder = argument;
    }
  }
  if (!is_right || folder.empty() || !(rate_hz > 0)) {
    std::fprintf(stderr, "Usage: %s FOLDER [--rate HZ] [--detector]\n", argv[0]);
    return 2;
  }
  try {
    Driver(folder, has_detector).Run(rate_hz);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
  return 0;
}
