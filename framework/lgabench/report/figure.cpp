#include <lgabench/report/figure.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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

}  // namespace

std::string figure_script(const std::string& suite, const Table& table, const PaperValues& paper) {
  const std::vector<int> columns = table.demonstrations();
  const double span = columns.back() - columns.front(), pad = span > 0 ? span * 0.06 : 5;
  const double left = columns.front() - pad, right = columns.back() + pad;
  Script script;

  const std::vector<std::string> methods = table.methods(mean_scenario);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    // Methods stand a little apart, so that no whisker hides another.
    const double shift = (static_cast<double>(i) - static_cast<double>(methods.size() - 1) / 2) * pad * 0.12;
    std::string ours, theirs;
    for (const int n : columns)
      if (const Row* row = table.find(mean_scenario, methods[i], n); row && row->success)
        ours += fmt::format("{:.6g} {} {} {}\n", n + shift, *row->success, row->interval.low, row->interval.high);
    const std::string name = display_name(methods[i]), color = display_color(methods[i], i);
    script.add(ours, fmt::format("with yerrorlines lw 2 pt {} ps 0.9 lc rgb '{}' title {}", 5 + i % 5 * 2, color,
                                 quoted(name)));
    if (const auto published = paper.find(name); published != paper.end())
      for (const auto& [n, rate] : published->second) theirs += fmt::format("{} {}\n", n, rate);
    script.add(theirs,
               fmt::format("with lines lw 1.6 dt (6,4) lc rgb '{}' title {}", color, quoted(name + ", the paper")));
  }
  for (const std::string& id : table.references(mean_scenario)) {
    std::string levels;
    for (const int n : columns)
      if (const Row* row = table.find(mean_scenario, id, n); row && row->success) {
        // With a single column a level across the picture, as one point draws no line.
        if (columns.size() == 1)
          levels += fmt::format("{} {}\n{} {}\n", left, *row->success, right, *row->success);
        else
          levels += fmt::format("{} {}\n", n, *row->success);
      }
    const char* dashes = id == "oracle" ? "1" : id == "random_object" ? "(8,3,2,3)" : "(2,3)";
    script.add(levels, fmt::format("with lines lw 1.2 dt {} lc rgb '{}' title {}", dashes, display_color(id, 0),
                                   quoted(display_name(id))));
  }
  if (script.empty()) return "";

  std::string ticks;
  for (const int n : columns) ticks += fmt::format("{}{}", ticks.empty() ? "" : ", ", n);
  return script.text(fmt::format(
      "set terminal svg size 900,520 font 'Helvetica,14' background '#ffffff' noenhanced\n"
      "set title {} font ',15'\n"
      "set xlabel 'demonstrations'\n"
      "set ylabel 'success'\n"
      "set xrange [{}:{}]\n"
      "set xtics ({})\n"
      "set yrange [-0.02:1.03]\n"
      "set ytics 0, 0.2 nomirror\n"
      "set xtics nomirror\n"
      "set border 3 lc rgb '#444444'\n"
      "set grid ytics lc rgb '#dddddd' lt 1 lw 1\n"
      "set key outside right top Left reverse samplen 2.5 spacing 1.3\n",
      quoted(fmt::format("{}, {}: {}", suite, table.title(), table.title(mean_scenario))), left, right, ticks));
}

Figure draw_figure(const fs::path& run, const std::string& suite, const Table& table, const PaperValues& paper) {
  std::string name = "success_" + slug(table.layout) + "_" + slug(table.engine);
  if (table.arm != "test") name += "_" + slug(table.arm);
  Figure figure{"figures/" + name + ".svg", ""};

  const std::string text = figure_script(suite, table, paper);
  if (text.empty()) {
    figure.problem = "no cell has finished";
    return figure;
  }
  const fs::path script = run / "figures" / (name + ".gp");
  write_file(script, text);
  const fs::path drawn = run / "figures" / fmt::format(".{}.{}.tmp", name, ::getpid());
  figure.problem = run_gnuplot(script, drawn);
  if (figure.problem.empty()) write_file(run / figure.file, read_file(drawn));
  std::error_code ignored;
  fs::remove(drawn, ignored);
  return figure;
}

}  // namespace lgabench::report
