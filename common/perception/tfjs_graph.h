#ifndef AIRDOS_COMMON_PERCEPTION_TFJS_GRAPH_H_
#define AIRDOS_COMMON_PERCEPTION_TFJS_GRAPH_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/perception/tfjs_model.h"

namespace airdos {

/// Looks things up in a model: nodes, constants, and what the attributes of a node say. Throws
/// InputError naming the node and its operation where something is not there, or impossible.
class TfjsGraph {
 public:
  using Wholes = std::vector<std::int64_t>;

  /// The model is not owned.
  explicit TfjsGraph(const TfjsModel& model) : model_(model) {}

  std::string Placeholder() const;
  const TfjsNode& Node(const std::string& name) const;
  /// The constant that an input is, or that stands behind its alias; null if it is computed.
  const TfjsTensor* Constant(const std::string& input) const;
  const TfjsTensor& ConstantInput(const TfjsNode& node, std::size_t index) const;
  /// Input 1, four dimensions of 1 to 65536.
  const TfjsTensor& KernelInput(const TfjsNode& node) const;

  /// Nodes are named as "name:output", and those that only come first as "^name".
  static std::string Plain(const std::string& input);
  static const std::string& InputOf(const TfjsNode& node, std::size_t index);
  static Wholes WholesOf(const TfjsNode& node, const std::string& name, const Wholes& otherwise);
  static std::string TextOf(const TfjsNode& node, const std::string& name);
  /// Rows and columns of an attribute that speaks of all four dimensions.
  static Wholes Spatial(const TfjsNode& node, const std::string& name);
  [[noreturn]] static void Refuse(const TfjsNode& node, const std::string& why);

 private:
  const TfjsModel& model_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_TFJS_GRAPH_H_
