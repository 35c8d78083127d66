#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_IMAGE_PACKER_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_IMAGE_PACKER_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "common/dataset/image_file.h"

namespace airdos {

/// How images are encoded, and how large their messages may be.
struct ImagePackerOptions {
  /// When an image file is re-encoded.
  enum class Encoding {
    kAuto,  ///< a file that fits travels unchanged; any other becomes a JPEG
    kJpeg,  ///< always JPEG; a JPEG file that fits travels unchanged
    kPng,   ///< always lossless, whatever the size
  };
  Encoding encoding = Encoding::kAuto;
  int max_image_bytes = 120000;
  std::vector<int> jpeg_qualities = {95, 92, 90, 85, 80, 70, 60, 50, 40, 30};  ///< tried in order
};

/// Packs image files into messages, each small enough to travel without loss.
class ImagePacker {
 public:
  explicit ImagePacker(const ImagePackerOptions& options) : options_(options) {}

  /// Sets how 16-bit pictures become 8 bits; they cannot be packed before this is set.
  void SetSixteenBitRange(const SixteenBitRange& range) { range_ = range; }

  /// `file` is a whole JPEG or PNG file, `name` identifies it in errors. Sets size, encoding and
  /// data. Throws InputError if the file cannot be decoded (DecodePicture()) or if no quality makes
  /// it fit.
  void Pack(const std::vector<std::uint8_t>& file, const std::string& name, image_t* message);

  /// The same for pixels, CV_8UC1 or CV_8UC3 (BGR). kAuto: PNG where it fits, as a file of these
  /// pixels would travel.
  void Pack(const cv::Mat& pixels, const std::string& name, image_t* message);

  /// What the user should know about the images packed so far, one line each; each returned once.
  std::vector<std::string> TakeNotes();

 private:
  /// Only the first note of each kind is kept.
  void Note(const std::string& kind, const std::string& note);
  void NoteLarge();
  void NotePixels(const ImageHeader& header, const Picture& picture, const std::string& name);
  bool PackUnchanged(const std::vector<std::uint8_t>& file, image_t* message);
  bool PackSmall(const cv::Mat& pixels, image_t* message);
  void PackDecoded(const cv::Mat& pixels, const std::string& name, image_t* message);
  void PackPng(const cv::Mat& image, image_t* message);
  bool PackJpeg(const cv::Mat& image, image_t* message);  ///< false if none fits

  ImagePackerOptions options_;
  SixteenBitRange range_;
  std::vector<std::string> notes_;
  std::set<std::string> said_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_IMAGE_PACKER_H_
