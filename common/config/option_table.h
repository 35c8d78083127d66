#ifndef AIRDOS_COMMON_CONFIG_OPTION_TABLE_H_
#define AIRDOS_COMMON_CONFIG_OPTION_TABLE_H_

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/config_reader.h"

namespace airdos {

/// A value must lie in [min, max].
struct Range {
  double min = 0;
  double max = 0;
};

/// A word of a configuration file, what it stands for, and what it does.
template <class Enum>
struct Choice {
  std::string word;
  Enum value;
  std::string help;
};

/// One option as its table describes it.
struct Option {
  /// What its value is: true or false, a whole number, any number, a text, a list of words or of
  /// whole numbers, one of a few words.
  enum class Kind { kSwitch, kWhole, kNumber, kText, kWords, kWholes, kChoice };
  Kind kind = Kind::kText;
  std::string key;                          ///< "section.key"
  std::string unit;                         ///< empty: none, or plain from the help
  std::optional<Range> range;               ///< of numbers
  std::vector<std::string> help;            ///< paragraphs; of a choice one for each word
  std::vector<std::string> words;           ///< of a choice
  std::vector<const void*> members;         ///< that it sets
  std::function<void(ConfigReader*)> read;  ///< into the members
  std::function<std::string()> value;       ///< of the (first) member, as YAML reads it
};

/// All options of one configuration file, bound to the members of an options object: the one place
/// for key, member, unit, range and help. The default is the value that the member has before
/// anything is read. A process has one function that fills it, `TableOf(Options*)`; what is done
/// with a table is below and in option_pages.h.
class OptionTable {
 public:
  /// The options from `first_option` to the next section's, under one heading of the file.
  struct Section {
    std::string name;
    std::string help;
    std::size_t first_option = 0;
  };

  /// `name` of the file without .yaml; `about` it, the comment at its head.
  OptionTable(std::string name, std::string about);

  /// Those that follow are in this section; each section stands once.
  void AddSection(const std::string& name, const std::string& help = "");

  void Add(const std::string& key, bool* member, const std::string& help);
  void Add(const std::string& key, int* member, const Range& range, const std::string& unit,
           const std::string& help);
  void Add(const std::string& key, double* member, const Range& range, const std::string& unit,
           const std::string& help);
  void Add(const std::string& key, std::string* member, const std::string& help);
  /// Lists are written with commas. Of words: empty for none; of numbers: at least one.
  void Add(const std::string& key, std::vector<std::string>* member, const std::string& help);
  void Add(const std::string& key, std::vector<int>* member, const Range& range,
           const std::string& unit, const std::string& help);

  /// One value for members that mean the same to several steps; they have the same default.
  void AddShared(const std::string& key, const std::vector<double*>& members, const Range& range,
                 const std::string& unit, const std::string& help);

  template <class Enum>
  void AddChoice(const std::string& key, Enum* member, const std::vector<Choice<Enum>>& choices) {
    Option option;
    for (const Choice<Enum>& choice : choices) {
      option.words.push_back(choice.word);
      option.help.push_back(choice.word + ": " + choice.help);
    }
    option.read = [key, member, choices, words = option.words](ConfigReader* config) {
      *member = choices[static_cast<std::size_t>(config->ReadChoice(key, words))].value;
    };
    option.value = [member, choices] {
      for (const Choice<Enum>& choice : choices) {
        if (choice.value == *member) return choice.word;
      }
      return std::string();
    };
    Append(Option::Kind::kChoice, key, {member}, std::move(option));
  }

  /// What is read is refused if the number of `key` is below that of `other`.
  void RequireNotBelow(const std::string& key, const std::string& other);

  /// Keys of earlier versions: a file or an assignment with one is answered with the new one.
  void SetRenamed(RenamedKeys renamed) { renamed_ = std::move(renamed); }

  /// All options, from a configuration that holds each; the caller calls Finish(). Throws
  /// InputError naming key and value.
  void Read(ConfigReader* config) const;

  const std::string& name() const { return name_; }
  const std::string& about() const { return about_; }
  const std::vector<Section>& sections() const { return sections_; }
  const std::vector<Option>& options() const { return options_; }
  const RenamedKeys& renamed() const { return renamed_; }

 private:
  void Append(Option::Kind kind, const std::string& key, std::vector<const void*> members,
              Option option);
  const Option& Find(const std::string& key) const;

  std::string name_;
  std::string about_;
  std::vector<Section> sections_;
  std::vector<Option> options_;
  std::vector<std::pair<std::string, std::string>> not_below_;
  RenamedKeys renamed_;
};

/// The options that a configuration says, by the table of their type.
template <class Options>
Options ReadOptions(ConfigReader* config) {
  Options options;
  TableOf(&options).Read(config);
  return options;
}

}  // namespace airdos

#endif  // AIRDOS_COMMON_CONFIG_OPTION_TABLE_H_
