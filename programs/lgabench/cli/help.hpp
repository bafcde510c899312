// How commands and options are shown: the same words in --help, in the man page and in completions.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <lgabench/cli/numbers.hpp>

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

/// What holds of an option: its default is in the help; it must be given; one value follows its name, which may be
/// repeated; --help leaves it to --help-all.
enum Mark { with_default, required, repeatable, rare };

/// A command whose options are declared once, in the order in which they are shown.
class Verb {
 public:
  Verb(CLI::App& app, const char* name, const std::string& summary) : verb_(app.add_subcommand(name, summary)) {}
  Verb(const Verb&) = delete;
  Verb& operator=(const Verb&) = delete;
  /// Gives it a --help-all if an option is rare.
  ~Verb();

  CLI::App* operator->() const { return verb_; }
  CLI::App* get() const { return verb_; }

  /// Options that are declared from here on stand below that title.
  void below(const char* title) { title_ = title; }
  /// `words`: "--demos N,...", its name and what it takes, several values with commas if that has one; "--quiet" for a
  /// bool; "RUN" or "run RUN" for what is taken by position. `value`: where it goes, or a std::function that is given
  /// it. `more`: Marks, and checks as CLI::Option::check() takes them.
  template <class T, class... More>
  CLI::Option* option(const std::string& words, T& value, const std::string& help, const More&... more) {
    CLI::Option* const option = declare(words.substr(0, words.find(' ')), value, help);
    arrange(*option, words);
    (add(*option, more), ...);
    using Number = typename number_in<T>::type;
    if constexpr (!std::is_void_v<Number>) option->check(CLI::Validator(not_a_number<Number>, ""));
    return option;
  }
  /// Has these be rare, and no others.
  void leave_to_help_all(std::set<std::string> options) { rare_ = std::move(options); }

 private:
  CLI::Option* declare(const std::string& name, bool& value, const std::string& help) {
    return verb_->add_flag(name, value, help);
  }
  template <class T>
  CLI::Option* declare(const std::string& name, T& value, const std::string& help) {
    return verb_->add_option(name, value, help);
  }
  template <class T>
  CLI::Option* declare(const std::string& name, const std::function<void(const T&)>& use, const std::string& help) {
    return verb_->add_option_function(name, use, help);
  }
  void arrange(CLI::Option& option, const std::string& words) const;
  void add(CLI::Option& option, Mark mark);
  template <class Check>
  void add(CLI::Option& option, const Check& check) {
    option.check(check);
  }

  CLI::App* verb_;
  std::string title_;
  std::set<std::string> rare_;
};

/// Checks the command line's words behind the program. @throws CLI::ValidationError for a list such as "a,,b", whose
/// empty item CLI11 would drop.
void expect_no_gaps(const CLI::App& app, const std::vector<std::string>& words);

/// Options of a command with several actions whose help begins with some of these ("build, check: documents that ...")
/// belong to them alone. @throws InputError for one that was given beside another `action`.
void expect_options_of(const CLI::App& verb, const std::string& action, const std::vector<std::string>& actions);

/// Groups of options in the order in which they are shown; options that nobody arranged come last.
std::vector<OptionGroup> option_groups(const CLI::App& app);

/// The commands that are shown, by the title they stand below.
struct CommandGroup {
  std::string title;
  std::vector<const CLI::App*> commands;
};
std::vector<CommandGroup> command_groups(const CLI::App& app);

/// "lgabench run [OPTIONS] SUITE", where `name` is "lgabench run".
std::string usage_line(const CLI::App& app, const std::string& name);

/// The text in lines of at most 100 columns; what goes on in another line is `indent` spaces in, or as far as the
/// line's second column.
std::string wrapped(std::string_view text, std::size_t indent);

/// What writes --help of an app and of the commands that are added to it later. With `first`, the app's own --help
/// shows these commands alone; --help-all shows every command, and the `reference`.
std::shared_ptr<CLI::FormatterBase> help_formatter(std::set<std::string> first = {}, std::string reference = "");

}  // namespace lgabench::cli
