#include "processes/tools/map/map_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/util/error.h"

namespace airdos {
namespace {

/// How many pixels are far from grey: lines of the camera and of people, no text, axes or static
/// points.
int CountColored(const cv::Mat& picture) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& p = picture.at<cv::Vec3b>(y, x);
      count += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 60 ? 1 : 0;
    }
  }
  return count;
}

FourDMap MapWithPath() {
  FourDMap map;
  for (int i = 0; i < 10; ++i) {
    map.frames[FrameId{i}].live = Se3{Eigen::Quaterniond::Identity(), {0.1 * i, 0, 0.3 * i}};
  }
  return map;
}

TEST(MapPictureTest, ShowsTheCameraAndPeopleThatWereSeenOftenEnough) {
  FourDMap map = MapWithPath();
  const int camera_alone = CountColored(DrawMap(map));
  EXPECT_GT(camera_alone, 100);
  for (int i = 0; i < 3; ++i)
    map.humans[{FrameId{i}, HumanId{4}}].joints[1].p_W = {1.F, 0.F,
                                                          1.F + 0.2F * static_cast<float>(i)};
  EXPECT_EQ(CountColored(DrawMap(map)), camera_alone);  // three frames say nothing
  for (int i = 3; i < 9; ++i)
    map.humans[{FrameId{i}, HumanId{4}}].joints[1].p_W = {1.F, 0.F,
                                                          1.F + 0.2F * static_cast<float>(i)};
  EXPECT_GT(CountColored(DrawMap(map)), camera_alone + 100);
}

TEST(MapPictureTest, AnEmptyMapIsAnEmptyPicture) {
  EXPECT_EQ(CountColored(DrawMap(FourDMap())), 0);
}

TEST(MapPictureTest, SaysWhichFileCannotBeWritten) {
  try {
    WriteMapPicture(MapWithPath(), "/nowhere/map.png");
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/map.png: cannot be written as a picture");
  }
}

}  // namespace
}  // namespace airdos
