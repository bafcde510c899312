// A leaderboard written by a test, with known outcomes, as docs/formats describes it.
#pragma once
#include <fmt/format.h>

#include <string>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

inline Setting small_setting() {
  return {"q1",
          "board",
          {{"heart", std::string(64, 'a'), {"test"}}, {"letter", std::string(64, 'b'), {"test", "hard"}}},
          {"cells"},
          {10, 20},
          {0, 1, 2},
          40,
          TestScenes::per_seed,
          77};
}

/// The size of q1's preset for the leaderboard.
inline Setting large_setting() {
  Setting setting{"q1", "leaderboard",        {}, {"continuous"}, {10, 20, 30, 40, 50}, {0, 1, 2},
                  100,  TestScenes::per_seed, 77};
  for (int s = 0; s < 13; ++s)
    setting.scenarios.push_back(
        {fmt::format("a_scenario_with_a_long_name_{}", s), sha256(std::to_string(s)), {"test"}});
  return setting;
}

/// An entry whose episodes succeed with that probability; `name` seeds them.
inline Entry made_entry(const Setting& setting, const std::string& name, double rate,
                        const std::string& kind = "method") {
  Entry entry;
  entry.setting = setting;
  entry.identity = {{kind, kind == "method" ? "method_of_" + name : name, "", "1.0",
                     kind == "method" ? Json{{"epochs", 750}, {"loss", "norm"}} : Json::object()},
                    RecordedAnswers(),
                    std::string(64, 'c'),
                    "mujoco",
                    "3.17",
                    hash(setting),
                    setting.scene_seed};
  entry.identity.row.name = entry.identity.row.id;
  entry.about = {{"authors", Json::array({name})},
                 {"license", "Apache-2.0"},
                 {"by", name},
                 {"source", {{"repository", "https://example.org/" + name}, {"commit", std::string(40, '0')}}}};
  entry.failures = {"missed_object", "wrong_object"};
  entry.evidence.push_back({{"by", name},
                            {"program", "lgabench 0.2.0"},
                            {"version", "0.2.0"},
                            {"build", Json::object()},
                            {"plugins", Json::array()},
                            {"machine", {{"processor", "a processor"}, {"instructions", "AVX2"}}},
                            {"confinement", "Landlock 6, seccomp"},
                            {"started", "2026-01-01T00:00:00Z"},
                            {"command", "lgabench run q1"},
                            {"data", Json::object()}});
  const Json part{{"precision", .5}, {"recall", .75}, {"size", 1}, {"true_size", 2}};
  const Json command{
      {"utterance", "Bring me the heart."},
      {"selection",
       {{"target", {{"object_types", Json::array({"heart"})}, {"textures", "ALL"}}}, {"provenance", "recorded"}}},
      {"quality", {{"target", {{"object_types", part}, {"textures", part}}}}}};
  for (const Setting::Scenario& scenario : setting.scenarios)
    if (kind == "method") entry.phi[scenario.id] = Json::array({Json::array({command})});
  RandomStream random(name);
  for (const Place& place : setting.places(learns(entry.identity.row))) {
    PlayedCell& cell = entry.cells.emplace_back();
    cell.place = place;
    cell.key = sha256(name + place.text()).substr(0, 16);
    cell.scenes = sha256(fmt::format("{} {} {}", place.scenario, place.layout, place.seed));
    cell.digest = sha256(cell.key);
    for (const std::string& arm : setting.scenario(place.scenario).arms)
      for (int i = 0; i < setting.episodes; ++i)
        cell.outcomes[arm] += random.uniform() < rate ? '.' : random.coin() ? 'a' : 'B';
    cell.lm_queries = kind == "method" ? 112 : 0;
    cell.learn_s = 4;
    cell.total_s = 6;
    cell.steps = 100;
  }
  return entry;
}

/// A replay of all of an entry's cells by somebody, on a processor with AVX2; one that passed was bit-identical.
inline Json replay_of(const Entry& entry, const std::string& by, const std::string& processor, bool passed = true) {
  const std::string nonce(32, '7');
  Json cells = Json::array();
  int episodes = 0;
  for (const std::size_t i : chosen_cells(entry, entry.hash(), nonce, entry.cells.size())) {
    cells.push_back(entry.cells[i].key);
    episodes += entry.cells[i].episodes();
  }
  return {{"kind", "replay"},
          {"nonce", nonce},
          {"cells", cells},
          {"bit_identical", passed ? cells.size() : 0},
          {"flips", passed ? 0 : episodes / 2},
          {"only_recorded", 0},
          {"episodes", episodes},
          {"passed", passed},
          {"by", by},
          {"when", "2026-01-02"},
          {"program", "lgabench 0.2.0"},
          {"build", Json::object()},
          {"machine", {{"processor", processor}, {"instructions", "AVX2"}}},
          {"confinement", "Landlock 6, seccomp"}};
}

/// Adds a line that counts.
inline void add_vouched(Entry& entry, const Json& line) {
  entry.verifications.push_back(line);
  entry.vouched.insert(line_hash(line));
}

/// An entry that may be ranked: its authors replayed it, and somebody vouches for that.
inline Entry replayed_entry(const Setting& setting, const std::string& name, double rate,
                            const std::string& kind = "method") {
  Entry entry = made_entry(setting, name, rate, kind);
  add_vouched(entry, replay_of(entry, name, "a processor"));
  return entry;
}
inline void write_replayed(const fs::path& board, const Entry& entry) {
  write_entry(board, entry);
  add_verification(board, entry, replay_of(entry, entry.about.at("by"), "a processor"));
  vouch(board, entry.place().string(), "1");
}

}  // namespace lgabench::leaderboard
