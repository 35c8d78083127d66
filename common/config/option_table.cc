#include "common/config/option_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "common/util/check.h"
#include "common/util/words.h"

namespace airdos {
namespace {

/// The shortest text that is read as this number again; with a point or an exponent, so that it is
/// not taken for a whole one.
std::string NumberText(double number) {
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  std::string text(buffer.data(), end);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
    return text.find('.') == std::string::npos ? text + ".0" : text;
  const std::size_t digits = exponent + 2;  // 1e-04: behind the sign
  text.erase(digits, text.find_first_not_of('0', digits) - digits);
  return text;
}

std::vector<int> ReadWholes(const std::string& key, const Range& range, ConfigReader* config) {
  std::string text;
  config->Read(key, &text);
  std::vector<int> numbers;
  for (const std::string& part : SplitAtCommas(text)) {
    std::istringstream stream(part);
    int number = 0;
    if (!(stream >> number) || !stream.eof() || number < range.min || number > range.max) {
      std::ostringstream why;
      why << "must be whole numbers between " << range.min << " and " << range.max
          << ", separated by commas";
      config->Fail(key, text, why.str());
    }
    numbers.push_back(number);
  }
  if (numbers.empty()) config->Fail(key, text, "must name at least one number");
  return numbers;
}

}  // namespace

OptionTable::OptionTable(std::string name, std::string about)
    : name_(std::move(name)), about_(std::move(about)) {}

void OptionTable::AddSection(const std::string& name, const std::string& help) {
  for (const Section& section : sections_) AIRDOS_CHECK(section.name != name);
  sections_.push_back({name, help, options_.size()});
}

void OptionTable::Append(Option::Kind kind, const std::string& key,
                         std::vector<const void*> members, Option option) {
  AIRDOS_CHECK(!sections_.empty() && key.rfind(sections_.back().name + ".", 0) == 0);
  option.kind = kind;
  option.key = key;
  option.members = std::move(members);
  options_.push_back(std::move(option));
}

void OptionTable::Add(const std::string& key, bool* member, const std::string& help) {
  Option option;
  option.help = {help};
  option.read = [=](ConfigReader* config) { config->Read(key, member); };
  option.value = [member] { return std::string(*member ? "true" : "false"); };
  Append(Option::Kind::kSwitch, key, {member}, std::move(option));
}

void OptionTable::Add(const std::string& key, int* member, const Range& range,
                      const std::string& unit, const std::string& help) {
  Option option;
  option.unit = unit;
  option.range = range;
  option.help = {help};
  option.read = [=](ConfigReader* config) {
    config->Read(key, member, static_cast<int>(range.min), static_cast<int>(range.max));
  };
  option.value = [member] { return std::to_string(*member); };
  Append(Option::Kind::kWhole, key, {member}, std::move(option));
}

void OptionTable::Add(const std::string& key, double* member, const Range& range,
                      const std::string& unit, const std::string& help) {
  AddShared(key, {member}, range, unit, help);
}

void OptionTable::AddShared(const std::string& key, const std::vector<double*>& members,
                            const Range& range, const std::string& unit, const std::string& help) {
  AIRDOS_CHECK(!members.empty());
  Option option;
  option.unit = unit;
  option.range = range;
  option.help = {help};
  option.read = [=](ConfigReader* config) {
    for (double* member : members) config->Read(key, member, range.min, range.max);
  };
  option.value = [members] {
    for (const double* member : members) AIRDOS_CHECK(*member == *members.front());
    return NumberText(*members.front());
  };
  Append(Option::Kind::kNumber, key, {members.begin(), members.end()}, std::move(option));
}

void OptionTable::Add(const std::string& key, std::string* member, const std::string& help) {
  Option option;
  option.help = {help};
  option.read = [=](ConfigReader* config) { config->Read(key, member); };
  option.value = [member] { return QuotedYaml(*member); };
  Append(Option::Kind::kText, key, {member}, std::move(option));
}

void OptionTable::Add(const std::string& key, std::vector<std::string>* member,
                      const std::string& help) {
  Option option;
  option.help = {help};
  option.read = [=](ConfigReader* config) {
    std::string text;
    config->Read(key, &text);
    *member = SplitAtCommas(text);
  };
  option.value = [member] { return QuotedYaml(JoinWords(*member, ",")); };
  Append(Option::Kind::kWords, key, {member}, std::move(option));
}

void OptionTable::Add(const std::string& key, std::vector<int>* member, const Range& range,
                      const std::string& unit, const std::string& help) {
  Option option;
  option.unit = unit;
  option.range = range;
  option.help = {help};
  option.read = [=](ConfigReader* config) { *member = ReadWholes(key, range, config); };
  option.value = [member] {
    std::string text;
    for (const int number : *member) text += (text.empty() ? "" : ",") + std::to_string(number);
    return text;
  };
  Append(Option::Kind::kWholes, key, {member}, std::move(option));
}

const Option& OptionTable::Find(const std::string& key) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const Option& option) { return option.key == key; });
  AIRDOS_CHECK(found != options_.end());
  return *found;
}

void OptionTable::RequireNotBelow(const std::string& key, const std::string& other) {
  AIRDOS_CHECK(Find(key).range && Find(other).range);
  not_below_.emplace_back(key, other);
}

void OptionTable::Read(ConfigReader* config) const {
  for (const Option& option : options_) option.read(config);
  for (const auto& [key, other] : not_below_) {
    double value = 0, least = 0;
    config->Read(key, &value, Find(key).range->min, Find(key).range->max);
    config->Read(other, &least, Find(other).range->min, Find(other).range->max);
    if (value >= least) continue;
    config->Fail(key, Find(key).value(), "must not be below " + other + ", " + Find(other).value());
  }
}

}  // namespace airdos
