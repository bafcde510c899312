// lgabench open: a run's report in a browser, or a page over all runs that renews itself while they compute.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <tuple>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/http/page_server.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/report/index.hpp>

namespace lgabench::cli {
namespace {

constexpr int deepest = 3, renewed_s = 3;  // directories below the one that is looked in

// The variable's value; nothing where it is not set.
std::string value_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value ? value : "";
}

// In a session of its own, so that a browser outlives this program. Where there is none, the address was printed.
void show(const std::string& address) {
  const bool has_display = !value_of("DISPLAY").empty() || !value_of("WAYLAND_DISPLAY").empty();
  const std::string named = value_of("BROWSER"), browser = named.empty() ? "xdg-open" : named;
  if (named.empty() && !has_display) return;
  const Descriptor null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  try {
    wait_for(start_process(
        {{"setsid", "--fork", browser, address}, environment_with({}), {{null.fd, 0}, {null.fd, 1}, {null.fd, 2}}}));
  } catch (const Refused& e) {
    to_stderr("no browser was opened: {}\n", e.what());
  }
}

void find_runs(const fs::path& directory, int depth, std::vector<fs::path>& runs) {
  std::error_code none_to_list;
  for (const auto& entry : fs::directory_iterator(directory, none_to_list)) {
    if (!fs::is_directory(entry.symlink_status()) || entry.path().filename().string().front() == '.') continue;
    if (is_run(entry.path()))
      runs.push_back(entry.path());
    else if (depth < deepest)
      find_runs(entry.path(), depth + 1, runs);
  }
}

std::vector<report::Progressed> runs_below(const fs::path& directory) {
  std::vector<fs::path> runs;
  find_runs(directory, 0, runs);
  std::vector<report::Progressed> all;
  for (const fs::path& run : runs) all.push_back(report::progress_of(run, run.lexically_relative(directory).string()));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::tie(b.record.started, a.name) < std::tie(a.record.started, b.name);
  });
  return all;
}

// The index at "/", and the report of a run that it lists. No path is made of what was asked for.
std::optional<http::Page> page_at(const fs::path& directory, const std::string& path) {
  std::vector<fs::path> runs;
  if (path == "/") {
    const std::vector<report::Progressed> all = runs_below(directory);
    const bool computing = std::any_of(all.begin(), all.end(), [](const auto& run) { return run.computing; });
    return http::Page{
        document::html(report::progress_document(all, one_line(directory.string())), document::no_episodes()),
        computing || all.empty() ? renewed_s : 0};
  }
  find_runs(directory, 0, runs);
  for (const fs::path& run : runs)
    if (path == "/" + (run.lexically_relative(directory) / report_file::page).generic_string())
      return http::Page{read_file(run / report_file::page, Links::refused)};
  return std::nullopt;
}

int open_runs(fs::path where) {
  if (where.empty()) where = fs::is_directory("runs") ? "runs" : ".";
  if (is_run(where)) {
    const fs::path page = fs::absolute(where / report_file::page).lexically_normal();
    if (!fs::exists(page)) report::write_report(where);
    to_stdout("{}\n", page.string());
    flush_stdout();
    show(page.string());
    return ok;
  }
  if (!fs::is_directory(where)) expect_run(where);
  const fs::path directory = fs::absolute(where / "").lexically_normal().parent_path();
  http::PageServer server([directory](const std::string& path) { return page_at(directory, path); });
  const std::string address = fmt::format("http://127.0.0.1:{}/", server.port());
  to_stdout("{} (Ctrl-C stops it)\n", address);
  flush_stdout();
  show(address);
  http::until_stopped([&server] { server.run(); }, [&server] { server.stop(); });
  return ok;
}

}  // namespace

void add_open(CLI::App& app, int& exit) {
  auto where = std::make_shared<fs::path>();
  Verb verb(app, "open", "Open a run's report in a browser, or a page over all runs");
  verb.option("RUN", *where,
              "A run: open shows its report, and makes one if there is none. A directory: open serves its runs on "
              "this machine alone, on a page that renews itself while they compute (default: runs, else this "
              "directory)");
  verb->footer(
      "Examples\n"
      "  lgabench open runs/q1-smoke-1a2b3c4d    its report.html\n"
      "  lgabench open                           all runs, until Ctrl-C\n"
      "The browser is that of the variable BROWSER, else the desktop's (xdg-open); without either, open the address "
      "that is printed.");
  verb->callback([where, &exit] { exit = open_runs(*where); });
}

}  // namespace lgabench::cli
