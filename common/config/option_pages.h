#ifndef AIRDOS_COMMON_CONFIG_OPTION_PAGES_H_
#define AIRDOS_COMMON_CONFIG_OPTION_PAGES_H_

#include <string>

#include "common/config/option_table.h"

namespace airdos {

/// The YAML file with the members' values and the table's comments: unit and help beside each
/// value.
std::string ConfigFileText(const OptionTable& table);

/// For a terminal: each key with its value, what is allowed, unit and help.
std::string OptionReference(const OptionTable& table);

/// What a program says of its options before it has read any.
struct OptionPages {
  std::string config_name;   ///< of the file, without .yaml
  std::string default_file;  ///< ConfigFileText() of the defaults
  std::string reference;     ///< OptionReference() of the defaults
  RenamedKeys renamed;
};

template <class Options>
OptionPages PagesOf() {
  Options options;
  const OptionTable table = TableOf(&options);
  return {table.name(), ConfigFileText(table), OptionReference(table), table.renamed()};
}

}  // namespace airdos

#endif  // AIRDOS_COMMON_CONFIG_OPTION_PAGES_H_
