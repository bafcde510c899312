// lgabench run: a suite, or a part of it, from cells to the table.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/harness/run_suite.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {
namespace {

using Words = std::vector<std::string>;

struct Arguments {
  std::string suite, preset, answers = "recorded", out, cache;
  Words methods, engines, scenarios, layouts, demonstrations, seeds, settings;
  std::vector<fs::path> plugin_path;
  std::optional<int> episodes;
  int jobs = 0, limit = 0;  // 0: as many as there are cores, all cells
  double timeout_s = 3600;
  bool resume = false, fresh = false, no_reference = false, json = false;
};

// 0,1,2 or 0:3 (without its end). What is no number stays a word: the reader then says what it expected there.
Json numbers(const Words& words) {
  Json all = Json::array();
  for (const std::string& word : words) {
    const std::size_t colon = word.find(':');
    const Json first = option_value(word.substr(0, colon)),
               last = colon == std::string::npos ? Json() : option_value(word.substr(colon + 1));
    constexpr long long most = 10000;
    if (first.is_number_unsigned() && last.is_number_unsigned() && first < last &&
        last.get<long long>() - first.get<long long>() <= most)
      for (auto n = first.get<long long>(); n < last.get<long long>(); ++n) all.push_back(n);
    else
      all.push_back(option_value(word));
  }
  return all;
}

// The command line's part of the grid, checked by the same reader as a suite's file.
Grid grid_of(const Arguments& a, const Suite& suite) {
  Json overrides = Json::object();
  const auto give = [&overrides](const char* member, const Words& words) {
    if (!words.empty()) overrides[member] = words;
  };
  give("methods", a.methods);
  give("engines", a.engines);
  give("scenarios", a.scenarios);
  give("layouts", a.layouts);
  if (!a.demonstrations.empty()) overrides["demonstrations"] = numbers(a.demonstrations);
  if (!a.seeds.empty()) overrides["seeds"] = numbers(a.seeds);
  if (a.episodes) overrides["episodes"] = *a.episodes;
  Grid grid = apply(JsonReader(overrides, "command line"), preset_grid(suite, a.preset));
  grid.smoke |= a.limit != 0;
  return grid;
}

// --set method.option=value
Json options_of(const Words& settings) {
  Json options = Json::object();
  for (const std::string& setting : settings) {
    const std::size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || dot > equals)
      throw InputError(fmt::format("--set {}: expected method.option=value", setting));
    options[setting.substr(0, dot)][setting.substr(dot + 1, equals - dot - 1)] =
        option_value(setting.substr(equals + 1));
  }
  return options;
}

fs::path default_cache() {
  for (const auto& [variable, below] :
       {std::pair{"LGABENCH_CACHE", ""}, {"XDG_CACHE_HOME", "lgabench"}, {"HOME", ".cache/lgabench"}})
    if (const char* base = std::getenv(variable); base && *base) return fs::path(base) / below;
  return fs::temp_directory_path() / "lgabench-cache";
}

std::string shell_quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=./:,@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// As typed.
Words command_line() {
  const std::string bytes = read_file("/proc/self/cmdline");
  Words words;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\0', at), bytes.size());
    words.push_back(bytes.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

std::string joined(const Words& words) {
  Words quoted;
  std::transform(words.begin(), words.end(), std::back_inserter(quoted), shell_quoted);
  return fmt::format("{}", fmt::join(quoted, " "));
}

// The command that takes this run up again, wherever its default directory was.
std::string resuming_command(const Arguments& a, const fs::path& out) {
  Words words = command_line();
  words.erase(
      std::remove_if(words.begin(), words.end(), [](const auto& w) { return w == "--fresh" || w == "--resume"; }),
      words.end());
  if (a.out.empty()) words.insert(words.end(), {"--out", out.string()});
  words.push_back("--resume");
  return joined(words);
}

int run(const Arguments& a) {
  const Suite suite = load_suite(a.suite);
  const Grid grid = grid_of(a, suite);
  const Variation variation{a.answers, options_of(a.settings), !a.no_reference};
  const Catalogue catalogue = scan_plugins(plugin_directories(a.plugin_path));

  RunPlan plan;
  plan.cells = expand(suite, grid, variation, catalogue);
  if (a.limit != 0 && plan.cells.size() > static_cast<std::size_t>(a.limit))
    plan.cells.resize(static_cast<std::size_t>(a.limit));
  plan.request = to_json(grid);
  plan.request.update({{"suite", suite.id},
                       {"preset", a.preset},
                       {"answers", a.answers},
                       {"options", variation.options},
                       {"references", variation.references},
                       {"limit", a.limit}});
  plan.command = joined(command_line());
  plan.out = a.out;
  if (a.out.empty())
    plan.out = fs::path("runs") / fmt::format("{}{}-{}", suite.id, a.preset.empty() ? "" : "-" + a.preset,
                                              run_hash(plan.cells, catalogue));
  plan.cache = a.cache.empty() ? default_cache() : fs::path(a.cache);
  plan.existing = a.fresh ? Existing::fresh : a.resume ? Existing::resume : Existing::same;
  plan.pool.jobs = a.jobs != 0 ? a.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  plan.pool.timeout_s = a.timeout_s;

  const RunOutcome outcome = run_suite(plan, catalogue);
  if (outcome.interrupted) {
    fmt::print(stderr, "interrupted; what was finished is kept. To go on:\n  {}\n", resuming_command(a, plan.out));
    return interrupted;
  }
  report::write_report(plan.out);
  if (a.json)
    fmt::print("{}", read_file(plan.out / "summary.json"));
  else
    fmt::print("{}\nreport: {}\n", report::table_text(plan.out), (plan.out / "report.html").string());
  fmt::print(stderr, "{} cells computed, {} were there, {} failed\n", outcome.computed, outcome.reused, outcome.failed);
  if (outcome.plugin_refused) return plugin_refused;
  return outcome.failed ? cells_failed : ok;
}

}  // namespace

void add_run(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("run", "Compute a suite's cells and print its table");
  const auto list = [verb](const char* name, Words& words, const char* help) {
    verb->add_option(name, words, help)->delimiter(',')->take_all();
  };
  verb->add_option("suite", a->suite, "A suite's id, or a .json file of one")->required();
  verb->add_option("--preset", a->preset, "A part of the suite: smoke, paper, leaderboard");
  list("--methods", a->methods, "Methods, by plugin id; a variant as ID+OPTION=VALUE+OPTION=VALUE");
  list("--engines", a->engines, "Engines, by plugin id");
  list("--scenarios", a->scenarios, "Scenarios");
  list("--layout", a->layouts, "cells, continuous or released; several with commas");
  list("--demos", a->demonstrations, "Numbers of demonstrations: 10,20");
  list("--seeds", a->seeds, "Training seeds: 0,1,2 or 0:3");
  verb->add_option("--episodes", a->episodes, "Test scenes of each arm");
  verb->add_option("--jobs", a->jobs, "Cells computed at once (default: one a core)")->check(CLI::Range(1, 4096));
  verb->add_option("--timeout", a->timeout_s, "Seconds after which a cell is stopped and has failed")
      ->check(CLI::Range(1.0, 1e7))
      ->capture_default_str();
  verb->add_option("--plugin-path", a->plugin_path, "A directory of more plugins; may be given again");
  verb->add_option("--out", a->out, "Run directory (default: runs/SUITE-PRESET-HASH)");
  verb->add_option("--cache", a->cache,
                   "Where demonstrations are kept (default: $LGABENCH_CACHE, else ~/.cache/lgabench)");
  auto* resume = verb->add_flag("--resume", a->resume, "Go on in --out; cells of another build are computed again");
  verb->add_flag("--fresh", a->fresh, "Drop the run that is in --out")->excludes(resume);
  verb->add_option("--limit", a->limit, "Only the first N cells; not for the leaderboard")
      ->check(CLI::Range(1, 1 << 30));
  verb->add_option("--set", a->settings,
                   "method.option=value, for each of its rows that does not set it; may be given again")
      ->take_all();
  verb->add_option("--answers", a->answers,
                   "Whose recorded answers; recorded: GPT-4's where it was asked, else Claude's")
      ->check(CLI::IsMember({"recorded", "gpt4", "claude"}))
      ->capture_default_str();
  verb->add_flag("--no-reference", a->no_reference, "Without the rows constant_action, random_object and oracle");
  verb->add_flag("--json", a->json, "Print summary.json instead of the table");
  verb->footer(
      "Example: lgabench run q1 --scenarios heart,letter --demos 10,50 --seeds 0:3\n"
      "An ablation: lgabench run q1 --methods lga,lga+batch_norm=true,lga+loss=squared");
  verb->callback([a, &exit] { exit = run(*a); });
}

}  // namespace lgabench::cli
