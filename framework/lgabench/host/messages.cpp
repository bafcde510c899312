#include <lgabench/host/messages.hpp>

#include <fmt/format.h>

#include <array>
#include <cstring>

#include <lgabench/core/fields.hpp>

namespace lgabench {

static void fields(SecondRole& second, Fields& field) {
  field("id", second.id);
  field("phrase", second.phrase);
}

void fields(Command& command, Fields& field) {
  field("utterance", command.utterance);
  field("task", command.task);
  field("second", command.second, when(command.second.has_value()));
  field("may_stop", command.may_stop, when(command.may_stop));
}

void fields(FeatureSpace& space, Fields& field) {
  field("id", space.id);
  field("object_types", space.object_types);
  field("textures", space.textures);
}

void fields(Needs& needs, Fields& field) {
  static constexpr std::array targets{"selected", "truth"};  // of Needs::Targets
  constexpr int most = 100;                                  // rollouts a demonstration: each is played by the oracle
  std::string word = targets.at(needs.targets == Needs::Targets::truth ? 1 : 0);
  field("targets", word, one_of(targets));
  needs.targets = word == targets[1] ? Needs::Targets::truth : Needs::Targets::selected;
  field("noisy_per_clean", needs.noisy_per_clean, within(0, most));
  field("noise_max", needs.noise_max);
  field("revise", needs.revise, may_lack());
  field("shadows", needs.shadows, may_lack());
}

void fields(Placed& placed, Fields& field) {
  field("id", placed.instance.id);
  field("object_type", placed.instance.object_type);
  field("texture", placed.instance.texture);
  field("pixels", placed.instance.pixels, within(0, 1 << 30));
  field("row", placed.row);
  field("column", placed.column);
}

void fields(SelectionCost& cost, Fields& field) {
  field("lm_queries", cost.lm_queries, within(0, 1 << 30));
  field("lm_tokens", cost.lm_tokens, within(0, 1LL << 60));
  field("lm_seconds", cost.lm_seconds);
  field("human_seconds", cost.human_seconds);
}

void fields(ProcessState& state, Fields& field) {
  field("threads", state.threads);
  field("descriptors", state.descriptors);
  field("heap_bytes", state.heap_bytes, within(0, 1LL << 60));
  field("flushed", state.flushed);
  field("rounds", state.rounds);
}

}  // namespace lgabench

namespace lgabench::host {
namespace {

using About = Question::About;
using Group = Question::Group;

FeatureSet read_set(const JsonReader& reader) {
  reader.only({"object_types", "textures"});
  return {reader.at("object_types").strings(), reader.at("textures").strings()};
}

}  // namespace

Json to_json(const Command& command) { return json_of(command); }
Command read_command(const JsonReader& reader) { return value_of<Command>(reader, false); }

Json to_json(const FeatureSpace& space) { return json_of(space); }
FeatureSpace read_space(const JsonReader& reader) { return value_of<FeatureSpace>(reader, false); }

Json selection_for_method(const Selection& selection) {
  Json json = distribution_json(selection);
  json.update({{"provenance", to_string(selection.provenance)},
               {"source", selection.source},
               {"asked_as", selection.asked_as}});
  return json;
}

Selection read_selection(const JsonReader& reader) {
  Selection selection;
  selection.target = read_unchecked_meaning(reader.at("target"));
  const Json distribution = distribution_of(reader.json());
  for (const auto& item : distribution.items()) {
    if (item.key() == "target") continue;
    if (selection.second) reader.fail("one second set at most");
    selection.second = SecondSet{read_set(reader.at(item.key())), item.key()};
  }
  if (reader.has("provenance")) selection.provenance = provenance_from(reader.at("provenance").string());
  if (reader.has("source")) selection.source = reader.at("source").string();
  if (reader.has("asked_as")) selection.asked_as = reader.at("asked_as").string();
  return selection;
}

Json to_json(const Instruction& instruction) {
  return {{"utterance", instruction.utterance}, {"selection", selection_for_method(instruction.selection)}};
}

Instruction read_instruction(const JsonReader& reader) {
  return {reader.at("utterance").string(), read_selection(reader.at("selection"))};
}

Json to_json(const Needs& needs) { return json_of(needs); }
Needs read_needs(const JsonReader& reader) { return value_of<Needs>(reader, false); }

Json to_json(const Question& question, const Command& command) {
  if (question.about == About::second && !command.second)
    throw MethodError("a question about a second set, which the command does not have");
  return {{"about", question.about == About::second ? command.second->id : "target"},
          {"group", question.group == Group::texture ? "texture" : "object_type"},
          {"candidate", question.candidate}};
}

Question read_question(const JsonReader& reader, const Command& command) {
  const std::string about = reader.at("about").string(), group = reader.at("group").string();
  if (about != "target" && !(command.second && about == command.second->id))
    reader.at("about").fail(command.second ? fmt::format("target or {}", command.second->id) : "target");
  if (group != "object_type" && group != "texture") reader.at("group").fail("object_type or texture");
  return {about == "target" ? About::target : About::second, group == "texture" ? Group::texture : Group::object_type,
          reader.at("candidate").string()};
}

Json to_json(const std::vector<Hypothesis>& hypotheses) {
  Json all = Json::array();
  for (const auto& [text, meaning, weight] : hypotheses)
    all.push_back({{"text", text}, {"meaning", to_json(meaning)}, {"weight", weight}});
  return all;
}

Json to_json(const std::vector<Placed>& objects) { return json_of(objects); }
std::vector<Placed> read_placed(const JsonReader& reader) { return value_of<std::vector<Placed>>(reader, false); }

std::vector<Hypothesis> read_hypotheses(const JsonReader& reader) {
  std::vector<Hypothesis> all;
  for (const JsonReader& one : reader.elements())
    all.push_back({one.at("text").string(), read_unchecked_meaning(one.at("meaning")), one.at("weight").number()});
  return all;
}

Json to_json(const SelectionCost& cost) { return json_of(cost); }
SelectionCost read_cost(const JsonReader& reader) { return value_of<SelectionCost>(reader, false); }

Json to_json(const ProcessState& state) { return json_of(state); }
ProcessState read_state(const JsonReader& reader) { return value_of<ProcessState>(reader, false); }

Frame log_frame(const std::vector<LogEntry>& entries) {
  Frame frame{{{"type", "log"}, {"epochs", Json::array()}, {"steps", Json::array()}}};
  Json curves = Json::array();
  bool any = false;
  for (const LogEntry& entry : entries) {
    frame.header["epochs"].push_back(entry.epochs);
    frame.header["steps"].push_back(entry.steps);
    const auto append = [&frame](double value) {
      frame.payload.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    append(entry.loss);
    Json names = Json::array();
    for (const auto& [name, value] : entry.curves) {
      names.push_back(name);
      append(value);
    }
    curves.push_back(names);
    any = any || !names.empty();
  }
  if (any) frame.header["curves"] = curves;
  return frame;
}

std::vector<LogEntry> read_log(const Frame& frame) {
  const JsonReader reader(frame.header, "log");
  const std::vector<JsonReader> epochs = reader.at("epochs").elements(), steps = reader.at("steps").elements();
  std::vector<LogEntry> entries(epochs.size());
  if (steps.size() != entries.size()) reader.at("steps").fail("as many as epochs");
  std::vector<std::vector<std::string>> names(entries.size());
  if (reader.has("curves")) {
    const std::vector<JsonReader> lists = reader.at("curves").elements();
    if (lists.size() != entries.size()) reader.at("curves").fail("as many as epochs");
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = lists[i].strings();
  }
  std::size_t at = 0, all = entries.size();
  for (const auto& of_entry : names) all += of_entry.size();
  if (frame.payload.size() != all * sizeof(double)) reader.fail("a payload of a double for each epoch and curve");
  const auto next = [&] {
    double value = 0;
    std::memcpy(&value, frame.payload.data() + sizeof(double) * at++, sizeof value);
    return value;
  };
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].epochs = static_cast<int>(epochs[i].integer(0, 1 << 30));
    entries[i].steps = steps[i].integer(0, 1LL << 60);
    entries[i].loss = next();
    for (const std::string& name : names[i]) entries[i].curves.emplace_back(name, next());
  }
  return entries;
}

Frame shown_frame(const Shown& shown) {
  expect_shown(shown);
  Frame frame{{{"type", "shown"}, {"pictures", Json::array()}, {"texts", shown.texts}, {"unread", shown.unread}}};
  for (const auto& [name, note, size, rgb] : shown.pictures) {
    frame.header["pictures"].push_back(
        {{"name", name}, {"note", note}, {"rows", size.rows}, {"columns", size.columns}});
    frame.payload.append(rgb.begin(), rgb.end());
  }
  return frame;
}

Shown read_shown(const Frame& frame) {
  constexpr int longest = 1 << 10;
  const JsonReader reader(frame.header, "shown");
  Shown shown{{}, reader.at("texts").strings(), reader.at("unread").strings()};
  auto from = frame.payload.begin();
  for (const JsonReader& one : reader.at("pictures").elements()) {
    const PictureSize size{static_cast<int>(one.at("rows").integer(1, longest)),
                           static_cast<int>(one.at("columns").integer(1, longest))};
    const auto bytes = static_cast<std::ptrdiff_t>(3 * size.pixels());
    if (frame.payload.end() - from < bytes) reader.fail("a payload of 3 bytes for each pixel");
    shown.pictures.push_back({one.at("name").string(), one.at("note").string(), size, {from, from + bytes}});
    from += bytes;
  }
  try {
    expect_shown(shown);
  } catch (const MethodError& e) {
    throw InputError(e.what());
  }
  return shown;
}

std::string to_bytes(const Action& action) {
  return {reinterpret_cast<const char*>(action.data()), action.size() * sizeof action[0]};
}

Action read_action(const std::string& bytes, std::size_t numbers) {
  Action action(numbers);
  if (bytes.size() != numbers * sizeof action[0])
    throw InputError(fmt::format("action: expected {} bytes, {} doubles, got {}", numbers * sizeof action[0], numbers,
                                 bytes.size()));
  std::memcpy(action.data(), bytes.data(), bytes.size());
  return action;
}

Json to_json(const Layout& layout) {
  Json json{{"observation", {{"rows", layout.picture.rows}, {"columns", layout.picture.columns}, {"channels", 3}}},
            {"action", to_json(layout.actions)}};
  if (!layout.state.empty()) json["observation"]["state"] = lgabench::to_json(layout.state);
  if (layout.may_stop) json["may_stop"] = true;
  return json;
}

PictureSize read_picture_size(const JsonReader& hello) {
  constexpr int longest = 1 << 14;
  const JsonReader observation = hello.at("observation");
  observation.at("channels").integer(3, 3);
  return {static_cast<int>(observation.at("rows").integer(1, longest)),
          static_cast<int>(observation.at("columns").integer(1, longest))};
}

Layout read_layout(const JsonReader& hello) {
  Layout layout{read_picture_size(hello), read_action_space(hello.at("action"))};
  const JsonReader observation = hello.at("observation");
  if (observation.has("state")) layout.state = read_numbers(observation.at("state"));
  layout.may_stop = hello.has("may_stop") && hello.at("may_stop").boolean();
  return layout;
}

Json beside_pictures(const Observation& observation) {
  Json json = Json::object();
  if (!observation.state.empty()) json["state"] = observation.state;
  for (const Named& one : observation.brought)
    json["brought"].push_back({{"object_type", one.object_type}, {"texture", one.texture}});
  return json;
}

void read_beside_pictures(const JsonReader& frame, const Layout& layout, Observation& observation) {
  observation.state.clear();
  observation.brought.clear();
  if (frame.has("state"))
    for (const JsonReader& number : frame.at("state").elements()) observation.state.push_back(number.number());
  if (observation.state.size() != layout.state.size())
    frame.fail(fmt::format("a \"state\" of {} numbers", layout.state.size()));
  if (frame.has("brought"))
    for (const JsonReader& one : frame.at("brought").elements())
      observation.brought.push_back({one.at("object_type").string(), one.at("texture").string()});
}

Frame ids_frame(const Observation& perceived) {
  return {{{"type", "ids"}}, {perceived.ids.begin(), perceived.ids.end()}};
}

Frame perceived_frame(const Observation& perceived) {
  return {{{"type", "perceived"}, {"instances", instances_json(perceived)}},
          {perceived.rgb.begin(), perceived.rgb.end()}};
}

Observation read_perceived(const Frame& ids, const Frame& perceived, PictureSize picture) {
  const JsonReader reader(perceived.header, "perceived");
  if (ids.payload.size() != picture.pixels()) reader.fail("\"ids\" before it with a byte for each pixel");
  if (perceived.payload.size() != 3 * picture.pixels()) reader.fail("a payload of 3 bytes for each pixel");
  Observation all{
      picture, {perceived.payload.begin(), perceived.payload.end()}, {ids.payload.begin(), ids.payload.end()}, {}};
  std::array<int, 256> pixels{};
  for (const std::uint8_t id : all.ids) ++pixels[id];
  for (const JsonReader& one : reader.at("instances").elements()) {
    const auto id = static_cast<std::uint8_t>(one.at("id").integer(1, 255));
    all.instances.push_back({id, one.at("object_type").string(), one.at("texture").string(), pixels[id]});
  }
  return all;
}

}  // namespace lgabench::host
