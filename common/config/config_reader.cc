#include "common/config/config_reader.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/suggestion.h"
#include "common/util/words.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxTextBytes = 100000;
constexpr std::size_t kMaxValues = 1000;
constexpr int kMaxDepth = 8;

// Aliases make a tree of 2^n values of n lines, or one without an end: so both its size and its
// depth are bounded.
void Flatten(const YAML::Node& node, const std::string& prefix, const std::string& name, int depth,
             std::map<std::string, std::string>* values) {
  if (depth > kMaxDepth) throw InputError(name + ": key '" + prefix + "' is nested too deeply");
  if (values->size() > kMaxValues) throw InputError(name + ": holds too many keys");
  if (node.IsScalar()) {
    if (!values->emplace(prefix, node.Scalar()).second) {
      throw InputError(name + ": key '" + prefix + "' appears twice");
    }
    return;
  }
  if (!node.IsMap()) {
    throw InputError(name + ": key '" + prefix + "' must be one value or a section");
  }
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    Flatten(entry.second, prefix.empty() ? key : prefix + "." + key, name, depth + 1, values);
  }
}

}  // namespace

ConfigReader ConfigReader::FromFile(const std::string& path, const RenamedKeys& renamed) {
  RequireRegularFile(path);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::string text(kMaxTextBytes + 1, '\0');  // one more, which FromString() refuses
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return FromString(text, path, renamed);
}

ConfigReader ConfigReader::FromString(const std::string& text, const std::string& name,
                                      const RenamedKeys& renamed) {
  ConfigReader reader;
  reader.name_ = name;
  reader.renamed_ = renamed;
  if (text.size() > kMaxTextBytes) {
    throw InputError(name + ": holds more than " + std::to_string(kMaxTextBytes) + " bytes");
  }
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsNull()) Flatten(root, "", name, 0, &reader.values_);
  } catch (const YAML::Exception& error) {
    throw InputError(name + ": line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  for (const auto& [key, value] : reader.values_) reader.RequireNotRenamed(key);
  return reader;
}

void ConfigReader::RequireNotRenamed(const std::string& key) const {
  const auto it = renamed_.find(key);
  if (it == renamed_.end()) return;
  throw InputError(name_ + ": key '" + key + "' is called '" + it->second + "' now");
}

void ConfigReader::Override(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError(name_ + ": '" + assignment + "' is not of the form section.key=value");
  }
  const std::string key = assignment.substr(0, equals);
  const auto it = values_.find(key);
  if (it == values_.end()) {
    RequireNotRenamed(key);
    Fail(key, assignment.substr(equals + 1), "there is no such key" + DidYouMean(key, Keys()));
  }
  it->second = assignment.substr(equals + 1);
}

const std::string& ConfigReader::Raw(const std::string& key) {
  const auto it = values_.find(key);
  if (it == values_.end()) throw InputError(name_ + ": key '" + key + "' is missing");
  read_.insert(key);
  return it->second;
}

void ConfigReader::Fail(const std::string& key, const std::string& value,
                        const std::string& why) const {
  throw InputError(name_ + ": key '" + key + "' with value '" + value + "': " + why);
}

void ConfigReader::Read(const std::string& key, bool* value) {
  const std::string& raw = Raw(key);
  if (raw != "true" && raw != "false") Fail(key, raw, "must be true or false");
  *value = raw == "true";
}

void ConfigReader::Read(const std::string& key, std::string* value) { *value = Raw(key); }

void ConfigReader::Read(const std::string& key, int* value, int min, int max) {
  double number = 0;
  Read(key, &number, min, max);
  if (number != std::floor(number)) Fail(key, Raw(key), "must be a whole number");
  *value = static_cast<int>(number);
}

void ConfigReader::Read(const std::string& key, double* value, double min, double max) {
  const std::string& raw = Raw(key);
  std::istringstream stream(raw);
  stream.imbue(std::locale::classic());
  double number = 0;
  if (!(stream >> number) || !stream.eof()) Fail(key, raw, "must be a number");
  if (!(number >= min && number <= max)) {
    std::ostringstream why;
    why << "must lie between " << min << " and " << max;
    Fail(key, raw, why.str());
  }
  *value = number;
}

int ConfigReader::ReadChoice(const std::string& key, const std::vector<std::string>& choices) {
  const std::string& raw = Raw(key);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == raw) return static_cast<int>(i);
  }
  Fail(key, raw, "must be one of " + JoinWords(choices, ", ") + DidYouMean(raw, choices));
}

void ConfigReader::Finish() const {
  for (const auto& [key, value] : values_) {
    if (read_.count(key) > 0) continue;
    Fail(key, value,
         "there is no such key" +
             DidYouMean(key, std::vector<std::string>(read_.begin(), read_.end())));
  }
}

std::string ConfigReader::Resolved() const {
  std::string text;
  for (const auto& [key, value] : values_) text += key + ": " + QuotedYaml(value) + "\n";
  return text;
}

std::vector<std::string> ConfigReader::Keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : values_) keys.push_back(key);
  return keys;
}

std::string QuotedYaml(const std::string& value) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,+-";
  if (!value.empty() && value.find_first_not_of(kPlain) == std::string::npos) return value;
  YAML::Emitter text;
  text << YAML::DoubleQuoted << value;
  return text.c_str();
}

}  // namespace airdos
