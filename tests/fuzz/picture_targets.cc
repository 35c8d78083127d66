#include <zlib.h>

#include <opencv2/imgcodecs.hpp>

#include "common/calibration/calib_json.h"
#include "common/check/check_camera.h"
#include "common/check/check_jpeg.h"
#include "common/dataset/image_file.h"
#include "common/dataset/image_names.h"
#include "common/dataset/image_rows.h"
#include "common/dataset/mask_file.h"
#include "common/util/error.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/palette_png.h"

// Pictures as bytes, the names of their files, and what a user writes of the camera.

namespace airdos {
namespace {

namespace fs = std::filesystem;

FuzzBytes Encoded(const std::string& ending, const cv::Mat& picture,
                  const std::vector<int>& options = {}) {
  FuzzBytes bytes;
  cv::imencode(ending, picture, bytes, options);
  return bytes;
}

/// Gives each chunk of a PNG the check sum of its content: changed bytes would get no further.
void RepairChecksums(FuzzBytes* png) {
  constexpr std::size_t kFrame = 12;  // length, name and check sum around the content
  for (std::size_t at = 8; at + kFrame <= png->size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | (*png)[at + i];
    if (length > png->size() - at - kFrame) return;
    const auto sum =
        crc32(0, png->data() + at + 4, static_cast<unsigned>(length + 4)) & 0xFFFFFFFFu;
    for (std::size_t i = 0; i < 4; ++i) {
      (*png)[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    }
    at += kFrame + length;
  }
}

/// The bytes behind the first one, whose lowest bit says whether their check sums are repaired.
FuzzBytes PictureOf(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return {};
  FuzzBytes bytes(data + 1, data + size);
  if (data[0] % 2 == 1) RepairChecksums(&bytes);
  return bytes;
}

std::vector<FuzzBytes> WithFirstByte(std::vector<FuzzBytes> seeds) {
  for (FuzzBytes& seed : seeds) seed.insert(seed.begin(), 1);
  return seeds;
}

/// A ramp of greys or colours, or of numbers of 16 bits.
cv::Mat Ramp(int type) {
  cv::Mat ramp(6, 9, type);
  for (int row = 0; row < ramp.rows; ++row) {
    for (int i = 0; i < ramp.cols; ++i) {
      ramp(cv::Rect(i, row, 1, 1)).setTo(cv::Scalar(20 * row, 25 * i, 7 * row * i, 255));
    }
  }
  return ramp;
}

// --- masks
void RunMaskFile(const std::uint8_t* data, std::size_t size) {
  const FuzzBytes bytes = PictureOf(data, size);
  const std::optional<ImageHeader> header = ReadImageHeader(bytes.data(), bytes.size());
  try {
    const PersonMask mask = DecodePersonMask(bytes.data(), bytes.size(), "fuzz");
    FuzzCheck(mask.pixels.cols == header->width && mask.pixels.rows == header->height,
              "a mask is not as large as it says");
    FuzzCheck(cv::countNonZero(mask.pixels) == cv::countNonZero(mask.values),
              "a mask marks something else than its numbers");
    RippledShare(mask);
    const std::string path = FuzzFolder::Write("mask.png", bytes.data(), bytes.size());
    const FuzzBytes plain = ReadMaskFile(path, mask.pixels.cols, mask.pixels.rows);
    const PersonMask again = DecodePersonMask(plain.data(), plain.size(), "plain");
    FuzzCheck(cv::countNonZero(again.pixels != mask.pixels) == 0, "a mask changed on its way");
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> MaskSeeds() {
  const cv::Mat bits = Ramp(CV_8UC1) > 50;
  return WithFirstByte({Encoded(".png", Ramp(CV_8UC1)), Encoded(".png", Ramp(CV_16UC1)),
                        Encoded(".png", Ramp(CV_8UC3)), Encoded(".png", Ramp(CV_16UC3)),
                        Encoded(".png", Ramp(CV_8UC4)),
                        Encoded(".png", bits, {cv::IMWRITE_PNG_BILEVEL, 1}),
                        PalettePng({{0, 0, 0}, {200, 0, 0}, {0, 200, 0}}, 3, {0, 1, 2, 0, 0, 1}),
                        PalettePng({{0, 0, 0}, {200, 0, 0}, {0, 200, 0}}, 3, {0, 1, 2, 0, 0, 1},
                                   PNG_INTERLACE_ADAM7)});
}

// --- camera images
/// One file as a sequence of one frame.
class OneFile : public StereoSequence {
 public:
  explicit OneFile(std::string path) : path_(std::move(path)) {}
  const StereoCamera& camera() const override { return camera_; }
  std::size_t num_frames() const override { return 1; }
  TrajectoryAxes ground_truth_axes() const override { return TrajectoryAxes::kUnknown; }
  bool has_people() const override { return false; }
  SequenceFrame Load(std::size_t /*index*/) const override { return {}; }
  FrameFiles files(std::size_t /*index*/) const override { return {path_, path_, "", "", ""}; }

 private:
  std::string path_;
  StereoCamera camera_;
};

void RunImageFile(const std::uint8_t* data, std::size_t size) {
  const FuzzBytes bytes = PictureOf(data, size);
  const OneFile sequence(FuzzFolder::Write("image", bytes.data(), bytes.size()));
  for (const SurveyedImage& image : SurveyImages(sequence))
    FuzzCheck(image.header || !image.error.empty(), "an image without a header has no error");
  JpegQuality(bytes);
  try {
    const SixteenBitRange range = FindSixteenBitRange(sequence).value_or(SixteenBitRange());
    FuzzCheck(range.bits >= 0 && range.bits <= 16, "a range of more than 16 bits");
    for (const PictureColor color : {PictureColor::kGrey, PictureColor::kAsStored}) {
      const Picture picture = DecodePicture(bytes, "fuzz", color, range);
      const std::optional<ImageHeader> header = ReadImageHeader(bytes.data(), bytes.size());
      FuzzCheck(picture.pixels.cols == header->width && picture.pixels.rows == header->height,
                "an image is not as large as it says");
      FuzzCheck(picture.pixels.depth() == CV_8U, "an image of more than 8 bits");
    }
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> ImageSeeds() {
  return WithFirstByte({Encoded(".png", Ramp(CV_8UC1)), Encoded(".png", Ramp(CV_16UC1)),
                        Encoded(".png", Ramp(CV_8UC4)), Encoded(".jpg", Ramp(CV_8UC1)),
                        Encoded(".jpg", Ramp(CV_8UC3)),
                        Encoded(".jpg", Ramp(CV_8UC3), {cv::IMWRITE_JPEG_PROGRESSIVE, 1}),
                        PalettePng({{9, 8, 7}, {200, 0, 0}}, 2, {0, 1, 1, 0})});
}

// --- names
void UseNames(const std::string& root, std::size_t num_rows) {
  try {
    HoldsImages(root + "/left");
    const ImageNames left = ListImages(root + "/left");
    const ImageNames right = ListImages(root + "/right");
    FuzzCheck(left.keys.size() == left.files.size() &&
                  (left.numbers.empty() || left.numbers.size() == left.files.size()),
              "names and keys differ in number");
    const std::optional<NamedTimes> times = TimesFromNames(left);
    FuzzCheck(!times || times->utimes.size() == left.files.size(), "times and names differ");
    CheckPairs(left, right);
    FindPartners(root + "/left", ".png", left, right);
    std::vector<std::string> notes;
    for (const std::size_t row : RowsOfImages("fuzz", "rows", num_rows, left, &notes))
      FuzzCheck(row < num_rows, "an image has a row that is not there");
  } catch (const InputError&) {
  }
}

void RunImageNames(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const std::size_t num_rows = input.U8();
  const std::string root = FuzzFolder::Path() + "/names";
  FuzzFolder::MakeFiles("names/left", input.Block());
  FuzzFolder::MakeFiles("names/right", input.Block());
  UseNames(root, num_rows);
  fs::remove_all(root);
}

std::vector<FuzzBytes> ImageNameSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const char* names :
       {"000001.png\n000003.png\n", "left9.png\nleft10.png\nleft10 (1).png\n.hidden.png\n",
        "1403636579763555584.png\n1403636579813555584.png\n", "1.500.jpg\n1.600.JPG\n1.700.jpeg\n",
        "a.png\nb.png\n", "shot1of2.png\nshot2of2.png\nother7.png\n"}) {
    FuzzOutput seed;
    seed.U8(3);
    seed.Block(std::string(names));
    seed.Block(std::string(names));
    seeds.push_back(seed.Take());
  }
  return seeds;
}

// --- the camera
/// Two bytes of the images' size, then the file.
void RunCalibJson(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const int width = 1 + input.U8();
  const int height = 1 + input.U8();
  const FuzzBytes text = input.Block();
  const std::string path = FuzzFolder::Write("calib.json", text.data(), text.size());
  try {
    const StereoCamera camera = ReadCalibJson(path, {width, height});
    FuzzCheck(camera.IsValid() && camera.width == width && camera.height == height,
              "a camera that is none");
    FindingList findings;
    CheckCamera(camera, path, &findings);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> CalibJsonSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const char* text :
       {R"({"fx":90.5,"fy":91,"cx":64,"cy":48.5,"baseline_m":0.2,"width":128,"height":96})",
        R"({"fx":90.5,"fy":91,"cx":32,"cy":24,"baseline":200,"width":64,"height":48})",
        R"({"fx":90.5,"fy":91,"cx":48,"cy":64,"baseline_m":-0.2})", "fx: 3\n",
        R"({"fx":1e308,"fy":1e-308,"cx":"64",})"}) {
    FuzzOutput seed;
    seed.U8(127);
    seed.U8(95);
    seed.Block(std::string(text));
    seeds.push_back(seed.Take());
  }
  return seeds;
}

}  // namespace

std::vector<FuzzTarget> PictureTargets() {
  return {{"mask_file", RunMaskFile, MaskSeeds, 4096},
          {"image_file", RunImageFile, ImageSeeds, 4096},
          {"image_names", RunImageNames, ImageNameSeeds, 2048},
          {"calib_json", RunCalibJson, CalibJsonSeeds, 2048}};
}

}  // namespace airdos
