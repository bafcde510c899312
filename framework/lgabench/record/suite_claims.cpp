#include <lgabench/record/suite_claims.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

constexpr long long most_demonstrations = 1'000'000;

std::string sentence(const JsonReader& reader) {
  if (reader.string().empty()) reader.fail("a sentence");
  return reader.string();
}

std::string row(const JsonReader& reader) {
  const std::string words = reader.string();
  bool options = words.find('+') != 0 && !words.empty();
  for (std::size_t at = words.find('+'), next = 0; at != words.npos; at = next) {
    next = words.find('+', at + 1);
    options = options && words.substr(at, next - at).find('=') != words.npos;
  }
  if (!options) reader.fail("a row, ID+OPTION=VALUE+...");
  return words;
}

SuiteClaim::Test test(const JsonReader& reader) {
  constexpr std::array words{"ordering", "at_most", "equivalence", "slope"};
  const auto found = std::find(words.begin(), words.end(), reader.string());
  if (found == words.end()) reader.fail(fmt::format("one of: {}", fmt::join(words, ", ")));
  return static_cast<SuiteClaim::Test>(found - words.begin());
}

// Whether the claim is of paired success.
bool paired(const JsonReader& measure) {
  const std::string word = measure.string();
  if (word != "success" && word != "paired success") measure.fail("success or paired success");
  return word == "paired success";
}

// An array with a value or more, each once.
template <class Value, class Read>
std::vector<Value> list(const JsonReader& reader, Read read) {
  std::vector<Value> all;
  for (const JsonReader& element : reader.elements()) {
    all.push_back(read(element));
    if (std::count(all.begin(), all.end(), all.back()) > 1) element.fail("each once");
  }
  if (all.empty()) reader.fail("one or more");
  return all;
}

void read_levels(const JsonReader& reader, SuiteClaim& claim) {
  claim.option = reader.at("option").string();
  const JsonReader levels = reader.at("levels");
  claim.levels = list<double>(levels, [](const JsonReader& level) { return level.number(); });
  if (claim.levels.size() < 2 || !std::is_sorted(claim.levels.begin(), claim.levels.end()))
    levels.fail("two levels or more, which grow");
}

SuiteClaim read_claim(const JsonReader& reader) {
  using Test = SuiteClaim::Test;
  SuiteClaim claim;
  claim.test = test(reader.at("test"));
  std::vector<std::string> members{"id",    "statement", "refuted_if", "test",          "above",
                                   "below", "scenarios", "arms",       "demonstrations"};
  const bool slope = claim.test == Test::slope, has_margin = claim.test != Test::ordering && !slope;
  if (slope) members.insert(members.end(), {"option", "levels"});
  if (has_margin) members.emplace_back("margin");
  if (!slope) members.emplace_back("measure");
  reader.only(members);
  claim.id = sentence(reader.at("id"));
  claim.statement = sentence(reader.at("statement"));
  claim.refuted_if = sentence(reader.at("refuted_if"));
  claim.above = row(reader.at("above"));
  claim.below = row(reader.at("below"));
  if (claim.above == claim.below) reader.at("below").fail("another row than \"above\"");
  if (reader.has("measure")) claim.paired = paired(reader.at("measure"));
  const auto name = [](const JsonReader& one) { return one.string(); };
  if (reader.has("scenarios")) claim.scenarios = list<std::string>(reader.at("scenarios"), name);
  if (reader.has("arms")) claim.arms = list<std::string>(reader.at("arms"), name);
  if (reader.has("demonstrations"))
    claim.demonstrations = list<int>(reader.at("demonstrations"), [](const JsonReader& n) {
      return static_cast<int>(n.integer(1, most_demonstrations));
    });
  if (has_margin) {
    claim.margin = reader.at("margin").number();
    const double least = claim.test == Test::equivalence ? 1e-9 : 0;
    if (!(claim.margin >= least && claim.margin < 1)) reader.at("margin").fail("a difference of success below 1");
  }
  if (slope) read_levels(reader, claim);
  return claim;
}

}  // namespace

std::vector<SuiteClaim> read_suite_claims(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  reader.only({"note", "claims"});
  std::vector<SuiteClaim> all;
  for (const JsonReader& claim : reader.at("claims").elements()) {
    all.push_back(read_claim(claim));
    if (std::count_if(all.begin(), all.end(), [&](const SuiteClaim& one) { return one.id == all.back().id; }) > 1)
      claim.at("id").fail("each id once");
  }
  if (all.empty()) reader.at("claims").fail("one or more");
  return all;
}

Json claims_beside(const fs::path& suite) {
  const fs::path file = suite.parent_path() / "claims" / suite.filename();
  if (!fs::exists(file)) return nullptr;
  Json json = read_json(file);
  read_suite_claims(json, file.string());
  return json;
}

}  // namespace lgabench
