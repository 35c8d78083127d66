#ifndef AIRDOS_TESTS_SUPPORT_SCRATCH_FOLDER_H_
#define AIRDOS_TESTS_SUPPORT_SCRATCH_FOLDER_H_

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace airdos {

/// A test's own folder, initially empty and removed at the end.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("airdos_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string PathOf(const std::string& name) const { return (path_ / name).string(); }

  /// Writes a file, creating the folders above it; returns its path.
  std::string Write(const std::string& name, const std::string& content = "") const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return PathOf(name);
  }
  std::string WritePicture(const std::string& name, const cv::Mat& picture) const {
    std::vector<std::uint8_t> bytes;
    cv::imencode(std::filesystem::path(name).extension().string(), picture, bytes);
    return Write(name, std::string(bytes.begin(), bytes.end()));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SCRATCH_FOLDER_H_
