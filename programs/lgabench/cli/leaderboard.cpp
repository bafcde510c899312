// lgabench leaderboard: published results, added, checked and made into pages.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>

#include <lgabench/cli/help.hpp>
#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/own_names.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/colour.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/python_method.hpp>
#include <lgabench/leaderboard/add.hpp>
#include <lgabench/leaderboard/archive.hpp>
#include <lgabench/leaderboard/check.hpp>
#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/recompute.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/leaderboard/supersede.hpp>
#include <lgabench/leaderboard/verification.hpp>

namespace lgabench::cli {
namespace {

struct LeaderboardArguments {
  std::string action, what, line, about, against, reason, nonce, python = usual_python();
  fs::path board = "results/leaderboard", archive;
  Words rows, methods;
  std::vector<fs::path> plugin_path, documents;
  leaderboard::VerifyOptions verify;
  bool maintainer = false;
  int jobs = 0;  // as many as there are cores
};

int print_all(const std::vector<std::string>& lines, const char* before) {
  for (const std::string& line : lines) to_stderr("{}{}\n", before, one_line(line));
  return lines.empty() ? ok : regression;
}

int add(const LeaderboardArguments& a) {
  if (a.what.empty() || a.about.empty()) throw InputError("leaderboard add: expected RUN, and --entry META.json");
  expect_run(a.what);
  const leaderboard::Added added = leaderboard::add_run(a.board, a.what, leaderboard::read_about(a.about), a.rows);
  if (print_all(added.refused, "refused: ") != ok) return regression;
  for (const std::string& entry : added.entries) to_stdout("added {}\n", entry);
  for (const std::string& entry : added.evidence) to_stdout("evidence added to {}\n", entry);
  to_stderr("Next: lgabench leaderboard build --board {}\n", path_word(a.board));
  return ok;
}

// What `add` makes where somebody says so, and all else needs.
void expect_board(const fs::path& board) {
  if (!fs::is_directory(board))
    throw InputError(fmt::format(
        "{}: no leaderboard is there; give --board DIR, or run the command in a checkout of lgabench's sources",
        board.string()));
}

std::string replay_words(const leaderboard::Entry& entry, const Json& line) {
  std::string words = fmt::format("{} of {} cells bit-identical, {} of {} episodes ended differently",
                                  line.at("bit_identical").get<int>(), line.at("cells").size(),
                                  line.at("flips").get<int>(), line.at("episodes").get<int>());
  if (line.at("bit_identical").get<std::size_t>() < line.at("cells").size())
    words += fmt::format("; the entry: {}; here: {}", to_string(entry.processor()),
                         to_string(leaderboard::processor_of(line)));
  return words;
}

// The mean over arms, then the arms that differ.
std::string fresh_words(const leaderboard::Entry& entry, const Json& line) {
  const std::vector<leaderboard::FreshEstimate> estimates = leaderboard::fresh_estimates(entry, {&line});
  const auto words = [](const leaderboard::FreshEstimate& one) {
    return fmt::format("{:+.3f} [{:+.3f}, {:+.3f}]", one.difference, one.low, one.high);
  };
  std::string text = words(estimates.back()) + " on fresh scenes";
  for (const leaderboard::FreshEstimate& one : estimates)
    if (!one.arm.empty() && estimates.size() > 1 && one.differs())
      text += fmt::format("; arm {} differs: {}", one.arm, words(one));
  if (line.at("passed").get<bool>())
    text += fmt::format("; a gain of {:.3f} would be found four times in five", leaderboard::smallest_found(estimates));
  return text;
}

std::string found_words(const leaderboard::Entry& entry, const Json& line) {
  const std::string kind = line.at("kind");
  return kind == "fresh"      ? fresh_words(entry, line)
         : kind == "commands" ? leaderboard::fresh_commands_words(line)
                              : replay_words(entry, line);
}

// @throws InputError where anybody may know what it draws: it stands in a verification.
void expect_new(const std::string& nonce, const fs::path& board, const std::vector<fs::path>& entries) {
  if (nonce.size() != 32 || nonce.find_first_not_of("0123456789abcdef") != nonce.npos)
    throw InputError(fmt::format(
        "--fresh-commands: expected 32 hexadecimal digits, as openssl rand -hex 16 prints them, got \"{}\"", nonce));
  for (const fs::path& entry : entries)
    if (const fs::path file = board / entry / "verifications.jsonl";
        fs::exists(file) && read_file(file, Links::refused).find(nonce) != std::string::npos)
      throw InputError(fmt::format("--fresh-commands: {} was used, in {}; expected a new one", nonce, file.string()));
}

// The plugins, and in `a` how many cells to compute at once.
Catalogue ready_to_compute(LeaderboardArguments& a) {
  Catalogue catalogue = scan_plugins(plugin_directories(a.plugin_path));
  for (const std::string& method : a.methods) with_python_method(method, a.python, catalogue);
  a.verify.pool.jobs = jobs_of(a.jobs);
  return catalogue;
}

// One line for each entry; a verification is recorded, whatever it says. Entries that cannot be verified stop no other.
int verify(LeaderboardArguments a) {
  if (a.verify.by.empty()) throw InputError("leaderboard verify: expected --by NAME, who verifies");
  a.verify.on_commands = !a.nonce.empty();
  if (a.verify.on_commands) expect_new(a.nonce, a.board, leaderboard::entry_directories(a.board));
  const Catalogue catalogue = ready_to_compute(a);
  std::vector<fs::path> entries;
  if (!a.what.empty())
    entries.push_back(leaderboard::find_entry(a.board, a.what));
  else
    entries = leaderboard::entry_directories(a.board);
  const leaderboard::Vouched vouched = leaderboard::read_vouched(a.board);
  bool differs = false;
  std::size_t verified = 0, unverified = 0;
  for (const fs::path& directory : entries) {
    leaderboard::Entry entry;
    std::optional<Json> line;
    try {
      entry = leaderboard::read_entry(a.board, directory, &vouched);
      if (!entry.withdrawn.is_null()) continue;
      if (a.verify.fresh && !entry.score.is_null())
        to_stderr(
            "{}: --fresh plays new scenes of the same commands; nobody is asked about other commands "
            "(docs/language-models.md)\n",
            entry.id());
      line = leaderboard::verification(a.board, entry, a.nonce.empty() ? leaderboard::new_nonce() : a.nonce, catalogue,
                                       a.verify);
    } catch (const Error& e) {  // a plugin that is not here, another version, a cell that the host failed
      to_stderr("not verified: {}: {}\n", directory.string(), one_line(e.what()));
      ++unverified;
      continue;
    }
    if (!line) return interrupted;
    leaderboard::add_verification(a.board, entry, *line);
    ++verified;
    const bool passed = line->at("passed");
    to_stdout("{} {}: {} (nonce {})\n", passed ? "agrees " : "DIFFERS", directory.string(), found_words(entry, *line),
              line->at("nonce").get<std::string>());
    if (const std::size_t enough = leaderboard::enough_cells_of(entry);
        line->at("kind") == "replay" && line->at("cells").size() < enough)
      to_stderr("Too few cells to count: nobody vouches for a replay of fewer than {} (--cells {})\n", enough, enough);
    else
      to_stderr("To make it count: lgabench leaderboard vouch {} {} --board {}\n", shell_line({entry.id()}),
                entry.verifications.size() + 1, path_word(a.board));
    differs = differs || !passed;
  }
  if (verified + unverified == 0)
    throw InputError(fmt::format("{}: no entry that is not withdrawn: nothing was verified",
                                 a.what.empty() ? a.board.string() : a.what));
  if (unverified > 0) to_stderr("{} of {} entries were not verified\n", unverified, entries.size());
  return differs ? regression : unverified > 0 ? usage : ok;
}

// Pictures of each entry that has none, the cheapest first. Entries that cannot be played stop no other.
int scenes(LeaderboardArguments a) {
  const Catalogue catalogue = ready_to_compute(a);
  std::vector<leaderboard::Entry> entries = leaderboard::read_entries(a.board);
  std::sort(entries.begin(), entries.end(), [](const leaderboard::Entry& one, const leaderboard::Entry& other) {
    return leaderboard::seconds_of_scenes(one) < leaderboard::seconds_of_scenes(other);
  });
  leaderboard::BoardScenes known = leaderboard::read_scenes(a.board, entries);
  const std::string only = a.what.empty() ? "" : leaderboard::find_entry(a.board, a.what).string();
  std::size_t without = 0;
  for (const leaderboard::Entry& entry : entries) {
    if (only.empty() ? known.count(entry.id()) > 0 : only != entry.place().string()) continue;
    try {
      const auto pictures = leaderboard::add_scenes(a.board, entry, catalogue, a.verify, known);
      if (!pictures) return interrupted;
      for (const fs::path& picture : *pictures) to_stdout("{}\n", picture.string());
    } catch (const Error& e) {
      to_stderr("no scenes: {}: {}\n", entry.place().string(), one_line(e.what()));
      ++without;
    }
  }
  return without > 0 ? usage : ok;
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

int supersede(const LeaderboardArguments& a) {
  if (a.what.empty() || a.reason.empty() || a.verify.by.empty())
    throw InputError("leaderboard supersede: expected RUN, --reason WORDS, and --by NAME, who computed it");
  expect_run(a.what);
  const leaderboard::Superseded done = leaderboard::supersede(a.board, a.what, a.rows, a.verify.by, a.reason, today());
  if (print_all(done.refused, "refused: ") != ok) return regression;
  for (const std::string& entry : done.same) to_stdout("the same bits already: {}\n", entry);
  for (const std::string& entry : done.entries) to_stdout("superseded {}\n", entry);
  if (!done.entries.empty())
    to_stderr("Next, for each: lgabench leaderboard verify ENTRY --by NAME; vouch; scenes; then build --board {}\n",
              shell_line({a.board.string()}));
  return ok;
}

int withdraw(const LeaderboardArguments& a) {
  if (a.what.empty() || a.reason.empty()) throw InputError("leaderboard withdraw: expected ENTRY, and --reason WORDS");
  leaderboard::withdraw(a.board, a.what, a.reason, today());
  to_stdout("the entry is withdrawn; its files remain\n");
  return ok;
}

int vouch(const LeaderboardArguments& a) {
  if (a.what.empty() || a.line.empty())
    throw InputError("leaderboard vouch: expected ENTRY, and LINE: its number in verifications.jsonl, or withdrawn");
  const Json line = leaderboard::vouch(a.board, a.what, a.line);
  const std::string kind = line.value("kind", "withdrawal"), when = line.at("when");
  std::string words;
  if (kind == "withdrawal") {
    words = fmt::format("withdrawal on {}: {}", when, line.at("reason").get<std::string>());
  } else {
    const leaderboard::Vouched vouched = leaderboard::read_vouched(a.board);
    const leaderboard::Entry entry =
        leaderboard::read_entry(a.board, leaderboard::find_entry(a.board, a.what), &vouched);
    words = fmt::format("{} by {} on {}: {} {}", kind, line.at("by").get<std::string>(), when,
                        line.at("passed").get<bool>() ? "agrees," : "DIFFERS,", found_words(entry, line));
  }
  to_stdout("vouched for {}: {}\n", one_line(words), leaderboard::line_hash(line));
  return ok;
}

// How far reading and computing are, on stderr: one line on a terminal, else a line after five seconds and every half
// minute.
class Steps {
 public:
  Steps() = default;
  ~Steps() {
    if (terminal_) put(stderr, "\r\x1b[K");
  }
  Steps(const Steps&) = delete;
  Steps& operator=(const Steps&) = delete;

  leaderboard::OnProgress on_progress() {
    return [this](const char* what, std::size_t done, std::size_t of, const char* things) {
      const auto now = Clock::now();
      if (!terminal_ && now - told_ < pause_) return;
      told_ = now;
      pause_ = std::chrono::seconds(30);
      put(stderr, fmt::format("{}{} {} of {} {}{}", terminal_ ? "\r\x1b[K" : "", what, done, of, things,
                              terminal_ ? "" : "\n"));
    };
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_ = is_terminal(stderr);
  Clock::time_point told_ = Clock::now();
  std::chrono::seconds pause_{5};
};

int check(const LeaderboardArguments& a) {
  leaderboard::CheckOptions options{a.against, a.maintainer, a.documents};
  options.installed = scan_plugins(plugin_directories(a.plugin_path));
  leaderboard::Checked checked;
  {
    Steps steps;
    options.on_progress = steps.on_progress();
    checked = leaderboard::check(a.board, options);
  }
  to_stdout("{} entr{}, {} problem{}\n", checked.entries, checked.entries == 1 ? "y" : "ies", checked.problems.size(),
            checked.problems.size() == 1 ? "" : "s");
  return print_all(checked.problems, "");
}

int build(const LeaderboardArguments& a) {
  std::vector<fs::path> files;
  {
    Steps steps;
    files = leaderboard::build(a.board, a.documents, steps.on_progress());
  }
  for (const fs::path& file : files) to_stdout("{}\n", file.string());
  if (a.archive.empty()) return ok;
  if (const int found = check(a); found != ok) return found;
  leaderboard::write_archive(a.board, a.archive);
  to_stdout("{}\n", a.archive.string());
  return ok;
}

}  // namespace

void add_leaderboard(CLI::App& app, int& exit) {
  auto a = std::make_shared<LeaderboardArguments>();
  Verb verb(app, "leaderboard", "Add results to a leaderboard, check it, and make its pages");
  const Words actions{"add", "verify", "vouch", "build", "check", "withdraw", "supersede", "scenes"};
  verb.option("ACTION", a->action, "add, verify, vouch, build, check, withdraw, supersede or scenes", required,
              one_of("action", actions));
  verb.option("WHAT", a->what,
              "add, supersede: a run's directory; verify, vouch, withdraw, scenes: an entry's directory or id (without "
              "one, verify takes all entries and scenes all without pictures)");
  verb.option("LINE", a->line, "vouch: the number of a line in verifications.jsonl, or `withdrawn`");
  verb.option("--board DIR", a->board, "The leaderboard's directory", with_default);
  verb.below("add, withdraw and supersede");
  verb.option("--entry META.json", a->about,
              "add: a file that says who submits the rows, and where their source code is "
              "(docs/entering-the-leaderboard.md)");
  verb.option("--rows ROW,...", a->rows, "add, supersede: only these rows of the run");
  verb.option("--reason WORDS", a->reason, "withdraw, supersede: the reason");
  verb.below("verify and scenes");
  auto* cells = verb.option("--cells N", a->verify.cells, "verify: how many cells to play, chosen by a nonce drawn now",
                            CLI::Range(1, 1000000), with_default);
  auto* fresh = verb.option("--fresh", a->verify.fresh, "verify: play on new test scenes, and compare success");
  fresh->excludes(cells);
  auto* commands = verb.option("--fresh-commands NONCE", a->nonce,
                               "verify: draw new commands from these 32 hexadecimal digits, which nobody knew before, "
                               "and score what the method selects for them, on their truth as the answers");
  commands->excludes(cells)->excludes(fresh);
  verb.option("--commands N", a->verify.commands, "verify: how many commands to draw",
              CLI::Range(leaderboard::fewest_commands, leaderboard::most_commands), with_default)
      ->needs(commands);
  verb.option("--by NAME", a->verify.by, "verify, supersede: your name, as the one who computes the cells");
  verb.option("--jobs N", a->jobs,
              "verify, scenes: cells to compute at once (default: one for each core that the job has)",
              CLI::Range(1, 4096));
  verb.option("--timeout SECONDS", a->verify.pool.timeout_s, "verify, scenes: seconds after which a cell is stopped",
              within(1, 1e7), with_default);
  verb.option("--methods FILE.py:CLASS,...", a->methods, "verify, scenes: methods in Python, as FILE.py:Class");
  verb.option("--python PROGRAM", a->python, "verify, scenes: the interpreter for methods in Python", with_default);
  add_plugin_path(verb, a->plugin_path);
  verb.below("build and check");
  verb.option("--against REVISION", a->against,
              "build, check: a git revision of the checkout you are in; the outcomes in it must not have changed");
  verb.option("--maintainer", a->maintainer, "build, check: with --against, allow changes to the maintainers' files");
  verb.option("--documents PATH,...", a->documents,
              "build, check: documents that contain tables of the board between markers, or a folder of them");
  verb.option("--archive OUT.tar.gz", a->archive,
              "build: check the board, then pack it into an archive, with license and citation");
  verb->footer(
      "Example: lgabench leaderboard add runs/q1-leaderboard --entry me.json && lgabench leaderboard build\n"
      "  add        adds rows of a run; it refuses a run that is not the whole preset on the board's scenes\n"
      "  verify     plays cells of an entry again, confined and without a cache, and records the outcome\n"
      "  vouch      makes a recorded outcome count; until then it is a claim, and the entry has no rank\n"
      "  build      writes the board's pages and tables, and entries of 0.4 and earlier in their shorter form\n"
      "  check      compares these with the entries; it only reads files\n"
      "  withdraw   takes an entry off the board; its files remain\n"
      "  supersede  takes new cells for entries from a run that computed them anew; the old files remain\n"
      "  scenes     plays two cells of an entry again and draws an episode of each\n"
      "Exit 1: refused, different, or a problem. Exit 2: none of these, but an entry was not verified or played.");
  verb->callback([a, actions, verb = verb.get(), &app, &exit] {
    expect_options_of(*verb, a->action, actions);
    if (!a->what.empty() && (a->action == "build" || a->action == "check"))
      throw InputError(fmt::format("leaderboard {}: \"{}\" is a word too many", a->action, a->what));
    if (!a->line.empty() && a->action != "vouch")
      throw InputError(fmt::format("leaderboard {}: \"{}\" is a word too many", a->action, a->line));
    a->verify.program = app.version();
    if (a->action != "add" || verb->count("--board") == 0) expect_board(a->board);
    exit = a->action == "verify"      ? verify(*a)
           : a->action == "add"       ? add(*a)
           : a->action == "vouch"     ? vouch(*a)
           : a->action == "build"     ? build(*a)
           : a->action == "check"     ? check(*a)
           : a->action == "scenes"    ? scenes(*a)
           : a->action == "supersede" ? supersede(*a)
                                      : withdraw(*a);
  });
}

}  // namespace lgabench::cli
