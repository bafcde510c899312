#include <lgabench/leaderboard/tracks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/record/answer_source.hpp>

namespace lgabench::leaderboard {

namespace {

int demonstrations_of(const JsonReader& numbers, const std::string& word) {
  const bool is_number = !word.empty() && word.size() < 8 && word.find_first_not_of("0123456789") == word.npos;
  if (!is_number || word.front() == '0') numbers.at(word).fail("a number of demonstrations as its name");
  return std::stoi(word);
}

}  // namespace

Tracks read_tracks(const fs::path& board) {
  const fs::path file = board / tracks_file;
  if (!fs::exists(fs::symlink_status(file))) return {};
  const Json json = read_json(file, Links::refused);
  const JsonReader reader(json, file.string());
  reader.only({"suites", "abstraction", "frozen", "labels", "open", "names_read", "persons"});
  Tracks tracks;
  const auto add = [&tracks](const JsonReader& place, const std::string& preset, Track track) {
    if (!tracks.emplace(preset, std::move(track)).second) place.fail("each preset in one track");
  };
  if (reader.has("abstraction")) {
    const JsonReader presets = reader.at("abstraction");
    if (!presets.json().is_object()) presets.fail("an object: arms by preset");
    for (const auto& [preset, ignored] : presets.json().items())
      add(presets.at(preset), preset, {Track::abstraction, presets.at(preset).strings()});
  }
  if (reader.has("frozen")) {
    const JsonReader presets = reader.at("frozen");
    for (const auto& [preset, ignored] : presets.json().items()) {
      const auto found = tracks.find(preset);
      if (found == tracks.end()) presets.at(preset).fail("a preset of the abstraction track");
      found->second.answers = presets.at(preset).string();
      if (!std::holds_alternative<RecordedAnswers>(read_answer_source(found->second.answers)))
        presets.at(preset).fail("answers that are shipped");
    }
  }
  if (reader.has("labels")) {
    const JsonReader presets = reader.at("labels");
    for (const auto& [preset, ignored] : presets.json().items()) {
      const auto found = tracks.find(preset);
      if (found == tracks.end()) presets.at(preset).fail("a preset of the abstraction track");
      for (const auto& [n, rule] : presets.at(preset).json().items())
        found->second.labels.emplace(demonstrations_of(presets.at(preset), n), presets.at(preset).at(n).string());
    }
  }
  if (reader.has("open"))
    for (const JsonReader& preset : reader.at("open").elements()) add(preset, preset.string(), {Track::open, {}});
  if (reader.has("names_read"))
    for (const std::string& preset : reader.at("names_read").strings()) tracks[preset].names_read = true;
  if (reader.has("persons"))
    for (const std::string& preset : reader.at("persons").strings()) tracks[preset].persons = true;
  return tracks;
}

std::vector<std::string> read_order(const fs::path& board) {
  const fs::path file = board / tracks_file;
  if (!fs::exists(fs::symlink_status(file))) return {};
  const Json json = read_json(file, Links::refused);
  const JsonReader reader(json, file.string());
  return reader.has("suites") ? reader.at("suites").strings() : std::vector<std::string>();
}

void expect_arms(const fs::path& board, const Tracks& tracks, const Setting& setting) {
  const std::vector<std::string> arms = track_of(tracks, setting).arms;
  for (std::size_t i = 0; i < arms.size(); ++i)
    if (std::none_of(setting.scenarios.begin(), setting.scenarios.end(),
                     [&](const Setting::Scenario& scenario) { return contains(scenario.arms, arms[i]); }))
      throw InputError(fmt::format("{}: /abstraction/{}/{}: expected an arm that the preset has, got \"{}\"",
                                   (board / tracks_file).string(), setting.name(), i, arms[i]));
}

Track track_of(const Tracks& tracks, const Setting& setting) {
  const auto found = tracks.find(setting.name());
  return found == tracks.end() ? Track() : found->second;
}

std::string to_string(Ranking ranking) {
  return ranking == Ranking::any_policy       ? "any policy"
         : ranking == Ranking::papers_network ? "paper's network"
                                              : "answers only";
}

std::vector<Ranking> rankings_of(const Track& track) {
  if (track.kind == Track::abstraction) return {Ranking::answers_only};
  if (track.kind == Track::open) return {Ranking::any_policy};
  return {Ranking::any_policy, Ranking::papers_network};
}

std::string words_of(Ranking ranking, const Track* track) {
  if (ranking == Ranking::answers_only) {
    if (track && track->persons)
      return "What a person did not say: rows differ in how they learn it, from demonstrations and from as many "
             "questions as they name. The published persons prove nothing: a row has a rank once it was as good with "
             "persons that were drawn after it was entered.";
    const std::string ranks =
        !track ? "The truth of these commands is public, so answers to them prove nothing: only methods that share one "
                 "frozen file of answers have ranks, in the suites in which there is one."
        : track->answers.empty()
            ? "The truth of these commands is public, so answers to them prove nothing; no file of answers is frozen "
              "for this table, and no row has a rank."
            : "The truth of these commands is public, so answers to them prove nothing, and what is ranked is the "
              "method: rows that share one frozen file of answers, and those that select nothing. Other answers have "
              "no rank.";
    return "Answers only: rows differ in what is selected alone, and the shipped policy learns and acts. \"Where it "
           "decides\" is success in the test scenes in which an abstraction decides; \"gap closed\" is the part of the "
           "distance there from the mask of any object to the true mask. " +
           ranks;
  }
  if (ranking == Ranking::papers_network) return "Paper's network: only rows that learn with it are ranked here.";
  return "Any policy: all that acts is ranked together.";
}

}  // namespace lgabench::leaderboard
