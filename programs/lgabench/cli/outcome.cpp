#include <lgabench/cli/outcome.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include <lgabench/cli/help.hpp>
#include <lgabench/core/colour.hpp>
#include <lgabench/core/exit_status.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::cli {

using namespace exit_status;

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

void expect_run(const fs::path& directory) {
  std::error_code none_to_list;
  if (is_run(directory)) return;
  if (array_elements(directory) > 0)
    throw InputError(
        fmt::format("{}: the parts of a run that are not merged yet; lgabench status {} shows how far they are",
                    directory.string(), shell_line({directory.string()})));
  Words near;
  for (const fs::path& parent : {directory, fs::path("runs")})
    for (const auto& entry : fs::directory_iterator(parent, none_to_list))
      if (near.size() < 10 && is_run(entry.path())) near.push_back(entry.path().string());
  std::sort(near.begin(), near.end());
  throw InputError(fmt::format("{}: not the directory of a run (no run.json){}{}", directory.string(),
                               near.empty() ? "" : "; runs: ", fmt::join(near, ", ")));
}

int array_elements(const fs::path& directory) {
  std::error_code not_there;
  const fs::path script = directory / array_script_name;
  if (!fs::is_regular_file(script, not_there)) return 0;
  const std::string text = read_file(script), before = "\n#SBATCH --array=1-";
  const std::size_t at = text.find(before);
  return at == text.npos ? 0 : static_cast<int>(std::strtol(text.c_str() + at + before.size(), nullptr, 10));
}

void name_other_version(const statistics::RunResults& run) {
  if (run.record.version != LGABENCH_VERSION)
    to_stderr("{}: made by lgabench {}, read by {}\n", run.directory.string(), one_line(run.record.version),
              LGABENCH_VERSION);
}

namespace {

void print_painted(const std::string& unpainted) {
  std::string text = printable(unpainted);
  for (const char* mark : {"†", "‡", "§"}) {
    const std::string painted_mark = painted(stdout, Colour::yellow, mark);
    for (std::size_t at = 0; (at = text.find(mark, at)) != text.npos; at += painted_mark.size())
      text.replace(at, std::string(mark).size(), painted_mark);
  }
  put(stdout, text);
}

}  // namespace

void print_tables(const report::Report& report) {
  print_painted(document::terminal(report.document, report.run.directory));
}

void print_claims_section(const std::vector<statistics::Claim>& claims, const std::string& title) {
  to_stdout("{}\n\n{}", title, document::terminal(report::claims_section(claims, statistics::MethodStyles(), title)));
}

int exit_of(const statistics::RunResults& results, int otherwise) {
  name_other_version(results);
  for (const std::string& why : results.unreadable) to_stderr("left out: {}\n", why);
  if (results.not_run > 0) to_stderr("{} cells of the run have not been played: not final\n", results.not_run);
  if (!results.unreadable.empty()) return usage;
  const bool none_finished =
      std::all_of(results.cells.begin(), results.cells.end(), [](const auto& cell) { return cell.failed; });
  if (none_finished)
    to_stderr("{}: all its {} cells failed: nothing was measured\n", results.directory.string(), results.cells.size());
  return none_finished ? cells_failed : otherwise;
}

int verdict_of(const statistics::RunResults& results, const std::vector<statistics::Claim>& claims) {
  if (results.record.smoke) to_stderr("Smoke or limited run: not for the leaderboard.\n");
  const bool reversed = std::any_of(claims.begin(), claims.end(),
                                    [](const auto& c) { return c.verdict == statistics::Verdict::reversed; });
  return exit_of(results, reversed ? regression : ok);
}

int print_difference(const statistics::RunResults& run, const std::vector<std::string>& rows, bool json) {
  const std::vector<statistics::Claim> claims = statistics::test_difference(run, rows.at(0), rows.at(1));
  if (json)
    to_stdout("{}\n", statistics::to_json(run.suite, claims).dump(2));
  else
    print_claims_section(claims, "Two rows, paired");
  const int exit = verdict_of(run, claims);
  const bool tested = std::any_of(claims.begin(), claims.end(),
                                  [](const auto& c) { return c.verdict != statistics::Verdict::not_tested; });
  if (tested || exit != ok) return exit;
  to_stderr("{}: nothing was compared, the reason stands above\n", run.directory.string());
  return cells_failed;
}

void print_report(const fs::path& run, Printed what) {
  constexpr std::size_t many = 100;  // cells: some seconds
  if (const std::size_t cells = read_run_record(run).cells.size(); cells > many && what != Printed::table)
    to_stderr("making the report of {} cells\n", cells);
  const report::Report report = report::write_report(run);
  if (what == Printed::json) {
    to_stdout("{}", read_file(run / report_file::summary));
    return;
  }
  if (what == Printed::tables) {
    print_tables(report);
    return;
  }
  const auto& [means, notes] = report.brief;
  if (what == Printed::end && !report.document.headline.empty())
    to_stdout("{}\n\n", wrapped(document::TableCell(report.document.headline).text(), 0));
  if (!means.rows.empty()) print_painted(document::terminal(means));
  if (what == Printed::end && !notes.empty() && !means.rows.empty()) to_stdout("\n");
  for (const std::string& note : notes)
    if (what == Printed::end)
      print_painted(one_line(note) + "\n");
    else
      to_stderr("{}\n", one_line(note));
}

void print_page(const fs::path& run) { to_stdout("\nreport: {}\n", (run / report_file::page).string()); }

}  // namespace lgabench::cli
