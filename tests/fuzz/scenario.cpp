// A scenario's file.
#include <lgabench/core/scenario.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  try {
    const Scenario scenario = read_scenario(parse_json(fuzz::text_of(data, size), "scenario.json"), "scenario.json");
    scenario.training_scenes(10);
    for (const ScenarioCommand& command : scenario.commands) canonical(to_json(command.truth));
    for (const Arm& arm : scenario.tests)
      for (const int i : scenario.commands_of(arm.id)) scenario.command(i);
  } catch (const InputError&) {
  }
  return 0;
}
