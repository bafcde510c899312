#include <lgabench/leaderboard/entry.hpp>

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/leaderboard/fields.hpp>
#include <lgabench/leaderboard/fresh_commands.hpp>
#include <lgabench/leaderboard/said.hpp>
#include <lgabench/leaderboard/verification.hpp>
#include <lgabench/plugin/loader.hpp>

namespace lgabench::leaderboard {
namespace {

Json entry_json(const Entry& entry) {
  Json json{{"id", entry.id()},          {"identity", to_json(entry.identity)}, {"preset", to_json(entry.setting)},
            {"about", entry.about},      {"failures", entry.failures},          {"phi", entry.phi},
            {"evidence", entry.evidence}};
  if (!entry.score.is_null()) json["score"] = entry.score;
  if (!entry.withdrawn.is_null()) json["withdrawn"] = entry.withdrawn;
  if (!entry.supersedes.empty()) json["supersedes"] = entry.supersedes;
  return json;
}

}  // namespace

// An entry's id is a hash of these bytes: what is new is written only where it is set.
void fields(Identity& identity, Fields& field) {
  Competitor& row = identity.row;
  field("method", row.id);
  field("kind", row.kind, one_of(competitor_kinds));
  field("version", row.version);
  field("options", row.options, object());
  field("acts", row.acts, when(row.acts.has_value()));
  field("asks", row.asks, when(!row.asks.empty()));
  field("answers", [&](Fields& answers) {
    answers("source", identity.answers);
    answers("sha256", identity.answers_sha256);
  });
  field("engine", [&](Fields& engine) {
    engine("id", identity.engine);
    engine("version", identity.engine_version);
  });
  fields(identity.conditions, field);
  field("preset", identity.preset_sha256);
  field("scene_seed", identity.scene_seed);
  if (field.reading()) row.name = row.own_name();
}

Json to_json(const Identity& identity) { return json_of(identity); }

fs::path answers_file(const Identity& identity) {
  const std::string ending = kept_ending(identity.answers);
  return ending.empty() ? fs::path() : fs::path("answers") / (identity.answers_sha256 + ending);
}

bool is_id(const std::string& text) {
  return !text.empty() && text.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789_-") == std::string::npos;
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

void fields(PlayedCell& cell, Fields& field) {
  constexpr double most = 1e15;  // of questions, tokens, seconds
  Json outcomes(cell.outcomes);  // read by the arms of the entry: read_entry()
  field("key", cell.key);
  field("scenario", cell.place.scenario);
  field("layout", cell.place.layout);
  field("demonstrations", cell.place.demonstrations);
  field("training_seed", cell.place.seed);
  field("outcomes", outcomes, object());
  field("failed", cell.failed, when(!cell.failed.empty()));
  field("scenes", cell.scenes, when(cell.failed.empty()));
  field("digest", cell.digest, when(cell.failed.empty()));
  field("phi", cell.phi, when(cell.phi > 0));
  field("lm_queries", cell.lm_queries, up_to(most));
  field("lm_tokens", cell.lm_tokens, up_to(most));
  field("human_seconds", cell.human_seconds, up_to(most));
  field("learn_s", cell.learn_s, up_to(most));
  field("total_s", cell.total_s, up_to(most));
  field("steps", cell.steps);
}

Json to_json(const PlayedCell& cell) { return json_of(cell); }

std::string to_string(Tier tier) {
  constexpr const char* words[] = {"recomputed", "replayed", "reproduced"};
  return words[static_cast<int>(tier)];
}

// Only the run that the entry was made from: whoever adds evidence changes nobody's tier.
Tier tier_of(const Entry& entry, const Json& line) {
  const Json& first = entry.evidence.front();
  const bool elsewhere = first.at("by") != line.at("by") && first.at("machine") != line.at("machine");
  return elsewhere ? Tier::reproduced : Tier::replayed;
}

fs::path Entry::place() const {
  const std::string& method = identity.row.id;
  if (!is_id(method))
    throw InputError(fmt::format("method \"{}\": expected an id of letters, digits, _ and -", method));
  return fs::path("entries") / method / id() / setting.name();
}

std::string Entry::hash() const { return sha256(id() + "\n" + cells_text(*this)); }

std::string Entry::rest_hash() const {
  Json json = entry_json(*this);
  json["evidence"] = Json::array({evidence.front()});
  json.erase("withdrawn");
  return sha256(canonical(json));
}

Processor Entry::processor() const {
  Processor first = read_processor(JsonReader(evidence.front().at("machine"), "entry.json", "/evidence/0/machine"));
  if (first.instructions.empty() && !inferred_instructions.empty()) {
    first.instructions = inferred_instructions;
    first.inferred = true;
  }
  return first;
}

bool Entry::has_answers_as_submitted() const {
  return !identity.row.is_reference() && std::holds_alternative<FileAnswers>(identity.answers);
}

bool Entry::was_replayed() const {
  return std::any_of(verifications.begin(), verifications.end(),
                     [this](const Json& line) { return line.at("kind") == "replay" && counts(line); });
}

bool Entry::replay_differed() const {
  return std::any_of(verifications.begin(), verifications.end(), [this](const Json& line) {
    return line.at("kind") == "replay" && counts(line) && !line.at("passed").get<bool>();
  });
}

Tier Entry::tier() const {
  Tier tier = Tier::recomputed;
  if (replay_differed()) return tier;
  for (const Json& line : verifications)
    if (line.at("kind") == "replay" && counts(line)) tier = std::max(tier, tier_of(*this, line));
  return tier;
}

int Entry::fresh() const {
  std::vector<const Json*> lines;
  for (const Json& line : verifications)
    if (line.at("kind") == "fresh" && line.contains("successes") && counts(line)) lines.push_back(&line);
  if (lines.empty()) return 0;
  const std::vector<FreshEstimate> estimates = fresh_estimates(*this, lines);
  return std::any_of(estimates.begin(), estimates.end(), [](const auto& one) { return one.differs(); }) ? -1 : 1;
}

int Entry::fresh_commands() const {
  std::vector<const Json*> lines;
  for (const Json& line : verifications)
    if (line.at("kind") == "commands" && counts(line)) lines.push_back(&line);
  return lines.empty() ? 0 : knows_fresh_commands(lines) ? 1 : -1;
}

std::string Entry::spec() const {
  std::string text = identity.row.own_name();
  for (const auto& [option, value] : identity.row.options.items())
    text += fmt::format("+{}={}", option, option_text(value));
  return text;
}

// Directories so many levels below one of the board's, sorted; none where it is not there.
static std::vector<fs::path> directories_below(const fs::path& board, const fs::path& root, int levels) {
  std::vector<fs::path> all{root};
  if (!fs::exists(board / root)) return {};
  for (; levels > 0; --levels) {
    std::vector<fs::path> below;
    for (const fs::path& directory : all) {
      expect_plain_entries(board / directory);
      for (const auto& entry : fs::directory_iterator(board / directory)) {
        if (!entry.is_directory())
          throw InputError(fmt::format("{}: expected only directories here", entry.path().string()));
        below.push_back(directory / entry.path().filename());
      }
    }
    all = std::move(below);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<fs::path> entry_directories(const fs::path& board) { return directories_below(board, "entries", 3); }

std::vector<fs::path> superseded_directories(const fs::path& board) {
  return directories_below(board, superseded_directory, 2);
}

bool is_reason(const std::string& text) {
  return !text.empty() && text.size() <= longest_reason && one_line(text) == text;
}

fs::path superseded_place(const std::string& id, const std::string& hash) {
  return fs::path(superseded_directory) / id / hash.substr(0, 16);
}

std::vector<Entry> read_entries(const fs::path& board, const OnProgress& on_progress) {
  std::vector<Entry> all;
  const Vouched vouched = read_vouched(board);
  const std::vector<fs::path> directories = entry_directories(board);
  for (const fs::path& directory : directories) {
    all.push_back(read_entry(board, directory, &vouched));
    if (on_progress) on_progress("read", all.size(), directories.size(), "entries");
  }
  return all;
}

std::vector<fs::path> other_answers(const fs::path& board, const std::vector<Entry>& entries) {
  std::set<fs::path> named;
  for (const Entry& entry : entries) named.insert(answers_file(entry.identity));
  std::vector<fs::path> others;
  if (fs::is_symlink(board / "answers")) return others;  // nobody's files of another place
  std::error_code none_there;
  for (const auto& file : fs::directory_iterator(board / "answers", none_there))
    if (const fs::path kept = "answers" / file.path().filename(); file.is_symlink() || named.count(kept) == 0)
      others.push_back(kept);
  return others;
}

std::string entry_text(const Entry& entry) { return text_of_entry(shortened(entry_json(entry))); }

std::string long_entry_text(const Entry& entry) { return text_of_entry(entry_json(entry)); }

std::string cells_text(const Entry& entry) {
  std::string text;
  for (const PlayedCell& cell : entry.cells) text += canonical(to_json(cell)) + "\n";
  return text;
}

BoardWriter::BoardWriter(const fs::path& board) : adding_(board / adding_directory) {
  const fs::path entries = board / "entries";
  std::error_code error;
  fs::create_directories(entries, error);
  lock_ = Descriptor{::open(entries.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (lock_.fd < 0) throw InputError(fmt::format("{}: cannot be written: {}", entries.string(), std::strerror(errno)));
  wait_for_lock(lock_.fd, Lock::exclusive, entries);
  remove_temporaries(board);
  fs::remove_all(adding_, error);
}

BoardWriter::~BoardWriter() {
  std::error_code error;
  fs::remove_all(adding_, error);
}

void write_entry(const fs::path& board, const Entry& entry, const std::vector<AnswerFile>& answers) {
  const BoardWriter writer(board);
  const fs::path place = board / entry.place(), adding = board / adding_directory, staged = adding / entry.place();
  keep_answers(answers, adding);
  write_file(staged / "cells.jsonl", cells_text(entry));
  write_file(staged / "entry.json", entry_text(entry));
  const auto move = [](const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_directories(to.parent_path(), error);
    if (!error) fs::rename(from, to, error);
    if (error) throw InputError(fmt::format("{}: cannot be written: {}", to.string(), error.message()));
  };
  for (const AnswerFile& file : answers) move(adding / "answers" / file.name, board / "answers" / file.name);
  if (!fs::exists(place)) return move(staged, place);
  for (const char* file : {"cells.jsonl", "entry.json"}) move(staged / file, place / file);
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
  write_entry(board, entry);
}

std::vector<std::size_t> chosen_cells(const Entry& entry, const std::string& hash, const std::string& nonce,
                                      std::size_t cells) {
  std::vector<std::pair<std::string, std::size_t>> order;
  for (std::size_t i = 0; i < entry.cells.size(); ++i) order.emplace_back(sha256(hash + nonce + entry.cells[i].key), i);
  std::sort(order.begin(), order.end());
  order.resize(std::min(cells, order.size()));
  std::vector<std::size_t> chosen;
  for (const auto& item : order) chosen.push_back(item.second);
  return chosen;
}

}  // namespace lgabench::leaderboard
