#include <lgabench/report/figure.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include <lgabench/report/names.hpp>

namespace lgabench::report {
namespace {

// A gnuplot string. Ids come from files: no quote or line break of theirs may end it and start a command.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "''";
    else
      out += std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  }
  return out + "'";
}

// Letters, digits and dashes of an id, for a file name.
std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  return out;
}

// Data blocks and the clauses of one plot command.
class Script {
 public:
  // A curve; none where there are no data.
  void add(const std::string& data, const std::string& style) {
    if (data.empty()) return;
    blocks_ += fmt::format("$d{} << END\n{}END\n", count_, data);
    plots_ += fmt::format("{}$d{} {}", count_ == 0 ? "plot " : ", \\\n     ", count_, style);
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  std::string text(const std::string& settings) const { return blocks_ + settings + plots_ + "\n"; }

 private:
  int count_ = 0;
  std::string blocks_, plots_;
};

// Runs `gnuplot script`, its output into `svg`. Returns what went wrong, or "".
std::string run_gnuplot(const fs::path& script, const fs::path& svg) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, svg.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  std::string program = "gnuplot", defaults = "-d", file = script.string();  // -d: nobody's start-up file
  char* arguments[] = {program.data(), defaults.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) return "gnuplot is not installed";
  if (error != 0) return fmt::format("gnuplot could not be started: {}", std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? "" : "gnuplot failed on the script beside the figure";
}

const char* dashes(const std::string& reference) {
  return reference == "oracle" ? "1" : reference == "random_object" ? "(8,3,2,3)" : "(2,3)";
}

std::string title(const std::string& suite, const Table& table, const std::string& rest) {
  return fmt::format("{}, {}{}: {}", suite, table.title(), rest, table.title(mean_scenario));
}

std::string settings(const std::string& title, const std::string& axis, double left, double right, double bottom,
                     const std::string& ticks) {
  return fmt::format(
      "set terminal svg size 900,620 font 'Helvetica,14' background '#ffffff' noenhanced\n"
      "set title {} font ',15'\n"
      "set xlabel {}\n"
      "set ylabel 'success'\n"
      "set xrange [{}:{}]\n"
      "set xtics ({})\n"
      "set yrange [{}:1.03]\n"
      "set ytics 0, 0.2 nomirror\n"
      "set xtics nomirror\n"
      "set border 3 lc rgb '#444444'\n"
      "set grid ytics lc rgb '#dddddd' lt 1 lw 1\n"
      "set key below center horizontal Left reverse maxcols 3 samplen 2.5 spacing 1.2\n",
      quoted(title), quoted(axis), left, right, ticks, bottom);
}

// Writes RUN/figures/NAME.gp and runs it.
Figure draw(const fs::path& run, const std::string& title, const std::string& name, const std::string& script) {
  Figure figure{title, "figures/" + name + ".svg", ""};
  if (script.empty()) {
    figure.problem = "no cell has finished";
    return figure;
  }
  const fs::path file = run / "figures" / (name + ".gp");
  write_file(file, script);
  const fs::path drawn = run / "figures" / fmt::format(".{}.{}.tmp", name, ::getpid());
  figure.problem = run_gnuplot(file, drawn);
  if (figure.problem.empty()) write_file(run / figure.file, read_file(drawn));
  std::error_code ignored;
  fs::remove(drawn, ignored);
  return figure;
}

}  // namespace

std::string curves_script(const std::string& suite, const Table& table, const std::string& arm,
                          const PaperValues& paper) {
  const std::vector<int> columns = table.demonstrations();
  const double span = columns.back() - columns.front(), pad = span * 0.06;
  Script script;

  const std::vector<std::string> methods = table.methods(mean_scenario);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    // Methods stand a little apart, so that no whisker hides another.
    const double shift = (static_cast<double>(i) - static_cast<double>(methods.size() - 1) / 2) * pad * 0.12;
    const std::string name = display_name(methods[i]), color = display_color(methods[i], i);
    std::string ours, theirs;
    for (const int n : columns) {
      if (const Row* row = table.find(arm, mean_scenario, methods[i], n); row && row->success)
        ours += fmt::format("{:.6g} {} {} {}\n", n + shift, *row->success, row->interval.low, row->interval.high);
      if (const auto rate = paper.find(mean_scenario, name, n))
        theirs += fmt::format("{} {} {}\n", n, *rate, paper.error(mean_scenario, name, n).value_or(0));
    }
    script.add(ours, fmt::format("with yerrorlines lw 2 pt {} ps 0.9 lc rgb '{}' title {}", 5 + i % 5 * 2, color,
                                 quoted(name)));
    script.add(theirs, fmt::format("with yerrorlines lw 1.6 dt (6,4) pt 0 lc rgb '{}' title {}", color,
                                   quoted(name + ", the paper")));
  }
  for (const std::string& id : table.references(mean_scenario)) {
    std::string levels;
    for (const int n : columns)
      if (const Row* row = table.find(arm, mean_scenario, id, n); row && row->success)
        levels += fmt::format("{} {}\n", n, *row->success);
    script.add(levels, fmt::format("with lines lw 1.2 dt {} lc rgb '{}' title {}", dashes(id), display_color(id, 0),
                                   quoted(display_name(id))));
  }
  if (script.empty()) return "";

  std::string ticks;
  for (const int n : columns) ticks += fmt::format("{}{}", ticks.empty() ? "" : ", ", n);
  return script.text(settings(title(suite, table, table.arms.size() > 1 ? ", " + arm : ""), "demonstrations",
                              columns.front() - pad, columns.back() + pad, -0.02, ticks));
}

std::string bars_script(const std::string& suite, const Table& table) {
  const int n = table.demonstrations().front();
  constexpr double group = 0.8;  // width of an arm's bars, of the 1 between arms
  Script script;

  // A line for each arm: its place, shifted, and the row's numbers.
  const auto data = [&table, n](const std::string& id, double shift) {
    std::string lines;
    for (std::size_t arm = 0; arm < table.arms.size(); ++arm)
      if (const Row* row = table.find(table.arms[arm], mean_scenario, id, n); row && row->success)
        lines += fmt::format("{:.6g} {} {} {}\n", static_cast<double>(arm) + shift, *row->success, row->interval.low,
                             row->interval.high);
    return lines;
  };
  const std::vector<std::string> methods = table.methods(mean_scenario);
  const double width = group / static_cast<double>(std::max<std::size_t>(methods.size(), 1));
  for (std::size_t i = 0; i < methods.size(); ++i) {
    script.add(data(methods[i], (static_cast<double>(i) + 0.5) * width - group / 2),
               fmt::format("using 1:2:3:4:({:.6g}) with boxerrorbars fs solid noborder lc rgb '{}' title {}",
                           width * 0.9, display_color(methods[i], i), quoted(display_name(methods[i]))));
  }
  for (const std::string& id : table.references(mean_scenario))
    script.add(data(id, -0.46),
               fmt::format("using 1:2:(0.92):(0) with vectors nohead lw 1.6 dt {} lc rgb '{}' title {}", dashes(id),
                           display_color(id, 0), quoted(display_name(id))));
  if (script.empty()) return "";

  std::string ticks;
  for (std::size_t arm = 0; arm < table.arms.size(); ++arm)
    ticks += fmt::format("{}{} {}", arm == 0 ? "" : ", ", quoted(table.arm_title(table.arms[arm])), arm);
  return script.text("set errorbars 0.7 front lw 1.4 lc rgb '#222222'\n" +
                     settings(title(suite, table, ", " + table.demonstrations_text(n)), "arm", -0.6,
                              static_cast<double>(table.arms.size()) - 0.4, 0, ticks));
}

std::vector<Figure> draw_figures(const fs::path& run, const std::string& suite, const Table& table,
                                 const PaperValues& paper) {
  const std::string name = "success_" + slug(table.layout) + "_" + slug(table.engine);
  if (table.demonstrations().size() == 1) return {draw(run, "success", name, bars_script(suite, table))};
  std::vector<Figure> figures;
  for (const std::string& arm : table.arms) {
    const bool one = table.arms.size() == 1;
    figures.push_back(draw(run, "success against demonstrations", one ? name : name + "_" + slug(arm),
                           curves_script(suite, table, arm, paper)));
  }
  return figures;
}

}  // namespace lgabench::report
