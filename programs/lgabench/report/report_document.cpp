#include <lgabench/report/report_document.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include <lgabench/report/headline.hpp>
#include <lgabench/report/sections.hpp>
#include <lgabench/statistics/settings.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::report {
namespace {

std::string pictures_note(const Pictures& pictures) {
  if (pictures.wanted == 0) return "";
  if (pictures.scenes.empty()) return fmt::format("No pictures of scenes: {}.", pictures.problem);
  std::string text = fmt::format(
      "Pictures: {} of the {} scenes that methods played (at most {}, each scenario’s first, those with a failure "
      "before others)",
      pictures.scenes.size(), pictures.wanted, most_pictures);
  return text + (pictures.problem.empty() ? "." : fmt::format("; others could not be drawn: {}.", pictures.problem));
}

// Who said which features matter, a line each: what is a measurement of people or of a language model, and what is not.
std::set<std::string> sources(const Summary& summary, const MethodStyles& styles) {
  std::set<std::string> lines;
  for (const PhiOfRow& of : distinct_phi(summary)) {
    const PhiOfCommand& phi = of.row->phi[of.command];
    const std::string words = provenance_words(phi.provenance, phi.erring);
    lines.insert(fmt::format("φ̂ of {}: {}{}.", styles.name(of.row->method), words.empty() ? phi.provenance : words,
                             phi.source.empty() ? "" : ", " + phi.source));
  }
  return lines;
}

std::vector<Note> all_notes(const Material& material) {
  std::vector<Note> all;
  for (const std::string& line : settings(material.run)) all.push_back({Note::setting, line});
  for (const std::string& line : notes(material.run, material.summary)) all.push_back({Note::note, line});
  if (material.about.title == material.run.suite)
    all.push_back({Note::source, "The suite has no title: \"about\" of its file gives it, and its arms, one."});
  for (const statistics::MethodError& error : method_errors(material.run))
    all.push_back({Note::error, error.text, error.log});
  for (const std::string& line : sources(material.summary, material.styles)) all.push_back({Note::source, line});
  if (const std::string line = pictures_note(material.pictures); !line.empty()) all.push_back({Note::source, line});
  return all;
}

Section how_to_read() {
  Section section{"reading", "How to read the numbers"};
  section.add(
      reading,
      List{{{"Success is the mean over scenarios of the mean over training seeds of the share of test episodes that "
             "succeeded."},
            {"Brackets hold a 95 % interval: Wilson's if the number is one policy's in one scenario, else a percentile "
             "interval of 2,000 resamples. Scenarios are not resampled; within each, test scenes and training seeds "
             "(or participants, if there are several) are: crossed if the seeds share their scenes, else scenes within "
             "seeds. Two imagined scenes, one success and one failure, are added. Three seeds on the same 20 scenes "
             "count as 20 scenes. How other scenarios would turn out is not part of it; the claims test that "
             "separately."},
            {"The change against an arm is the difference of a policy's two rates, averaged in the same way; arms are "
             "paired scene by scene. Its interval is found in the same way (for one policy: Bonett and Price's for "
             "paired proportions)."},
            {"A test input counts as seen in training if everything that the policy is given, pictures and text, "
             "occurred there byte for byte: a high share measures what was memorised. – where a policy does not report "
             "it."},
            {"Reference rows are not methods: the best constant action knows only the training actions, the random "
             "visible object is handled by the oracle's rule, the oracle knows the target. The last two learn nothing "
             "and are the same for every number of demonstrations."}}});
  return section;
}

}  // namespace

MethodStyles styles_of(const Summary& summary, const RunResults& run) {
  std::vector<std::string> names;
  for (const Table& table : summary.tables)
    for (const Row& row : table.rows) names.push_back(row.method);
  for (const CellResult& cell : summary.failed) names.push_back(cell.method);
  return MethodStyles(names, told_names(run));
}

TableCell named(const Material& material, const std::string& method, Emphasis emphasis) {
  TableCell cell(Span(material.styles.name(method), emphasis));
  cell.style = material.styles(method);
  return cell;
}

std::string place_of(const Row& row, const std::string& member) {
  return fmt::format("/rows/{}/{}", row.index, member);
}

TableCell with_interval(double value, const Interval& interval, const std::string& place,
                        const std::array<const char*, 3>& members, std::string (*set)(double), Emphasis emphasis) {
  const auto aside = [](const std::string& text, const std::string& where) {
    return Span::number(text, where, Emphasis::detail);
  };
  return Spans{Span::number(set(value), place + members[0], emphasis), aside(" [", ""),
               aside(set(interval.low), place + members[1]),           aside(", ", ""),
               aside(set(interval.high), place + members[2]),          aside("]", "")};
}

Spans marks_spans(const Row& row) {
  Spans spans;
  const auto add = [&spans](const std::string& sign, const std::string& meaning) {
    spans.push_back(Span::number(sign));
    spans.back().title = meaning;
  };
  for (const RowMark& mark : table_marks())
    if (row.marked(mark.word)) add(mark.sign, mark.meaning);
  if (acts_the_same(row)) {
    spans.push_back(Span::number(" "));
    add("=", "the same actions as in " + row.shift->against_title);
  }
  return spans;
}

TableCell count_cell(const Row& row, const std::string& member, int count) {
  return Span::number(std::to_string(count), place_of(row, member));
}

std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  return out;
}

std::string success_title(const Material& material) {
  if (!material.paper.title.empty()) return material.paper.title;
  const std::vector<Table>& tables = material.summary.tables;
  if (tables.empty()) return "Success";
  return tables.front().arms.size() > 1               ? "Success in each arm of the test"
         : tables.front().demonstrations().size() > 1 ? "Success against the number of demonstrations"
                                                      : "Success";
}

Document report_document(const Material& material) {
  const AboutSuite& about = material.about;
  Document document{material.run.suite,
                    about.title + ": " + success_title(material),
                    headline(material, about),
                    all_notes(material),
                    {},
                    about.question,
                    arm_lines(material, about),
                    setting_line(material.run)};
  const auto add = [&document](Section section) {
    if (!section.blocks.empty()) document.sections.push_back(std::move(section));
  };
  add(pairs(material));
  add(steps(material));
  add(regret(material));
  for (Section& section : success(material)) add(std::move(section));
  add(selection_errors(material));
  add(perturbations(material));
  add(claims_section(material.claims, material.styles, claims_title(material.claims), about));
  add(phi(material));
  add(failures(material));
  add(attribution(material));
  add(learning_curves(material));
  add(engines(material));
  add(times(material));
  add(failed_cells(material));
  add(what_was_run(material));
  add(how_to_read());
  add(provenance(material));
  return document;
}

}  // namespace lgabench::report
