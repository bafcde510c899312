#include <lgabench/core/language_model.hpp>

#include <fmt/format.h>

#include <lgabench/core/terminal.hpp>

namespace lgabench {

std::vector<Hypothesis> read_hypotheses(const JsonReader& reader, const FeatureSpace& space) {
  constexpr std::size_t most = 50, longest = 300;
  const std::vector<JsonReader> elements = reader.elements();
  if (elements.empty() || elements.size() > most) reader.fail(fmt::format("1 to {} hypotheses", most));
  std::vector<Hypothesis> all;
  for (const JsonReader& one : elements) {
    one.only({"text", "meaning", "weight"});
    const std::string text = one.at("text").string();
    if (text.empty() || text.size() > longest || text != one_line(text))
      one.at("text").fail(fmt::format("words, in a line of at most {} bytes", longest));
    all.push_back({text, read_meaning(one.at("meaning"), space), one.has("weight") ? one.at("weight").number() : 1});
    if (!(all.back().weight > 0)) one.at("weight").fail("a number above 0");
  }
  return all;
}

Meaning LanguageModel::mean(const Command& command, const FeatureSpace&) {
  throw MethodError(model() + ": cannot say in one answer what \"" + command.utterance +
                    "\" means, as meaning=structured asks");
}

std::vector<Hypothesis> LanguageModel::hypotheses(const Command& command, const FeatureSpace&) {
  throw MethodError(model() + ": cannot say what \"" + command.utterance + "\" leaves unsaid");
}

bool HumanAnswers::accepts(const Command& command, const std::string&, const std::string&) {
  throw MethodError("\"" + command.utterance + "\": these people cannot say of one object whether they would take it");
}

namespace {

[[noreturn]] void refuse_scenes(const Command& command) {
  throw MethodError("\"" + command.utterance +
                    "\": expected a scenario with \"questions\", whose people are asked in scenes");
}

}  // namespace

std::vector<Placed> HumanAnswers::scene(const Command& command, int) { refuse_scenes(command); }
bool HumanAnswers::takes(const Command& command, int, std::uint8_t) { refuse_scenes(command); }
std::optional<std::uint8_t> HumanAnswers::which(const Command& command, int) { refuse_scenes(command); }

}  // namespace lgabench
