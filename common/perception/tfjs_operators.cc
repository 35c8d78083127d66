// The operators of TfjsConverter: what each of TensorFlow becomes in ONNX.
#include <algorithm>

#include "common/perception/tfjs_converter.h"
#include "common/util/text_file.h"

namespace airdos {

std::string TfjsConverter::NewName(const std::string& base) {
  return base + "_airdos" + std::to_string(num_names_++);
}

std::string TfjsConverter::Add(const OnnxNode& node) {
  onnx_.AddNode(node);
  return node.output;
}

TfjsConverter::Window TfjsConverter::SlideOver(const TfjsNode& node, const Wholes& shape,
                                               const Wholes& kernel, const Wholes& strides,
                                               const Wholes& dilations) {
  Window window{kernel, strides, {}, {}, {}};
  const std::string padding = TfjsGraph::TextOf(node, "padding");
  if (padding != "SAME" && padding != "VALID")
    TfjsGraph::Refuse(node, "padding '" + Shown(padding) + "' is not supported");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::int64_t reach = (kernel[i] - 1) * dilations[i] + 1;
    const std::int64_t size = shape[i + 1];
    const bool is_same = padding == "SAME";
    window.size.push_back(is_same ? (size + strides[i] - 1) / strides[i]
                                  : (size - reach) / strides[i] + 1);
    if (window.size[i] < 1 || (!is_same && size < reach))
      TfjsGraph::Refuse(node, "the image is too small");
    const std::int64_t missing =
        is_same ? std::max<std::int64_t>(0, (window.size[i] - 1) * strides[i] + reach - size) : 0;
    window.before.push_back(missing / 2);
    window.after.push_back(missing - missing / 2);
  }
  return window;
}

std::string TfjsConverter::Padded(const std::string& input, Window* window) {
  if (window->before == window->after) return input;
  const std::string pads = NewName(input);
  const Wholes& before = window->before;
  const Wholes& after = window->after;
  onnx_.AddConstant(pads, {8}, Wholes{0, 0, before[0], before[1], 0, 0, after[0], after[1]});
  const std::string zero = NewName(input);
  onnx_.AddConstant(zero, {}, std::vector<float>{0});
  window->before = window->after = {0, 0};
  return Add({"Pad", {input, pads, zero}, NewName(input), {{"mode", std::string("constant")}}});
}

TfjsConverter::Wholes TfjsConverter::PadsOf(const Window& window) {
  return {window.before[0], window.before[1], window.after[0], window.after[1]};
}

std::string TfjsConverter::Kernel(const TfjsNode& node, const TfjsTensor& weights,
                                  bool is_depthwise) {
  const Wholes& shape = weights.shape;
  const std::int64_t area = shape[0] * shape[1];
  std::vector<float> values;
  values.reserve(weights.values.size());
  const auto at = [&](std::int64_t position, std::int64_t third, std::int64_t fourth) {
    return weights
        .values[static_cast<std::size_t>((position * shape[2] + third) * shape[3] + fourth)];
  };
  const std::int64_t outer = is_depthwise ? shape[2] : shape[3];
  const std::int64_t inner = is_depthwise ? shape[3] : shape[2];
  for (std::int64_t a = 0; a < outer; ++a) {
    for (std::int64_t b = 0; b < inner; ++b) {
      for (std::int64_t position = 0; position < area; ++position)
        values.push_back(is_depthwise ? at(position, a, b) : at(position, b, a));
    }
  }
  const std::string name = NewName(node.name);
  onnx_.AddConstant(name,
                    is_depthwise ? OnnxShape{outer * inner, 1, shape[0], shape[1]}
                                 : OnnxShape{outer, inner, shape[0], shape[1]},
                    values);
  return name;
}

TfjsConverter::Computed TfjsConverter::Convolve(const TfjsNode& node, bool is_depthwise) {
  const Computed input = ImageInput(node, 0);
  const TfjsTensor& weights = graph_.KernelInput(node);
  if (weights.shape[2] != input.shape[3])
    TfjsGraph::Refuse(node, "its kernel does not fit its input");
  const Wholes dilations = TfjsGraph::Spatial(node, "dilations");
  Window window = SlideOver(node, input.shape, {weights.shape[0], weights.shape[1]},
                            TfjsGraph::Spatial(node, "strides"), dilations);
  const std::string padded = Padded(input.name, &window);
  std::vector<std::string> inputs{padded, Kernel(node, weights, is_depthwise)};
  const std::int64_t groups = is_depthwise ? weights.shape[2] : 1;
  const std::int64_t channels =
      is_depthwise ? weights.shape[2] * weights.shape[3] : weights.shape[3];
  const auto fused = node.texts.find("fused_ops");
  const std::vector<std::string> steps =
      fused == node.texts.end() ? std::vector<std::string>() : fused->second;
  for (const std::string& step : steps) {
    if (step != "BiasAdd") continue;
    const TfjsTensor& bias = graph_.ConstantInput(node, 2);
    if (static_cast<std::int64_t>(bias.values.size()) != channels)
      TfjsGraph::Refuse(node, "its bias does not fit its kernel");
    inputs.push_back(NewName(node.name));
    onnx_.AddConstant(inputs.back(), {channels}, bias.values);
  }
  std::string name = Add({"Conv",
                          inputs,
                          NewName(node.name),
                          {{"kernel_shape", window.kernel},
                           {"strides", window.strides},
                           {"dilations", dilations},
                           {"pads", PadsOf(window)},
                           {"group", groups}}});
  for (const std::string& step : steps) {
    if (step != "BiasAdd") name = AddActivation(node, step, name);
  }
  return {name, {1, window.size[0], window.size[1], channels}};
}

TfjsConverter::Computed TfjsConverter::ConvolveTransposed(const TfjsNode& node) {
  const Computed input = ImageInput(node, 2);
  const TfjsTensor& weights = graph_.KernelInput(node);
  if (weights.shape[3] != input.shape[3])
    TfjsGraph::Refuse(node, "its kernel does not fit its input");
  const Wholes strides = TfjsGraph::Spatial(node, "strides");
  const Wholes output = WholeValues(node, TfjsGraph::InputOf(node, 0), 0);
  if (output.size() != 4) TfjsGraph::Refuse(node, "the size of its output is unknown");
  Wholes before, after;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::int64_t full = (input.shape[i + 1] - 1) * strides[i] + weights.shape[i];
    const std::int64_t surplus = full - output[i + 1];
    if (surplus < 0 || output[i + 1] < 1)
      TfjsGraph::Refuse(node, "the size of its output is impossible");
    before.push_back(surplus / 2);
    after.push_back(surplus - surplus / 2);
  }
  const std::string name = Add({"ConvTranspose",
                                {input.name, Kernel(node, weights, false)},
                                NewName(node.name),
                                {{"kernel_shape", Wholes{weights.shape[0], weights.shape[1]}},
                                 {"strides", strides},
                                 {"pads", Wholes{before[0], before[1], after[0], after[1]}}}});
  return {name, {1, output[1], output[2], weights.shape[2]}};
}

std::string TfjsConverter::AddActivation(const TfjsNode& node, const std::string& kind,
                                         const std::string& input) {
  const std::string name = NewName(node.name);
  if (kind == "Relu" || kind == "Sigmoid") return Add({kind, {input}, name});
  // OpenCV 4.6 reads the bounds of Clip only where older operator sets had them.
  if (kind == "Relu6") return Add({"Clip", {input}, name, {{"min", 0.0F}, {"max", 6.0F}}});
  TfjsGraph::Refuse(node, "the activation '" + Shown(kind) + "' is not supported");
}

TfjsConverter::Computed TfjsConverter::Activate(const TfjsNode& node) {
  const Computed input = Compute(TfjsGraph::InputOf(node, 0));
  return {AddActivation(node, node.operation, input.name), input.shape};
}

std::string TfjsConverter::Operand(const TfjsNode& node, const TfjsTensor& constant) {
  Wholes shape = constant.shape;
  const std::string name = NewName(node.name);
  if (shape.size() == 1) shape = {1, shape[0], 1, 1};
  if (shape.empty()) shape = {1, 1, 1, 1};
  const bool is_plain = shape.size() == 4 && constant.shape.size() < 2;
  if (!is_plain) TfjsGraph::Refuse(node, "constants of this shape are not supported");
  onnx_.AddConstant(name, shape, constant.values);
  return name;
}

TfjsConverter::Computed TfjsConverter::Combine(const TfjsNode& node, const std::string& operation) {
  if (node.inputs.size() != 2) TfjsGraph::Refuse(node, "must have two inputs");
  std::vector<std::string> names;
  Wholes shape;
  for (const std::string& input : node.inputs) {
    const TfjsTensor* constant = graph_.Constant(input);
    if (constant != nullptr) {
      names.push_back(Operand(node, *constant));
      continue;
    }
    const Computed computed = Compute(input);
    names.push_back(computed.name);
    // Of two, the one that is not spread over the other.
    if (shape.size() != computed.shape.size()) shape = computed.shape;
    for (std::size_t i = 0; i < shape.size(); ++i) shape[i] = std::max(shape[i], computed.shape[i]);
  }
  if (shape.empty()) TfjsGraph::Refuse(node, "both inputs are constants");
  return {Add({operation, names, NewName(node.name)}), shape};
}

TfjsConverter::Computed TfjsConverter::Resize(const TfjsNode& node) {
  const Computed input = ImageInput(node, 0);
  const Wholes size = WholeValues(node, TfjsGraph::InputOf(node, 1), 0);
  if (size.size() != 2 || size[0] < 1 || size[1] < 1 || std::max(size[0], size[1]) > 65536)
    TfjsGraph::Refuse(node, "the size of its output is unknown");
  const bool is_half_pixel = TfjsGraph::WholesOf(node, "half_pixel_centers", {0})[0] != 0;
  const bool is_aligned = TfjsGraph::WholesOf(node, "align_corners", {0})[0] != 0;
  const std::string mode = is_aligned      ? "align_corners"
                           : is_half_pixel ? "pytorch_half_pixel"
                                           : "asymmetric";
  const std::string scales = NewName(node.name);
  const auto ratio = [&](std::size_t i) {
    return static_cast<float>(size[i]) / static_cast<float>(input.shape[i + 1]);
  };
  onnx_.AddConstant(scales, {4}, std::vector<float>{1, 1, ratio(0), ratio(1)});
  const std::string name = Add({"Resize",
                                {input.name, "", scales},
                                NewName(node.name),
                                {{"mode", std::string("linear")},
                                 {"coordinate_transformation_mode", mode},
                                 {"nearest_mode", std::string("floor")}}});
  return {name, {1, size[0], size[1], input.shape[3]}};
}

TfjsConverter::Computed TfjsConverter::Pool(const TfjsNode& node) {
  const Computed input = ImageInput(node, 0);
  Window window = SlideOver(node, input.shape, TfjsGraph::Spatial(node, "ksize"),
                            TfjsGraph::Spatial(node, "strides"), {1, 1});
  const bool is_average = node.operation == "AvgPool";
  const Wholes shape{1, window.size[0], window.size[1], input.shape[3]};
  if (is_average && window.kernel == Wholes{input.shape[1], input.shape[2]})
    return {Add({"GlobalAveragePool", {input.name}, NewName(node.name)}), {1, 1, 1, shape[3]}};
  const std::string operation = is_average ? "AveragePool" : "MaxPool";
  return {Add({operation,
               {input.name},
               NewName(node.name),
               {{"kernel_shape", window.kernel},
                {"strides", window.strides},
                {"pads", PadsOf(window)}}}),
          shape};
}

}  // namespace airdos
