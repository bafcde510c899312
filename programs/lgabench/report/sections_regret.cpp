// What rows lose to exact Bayes, by demonstrations and questions.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <variant>

#include <lgabench/report/sections.hpp>

namespace lgabench::report {

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
          "Success of {} persons, and what each row loses to person_rule with as many "
          "demonstrations and questions; brackets: 95 % intervals over persons",
          one->persons);
      next.group_head = "demonstrations";
      next.heads = {"questions", "row", "success", "regret"};
      next.align = "lrlrr";
      section.add(reading, std::move(next));
      grid = &std::get<Grid>(section.blocks.back().content);
    }
    const std::string place = fmt::format("/regret/{}/", one - material.summary.regrets.data());
    Grid::Row row{std::to_string(one->demonstrations),
                  {Span::number(std::to_string(one->questions), place + "questions"), named(material, one->method),
                   with_interval(one->success, one->success_interval, place,
                                 {"success", "success_interval/low", "success_interval/high"}, rate_text),
                   with_interval(one->regret, one->interval, place,
                                 {"regret", "regret_interval/low", "regret_interval/high"}, signed_rate)}};
    row.cells[2].rate = one->success;
    grid->rows.push_back(std::move(row));
  }
  section.add(
      reading,
      Paragraph{{"person_rule weighs all rules of the grammar by Bayes' rule and selects by the likeliest rule. With "
                 "choice=scene it selects in each scene what all rules together make likeliest: this is the "
                 "ceiling for rows that know no more of the person. A row with this option has a regret below 0."}});
  return section;
}

}  // namespace lgabench::report
