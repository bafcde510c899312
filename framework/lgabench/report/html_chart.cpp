// Charts as SVG. Colours are the style sheet's business where they differ between dark and light.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>

namespace lgabench::report::html_parts {
namespace {

constexpr double width = 480, height = 300, left = 40, right = 12, top = 12, bottom = 44;
constexpr int marks = 4;

double y_of(double rate) { return top + (1 - rate) * (height - top - bottom); }

// A mark, told apart by its shape as well.
std::string mark(std::size_t shape, double x, double y, const char* attributes) {
  switch (shape % marks) {
    case 0:
      return fmt::format("<circle cx={:.1f} cy={:.1f} r=5 {}/>", x, y, attributes);
    case 1:
      return fmt::format("<rect x={:.1f} y={:.1f} width=9 height=9 {}/>", x - 4.5, y - 4.5, attributes);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l6 10h-12z\" {}/>", x, y - 6.5, attributes);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l6 6-6 6-6-6z\" {}/>", x, y - 6, attributes);
  }
}

// "#000000" is the text's colour, which a dark page turns.
std::string colour(const std::string& method, std::size_t index) {
  const std::string own = display_color(method, index);
  return own == "#000000" ? "var(--ink)" : own;
}

// A place on the x axis: a number of demonstrations, or an arm.
struct Place {
  std::string label, arm;
  int demonstrations;
  double x;
};

std::vector<Place> places(const Table& table, const std::string& arm) {
  std::vector<Place> all;
  const std::vector<int> demonstrations = table.demonstrations();
  const double pad = 34, inner = width - left - right - 2 * pad;
  if (demonstrations.size() > 1) {
    const double span = demonstrations.back() - demonstrations.front();
    for (const int n : demonstrations)
      all.push_back({std::to_string(n), arm, n, left + pad + inner * (n - demonstrations.front()) / span});
  } else {
    const double step = (width - left - right) / static_cast<double>(table.arms.size());
    for (std::size_t i = 0; i < table.arms.size(); ++i)
      all.push_back({table.arm_title(table.arms[i]), table.arms[i], demonstrations.front(),
                     left + step * (static_cast<double>(i) + 0.5)});
  }
  return all;
}

std::string axes(const std::vector<Place>& along, const std::string& axis) {
  std::string text = "<g class=axes>";
  for (int tenth = 0; tenth <= 10; tenth += 2)
    text += fmt::format("<path d=\"M{} {:.1f}H{}\"/><text x={} y={:.1f} text-anchor=end>{:.1f}</text>", left,
                        y_of(tenth / 10.0), width - right, left - 8, y_of(tenth / 10.0) + 4, tenth / 10.0);
  const bool slanted = along.size() > 5 && along.front().arm != along.back().arm;
  for (const Place& place : along)
    text += slanted
                ? fmt::format(
                      "<text class=slanted transform=\"translate({:.1f} {}) rotate(-20)\" text-anchor=end>{}</text>",
                      place.x + 6, height - bottom + 16, escaped(place.label))
                : fmt::format("<text x={:.1f} y={} text-anchor=middle>{}</text>", place.x, height - bottom + 18,
                              escaped(place.label));
  if (!slanted)
    text += fmt::format("<text class=axis x={} y={} text-anchor=middle>{}</text>", (left + width - right) / 2,
                        height - 6, axis);
  return text + "</g>";
}

// One method's points with whiskers, joined where they lie along the demonstrations.
std::string curve(const Table& table, const std::vector<Place>& along, const std::string& scenario,
                  const std::string& id, std::size_t index, double shift, bool joined, const PaperValues& paper,
                  const RowNumbers& numbers) {
  std::string line, theirs, points;
  const std::string name = escaped(display_name(id));
  for (const Place& place : along) {
    if (const auto rate = paper.find(scenario, display_name(id), place.demonstrations); rate && joined) {
      const auto error = paper.error(scenario, display_name(id), place.demonstrations);
      theirs += fmt::format("{}{:.1f} {:.1f}", theirs.empty() ? "M" : "L", place.x, y_of(*rate));
      points += fmt::format(
          "<g class=\"point theirs\" tabindex=0 role=img aria-label=\"{}, the paper’s, at {}: {:.3f}{}\">{}{}</g>",
          name, escaped(place.label), *rate, error ? fmt::format(" ± {:.3f}", *error) : "",
          error ? fmt::format("<path class=\"whisker theirs\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", place.x,
                              y_of(*rate - *error), y_of(*rate + *error))
                : "",
          mark(index, place.x, y_of(*rate), "class=\"hollow\""));
    }
    const Row* row = table.find(place.arm, scenario, id, place.demonstrations);
    if (!row || !row->success) continue;
    const double x = place.x + shift, y = y_of(*row->success);
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
    points += fmt::format(
        "<g class=point tabindex=0 role=button data-row={} aria-label=\"{} at {}: {:.2f} [{:.2f}, {:.2f}]\">"
        "<path class=whisker d=\"M{:.1f} {:.1f}V{:.1f}\"/>{}</g>",
        numbers(*row), name, escaped(place.label), *row->success, row->interval.low, row->interval.high, x,
        y_of(row->interval.low), y_of(row->interval.high), mark(index, x, y, ""));
  }
  if (line.empty() && theirs.empty()) return "";
  return fmt::format("<g style=\"--c:{}\">{}{}{}</g>", colour(id, index),
                     theirs.empty() ? "" : "<path class=\"line theirs\" d=\"" + theirs + "\"/>",
                     joined && !line.empty() ? "<path class=line d=\"" + line + "\"/>" : "", points);
}

// A reference row: a level, no method.
std::string level(const Table& table, const std::vector<Place>& along, const std::string& scenario,
                  const std::string& id, bool joined, const RowNumbers& numbers) {
  std::string line, points;
  for (const Place& place : along) {
    const Row* row = table.find(place.arm, scenario, id, place.demonstrations);
    if (!row || !row->success) continue;
    const double y = y_of(*row->success);
    line += joined ? fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", place.x, y)
                   : fmt::format("M{:.1f} {:.1f}h40", place.x - 20, y);
    points += fmt::format(
        "<g class=\"point level\" tabindex=0 role=button data-row={} aria-label=\"reference row {} at {}: {:.2f} "
        "[{:.2f}, {:.2f}]\"><circle cx={:.1f} cy={:.1f} r=3 /></g>",
        numbers(*row), escaped(display_name(id)), escaped(place.label), *row->success, row->interval.low,
        row->interval.high, place.x, y);
  }
  if (line.empty()) return "";
  return fmt::format("<g class=\"reference {}\"><path class=line d=\"{}\"/>{}</g>", escaped(id), line, points);
}

}  // namespace

std::string named(const std::string& method, std::size_t index) {
  const bool reference = display_rank(method) > display_rank("");
  return fmt::format("<span class=\"name{}\" style=\"--c:{}\">{}</span>", reference ? " reference" : "",
                     reference ? "transparent" : colour(method, index), escaped(display_name(method)));
}

std::string legend(const Table& table, const PaperValues& paper) {
  std::string text = "<ul class=legend>";
  const auto add = [&text](const std::string& picture, const std::string& name) {
    text += fmt::format("<li><svg viewBox=\"0 0 34 16\" aria-hidden=true>{}</svg>{}</li>", picture, name);
  };
  const std::vector<std::string> methods = table.methods(mean_scenario);
  const bool curves = table.demonstrations().size() > 1;
  for (std::size_t i = 0; i < methods.size(); ++i)
    add(fmt::format("<g style=\"--c:{}\">{}{}</g>", colour(methods[i], i),
                    curves ? "<path class=line d=\"M1 8H33\"/>" : "", mark(i, 17, 8, "class=\"point\"")),
        escaped(display_name(methods[i])));
  for (const std::string& id : table.references(mean_scenario))
    add(fmt::format("<g class=\"reference {}\"><path class=line d=\"M1 8H33\"/></g>", escaped(id)),
        escaped(display_name(id)) + " (reference)");
  if (curves && paper.rates.count(mean_scenario) != 0)
    add("<g style=\"--c:currentColor\"><path class=\"line theirs\" d=\"M1 8H33\"/>" +
            mark(0, 17, 8, "class=\"hollow\"") + "</g>",
        "hollow, dashed: the paper’s with its error bars, over its own scenarios");
  for (const Mark& sign : table_marks)
    if (std::any_of(table.rows.begin(), table.rows.end(), [&sign](const Row& row) { return row.marked(sign.word); }))
      text += fmt::format("<li><b>{}</b> {}</li>", sign.sign, sign.meaning);
  return text + "</ul>";
}

std::string chart(const Table& table, const std::string& arm, const std::string& scenario, const PaperValues& paper,
                  const RowNumbers& numbers) {
  const bool joined = table.demonstrations().size() > 1;
  const std::vector<Place> along = places(table, arm);
  const std::string axis =
      joined ? "demonstrations" : ("arm, " + table.demonstrations_text(along.front().demonstrations));
  const std::string title =
      table.title(scenario) + (joined && table.arms.size() > 1 ? fmt::format(", arm {}", arm) : "");
  std::string text = axes(along, axis);
  for (const std::string& id : table.references(scenario)) text += level(table, along, scenario, id, joined, numbers);
  const std::vector<std::string> methods = table.methods(scenario);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    // Methods stand a little apart, so that no whisker hides another.
    const double apart = joined ? 5 : std::min(14.0, 300.0 / static_cast<double>(along.size() * methods.size()));
    const double shift = (static_cast<double>(i) - static_cast<double>(methods.size() - 1) / 2) * apart;
    text += curve(table, along, scenario, methods[i], i, shift, joined, paper, numbers);
  }
  return fmt::format(
      "<figure><figcaption>{}</figcaption><svg class=chart viewBox=\"0 0 {} {}\" role=group aria-label=\"success "
      "against "
      "{}, {}\">{}</svg></figure>",
      escaped(title), width, height, joined ? "demonstrations" : "arms", escaped(title), text);
}

}  // namespace lgabench::report::html_parts
