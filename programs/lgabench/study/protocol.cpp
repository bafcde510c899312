#include <lgabench/study/protocol.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/read_space.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/shell.hpp>

namespace lgabench::study {
namespace {

constexpr std::size_t most_items = 40;

std::string words(const JsonReader& reader, const std::string& member) {
  const std::string text = reader.at(member).string();
  if (text.empty()) reader.at(member).fail("words");
  return text;
}

// With `meanings` what the model said that the command means, where it was asked; else its yes and no of each feature.
Selection proposal_of(const Item& item, RecordedLanguageModel& lm, bool meanings) {
  return meanings && lm.has_meaning(item.command) ? select_meaning(item.command, item.space, lm)
                                                  : select_features(item.command, item.space, lm);
}

// The command with those words, and the objects that are asked about.
Item item_of_pairs(const JsonReader& reader) {
  Item item;
  item.scenario = reader.at("scenario").string();
  item.asked_as = words(reader, "asked_as");
  const Scenario scenario = load_scenario(item.scenario);
  item.space = scenario.space;
  for (const ScenarioCommand& command : scenario.commands)
    if (command.utterance == item.asked_as) item.truth = command.truth;
  if (!item.truth) reader.at("asked_as").fail("a command of " + item.scenario);
  item.command.utterance = item.asked_as;
  const auto known = [](const JsonReader& name, const std::vector<std::string>& names) {
    if (!contains(names, name.string())) name.fail("a word of the space");
    return name.string();
  };
  for (const JsonReader& pair : reader.at("pairs").elements()) {
    pair.only({"object_type", "texture", "settled"});
    item.pairs.push_back({known(pair.at("object_type"), item.space.object_types),
                          known(pair.at("texture"), item.space.textures),
                          pair.has("settled") ? std::optional(pair.at("settled").boolean()) : std::nullopt});
  }
  if (item.pairs.empty()) reader.at("pairs").fail("a pair");
  return item;
}

// A scenario's one command, with the proposal that LGA-HILL makes in a run.
Item scenario_item(const JsonReader& reader, bool meanings) {
  reader.only({"scenario", "asked_as", "hint", "pairs"});
  if (reader.has("pairs")) return item_of_pairs(reader);
  Item item;
  item.scenario = reader.at("scenario").string();
  const Scenario scenario = load_scenario(item.scenario);
  if (scenario.commands.size() != 1) reader.at("scenario").fail("a scenario with one command");
  item.command = scenario.command(0);
  item.space = scenario.space;
  item.truth = scenario.commands.front().truth;
  RecordedLanguageModel lm(scenario, recorded_source(scenario, "recorded", true));
  item.proposal = proposal_of(item, lm, meanings);
  item.proposed_by = lm.model();
  item.asked_as = reader.has("asked_as") ? words(reader, "asked_as") : item.command.utterance;
  if (reader.has("hint")) item.hint = reader.at("hint").string();
  return item;
}

Item practice_item(const JsonReader& reader, bool meanings) {
  if (reader.has("scenario")) return scenario_item(reader, meanings);
  reader.only({"asked_as", "hint", "task", "feature_space", "proposal", "proposed_by"});
  Item item;
  item.asked_as = words(reader, "asked_as");
  const std::vector<TaskInfo> tasks = installed_tasks();
  const auto known = std::find_if(tasks.begin(), tasks.end(),
                                  [&](const TaskInfo& task) { return task.id == reader.at("task").string(); });
  if (known == tasks.end()) reader.at("task").fail("a task of an installed environment");
  const TaskInfo& task = *known;
  item.command = {item.asked_as, task.id, task.second};
  item.space = read_space(reader.at("feature_space"));
  item.proposal = read_distribution(reader.at("proposal"), item.space, task.second);
  if (!meanings && !item.proposal.target.is_product())
    reader.at("proposal").fail("one set, or \"meanings\": true in the protocol");
  if (!item.proposal.target.turns.empty()) reader.at("proposal").at("target").fail("a meaning without turns");
  item.proposed_by = words(reader, "proposed_by");
  if (reader.has("hint")) item.hint = reader.at("hint").string();
  return item;
}

std::vector<Item> items(const JsonReader& reader, bool meanings) {
  std::vector<Item> all;
  for (const JsonReader& one : reader.elements()) all.push_back(scenario_item(one, meanings));
  if (all.size() > most_items) reader.fail(fmt::format("at most {} commands", most_items));
  return all;
}

// Nothing is asked twice but by design.
void expect_distinct(const Protocol& protocol, const JsonReader& reader) {
  std::vector<std::string> seen;
  const auto add = [&](const std::vector<Item>& some) {
    for (const Item& item : some) {
      const std::string& one = item.pairs.empty() ? item.scenario : item.asked_as;
      if (contains(seen, one))
        reader.fail(fmt::format("each scenario once in sets and spares; {} is there twice", one));
      seen.push_back(one);
    }
  };
  for (const auto& set : protocol.sets) add(set);
  add(protocol.spares);
}

void read_design(const JsonReader& reader, Protocol& protocol) {
  for (const JsonReader& set : reader.at("sets").elements()) protocol.sets.push_back(items(set, protocol.meanings));
  if (protocol.sets.empty() || protocol.sets.size() > 2) reader.at("sets").fail("one set, or two for a crossover");
  for (const auto& set : protocol.sets)
    if (set.empty()) reader.at("sets").fail("commands in every set");
  // A Williams square of an even number is balanced for what comes before what.
  if (protocol.crossover() && (protocol.sets[0].size() != protocol.sets[1].size() || protocol.sets[0].size() % 2 != 0))
    reader.at("sets").fail("two sets of one even size");
  if (reader.has("spares")) protocol.spares = items(reader.at("spares"), protocol.meanings);
  expect_distinct(protocol, reader);
  protocol.practice = practice_item(reader.at("practice"), protocol.meanings);
  for (const auto* all : {&protocol.sets[0], &protocol.sets.back(), &protocol.spares})
    for (const Item& item : *all)
      if (item.pairs.empty() == protocol.of_pairs() || (protocol.of_pairs() && all != &protocol.sets[0]))
        reader.at("sets").fail("pairs in practice and every command of one set, without spares, or nowhere");
  if (protocol.of_pairs()) return;
  const JsonReader example = reader.at("example");
  example.only({"command", "feature_space", "answer"});
  protocol.example_command = words(example, "command");
  protocol.example_space = read_space(example.at("feature_space"));
  protocol.example = read_distribution(example.at("answer"), protocol.example_space, std::nullopt);
  if (!protocol.example.target.is_product()) example.at("answer").fail("one set");
}

void read_rules(const JsonReader& reader, Protocol& protocol) {
  const JsonReader exclusions = reader.at("exclusions");
  exclusions.only({"fewest_trials", "longest_seconds", "most_controls_failed"});
  if (exclusions.has("most_controls_failed"))
    protocol.most_controls_failed = static_cast<int>(exclusions.at("most_controls_failed").integer(0, 1000));
  protocol.fewest_trials = static_cast<int>(exclusions.at("fewest_trials").integer(1, 1000));
  if (exclusions.has("longest_seconds")) {
    const JsonReader longest = exclusions.at("longest_seconds");
    protocol.longest_s = longest.number();
    if (!(protocol.longest_s > 0)) longest.fail("more than 0 seconds");
  }
  const JsonReader asked = reader.at("questionnaire");
  asked.only({"nasa_tlx", "free_text"});
  const JsonReader tlx = asked.at("nasa_tlx");
  if (tlx.json() == "by_condition")
    protocol.tlx = Tlx::by_condition;
  else if (tlx.json().is_boolean())
    protocol.tlx = tlx.boolean() ? Tlx::at_end : Tlx::never;
  else
    tlx.fail("true, false or \"by_condition\"");
  protocol.free_text = asked.at("free_text").boolean();
}

// All that people are shown, and what their answers are judged by.
Json stimuli(const Protocol& protocol) {
  const auto shown = [](const Item& item) {
    Json json{{"asked_as", item.asked_as},
              {"hint", item.hint},
              {"types", item.space.object_types},
              {"textures", item.space.textures},
              {"proposal", distribution_json(item.proposal)},
              {"proposed_by", item.proposed_by},
              {"truth", item.truth ? distribution_json(*item.truth) : Json()}};
    for (const AskedPair& pair : item.pairs)
      json["pairs"].push_back({pair.object_type, pair.texture});  // else as 0.2.0
    return json;
  };
  Json all{{"practice", shown(protocol.practice)}, {"sets", Json::array()}, {"spares", Json::array()}};
  for (const auto& set : protocol.sets) {
    Json some = Json::array();
    for (const Item& item : set) some.push_back(shown(item));
    all["sets"].push_back(std::move(some));
  }
  for (const Item& item : protocol.spares) all["spares"].push_back(shown(item));
  return all;
}

void find_blanks(const std::string& text, const std::string& file, std::vector<std::string>& found) {
  for (std::size_t at = 0; (at = text.find("[[", at)) != std::string::npos;) {
    const std::size_t end = text.find("]]", at);
    found.push_back(fmt::format("{}: {}", file, text.substr(at, end == std::string::npos ? 40 : end + 2 - at)));
    if (end == std::string::npos) return;
    at = end + 2;
  }
}

}  // namespace

std::string to_string(Condition condition) { return condition == Condition::human ? "human" : "lga_hill"; }

Condition read_condition(const JsonReader& reader) {
  const std::string word = reader.string();
  if (word == "human") return Condition::human;
  if (word == "lga_hill") return Condition::lga_hill;
  reader.fail("human or lga_hill");
}

Protocol read_protocol(const fs::path& file) {
  Protocol protocol;
  protocol.bytes = read_file(file);
  protocol.sha256 = sha256(protocol.bytes);
  protocol.json = parse_json(protocol.bytes, file.string());
  const JsonReader reader(protocol.json, file.string());
  reader.only({"study", "title", "note", "researcher", "license", "consent", "seed", "planned_people", "minutes",
               "meanings", "instruction", "sets", "spares", "practice", "example", "exclusions", "questionnaire"});
  protocol.id = words(reader, "study");
  protocol.title = words(reader, "title");
  const JsonReader researcher = reader.at("researcher");
  researcher.only({"name", "contact", "ethics"});
  protocol.researcher = words(researcher, "name");
  protocol.contact = words(researcher, "contact");
  protocol.ethics = words(researcher, "ethics");
  protocol.license = words(reader, "license");
  protocol.seed = static_cast<std::uint64_t>(reader.at("seed").integer(0, 1LL << 53));
  protocol.planned = static_cast<int>(reader.at("planned_people").integer(1, 100000));
  protocol.minutes = static_cast<int>(reader.at("minutes").integer(1, 600));
  if (reader.has("meanings")) protocol.meanings = reader.at("meanings").boolean();
  if (reader.has("instruction")) protocol.instruction = words(reader, "instruction");
  const fs::path consent = reader.at("consent").string();
  if (consent.empty() || consent.has_parent_path()) reader.at("consent").fail("a file's name, beside the protocol");
  protocol.consent = read_file(file.parent_path() / consent, Links::followed, 1 << 20);
  if (protocol.consent.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError((file.parent_path() / consent).string() + ": expected the text of the consent, got an empty file");
  canonical(protocol.consent);  // UTF-8, or an InputError
  read_design(reader, protocol);
  read_rules(reader, protocol);
  protocol.pin = canonical(pin_of(protocol));
  return protocol;
}

std::vector<std::string> blanks(const Protocol& protocol) {
  std::vector<std::string> found;
  const Json flat = protocol.json.flatten();
  for (const auto& [place, value] : flat.items())  // texts alone: lists begin with [[ as well
    if (value.is_string()) find_blanks(value.get<std::string>(), "protocol", found);
  find_blanks(protocol.consent, "consent", found);
  return found;
}

fs::path pin_file(const fs::path& protocol) { return fs::path(protocol).replace_extension(".pin"); }

Json pin_of(const Protocol& protocol) {
  return {{"protocol", protocol.sha256},
          {"consent", sha256(protocol.consent)},
          {"stimuli", sha256(canonical(stimuli(protocol)))}};
}

std::string not_ready(const Protocol& protocol, const fs::path& file) {
  if (const std::vector<std::string> empty = blanks(protocol); !empty.empty())
    return fmt::format("{} blanks to fill in; lgabench study check lists them", empty.size());
  const fs::path pin = pin_file(file);
  std::error_code error;
  if (!fs::exists(pin, error))
    return fmt::format("not pinned; once nothing will change any more: lgabench study check {} --pin",
                       shell_line({file.parent_path().empty() ? "." : file.parent_path().string()}));
  const Json pinned = read_json(pin), now = pin_of(protocol);
  for (const char* part : {"protocol", "consent", "stimuli"})
    if (!pinned.is_object() || !pinned.contains(part) || pinned.at(part) != now.at(part))
      return fmt::format(
          "{} differs from what {} pins; changing it starts another study: copy protocol and consent to a new "
          "directory",
          std::string(part) == "stimuli" ? "what people are shown (scenarios, answers)" : fmt::format("the {}", part),
          pin.string());
  return "";
}

}  // namespace lgabench::study
