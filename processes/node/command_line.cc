#include "processes/node/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>

#include "common/util/suggestion.h"
#include "common/util/words.h"

namespace airdos {

CommandOption CommandOption::Required() const { return CommandOption(option_->required()); }

CommandOption CommandOption::ShowDefault() const {
  return CommandOption(option_->capture_default_str());
}

CommandOption CommandOption::Hide() const { return CommandOption(option_->group("")); }

CommandOption CommandOption::OneEachTime() const {
  return CommandOption(option_->allow_extra_args(false));
}

CommandOption CommandOption::Words(int least, int most) const {
  return CommandOption(option_->expected(least, most));
}

CommandOption CommandOption::ShownAs(const std::string& what) const {
  return CommandOption(option_->type_name(what));
}

CommandOption CommandOption::Within(int low, int high) const {
  return CommandOption(option_->check(CLI::Range(low, high)));
}

CommandOption CommandOption::Within(double low, double high) const {
  return CommandOption(option_->check(CLI::Range(low, high)));
}

CommandOption CommandOption::NotNegative() const {
  return CommandOption(option_->check(CLI::NonNegativeNumber));
}

CommandOption CommandOption::Positive() const {
  return CommandOption(option_->check(CLI::PositiveNumber));
}

CommandOption CommandOption::OneOf(const std::vector<std::string>& words) const {
  const std::string list = JoinWords(words, ", ");
  const auto check = [words, list](std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return "";
    return "'" + word + "' is none of " + list + DidYouMean(word, words);
  };
  return CommandOption(option_->check(CLI::Validator(check, "one of " + list)));
}

CommandOption CommandOption::OneOfFew(const std::vector<std::string>& words) const {
  return CommandOption(option_->check(CLI::IsMember(words)));
}

CommandOption CommandOption::Check(
    const std::function<std::string(const std::string&)>& what_is_wrong) const {
  return CommandOption(option_->check(what_is_wrong));
}

bool CommandOption::is_given() const { return option_->count() > 0; }

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : app_(std::make_shared<CLI::App>(description, program)) {}

template <typename Value>
CommandOption CommandLine::Add(const std::string& names, Value* value, const std::string& text) {
  return CommandOption(app_->add_option(names, *value, text));
}

CommandOption CommandLine::AddRepeated(const std::string& names, std::vector<std::string>* values,
                                       const std::string& text) {
  CLI::Option* const option = app_->add_option(names, *values, text);
  return CommandOption(option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
}

CommandOption CommandLine::AddFlag(const std::string& names, bool* value, const std::string& text) {
  return CommandOption(app_->add_flag(names, *value, text));
}

CommandOption CommandLine::AddFile(const std::string& names, std::string* path,
                                   const std::string& text) {
  return CommandOption(app_->add_option(names, *path, text)->type_name("FILE"));
}

CommandOption CommandLine::AddFolder(const std::string& names, std::string* path,
                                     const std::string& text) {
  return CommandOption(app_->add_option(names, *path, text)->type_name("FOLDER"));
}

void CommandLine::AddForce(bool* force) {
  AddFlag("--force", force,
          "replace files that this program did not write, or that were changed since");
}

void CommandLine::AddPage(const std::string& name, const std::string& page, const std::string& text,
                          const std::vector<std::string>& unheeded) {
  const auto print = [name, page, unheeded, app = app()] {
    for (const std::string& other : unheeded) {
      if (app->count(other) > 0) throw CLI::ExcludesError(name, other);
    }
    std::cout << page;
    throw CLI::Success();
  };
  app_->add_flag_callback(name, print, text);
}

CommandLine CommandLine::AddCommand(const std::string& name, const std::string& text) {
  return CommandLine(app_->get_subcommand_ptr(app_->add_subcommand(name, text)));
}

void CommandLine::RequireCommand() {
  app_->fallthrough();
  app_->require_subcommand(1);
}

void CommandLine::OnGiven(const std::function<void()>& run) { app_->callback(run); }

bool CommandLine::is_given() const { return app_->parsed(); }

#define AIRDOS_ADD(Value) \
  template CommandOption CommandLine::Add(const std::string&, Value*, const std::string&)
AIRDOS_ADD(int);
AIRDOS_ADD(std::int64_t);
AIRDOS_ADD(std::uint64_t);
AIRDOS_ADD(double);
AIRDOS_ADD(std::string);
AIRDOS_ADD(std::vector<std::string>);
AIRDOS_ADD(std::optional<int>);
AIRDOS_ADD(std::optional<std::int64_t>);
AIRDOS_ADD(std::optional<std::string>);
#undef AIRDOS_ADD

}  // namespace airdos
