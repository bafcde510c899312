#include <lgabench/study/report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/core/rounding.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/study/pair_report.hpp>

namespace lgabench::study {
namespace {

using namespace document;
using namespace statistics;

constexpr const char* simulated_words = "rehearsal, not people";

std::string name(Condition condition) { return display_name(to_string(condition)); }
constexpr double readable = 1e6;  // beyond it a number of seconds is an error, and not to be printed digit by digit
std::string seconds(double s) { return std::abs(s) < readable ? fixed(s, 1) : fmt::format("{:.3g}", s); }
std::string seconds(const std::optional<double>& s) { return s ? seconds(*s) : "–"; }
std::string p_cell(double p) { return p < .001 ? "< 0.001" : fixed(p, 3); }
std::string p_words(double p) { return (p < .001 ? "p " : "p = ") + p_cell(p); }
std::string signed_seconds(double s) { return std::abs(s) < readable ? signed_text(s, 1) : fmt::format("{:+.3g}", s); }
std::string change_words(const Change& c, const char* unit) {
  return fmt::format("{}{} [{}, {}]", signed_seconds(c.difference), unit, signed_seconds(c.interval.low),
                     signed_seconds(c.interval.high));
}
// An effect on log seconds as a ratio of seconds.
std::string ratio_words(const Change& c) {
  const auto words = [](double log) {
    return log < std::log(readable) ? fixed(std::exp(log)) : fmt::format("{:.3g}", std::exp(log));
  };
  return fmt::format("{} [{}, {}]", words(c.difference), words(c.interval.low), words(c.interval.high));
}
std::string share(const std::optional<double>& value) { return value ? fixed(*value) : "–"; }

// Mean and error bar of the paper's figure 3b, by method's name.
std::map<std::string, std::pair<double, double>> published() {
  const Json all = read_json(data_directory() / "paper" / "reference_results.json").at("figure_3b_user_seconds");
  std::map<std::string, std::pair<double, double>> values;
  for (const auto& [method, value] : all.items())
    values[method] = {value.at("mean").get<double>(), value.at("err").get<double>()};
  return values;
}

// A thin line for each person, from their mean seconds in one condition to those in the other.
std::vector<Series> lines_of_people(const StudyResults& results, double left, double right) {
  std::vector<Series> lines;
  for (const PersonResult& person : results.people) {
    if (!person.excluded.empty()) continue;
    Series line{Series::reference, pseudonym(person.session->slot()), {}, true};
    for (const Condition condition : conditions) {
      const double s = person.mean_s(condition);
      line.points.push_back({condition == Condition::human ? left : right,
                             s,
                             s,
                             s,
                             fmt::format("{}, {}: {} s", line.name, name(condition), seconds(s)),
                             {}});
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

// As the paper's figure 3b: mean seconds a command of each condition, with standard errors; and each person's two
// means.
Chart seconds_chart(const StudyResults& results) {
  Chart chart;
  chart.file = "seconds";
  chart.title = fmt::format("Seconds a command{}",
                            results.record->kind == Kind::rehearsal ? fmt::format(" ({})", simulated_words) : "");
  chart.subtitle =
      fmt::format("{} people's means ± 1 standard error; grey: each person; hollow: the paper", results.used());
  chart.width = 460;
  chart.height = 340;
  chart.legend = false;  // the conditions stand along the axis, and people need no names
  constexpr double left = .3, right = .7;
  chart.series = lines_of_people(results, left, right);
  const MethodStyles styles({"human", "lga_hill"});
  double highest = 0;
  for (const Series& line : chart.series)
    for (const ChartPoint& point : line.points) highest = std::max(highest, point.y);
  chart.alternative = "Mean seconds a command:";
  const auto paper = published();
  for (const Condition condition : conditions) {
    const bool human = condition == Condition::human;
    chart.ticks.push_back({human ? left : right, name(condition)});
    const double outward = human ? -1 : 1, x = (human ? left : right) + .05 * outward;  // beside the lines
    if (const auto& s = results.seconds[index(condition)]) {
      const double error = s->se.value_or(0);
      const std::string words =
          fmt::format("{} {}{}", name(condition), seconds(s->mean), s->se ? " ± " + seconds(s->se) : "");
      chart.series.push_back({Series::measured,
                              name(condition),
                              styles(to_string(condition)),
                              false,
                              {{x, s->mean, s->mean - error, s->mean + error, words, {}}}});
      chart.alternative += " " + words + ";";
      highest = std::max(highest, s->mean + error);
    }
    if (const auto found = paper.find(name(condition)); found != paper.end()) {
      const auto& [mean, error] = found->second;
      chart.series.push_back({Series::published,
                              name(condition),
                              styles(to_string(condition)),
                              false,
                              {{x + .07 * outward,
                                mean,
                                mean - error,
                                mean + error,
                                fmt::format("the paper: {} {} ± {}", name(condition), mean, error),
                                {}}}});
      highest = std::max(highest, mean + error);
    }
  }
  chart.alternative.back() = '.';
  chart.top = 25 * std::ceil(highest * 1.05 / 25);
  return chart;
}

// A table of two rows: of each condition the `values` below the heads.
template <class Values>
Grid by_condition(const std::string& name_of_table, const std::string& caption, const std::vector<std::string>& heads,
                  const Values& values) {
  Grid grid;
  grid.name = name_of_table;
  grid.caption = caption;
  grid.heads = {"condition"};
  grid.heads.insert(grid.heads.end(), heads.begin(), heads.end());
  grid.align = "l" + std::string(heads.size(), 'r');
  for (const Condition condition : conditions) {
    std::vector<TableCell> cells{name(condition)};
    for (const std::string& value : values(condition)) cells.emplace_back(value);
    grid.rows.push_back({{}, std::move(cells)});
  }
  return grid;
}

Section seconds_section(const StudyResults& results) {
  Section section{"seconds", "Seconds a command"};
  const auto paper = published();
  section.add(
      everywhere,
      by_condition("seconds", "Seconds a command: over people, each with the mean of their trials",
                   {"people", "mean", "sd", "se", "mean active", "the paper"}, [&](Condition condition) {
                     const auto &raw = results.seconds[index(condition)], &active = results.active_s[index(condition)];
                     const auto& [mean, error] = paper.at(name(condition));
                     return std::vector{std::to_string(results.used()),       raw ? seconds(raw->mean) : "–",
                                        raw ? seconds(raw->sd) : "–",         raw ? seconds(raw->se) : "–",
                                        active ? seconds(active->mean) : "–", fmt::format("{} ± {}", mean, error)};
                   }));
  List tests;
  if (results.primary)
    tests.items.push_back(
        {fmt::format("Primary: Human − LGA-HILL {}, {} (paired t on people's means, {} people)",
                     change_words(*results.primary, " s"), p_words(results.primary->p), results.used())});
  else
    tests.items.push_back({"Primary: not tested, two people are needed"});
  if (results.active)
    tests.items.push_back(
        {fmt::format("The same on active seconds (without loss of focus, and without pauses over {:g} s): {}, {}",
                     idle_after_s, change_words(*results.active, " s"), p_words(results.active->p))});
  for (const Condition condition : conditions)
    if (const auto& first = results.by_first[index(condition)])
      tests.items.push_back({fmt::format("Who began with {}: {} s{}", name(condition), signed_seconds(first->mean),
                                         first->sd ? fmt::format(" (sd {})", seconds(first->sd)) : "")});
  section.add(everywhere, std::move(tests));
  section.add(reading, Charts{{seconds_chart(results)}});
  return section;
}

Section model_section(const StudyResults& results) {
  Section section{"model", "Crossover"};
  if (results.log_model.empty()) {
    section.add(everywhere, List{{{"Crossover model: not fitted, more people in all of its orders are needed"}}});
    return section;
  }
  Grid grid;
  grid.name = "crossover";
  grid.caption = "Ratios of seconds: linear model on each person's difference of mean log seconds between periods";
  grid.heads = {"effect", "ratio", "p"};
  grid.align = "llr";
  constexpr const char* effects[] = {"condition: Human / LGA-HILL", "period: first / second", "set: first / second"};
  for (std::size_t i = 0; i < 3; ++i)
    grid.rows.push_back({{}, {effects[i], ratio_words(results.log_model[i]), p_cell(results.log_model[i].p)}});
  section.add(everywhere, std::move(grid));
  return section;
}

std::string mean_of(const std::vector<double>& values) {
  return values.empty() ? "–" : fmt::format("{} ({})", seconds(spread(values).mean), values.size());
}

Section commands_section(const StudyResults& results) {
  Section section{"commands", "By command"};
  Grid grid;
  grid.name = "commands";
  grid.caption = fmt::format("Seconds by command (people); p: {}, Holm's over the commands",
                             results.record->protocol->crossover() ? "Welch's t between people" : "paired t");
  grid.heads = {"command", "Human", "LGA-HILL", "difference", "p"};
  grid.align = "lrrrr";
  for (const CommandResult& command : results.commands)
    grid.rows.push_back(
        {{},
         {command.item->asked_as, mean_of(command.seconds[0]), mean_of(command.seconds[1]),
          command.change ? change_words(*command.change, "") : "–", command.change ? p_cell(command.p_holm) : "–"}});
  section.add(everywhere, std::move(grid));
  return section;
}

Section phi_section(const StudyResults& results) {
  Section section{"phi", "φ̂ against the released truth"};
  section.add(everywhere, by_condition("phi", "φ̂ against the released truth, mean over trials",
                                       {"types: precision", "types: recall", "textures: precision", "textures: recall"},
                                       [&](Condition condition) {
                                         const SetQuality& q = results.phi[index(condition)];
                                         return std::vector{share(q.object_types.precision),
                                                            share(q.object_types.recall), share(q.textures.precision),
                                                            share(q.textures.recall)};
                                       }));
  return section;
}

Section left_out_section(const StudyResults& results) {
  Section section{"left_out", "Left out, and checks"};
  List list;
  const auto add = [&list](const std::string& text) { list.items.push_back({text}); };
  add(fmt::format("People: {} consented and stayed, {} withdrew (nothing of them is left), {} planned; {} used",
                  results.people.size(), results.record->withdrawn, results.record->protocol->planned, results.used()));
  if (const std::size_t damaged = results.record->damaged.size(); damaged > 0)
    add(fmt::format("{} {} left out: the file cannot be read", damaged, damaged == 1 ? "person is" : "people are"));
  for (const PersonResult& person : results.people)
    if (!person.excluded.empty())
      add(fmt::format("{} is left out: {}", pseudonym(person.session->slot()), person.excluded));
  add(fmt::format("Trials that do not count: {} interrupted, {} too long, {} for practice", results.interrupted,
                  results.too_long, results.practice));
  add(fmt::format("Trials whose clicks do not add up to what was submitted: {}", results.disagree));
  add(fmt::format("Trials whose duration differs by more than 2 s on the server's clock: {}", results.clocks_apart));
  section.add(everywhere, std::move(list));
  return section;
}

// NASA-TLX about each condition, of the same people.
Grid tlx_grid(const StudyResults& results) {
  Grid grid;
  grid.name = "nasa_tlx";
  grid.caption = "NASA-TLX, raw, 0 to 100, after each condition; p: paired t, Holm's over the rows";
  grid.heads = {"scale", "people", "Human", "LGA-HILL", "difference", "p"};
  grid.align = "lrrrrr";
  for (const ScaleResult& row : results.tlx) {
    if (row.values[0].empty()) continue;
    grid.rows.push_back({{},
                         {row.scale == "raw" ? "mean of the six" : row.scale, std::to_string(row.values[0].size()),
                          seconds(spread(row.values[0]).mean), seconds(spread(row.values[1]).mean),
                          row.change ? change_words(*row.change, "") : "–", row.change ? p_cell(row.p_holm) : "–"}});
  }
  return grid;
}

// Of those who answered: the mean of each scale, and words as they were typed.
Section questionnaire_section(const StudyResults& results) {
  Section section{"questionnaire", results.tlx.empty() ? "Asked at the end" : "What people said", reading};
  std::map<std::string, std::vector<double>> scales;
  List words;
  for (const PersonResult& person : results.people) {
    const Json& answers = person.session->answers();
    if (answers.is_null()) continue;
    for (const auto& [scale, value] : answers.at("tlx").items())
      if (results.tlx.empty() && value.is_number()) scales[scale].push_back(value.get<double>());
    if (const std::string text = answers.at("free_text"); !text.empty())
      words.items.push_back({fmt::format("{}: {}", pseudonym(person.session->slot()), text)});
  }
  if (Grid grid = tlx_grid(results); !grid.rows.empty()) section.add(reading, std::move(grid));
  if (!scales.empty()) {
    Grid grid;
    grid.name = "nasa_tlx";
    grid.caption = "NASA-TLX, raw, 0 to 100";
    grid.heads = {"scale", "people", "mean", "sd"};
    grid.align = "lrrr";
    for (const auto& [scale, values] : scales) {
      const Spread s = spread(values);
      grid.rows.push_back({{}, {scale, std::to_string(values.size()), seconds(s.mean), seconds(s.sd)}});
    }
    section.add(reading, std::move(grid));
  }
  if (!words.items.empty()) section.add(reading, std::move(words));
  return section;
}

// The primary test in a sentence; of a rehearsal it says first that it is none.
std::string headline(const StudyResults& results) {
  const std::string begin = results.record->kind == Kind::rehearsal ? "Rehearsal, not people, so no result: " : "";
  if (results.record->protocol->of_pairs()) return begin + agreement_words(results) + ".";
  if (!results.primary) return begin + "fewer than two people can be compared.";
  return fmt::format(
      "{}{} people took {} s a command from empty lists ({}), {} s with a model's answer filled in ({}): {}, {}.",
      begin, results.used(), seconds(results.seconds[0]->mean), name(Condition::human),
      seconds(results.seconds[1]->mean), name(Condition::lga_hill), change_words(*results.primary, " s"),
      p_words(results.primary->p));
}

Json change_json(const std::optional<Change>& c) {
  if (!c) return nullptr;
  return {{"difference", c->difference}, {"low", c->interval.low}, {"high", c->interval.high}, {"p", c->p}};
}
Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
Json spread_json(const std::optional<Spread>& s) {
  if (!s) return nullptr;
  return {{"mean", s->mean}, {"sd", optional_json(s->sd)}, {"se", optional_json(s->se)}};
}
// Null unless NASA-TLX was asked about each condition; else by scale.
Json tlx_json(const StudyResults& results) {
  if (results.tlx.empty()) return nullptr;
  Json json;
  for (const ScaleResult& row : results.tlx) {
    const auto of = [&row](Condition condition) {
      const std::vector<double>& values = row.values[index(condition)];
      return spread_json(values.empty() ? std::nullopt : std::optional(spread(values)));
    };
    json[row.scale] = {{"people", row.values[0].size()},
                       {"human", of(Condition::human)},
                       {"lga_hill", of(Condition::lga_hill)},
                       {"change", change_json(row.change)},
                       {"p_holm", row.change ? Json(row.p_holm) : Json()}};
  }
  return json;
}
Json quality_json(const SetQuality& q) {
  const auto of = [](const NameQuality& one) {
    return Json{{"precision", optional_json(one.precision)}, {"recall", optional_json(one.recall)}};
  };
  return {{"object_types", of(q.object_types)}, {"textures", of(q.textures)}};
}

}  // namespace

Document document_of(const StudyResults& results) {
  const Record& record = *results.record;
  Document document;
  document.suite = record.protocol->id;
  document.title = fmt::format("Study: {}", record.protocol->title);
  document.headline = {headline(results)};
  const auto note = [&document](const std::string& text) { document.notes.push_back({Note::note, text}); };
  if (record.kind == Kind::rehearsal) note(fmt::format("{}: no number here is a result.", simulated_words));
  if (!record.shown_as_now)
    note("People saw other scenarios or answers than this version of lgabench has; φ̂ is judged by this version's.");
  if (record.protocol->of_pairs()) {
    document.sections = {pairs_section(results), left_out_section(results), questionnaire_section(results)};
    return document;
  }
  note("The paper does not say whether its ± is a standard deviation or a standard error; here both are printed.");
  if (!record.protocol->crossover())
    note(
        "Everybody answers each command twice, so the second answer profits from the first; the order of conditions "
        "balances this only on average.");
  document.sections = {seconds_section(results), commands_section(results), phi_section(results),
                       left_out_section(results), questionnaire_section(results)};
  if (record.protocol->crossover()) document.sections.insert(document.sections.begin() + 1, model_section(results));
  return document;
}

Json to_json(const StudyResults& results) {
  const Record& record = *results.record;
  Json json{{"study", record.protocol->id},
            {"rehearsal", record.kind == Kind::rehearsal},
            {"people", results.people.size()},
            {"used", results.used()},
            {"withdrawn", record.withdrawn},
            {"primary", change_json(results.primary)},
            {"active", change_json(results.active)},
            {"tlx", tlx_json(results)},
            {"trials",
             {{"interrupted", results.interrupted},
              {"too_long", results.too_long},
              {"practice", results.practice},
              {"clicks_disagree", results.disagree},
              {"clocks_apart", results.clocks_apart}}},
            {"conditions", Json::object()},
            {"commands", Json::array()},
            {"crossover", nullptr}};
  for (const Condition condition : conditions)
    json["conditions"][to_string(condition)] = {{"seconds", spread_json(results.seconds[index(condition)])},
                                                {"active_seconds", spread_json(results.active_s[index(condition)])},
                                                {"phi", quality_json(results.phi[index(condition)])}};
  for (const CommandResult& command : results.commands)
    json["commands"].push_back({{"scenario", command.item->scenario},
                                {"change", change_json(command.change)},
                                {"p_holm", command.change ? Json(command.p_holm) : Json()}});
  if (!results.pairs.empty()) json["agreement"] = pairs_json(results);
  if (!results.log_model.empty())
    json["crossover"] = {{"condition", change_json(results.log_model[0])},
                         {"period", change_json(results.log_model[1])},
                         {"set", change_json(results.log_model[2])}};
  return json;
}

std::string trials_csv(const StudyResults& results) {
  constexpr const char* states[] = {"waiting", "started", "shown", "finished", "interrupted"};
  std::string text =
      csv_line({"participant", "excluded", "condition", "period", "set", "practice", "scenario", "asked_as", "state",
                "counts", "raw_seconds", "active_seconds", "server_seconds", "edits", "quality", "answers"});
  for (const PersonResult& person : results.people)
    for (const Trial& trial : person.session->all()) {
      constexpr const char* said[] = {"yes", "no", "can't tell"};
      Json answers;  // by pair
      for (std::size_t i = 0; i < trial.answers.size(); ++i)
        answers[trial.item->pairs[i].object_type + ", " + trial.item->pairs[i].texture] = said[trial.answers[i]];
      Selection selection = trial.selection;
      selection.provenance = Provenance::human;
      const bool done = trial.state == Trial::finished;
      const auto number = [done](double value) {
        return !done ? "" : std::abs(value) < readable ? fmt::format("{:.3f}", value) : fmt::format("{:.9g}", value);
      };
      text += csv_line({pseudonym(person.session->slot()), person.excluded, to_string(trial.condition),
                        std::to_string(trial.period + 1), trial.set < 0 ? "" : std::to_string(trial.set + 1),
                        trial.practice ? "1" : "0", trial.item->scenario, trial.item->asked_as,
                        trial.why.empty() ? states[trial.state] : fmt::format("interrupted: {}", trial.why),
                        counts(*results.record->protocol, trial) ? "1" : "0", number(trial.raw_s),
                        number(trial.active_s), number(trial.server_s), std::to_string(trial.edits),
                        done && trial.item->truth && answers.is_null()
                            ? canonical(to_json(quality(selection, *trial.item->truth)))
                            : "",
                        answers.is_null() ? "" : canonical(answers)});
    }
  return text;
}

Report write_report(const fs::path& directory) {
  const Record record = read_study(directory);
  for (const std::string& line : record.damaged) to_stderr("LEFT OUT: {}\n", one_line(line));
  const StudyResults results = results_of(record);
  Document document = document_of(results);
  write_file(directory / "trials.csv", trials_csv(results));
  write_file(directory / "results.json", to_json(results).dump(1) + "\n");
  write_document(directory, document);
  return {std::move(document), record.damaged.size(), results.used()};
}

}  // namespace lgabench::study
