// An entry's files, read and checked into a value: what somebody sent is untrusted.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <optional>

#include <lgabench/abstraction/quality.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/leaderboard/answer_score.hpp>
#include <lgabench/leaderboard/fields.hpp>
#include <lgabench/leaderboard/labels.hpp>
#include <lgabench/leaderboard/said.hpp>
#include <lgabench/leaderboard/verification.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench::leaderboard {
namespace {

constexpr std::uintmax_t most_bytes = 16 << 20;

// Reads a file of an entry's cells or verifications; the largest published one has 130 kB.
std::string read_bounded(const fs::path& file) { return read_file(file, Links::refused, most_bytes); }

void expect_time(const JsonReader& reader) {
  const std::string text = reader.string();
  std::tm time{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &time);
  if (end == nullptr || *end != '\0' || text.size() != 20) reader.fail("a time, as 2026-01-31T12:00:00Z");
}

Identity read_identity(const JsonReader& reader) {
  const Identity identity = value_of<Identity>(reader);
  if (!is_id(identity.engine)) reader.at("engine").at("id").fail("an id of letters, digits, _ and -");
  read_sha256(reader.at("answers").at("sha256"));
  read_sha256(reader.at("preset"));
  return identity;
}

PlayedCell read_cell_line(const JsonReader& reader, const Entry& entry) {
  PlayedCell cell = value_of<PlayedCell>(reader);
  if (!is_cell_key(cell.key)) reader.at("key").fail("16 hexadecimal digits");
  for (const char* hash : {"scenes", "digest"})
    if (cell.failed.empty()) read_sha256(reader.at(hash));
  const JsonReader outcomes = reader.at("outcomes");
  const std::vector<std::string>& arms = entry.setting.scenario(cell.place.scenario).arms;
  outcomes.only(arms);
  for (const std::string& arm : arms) {
    const JsonReader letters = outcomes.at(arm);
    const std::string text = letters.string();
    if (text.size() != static_cast<std::size_t>(entry.setting.episodes))
      letters.fail(fmt::format("{} letters, one an episode", entry.setting.episodes));
    for (const char c : text)
      if (!cell.failed.empty() && c != failed_cell_letter)
        letters.fail("\"!\" of a failed cell");
      else if (cell.failed.empty() && !read_entry_letter(c, entry.failures))
        letters.fail("\".\", or the letter of a failure");
    cell.outcomes[arm] = text;
  }
  if (const auto phis = entry.phi.find(cell.place.scenario); reader.has("phi"))
    reader.at("phi").integer(0, phis == entry.phi.end() ? 0 : static_cast<long long>(phis->size()) - 1);
  return cell;
}

void expect_about(const JsonReader& about) {
  about.only({"authors", "license", "source", "by", "answers", "note", "label"});
  if (about.at("authors").strings().empty()) about.at("authors").fail("at least one name");
  for (const char* text : {"license", "by"})
    if (about.at(text).string().empty()) about.at(text).fail("a text");
  for (const char* text : {"answers", "note"})
    if (about.has(text)) about.at(text).string();
  if (about.has("label")) {
    const std::string label = about.at("label").string();
    if (label.empty() || label.size() > longest_label || one_line(label) != label)
      about.at("label").fail(fmt::format("1 to {} characters in one line", longest_label));
  }
  const JsonReader source = about.at("source");
  source.only({"repository", "commit", "file", "sha256"});
  if (source.has("repository")) {
    source.at("repository").string();
    const std::string commit = source.at("commit").string();
    if (commit.size() != 40 || commit.find_first_not_of("0123456789abcdef") != std::string::npos)
      source.at("commit").fail("40 hexadecimal digits");
  } else {
    source.at("file").string();
    read_sha256(source.at("sha256"));
  }
}

void expect_phi(const JsonReader& phi, const Setting& setting) {
  std::vector<std::string> scenarios;
  for (const Setting::Scenario& s : setting.scenarios) scenarios.push_back(s.id);
  phi.only(scenarios);
  for (const auto& scenario : phi.json().items()) {
    const std::vector<JsonReader> lists = phi.at(scenario.key()).elements();
    if (lists.empty()) phi.at(scenario.key()).fail("at least one list of Selections");
    for (const JsonReader& list : lists)
      for (const JsonReader& command : list.elements()) {
        command.at("utterance").string();
        command.at("selection").at("provenance").string();
        command.at("selection").at("target");
        read_quality(command.at("quality"));
      }
  }
}

void expect_evidence(const JsonReader& evidence) {
  if (evidence.elements().empty()) evidence.fail("at least one run");
  for (const JsonReader& one : evidence.elements()) {
    one.only({"by", "program", "version", "build", "plugins", "machine", "confinement", "started", "command", "data"});
    for (const char* text : {"by", "program", "version", "confinement", "command"}) one.at(text).string();
    expect_time(one.at("started"));
    read_processor(one.at("machine"));
    for (const JsonReader& plugin : one.at("plugins").elements())
      for (const char* text : {"kind", "id", "version", "sha256"}) plugin.at(text).string();
    for (const char* object : {"build", "data"})
      if (!one.at(object).json().is_object()) one.at(object).fail("an object");
  }
}

// A letter for each word, as many as there are.
std::vector<std::string> read_failures(const JsonReader& reader) {
  const std::vector<std::string> words = reader.strings();
  if (words.size() > most_failure_words) reader.fail(fmt::format("{} words at most", most_failure_words));
  return words;
}

Json read_supersedes(const JsonReader& reader) {
  if (reader.elements().empty()) reader.fail("at least one entry whose place this one took");
  for (const JsonReader& one : reader.elements()) {
    one.only({"hash", "when", "reason"});
    read_sha256(one.at("hash"));
    expect_date(one.at("when"));
    if (!is_reason(one.at("reason").string()))
      one.at("reason").fail(fmt::format("1 to {} bytes in one line", longest_reason));
  }
  return reader.json();
}

void expect_entry_files(const fs::path& path) {
  expect_plain_entries(path);
  for (const auto& file : fs::directory_iterator(path))
    if (!contains(entry_files, file.path().filename()))
      throw InputError(
          fmt::format("{}: expected only entry.json, cells.jsonl and verifications.jsonl here", file.path().string()));
}

void read_hashed(const JsonReader& reader, Entry& entry) {
  entry.identity = read_identity(reader.at("identity"));
  entry.setting = read_setting(reader.at("preset"));
  if (entry.identity.preset_sha256 != leaderboard::hash(entry.setting))
    reader.at("identity").at("preset").fail("the hash of /preset");
  if (entry.identity.scene_seed != entry.setting.scene_seed)
    reader.at("identity").at("scene_seed").fail("that of /preset");
  if (const std::string id = entry.id(); reader.at("id").string() != id)
    reader.at("id").fail(id + ", the hash of /identity");
}

// entry.json, without the cells that follow from it.
Entry read_head(const fs::path& file) {
  const std::string bytes = read_file(file, Links::refused, most_entry_bytes);
  const Json json = expanded(parse_json(bytes, file.string()), file.string());
  const JsonReader reader(json, file.string());
  reader.only({"id", "identity", "preset", "about", "failures", "phi", "score", "evidence", "withdrawn", "supersedes"});
  Entry entry;
  read_hashed(reader, entry);
  expect_about(reader.at("about"));
  entry.about = reader.at("about").json();
  entry.failures = read_failures(reader.at("failures"));
  expect_phi(reader.at("phi"), entry.setting);
  entry.phi = reader.at("phi").json();
  if (reader.has("score")) {
    expect_score(reader.at("score"), entry.setting);
    entry.score = reader.at("score").json();
  }
  expect_evidence(reader.at("evidence"));
  entry.evidence = reader.at("evidence").json();
  if (reader.has("withdrawn")) {
    for (const char* text : {"when", "reason"}) reader.at("withdrawn").at(text).string();
    entry.withdrawn = reader.at("withdrawn").json();
  }
  if (reader.has("supersedes")) entry.supersedes = read_supersedes(reader.at("supersedes"));
  if (entry_text(entry) != bytes && long_entry_text(entry) != bytes)
    throw InputError(fmt::format("{}: not as it is written", file.string()));
  return entry;
}

// cells.jsonl: those of the entry's setting, in its order.
void read_cells(const fs::path& lines, Entry& entry) {
  int number = 0;
  const std::vector<Place> places = entry.setting.places(learns(entry.identity.row));
  const std::string text = read_bounded(lines);
  for (const Json& line : parse_json_lines(text, lines.string())) {
    const JsonReader at(line, fmt::format("{}: line {}", lines.string(), ++number));
    entry.cells.push_back(read_cell_line(at, entry));
    const std::size_t i = entry.cells.size() - 1;
    if (i >= places.size() || !(places[i] == entry.cells[i].place))
      at.fail(i < places.size() ? "the cell " + places[i].text() : fmt::format("{} cells", places.size()));
  }
  if (entry.cells.size() < places.size())
    throw InputError(fmt::format("{}: expected {} cells, got {}; the next is {}", lines.string(), places.size(),
                                 entry.cells.size(), places[entry.cells.size()].text()));
  if (text != cells_text(entry)) throw InputError(fmt::format("{}: not as it is written", lines.string()));
}

// What the board's maintainers say of the entry.
void add_vouched(const Vouched& vouched, Entry& entry) {
  if (const auto inferred = vouched.instructions.find(entry.id()); inferred != vouched.instructions.end())
    entry.inferred_instructions = inferred->second;
  const std::string hash = entry.hash();
  const auto found = vouched.lines.find(hash);
  const auto rest = vouched.entries.find(hash);
  if (found != vouched.lines.end() && rest != vouched.entries.end() && rest->second == entry.rest_hash())
    entry.vouched = found->second;
}

// verifications.jsonl; `most`: of lines that no maintainer vouches for.
void read_verifications(const fs::path& checks, std::optional<std::size_t> most, Entry& entry) {
  if (!fs::exists(checks)) return;
  const std::vector<Json> verifications = parse_json_lines(read_bounded(checks), checks.string());
  const auto claims = std::count_if(verifications.begin(), verifications.end(),
                                    [&entry](const Json& line) { return !entry.counts(line); });
  if (most && static_cast<std::size_t>(claims) > *most)
    throw InputError(fmt::format("{}: expected at most {} lines that no maintainer vouches for, got {}",
                                 checks.string(), *most, claims));
  int number = 0;
  const std::string hash = entry.hash();
  for (const Json& line : verifications) {
    expect_verification(JsonReader(line, fmt::format("{}: line {}", checks.string(), ++number)), entry, hash);
    entry.verifications.push_back(line);
  }
}

// Wherever it lies.
Entry read_files(const fs::path& path, const Vouched* vouched) {
  expect_entry_files(path);
  Entry entry = read_head(path / "entry.json");
  read_cells(path / "cells.jsonl", entry);
  if (vouched != nullptr) add_vouched(*vouched, entry);
  read_verifications(path / "verifications.jsonl", vouched != nullptr ? std::optional(most_claims) : std::nullopt,
                     entry);
  return entry;
}

void expect_at(const fs::path& board, const fs::path& directory, const fs::path& place) {
  if (directory != place)
    throw InputError(fmt::format("{}: expected at {}, by what it is", (board / directory).string(), place.string()));
}

}  // namespace

std::string read_sha256(const JsonReader& reader) {
  const std::string text = reader.string();
  if (text.size() != 64 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
    reader.fail("64 hexadecimal digits");
  return text;
}

Entry read_entry(const fs::path& board, const fs::path& directory, const Vouched* vouched) {
  Entry entry = read_files(board / directory, vouched);
  expect_at(board, directory, entry.place());
  return entry;
}

Entry read_superseded(const fs::path& board, const fs::path& directory) {
  Entry entry = read_files(board / directory, nullptr);
  expect_at(board, directory, superseded_place(entry.id(), entry.hash()));
  return entry;
}

Json read_about(const fs::path& file) {
  Json about = read_json(file);
  expect_about(JsonReader(about, file.string()));
  return about;
}

}  // namespace lgabench::leaderboard
