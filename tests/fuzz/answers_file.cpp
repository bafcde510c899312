// A file of answers that somebody wrote, as --answers takes it, and what it says of a command with two sets.
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  static const Scenario scenario = load_scenario("sweep_block_without_touching_line");
  const fs::path file = fuzz::write(fuzz::directory() / "answers.json", fuzz::text_of(data, size));
  try {
    read_recorded(file);
    RecordedLanguageModel lm = RecordedLanguageModel::of_file(scenario.space, scenario.answers_of, file);
    canonical(Json(lm.known()));
    canonical(to_json(select_features(scenario.command(0), scenario.space, lm)));
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
  return 0;
}
