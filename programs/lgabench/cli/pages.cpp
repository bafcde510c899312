#include <lgabench/cli/pages.hpp>

#include <fmt/format.h>

#include <functional>
#include <string_view>

#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/help.hpp>
#include <lgabench/core/version.hpp>

namespace lgabench::cli {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size()) text.replace(at, what.size(), by);
  return text;
}

void each_command(const CLI::App& app, const std::function<void(const CLI::App&)>& use) {
  for (const CommandGroup& group : command_groups(app))
    for (const CLI::App* command : group.commands) use(*command);
}

// What a command takes by position; all of it is of one kind.
std::string positional(const CLI::App& command) {
  for (const OptionGroup& group : option_groups(command))
    if (group.title.empty()) return group.options.front().takes;
  return "";
}

// --- man ---

std::string roff(const std::string& text) {
  std::string out = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (!out.empty() && (out[0] == '.' || out[0] == '\'')) out = "\\&" + out;
  return replaced(replaced(out, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

std::string roff_options(const CLI::App& app) {
  std::string page;
  for (const auto& [title, options] : option_groups(app)) {
    if (!title.empty()) page += ".PP\n" + roff(title) + ":\n";
    for (const OptionHelp& option : options) {
      std::string name = fmt::format("{}", fmt::join(option.names, ", "));
      page += fmt::format(".TP\n\\fB{}\\fR{}\\fI{}\\fR\n{}\n", roff(name), name.empty() ? "" : " ", roff(option.takes),
                          roff(option.text));
    }
  }
  return page;
}

// Lines as --help has them; one at the left margin before an indented one is a title.
std::string roff_footer(const std::string& text, const char* heading) {
  const std::string footer = wrapped(text, 2);
  std::string page = ".PP\n.nf\n";
  for (std::size_t at = 0; at < footer.size();) {
    const std::size_t end = std::min(footer.find('\n', at), footer.size());
    const std::string line = footer.substr(at, end - at);
    const bool is_title = *heading && !line.empty() && line[0] != ' ' && footer.compare(end, 3, "\n  ") == 0;
    page += is_title ? fmt::format(".fi\n.{} {}\n.nf\n", heading, line) : roff(line) + "\n";
    at = end + 1;
  }
  return page + ".fi\n";
}

// --- completion ---

// How a completion names the kinds of values that it knows: shell functions print the words of each.
std::string word_functions(const CLI::App& app) {
  std::string commands = "all";
  each_command(app, [&commands](const CLI::App& command) { commands += " " + command.get_name(); });
  return replaced(
      "# Prints what a value may be, a word a line: as `lgabench list` has them, or one of A|B|C. $2: the command's "
      "first\n"
      "# word, a suite or scenario that may take some of them alone.\n"
      "_lgabench_words() {\n"
      "  case $1 in\n"
      "    *'|'*) printf '%s\\n' \"$1\" | tr '|' '\\n' ;;\n"
      "    METHOD*) _lgabench_list methods ;;\n"
      "    ENGINE*) _lgabench_list engines ;;\n"
      "    SUITE) _lgabench_list suites ;;\n"
      "    SCENARIO* | COMMAND) _lgabench_list scenarios --of \"$2\" || _lgabench_list scenarios ;;\n"
      "    NAME) local kind; for kind in methods rows engines perturbations environments suites scenarios; do "
      "_lgabench_list $kind; "
      "done ;;\n"
      "    LAYOUT*) _lgabench_list layouts --of \"$2\" || _lgabench_list layouts ;;\n"
      "    SOURCE) _lgabench_list sources --of \"$2\" || _lgabench_list sources ;;\n"
      "    KIND) _lgabench_list kinds ;;\n"
      "    AXIS) _lgabench_list axes ;;\n"
      "    AXIS,...) _lgabench_list perturbations --of \"$2\" || _lgabench_list perturbations ;;\n"
      "    ARM,...) _lgabench_list arms --of \"$2\" ;;\n"
      "    TOPIC) printf '%s\\n' COMMANDS ;;\n"
      "    PRESET) _lgabench_list presets --of \"$2\" || _lgabench_list presets ;;\n"
      "  esac\n"
      "}\n"
      "_lgabench_list() { lgabench list \"$@\" 2>/dev/null; }\n",
      "COMMANDS", commands);
}

std::string bash_quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

bool is_list(const std::string& takes) { return takes.find(",...") != takes.npos; }

// "_files", or what completes a value of that kind in zsh.
std::string zsh_action(const std::string& takes) {
  for (const char* directory : {"DIR", "RUN", "OUT", "A", "B"})
    if (takes == directory) return "_files -/";
  for (const char* file : {"FILE", "PATH", "PROGRAM"})
    if (takes == file) return "_files";
  const std::string words = fmt::format("${{(f)\"$(_lgabench_words '\\''{}'\\'' \"$words[2]\")\"}}", takes);
  return is_list(takes) ? fmt::format("_values -s , value {}", words) : fmt::format("compadd -- {}", words);
}

// Text within '...[...]' of a specification.
std::string zsh_text(const std::string& text) {
  std::string out = replaced(text, "'", "'\\''");
  for (const char* special : {"[", "]", ":"}) out = replaced(out, special, std::string("\\") + special);
  return out;
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string page = fmt::format(
      ".TH LGABENCH 1 \"\" \"lgabench {}\" \"User Commands\"\n.SH NAME\nlgabench \\- {}\n.SH SYNOPSIS\n{}\n.SH "
      "COMMANDS\n",
      LGABENCH_VERSION, roff(app.get_description()), roff(usage_line(app, app.get_name())));
  for (const auto& [title, commands] : command_groups(app)) {
    page += ".SS " + title + "\n";
    for (const CLI::App* command : commands)
      page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command->get_name()), roff(command->get_description()));
  }
  page += ".SH OPTIONS\n" + roff_options(app);
  each_command(app, [&page, &app](const CLI::App& command) {
    const std::string name = app.get_name() + " " + command.get_name();
    page += fmt::format(".SH \"{}\"\n{}\n.PP\n{}.\n", name, roff(usage_line(command, name)),
                        roff(command.get_description()));
    page += roff_options(command);
    if (!command.get_footer().empty()) page += roff_footer(command.get_footer(), "");
  });
  return page + roff_footer(reference + std::string("\n\n") + app.get_footer(), "SH");
}

std::string bash_completion(const CLI::App& app) {
  std::string commands, options, takes;
  each_command(app, [&](const CLI::App& command) {
    const std::string name = command.get_name();
    commands += name + " ";
    std::string names;
    for (const OptionGroup& group : option_groups(command))
      for (const OptionHelp& option : group.options)
        for (const std::string& one : option.names) {
          names += one + " ";
          if (!option.takes.empty())
            takes += fmt::format("    '{} {}') echo {} ;;\n", name, one, bash_quoted(option.takes));
        }
    options += fmt::format("    {}) echo {} ;;\n", name, bash_quoted(names));
    if (const std::string kind = positional(command); !kind.empty())
      takes += fmt::format("    '{} ') echo {} ;;\n", name, bash_quoted(kind));
  });
  return fmt::format(
             "# Completion of lgabench for bash, written from its --help.\n{}"
             "_lgabench_options() {{\n  case $1 in\n{}  esac\n}}\n"
             "# What an option of a command takes, or the command itself by position.\n"
             "_lgabench_takes() {{\n  case \"$1 $2\" in\n{}  esac\n}}\n",
             word_functions(app), options, takes) +
         "_lgabench() {\n"
         "  local now=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} takes=\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    mapfile -t COMPREPLY < <(compgen -W '" +
         commands +
         "--help --version' -- \"$now\")\n"
         "    return\n"
         "  fi\n"
         "  [[ $before == -* ]] && takes=$(_lgabench_takes \"$command\" \"$before\")\n"
         "  if [[ -z $takes && $now == -* ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$(_lgabench_options \"$command\")\" -- \"$now\")\n"
         "    return\n"
         "  fi\n"
         "  [[ -n $takes ]] || takes=$(_lgabench_takes \"$command\" '')\n"
         "  case $takes in\n"
         "    DIR | RUN | OUT | A | B) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$now\") ;;\n"
         "    FILE | PATH | PROGRAM) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$now\") ;;\n"
         "    *,...)\n"
         "      local first=\n"
         "      [[ $now == *,* ]] && first=${now%,*},\n"
         "      mapfile -t COMPREPLY < <(compgen -P \"$first\" -W \"$(_lgabench_words \"$takes\" "
         "\"${COMP_WORDS[2]}\")\" -- "
         "\"${now##*,}\")\n"
         "      ;;\n"
         "    *) mapfile -t COMPREPLY < <(compgen -W \"$(_lgabench_words \"$takes\" \"${COMP_WORDS[2]}\")\" -- "
         "\"$now\") ;;\n"
         "  esac\n"
         "}\n"
         "complete -F _lgabench lgabench\n";
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  each_command(app, [&](const CLI::App& command) {
    commands += fmt::format("    '{}:{}'\n", command.get_name(), zsh_text(command.get_description()));
    cases += fmt::format("    {})\n      _arguments \\\n", command.get_name());
    for (const OptionGroup& group : option_groups(command))
      for (const OptionHelp& option : group.options) {
        const std::string value =
            option.takes.empty() ? "" : fmt::format(":{}:{}", zsh_text(option.takes), zsh_action(option.takes));
        if (option.names.empty()) cases += fmt::format("        '*{}' \\\n", value);
        for (const std::string& name : option.names)
          cases += fmt::format("        '*{}[{}]{}' \\\n", name, zsh_text(option.text), value);
      }
    cases += "        ;;\n";
  });
  return fmt::format(
      "#compdef lgabench\n# Completion of lgabench for zsh, written from its --help.\n{}"
      "_lgabench() {{\n"
      "  local -a commands=(\n{}  )\n"
      "  if ((CURRENT == 2)); then\n    _describe command commands\n    return\n  fi\n"
      "  shift words\n  ((CURRENT--))\n"
      "  case $words[1] in\n{}  esac\n}}\n"
      "_lgabench \"$@\"\n",
      word_functions(app), commands, replaced(cases, " \\\n        ;;", "\n      ;;"));
}

std::string fish_completion(const CLI::App& app) {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
  };
  // What completes a value: files, directories, words of `lgabench list`, or those of A|B|C.
  const auto values = [&quoted](const std::string& takes) -> std::string {
    const std::string action = zsh_action(takes);
    if (action == "_files -/") return " -xa '(__fish_complete_directories)'";
    if (action == "_files") return " -rF";
    return fmt::format(" -xa {}", quoted(fmt::format("(_lgabench_words {})", quoted(takes))));
  };
  std::string lines;
  each_command(app, [&](const CLI::App& command) {
    const std::string name = command.get_name();
    lines += fmt::format("complete -c lgabench -n __fish_use_subcommand -xa {} -d {}\n", name,
                         quoted(command.get_description()));
    const std::string begin = fmt::format("complete -c lgabench -n 'test (_lgabench_word 2) = {}'", name);
    for (const OptionGroup& group : option_groups(command))
      for (const OptionHelp& option : group.options) {
        const std::string value = option.takes.empty() ? "" : values(option.takes);
        if (option.names.empty()) lines += begin + value + '\n';
        for (const std::string& one : option.names)
          lines += fmt::format("{} -{} {} -d {}{}\n", begin, one.substr(0, 2) == "--" ? "l" : "s",
                               one.substr(one.find_first_not_of('-')), quoted(option.text), value);
      }
  });
  return "# Completion of lgabench for fish, written from its --help.\n"
         "function _lgabench_word\n  set -l words (commandline -opc) ''\n  echo $words[$argv[1]]\nend\n"
         "# As the script of bash has it, which prints them: a list keeps what stands before its last comma.\n"
         "function _lgabench_words\n"
         "  set -l before (string match -r '.*,' -- (commandline -ct))\n"
         "  set -l script " +
         quoted(word_functions(app) + "_lgabench_words \"$@\"") +
         "\n"
         "  for word in (bash -c $script bash $argv[1] (_lgabench_word 3) 2>/dev/null)\n"
         "    string match -q -- '*,...' $argv[1]; and echo \"$before$word\"; or echo $word\n"
         "  end\nend\n"
         "complete -c lgabench -f\n" +
         lines;
}

}  // namespace lgabench::cli
