// What rows lose to exact Bayes, by demonstrations and questions.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include <lgabench/report/sections.hpp>

namespace lgabench::report {

namespace {

// With its interval, or with a word where it is undecided.
document::TableCell rate_of(double value, const std::optional<Interval>& interval, const std::string& place,
                            const std::string& member, std::string (*text)(double)) {
  const std::string low = member + "_interval/low", high = member + "_interval/high";
  if (interval) return with_interval(value, *interval, place, {member.c_str(), low.c_str(), high.c_str()}, text);
  return {Spans{Span::number(text(value), place + member), Span(" undecided")}};
}

}  // namespace

Section regret(const Material& material) {
  Section section{"regret", "What rows lose to exact Bayes"};
  std::vector<const Regret*> all;
  for (const Regret& one : material.summary.regrets) all.push_back(&one);
  if (all.empty()) return section;
  std::stable_sort(all.begin(), all.end(), [](const Regret* a, const Regret* b) {
    return std::tuple(a->layout, a->engine, a->demonstrations, a->questions, -a->success) <
           std::tuple(b->layout, b->engine, b->demonstrations, b->questions, -b->success);
  });
  for (const Regret* one : all) {
    Grid* grid = section.blocks.empty() ? nullptr : std::get_if<Grid>(&section.blocks.back().content);
    const std::string name = fmt::format("regret_{}_{}", slug(one->layout), slug(one->engine));
    if (!grid || grid->name != name) {
      Grid next;
      next.name = name;
      next.caption = fmt::format(
          "Success of {} persons, and what each row loses to Bayes with as many demonstrations and questions; "
          "brackets: "
          "95 % intervals over persons",
          one->persons);
      next.group_head = "demonstrations";
      next.heads = {"questions", "row", "success", "regret", "to Bayes with one Selection"};
      next.align = "lrlrrr";
      section.add(reading, std::move(next));
      grid = &std::get<Grid>(section.blocks.back().content);
    }
    const std::string place = fmt::format("/regret/{}/", one - material.summary.regrets.data());
    Grid::Row row{std::to_string(one->demonstrations),
                  {Span::number(std::to_string(one->questions), place + "questions"), named(material, one->method),
                   rate_of(one->success, one->success_interval, place, "success", rate_text)}};
    for (const auto& [member, loss] : {std::pair("regret", &one->regret), std::pair("to_bayes", &one->to_bayes)})
      row.cells.push_back(*loss ? rate_of((*loss)->difference, (*loss)->interval, place, member, signed_rate)
                                : document::TableCell());
    row.cells[2].rate = one->success;
    grid->rows.push_back(std::move(row));
  }
  section.add(
      reading,
      Paragraph{
          {"person_rule weighs all rules of the grammar by Bayes' rule. With choice=scene it takes in each scene "
           "what all rules together make likeliest. This is the ceiling for rows that know no more of the person, "
           "and regret is to it. Without that option it selects once, by the likeliest rule, as the rows of the "
           "last column do. Fewer than six persons leave an interval undecided."}});
  return section;
}

}  // namespace lgabench::report
