// An entry of the leaderboard: one row of a table, as files (docs/formats): entries/METHOD/ID/SUITE-PRESET/.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/harness/answers.hpp>
#include <lgabench/leaderboard/conditions.hpp>
#include <lgabench/leaderboard/setting.hpp>
#include <lgabench/leaderboard/vouched.hpp>
#include <lgabench/record/outcome.hpp>
#include <lgabench/record/processor.hpp>

namespace lgabench::leaderboard {

/// What an entry is, whoever computed it: two with the same parts are one entry.
struct Identity {
  Competitor row;  // its name is its id
  AnswerSource answers;
  std::string answers_sha256;  // of what they are
  std::string engine, engine_version;
  std::string preset_sha256;  // hash(setting)
  std::uint64_t scene_seed = 0;
  Conditions conditions{};
};
Json to_json(const Identity& identity);
/// The board's copy of the answers that a row is based on, answers/SHA256.ENDING, relative to the board; "" where they
/// are shipped, or there are none.
fs::path answers_file(const Identity& identity);
/// Letters, digits, _ and -: an id that may stand in a path.
bool is_id(const std::string& text);
/// @throws InputError for what is not 64 hexadecimal digits.
std::string read_sha256(const JsonReader& reader);
/// The first 16 digits of the SHA-256 of its canonical JSON.
std::string id_of(const Identity& identity);

/// One cell's line of cells.jsonl.
struct PlayedCell {
  Place place;
  std::string key;                              // of the cell in a run of this row alone
  std::string scenes;                           // SHA-256 over the hashes of its test scenes; "" where it failed
  std::string digest;                           // SHA-256 over its results, selection to episodes; "" where it failed
  std::string failed;                           // why the method failed it; "" where it did not
  std::map<std::string, std::string> outcomes;  // of each arm a character an episode
  std::size_t phi = 0;                          // index of its Selections among its scenario's
  double lm_queries = 0, lm_tokens = 0, human_seconds = 0;  // over its commands
  double learn_s = 0, total_s = 0;
  long long steps = 0;  // of the optimiser

  int episodes() const;
  int successes() const;
};
Json to_json(const PlayedCell& cell);

/// How many cells a replay plays, unless the entry has fewer: 30 find 10 % falsified ones in 96 of 100 cases.
constexpr std::size_t enough_cells = 30;

/// Called with how many of so many steps are done, in words: "read 3 of 352 entries".
using OnProgress = std::function<void(const char* what, std::size_t done, std::size_t of, const char* things)>;
/// Whether a text may say why an entry took another's place: 1 to longest_reason bytes in one line.
bool is_reason(const std::string& text);
constexpr std::size_t longest_reason = 500;

/// Where an entry lies once another has taken its place, relative to the board: superseded/ID/, and the first 16 digits
/// of its Entry::hash().
fs::path superseded_place(const std::string& id, const std::string& hash);

/// How far an entry was checked.
enum class Tier { recomputed, replayed, reproduced };
std::string to_string(Tier tier);

struct Entry {
  Identity identity;
  Setting setting;
  std::vector<PlayedCell> cells;       // one for each of the setting's places, in their order
  Json about;                          // what its authors say
  Json phi = Json::object();           // scenario -> lists of its commands' Selections, distinct ones
  std::vector<std::string> failures;   // what the letters from 'a' on mean
  Json evidence = Json::array();       // who computed it with what
  Json score;                          // of its answers without a policy, score_of_answers(); null where it has none
  Json withdrawn;                      // {"when", "reason"}, or null
  Json supersedes = Json::array();     // {"hash", "when", "reason"} of each entry whose place it took, the first first
  Json verifications = Json::array();  // lines of verifications.jsonl
  std::set<std::string> vouched;       // hashes of those of its lines that count; see vouched.hpp
  std::string inferred_instructions;   // of its processor, by the maintainers; "" where they say nothing

  std::string id() const { return id_of(identity); }
  /// entries/METHOD/ID/SUITE-PRESET, relative to the board. @throws InputError for a method's id that could lead
  /// elsewhere.
  fs::path place() const;
  /// SHA-256 over id and cells: what a nonce is drawn against.
  std::string hash() const;
  /// SHA-256 of what it says beside its cells: entry.json in its long form, with its first evidence alone and without
  /// /withdrawn, as canonical JSON. Nothing of that changes.
  std::string rest_hash() const;
  /// The processor of the machine that computed it first.
  Processor processor() const;
  /// Whether the maintainers vouch for the line.
  bool counts(const Json& line) const { return !vouched.empty() && vouched.count(line_hash(line)) > 0; }
  bool is_withdrawn() const { return !withdrawn.is_null() && counts(withdrawn); }
  /// Whether a method's answers are a file that its authors wrote: whoever gave them cannot be asked again.
  bool has_answers_as_submitted() const;
  /// Whether a replay counts, whatever it found.
  bool was_replayed() const;
  /// What replays that count make it; one that differs is not outvoted.
  Tier tier() const;
  bool replay_differed() const;
  /// What verifications on fresh scenes that count found, all together (fresh_estimates()): -1 where success differs in
  /// an arm or over all; else 1; 0 where none was made.
  int fresh() const;
  /// What drawn commands that count found, all together (knows_fresh_commands()): likewise.
  int fresh_commands() const;
  /// The row's id, and the options in which the preset would set it otherwise: what --methods takes.
  std::string spec() const;
};

/// The tier that a replay gives its entry if it passed.
Tier tier_of(const Entry& entry, const Json& line);

/// Reads and checks an entry's directory: schema, identity, completeness, letters. `vouched` says which of its lines
/// count; without it none does. @throws InputError with the file and the first place that is not as docs/formats says,
/// and, with `vouched`, for more than most_claims lines that nobody vouches for.
Entry read_entry(const fs::path& board, const fs::path& directory, const Vouched* vouched = nullptr);
/// So many of an entry's verifications may be vouched for by nobody: anybody may append some, and each is checked.
constexpr std::size_t most_claims = 100;
/// What an entry that another one took the place of says, where superseded_place() says.
Entry read_superseded(const fs::path& board, const fs::path& directory);
/// Directories of all entries, sorted, relative to the board. @throws InputError for what is neither file nor
/// directory.
std::vector<fs::path> entry_directories(const fs::path& board);
/// Directories of what entries took the place of, superseded/ID/HASH. @throws as entry_directories().
std::vector<fs::path> superseded_directories(const fs::path& board);
/// All entries, with what the board's vouched.json says. @throws InputError as read_entry().
std::vector<Entry> read_entries(const fs::path& board, const OnProgress& on_progress = {});

/// What lies in answers/ and no entry names, or is a link, relative to the board: nobody would ever read it.
std::vector<fs::path> other_answers(const fs::path& board, const std::vector<Entry>& entries);

/// What authors say of their rows, from a file. @throws InputError for what is not as docs/formats says.
Json read_about(const fs::path& file);

/// What an entry's directory may hold, and nothing else.
inline constexpr std::array entry_files{"entry.json", "cells.jsonl", "verifications.jsonl"};
/// entry.json and cells.jsonl, as text. Entries of 0.4 and earlier have the long form (said.hpp).
std::string entry_text(const Entry& entry);
std::string long_entry_text(const Entry& entry);
std::string cells_text(const Entry& entry);
/// Where entries are written before they get their place in a board.
inline constexpr const char* adding_directory = ".adding";
/// Where they lie when others have taken their place.
inline constexpr const char* superseded_directory = "superseded";
/// Held by whoever changes files of a board, which one process does at a time. What a killed one left is gone: its
/// temporaries, and what it was about to add. @throws InputError where the board cannot be made or read.
class BoardWriter {
 public:
  explicit BoardWriter(const fs::path& board);
  ~BoardWriter();
  BoardWriter(const BoardWriter&) = delete;
  BoardWriter& operator=(const BoardWriter&) = delete;

 private:
  fs::path adding_;
  Descriptor lock_;
};

/// Writes entry.json and cells.jsonl, and before them the answers that they name: a new entry is there with both files
/// or not at all. Verifications are appended by add_verification() alone. @throws InputError
void write_entry(const fs::path& board, const Entry& entry, const std::vector<AnswerFile>& answers = {});
void add_verification(const fs::path& board, const Entry& entry, const Json& verification);

/// The entry of that directory or id. @throws InputError where there is none, or several.
fs::path find_entry(const fs::path& board, const std::string& name);
/// Marks the entry as withdrawn; its files remain. @throws InputError as find_entry(), and for one that was before.
void withdraw(const fs::path& board, const std::string& name, const std::string& reason, const std::string& when);

/// The `cells` places that a nonce (32 hexadecimal digits) chooses: those with the smallest SHA-256 of the entry's
/// hash, the nonce and the cell's key. `hash`: the entry's, which takes longer to make than the choice.
std::vector<std::size_t> chosen_cells(const Entry& entry, const std::string& hash, const std::string& nonce,
                                      std::size_t cells);

}  // namespace lgabench::leaderboard
