// The checks of cameras, times, image files and stereo pairs: each finding's limit just below and
// just above it, with its severity and the place that it names.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

#include "common/check/check_camera.h"
#include "common/check/check_files.h"
#include "common/check/check_findings.h"
#include "common/check/check_images.h"
#include "common/check/check_input.h"
#include "common/check/check_jpeg.h"
#include "common/check/check_stereo.h"
#include "common/check/check_times.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

/// "error", "warning" or "note" of the first finding of a kind; "" for none.
std::string SeverityOf(const FindingList& list, const std::string& kind) {
  for (const Finding& finding : list.findings()) {
    if (finding.kind == kind) return NameOf(finding.severity);
  }
  return "";
}

Finding FirstOf(const FindingList& list, const std::string& kind) {
  for (const Finding& finding : list.findings()) {
    if (finding.kind == kind) return finding;
  }
  return {};
}

TEST(FindingListValuesTest, CountsEachOnceAndKeepsThreeOfAKind) {
  FindingList list;
  for (int i = 0; i < 2; ++i) list.Warn("a", "x", "the same");
  EXPECT_EQ(list.count(Severity::kWarning), 1);
  for (const char* where : {"1", "2", "3"}) list.Fail("b", where, "bad");
  EXPECT_EQ(list.findings().size(), 4u);
  list.Fail("b", "4", "bad");
  EXPECT_EQ(list.findings().size(), 4u);
  EXPECT_EQ(list.count(Severity::kError), 4);
  EXPECT_EQ(list.count(Severity::kWarning), 1);
  EXPECT_EQ(list.count(Severity::kNote), 0);
  const nlohmann::json json = list.ToJson("in");
  EXPECT_EQ(json["errors"], 4);
  EXPECT_EQ(json["warnings"], 1);
  EXPECT_EQ(json["counts"]["b"], 4);
  list.FailFrom("c", "file:7: why: so");
  EXPECT_EQ(FirstOf(list, "c").where, "file:7");
  EXPECT_EQ(FirstOf(list, "c").what, "why: so");
}

FindingList Timed(const std::vector<std::int64_t>& utimes) {
  FindingList list;
  CheckTimes(utimes, "t", &list);
  return list;
}

TEST(CheckTimesValuesTest, TheRateOfACamera) {
  const auto rate = [](std::int64_t step) { return Timed({7, 7 + step, 7 + 2 * step}); };
  EXPECT_EQ(SeverityOf(rate(5000), "times.rate"), "note");
  EXPECT_EQ(SeverityOf(rate(4999), "times.rate"), "warning");
  EXPECT_EQ(SeverityOf(rate(1000000), "times.rate"), "note");
  EXPECT_EQ(SeverityOf(rate(1000001), "times.rate"), "warning");
  EXPECT_EQ(SeverityOf(rate(500), "times.rate"), "warning");
  EXPECT_EQ(SeverityOf(rate(499), "times.unit"), "error");
  EXPECT_EQ(SeverityOf(rate(5000000), "times.unit"), "error");  // 5 s, were they ms 5 ms
}

TEST(CheckTimesValuesTest, AGapIsFromHalfAnIntervalMoreOn) {
  EXPECT_EQ(SeverityOf(Timed({0, 100000, 200000, 350000}), "times.gap"), "");
  const Finding one = FirstOf(Timed({0, 100000, 200000, 360000}), "times.gap");
  EXPECT_EQ(one.severity, Severity::kWarning);
  EXPECT_TRUE(Holds(one.what, "between images 2 and 3: about 1 missing")) << one.what;
  const Finding three = FirstOf(Timed({0, 100000, 200000, 600000}), "times.gap");
  EXPECT_TRUE(Holds(three.what, "about 3 missing")) << three.what;
}

TEST(CheckTimesValuesTest, OrderIsAnErrorForEachImage) {
  const FindingList list = Timed({0, 100000, 100000, 50000, 200000});
  EXPECT_EQ(list.count(Severity::kError), 2);
  EXPECT_TRUE(Holds(list.findings()[0].what, "image 2 has the same time as the previous one"));
  EXPECT_TRUE(Holds(list.findings()[1].what, "image 3 comes 0.05 s before"));
}

StereoCamera Camera() {
  StereoCamera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx_px = 500;
  camera.fy_px = 510;
  camera.cx_px = 320;
  camera.cy_px = 180;
  camera.baseline_m = 0.25;
  return camera;
}

/// Severity of what is found of a camera under a kind, and that nothing else is.
template <class Change>
std::string OfCamera(const std::string& kind, Change change) {
  StereoCamera camera = Camera();
  change(&camera);
  FindingList list;
  CheckCamera(camera, "c", &list);
  EXPECT_EQ(list.findings().size(), SeverityOf(list, kind).empty() ? 0u : 1u) << kind;
  return SeverityOf(list, kind);
}

TEST(CheckCameraValuesTest, Baseline) {
  const std::vector<std::pair<double, std::string>> expected = {
      {0.0049, "error"}, {0.0051, "warning"}, {0.0199, "warning"}, {0.0201, ""},
      {1.99, ""},        {2.01, "warning"},   {4.99, "warning"},   {5.01, "error"}};
  for (const auto& [baseline_m, severity] : expected) {
    const double value = baseline_m;
    EXPECT_EQ(OfCamera("camera.baseline", [&](StereoCamera* c) { c->baseline_m = value; }),
              severity)
        << baseline_m;
  }
}

TEST(CheckCameraValuesTest, FocalLengthByTheWidth) {
  const std::vector<std::pair<double, std::string>> expected = {
      {0.099, "error"}, {0.101, "warning"}, {0.299, "warning"}, {0.301, ""},
      {3.99, ""},       {4.01, "warning"},  {19.9, "warning"},  {20.1, "error"}};
  for (const auto& [ratio, severity] : expected) {
    const double value = 640 * ratio;
    EXPECT_EQ(
        OfCamera("camera.focal_length", [&](StereoCamera* c) { c->fx_px = c->fy_px = value; }),
        severity)
        << ratio;
  }
  for (const auto& [fy, severity] :
       {std::make_pair(449.0, "warning"), {451.0, ""}, {549.0, ""}, {551.0, "warning"}}) {
    const double value = fy;
    EXPECT_EQ(OfCamera("camera.focal_length", [&](StereoCamera* c) { c->fy_px = value; }), severity)
        << fy;
  }
}

TEST(CheckCameraValuesTest, ResolutionByThePrincipalPoint) {
  const std::vector<std::pair<double, std::string>> expected = {
      {0.79, "error"}, {0.81, "warning"}, {0.92, ""},        {1, ""},
      {1.09, ""},      {1.11, "warning"}, {1.24, "warning"}, {1.26, "error"}};
  for (const auto& [factor, severity] : expected) {
    const double value = factor;
    const auto change = [&](StereoCamera* c) {
      c->cx_px *= value;
      c->cy_px *= value;
    };
    EXPECT_EQ(OfCamera("camera.resolution", change), severity) << factor;
  }
}

TEST(CheckCameraValuesTest, PrincipalPointByEachSide) {
  const auto at = [](double x, double y) {
    return OfCamera("camera.principal_point", [&](StereoCamera* c) {
      c->cx_px = x * c->width;
      c->cy_px = y * c->height;
    });
  };
  EXPECT_EQ(at(0.5, 0.64), "");
  EXPECT_EQ(at(0.5, 0.66), "warning");
  EXPECT_EQ(at(0.5, 0.36), "");
  EXPECT_EQ(at(0.5, 0.34), "warning");
  EXPECT_EQ(at(0.64, 0.5), "");
  EXPECT_EQ(at(0.66, 0.5), "warning");
  EXPECT_EQ(at(0.34, 0.5), "warning");
  EXPECT_EQ(
      OfCamera("camera.principal_point", [](StereoCamera* c) { std::swap(c->cx_px, c->cy_px); }),
      "error");
}

TEST(CheckFilesValuesTest, WhatIsNotReadIsAnErrorWhereNothingElseIsThere) {
  const ScratchFolder folder("check_files_values");
  for (const char* name : {"image_0/0.png", "image_0/0.tif", "image_1/0.png"}) folder.Write(name);
  FindingList list;
  ReportUnreadFiles(folder.path(), &list);
  EXPECT_EQ(SeverityOf(list, "folder.unread"), "warning");
  EXPECT_EQ(FirstOf(list, "folder.unread").where, folder.PathOf("image_0"));
  std::filesystem::remove(folder.PathOf("image_0/0.png"));
  FindingList only;
  ReportUnreadFiles(folder.path(), &only);
  EXPECT_EQ(SeverityOf(only, "folder.unread"), "error");
}

SurveyedImage Image(const std::string& path) {
  SurveyedImage image;
  image.path = path;
  image.header = ImageHeader{640, 360};
  image.header->is_png = true;
  return image;
}

FindingList Surveyed(const std::vector<SurveyedImage>& images) {
  FindingList list;
  CheckImageFiles(images, Camera(), std::nullopt, &list);
  return list;
}

TEST(CheckImageFilesValuesTest, BothSidesAreTheCameras) {
  std::vector<SurveyedImage> images = {Image("a"), Image("b"), Image("c")};
  EXPECT_TRUE(Surveyed(images).findings().empty());
  images[1].header->height = 361;
  EXPECT_EQ(FirstOf(Surveyed(images), "images.size").where, "b");
  images[1] = Image("b");
  images[2].header->width = 641;
  EXPECT_EQ(FirstOf(Surveyed(images), "images.size").where, "c");
  EXPECT_EQ(Surveyed(images).count(Severity::kError), 1);
}

TEST(CheckImageFilesValuesTest, TheFirstOfAKindIsNamed) {
  std::vector<SurveyedImage> images = {Image("a"), Image("b"), Image("c"), Image("d")};
  for (const std::size_t i : {1u, 2u}) images[i].header->orientation = 6;
  const Finding turned = FirstOf(Surveyed(images), "images.orientation");
  EXPECT_EQ(turned.where, "b");
  EXPECT_EQ(turned.severity, Severity::kNote);
  EXPECT_TRUE(Holds(turned.what, "2 of 4 images turned by 90")) << turned.what;
  for (const std::size_t i : {2u, 3u}) images[i].header->num_channels = 3;
  const Finding kinds = FirstOf(Surveyed(images), "images.kinds");
  EXPECT_EQ(kinds.severity, Severity::kWarning);
  EXPECT_TRUE(Holds(kinds.what, "2 RGB (first c), 2 grey (first a)")) << kinds.what;
  images[3].header->num_channels = 4;
  EXPECT_EQ(FirstOf(Surveyed(images), "images.alpha").where, "d");
}

TEST(CheckImageFilesValuesTest, WhatCannotBeReadOrHasFewGreys) {
  std::vector<SurveyedImage> images = {Image("a"), Image("b")};
  images[1].header.reset();
  images[1].error = "b: is empty";
  EXPECT_EQ(SeverityOf(Surveyed(images), "images.file"), "error");
  for (const int bits : {1, 2, 4}) {
    images = {Image("a"), Image("b")};
    for (SurveyedImage& image : images) image.header->bits = bits;
    EXPECT_EQ(SeverityOf(Surveyed(images), "images.bits"), "warning") << bits;
  }
}

/// The start of a JPEG file with a table for colours, then one for brightness, in one segment;
/// their 64 entries are `low`, and `low + 1` from entry `num_low` on.
std::vector<std::uint8_t> Jpeg(int low, int num_low) {
  std::vector<std::uint8_t> file = {0xFF, 0xD8, 0xFF, 0xDB, 0, 2 + 2 * 65};
  file.push_back(1);
  file.insert(file.end(), 64, 99);
  file.push_back(0);
  for (int i = 0; i < 64; ++i)
    file.push_back(static_cast<std::uint8_t>(i < num_low ? low : low + 1));
  file.insert(file.end(), {0xFF, 0xDA, 0, 8});
  return file;
}

// libjpeg's scale in per cent is 200 - 2 q from 50 on and 5000 / q below; table K.1 sums up to
// 3688.
TEST(JpegValuesTest, QualityByTheSumOfTheTable) {
  EXPECT_EQ(JpegQuality(Jpeg(29, 64)), 75);   // 1856: 50.3 %
  EXPECT_EQ(JpegQuality(Jpeg(115, 64)), 25);  // 7360: 199.6 %
  EXPECT_EQ(JpegQuality(Jpeg(34, 27)), 70);   // 2213: 60.0 %
  EXPECT_EQ(JpegQuality(Jpeg(35, 17)), 69);   // 2287: 62.0 %
  EXPECT_FALSE(JpegQuality({0xFF, 0xD8, 0xFF, 0xDA, 0, 8}));
}

TEST(JpegValuesTest, BelowSeventyIsAWarning) {
  for (const auto& [low, num_low, severity] :
       {std::make_tuple(34, 27, "note"), {35, 17, "warning"}}) {
    JpegCheck check;
    check.Add(Jpeg(low, num_low));
    FindingList list;
    check.Report("f", &list);
    EXPECT_EQ(SeverityOf(list, "images.jpeg_quality"), severity);
  }
}

TEST(SampleValuesTest, WhichFramesAreLookedAt) {
  using Frames = std::vector<std::size_t>;
  EXPECT_EQ(SampleEvenly(11, 3), (Frames{0, 5, 10}));
  EXPECT_EQ(SampleEvenly(10, 4), (Frames{0, 3, 6, 9}));
  EXPECT_EQ(SampleEvenly(5, 1), (Frames{0}));
  EXPECT_EQ(SampleEvenly(2, 5), (Frames{0, 1}));
  CheckOptions quick;
  quick.depth = CheckOptions::Depth::kQuick;
  EXPECT_EQ(SampleOfPictures(3, quick), (Frames{0, 1, 2}));
  EXPECT_EQ(SampleOfPictures(4, quick), (Frames{1, 2}));
  EXPECT_EQ(SampleOfPictures(30, quick), (Frames{10, 20}));
  EXPECT_EQ(SampleOfPeople(100, quick).size(), 20u);
  CheckOptions full;
  full.max_frames = 2;
  EXPECT_EQ(SampleOfPictures(30, full), (Frames{0, 29}));
  EXPECT_EQ(SampleOfPeople(1000, full).size(), 200u);
  full.all = true;
  EXPECT_EQ(SampleOfPictures(30, full).size(), 30u);
  EXPECT_EQ(SampleOfPeople(1000, full).size(), 1000u);
}

/// Grey noise in which there are corners, the same every time.
cv::Mat Noise() {
  cv::Mat noise(460, 760, CV_8UC1);
  cv::RNG random(5);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(noise, noise, cv::Size(7, 7), 1.5);
  cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX);
  return noise;
}

/// A pair with this disparity (px) in which the right image's rows lie this much lower.
FindingList OfPair(const StereoCamera& camera, int disparity_px, int rows_px) {
  const cv::Mat noise = Noise();
  StereoCheck check(camera);
  FindingList list;
  check.Add("l", noise(cv::Rect(50, 50, 640, 360)), "r",
            noise(cv::Rect(50 + disparity_px, 50 - rows_px, 640, 360)), &list);
  check.Report("s", &list);
  return list;
}

TEST(StereoCheckValuesTest, DepthByFocalLengthAndBaseline) {
  StereoCamera camera = Camera();
  camera.fy_px = 300;
  // Of 20 px: 25 times the baseline.
  const std::vector<std::pair<double, std::string>> expected = {
      {0.199, "error"}, {0.201, "warning"}, {0.497, "warning"}, {0.503, "note"},
      {149, "note"},    {151, "warning"},   {995, "warning"},   {1005, "error"}};
  for (const auto& [depth_m, severity] : expected) {
    camera.baseline_m = depth_m / 25;
    EXPECT_EQ(SeverityOf(OfPair(camera, 20, 0), "camera.depth"), severity) << depth_m;
  }
}

TEST(StereoCheckValuesTest, RowsAndOrder) {
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 20, 0), "images.rectification"), "note");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 20, 1), "images.rectification"), "warning");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 20, -2), "images.rectification"), "error");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 20, 2), "images.rectification"), "error");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 20, 0), "images.order"), "note");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), -20, 0), "images.swapped"), "error");
  EXPECT_EQ(SeverityOf(OfPair(Camera(), 0, 2), "images.order"), "warning");
}

TEST(StereoCheckValuesTest, OnePairThatIsTheSamePictureTwiceIsAnError) {
  const cv::Mat noise = Noise();
  const cv::Mat left = noise(cv::Rect(50, 50, 640, 360));
  StereoCheck check(Camera());
  FindingList list;
  check.Add("l0", left, "r0", noise(cv::Rect(70, 50, 640, 360)), &list);
  check.Add("l1", left, "r1", left, &list);
  check.Report("s", &list);
  EXPECT_EQ(SeverityOf(list, "images.identical"), "error");
  EXPECT_TRUE(Holds(FirstOf(list, "images.identical").what, "in 1 of 2 pairs"));
}

}  // namespace
}  // namespace airdos
