#include <lgabench/leaderboard/answer_score.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <limits>
#include <map>

#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/answers.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr const char* all = "all";
constexpr const char* counts[] = {"commands", "exact_sets", "scenes", "exact_scenes", "kept", "meant", "right"};

Json to_json(const SceneScore& s) {
  return {
      {"commands", s.commands}, {"exact_sets", s.exact_sets}, {"scenes", s.scenes}, {"exact_scenes", s.exact_scenes},
      {"kept", s.kept},         {"meant", s.meant},           {"right", s.right}};
}

Json scored(const Installed& installed, const std::string& asked, Answerer answerer) {
  const Setting& setting = installed.setting;
  std::map<std::string, SceneScore> by_scenario;
  SelectionCost cost;
  std::vector<std::string> models;
  for (const Setting::Scenario& played : setting.scenarios) {
    const Scenario scenario = suite_scenario(installed.suite, played.id, Truth::released, &installed.design);
    LanguageModel& answers = answerer.of(scenario);
    for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i) {
      if (scenario.commands[static_cast<std::size_t>(i)].ambiguous) continue;  // in no mean
      const Selection selection = select_as_asked(asked, scenario.command(i), scenario.space, answers);
      add_source(selection.source, models);
      cost.lm_queries += selection.cost.lm_queries;
      cost.lm_tokens += selection.cost.lm_tokens;
      by_scenario[played.id] +=
          score(scenario, i, selection, setting.layouts.front(), setting.scene_seed, setting.episodes);
    }
  }
  Json groups = Json::object(), wrong = Json::object();
  const auto sum = [&](const std::string& group, const std::function<bool(const std::string&)>& is_in) {
    SceneScore total;
    for (const auto& [id, one] : by_scenario)
      if (is_in(id)) total += one;
    if (total.commands > 0) groups[group] = to_json(total);
  };
  for (const auto& [group, ids] : installed.suite.groups)
    sum(group, [&ids = ids](const std::string& id) { return contains(ids, id); });
  sum(all, [](const std::string&) { return true; });
  for (const auto& [id, one] : by_scenario)
    if (one.exact_scenes < one.scenes)
      wrong[id] = {{"exact_scenes", one.exact_scenes},
                   {"scenes", one.scenes},
                   {"kept", one.wrongly_kept},
                   {"missed", one.missed}};
  return {{"models", models},         {"asked", asked},   {"questions", cost.lm_queries},
          {"tokens", cost.lm_tokens}, {"groups", groups}, {"wrong", wrong}};
}

}  // namespace

Json score_of_answers(const Installed& installed, const Competitor& row, const AnswerSource& answers,
                      const fs::path& file) {
  if (row.is_reference() || row.id != "lga") return nullptr;
  if (!file.empty() && sha256_file(file) != file.stem())
    throw InputError(file.string() + ": its SHA-256 is not the one in its name");
  return scored(installed, row.options.value("meaning", "flat"), {answers, file});
}

void expect_score(const JsonReader& score, const Setting& setting) {
  constexpr int most = std::numeric_limits<int>::max();
  const auto line = [](const JsonReader& reader) {
    if (const std::string text = reader.string(); text.empty() || text != one_line(text))
      reader.fail("words, in a line");
  };
  const char* const by = score.has("models") ? "models" : "model";  // of before the list: the last one alone
  score.only({by, "asked", "questions", "tokens", "groups", "wrong"});
  if (by == std::string("model"))
    line(score.at(by));
  else if (score.at(by).strings().empty())
    score.at(by).fail("one at least");
  else
    for (const JsonReader& model : score.at(by).elements()) line(model);
  if (const std::string asked = score.at("asked").string();
      asked != "flat" && asked != "structured" && asked != "named")
    score.at("asked").fail("flat, structured or named");
  for (const char* price : {"questions", "tokens"}) score.at(price).integer(0, most);
  score.at("groups").at(all);
  for (const auto& [name, ignored] : score.at("groups").json().items()) {
    const JsonReader group = score.at("groups").at(name);
    group.only({std::begin(counts), std::end(counts)});
    for (const char* count : counts) group.at(count).integer(0, most);
    for (const auto& [part, of] : {std::pair("exact_sets", "commands"), {"exact_scenes", "scenes"}, {"right", "kept"}})
      group.at(part).integer(0, group.at(of).integer(0, most));
    group.at("scenes").integer(1, most);
  }
  std::vector<std::string> scenarios;
  for (const Setting::Scenario& one : setting.scenarios) scenarios.push_back(one.id);
  score.at("wrong").only(scenarios);
  for (const auto& [id, ignored] : score.at("wrong").json().items()) {
    const JsonReader one = score.at("wrong").at(id);
    one.only({"exact_scenes", "scenes", "kept", "missed"});
    one.at("exact_scenes").integer(0, one.at("scenes").integer(1, most) - 1);
    for (const char* list : {"kept", "missed"})
      for (const JsonReader& name : one.at(list).elements()) line(name);
  }
}

std::string models_of(const Json& score) {
  if (score.contains("model")) return score.at("model");
  return fmt::format("{}", fmt::join(score.at("models").get<std::vector<std::string>>(), " and "));
}

Json as_before_the_list(Json score) {
  score["model"] = score.at("models").back();
  score.erase("models");
  return score;
}

double scenes_exact(const Json& score) {
  const Json& sum = score.at("groups").at(all);
  return sum.at("exact_scenes").get<double>() / sum.at("scenes").get<double>();
}

}  // namespace lgabench::leaderboard
