#include "common/perception/onnx_writer.h"

#include <cstring>

#include "common/util/check.h"

namespace airdos {
namespace {

// Numbers of the fields in onnx.proto, and of its types.
namespace field {
enum Model { kIrVersion = 1, kGraph = 7, kOperatorSet = 8 };
enum OperatorSet { kVersion = 2 };
enum Graph { kNode = 1, kGraphName = 2, kConstant = 5, kInput = 11, kOutput = 12 };
enum Node { kNodeInput = 1, kNodeOutput = 2, kNodeName = 3, kOperation = 4, kAttribute = 5 };
enum Attribute {
  kAttributeName = 1,
  kFloat = 2,
  kInt = 3,
  kText = 4,
  kInts = 8,
  kAttributeType = 20
};
enum Tensor { kDimensions = 1, kDataType = 2, kTensorName = 8, kRawData = 9 };
enum Value { kValueName = 1, kValueType = 2 };
enum Type { kTensorType = 1 };
enum TensorType { kElementType = 1, kShape = 2 };
enum Shape { kDimension = 1 };
enum Dimension { kSize = 1 };
}  // namespace field

constexpr int kFloatData = 1;
constexpr int kInt64Data = 7;
constexpr int kIrVersion = 7;
constexpr int kOperatorSetVersion = 11;

enum WireType { kVarint = 0, kBytes = 2, kFixed32 = 5 };

void PutVarint(std::uint64_t value, std::string* bytes) {
  for (; value >= 0x80; value >>= 7) bytes->push_back(static_cast<char>((value & 0x7f) | 0x80));
  bytes->push_back(static_cast<char>(value));
}

void PutKey(int number, WireType type, std::string* bytes) {
  PutVarint(static_cast<std::uint64_t>(number) << 3 | type, bytes);
}

void PutInt(int number, std::int64_t value, std::string* bytes) {
  PutKey(number, kVarint, bytes);
  PutVarint(static_cast<std::uint64_t>(value), bytes);
}

void PutBytes(int number, const std::string& value, std::string* bytes) {
  PutKey(number, kBytes, bytes);
  PutVarint(value.size(), bytes);
  *bytes += value;
}

void PutFloat(int number, float value, std::string* bytes) {
  PutKey(number, kFixed32, bytes);
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes->append(raw, sizeof value);
}

/// Writes the value of an attribute and its type.
struct AttributeValue {
  std::string* bytes;

  void operator()(std::int64_t value) const {
    PutInt(field::kInt, value, bytes);
    PutInt(field::kAttributeType, 2, bytes);
  }
  void operator()(float value) const {
    PutFloat(field::kFloat, value, bytes);
    PutInt(field::kAttributeType, 1, bytes);
  }
  void operator()(const std::string& value) const {
    PutBytes(field::kText, value, bytes);
    PutInt(field::kAttributeType, 3, bytes);
  }
  void operator()(const std::vector<std::int64_t>& values) const {
    for (const std::int64_t value : values) PutInt(field::kInts, value, bytes);
    PutInt(field::kAttributeType, 7, bytes);
  }
};

std::string ValueBytes(const OnnxValue& value) {
  std::string shape;
  for (const std::int64_t size : value.shape) {
    std::string dimension;
    PutInt(field::kSize, size, &dimension);
    PutBytes(field::kDimension, dimension, &shape);
  }
  std::string tensor;
  PutInt(field::kElementType, kFloatData, &tensor);
  PutBytes(field::kShape, shape, &tensor);
  std::string type;
  PutBytes(field::kTensorType, tensor, &type);
  std::string bytes;
  PutBytes(field::kValueName, value.name, &bytes);
  PutBytes(field::kValueType, type, &bytes);
  return bytes;
}

std::size_t NumValues(const OnnxShape& shape) {
  std::size_t number = 1;
  for (const std::int64_t size : shape) number *= static_cast<std::size_t>(size);
  return number;
}

}  // namespace

void OnnxWriter::AddTensor(const std::string& name, const OnnxShape& shape, int type,
                           const void* data, std::size_t num_bytes) {
  std::string tensor;
  for (const std::int64_t size : shape) PutInt(field::kDimensions, size, &tensor);
  PutInt(field::kDataType, type, &tensor);
  PutBytes(field::kTensorName, name, &tensor);
  PutBytes(field::kRawData, std::string(static_cast<const char*>(data), num_bytes), &tensor);
  PutBytes(field::kConstant, tensor, &constants_);
}

void OnnxWriter::AddConstant(const std::string& name, const OnnxShape& shape,
                             const std::vector<float>& values) {
  AIRDOS_CHECK(values.size() == NumValues(shape));
  AddTensor(name, shape, kFloatData, values.data(), values.size() * sizeof(float));
}

void OnnxWriter::AddConstant(const std::string& name, const OnnxShape& shape,
                             const std::vector<std::int64_t>& values) {
  AIRDOS_CHECK(values.size() == NumValues(shape));
  AddTensor(name, shape, kInt64Data, values.data(), values.size() * sizeof(std::int64_t));
}

void OnnxWriter::AddNode(const OnnxNode& node) {
  std::string bytes;
  for (const std::string& input : node.inputs) PutBytes(field::kNodeInput, input, &bytes);
  PutBytes(field::kNodeOutput, node.output, &bytes);
  PutBytes(field::kNodeName, node.output, &bytes);
  PutBytes(field::kOperation, node.operation, &bytes);
  for (const OnnxAttribute& attribute : node.attributes) {
    std::string value;
    PutBytes(field::kAttributeName, attribute.name, &value);
    std::visit(AttributeValue{&value}, attribute.value);
    PutBytes(field::kAttribute, value, &bytes);
  }
  PutBytes(field::kNode, bytes, &nodes_);
}

std::string OnnxWriter::Bytes(const OnnxValue& input, const std::vector<OnnxValue>& outputs) const {
  std::string graph = nodes_;
  PutBytes(field::kGraphName, "network", &graph);
  graph += constants_;
  PutBytes(field::kInput, ValueBytes(input), &graph);
  for (const OnnxValue& output : outputs) PutBytes(field::kOutput, ValueBytes(output), &graph);
  std::string operators;
  PutInt(field::kVersion, kOperatorSetVersion, &operators);
  std::string model;
  PutInt(field::kIrVersion, kIrVersion, &model);
  PutBytes(field::kGraph, graph, &model);
  PutBytes(field::kOperatorSet, operators, &model);
  return model;
}

}  // namespace airdos
