#ifndef AIRDOS_COMMON_CONFIG_CONFIG_READER_H_
#define AIRDOS_COMMON_CONFIG_CONFIG_READER_H_

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace airdos {

/// Keys that had another name in an earlier version: old name, name now.
using RenamedKeys = std::map<std::string, std::string>;

/// Strict reader of one YAML file of scalars under sections: every key that the program reads must
/// be there, and every key that is there must be read. Throws InputError naming file, key and
/// value, and the key or choice that a mistyped one is near to. Keys are written `section.key`. At
/// most 100,000 bytes, 1,000 keys, 8 levels.
class ConfigReader {
 public:
  static ConfigReader FromFile(const std::string& path, const RenamedKeys& renamed = {});
  /// `name` stands for the file in messages; a key of `renamed` is refused, naming the new one.
  static ConfigReader FromString(const std::string& text, const std::string& name,
                                 const RenamedKeys& renamed = {});

  bool Has(const std::string& key) const { return values_.count(key) > 0; }
  /// All keys of the file, in order.
  std::vector<std::string> Keys() const;

  /// Throws, naming the new key, if this one was renamed.
  void RequireNotRenamed(const std::string& key) const;

  /// Replaces one value; `assignment` is "section.key=value" and the key must be in the file.
  void Override(const std::string& assignment);

  void Read(const std::string& key, bool* value);
  void Read(const std::string& key, std::string* value);
  /// The value must lie in [min, max].
  void Read(const std::string& key, int* value, int min, int max);
  void Read(const std::string& key, double* value, double min, double max);
  /// The value must be one of `choices`; returns its index.
  int ReadChoice(const std::string& key, const std::vector<std::string>& choices);

  /// Throws if the file has a key that was not read.
  void Finish() const;

  /// Every key with the value in force, one `section.key: value` a line, in order of the keys; a
  /// reader of its own reads it again.
  std::string Resolved() const;

  /// For what only the caller can tell of a value.
  [[noreturn]] void Fail(const std::string& key, const std::string& value,
                         const std::string& why) const;

 private:
  ConfigReader() = default;
  const std::string& Raw(const std::string& key);

  std::string name_;
  RenamedKeys renamed_;
  std::map<std::string, std::string> values_;
  std::set<std::string> read_;
};

/// The value as YAML reads it again: in quotes where it is not plain.
std::string QuotedYaml(const std::string& value);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CONFIG_CONFIG_READER_H_
