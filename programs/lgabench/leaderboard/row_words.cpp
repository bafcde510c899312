// What pages say of an entry and of its place, and what the words mean.
#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/rounding.hpp>
#include <lgabench/leaderboard/suite_page.hpp>
#include <lgabench/leaderboard/units.hpp>
#include <lgabench/leaderboard/verification.hpp>
#include <lgabench/record/reference_rows.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/tables.hpp>

namespace lgabench::leaderboard {
namespace {

using document::Grid;
using document::Paragraph;
using document::reading;
using document::Section;
using document::Span;
using document::TableCell;

constexpr int score_digits = 3;
constexpr std::size_t date_digits = 10;  // of "2026-11-25T11:31:07Z"

}  // namespace

std::string computed_on(const Entry& entry) {
  return entry.evidence.front().at("started").get<std::string>().substr(0, date_digits);
}

std::string replayed_on(const Entry& entry) {
  std::string last;
  for (const Json& line : entry.verifications)
    if (entry.counts(line)) last = std::max(last, line.at("when").get<std::string>().substr(0, date_digits));
  return last;
}

Span by_span(const Entry& entry) { return Span(entry.about.at("by").get<std::string>()); }

Span id_span(const Entry& entry) {
  Span span = Span::link(entry.id(), (entry.place() / "entry.json").string());
  span.emphasis = document::Emphasis::code;
  return span;
}

// Addresses of commits are known of three hosts; of another the repository's is.
Span source_span(const Entry& entry) {
  const Json& source = entry.about.at("source");
  if (!source.contains("repository")) {
    Span file(source.at("file").get<std::string>(), document::Emphasis::code);
    file.title = file.text + ", SHA-256 " + source.at("sha256").get<std::string>();
    return file;
  }
  const std::string repository = source.at("repository"), commit = source.at("commit");
  Span span(commit.substr(0, 8), document::Emphasis::code);
  span.title = repository + " @ " + commit;
  if (repository.rfind("https://", 0) != 0) return span;
  span.url = repository;
  for (const char* host : {"https://github.com/", "https://gitlab.com/", "https://codeberg.org/"})
    if (repository.rfind(host, 0) == 0) span.url += "/commit/" + commit;
  return span;
}

bool is_paired(const std::vector<NamedTable>& tables) {
  return std::any_of(tables.begin(), tables.end(), [](const NamedTable& table) { return table.setting.paired(); });
}

std::string what_was_played(const Setting& setting) {
  const auto presets = statistics::about_suite(setting.suite).presets;
  const auto found = presets.find(setting.preset);
  return fmt::format(
      "{}{} scenarios, {} demonstrations, {} training seed{}, {} test scenes of each arm and {}; scene seed {}.{}",
      found == presets.end() ? "" : found->second + " ", setting.scenarios.size(),
      fmt::join(setting.demonstrations, ", "), setting.seeds.size(), setting.seeds.size() == 1 ? "" : "s",
      setting.episodes, setting.test_scenes == TestScenes::per_seed ? "training seed" : "scenario", setting.scene_seed,
      setting.paired() ? " " + words_of_success(setting) : "");
}

std::string rank_text(const Standing& standing) { return standing.rank ? std::to_string(*standing.rank) : "–"; }

Span rank_span(const Standing& standing) {
  Span span = Span::number(rank_text(standing));
  if (!standing.rank) span.title = "no rank: " + standing.not_ranked;
  return span;
}

std::string tier_and_marks(const Standing& s) {
  std::vector<std::string> words{to_string(s.entry->tier())};
  if (!s.not_ranked.empty()) words.push_back(s.not_ranked);
  for (std::string& mark : marks_of(*s.entry, s.not_ranked.empty()))
    if (mark != s.not_ranked) words.push_back(std::move(mark));
  return fmt::format("{}", fmt::join(words, "; "));
}

std::string score_text(double score) { return fixed(score, score_digits); }

std::string interval_text(const Standing& s) {
  return fmt::format("[{}, {}]", fixed(s.interval.low, score_digits), fixed(s.interval.high, score_digits));
}

std::string score_text(const Standing& standing) { return score_text(standing.score) + " " + interval_text(standing); }

Span below_random_mark() {
  const RowMark& mark = *find_reference_row(random_object)->below_it;
  Span span(mark.sign);
  span.title = mark.meaning;
  return span;
}

std::optional<Paragraph> below_random_note(const std::vector<NamedStanding>& standings) {
  if (std::none_of(standings.begin(), standings.end(), [](const Standing& s) { return s.below_random; })) return {};
  const Span mark = below_random_mark();
  return Paragraph{{mark, " " + mark.title + "."}};
}

std::optional<Grid> waiting_grid(const NamedTable& table) {
  if (table.waiting.empty()) return {};
  Grid grid = grid_of(table, "_waiting", title_of(table) + ", not yet replayed");
  for (const NamedStanding& s : table.waiting) {
    add_row(grid, s);
    put(grid, "not yet replayed", 'l', Span(s.label));
    put(grid, "policy", 'l', Span(s.policy));
    put(grid, "claimed " + success_word(table.setting), 'r', Span::number(score_text(s.score)));
    put(grid, "known", 'l', Span(tier_and_marks(s)));
    put(grid, "by", 'l', by_span(*s.entry));
    put(grid, "id", 'l', id_span(*s.entry));
  }
  return grid;
}

Section words_of_the_board() {
  Section section{"words", "What the words mean"};
  std::vector<std::pair<std::string, std::string>> words{
      {"rank",
       "1 plus the number of entries that are significantly better (paired test on these scenes, Holm’s "
       "correction) in this ranking, and never less than the rank of an entry with more success. Entries "
       "of one rank are not known to differ, which does not mean that they perform equally. All rows count, also "
       "those that a page hides at first."},
      {"–", "no rank: a reference, or a row that the column \"known\" gives a reason for."},
      {"any policy, paper’s network, answers only",
       "three rankings. Any policy: all that learns and acts. Paper’s network: only methods that learn as the paper "
       "does. Answers only: one policy for all, so that rows differ in what is selected alone."},
      {"policy",
       "what learns to act: the paper’s network; a heat map of places, which is trained; the centroid of "
       "the mask, which is not; or the method’s own."},
      {"φ̂",
       "what a method selects as what matters. Precision: the share of it that is right. Recall: the share of "
       "what is right that it has."},
      {"reference",
       "not methods: the same action everywhere, any visible object, the expert that demonstrates. "
       "They stand where their success puts them, and have no rank."},
      {"§", "below the random visible object, which needs no demonstration."},
      {"[0.51, 0.57]", "a 95 % interval."},
      {"recomputed", "the numbers follow from the entry’s files; nothing was played again."},
      {"replayed",
       "a maintainer’s build played some of its cells again, chosen by bits drawn after it was written, "
       "and got the same."},
      {"reproduced", "so did another person, on another machine."},
      {"fresh", "played on scenes that nobody knew when it was submitted, and no worse there."},
      {"not yet replayed", "what the files of an entry claim; nobody has played it again, and it has no rank."},
      {"claimed by", "reported by the person named; no maintainer has confirmed it."},
      {"answers",
       "whose words say what matters: recorded with the benchmark, a language model’s replies, or a file that the "
       "entry brings."}};
  for (auto& meaning : meanings_of_marks()) words.push_back(std::move(meaning));
  words.insert(words.end(),
               {{"partly confined, unconfined", "the kernel could not keep the method from some files or calls."},
                {"n = 10", "success with 10 demonstrations."},
                {"training s", "seconds of training of one policy, on the submitter’s machine."}});
  section.add<document::Facts>(reading, {std::move(words), true});
  return section;
}

}  // namespace lgabench::leaderboard
