#include <lgabench/cli/help.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench::cli {
namespace {

constexpr std::size_t widest = 100, text_column = 28;

OptionHelp help_of(const CLI::Option& option) {
  OptionHelp help;
  for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
  // CLI11 puts what its checks expect after a colon.
  if (option.get_type_size() != 0) help.takes = option.get_type_name().substr(0, option.get_type_name().find(':'));
  help.text = option.get_description();
  if (const std::string& usual = option.get_default_str(); !usual.empty())
    help.text += fmt::format(" (default: {})", usual);
  help.required = option.get_required();
  help.repeated = option.get_expected_max() > 1 && help.names.empty();
  return help;
}

// "  NAME     text", the text below the name where that is long.
std::string entry(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  if (line.size() + 2 > text_column)
    line = line + "\n" + std::string(text_column, ' ');
  else
    line.resize(text_column, ' ');
  return wrapped(line + text, text_column) + "\n";
}

// Where a line goes on in the next one: below its second column where it has two, further in than an example.
std::size_t hanging(std::string_view line, std::size_t indent) {
  constexpr std::size_t widest_first_column = 30;
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == line.npos || begin == 0) return indent;
  if (begin >= text_column) return begin;
  const std::size_t second = line.find_first_not_of(' ', line.find("  ", begin));
  return second <= widest_first_column ? second : begin + 4;
}

// The group of that title: a new one where there is none yet.
template <class Group>
Group& titled(std::vector<Group>& groups, const std::string& title) {
  const auto found =
      std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.title == title; });
  return found == groups.end() ? groups.emplace_back(Group{title, {}}) : *found;
}

std::string named(const OptionHelp& option) {
  if (option.names.empty()) return option.takes;
  return fmt::format("{}{}{}", fmt::join(option.names, ", "), option.takes.empty() ? "" : " ", option.takes);
}

class HelpFormatter : public CLI::FormatterBase {
 public:
  explicit HelpFormatter(std::set<std::string> rare) : rare_(std::move(rare)) {}
  HelpFormatter(std::set<std::string> first, std::string reference)
      : first_(std::move(first)), reference_(std::move(reference)) {}

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string help = wrapped(app->get_description(), 0) + "\n\nUsage: " + usage_line(*app, name) + "\n";
    const bool is_command = app->get_parent() != nullptr, all = mode == CLI::AppFormatMode::All;
    const std::string footer = paragraph(app->get_footer());
    if (is_command) help += footer;
    std::size_t more = 0;
    for (const auto& [title, commands] : command_groups(*app)) {
      std::string entries;
      for (const CLI::App* command : commands)
        if (all || first_.empty() || first_.count(command->get_name()) > 0)
          entries += entry(command->get_name(), command->get_description());
        else
          ++more;
      if (!entries.empty()) help += "\n" + title + "\n" + entries;
    }
    if (more > 0) help += fmt::format("\n{} more commands: {} help all\n", more, name);
    more = 0;
    for (const auto& [title, options] : option_groups(*app)) {
      std::string entries;
      for (const OptionHelp& option : options)
        if (!all && !option.names.empty() && rare_.count(option.names.back()) > 0)
          ++more;
        else
          entries += entry(named(option), option.text);
      if (!entries.empty()) help += "\n" + (title.empty() ? "" : title + "\n") + entries;
    }
    if (more > 0) help += fmt::format("\n{} more options: {} --help-all\n", more, name);
    if (is_command) return help;
    return help + (all ? paragraph(reference_) : "") + footer;
  }

 private:
  static std::string paragraph(const std::string& text) { return text.empty() ? "" : "\n" + wrapped(text, 2) + "\n"; }

  const std::set<std::string> rare_{}, first_{};
  const std::string reference_{};
};

}  // namespace

Verb::~Verb() {
  if (rare_.empty()) return;
  verb_->set_help_all_flag("--help-all", "Print this help message with all options and exit");
  verb_->formatter(std::make_shared<HelpFormatter>(std::move(rare_)));
}

void Verb::arrange(CLI::Option& option, const std::string& words) const {
  if (!title_.empty()) option.group(title_);
  const std::size_t space = words.find(' ');
  if (space == words.npos && option.nonpositional()) return;
  const std::string takes = space == words.npos ? words : words.substr(space + 1);
  option.type_name(takes);
  if (takes.find(',') != takes.npos) option.delimiter(',');
  if (takes.find(",...") == takes.npos) return;
  option.check(CLI::Validator(
      [&option](const std::string& value) {
        const std::vector<std::string>& all = option.results();
        const bool once = std::count(all.begin(), all.end(), value) == 1;
        return once ? std::string() : fmt::format("expected each value once, got {} twice", value);
      },
      ""));
}

void Verb::add(CLI::Option& option, Mark mark) {
  if (mark == with_default) option.capture_default_str();
  if (mark == required) option.required();
  if (mark == repeatable) option.allow_extra_args(false);
  if (mark == rare) rare_.insert(option.get_name());
}

void expect_no_gaps(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<const CLI::App*> verbs =
      app.get_subcommands([&words](const CLI::App* one) { return !words.empty() && one->get_name() == words.front(); });
  const CLI::Option* option = nullptr;
  for (std::size_t i = 1; !verbs.empty() && i < words.size(); ++i) {
    std::string value = words[i];
    if (value.rfind("--", 0) == 0) {
      const std::size_t equals = value.find('=');
      option = verbs.front()->get_option_no_throw(value.substr(0, equals));
      if (equals == value.npos) continue;
      value.erase(0, equals + 1);
    }
    if (!option || option->get_delimiter() != ',') continue;
    if (("," + value + ",").find(",,") != value.npos)
      throw CLI::ValidationError(option->get_name(), fmt::format("expected a value between commas, got {}", value));
  }
}

void expect_options_of(const CLI::App& verb, const std::string& action, const std::vector<std::string>& actions) {
  const auto is_action = [&](const std::string& word) { return contains(actions, word); };
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0 || !option->nonpositional()) continue;
    const std::string text = option->get_description(), begin = text.substr(0, text.find(':'));
    std::vector<std::string> words = CLI::detail::split(begin, ',');
    for (std::string& word : words) CLI::detail::trim(word);
    if (std::all_of(words.begin(), words.end(), is_action) && !contains(words, action))
      throw InputError(fmt::format("{} {}: {} is an option of {}", verb.get_name(), action, option->get_name(), begin));
  }
}

std::vector<OptionGroup> option_groups(const CLI::App& app) {
  std::vector<OptionGroup> groups{{"", {}}};
  std::vector<OptionHelp> others;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    if (option->nonpositional() && option->get_group() == "Options") {
      others.push_back(help_of(*option));
      continue;
    }
    const std::string title = option->nonpositional() ? option->get_group() : "";
    titled(groups, title).options.push_back(help_of(*option));
  }
  if (groups.front().options.empty()) groups.erase(groups.begin());
  const bool titled = !groups.empty() && !groups.back().title.empty();
  if (!others.empty()) groups.push_back({titled ? "Other options" : "Options", others});
  return groups;
}

std::vector<CommandGroup> command_groups(const CLI::App& app) {
  std::vector<CommandGroup> groups;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_group().empty()) continue;  // hidden
    const std::string title = command->get_group() == "Subcommands" ? "Other commands" : command->get_group();
    titled(groups, title).commands.push_back(command);
  }
  return groups;
}

std::string usage_line(const CLI::App& app, const std::string& name) {
  std::string usage = name;
  if (!command_groups(app).empty()) usage += " COMMAND";
  usage += " [OPTIONS]";
  for (const OptionGroup& group : option_groups(app))
    if (group.title.empty())
      for (const OptionHelp& one : group.options) {
        const std::string word = one.takes + (one.repeated ? "..." : "");
        usage += one.required ? " " + word : " [" + word + "]";
      }
  return usage;
}

std::string wrapped(std::string_view text, std::size_t indent) {
  std::string out;
  while (true) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    const std::size_t in = hanging(line, indent);
    std::size_t room = widest;
    while (line.size() > room) {
      std::size_t cut = line.rfind(' ', room);
      if (cut == line.npos || line.find_first_not_of(' ') > cut) cut = std::min(line.find(' ', room), line.size());
      out += line.substr(0, cut);
      line.remove_prefix(std::min(cut + 1, line.size()));
      if (line.empty()) break;
      out += "\n" + std::string(in, ' ');
      room = widest - in;
    }
    out += line;
    if (end == text.size()) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

std::shared_ptr<CLI::FormatterBase> help_formatter(std::set<std::string> first, std::string reference) {
  return std::make_shared<HelpFormatter>(std::move(first), std::move(reference));
}

}  // namespace lgabench::cli
