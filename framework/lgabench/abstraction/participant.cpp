#include <lgabench/abstraction/participant.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

using Answer = Participant::Answer;

Selection read_selection(const JsonReader& reader, const Scenario& scenario) {
  const Selection selection = read_distribution(reader, scenario.space, scenario.second);
  if (scenario.second && !selection.second)
    reader.fail(fmt::format("\"{}\" too, for {}", scenario.second->id, scenario.task));
  return selection;
}

// {"selection", "seconds"} and, of an edit, what was edited.
Selection read_made(const JsonReader& reader, const Scenario& scenario, const std::string& asked_as) {
  Selection selection = read_selection(reader.at("selection"), scenario);
  selection.provenance = Provenance::human;
  selection.asked_as = asked_as;
  selection.cost.human_seconds = reader.at("seconds").number();
  constexpr double most = 1e9;
  if (!(selection.cost.human_seconds > 0 && selection.cost.human_seconds <= most))
    reader.at("seconds").fail(fmt::format("more than 0, at most {:g}", most));
  return selection;
}

void read_answer(const JsonReader& reader, Participant& participant) {
  reader.only({"scenario", "command", "asked_as", "specified", "edited"});
  const std::string id = reader.at("scenario").string(), utterance = reader.at("command").string();
  const std::vector<std::string> ids = scenario_ids();
  if (!contains(ids, id))
    throw InputError(
        fmt::format("{}: {}: {}", reader.file(), reader.at("scenario").place(), none_named("scenario", id, ids)));
  const Scenario scenario = load_scenario(id);
  const std::vector<std::string> utterances = scenario.utterances();
  if (!contains(utterances, utterance))
    reader.at("command").fail(fmt::format("one of \"{}\"", fmt::join(utterances, "\", \"")));

  const std::string asked_as = reader.has("asked_as") ? reader.at("asked_as").string() : utterance;
  Answer answer;
  if (reader.has("specified")) {
    reader.at("specified").only({"selection", "seconds"});
    answer.specified = read_made(reader.at("specified"), scenario, asked_as);
    answer.specified->source = "participant " + participant.id;
  }
  if (reader.has("edited")) {
    const JsonReader edited = reader.at("edited");
    edited.only({"proposal", "proposed_by", "selection", "seconds"});
    answer.edited = read_made(edited, scenario, asked_as);
    answer.proposal = read_selection(edited.at("proposal"), scenario);
    answer.edited->source =
        fmt::format("{}, edited by participant {}", edited.at("proposed_by").string(), participant.id);
  }
  if (!answer.specified && !answer.edited) reader.fail("specified, edited or both");
  if (!participant.answers.emplace(std::pair(scenario.answers_of, utterance), std::move(answer)).second)
    reader.fail("each command once");
}

}  // namespace

const Answer* Participant::find(const Scenario& scenario, const std::string& utterance) const {
  const auto found = answers.find({scenario.answers_of, utterance});
  return found == answers.end() ? nullptr : &found->second;
}

bool Participant::answered_all(const Scenario& scenario, std::optional<Selection> Answer::*how) const {
  return std::all_of(scenario.commands.begin(), scenario.commands.end(), [&](const ScenarioCommand& command) {
    const Answer* answer = find(scenario, command.utterance);
    return answer && answer->*how;
  });
}

Participant read_participant(const fs::path& file) {
  const Json json = read_json(file);
  const JsonReader reader(json, file.string());
  reader.only({"participant", "study", "consent", "license", "answers", "rehearsal"});
  Participant participant;
  participant.id = reader.at("participant").string();
  if (participant.id.empty()) reader.at("participant").fail("a pseudonym");
  participant.sha256 = sha256_file(file);
  if (reader.has("rehearsal")) participant.rehearsal = reader.at("rehearsal").boolean();
  reader.at("study").string();
  reader.at("license").string();
  const JsonReader consent = reader.at("consent");
  consent.only({"given", "statement", "ethics"});
  consent.at("statement").string();
  consent.at("ethics").string();
  if (!consent.at("given").boolean()) consent.at("given").fail("true: answers are used only with consent");
  for (const JsonReader& answer : reader.at("answers").elements()) read_answer(answer, participant);
  return participant;
}

ParticipantAsHuman::ParticipantAsHuman(Participant participant, Scenario scenario)
    : participant_(std::move(participant)), scenario_(std::move(scenario)) {}

void ParticipantAsHuman::refuse(const Command& command, const char* what) const {
  throw InputError(fmt::format("participant {}, \"{}\": {}", participant_.id, command.utterance, what));
}

const Answer& ParticipantAsHuman::answer(const Command& command) const {
  const Answer* found = participant_.find(scenario_, command.utterance);
  if (!found) refuse(command, "no answer to this command");
  return *found;
}

Selection ParticipantAsHuman::specify(const Command& command) {
  const Answer& given = answer(command);
  if (!given.specified) refuse(command, "no Selection made from scratch, only an edited one");
  return *given.specified;
}

Selection ParticipantAsHuman::edit(const Command& command, const Selection& proposal) {
  const Answer& given = answer(command);
  if (!given.edited) refuse(command, "no edited Selection, only one made from scratch");
  if (distribution_json(given.proposal) != distribution_json(proposal))
    refuse(command, "the edit began with another proposal than this run's language model makes; see --answers");
  Selection edited = *given.edited;
  edited.cost = proposal.cost;
  edited.cost.human_seconds = given.edited->cost.human_seconds;
  return edited;
}

}  // namespace lgabench
