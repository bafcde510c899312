#include <lgabench/leaderboard/conditions.hpp>

#include <fmt/format.h>

#include <lgabench/harness/expand.hpp>
#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/leaderboard/tracks.hpp>

namespace lgabench::leaderboard {

std::vector<std::string> Conditions::members() { return {"names", "reader", "segments"}; }

Conditions Conditions::read(const JsonReader& identity) {
  Conditions conditions;
  if (identity.has("names")) {
    conditions.reading.names = identity.at("names").string();
    if (!is_id(conditions.reading.names)) identity.at("names").fail("an id of letters, digits, _ and -");
    conditions.reader_sha256 = read_sha256(identity.at("reader"));
  }
  if (identity.has("segments")) conditions.reading.segments = read_segments(identity.at("segments"));
  return conditions;
}

Json Conditions::json() const {
  Json json = Json::object();
  if (reading.names != Reading::simulator) json.update({{"names", reading.names}, {"reader", reader_sha256}});
  if (reading.segments != Reading::simulator) json["segments"] = reading.segments;
  return json;
}

Conditions Conditions::of(const Cell& cell) { return {cell.reading, cell.data.value("reader", "")}; }

void Conditions::set(Cell& cell, const Scenario& scenario) const {
  cell.reading = reading;
  if (!none()) cell.data = data_hashes(scenario, cell.answers, reading);
}

void Conditions::expect_same(const Cell& cell) const {
  const std::string here = cell.data.value("reader", "");
  if (here != reader_sha256)
    throw InputError(
        fmt::format("model that reads names ({}): {} here, {} in the entry", reading.names, here, reader_sha256));
}

std::string Conditions::refusal() const {
  const std::string id = reading.plugin();
  return id.empty() ? "" : fmt::format("a plugin ({}) read its names, which no leaderboard ranks", id);
}

std::string Conditions::why_not_ranked(const Track& track) const {
  return none() || track.names_read ? "" : "names read from pictures";
}

std::vector<std::pair<std::string, std::string>> Conditions::values() const {
  return {{"names", reading.names}, {"segments", reading.segments}};
}

std::vector<std::string> Conditions::arguments(const Track& track) const {
  if (none() && !track.names_read) return {};
  return {"--names", reading.names, "--segments", reading.segments};
}

std::vector<std::string> Conditions::parts() const {
  std::vector<std::string> all;
  for (const auto& [name, value] : values())
    if (value != Reading::simulator) all.push_back(name + "=" + value);
  return all;
}

}  // namespace lgabench::leaderboard
