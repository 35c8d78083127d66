#ifndef AIRDOS_COMMON_PERCEPTION_ONNX_WRITER_H_
#define AIRDOS_COMMON_PERCEPTION_ONNX_WRITER_H_

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace airdos {

using OnnxShape = std::vector<std::int64_t>;

/// An attribute of a node: a whole number, a number, a text, or a list of whole numbers.
struct OnnxAttribute {
  std::string name;
  std::variant<std::int64_t, float, std::string, std::vector<std::int64_t>> value;
};

/// One operation; its inputs are names of constants, of the network's input, or of the outputs of
/// nodes added before it. An empty name is an input that is left out.
struct OnnxNode {
  std::string operation;
  std::vector<std::string> inputs;
  std::string output;
  std::vector<OnnxAttribute> attributes = {};
};

/// An input or output of the network with its shape.
struct OnnxValue {
  std::string name;
  OnnxShape shape;
};

/// Writes a network in the ONNX format (operator set 11), as cv::dnn::readNetFromONNX reads it. It
/// knows only the format: whether the operations fit together is for the reader to say.
class OnnxWriter {
 public:
  /// Adds a constant tensor, row by row. AIRDOS_CHECKs that there are as many values as the shape
  /// says.
  void AddConstant(const std::string& name, const OnnxShape& shape,
                   const std::vector<float>& values);
  void AddConstant(const std::string& name, const OnnxShape& shape,
                   const std::vector<std::int64_t>& values);
  void AddNode(const OnnxNode& node);

  /// The file's bytes.
  std::string Bytes(const OnnxValue& input, const std::vector<OnnxValue>& outputs) const;

 private:
  void AddTensor(const std::string& name, const OnnxShape& shape, int type, const void* data,
                 std::size_t num_bytes);

  std::string constants_;  // fields of the graph
  std::string nodes_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_ONNX_WRITER_H_
