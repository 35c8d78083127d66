#ifndef AIRDOS_COMMON_PERCEPTION_TFJS_MODEL_H_
#define AIRDOS_COMMON_PERCEPTION_TFJS_MODEL_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// A constant of the model; whole numbers and switches are stored as floats, too.
struct TfjsTensor {
  std::vector<std::int64_t> shape;
  std::vector<float> values;
};

/// An operation with those of its attributes that are texts, numbers or lists of these.
struct TfjsNode {
  std::string name;
  std::string operation;
  std::vector<std::string> inputs;  ///< names of nodes or constants
  std::map<std::string, std::vector<std::string>> texts;
  std::map<std::string, std::vector<std::int64_t>> wholes;  ///< switches are 0 and 1
};

/// A TensorFlow.js graph model.
struct TfjsModel {
  std::map<std::string, TfjsNode> nodes;
  std::map<std::string, TfjsTensor> weights;
};

/// Reads model.json and, from the same folder, the files of weights that it names (float32,
/// float16, uint8 and uint16 with scale, int32, bool). Throws InputError naming the file if
/// something is missing, malformed, or not a graph model.
TfjsModel ReadTfjsModel(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_TFJS_MODEL_H_
