#include "processes/node/live/program_cli.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>

#include "common/util/commit.h"
#include "common/util/error.h"
#include "common/util/suggestion.h"
#include "common/util/version.h"
#include "common/util/words.h"
#include "processes/node/live/process_log.h"

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

int FailInOneLine(const CLI::App& app, std::string what, int exit_code) {
  // Texts of libraries may span several lines.
  while (!what.empty() && what.back() == '\n') what.pop_back();
  std::replace(what.begin(), what.end(), '\n', ' ');
  // The journal takes a line without a level for information.
  const std::string head = StyleOfStderr() == LogStyle::kJournal ? "<3>" : "";
  std::cerr << head << app.get_name() << ": " << what << std::endl;
  return exit_code;
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

/// The descriptor of a closed stream is reused by the next file that is opened, which would then
/// receive our messages. This makes writing to it fail instead, as for any file opened read-only.
void OccupyClosedStreams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    const int taken = open("/dev/null", O_RDONLY);
    if (taken != stream && taken >= 0) close(taken);
  }
}

/// The exit code of a program that ended with `code`.
int WithOutputChecked(const CLI::App& app, int code) {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return FailInOneLine(app, "standard output cannot be written (closed, or the disk is full)",
                       code == 0 ? 1 : code);
}

}  // namespace

InputOptions::InputOptions(CommandLine* line) {
  line->Add("INPUT", &input_, "folder of a data set, or LCM log");
  line->AddFolder("--data", &data_, "the same as INPUT");
  line->AddFile("--log", &log_, "the same as INPUT");
}

const std::string& InputOptions::path() const {
  const std::string* path = nullptr;
  for (const std::string* given : {&input_, &data_, &log_}) {
    if (given->empty()) continue;
    if (path != nullptr) {
      throw InputError("only one input is possible: '" + *path + "' or '" + *given + "'");
    }
    path = given;
  }
  if (path == nullptr) {
    throw InputError("INPUT is missing: the folder of a data set (--data) or an LCM log (--log)");
  }
  return *path;
}

int RunProgram(int argc, char** argv, CommandLine* line, const std::function<int()>& body) {
  CLI::App* const app = line->app();
  OccupyClosedStreams();
  UseHelpFormatter(std::make_shared<HelpFormatter>(), app);
  app->set_version_flag("--version", app->get_name() + " " + kVersion + " (" + kCommit + ")",
                        "print version and commit");
  try {
    app->parse(argc, argv);
    return WithOutputChecked(*app, body());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app->exit(error);
      return WithOutputChecked(*app, 0);
    }
    const std::string unknown = ExplainUnknown(*app);
    return FailInOneLine(*app, unknown.empty() ? error.what() : unknown, kExitBadInput);
  } catch (const InputError& error) {
    return FailInOneLine(*app, error.what(), kExitBadInput);
  } catch (const std::exception& error) {
    return FailInOneLine(*app, error.what(), 1);
  }
}

}  // namespace airdos
