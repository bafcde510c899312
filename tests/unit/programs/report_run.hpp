// A run directory written by a test, with known outcomes, as docs/formats describes it.
#pragma once
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/document/writers.hpp>
#include <lgabench/record/perturbed.hpp>
#include <lgabench/report/report.hpp>

#include "../testing.hpp"

namespace lgabench {

class FabricatedRun : public TemporaryDirectory {
 public:
  FabricatedRun() {
    run = {{"suite", "q1"},
           {"preset", "smoke"},
           {"smoke", true},
           {"cells", Json::array()},
           {"version", "0.3.0"},
           {"machine", {{"processor", "a processor"}, {"cores", 2}, {"memory_gib", 8.0}, {"system", "Linux"}}},
           {"plugins", {{{"kind", "method"}, {"id", "lga"}, {"version", "0.1"}, {"sha256", std::string(64, 'a')}}}},
           {"build", {{"lgabench-worker", std::string(64, 'b')}}},
           {"request", Json::object()},
           {"command", "lgabench run q1"},
           {"answers", Json::array()},
           {"started", "2024-05-07T12:00:00Z"}};
  }

  struct Arm {
    std::string name;
    int won = 0;                      // of 20: the first
    std::vector<int> commands{0};     // given in turn
    double action = 0.5;              // each of the 12 numbers; NaN: gave none
    Json perturbation{};              // as in a scenario; null: none
    int unchanged = 0;                // of 20: the first, whose input is the control's
    std::vector<std::string> took{};  // of each episode; empty: not told
    std::size_t steps = 1;            // of each episode: all of them the same action
  };

  struct Spec {
    std::string method;  // the row's name
    int won = 0;         // of 20: the first
    std::string scenario = "heart";
    int demonstrations = 20, seed = 0;
    std::string kind = "method", layout = "cells", failure = "missed_object", engine = "mujoco";
    int first_scene = 0;  // hash of the first of 20 scenes
    double learn_s = 4;
    std::string provenance{};                              // of the Selections; "": the method's own
    std::string participant{};                             // whose answers the cell is based on
    bool rehearsal = false;                                // that was no person
    double human_seconds = 0;                              // of each command
    std::map<std::string, double> curves{};                // of training.jsonl, beside the loss: their first value
    int inputs_seen = -1;                                  // of 20 in each arm: the first; -1: the policy does not tell
    std::string attribution{};                             // of each failure; "": null
    std::vector<Arm> arms{};                               // none: "test", with `won`
    std::vector<std::pair<std::string, bool>> commands{};  // utterance, seen; none: one that is seen
    Json selection_errors{};                               // as in cell.json; null: none
    std::map<std::size_t, Json> of_commands{};             // members of the scenario's commands, beside or instead
    std::map<std::size_t, Json> selected{};                // targets, instead of the usual one
    Json train_on{};                                       // as in cell.json; null: none
    Json options = Json::object();                         // of the method, beside those in its row's name

    std::vector<Arm> all_arms() const { return arms.empty() ? std::vector<Arm>{{"test", won, {0}, 0.5}} : arms; }
    std::vector<std::pair<std::string, bool>> all_commands() const {
      return commands.empty() ? std::vector<std::pair<std::string, bool>>{{"Bring me the " + scenario + ".", true}}
                              : commands;
    }
  };

  static Json options_of(const Spec& s) {
    Json options = s.options;
    std::istringstream words(s.method);
    std::string word;
    std::getline(words, word, '+');  // the id
    while (std::getline(words, word, '+'))
      if (const std::string option = word.substr(0, word.find('='));
          !options.contains(option) && !s.selection_errors.contains(option))
        options[option] = word.substr(word.find('=') + 1);
    return options;
  }

  static Json cell_json(const Spec& s) {
    Json commands = Json::array(), tests = Json::array();
    for (const auto& [utterance, seen] : s.all_commands())
      commands.push_back({{"utterance", utterance},
                          {"seen", seen},
                          {"truth", {{"target", {{"object_types", {"heart"}}, {"textures", "ALL"}}}}}});
    for (const auto& [command, members] : s.of_commands) commands.at(command).update(members);
    for (const Arm& arm : s.all_arms()) {
      tests.push_back({{"arm", arm.name}});
      if (!arm.perturbation.is_null()) tests.back()["perturbation"] = arm.perturbation;
    }
    Json cell{{"suite", "q1"},
              {"environment", "tabletop"},
              {"layout", s.layout},
              {"scenario",
               {{"id", s.scenario},
                {"environment", "tabletop"},
                {"task", "pick_and_place"},
                {"commands", commands},
                {"tests", tests}}},
              {"engine", s.engine},
              {"method",
               {{"kind", s.kind},
                {"id", s.method.substr(0, s.method.find('+'))},
                {"name", s.method},
                {"version", "0.1"},
                {"options", options_of(s)}}},
              {"demonstrations", s.demonstrations},
              {"training_seed", s.seed},
              {"scene_seed", 7},
              {"episodes", 20},
              {"answers", "recorded"},
              {"data", {{"answers", std::string(64, 'c')}}},
              {"smoke", true}};
    const std::map<std::string, std::string> asks{{"human", "specify"}, {"lga_hill", "edit"}};
    if (const auto whom = asks.find(s.method); whom != asks.end()) cell["method"]["asks"] = whom->second;
    if (!s.participant.empty()) cell["participant"] = {{"id", s.participant}, {"sha256", std::string(64, 'd')}};
    if (!s.selection_errors.is_null()) cell["selection_errors"] = s.selection_errors;
    if (!s.train_on.is_null()) cell["train_on"] = s.train_on;
    if (s.rehearsal) cell["participant"]["rehearsal"] = true;
    return cell;
  }

  static Json selection_json(const Spec& s) {
    Json commands = Json::array();
    for (const auto& [utterance, seen] : s.all_commands()) {
      commands.push_back(selected_json(s));
      commands.back()["utterance"] = utterance;
    }
    for (const auto& [command, target] : s.selected) commands.at(command)["selection"]["target"] = target;
    return {{"commands", commands}};
  }

  static Json selected_json(const Spec& s) {
    const Json quality{{"precision", 1.0}, {"recall", 0.75}, {"size", 3}, {"true_size", 4}};
    const bool selects =
        s.method == "lga" || s.method == "human" || s.method == "lga_hill" || !s.selection_errors.is_null();
    return {
        {"selection",
         {{"target", {{"object_types", {"heart"}}, {"textures", {"red", "tiger"}}}},
          {"provenance", !s.provenance.empty() ? s.provenance
                         : s.method == "lga"   ? "recorded"
                         : selects             ? "truth"
                                               : "none"},
          {"source", !s.participant.empty() ? "participant " + s.participant
                     : selects              ? "gpt-4"
                                            : ""},
          {"asked_as", selects ? "fetch | heart" : ""},
          {"cost",
           {{"lm_queries", selects ? 112 : 0},
            {"lm_tokens", 0},
            {"lm_seconds", 0.0},
            {"human_seconds", s.human_seconds}}}}},
        {"quality",
         selects ? Json{{"target", {{"object_types", quality}, {"textures", quality}}}, {"avoid", nullptr}} : Json()}};
  }

  static std::string perturbed_text(const Spec& s) {
    std::string lines;
    for (const Arm& arm : s.all_arms())
      for (int i = 0; i < 20; ++i) {
        const bool control = arm.perturbation.is_null();
        PerturbedEpisode episode{arm.name,
                                 i,
                                 control ? "" : arm.perturbation.begin().key(),
                                 control ? 0 : arm.perturbation.begin().value().get<int>(),
                                 {}};
        episode.hashes.fill(hex(static_cast<std::uint64_t>(control || i < arm.unchanged ? i : 100 + i)));
        lines += canonical(to_json(episode)) + '\n';
      }
    return lines;
  }

  /// A cell that finished; returns its directory.
  fs::path add(const Spec& s) {
    std::string episodes, training;
    for (const Arm& arm : s.all_arms())
      for (std::size_t i = 0; i < 20; ++i) {
        const bool won = static_cast<int>(i) < arm.won;
        Json episode{{"arm", arm.name},
                     {"index", i},
                     {"command", arm.commands[i % arm.commands.size()]},
                     {"scene", hex(i + static_cast<std::size_t>(s.first_scene))},
                     {"success", won},
                     {"failure", won ? "none" : s.failure},
                     {"attribution", won || s.attribution.empty() ? Json() : Json(s.attribution)},
                     {"action", std::isnan(arm.action) ? Json() : Json(std::vector<double>(12, arm.action))}};
        if (arm.steps > 1) episode["then"] = Json::array_t(arm.steps - 1, episode["action"]);
        if (!arm.took.empty()) episode["took"] = arm.took.at(i);
        if (s.inputs_seen >= 0) episode["input_seen"] = static_cast<int>(i) < s.inputs_seen;
        episodes += canonical(episode) + '\n';
      }
    for (int e = 1; e <= 3; ++e) {
      Json line{{"epoch", e}, {"steps", 2 * e}, {"loss", 1.0 / e}};
      for (const auto& [name, first] : s.curves) line[name] = first / e;
      training += canonical(line) + '\n';
    }
    const Json timing{{"load_s", 0.125},      {"select_s", 0.125}, {"sample_s", 0.5}, {"demonstrate_s", 1.0},
                      {"learn_s", s.learn_s}, {"evaluate_s", 2.0}, {"total_s", 7.75}};
    const fs::path cell = new_cell(s);
    std::vector<std::pair<std::string, std::string>> written{{"cell.json", canonical(cell_json(s)) + '\n'},
                                                             {"selection.json", canonical(selection_json(s)) + '\n'},
                                                             {"training.jsonl", training},
                                                             {"episodes.jsonl", episodes},
                                                             {"timing.json", canonical(timing) + '\n'}};
    if (!s.all_arms().back().perturbation.is_null()) written.emplace_back("perturbed.jsonl", perturbed_text(s));
    Json files;
    for (const auto& [name, text] : written) {
      write_file(cell / name, text);
      files[name] = sha256(text);
    }
    write_file(cell / "status.json", canonical({{"state", "ok"}, {"build", Json::object()}, {"files", files}}) + '\n');
    return cell;
  }

  /// A cell that failed.
  fs::path add_failed(const Spec& s, const std::string& fault) {
    const fs::path cell = new_cell(s);
    write_file(cell / "cell.json", canonical(cell_json(s)) + '\n');
    write_file(cell / "status.json", canonical({{"state", "failed"},
                                                {"reason", "signal 11 (Segmentation fault) in phase learn"},
                                                {"signal", 11},
                                                {"fault", fault},
                                                {"build", Json::object()},
                                                {"files", Json::object()},
                                                {"log_tail", {"last words"}}}) +
                                         '\n');
    return cell;
  }

  /// Writes run.json as it stands.
  const FabricatedRun& save() const {
    write_file(path / "run.json", canonical(run) + '\n');
    return *this;
  }

  Json run;

 private:
  fs::path new_cell(const Spec& s) {
    const std::string key = sha256(canonical(cell_json(s))).substr(0, 16);
    run["cells"].push_back(key);
    return path / "cells" / key;
  }
};

/// The table that `lgabench report` prints.
inline std::string table_text(const fs::path& run) {
  return document::terminal(report::write_report(run).document, run);
}

}  // namespace lgabench
