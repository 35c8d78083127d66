#include "processes/node/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>
#include <sstream>

#include "common/util/error.h"
#include "common/util/suggestion.h"
#include "common/util/words.h"

namespace airdos {
namespace {

/// Wraps the text into lines of at most `width` columns.
std::string Wrapped(const std::string& text, std::size_t width) {
  return JoinWords(WrapWords(text, width), "\n");
}

/// Formats --help with line wrapping.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = make_option_name(option, is_positional);
    const std::string details = make_option_opts(option);
    std::string text = option->get_description();
    constexpr std::size_t kMaxName = 60;
    if (name.size() + details.size() <= kMaxName) {
      name += details;
    } else {
      text += " [" + details.substr(details.find_first_not_of(' ')) + "]";
    }
    std::ostringstream out;
    CLI::detail::format_help(out, name, Wrapped(text, kWidth - get_column_width()),
                             get_column_width());
    return out.str();
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true),
                             Wrapped(command->get_description(), kWidth - get_column_width()),
                             get_column_width());
    return out.str();
  }
  std::string make_description(const CLI::App* app) const override {
    return Wrapped(app->get_description(), kWidth) + "\n";
  }

 private:
  static constexpr std::size_t kWidth = 100;
};

void UseHelpFormatter(const std::shared_ptr<HelpFormatter>& formatter, CLI::App* app) {
  app->formatter(formatter);
  for (CLI::App* command : app->get_subcommands({})) UseHelpFormatter(formatter, command);
}

/// Options of the app and of the given command, without hidden ones.
std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands()) {
    for (const std::string& name : OptionNames(*command)) names.push_back(name);
  }
  return names;
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

/// Explains what is unknown on the command line; empty if the error is of another kind.
std::string ExplainUnknown(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(true);
  const auto option = std::find_if(rest.begin(), rest.end(), [](const std::string& word) {
    return word.size() > 1 && word[0] == '-';
  });
  const std::string see = " (see --help)";
  if (option != rest.end()) {
    const std::string name = option->substr(0, option->find('='));
    const std::string hint = DidYouMean(name, OptionNames(app));
    return "there is no option '" + name + "'" + (hint.empty() ? see : hint);
  }
  if (rest.empty()) return "";
  const std::vector<std::string> commands = CommandNames(app);
  if (!commands.empty() && app.get_subcommands().empty()) {
    const std::string hint = DidYouMean(rest[0], commands);
    return "there is no command '" + rest[0] + "'" + (hint.empty() ? see : hint);
  }
  return "one argument too many: '" + rest[0] + "'" + see;
}

}  // namespace

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

CommandOption CommandOption::Excludes(const std::string& name) const {
  return CommandOption(option_->excludes(name));
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

bool CommandLine::Parse(int argc, char** argv, const std::string& version) {
  UseHelpFormatter(std::make_shared<HelpFormatter>(), app());
  app_->set_version_flag("--version", version, "print version and commit");
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      const std::string unknown = ExplainUnknown(*app_);
      throw InputError(unknown.empty() ? error.what() : unknown);
    }
    app_->exit(error);  // --help, --version
    return false;
  }
}

std::string CommandLine::program() const { return app_->get_name(); }

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
AIRDOS_ADD(std::optional<double>);
AIRDOS_ADD(std::optional<std::int64_t>);
AIRDOS_ADD(std::optional<std::string>);
#undef AIRDOS_ADD

}  // namespace airdos
