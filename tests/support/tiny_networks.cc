#include "tests/support/tiny_networks.h"

#include <cstddef>
#include <vector>

#include "common/perception/onnx_writer.h"

namespace airdos {
namespace {

using Wholes = std::vector<std::int64_t>;
using Floats = std::vector<float>;

constexpr int kJoints = 17;

/// A convolution of one pixel with weights for red, green and blue of each channel.
void AddPixelwise(const std::string& input, const std::string& output, const Floats& weights,
                  const Floats& bias, OnnxWriter* onnx) {
  const auto channels = static_cast<std::int64_t>(bias.size());
  onnx->AddConstant(output + "_weights", {channels, 3, 1, 1}, weights);
  onnx->AddConstant(output + "_bias", {channels}, bias);
  onnx->AddNode({"Conv",
                 {input, output + "_weights", output + "_bias"},
                 output,
                 {{"kernel_shape", Wholes{1, 1}}}});
}

/// The mean of cells.
void AddCells(const std::string& input, const std::string& output, const Wholes& cell,
              OnnxWriter* onnx) {
  onnx->AddNode({"AveragePool", {input}, output, {{"kernel_shape", cell}, {"strides", cell}}});
}

}  // namespace

std::string TinyMoveNet(const cv::Size& input, bool has_channels_last) {
  OnnxWriter onnx;
  std::string image = "image";
  if (has_channels_last) {
    onnx.AddNode({"Transpose", {"image"}, "turned", {{"perm", Wholes{0, 3, 1, 2}}}});
    image = "turned";
  }
  AddCells(image, "cells", {4, 4}, &onnx);
  std::vector<OnnxValue> outputs;
  const auto add_head = [&](const std::string& name, const Floats& weights, const Floats& bias) {
    const OnnxShape shape{1, static_cast<std::int64_t>(bias.size()), input.height / 4,
                          input.width / 4};
    if (!has_channels_last) {
      AddPixelwise("cells", name, weights, bias, &onnx);
      outputs.push_back({name, shape});
      return;
    }
    AddPixelwise("cells", name + "_first", weights, bias, &onnx);
    onnx.AddNode({"Transpose", {name + "_first"}, name, {{"perm", Wholes{0, 2, 3, 1}}}});
    outputs.push_back({name, {1, shape[2], shape[3], shape[1]}});
  };
  add_head("centre", {12, 0, 0}, {-6});
  Floats green, regression, offsets;
  for (int joint = 0; joint < kJoints; ++joint) {
    green.insert(green.end(), {0, 12, 0});
    regression.insert(regression.end(), {static_cast<float>(joint) - 8, 2});
    offsets.insert(offsets.end(), {0.25F, -0.5F});
  }
  add_head("heatmaps", green, Floats(kJoints, -6));
  const Floats nothing(std::size_t{3} * 2 * kJoints, 0);
  add_head("regression", nothing, regression);
  add_head("offsets", nothing, offsets);
  const OnnxShape shape = has_channels_last ? OnnxShape{1, input.height, input.width, 3}
                                            : OnnxShape{1, 3, input.height, input.width};
  return onnx.Bytes({"image", shape}, outputs);
}

std::string TinyYolo(bool is_transposed) {
  constexpr int kColumns = 5 + 3 * kJoints;
  constexpr int kCells = 2;
  OnnxWriter onnx;
  AddCells("image", "cells", {32, 32}, &onnx);
  Floats weights(std::size_t{3} * kColumns, 0);
  weights[3 * 4] = 1;  // the score is the red
  for (std::size_t joint = 0; joint < kJoints; ++joint) weights[3 * (7 + 3 * joint) + 1] = 1;
  AddPixelwise("cells", "scores", weights, Floats(kColumns, 0), &onnx);
  Floats places(std::size_t{kColumns} * kCells * kCells, 0);
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    const auto put = [&](int column, int value) {
      places[static_cast<std::size_t>(column * kCells * kCells + cell)] = static_cast<float>(value);
    };
    put(0, 16 + 32 * (cell % kCells));
    put(1, 16 + 32 * (cell / kCells));
    put(2, 20);
    put(3, 30);
    for (int joint = 0; joint < kJoints; ++joint) {
      put(5 + 3 * joint, cell);
      put(6 + 3 * joint, joint);
    }
  }
  onnx.AddConstant("places", {1, kColumns, kCells, kCells}, places);
  onnx.AddNode({"Add", {"scores", "places"}, "grid"});
  onnx.AddConstant("shape", {3}, Wholes{1, kColumns, kCells * kCells});
  onnx.AddNode({"Reshape", {"grid", "shape"}, "list"});
  if (!is_transposed) {
    onnx.AddNode({"Transpose", {"list"}, "rows", {{"perm", Wholes{0, 2, 1}}}});
    return onnx.Bytes({"image", {1, 3, 64, 64}}, {{"rows", {1, kCells * kCells, kColumns}}});
  }
  return onnx.Bytes({"image", {1, 3, 64, 64}}, {{"list", {1, kColumns, kCells * kCells}}});
}

std::string TinySimcc(const cv::Size& input, bool is_swapped) {
  OnnxWriter onnx;
  std::vector<OnnxValue> outputs;
  const auto add_list = [&](const std::string& name, const Wholes& across, const Wholes& twice,
                            int length) {
    AddCells("image", name + "_mean", across, &onnx);
    // Each value and a zero after it.
    Floats weights(std::size_t{3} * kJoints * 2, 0);
    for (std::size_t joint = 0; joint + 1 < kJoints; ++joint) weights[joint * 2] = 1;
    onnx.AddConstant(name + "_weights", {3, kJoints, twice[0], twice[1]}, weights);
    onnx.AddNode({"ConvTranspose",
                  {name + "_mean", name + "_weights"},
                  name + "_twice",
                  {{"kernel_shape", twice}, {"strides", twice}}});
    onnx.AddConstant(name + "_shape", {3}, Wholes{1, kJoints, 2 * length});
    onnx.AddNode({"Reshape", {name + "_twice", name + "_shape"}, name});
    outputs.push_back({name, {1, kJoints, 2 * length}});
  };
  const auto add_columns = [&] { add_list("columns", {input.height, 1}, {1, 2}, input.width); };
  if (!is_swapped) add_columns();
  add_list("rows", {1, input.width}, {2, 1}, input.height);
  if (is_swapped) add_columns();
  return onnx.Bytes({"image", {1, 3, input.height, input.width}}, outputs);
}

std::string TinyMask(const cv::Size& input) {
  OnnxWriter onnx;
  AddPixelwise("image", "mask", {1, 0, 0}, {0}, &onnx);
  return onnx.Bytes({"image", {1, 3, input.height, input.width}},
                    {{"mask", {1, 1, input.height, input.width}}});
}

}  // namespace airdos
