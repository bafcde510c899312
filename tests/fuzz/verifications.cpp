// Lines of verifications.jsonl that somebody sends for another's entry, as claims, and as if they were vouched for.
#include <algorithm>

#include <lgabench/leaderboard/pages.hpp>
#include <lgabench/leaderboard/verification.hpp>

#include "../unit/programs/leaderboard_board.hpp"
#include "fuzz.hpp"

namespace {

using namespace lgabench;
using namespace lgabench::leaderboard;

// As fresh_estimates() needs them: of each cell and arm a count of successes.
bool has_counts(const Json& line, const Entry& entry) {
  const Json all = line.value("successes", Json());
  const std::vector<std::size_t> cells = fresh_cells(entry, line.at("nonce"));
  if (!all.is_array() || all.size() != cells.size()) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& arms = entry.cells[cells[i]].outcomes;
    if (!all[i].is_object() || all[i].size() != arms.size()) return false;
    for (const auto& arm : arms) {
      const Json count = all[i].value(arm.first, Json());
      if (!count.is_number_integer() || count < 0 || count > arm.second.size()) return false;
    }
  }
  return true;
}

// What follows from a line's nonce and counts, as an honest writer has it: what lies behind these checks is reached.
void put_right(Json& line, const Entry& entry) {
  const std::string nonce =
      line.is_object() && line.contains("nonce") && line["nonce"].is_string() ? line["nonce"] : "";
  if (nonce.size() != 32 || !line.contains("cells") || !line["cells"].is_array()) return;
  const bool fresh = line.contains("kind") && line["kind"] == "fresh";
  const std::size_t cells = std::min(line["cells"].size(), entry.cells.size());
  line["cells"] = Json::array();
  int episodes = 0;
  for (const std::size_t i : fresh ? fresh_cells(entry, nonce) : chosen_cells(entry, entry.hash(), nonce, cells)) {
    line["cells"].push_back(entry.cells[i].key);
    episodes += entry.cells[i].episodes();
  }
  line["episodes"] = episodes;
  if (!fresh || !has_counts(line, entry)) return;
  const std::vector<FreshEstimate> estimates = fresh_estimates(entry, {&line});
  line["passed"] = std::none_of(estimates.begin(), estimates.end(), [](const auto& one) { return one.differs(); });
  const FreshEstimate& mean = estimates.back();
  line.update({{"difference", mean.difference}, {"low", mean.low}, {"high", mean.high}});
}

// Of a method that learns, with two test arms in one of two scenarios.
Entry made() {
  Setting setting = small_setting();
  setting.episodes = 10;
  setting.seeds = {0, 1};
  setting.demonstrations = {10};
  return made_entry(setting, "lga", .5);
}

// As the board shows its lines, and its pages too where that is asked for.
void look_at(const fs::path& board, const Entry& entry, bool at_pages) {
  to_string(entry.tier());
  entry.replay_differed();
  entry.fresh();
  claims(entry);
  if (at_pages) made_files(board, {entry}, {});
}

// What read_entry() does with them, whose other files are always the same.
void add_lines(Entry& entry, const std::string& lines) {
  int number = 0;
  const std::string hash = entry.hash();
  for (const Json& line : parse_json_lines(lines, "verifications.jsonl")) {
    expect_verification(JsonReader(line, fmt::format("verifications.jsonl: line {}", ++number)), entry, hash);
    entry.verifications.push_back(line);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fs::path board = fuzz::directory() / "verified";
  static Entry entry = made();
  static const std::string hash = entry.hash();
  const std::string_view text = fuzz::text_of(data, size);
  const bool whole = fuzz::takes_long(text);
  entry.verifications.clear();
  std::string lines;
  static const std::string rest = entry.rest_hash();
  Vouched all{{}, {{hash, rest}}, {}};
  for (const std::string_view line : fuzz::split(text, "\n")) {
    if (line.empty()) continue;
    Json json = json_or_null(line);
    put_right(json, entry);
    if (json.is_object()) all.lines[hash].insert(line_hash(json));
    lines += (json.is_object() ? canonical(json) : std::string(line)) + "\n";
  }
  try {
    add_lines(entry, lines);
    for (const auto& vouched : {std::set<std::string>(), all.lines[hash]}) {
      entry.vouched = vouched;
      look_at(board, entry, whole);
    }
  } catch (const InputError&) {
  }
  if (!whole) return 0;
  static const bool written [[maybe_unused]] = (write_entry(board, made()), true);
  fuzz::write(board / entry.place() / "verifications.jsonl", lines);
  try {
    read_entry(board, entry.place(), &all);
  } catch (const InputError&) {
  }
  return 0;
}
