#include <lgabench/study/pair_report.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>

namespace lgabench::study {
namespace {

using namespace document;
using namespace statistics;

// "yes" or "no" where people settle the pair.
std::string settled_as(const PairResult& pair) {
  return !pair.settled() ? "" : pair.said[0] > pair.said[1] ? "yes" : "no";
}

Interval interval_of(const PairResult& pair) {
  return pair.people() > 0 ? wilson(pair.said[0], pair.people()) : Interval();
}

}  // namespace

std::string agreement_words(const StudyResults& results) {
  std::array<int, 2> settled{};
  int disputed = 0;
  for (const PairResult& pair : results.pairs) {
    disputed += !pair.pair->settled;
    if (pair.settled()) ++settled[settled_as(pair) == "yes" ? 0 : 1];
  }
  return fmt::format(
      "{} people settle {} of {} disputed pairs ({} meant, {} not; exact binomial against one half, Holm over the "
      "pairs); Krippendorff's alpha of yes, no and can't tell: {}",
      results.used(), settled[0] + settled[1], disputed, settled[0], settled[1],
      results.agreement ? fixed(*results.agreement) : "–");
}

Section pairs_section(const StudyResults& results) {
  Section section{"pairs", "Pairs"};
  section.add(everywhere, List{{{agreement_words(results)}}});
  Grid grid;
  grid.name = "pairs";
  grid.caption =
      "Could the command mean the object? Share yes with Wilson's 95 % interval; p: Holm's over the disputed pairs";
  grid.heads = {"command", "object", "yes", "no", "can't tell", "share yes", "p", "settled"};
  grid.align = "llrrrrrl";
  for (const PairResult& pair : results.pairs) {
    const std::optional<bool> truth = pair.pair->settled;
    const Interval interval = interval_of(pair);
    const double share = pair.said[0] / std::max(1., static_cast<double>(pair.people()));
    std::vector<TableCell> cells{pair.item->asked_as, pair.pair->object_type + ", " + pair.pair->texture};
    for (const int said : pair.said) cells.emplace_back(std::to_string(said));
    cells.emplace_back(fmt::format("{} [{}, {}]", fixed(share), fixed(interval.low), fixed(interval.high)));
    cells.emplace_back(truth ? "–" : fixed(pair.p_holm, 3));
    cells.emplace_back(!truth ? settled_as(pair) : *truth ? "control: yes" : "control: no");
    grid.rows.push_back({{}, std::move(cells)});
  }
  section.add(everywhere, std::move(grid));
  List failed;
  for (const PersonResult& person : results.people)
    if (const int n = controls_failed(*results.record->protocol, *person.session); n > 0)
      failed.items.push_back({fmt::format("{}: {} controls failed", pseudonym(person.session->slot()), n)});
  if (!failed.items.empty()) section.add(everywhere, std::move(failed));
  return section;
}

Json pairs_json(const StudyResults& results) {
  Json json{{"alpha", results.agreement ? Json(*results.agreement) : Json()}, {"pairs", Json::array()}};
  for (const PairResult& pair : results.pairs) {
    const Interval interval = interval_of(pair);
    Json one{{"command", pair.item->asked_as},
             {"object_type", pair.pair->object_type},
             {"texture", pair.pair->texture},
             {"yes", pair.said[0]},
             {"no", pair.said[1]},
             {"cannot_tell", pair.said[2]},
             {"low", interval.low},
             {"high", interval.high}};
    if (const std::optional<bool> truth = pair.pair->settled)
      one["control"] = *truth;
    else
      one.update({{"p_holm", pair.p_holm}, {"settled", pair.settled() ? Json(settled_as(pair) == "yes") : Json()}});
    json["pairs"].push_back(std::move(one));
  }
  return json;
}

}  // namespace lgabench::study
