// How commands and options are shown: the same words in --help, in the man page and in completions.
#pragma once
#include <CLI/CLI.hpp>
#include <initializer_list>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lgabench::cli {

/// An option of a command, or what it takes by position.
struct OptionHelp {
  std::vector<std::string> names;  // "--demos"; none for what is taken by position
  std::string takes;               // "N,..." (a comma: several), "text|md" (one of these), "" for a flag
  std::string text;                // with its default
  bool required = false, repeated = false;
};
struct OptionGroup {
  std::string title;  // "" for what is taken by position
  std::vector<OptionHelp> options;
};

/// Puts options of a command, each with a word for what it takes ("" for a flag), below one title; a title of "" leaves
/// them where they are.
void arrange(CLI::App& verb, const char* title, std::initializer_list<std::pair<const char*, const char*>> options);

/// Options of a command with several actions whose help begins with some of these ("build, check: documents that ...")
/// belong to them alone. @throws InputError for one that was given beside another `action`.
void expect_options_of(const CLI::App& verb, const std::string& action, const std::vector<std::string>& actions);

/// In the order in which they are shown; options that nobody arranged come last.
std::vector<OptionGroup> option_groups(const CLI::App& app);

/// The commands that are shown, by the title they stand below.
struct CommandGroup {
  std::string title;
  std::vector<const CLI::App*> commands;
};
std::vector<CommandGroup> command_groups(const CLI::App& app);

/// "lgabench run [OPTIONS] SUITE", where `name` is "lgabench run".
std::string usage_line(const CLI::App& app, const std::string& name);

/// The text in lines of at most 100 columns; what goes on in another line is `indent` spaces in.
std::string wrapped(std::string_view text, std::size_t indent);

/// What writes --help of an app and of the commands that are added to it later.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// Has the command's --help leave these out ("--shard"), which its --help-all then shows; none of its own before.
void leave_to_help_all(CLI::App& verb, std::set<std::string> options);

}  // namespace lgabench::cli
