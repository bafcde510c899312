#include <fmt/format.h>

#include <lgabench/report/engines.hpp>
#include <lgabench/report/html_parts.hpp>
#include <lgabench/report/names.hpp>
#include <lgabench/report/tables.hpp>

namespace lgabench::report {
namespace {

std::string name_of(const AgreementRow& row) {
  return row.method.empty() ? "all, an action once a scene" : display_name(row.method);
}

std::string rate(int won, int of) { return of == 0 ? "–" : fmt::format("{:.2f}", static_cast<double>(won) / of); }

std::string share_text(const AgreementRow& row) {
  if (row.episodes == 0) return "–";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", static_cast<double>(row.agreed) / row.episodes, row.interval.low,
                     row.interval.high);
}

std::string failure_text(const std::string& failure) { return failure == "none" ? "won" : failure; }

std::string place_text(const Disagreement& d) {
  return fmt::format("{}, {}, {} demonstrations, training seed {}, arm {}, scene {}", d.cell->scenario,
                     display_name(d.cell->method), d.cell->demonstrations, d.cell->training_seed, d.arm, d.index);
}

std::string title_text(const EngineAgreement& a) {
  return fmt::format("{} and {}, layout {}", a.first, a.second, a.layout);
}

constexpr const char* explanation =
    "Episodes of one scene that both engines played with the same action, bit for bit: success on each, and how often "
    "the verdict (won or lost) is the same, with Wilson's 95 % interval. Not counted: episodes whose actions differ, "
    "since the policy was trained on what the other engine showed.";

}  // namespace

std::string agreement_text(const std::vector<EngineAgreement>& agreements) {
  std::string text;
  for (const EngineAgreement& a : agreements) {
    text += fmt::format("{}: the same verdict on the same action [95 % interval]\n\n", title_text(a));
    text += fmt::format("  {:<28} {:>9} {:>9} {:>9}  same verdict\n", "", "episodes", a.first, a.second);
    for (const AgreementRow& row : a.rows)
      text += fmt::format("  {:<28} {:>9} {:>9} {:>9}  {}\n", name_of(row), row.episodes,
                          rate(row.won_first, row.episodes), rate(row.won_second, row.episodes), share_text(row));
    text += '\n';
  }
  return text;
}

std::string agreement_markdown(const std::vector<EngineAgreement>& agreements) {
  if (agreements.empty()) return "";
  std::string text = fmt::format("\n## Does it depend on the engine?\n\n{}\n", explanation);
  for (const EngineAgreement& a : agreements) {
    text += fmt::format(
        "\n{}\n\n| method | episodes | other actions | {} | {} | same verdict |\n| --- | --- | --- | --- | --- | --- "
        "|\n",
        plain(title_text(a)), plain(a.first), plain(a.second));
    for (const AgreementRow& row : a.rows)
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", plain(name_of(row)), row.episodes, row.other_actions,
                          rate(row.won_first, row.episodes), rate(row.won_second, row.episodes), share_text(row));
    if (a.disagreements.empty()) continue;
    text += fmt::format("\n| where they disagree | {} | {} |\n| --- | --- | --- |\n", plain(a.first), plain(a.second));
    for (const Disagreement& d : a.disagreements)
      text += fmt::format("| {} | {} | {} |\n", plain(place_text(d)), failure_text(d.episode().failure),
                          failure_text(d.failure_second));
  }
  return text;
}

namespace html_parts {

std::string engines(const std::vector<EngineAgreement>& agreements, const Pictures& pictures) {
  if (agreements.empty()) return "";
  std::string body = fmt::format("<p>{}</p>", explanation);
  for (std::size_t i = 0; i < agreements.size(); ++i) {
    const EngineAgreement& a = agreements[i];
    std::string rows;
    for (std::size_t k = 0; k < a.rows.size(); ++k) {
      const AgreementRow& row = a.rows[k];
      const auto value = [&](const char* member, int number) {
        return fmt::format("<span data-value=\"/engine_agreement/{}/rows/{}/{}\">{}</span>", i, k, member, number);
      };
      rows += row_of({row.method.empty() ? escaped(name_of(row)) : named(row.method), value("episodes", row.episodes),
                      value("other_actions", row.other_actions), rate(row.won_first, row.episodes),
                      rate(row.won_second, row.episodes), share_text(row)});
    }
    body += table(escaped(title_text(a)),
                  {"method", "episodes", "other actions", escaped(a.first), escaped(a.second), "same verdict"}, rows);
    for (const Disagreement& d : a.disagreements) {
      const std::string where = escaped(place_text(d));
      const auto picture = [&](const std::string& key, const std::string& caption) {
        const auto drawn = pictures.ends.find(key);
        return drawn == pictures.ends.end()
                   ? std::string()
                   : fmt::format(
                         "<div><img width=256 height=128 alt=\"{}: {}\" src=\"data:image/png;base64,{}\">"
                         "<br><small>{}</small></div>",
                         where, caption, drawn->second, caption);
      };
      body += fmt::format(
          "<figure class=engines><div class=pair>{}{}{}</div><figcaption>{}</figcaption></figure>",
          picture(end_key(d, ""), "before"),
          picture(end_key(d, a.first), fmt::format("{}: {}", escaped(a.first), failure_text(d.episode().failure))),
          picture(end_key(d, a.second), fmt::format("{}: {}", escaped(a.second), failure_text(d.failure_second))),
          where);
    }
  }
  return section("engines", "Does it depend on the engine?", body);
}

}  // namespace html_parts

}  // namespace lgabench::report
