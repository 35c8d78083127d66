#ifndef AIRDOS_COMMON_PERCEPTION_TFJS_CONVERTER_H_
#define AIRDOS_COMMON_PERCEPTION_TFJS_CONVERTER_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/perception/onnx_writer.h"
#include "common/perception/tfjs_graph.h"
#include "common/perception/tfjs_to_onnx.h"

namespace airdos {

/// What TfjsToOnnx() does: walks from the outputs back to the input (tfjs_to_onnx.cc), and adds the
/// ONNX operators of each node once those of its inputs are there (tfjs_operators.cc). Names and
/// order of what is written depend on the order of the walk only.
class TfjsConverter {
 public:
  /// Neither is owned.
  TfjsConverter(const TfjsModel& model, const TfjsCut& cut) : graph_(model), cut_(cut) {}

  /// The ONNX file.
  std::string Convert();

 private:
  using Wholes = TfjsGraph::Wholes;

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

  // The walk.
  Computed Compute(const std::string& input);
  Computed ComputeNode(const TfjsNode& node);
  Computed ImageInput(const TfjsNode& node, std::size_t index);
  /// Whole numbers that are computed from shapes, as the sizes of images are.
  Wholes WholeValues(const TfjsNode& user, const std::string& input, int depth);
  static Wholes Slice(const TfjsNode& node, const Wholes& values, const Wholes& begin,
                      const Wholes& end);

  // The operators.
  Computed Convolve(const TfjsNode& node, bool is_depthwise);
  Computed ConvolveTransposed(const TfjsNode& node);
  Computed Combine(const TfjsNode& node, const std::string& operation);
  Computed Activate(const TfjsNode& node);
  Computed Resize(const TfjsNode& node);
  Computed Pool(const TfjsNode& node);
  static Window SlideOver(const TfjsNode& node, const Wholes& shape, const Wholes& kernel,
                          const Wholes& strides, const Wholes& dilations);
  /// OpenCV 4.6 pads inside a convolution only by the same on both sides.
  std::string Padded(const std::string& input, Window* window);
  static Wholes PadsOf(const Window& window);
  /// TensorFlow has rows x columns x in x out; of depth-wise ones in x multiples; of transposed
  /// ones out x in, and so does ONNX have those the other way round.
  std::string Kernel(const TfjsNode& node, const TfjsTensor& weights, bool is_depthwise);
  std::string AddActivation(const TfjsNode& node, const std::string& kind,
                            const std::string& input);
  std::string Operand(const TfjsNode& node, const TfjsTensor& constant);
  std::string NewName(const std::string& base);
  std::string Add(const OnnxNode& node);

  TfjsGraph graph_;
  const TfjsCut& cut_;
  OnnxWriter onnx_;
  std::map<std::string, Computed> computed_;
  std::set<std::string> in_work_;
  int num_names_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_TFJS_CONVERTER_H_
