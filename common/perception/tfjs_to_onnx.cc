#include "common/perception/tfjs_to_onnx.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

#include "common/perception/onnx_writer.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

using Wholes = std::vector<std::int64_t>;

constexpr int kMaxDepth = 1000;
constexpr char kImage[] = "image";

/// A tensor that is computed: its ONNX name, and TensorFlow's shape (1, rows, columns, channels).
struct Computed {
  std::string name;
  Wholes shape;
};

/// What a window that slides over rows and columns needs around its input, and gives.
struct Window {
  Wholes kernel;   // rows, columns
  Wholes strides;  // likewise
  Wholes size;     // of the output, likewise
  Wholes before;   // rows and columns to add at the top and left
  Wholes after;    // at the bottom and right
};

[[noreturn]] void Refuse(const TfjsNode& node, const std::string& why) {
  throw InputError("node '" + Shown(node.name) + "' (" + Shown(node.operation) + "): " + why);
}

/// Nodes are named as "name:output", and those that only come first as "^name".
std::string Plain(const std::string& input) {
  const std::string name = input.substr(0, input.find(':'));
  return name.empty() || name[0] != '^' ? name : name.substr(1);
}

class Converter {
 public:
  Converter(const TfjsModel& model, const TfjsCut& cut) : model_(model), cut_(cut) {}

  std::string Convert() {
    const std::string input = cut_.input.empty() ? Placeholder() : cut_.input;
    Node(input);  // or there is none
    computed_[input] = {kImage, {1, cut_.height_px, cut_.width_px, 3}};
    std::vector<OnnxValue> outputs;
    for (const std::string& output : cut_.outputs) {
      const Computed from = Compute(output);
      onnx_.AddNode({"Identity", {from.name}, output});
      outputs.push_back({output, Channelled(from.shape)});
    }
    return onnx_.Bytes({kImage, {1, 3, cut_.height_px, cut_.width_px}}, outputs);
  }

 private:
  std::string Placeholder() const {
    for (const auto& [name, node] : model_.nodes) {
      if (node.operation == "Placeholder") return name;
    }
    throw InputError("the model has no placeholder for its input");
  }

  const TfjsNode& Node(const std::string& name) const {
    const auto node = model_.nodes.find(name);
    if (node == model_.nodes.end()) throw InputError("the model has no node '" + Shown(name) + "'");
    return node->second;
  }

  static OnnxShape Channelled(const Wholes& shape) {
    return shape.size() == 4 ? OnnxShape{shape[0], shape[3], shape[1], shape[2]} : shape;
  }

  static const std::string& InputOf(const TfjsNode& node, std::size_t index) {
    if (index >= node.inputs.size()) Refuse(node, "has too few inputs");
    return node.inputs[index];
  }

  static Wholes WholesOf(const TfjsNode& node, const std::string& name, const Wholes& otherwise) {
    const auto found = node.wholes.find(name);
    return found == node.wholes.end() || found->second.empty() ? otherwise : found->second;
  }

  static std::string TextOf(const TfjsNode& node, const std::string& name) {
    const auto found = node.texts.find(name);
    return found == node.texts.end() || found->second.empty() ? "" : found->second[0];
  }

  /// Rows and columns of an attribute that speaks of all four dimensions.
  static Wholes Spatial(const TfjsNode& node, const std::string& name) {
    const Wholes all = WholesOf(node, name, {1, 1, 1, 1});
    if (all.size() != 4 || all[1] < 1 || all[2] < 1 || std::max(all[1], all[2]) > 4096)
      Refuse(node, "has impossible " + name);
    return {all[1], all[2]};
  }

  const TfjsTensor* Constant(const std::string& input) const {
    const auto weight = model_.weights.find(Plain(input));
    if (weight != model_.weights.end()) return &weight->second;
    const auto node = model_.nodes.find(Plain(input));
    const bool is_alias = node != model_.nodes.end() && node->second.operation == "Identity" &&
                          node->second.inputs.size() == 1 &&
                          node->second.inputs[0] != node->second.name;
    if (!is_alias) return nullptr;
    const auto behind = model_.weights.find(Plain(node->second.inputs[0]));
    return behind == model_.weights.end() ? nullptr : &behind->second;
  }

  const TfjsTensor& ConstantInput(const TfjsNode& node, std::size_t index) const {
    const TfjsTensor* constant = Constant(InputOf(node, index));
    if (constant == nullptr) Refuse(node, "its input " + std::to_string(index) + " is no constant");
    return *constant;
  }

  std::string NewName(const std::string& base) {
    return base + "_airdos" + std::to_string(num_names_++);
  }

  std::string Add(const OnnxNode& node) {
    onnx_.AddNode(node);
    return node.output;
  }

  Computed Compute(const std::string& input) {
    const std::string name = Plain(input);
    const auto known = computed_.find(name);
    if (known != computed_.end()) return known->second;
    const TfjsNode& node = Node(name);
    if (!in_work_.insert(name).second || in_work_.size() > kMaxDepth)
      Refuse(node, "depends on itself");
    const Computed result = ComputeNode(node);
    in_work_.erase(name);
    return computed_[name] = result;
  }

  Computed ComputeNode(const TfjsNode& node) {
    const std::string& op = node.operation;
    if (op == "Identity" || op == "Cast") return Compute(InputOf(node, 0));
    if (op == "_FusedConv2D" || op == "Conv2D") return Convolve(node, false);
    if (op == "FusedDepthwiseConv2dNative" || op == "DepthwiseConv2dNative")
      return Convolve(node, true);
    if (op == "Conv2DBackpropInput") return ConvolveTransposed(node);
    if (op == "AddV2" || op == "Add" || op == "BiasAdd" || op == "AddN")
      return Combine(node, "Add");
    if (op == "Mul" || op == "Sub") return Combine(node, op);
    if (op == "Relu" || op == "Relu6" || op == "Sigmoid") return Activate(node);
    if (op == "ResizeBilinear") return Resize(node);
    if (op == "AvgPool" || op == "MaxPool") return Pool(node);
    Refuse(node, "this operation is not supported");
  }

  Computed ImageInput(const TfjsNode& node, std::size_t index) {
    Computed input = Compute(InputOf(node, index));
    if (input.shape.size() != 4) Refuse(node, "its input is no image");
    return input;
  }

  static Window SlideOver(const TfjsNode& node, const Wholes& shape, const Wholes& kernel,
                          const Wholes& strides, const Wholes& dilations) {
    Window window{kernel, strides, {}, {}, {}};
    const std::string padding = TextOf(node, "padding");
    if (padding != "SAME" && padding != "VALID")
      Refuse(node, "padding '" + Shown(padding) + "' is not supported");
    for (std::size_t i = 0; i < 2; ++i) {
      const std::int64_t reach = (kernel[i] - 1) * dilations[i] + 1;
      const std::int64_t size = shape[i + 1];
      const bool is_same = padding == "SAME";
      window.size.push_back(is_same ? (size + strides[i] - 1) / strides[i]
                                    : (size - reach) / strides[i] + 1);
      if (window.size[i] < 1 || (!is_same && size < reach)) Refuse(node, "the image is too small");
      const std::int64_t missing =
          is_same ? std::max<std::int64_t>(0, (window.size[i] - 1) * strides[i] + reach - size) : 0;
      window.before.push_back(missing / 2);
      window.after.push_back(missing - missing / 2);
    }
    return window;
  }

  /// OpenCV 4.6 pads inside a convolution only by the same on both sides.
  std::string Padded(const std::string& input, Window* window) {
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

  static Wholes PadsOf(const Window& window) {
    return {window.before[0], window.before[1], window.after[0], window.after[1]};
  }

  /// TensorFlow has rows x columns x in x out; of depth-wise ones in x multiples; of transposed
  /// ones out x in, and so does ONNX have those the other way round.
  std::string Kernel(const TfjsNode& node, const TfjsTensor& weights, bool is_depthwise) {
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

  const TfjsTensor& KernelInput(const TfjsNode& node) const {
    const TfjsTensor& weights = ConstantInput(node, 1);
    if (weights.shape.size() != 4) Refuse(node, "its kernel does not have four dimensions");
    for (const std::int64_t size : weights.shape) {
      if (size < 1 || size > 65536) Refuse(node, "its kernel has an impossible size");
    }
    return weights;
  }

  Computed Convolve(const TfjsNode& node, bool is_depthwise) {
    const Computed input = ImageInput(node, 0);
    const TfjsTensor& weights = KernelInput(node);
    if (weights.shape[2] != input.shape[3]) Refuse(node, "its kernel does not fit its input");
    const Wholes dilations = Spatial(node, "dilations");
    Window window = SlideOver(node, input.shape, {weights.shape[0], weights.shape[1]},
                              Spatial(node, "strides"), dilations);
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
      const TfjsTensor& bias = ConstantInput(node, 2);
      if (static_cast<std::int64_t>(bias.values.size()) != channels)
        Refuse(node, "its bias does not fit its kernel");
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

  Computed ConvolveTransposed(const TfjsNode& node) {
    const Computed input = ImageInput(node, 2);
    const TfjsTensor& weights = KernelInput(node);
    if (weights.shape[3] != input.shape[3]) Refuse(node, "its kernel does not fit its input");
    const Wholes strides = Spatial(node, "strides");
    const Wholes output = WholeValues(node, InputOf(node, 0), 0);
    if (output.size() != 4) Refuse(node, "the size of its output is unknown");
    Wholes before, after;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::int64_t full = (input.shape[i + 1] - 1) * strides[i] + weights.shape[i];
      const std::int64_t surplus = full - output[i + 1];
      if (surplus < 0 || output[i + 1] < 1) Refuse(node, "the size of its output is impossible");
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

  std::string AddActivation(const TfjsNode& node, const std::string& kind,
                            const std::string& input) {
    const std::string name = NewName(node.name);
    if (kind == "Relu" || kind == "Sigmoid") return Add({kind, {input}, name});
    // OpenCV 4.6 reads the bounds of Clip only where older operator sets had them.
    if (kind == "Relu6") return Add({"Clip", {input}, name, {{"min", 0.0F}, {"max", 6.0F}}});
    Refuse(node, "the activation '" + Shown(kind) + "' is not supported");
  }

  Computed Activate(const TfjsNode& node) {
    const Computed input = Compute(InputOf(node, 0));
    return {AddActivation(node, node.operation, input.name), input.shape};
  }

  std::string Operand(const TfjsNode& node, const TfjsTensor& constant) {
    Wholes shape = constant.shape;
    const std::string name = NewName(node.name);
    if (shape.size() == 1) shape = {1, shape[0], 1, 1};
    if (shape.empty()) shape = {1, 1, 1, 1};
    const bool is_plain = shape.size() == 4 && constant.shape.size() < 2;
    if (!is_plain) Refuse(node, "constants of this shape are not supported");
    onnx_.AddConstant(name, shape, constant.values);
    return name;
  }

  Computed Combine(const TfjsNode& node, const std::string& operation) {
    if (node.inputs.size() != 2) Refuse(node, "must have two inputs");
    std::vector<std::string> names;
    Wholes shape;
    for (const std::string& input : node.inputs) {
      const TfjsTensor* constant = Constant(input);
      if (constant != nullptr) {
        names.push_back(Operand(node, *constant));
        continue;
      }
      const Computed computed = Compute(input);
      names.push_back(computed.name);
      // Of two, the one that is not spread over the other.
      if (shape.size() != computed.shape.size()) shape = computed.shape;
      for (std::size_t i = 0; i < shape.size(); ++i)
        shape[i] = std::max(shape[i], computed.shape[i]);
    }
    if (shape.empty()) Refuse(node, "both inputs are constants");
    return {Add({operation, names, NewName(node.name)}), shape};
  }

  Computed Resize(const TfjsNode& node) {
    const Computed input = ImageInput(node, 0);
    const Wholes size = WholeValues(node, InputOf(node, 1), 0);
    if (size.size() != 2 || size[0] < 1 || size[1] < 1 || std::max(size[0], size[1]) > 65536)
      Refuse(node, "the size of its output is unknown");
    const bool is_half_pixel = WholesOf(node, "half_pixel_centers", {0})[0] != 0;
    const bool is_aligned = WholesOf(node, "align_corners", {0})[0] != 0;
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

  Computed Pool(const TfjsNode& node) {
    const Computed input = ImageInput(node, 0);
    Window window =
        SlideOver(node, input.shape, Spatial(node, "ksize"), Spatial(node, "strides"), {1, 1});
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

  /// Whole numbers that are computed from shapes, as the sizes of images are.
  Wholes WholeValues(const TfjsNode& user, const std::string& input, int depth) {
    if (const TfjsTensor* constant = Constant(input)) {
      Wholes values;
      for (const float value : constant->values)
        values.push_back(static_cast<std::int64_t>(std::clamp(value, -1e9F, 1e9F)));
      return values;
    }
    const TfjsNode& node = Node(Plain(input));
    if (depth > 100) Refuse(node, "depends on itself");
    const auto operand = [&](std::size_t i) {
      return WholeValues(node, InputOf(node, i), depth + 1);
    };
    if (node.operation == "Shape") return Compute(InputOf(node, 0)).shape;
    if (node.operation == "StridedSlice") return Slice(node, operand(0), operand(1), operand(2));
    if (node.operation == "Mul") {
      Wholes a = operand(0);
      const Wholes b = operand(1);
      if (a.size() != b.size()) Refuse(node, "its inputs differ in size");
      for (std::size_t i = 0; i < a.size(); ++i) a[i] *= std::clamp<std::int64_t>(b[i], -64, 64);
      return a;
    }
    Refuse(user, "its size comes from " + Shown(node.operation) + ", which is not supported");
  }

  static Wholes Slice(const TfjsNode& node, const Wholes& values, const Wholes& begin,
                      const Wholes& end) {
    for (const char* mask : {"begin_mask", "end_mask", "ellipsis_mask", "new_axis_mask"}) {
      if (WholesOf(node, mask, {0})[0] != 0) Refuse(node, "its masks are not supported");
    }
    const auto size = static_cast<std::int64_t>(values.size());
    const bool fits = begin.size() == 1 && end.size() == 1 && begin[0] >= 0 && end[0] > begin[0] &&
                      end[0] <= size;
    if (!fits) Refuse(node, "its range is not supported");
    return {values.begin() + begin[0], values.begin() + end[0]};
  }

  const TfjsModel& model_;
  const TfjsCut& cut_;
  OnnxWriter onnx_;
  std::map<std::string, Computed> computed_;
  std::set<std::string> in_work_;
  int num_names_ = 0;
};

}  // namespace

std::string TfjsToOnnx(const TfjsModel& model, const TfjsCut& cut) {
  return Converter(model, cut).Convert();
}

}  // namespace airdos
