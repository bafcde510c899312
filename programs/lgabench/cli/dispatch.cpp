#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <regex>
#include <string_view>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/scenario_path.hpp>
#include <lgabench/core/suggest.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {
namespace {

// The first option among the words that there is none of, with what may have been meant; "" if all that begins with a
// dash is one.
std::string unknown_option(const CLI::App& verb, const std::vector<std::string>& words) {
  const auto option =
      std::find_if(words.begin(), words.end(), [](const auto& w) { return w.size() > 1 && w[0] == '-'; });
  if (option == words.end()) return "";
  std::vector<std::string> known;
  for (const CLI::Option* one : verb.get_options())
    for (const std::string& name : one->get_lnames()) known.push_back("--" + name);
  const std::string name = option->substr(0, option->find('='));
  return fmt::format("unknown option {}{}", name,
                     suggestion("--" + name.substr(std::min(name.find_first_not_of('-'), name.size())), known));
}

// What a check of CLI11's says of a value, as all other errors say it. Of a word without an option its name says
// nothing.
std::string of_a_value(const CLI::App& verb, const std::string& what) {
  static const std::pair<std::regex, const char*> words[] = {
      {std::regex("Value (\\S+) not in range (\\S+) to (\\S+)$"), "expected a number from $2 to $3, got $1"},
      {std::regex("\\d+ required (\\S+) missing$"), "expected $1 after it"},
      {std::regex("^Could not convert: (\\S+) = (.*)$"), "$1: expected no value, got $2"},
      {std::regex("At Most 1 required but received (\\d+)$"), "expected it once, got it $1 times"},
      {std::regex("At (?:Most|least) (\\d+) required but received (\\d+)$"), "expected $1 values, got $2"}};
  std::string text = what;
  for (const auto& [said, words_of_ours] : words) text = std::regex_replace(text, said, words_of_ours);
  const std::size_t colon = text.find(": ");
  const CLI::Option* option = colon == text.npos ? nullptr : verb.get_option_no_throw(text.substr(0, colon));
  return option && option->get_positional() ? verb.get_name() + text.substr(colon) : text;
}

// What CLI11 says of a command line, in words that name what is wrong and what to write.
std::string explained(const CLI::App& app, const CLI::ParseError& e) {
  const std::vector<const CLI::App*> chosen = app.get_subcommands({});
  const auto parsed = std::find_if(chosen.begin(), chosen.end(), [](const CLI::App* c) { return c->parsed(); });
  const CLI::App& verb = parsed == chosen.end() ? app : **parsed;
  const std::string name = &verb == &app ? app.get_name() : app.get_name() + " " + verb.get_name();
  const std::vector<std::string> words = app.remaining(true);
  const bool missing = dynamic_cast<const CLI::RequiredError*>(&e) != nullptr;
  if (!missing && !dynamic_cast<const CLI::ExtrasError*>(&e)) return of_a_value(verb, e.what());
  if (const std::string unknown = unknown_option(verb, words); !unknown.empty())
    return fmt::format("{}; see {} --help", unknown, name);
  if (missing) {
    const std::string what = e.what(), missed = what.substr(0, what.find(' '));
    const CLI::Option* option = verb.get_option_no_throw(missed);
    if (!option) return what;
    return fmt::format("{} is missing; usage: {}", option->get_positional() ? option->get_type_name() : missed,
                       usage_line(verb, name));
  }
  if (&verb != &app) return fmt::format("\"{}\" is a word too many; usage: {}", words.front(), usage_line(verb, name));
  std::vector<std::string> known{"--help", "--version"};
  for (const CommandGroup& group : command_groups(app))
    for (const CLI::App* command : group.commands) known.push_back(command->get_name());
  std::string near = suggestion(words.front(), known);
  if (near.empty()) near = suggestion("--" + words.front(), known);
  return fmt::format("unknown command \"{}\"{}; see {} --help", words.front(), near, name);
}

}  // namespace

void say_renamed(const std::string& old, const std::string& now) {
  to_stderr("lgabench: {} is accepted for one more release; write {}\n", old, now);
}

int dispatch(CLI::App& app, const std::vector<std::string>& words, const int& exit) {
  ::signal(SIGXFSZ, SIG_IGN);  // a file over the limit (ulimit -f) is an error, not the end
  try {
    try {
      expect_no_gaps(app, words);
      if (!words.empty() && words.front() != "help" && words.front().rfind('-', 0) != 0) expect_scenario_directories();
      app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // the order that CLI11 wants
      if (app.get_subcommands().empty()) throw CLI::CallForHelp();
    } catch (const CLI::CallForVersion& e) {
      to_stdout("{}\n", e.what());
    } catch (const CLI::CallForAllHelp&) {
      to_stdout("{}", app.help("", CLI::AppFormatMode::All));
    } catch (const CLI::Success&) {  // --help
      to_stdout("{}", app.help());
    }
    flush_stdout();
    return exit;
  } catch (const CLI::ParseError& e) {
    complain(app.get_name(), explained(app, e));
    return usage;
  } catch (...) {
    return report_error(app.get_name());
  }
}

}  // namespace lgabench::cli
