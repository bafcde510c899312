#include <lgabench/leaderboard/fresh_commands.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <map>
#include <set>

#include <lgabench/abstraction/scene_score.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/drawn/draw.hpp>
#include <lgabench/leaderboard/admission.hpp>
#include <lgabench/statistics/results.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr const char *scenario_id = "fresh_commands", *layout = "continuous", *engine = "kinematic";
constexpr double enough_of_lga = .95, alpha = .05;

// Of at most `few` successes among `of`, where all together have this many more among `others`.
double p_of_so_few(int few, int of, int successes, int others) {
  const auto count = [](int number) { return static_cast<unsigned>(number); };
  const boost::math::hypergeometric all(count(few + successes), count(of), count(of + others));
  return boost::math::cdf(all, count(few));
}

struct Counts {
  int commands = 0, exact = 0, lga_exact = 0, published = 0, published_exact = 0;

  bool known() const {
    return exact >= enough_of_lga * lga_exact || p_of_so_few(exact, commands, published_exact, published) > alpha;
  }
};

// So many that none exact is no chance, where any published one is exact.
int enough_commands(const Counts& counts) {
  int enough = fewest_commands;
  while (counts.published_exact > 0 && p_of_so_few(0, enough, counts.published_exact, counts.published) > alpha)
    ++enough;
  return enough;
}

Counts counts_of(const Json& line) {
  return {line.at("commands"), line.at("exact"), line.at("lga_exact"), line.at("published"),
          line.at("published_exact")};
}

// No pair of type and texture is wrong but those that the scenario leaves open.
bool is_exact(const Scenario& scenario, int command, const Json& selection) {
  const Json distribution = distribution_of(selection);
  const Selection selected = read_distribution(JsonReader(distribution, "selection"), scenario.space, scenario.second);
  return score(scenario, command, selected, layout, 0, 0).exact_sets > 0;
}

// The Selections of the published commands, as the entry has them.
void count_published(const Entry& entry, const Installed& installed, Counts& counts) {
  for (const Setting::Scenario& played : installed.setting.scenarios) {
    const Scenario scenario = suite_scenario(installed.suite, played.id, Truth::released, &installed.design);
    const Json lists = entry.phi.value(played.id, Json::array());
    if (lists.empty()) continue;                  // each of its cells failed
    std::map<std::string, const Json*> selected;  // of some commands alone where an arm's words differ
    for (const Json& command : lists.front()) selected[command.at("utterance")] = &command.at("selection");
    for (int i = 0; i < static_cast<int>(scenario.commands.size()); ++i) {
      const ScenarioCommand& command = scenario.commands[static_cast<std::size_t>(i)];
      const auto found = selected.find(command.utterance);
      if (found == selected.end() || command.ambiguous || found->second->at("provenance") == "none") continue;
      ++counts.published;
      counts.published_exact += is_exact(scenario, i, *found->second);
    }
  }
}

struct Drawn {
  std::vector<Scenario> each;  // of one command
  Json all, answers;           // a scenario of all commands, and the file of their answers
};

Drawn draw(const std::string& nonce, int count) {
  std::set<std::string> published;
  for (const std::string& id : scenario_ids())
    for (const ScenarioCommand& command : load_scenario(id).commands) published.insert(command.utterance);
  const drawn::Lexicon lexicon = drawn::load_lexicon({});
  drawn::DrawRequest request;
  request.seed = std::stoull(sha256(nonce + "commands").substr(0, 15), nullptr, 16);
  request.commands = count;
  const auto fits = [&](const drawn::DrawnCommand& command) {
    return command.meaning.is_product() && published.count(command.utterance) == 0 &&
           drawn::can_be_shown(drawn::scenario_of(command, lexicon.space));
  };
  Drawn drawn{{}, {}, {{"model", "the truth"}, {"space", lexicon.space.id}, {"answers", Json::array()}}};
  for (const drawn::DrawnCommand& command : drawn::draw_commands(lexicon, request, fits)) {
    const Json scenario = drawn::scenario_of(command, lexicon.space);
    const Json& said = scenario.at("commands").at(0);
    if (drawn.each.empty()) {
      drawn.all = scenario;
      for (const char* of_one : {"undecided", "near_miss_sets", "note"}) drawn.all.erase(of_one);
      drawn.all.update({{"id", scenario_id}, {"commands", Json::array()}, {"tests", {{{"arm", "test"}}}}});
    }
    drawn.all["commands"].push_back(said);
    const Json& target = said.at("truth").at("target");
    drawn.answers["answers"].push_back({{"command", command.utterance}, {"target", target}, {"structured", target}});
    drawn.each.push_back(read_scenario(scenario, command.id));
  }
  return drawn;
}

// Nothing is demonstrated, and one scene is played: what counts is what was selected.
Cell cell_of(const Drawn& drawn, const Competitor& row, const AnswerSource& answers, const Catalogue& catalogue) {
  const Scenario scenario = read_scenario(drawn.all, scenario_id);
  Cell cell;
  cell.suite = scenario_id;
  cell.environment = scenario.environment->id();
  cell.scenario = std::make_shared<const Json>(scenario.json);
  cell.layout = layout;
  cell.engine = catalogue.find("engine", engine).id;
  cell.method = row;
  const PluginInfo& lga = catalogue.find("method", "lga");
  cell.method.acts = ActingMethod{lga.id, lga.version, resolve_options(lga, {{"policy", "point"}})};
  cell.method.name = cell.method.own_name();
  cell.episodes = 1;
  cell.answers = answers;
  cell.data = data_hashes(scenario, answers, cell.reading);
  return cell;
}

int exact_in(const fs::path& directory, const Drawn& drawn) {
  const statistics::CellResult cell = statistics::read_cell(directory);
  if (cell.failed && cell.fault != "plugin")
    throw InputError(fmt::format("the cell of drawn commands was failed by the {}: {}", cell.fault, cell.reason));
  int exact = 0;
  for (std::size_t i = 0; i < cell.commands.size() && !cell.failed; ++i)
    exact += is_exact(drawn.each[i], 0, cell.commands[i].selection);
  return exact;
}

}  // namespace

std::string why_exempt(const Entry& entry) {
  if (entry.identity.row.is_reference()) return "is a reference";
  std::set<std::string> from = provenances_of(entry);
  from.erase("none");
  if (from.empty()) return "selects nothing";
  for (const char* people : {"truth", "simulated_edit", "human"})
    if (from.count(people) > 0) return "asks people";
  const auto several = [](const Json& lists) { return lists.size() > 1; };
  return std::any_of(entry.phi.begin(), entry.phi.end(), several) ? "selects from demonstrations" : "";
}

bool knows_fresh_commands(const std::vector<const Json*>& lines) {
  Counts all;
  for (const Json* line : lines) {
    const Counts one = counts_of(*line);
    all = {all.commands + one.commands, all.exact + one.exact, all.lga_exact + one.lga_exact, one.published,
           one.published_exact};
  }
  return all.known();
}

void expect_fresh_commands(const JsonReader& line) {
  const long long commands = line.at("commands").integer(fewest_commands, most_commands),
                  published = line.at("published").integer(0, most_published);
  line.at("exact").integer(0, commands);
  line.at("lga_exact").integer(0, commands);
  line.at("published_exact").integer(0, published);
  const bool known = counts_of(line.json()).known();
  if (line.at("passed").boolean() != known)
    line.at("passed").fail(known ? "true, by its counts" : "false, by its counts");
}

std::string fresh_commands_words(const Json& line) {
  const Counts counts = counts_of(line);
  return fmt::format("{} of {} drawn commands exact (lga: {}), {} of {} published", counts.exact, counts.commands,
                     counts.lga_exact, counts.published_exact, counts.published);
}

std::optional<OnFreshCommands> on_fresh_commands(const Entry& entry, const Installed& installed,
                                                 const std::string& nonce, const Catalogue& catalogue,
                                                 const VerifyOptions& options) {
  if (const std::string why = why_exempt(entry); !why.empty())
    throw InputError(fmt::format("no command to draw: the row {}", why));
  for (const Setting::Scenario& played : installed.setting.scenarios)
    if (suite_scenario(installed.suite, played.id, Truth::released, &installed.design).json.value("persons", false))
      throw InputError(fmt::format("no command to draw: {} has persons, whom --fresh draws", installed.suite.id));
  Counts counts{options.commands};
  count_published(entry, installed, counts);
  if (const int enough = enough_commands(counts); counts.commands < enough)
    throw InputError(
        fmt::format("--commands: expected {} or more beside {} of {} published ones that are exact, got {}: "
                    "of fewer drawn ones none may be exact by chance",
                    enough, counts.published_exact, counts.published, counts.commands));
  const Drawn drawn = draw(nonce, counts.commands);
  const Scratch scratch("commands");
  const std::string bytes = canonical(drawn.answers) + "\n", hash = sha256(bytes);
  const fs::path file = scratch.path / (hash + ".json");
  write_file(file, bytes);
  const PluginInfo& lga = catalogue.find("method", "lga");
  RunPlan plan;
  plan.cells = {cell_of(drawn, entry.identity.row, FileAnswers{hash}, catalogue),
                cell_of(drawn, {"method", lga.id, lga.id, lga.version, resolve_options(lga, Json::object()), lga.asks},
                        FileAnswers{hash}, catalogue)};
  if (key(plan.cells[0]) == key(plan.cells[1])) plan.cells.pop_back();
  plan.request = {{"suite", scenario_id}, {"preset", ""}};
  plan.command = "lgabench leaderboard verify --fresh-commands";
  plan.program = options.program;
  plan.pool = options.pool;
  plan.answers.push_back({file.filename(), file, Json::object()});
  const std::optional<Recomputed> played = recompute(plan, catalogue);
  if (!played) return std::nullopt;
  counts.exact = exact_in(played->cells.front(), drawn);
  counts.lga_exact = exact_in(played->cells.back(), drawn);
  return OnFreshCommands{{{"kind", "commands"},
                          {"commands", counts.commands},
                          {"exact", counts.exact},
                          {"lga_exact", counts.lga_exact},
                          {"published", counts.published},
                          {"published_exact", counts.published_exact},
                          {"passed", counts.known()}},
                         played->record};
}

}  // namespace lgabench::leaderboard
