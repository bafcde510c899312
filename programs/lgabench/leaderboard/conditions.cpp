#include <lgabench/leaderboard/conditions.hpp>

#include <fmt/format.h>

#include <lgabench/harness/expand.hpp>
#include <lgabench/leaderboard/fields.hpp>
#include <lgabench/leaderboard/tracks.hpp>

namespace lgabench::leaderboard {

// They stand among an identity's own members, which has none where they are the suite's.
void fields(Conditions& conditions, Fields& field) {
  Reading& reading = conditions.reading;
  const JsonReader* const reader = field.reading();
  const bool read = reader ? reader->has("names") : reading.names != Reading::simulator;
  field("names", reading.names, when(read));
  field("reader", conditions.reader_sha256, Form{read, read});
  field("segments", reading.segments, segments_form(reading));
  if (!reader || !read) return;
  if (!is_id(reading.names)) reader->at("names").fail("an id of letters, digits, _ and -");
  read_sha256(reader->at("reader"));
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
