#include <fmt/format.h>

#include <lgabench/report/claims.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/pairs.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

// "LGA − GCBC-DART"
std::string rows_text(const ClaimedDifference& d) {
  return fmt::format("{} − {}", display_name(d.above), display_name(d.below));
}

std::string sample_text(const ClaimedDifference& d) {
  return fmt::format("{} {}, {} {}", d.policies, d.policies == 1 ? "policy" : "policies", d.scenarios,
                     d.scenarios == 1 ? "scenario" : "scenarios");
}

std::string with_reason(Verdict verdict, const std::string& reason) {
  return reason.empty() ? to_string(verdict) : fmt::format("{}: {}", to_string(verdict), reason);
}

}  // namespace

Json to_json(const std::string& suite, const std::vector<Claim>& claims) {
  Json all = Json::array();
  for (const Claim& claim : claims) {
    Json differences = Json::array();
    for (const ClaimedDifference& d : claim.differences) {
      const auto number = [&d](double value) { return d.change ? Json(value) : Json(nullptr); };
      const Change change = d.change.value_or(Change());
      differences.push_back({{"above", d.above},
                             {"below", d.below},
                             {"arm", d.arm},
                             {"demonstrations", d.demonstrations},
                             {"verdict", to_string(d.verdict)},
                             {"reason", d.reason},
                             {"difference", number(change.difference)},
                             {"low", number(change.interval.low)},
                             {"high", number(change.interval.high)},
                             {"p", number(change.p)},
                             {"p_holm", number(d.p_holm)},
                             {"scenarios", d.scenarios},
                             {"policies", d.policies}});
    }
    all.push_back({{"claim", claim.id},
                   {"statement", claim.statement},
                   {"layout", claim.layout},
                   {"engine", claim.engine},
                   {"verdict", to_string(claim.verdict)},
                   {"reason", claim.reason},
                   {"differences", differences}});
  }
  return {{"suite", suite}, {"claims", all}};
}

std::string claims_text(const std::string& suite, const std::vector<Claim>& claims) {
  std::string text, field;
  for (const Claim& claim : claims) {
    const std::string here =
        fmt::format("{}, layout {}, engine {}: the paper's claims\n\n", suite, claim.layout, claim.engine);
    if (here != field) text += (text.empty() ? "" : "\n") + here;
    field = here;
    text += fmt::format("{}  {}\n      {}\n", claim.id, claim.statement, with_reason(claim.verdict, claim.reason));
    for (const ClaimedDifference& d : claim.differences) {
      text +=
          fmt::format("      {:<10}  n={:<4} {:<10} {}", to_string(d.verdict), d.demonstrations, d.arm, rows_text(d));
      text += d.change ? fmt::format("  {}  {} (Holm)  {}\n", change_text(*d.change), p_text(d.p_holm), sample_text(d))
                       : fmt::format("  {}\n", d.reason);
    }
  }
  return text;
}

std::string claims_markdown(const std::vector<Claim>& claims) {
  std::string text =
      "\n## The paper's claims\n\n"
      "| claim | | layout | engine | verdict |\n| --- | --- | --- | --- | --- |\n";
  std::string details;
  for (const Claim& claim : claims) {
    text += fmt::format("| {} | {} | {} | {} | **{}**{} |\n", claim.id, claim.statement, plain(claim.layout),
                        plain(claim.engine), to_string(claim.verdict),
                        claim.reason.empty() ? "" : ": " + plain(claim.reason));
    for (const ClaimedDifference& d : claim.differences)
      if (d.change)
        details += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", claim.id, plain(claim.layout),
                               plain(claim.engine), plain(d.arm), d.demonstrations, plain(rows_text(d)),
                               change_text(*d.change), p_text(d.p_holm), sample_text(d), to_string(d.verdict));
  }
  if (details.empty()) return text;
  return text +
         "\nEach difference, on the mean over scenarios, paired by training seed and scene; p is Holm's over the rows "
         "compared in one arm at one number of demonstrations.\n\n"
         "| claim | layout | engine | arm | demonstrations | difference | | | from | verdict |\n"
         "| --- | --- | --- | --- | ---: | --- | --- | --- | --- | --- |\n" +
         details;
}

}  // namespace lgabench::report
