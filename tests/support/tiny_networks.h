#ifndef AIRDOS_TESTS_SUPPORT_TINY_NETWORKS_H_
#define AIRDOS_TESTS_SUPPORT_TINY_NETWORKS_H_

#include <opencv2/core.hpp>
#include <string>

namespace airdos {

// ONNX files of a few layers, whose answers can be worked out by hand. All expect grey levels / 255
// (mean 0, scale 255), red first.

/// The heads of MoveNet MultiPose on cells of 4 px: a red cell is the middle of a person (logit 12
/// * red - 6), a green one is every joint (logit 12 * green - 6). Joint j is expected 2 cells right
/// of the middle and j - 8 below it, and lies in its cell at (0.25 rows, -0.5 columns).
std::string TinyMoveNet(const cv::Size& input, bool has_channels_last = false);

/// The output of a YOLO network that looks at cells of 32 px, of which the input has two in each
/// direction, with 56 columns and a row for each cell, or transposed. Candidate i has the score
/// `red` of its cell, its middle at the cell's, is 20 px wide and 30 px high, and joint j at
/// (u, v) = (i, j) with the score `green`.
std::string TinyYolo(bool is_transposed);

/// The lists of SimCC with two values a pixel: joint j, but for the last one, is as likely in a
/// column or row as that has red on average. The last one has 0 everywhere.
std::string TinySimcc(const cv::Size& input, bool is_swapped = false);

/// A mask net: the red of each pixel.
std::string TinyMask(const cv::Size& input);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_TINY_NETWORKS_H_
