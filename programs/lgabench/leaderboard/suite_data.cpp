// What a click on a number of a suite's page shows.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/base64.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/leaderboard/suite_page.hpp>
#include <lgabench/leaderboard/titles.hpp>
#include <lgabench/record/outcome.hpp>
#include <lgabench/statistics/names.hpp>

namespace lgabench::leaderboard {
namespace {

// Successes of all cells, in the order of places, arms and episodes, eight to a byte, the first in its highest bit.
std::string success_bits(const Entry& entry) {
  std::string bytes;
  std::size_t bit = 0;
  for (const PlayedCell& cell : entry.cells)
    for (const std::string& arm : entry.setting.scenario(cell.place.scenario).arms)
      for (const char letter : cell.outcomes.at(arm)) {
        if (bit % 8 == 0) bytes.push_back('\0');
        if (is_success(letter)) bytes.back() = static_cast<char>(bytes.back() | (0x80 >> bit % 8));
        ++bit;
      }
  return base64(bytes);
}

std::string command_of(const Entry& entry, const Track& track) {
  const Identity& identity = entry.identity;
  std::vector<std::string> words{"lgabench",           "run",       entry.setting.suite, "--preset",
                                 entry.setting.preset, "--engines", identity.engine};
  if (!identity.row.is_reference()) words.insert(words.end(), {"--methods", entry.spec(), "--no-reference"});
  if (!identity.row.is_reference())
    for (const std::string& word : identity.conditions.arguments(track)) words.push_back(word);
  const std::string kept = answers_file(identity).string();
  words.insert(words.end(), {"--answers", kept.empty() ? to_string(identity.answers)
                                          : std::holds_alternative<FileAnswers>(identity.answers)
                                              ? kept
                                              : to_string(CassetteAnswers{kept})});
  return shell_line(words);
}

// A span for the page's script.
Json link_of(const document::Span& span) {
  return {{"text", span.title.empty() ? span.text : span.title}, {"url", span.url}};
}

// Its two episodes as pictures, the worst first; none where nobody has drawn them.
Json scenes_of(const Entry& entry, const BoardScenes& scenes) {
  Json all = Json::array();
  const auto found = scenes.find(entry.id());
  if (found == scenes.end()) return all;
  for (const char* which : {"worst", "best"}) {
    const auto scene = found->second.find(which);
    if (scene == found->second.end()) continue;
    const PlayedCell& cell = *std::find_if(entry.cells.begin(), entry.cells.end(),
                                           [&](const PlayedCell& one) { return one.key == scene->second.cell; });
    const char letter = cell.outcomes.at(scene->second.arm).at(static_cast<std::size_t>(scene->second.index));
    const std::optional<Outcome> outcome = read_entry_letter(letter, entry.failures);
    all.push_back({{"picture", scene_picture(entry.id(), which).string()},
                   {"which", which},
                   {"scenario", cell.place.scenario},
                   {"arm", scene->second.arm},
                   {"n", cell.place.demonstrations},
                   {"seed", cell.place.seed},
                   {"index", scene->second.index},
                   {"command", scene->second.command},
                   {"outcome", !outcome || outcome->failure == failure::none ? "success" : outcome->failure}});
  }
  return all;
}

// The entries whose place it took, the newest first.
Json superseded_by(const Entry& entry) {
  Json all = Json::array();
  for (std::size_t i = entry.supersedes.size(); i-- > 0;) {
    const Json& one = entry.supersedes[i];
    all.push_back({{"when", one.at("when")},
                   {"reason", one.at("reason")},
                   {"place", superseded_place(entry.id(), one.at("hash")).string()}});
  }
  return all;
}

}  // namespace

Json suite_data(const std::vector<NamedTable>& tables, const BoardScenes& scenes) {
  Json settings = Json::array(), entries = Json::array(), tabs = Json::array();
  for (const NamedTable& table : tables) {
    Json setting = to_json(table.setting);
    const Titles titles(table.setting.suite);
    for (Json& scenario : setting["scenarios"]) {
      scenario["title"] = titles.scenario(scenario.at("id"));
      for (const Json& arm : scenario.at("arms")) setting["titles"][arm.get<std::string>()] = titles.arm(arm);
    }
    settings.push_back(std::move(setting));
    tabs.push_back({{"title", section_title(table, tables)},
                    {"sections", Json::array({fmt::format("table{}", tabs.size() + 1)})}});
    for (const NamedStanding& s : table.standings) {
      const Entry& entry = *s.entry;
      Json failed = Json::array(), evidence = Json::array();
      for (std::size_t c = 0; c < entry.cells.size(); ++c)
        if (!entry.cells[c].failed.empty()) failed.push_back({c, entry.cells[c].failed});
      entries.push_back({{"table", settings.size() - 1},
                         {"name", s.full_name()},
                         {"row", statistics::display_name(s.name)},
                         {"id", entry.id()},
                         {"place", entry.place().string()},
                         {"learns", learns(entry.identity.row)},
                         {"version", entry.identity.row.version},
                         {"answers", to_string(entry.identity.answers)},
                         {"kept_answers", answers_file(entry.identity).string()},
                         {"command", command_of(entry, table.track)},
                         {"authors", entry.about.at("authors")},
                         {"license", entry.about.at("license")},
                         {"source", link_of(source_span(entry))},
                         {"computed", computed_on(entry)},
                         {"replayed", replayed_on(entry)},
                         {"scenes", scenes_of(entry, scenes)},
                         {"program", entry.evidence.front().at("program")},
                         {"processor", to_string(entry.processor())},
                         {"tier", to_string(entry.tier())},
                         {"failed", failed},
                         {"successes", success_bits(entry)}});
      if (!entry.supersedes.empty()) entries.back()["supersedes"] = superseded_by(entry);
    }
  }
  return {{"settings", settings}, {"entries", entries}, {"tabs", tabs}};
}

}  // namespace lgabench::leaderboard
