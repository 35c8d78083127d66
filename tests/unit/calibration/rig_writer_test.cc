// What is written is read again as the same rig.
#include "common/calibration/rig_writer.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/calibration/calibration_file.h"
#include "common/util/error.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

StereoRig MakeRig(LensModel lens) {
  StereoRig rig;
  rig.left = {640, 480, 461.25, 458.5, 322.75, 236.125, lens, {-0.0137, 0.0207, -0.0012, 0.0025}};
  rig.right = {640, 480, 457.5, 456.125, 318.5, 243.25, lens, {-0.0085, 0.0114, -0.0007, 0.0015}};
  rig.T_L_R.rotation = ExpSo3({0.011, -0.023, 0.007});
  rig.T_L_R.translation = {0.112, 0.0021, -0.0034};
  return rig;
}

/// Written to a folder and read.
StereoRig Again(const StereoRig& rig, const std::string& format) {
  const ScratchFolder folder("rig_writer");
  std::vector<std::string> paths;
  for (const NamedText& file : WriteRig(rig, StereoRectifier(rig), format)) {
    paths.push_back(folder.Write(file.name, file.text));
  }
  CalibrationOptions options;
  options.format.image_size = {rig.left.width, rig.left.height};
  return ReadStereoRig(paths, options);
}

TEST(RigWriter, EachFormatIsReadAsTheSameRig) {
  for (const std::string& format : WrittenFormats()) {
    if (format == "calib.json") continue;
    for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kFisheye}) {
      SCOPED_TRACE(format);
      const StereoRig rig = MakeRig(lens);
      const StereoRig read = Again(rig, format);
      EXPECT_LT(Boxminus(read.T_L_R, rig.T_L_R).norm(), 1e-9);
      for (const auto& [actual, wanted] :
           {std::make_pair(&read.left, &rig.left), {&read.right, &rig.right}}) {
        EXPECT_EQ(actual->width, wanted->width);
        EXPECT_EQ(actual->height, wanted->height);
        EXPECT_EQ(actual->fx_px, wanted->fx_px);
        EXPECT_EQ(actual->fy_px, wanted->fy_px);
        EXPECT_EQ(actual->cx_px, wanted->cx_px);
        EXPECT_EQ(actual->cy_px, wanted->cy_px);
        EXPECT_EQ(actual->lens, wanted->lens);
        EXPECT_EQ(actual->distortion, wanted->distortion);
      }
    }
  }
}

TEST(RigWriter, CalibJsonIsTheRectifiedPair) {
  const StereoRig rig = MakeRig(LensModel::kRadialTangential);
  const StereoRig read = Again(rig, "calib.json");
  EXPECT_TRUE(read.are_images_rectified);
  EXPECT_TRUE(*read.rectified == StereoRectifier(rig).camera());
  EXPECT_THROW(WriteRig(read, StereoRectifier(read), "kalibr"), InputError);
}

TEST(RigWriter, WhatAFormatCannotSayIsRefused) {
  StereoRig rig = MakeRig(LensModel::kRadialTangential);
  rig.left.distortion.push_back(0.01);
  EXPECT_THROW(Again(rig, "kalibr"), InputError);
  EXPECT_THROW(Again(rig, "euroc"), InputError);
  EXPECT_EQ(Again(rig, "ros").left.distortion, rig.left.distortion);
  EXPECT_EQ(Again(rig, "opencv").left.distortion, rig.left.distortion);
}

}  // namespace
}  // namespace airdos
