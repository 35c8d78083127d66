#ifndef AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SIZES_H_
#define AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SIZES_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "common/check/check_findings.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Checks whether the images and masks of a log have the sizes that their messages, the files in
/// them and the calibration state. Decodes nothing: files state their size in their first bytes.
class LogSizes {
 public:
  void Add(const std::string& channel, const image_t& message);
  void Add(const std::string& channel, const person_mask_t& message);
  void Report(const std::string& path, const std::optional<StereoCamera>& camera,
              FindingList* findings) const;

 private:
  /// Width and height of an image.
  struct Size {
    std::int64_t width = 0;   // px
    std::int64_t height = 0;  // px
    friend bool operator<(const Size& a, const Size& b) {
      return a.width != b.width ? a.width < b.width : a.height < b.height;
    }
    friend bool operator==(const Size& a, const Size& b) {
      return a.width == b.width && a.height == b.height;
    }
    std::string Text() const {
      return std::to_string(width) + " x " + std::to_string(height) + " px";
    }
    Size Exchanged() const { return {height, width}; }
  };
  struct Group {  // similar messages
    std::int64_t num = 0;
    std::int64_t first_seq = 0;
  };
  /// What was found on one channel.
  struct Channel {
    std::int64_t num = 0;
    Group unreadable;    // neither JPEG nor PNG, although the message says so
    Group contradicted;  // the file's size differs from the message's
    Size said;           // stated by the first of those; the next is its file's
    Size of_file;
    std::map<Size, Group> sizes;  // of the pictures themselves
  };

  template <class Message>
  void Take(const std::string& channel, const Message& message, bool is_file);
  void ReportSizes(const std::string& path, const std::string& name, const Channel& channel,
                   const std::optional<StereoCamera>& camera, FindingList* findings) const;

  std::map<std::string, Channel> channels_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_CHECK_LOG_SIZES_H_
