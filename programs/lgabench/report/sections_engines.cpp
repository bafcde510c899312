// Does it depend on the engine?
#include <fmt/format.h>

#include <lgabench/report/sections.hpp>

namespace lgabench::report {
namespace {

std::string ending(const std::string& failure) { return failure == "none" ? "success" : failure; }

TableCell rate(int successes, int of) {
  return Span::number(of == 0 ? "–" : fixed(static_cast<double>(successes) / of));
}

Grid agreement_grid(const Material& material, const EngineAgreement& a, const std::string& place) {
  Grid grid;
  grid.name = fmt::format("engines_{}_{}_{}", slug(a.layout), slug(a.first), slug(a.second));
  grid.caption = fmt::format("{} and {}, layout {}: the same verdict on the same action [95 % interval]", a.first,
                             a.second, a.layout);
  grid.heads = {"method", "episodes", "other actions", a.first, a.second, "same verdict"};
  grid.align = "llllll";
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    const AgreementRow& row = a.rows[k];
    const auto number = [&](const char* member, double value, int digits) {
      return Span::number(fixed(value, digits), fmt::format("{}/rows/{}/{}", place, k, member));
    };
    Spans share{Span::number("–")};
    if (row.same.episodes > 0)
      share = {Span::number(fixed(static_cast<double>(row.same.agreed()) / row.same.episodes, 3) + " ["),
               number("low", row.interval.low, 3), Span::number(", "), number("high", row.interval.high, 3),
               Span::number("]")};
    grid.rows.push_back(
        {{},
         {row.method.empty() ? TableCell("all, an action once a scene") : named(material, row.method),
          number("episodes", row.same.episodes, 0), number("other_actions", row.other_actions, 0),
          rate(row.same.won_first, row.same.episodes), rate(row.same.won_second, row.same.episodes), share}});
  }
  return grid;
}

Paragraph not_counted(const EngineAgreement& a, const std::string& place) {
  return {{fmt::format("{} and {}, layout {}: not counted are ", a.first, a.second, a.layout),
           Span::number(fmt::format("{}", a.several_steps), place),
           " episodes of tasks of several steps: no one action decides such an episode."}};
}

std::string place_text(const Disagreement& d) {
  return fmt::format("{}, {}, {} demonstrations, training seed {}, arm {}, scene {}", d.cell->scenario,
                     display_name(d.cell->method), d.cell->demonstrations, d.cell->training_seed, d.arm, d.index);
}

// The scene, and its end on either engine.
PictureRow pictures_of(const Material& material, const EngineAgreement& a, const Disagreement& d) {
  PictureRow row;
  row.caption = place_text(d);
  const auto add = [&](const std::string& engine, const std::string& caption) {
    const auto& ends = material.pictures.ends;
    auto drawn = ends.find(end_key(*d.cell, d.arm, d.index, engine));
    if (drawn != ends.end() && drawn->second == "") drawn = ends.find(end_key(*d.cell, d.arm, d.index, ""));
    if (drawn != ends.end() && drawn->second.is_string()) row.pictures.emplace_back(caption, drawn->second);
  };
  add("", "before");
  add(a.first, fmt::format("{}: {}", a.first, ending(d.episode().failure)));
  add(a.second, fmt::format("{}: {}", a.second, ending(d.failure_second)));
  return row;
}

}  // namespace

Section engines(const Material& material) {
  Section section{"engines", "Does it depend on the engine?"};
  if (material.agreements.empty()) return section;
  section.add(
      reading,
      Paragraph{{"Episodes of one scene that both engines played with the same action, bit for bit: success on "
                 "each, and how often the verdict (success or failure) is the same, with Wilson's 95 % interval. "
                 "Not counted: episodes whose actions differ, since the policy was trained on what the other "
                 "engine showed."}});
  for (std::size_t i = 0; i < material.agreements.size(); ++i) {
    const EngineAgreement& a = material.agreements[i];
    if (a.several_steps > 0)
      section.add(everywhere, not_counted(a, fmt::format("/engine_agreement/{}/several_steps", i)));
    if (a.rows.empty()) continue;
    section.add(everywhere, agreement_grid(material, a, fmt::format("/engine_agreement/{}", i)), "",
                fmt::format("{} and {}, layout {}", a.first, a.second, a.layout));
    if (a.disagreements.empty()) continue;
    Grid where;
    where.name = fmt::format("disagreements_{}_{}_{}", slug(a.layout), slug(a.first), slug(a.second));
    where.caption = "Episodes in which they disagree";
    where.heads = {"where they disagree", a.first, a.second};
    where.align = "lll";
    for (const Disagreement& d : a.disagreements)
      where.rows.push_back({{}, {place_text(d), ending(d.episode().failure), ending(d.failure_second)}});
    section.add(reading, std::move(where), "Each of them");
    for (const Disagreement& d : a.disagreements) section.add(reading, pictures_of(material, a, d));
  }
  return section;
}

}  // namespace lgabench::report
