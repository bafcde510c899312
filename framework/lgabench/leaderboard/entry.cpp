#include <lgabench/leaderboard/entry.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <lgabench/core/hash.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/report/statistics.hpp>

namespace lgabench::leaderboard {
namespace {

// Two-sided p of a difference of which the 95 % interval is recorded.
double p_of_fresh(const Json& line) {
  const double width = line.at("high").get<double>() - line.at("low").get<double>();
  return std::erfc(std::sqrt(2.) * report::z_95 * std::abs(line.at("difference").get<double>()) / width);
}

}  // namespace

Json to_json(const Identity& identity) {
  Json json{{"method", identity.row.id},
            {"kind", identity.row.kind},
            {"version", identity.row.version},
            {"options", identity.row.options},
            {"answers", {{"source", to_string(identity.answers)}, {"sha256", identity.answers_sha256}}},
            {"engine", {{"id", identity.engine}, {"version", identity.engine_version}}},
            {"preset", identity.preset_sha256},
            {"scene_seed", identity.scene_seed}};
  if (!identity.row.asks.empty()) json["asks"] = identity.row.asks;
  return json;
}

std::string id_of(const Identity& identity) { return sha256(canonical(to_json(identity))).substr(0, 16); }

int PlayedCell::episodes() const {
  std::size_t n = 0;
  for (const auto& arm : outcomes) n += arm.second.size();
  return static_cast<int>(n);
}

int PlayedCell::successes() const {
  int n = 0;
  for (const auto& arm : outcomes) n += lgabench::successes(arm.second);
  return n;
}

Json to_json(const PlayedCell& cell) {
  Json json{{"key", cell.key},
            {"scenario", cell.place.scenario},
            {"layout", cell.place.layout},
            {"demonstrations", cell.place.demonstrations},
            {"training_seed", cell.place.seed},
            {"outcomes", cell.outcomes},
            {"lm_queries", cell.lm_queries},
            {"lm_tokens", cell.lm_tokens},
            {"human_seconds", cell.human_seconds},
            {"learn_s", cell.learn_s},
            {"total_s", cell.total_s},
            {"steps", cell.steps}};
  if (cell.phi > 0) json["phi"] = cell.phi;
  if (cell.failed.empty())
    json.update({{"scenes", cell.scenes}, {"digest", cell.digest}});
  else
    json["failed"] = cell.failed;
  return json;
}

std::string to_string(Tier tier) {
  constexpr const char* words[] = {"recomputed", "replayed", "reproduced"};
  return words[static_cast<int>(tier)];
}

fs::path Entry::place() const {
  const std::string& method = identity.row.id;
  const bool plain = !method.empty() && method.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-") == std::string::npos;
  if (!plain) throw InputError(fmt::format("method \"{}\": expected an id of letters, digits, _ and -", method));
  return fs::path("entries") / method / id() / setting.name();
}

std::string Entry::hash() const { return sha256(id() + "\n" + cells_text(*this)); }

Tier Entry::tier() const {
  Tier tier = Tier::recomputed;
  const auto elsewhere = [this](const Json& line) {
    return std::none_of(evidence.begin(), evidence.end(), [&](const Json& one) {
      return one.at("by") == line.at("by") || one.at("machine") == line.at("machine");
    });
  };
  for (const Json& line : verifications)
    if (line.at("kind") == "replay") {
      if (!line.at("passed").get<bool>()) return Tier::recomputed;  // one that failed is not outvoted
      tier = std::max(tier, elsewhere(line) ? Tier::reproduced : Tier::replayed);
    }
  return tier;
}

int Entry::fresh() const {
  std::vector<double> p;
  for (const Json& line : verifications)
    if (line.at("kind") == "fresh") p.push_back(p_of_fresh(line));
  const std::vector<double> adjusted = report::holm(p);
  return p.empty() ? 0 : *std::min_element(adjusted.begin(), adjusted.end()) <= report::alpha ? -1 : 1;
}

std::string Entry::spec() const {
  std::string text = identity.row.id;
  for (const auto& [option, value] : identity.row.options.items())
    text += fmt::format("+{}={}", option, option_text(value));
  return text;
}

std::vector<fs::path> entry_directories(const fs::path& board) {
  std::vector<fs::path> all;
  const fs::path root = board / "entries";
  if (!fs::exists(root)) return all;
  const auto below = [](const fs::path& directory) {
    expect_plain_entries(directory);
    std::vector<fs::path> names;
    for (const auto& entry : fs::directory_iterator(directory)) {
      if (!entry.is_directory())
        throw InputError(fmt::format("{}: expected directories alone here", entry.path().string()));
      names.push_back(entry.path());
    }
    std::sort(names.begin(), names.end());
    return names;
  };
  for (const fs::path& method : below(root))
    for (const fs::path& id : below(method))
      for (const fs::path& setting : below(id)) all.push_back(fs::relative(setting, board));
  return all;
}

std::vector<Entry> read_entries(const fs::path& board) {
  std::vector<Entry> all;
  for (const fs::path& directory : entry_directories(board)) all.push_back(read_entry(board, directory));
  return all;
}

std::string entry_text(const Entry& entry) {
  Json json{{"id", entry.id()},          {"identity", to_json(entry.identity)}, {"preset", to_json(entry.setting)},
            {"about", entry.about},      {"failures", entry.failures},          {"phi", entry.phi},
            {"evidence", entry.evidence}};
  if (!entry.withdrawn.is_null()) json["withdrawn"] = entry.withdrawn;
  return json.dump(1) + "\n";
}

std::string cells_text(const Entry& entry) {
  std::string text;
  for (const PlayedCell& cell : entry.cells) text += canonical(to_json(cell)) + "\n";
  return text;
}

void write_entry(const fs::path& board, const Entry& entry) {
  const fs::path path = board / entry.place();
  write_file(path / "cells.jsonl", cells_text(entry));
  write_file(path / "entry.json", entry_text(entry));
}

void add_verification(const fs::path& board, const Entry& entry, const Json& verification) {
  append_file(board / entry.place() / "verifications.jsonl", canonical(verification) + "\n");
}

fs::path find_entry(const fs::path& board, const std::string& name) {
  std::vector<fs::path> found;
  for (const fs::path& directory : entry_directories(board))
    if (directory == fs::path(name).lexically_normal() || board / directory == fs::path(name).lexically_normal() ||
        directory.parent_path().filename() == name)
      found.push_back(directory);
  if (found.size() != 1)
    throw InputError(fmt::format("{}: expected an entry's directory below {}, or its id{}", name,
                                 (board / "entries").string(), found.empty() ? "" : "; it names several"));
  return found.front();
}

void withdraw(const fs::path& board, const std::string& name, const std::string& reason, const std::string& when) {
  Entry entry = read_entry(board, find_entry(board, name));
  if (!entry.withdrawn.is_null()) throw InputError(name + ": was withdrawn before");
  entry.withdrawn = {{"when", when}, {"reason", reason}};
  write_file(board / entry.place() / "entry.json", entry_text(entry));
}

std::vector<std::size_t> chosen_cells(const Entry& entry, const std::string& nonce, std::size_t cells) {
  std::vector<std::pair<std::string, std::size_t>> order;
  const std::string hash = entry.hash();
  for (std::size_t i = 0; i < entry.cells.size(); ++i) order.emplace_back(sha256(hash + nonce + entry.cells[i].key), i);
  std::sort(order.begin(), order.end());
  order.resize(std::min(cells, order.size()));
  std::vector<std::size_t> chosen;
  for (const auto& item : order) chosen.push_back(item.second);
  return chosen;
}

}  // namespace lgabench::leaderboard
