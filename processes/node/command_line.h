#ifndef AIRDOS_PROCESSES_NODE_COMMAND_LINE_H_
#define AIRDOS_PROCESSES_NODE_COMMAND_LINE_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

// Every file that includes CLI11 takes seconds longer to compile: command_line.cc alone does.
namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;
class Option;
}  // namespace CLI

namespace airdos {

/// One option of a CommandLine. Each function returns the option, for more to be said about it.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}

  CommandOption Required() const;
  /// Shows in --help the value that the variable has now.
  CommandOption ShowDefault() const;
  /// Not listed in --help.
  CommandOption Hide() const;
  /// One word each time it is given, where the variable is a list.
  CommandOption OneEachTime() const;
  /// How many words a list takes.
  CommandOption Words(int least, int most) const;
  /// What --help shows in place of the type, such as WIDTHxHEIGHT.
  CommandOption ShownAs(const std::string& what) const;

  /// Not together with that option.
  CommandOption Excludes(const std::string& name) const;

  // What is allowed; anything else is an error.
  CommandOption Within(int low, int high) const;
  CommandOption Within(double low, double high) const;
  CommandOption NotNegative() const;
  CommandOption Positive() const;
  /// One of the words; the message for any other word suggests a similar one. --help lists the
  /// words below the text.
  CommandOption OneOf(const std::vector<std::string>& words) const;
  /// The same for words that --help shows beside the name.
  CommandOption OneOfFew(const std::vector<std::string>& words) const;
  /// What `what_is_wrong` returns an empty text for.
  CommandOption Check(const std::function<std::string(const std::string&)>& what_is_wrong) const;

  /// After parsing.
  bool is_given() const;

 private:
  CLI::Option* option_;
};

/// The command line of a program, or of one of its commands. Copies stand for the same one.
/// Variables receive their values when RunProgram() parses it, and must live until then.
class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& program);

  /// The types are those at the end of command_line.cc. A list takes any number of words.
  template <typename Value>
  CommandOption Add(const std::string& names, Value* value, const std::string& text);
  /// An option that may be given again, one word each time.
  CommandOption AddRepeated(const std::string& names, std::vector<std::string>* values,
                            const std::string& text);
  CommandOption AddFlag(const std::string& names, bool* value, const std::string& text);
  /// An option that names a file or a folder, shown as FILE or FOLDER in --help.
  CommandOption AddFile(const std::string& names, std::string* path, const std::string& text);
  CommandOption AddFolder(const std::string& names, std::string* path, const std::string& text);
  /// --force: see OutputRules.
  void AddForce(bool* force);
  /// Prints the page and ends the program as --help does. The options that it would not heed are
  /// refused beside it.
  void AddPage(const std::string& name, const std::string& page, const std::string& text,
               const std::vector<std::string>& unheeded);

  CommandLine AddCommand(const std::string& name, const std::string& text);
  /// One of the commands must be given. The program's own options may stand behind it.
  void RequireCommand();
  /// Runs as soon as the command has been parsed.
  void OnGiven(const std::function<void()>& run);
  /// Whether the command is given; after parsing.
  bool is_given() const;

  /// Parses the words, which sets the variables. Adds --help and --version, which prints `version`;
  /// false if one of these, or a page, was printed. Throws InputError, which suggests what a
  /// mistyped word stands for.
  bool Parse(int argc, char** argv, const std::string& version);
  std::string program() const;

 private:
  explicit CommandLine(const std::shared_ptr<CLI::App>& app) : app_(app) {}
  CLI::App* app() const { return app_.get(); }
  std::shared_ptr<CLI::App> app_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_COMMAND_LINE_H_
