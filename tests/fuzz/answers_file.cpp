// A file of answers that somebody wrote, as --answers takes it, and what it says of a command with two sets.
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  fuzz::use_small_data();
  static const Scenario scenario = load_scenario("sweep_block_without_touching_line");
  static const Command command = scenario.command(0);
  static const fs::path file = fuzz::directory() / "answers.json";
  fuzz::write(file, fuzz::text_of(data, size));
  try {
    RecordedLanguageModel lm = RecordedLanguageModel::of_file(scenario.space, scenario.answers_of, file);
    canonical(Json(lm.known()));
    for (const Hypothesis& hypothesis : lm.hypotheses(command, scenario.space)) canonical(to_json(hypothesis.meaning));
    if (lm.has_meaning(command)) canonical(to_json(select_meaning(command, scenario.space, lm)));
    canonical(to_json(select_features(command, scenario.space, lm)));
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
  return 0;
}
