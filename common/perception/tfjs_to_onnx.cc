#include "common/perception/tfjs_to_onnx.h"

#include <algorithm>

#include "common/perception/tfjs_converter.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

constexpr int kMaxDepth = 1000;
constexpr char kImage[] = "image";

OnnxShape Channelled(const TfjsGraph::Wholes& shape) {
  return shape.size() == 4 ? OnnxShape{shape[0], shape[3], shape[1], shape[2]} : shape;
}

}  // namespace

std::string TfjsConverter::Convert() {
  const std::string input = cut_.input.empty() ? graph_.Placeholder() : cut_.input;
  graph_.Node(input);  // or there is none
  computed_[input] = {kImage, {1, cut_.height_px, cut_.width_px, 3}};
  std::vector<OnnxValue> outputs;
  for (const std::string& output : cut_.outputs) {
    const Computed from = Compute(output);
    onnx_.AddNode({"Identity", {from.name}, output});
    outputs.push_back({output, Channelled(from.shape)});
  }
  return onnx_.Bytes({kImage, {1, 3, cut_.height_px, cut_.width_px}}, outputs);
}

TfjsConverter::Computed TfjsConverter::Compute(const std::string& input) {
  const std::string name = TfjsGraph::Plain(input);
  const auto known = computed_.find(name);
  if (known != computed_.end()) return known->second;
  const TfjsNode& node = graph_.Node(name);
  if (!in_work_.insert(name).second || in_work_.size() > kMaxDepth)
    TfjsGraph::Refuse(node, "depends on itself");
  const Computed result = ComputeNode(node);
  in_work_.erase(name);
  return computed_[name] = result;
}

TfjsConverter::Computed TfjsConverter::ComputeNode(const TfjsNode& node) {
  const std::string& op = node.operation;
  if (op == "Identity" || op == "Cast") return Compute(TfjsGraph::InputOf(node, 0));
  if (op == "_FusedConv2D" || op == "Conv2D") return Convolve(node, false);
  if (op == "FusedDepthwiseConv2dNative" || op == "DepthwiseConv2dNative")
    return Convolve(node, true);
  if (op == "Conv2DBackpropInput") return ConvolveTransposed(node);
  if (op == "AddV2" || op == "Add" || op == "BiasAdd" || op == "AddN") return Combine(node, "Add");
  if (op == "Mul" || op == "Sub") return Combine(node, op);
  if (op == "Relu" || op == "Relu6" || op == "Sigmoid") return Activate(node);
  if (op == "ResizeBilinear") return Resize(node);
  if (op == "AvgPool" || op == "MaxPool") return Pool(node);
  TfjsGraph::Refuse(node, "this operation is not supported");
}

TfjsConverter::Computed TfjsConverter::ImageInput(const TfjsNode& node, std::size_t index) {
  Computed input = Compute(TfjsGraph::InputOf(node, index));
  if (input.shape.size() != 4) TfjsGraph::Refuse(node, "its input is no image");
  return input;
}

TfjsConverter::Wholes TfjsConverter::WholeValues(const TfjsNode& user, const std::string& input,
                                                 int depth) {
  if (const TfjsTensor* constant = graph_.Constant(input)) {
    Wholes values;
    for (const float value : constant->values)
      values.push_back(static_cast<std::int64_t>(std::clamp(value, -1e9F, 1e9F)));
    return values;
  }
  const TfjsNode& node = graph_.Node(TfjsGraph::Plain(input));
  if (depth > 100) TfjsGraph::Refuse(node, "depends on itself");
  const auto operand = [&](std::size_t i) {
    return WholeValues(node, TfjsGraph::InputOf(node, i), depth + 1);
  };
  if (node.operation == "Shape") return Compute(TfjsGraph::InputOf(node, 0)).shape;
  if (node.operation == "StridedSlice") return Slice(node, operand(0), operand(1), operand(2));
  if (node.operation == "Mul") {
    Wholes a = operand(0);
    const Wholes b = operand(1);
    if (a.size() != b.size()) TfjsGraph::Refuse(node, "its inputs differ in size");
    for (std::size_t i = 0; i < a.size(); ++i) a[i] *= std::clamp<std::int64_t>(b[i], -64, 64);
    return a;
  }
  TfjsGraph::Refuse(user,
                    "its size comes from " + Shown(node.operation) + ", which is not supported");
}

TfjsConverter::Wholes TfjsConverter::Slice(const TfjsNode& node, const Wholes& values,
                                           const Wholes& begin, const Wholes& end) {
  for (const char* mask : {"begin_mask", "end_mask", "ellipsis_mask", "new_axis_mask"}) {
    if (TfjsGraph::WholesOf(node, mask, {0})[0] != 0)
      TfjsGraph::Refuse(node, "its masks are not supported");
  }
  const auto size = static_cast<std::int64_t>(values.size());
  const bool fits =
      begin.size() == 1 && end.size() == 1 && begin[0] >= 0 && end[0] > begin[0] && end[0] <= size;
  if (!fits) TfjsGraph::Refuse(node, "its range is not supported");
  return {values.begin() + begin[0], values.begin() + end[0]};
}

std::string TfjsToOnnx(const TfjsModel& model, const TfjsCut& cut) {
  return TfjsConverter(model, cut).Convert();
}

}  // namespace airdos
