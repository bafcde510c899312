#include <lgabench/cli/programs.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <lgabench/cli/commands.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_environment.hpp>

namespace lgabench::cli {
namespace {

bool is_worker_verb(const std::string& word) { return *worker_summary(word) != 0; }

// `help` in words that CLI11 knows; what is no command is left alone, to be refused.
void ask_for_help(const CLI::App& app, std::vector<std::string>& words) {
  if (words.empty() || words[0] != "help" || words.size() > 2) return;
  const std::string topic = words.size() == 2 ? words[1] : "";
  if (topic.empty())
    words = {"--help"};
  else if (topic == "all")
    words = {"--help-all"};
  else if (topic[0] != '-')
    words = {topic};
  const auto is_topic = [&topic](const CLI::App* one) { return one->get_name() == topic; };
  if (!app.get_subcommands(is_topic).empty()) words.push_back("--help");
}

}  // namespace

int hand_to_worker(std::vector<std::string> words) {
  const fs::path worker = program_directory() / "lgabench-worker";
  std::string name = "lgabench";
  std::vector<char*> argv{name.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(worker.c_str(), argv.data());
  to_stderr("lgabench: {}: cannot be started: {}\n", worker.string(), std::strerror(errno));
  return usage;
}

int lgabench_program(int argc, char** argv, const char* version) {
  open_standard_streams();
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && is_worker_verb(words[0])) return hand_to_worker(words);
  if (!words.empty() && words[0] == "commands") {
    words[0] = "draw-commands";
    say_renamed("lgabench commands", "lgabench draw-commands");
  }

  know_python_environments();
  int exit = ok;
  CLI::App app(about, "lgabench");
  app.set_version_flag("--version", version, "Print version, commit, build type and compiler");
  add_commands(app, exit);
  for (const auto& [verb, summary] : worker_verbs) app.add_subcommand(verb, summary);
  arrange_commands(app);
  ask_for_help(app, words);
  if (!words.empty() && is_worker_verb(words[0])) return hand_to_worker(words);
  return dispatch(app, words, exit);
}

}  // namespace lgabench::cli
