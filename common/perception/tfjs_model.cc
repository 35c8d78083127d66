#include "common/perception/tfjs_model.h"

#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = 1u << 30;

std::string ReadBytes(const std::string& path) {
  RequireRegularFile(path);
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) > kMaxBytes)
    throw InputError(path + ": is larger than 1 GB");
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file && !file.eof()) throw InputError(path + ": cannot be read");
  return bytes;
}

/// Texts are written in base64. Nothing if it is not that.
std::optional<std::string> FromBase64(const std::string& text) {
  static const std::string kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int num_bits = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    const std::size_t value = kLetters.find(letter);
    if (value == std::string::npos) return std::nullopt;
    bits = (bits << 6 | static_cast<unsigned>(value)) & 0xffffff;
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes.push_back(static_cast<char>(bits >> num_bits & 0xff));
  }
  return bytes;
}

/// Whole numbers are written as texts or as numbers.
std::int64_t ToWhole(const json& value) {
  return value.is_string() ? std::stoll(value.get<std::string>()) : value.get<std::int64_t>();
}

void AddAttribute(const std::string& name, const json& value, TfjsNode* node) {
  const bool is_list = value.contains("list");
  const json& content = is_list ? value.at("list") : value;
  const auto as_list = [&](const char* kind) {
    const json& of_kind = content.at(kind);
    return is_list ? of_kind : json::array({of_kind});
  };
  if (content.contains("s")) {
    for (const json& text : as_list("s")) {
      const auto bytes = FromBase64(text.get<std::string>());
      if (bytes) node->texts[name].push_back(*bytes);
    }
  } else if (content.contains("i")) {
    for (const json& number : as_list("i")) node->wholes[name].push_back(ToWhole(number));
  } else if (content.contains("b")) {
    for (const json& is_set : as_list("b"))
      node->wholes[name].push_back(is_set.get<bool>() ? 1 : 0);
  }
}

TfjsNode ToNode(const json& entry) {
  TfjsNode node;
  node.name = entry.at("name").get<std::string>();
  node.operation = entry.at("op").get<std::string>();
  if (entry.contains("input")) node.inputs = entry.at("input").get<std::vector<std::string>>();
  if (entry.contains("attr")) {
    for (const auto& [name, value] : entry.at("attr").items()) AddAttribute(name, value, &node);
  }
  return node;
}

/// The bytes of all weights of one group, handed out one after the other.
class WeightBytes {
 public:
  WeightBytes(std::string path, std::string bytes)
      : path_(std::move(path)), bytes_(std::move(bytes)) {}

  /// Numbers of type Number.
  template <class Number>
  std::vector<float> Take(std::size_t number) {
    const std::size_t num_left = (bytes_.size() - position_) / sizeof(Number);
    if (number > num_left) throw InputError(path_ + ": its weights are cut short");
    std::vector<float> values;
    values.reserve(number);
    for (std::size_t i = 0; i < number; ++i, position_ += sizeof(Number)) {
      Number value;
      std::memcpy(static_cast<void*>(&value), bytes_.data() + position_, sizeof value);
      values.push_back(static_cast<float>(value));
    }
    return values;
  }

  std::vector<float> Take(const std::string& type, std::size_t number) {
    if (type == "float32") return Take<float>(number);
    if (type == "float16") return Take<cv::float16_t>(number);
    if (type == "int32") return Take<std::int32_t>(number);
    if (type == "uint16") return Take<std::uint16_t>(number);
    if (type == "uint8" || type == "bool") return Take<std::uint8_t>(number);
    throw InputError(path_ + ": weights of type '" + Shown(type) + "' are not read");
  }

 private:
  std::string path_;
  std::string bytes_;
  std::size_t position_ = 0;
};

TfjsTensor ToTensor(const json& entry, WeightBytes* bytes) {
  TfjsTensor tensor;
  tensor.shape = entry.at("shape").get<std::vector<std::int64_t>>();
  std::size_t number = 1;
  for (const std::int64_t size : tensor.shape) {
    if (size < 0 || size > static_cast<std::int64_t>(kMaxBytes) || number > kMaxBytes)
      throw InputError("a tensor has an impossible shape");
    number *= static_cast<std::size_t>(size);
  }
  if (!entry.contains("quantization")) {
    tensor.values = bytes->Take(entry.at("dtype").get<std::string>(), number);
    return tensor;
  }
  const json& quantization = entry.at("quantization");
  tensor.values = bytes->Take(quantization.at("dtype").get<std::string>(), number);
  if (!quantization.contains("scale")) return tensor;
  const auto scale = quantization.at("scale").get<float>();
  const auto min = quantization.at("min").get<float>();
  for (float& value : tensor.values) value = value * scale + min;
  return tensor;
}

TfjsModel FromJson(const std::string& path, const json& file) {
  TfjsModel model;
  for (const json& entry : file.at("modelTopology").at("node")) {
    TfjsNode node = ToNode(entry);
    const std::string name = node.name;
    model.nodes.emplace(name, std::move(node));
  }
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const json& group : file.at("weightsManifest")) {
    std::string bytes;
    for (const json& name : group.at("paths")) {
      // Of the name alone: the file lies beside, whatever the model says.
      const auto file_name = std::filesystem::path(name.get<std::string>()).filename();
      bytes += ReadBytes((folder / file_name).string());
    }
    WeightBytes weights(path, std::move(bytes));
    for (const json& entry : group.at("weights")) {
      model.weights[entry.at("name").get<std::string>()] = ToTensor(entry, &weights);
    }
  }
  return model;
}

}  // namespace

TfjsModel ReadTfjsModel(const std::string& path) {
  try {
    return FromJson(path, json::parse(ReadBytes(path)));
  } catch (const InputError& error) {
    const std::string text = error.what();
    throw InputError(text.find(": ") == std::string::npos ? path + ": " + text : text);
  } catch (const std::exception&) {  // of the JSON library, or of a number
    throw InputError(path + ": is not a TensorFlow.js graph model (model.json)");
  }
}

}  // namespace airdos
