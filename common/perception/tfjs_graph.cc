#include "common/perception/tfjs_graph.h"

#include <algorithm>

#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {

void TfjsGraph::Refuse(const TfjsNode& node, const std::string& why) {
  throw InputError("node '" + Shown(node.name) + "' (" + Shown(node.operation) + "): " + why);
}

std::string TfjsGraph::Plain(const std::string& input) {
  const std::string name = input.substr(0, input.find(':'));
  return name.empty() || name[0] != '^' ? name : name.substr(1);
}

std::string TfjsGraph::Placeholder() const {
  for (const auto& [name, node] : model_.nodes) {
    if (node.operation == "Placeholder") return name;
  }
  throw InputError("the model has no placeholder for its input");
}

const TfjsNode& TfjsGraph::Node(const std::string& name) const {
  const auto node = model_.nodes.find(name);
  if (node == model_.nodes.end()) throw InputError("the model has no node '" + Shown(name) + "'");
  return node->second;
}

const std::string& TfjsGraph::InputOf(const TfjsNode& node, std::size_t index) {
  if (index >= node.inputs.size()) Refuse(node, "has too few inputs");
  return node.inputs[index];
}

TfjsGraph::Wholes TfjsGraph::WholesOf(const TfjsNode& node, const std::string& name,
                                      const Wholes& otherwise) {
  const auto found = node.wholes.find(name);
  return found == node.wholes.end() || found->second.empty() ? otherwise : found->second;
}

std::string TfjsGraph::TextOf(const TfjsNode& node, const std::string& name) {
  const auto found = node.texts.find(name);
  return found == node.texts.end() || found->second.empty() ? "" : found->second[0];
}

TfjsGraph::Wholes TfjsGraph::Spatial(const TfjsNode& node, const std::string& name) {
  const Wholes all = WholesOf(node, name, {1, 1, 1, 1});
  if (all.size() != 4 || all[1] < 1 || all[2] < 1 || std::max(all[1], all[2]) > 4096)
    Refuse(node, "has impossible " + name);
  return {all[1], all[2]};
}

const TfjsTensor* TfjsGraph::Constant(const std::string& input) const {
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

const TfjsTensor& TfjsGraph::ConstantInput(const TfjsNode& node, std::size_t index) const {
  const TfjsTensor* constant = Constant(InputOf(node, index));
  if (constant == nullptr) Refuse(node, "its input " + std::to_string(index) + " is no constant");
  return *constant;
}

const TfjsTensor& TfjsGraph::KernelInput(const TfjsNode& node) const {
  const TfjsTensor& weights = ConstantInput(node, 1);
  if (weights.shape.size() != 4) Refuse(node, "its kernel does not have four dimensions");
  for (const std::int64_t size : weights.shape) {
    if (size < 1 || size > 65536) Refuse(node, "its kernel has an impossible size");
  }
  return weights;
}

}  // namespace airdos
