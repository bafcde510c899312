#include <lgabench/leaderboard/admission.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/verification.hpp>

namespace lgabench::leaderboard {
namespace {

// In the abstraction track: truths are public, so that nothing but a method on given answers can be ranked.
std::string why_not_in_track(const Entry& entry, const Track& track) {
  if (track.persons) return "";
  if (track.answers.empty()) return "no ranks: the truths are public";
  std::set<std::string> asked = provenances_of(entry);
  asked.erase("none");
  if (asked.empty() || to_string(entry.identity.answers) == track.answers) return "";
  return "other answers than the frozen ones";
}

}  // namespace

bool is_in(const Entry& entry, Ranking ranking) {
  return ranking != Ranking::papers_network || entry.identity.row.is_reference() || policy_of(entry) == "regression";
}

std::string why_not_ranked(const Entry& entry, const Track& track) {
  if (entry.identity.row.is_reference()) return "reference";
  if (entry.identity.row.asks == "truth" || entry.identity.row.asks == "network")
    return "asks for the " + entry.identity.row.asks;
  if (entry.fresh() < 0) return "differs on fresh scenes";
  if (entry.fresh_commands() < 0) return "differs on fresh commands";
  if (!entry.was_replayed()) return "not yet replayed";
  if (entry.replay_differed()) return "a replay differed";
  const std::set<std::string> provenances = provenances_of(entry);
  if (provenances.count("truth") > 0 || (!track.persons && provenances.count("simulated_edit") > 0))
    return "the truth stands in for people";
  if (entry.has_answers_as_submitted()) return as_submitted;
  if (track.persons && entry.fresh() == 0) return "not yet played with other persons";
  const std::string of_track = track.kind == Track::abstraction ? why_not_in_track(entry, track) : "";
  return of_track.empty() ? entry.identity.conditions.why_not_ranked(track) : of_track;
}

std::vector<std::string> marks_of(const Entry& entry, bool is_ranked) {
  std::vector<std::string> marks;
  if (entry.has_answers_as_submitted()) marks.emplace_back(as_submitted);
  const std::string confined = entry.evidence.front().at("confinement");
  if (confined.rfind("Landlock ", 0) != 0 || confined.find("no ") != std::string::npos)
    marks.emplace_back("unconfined");
  else if (confined.find("without") != std::string::npos)
    marks.emplace_back("partly confined");
  const auto failed = std::count_if(entry.cells.begin(), entry.cells.end(),
                                    [](const PlayedCell& cell) { return !cell.failed.empty(); });
  if (failed > 0) marks.push_back(fmt::format("{} cells failed", failed));
  if (entry.fresh() > 0) marks.emplace_back("fresh");
  if (entry.fresh_commands() > 0) marks.emplace_back("fresh commands");
  if (is_ranked && entry.fresh() == 0) marks.emplace_back(never_fresh);
  if (is_ranked && entry.identity.row.acts && entry.fresh_commands() == 0) {
    const std::string why = why_exempt(entry);
    marks.push_back(why.empty() ? never_fresh_commands : "no fresh commands: " + why);
  }
  for (std::string& claim : claims(entry)) marks.push_back(std::move(claim));
  return marks;
}

std::vector<std::pair<std::string, std::string>> meanings_of_marks() {
  return {{"fresh commands",
           "its method was as exact for commands of the lexicon that nobody knew when it was submitted as it is here, "
           "or as LGA is on the same answers."},
          {"no fresh commands",
           "no command tests whether the method has the published ones’ truths by heart: it selects nothing, selects "
           "from demonstrations, or asks people."},
          {never_fresh_commands, "its Selections for commands that nobody knew were not looked at."},
          {never_fresh, "its success on scenes that nobody knew was not looked at."},
          {as_submitted,
           "that file is used as it came. Nobody can ask whoever gave the answers again, and the truth of shipped "
           "commands is public, so the file may be a copy of it: the row has no rank."},
          {"the truth stands in for people",
           "the row needs people’s answers, and was given the true features: an upper "
           "bound, without a rank."}};
}

std::set<std::string> provenances_of(const Entry& entry) {
  std::set<std::string> all;
  for (const auto& scenario : entry.phi.items())
    for (const Json& list : scenario.value())
      for (const Json& command : list) all.insert(command.at("selection").at("provenance").get<std::string>());
  return all;
}

std::string policy_of(const Entry& entry) {
  const Competitor& row = entry.identity.row;
  const Json policy = (row.acts ? row.acts->options : row.options).value("policy", Json());
  return policy.is_string() ? policy.get<std::string>() : "";
}

}  // namespace lgabench::leaderboard
