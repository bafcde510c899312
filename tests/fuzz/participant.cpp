// A person's answers, and what they say to each command that they were asked about.
#include <lgabench/abstraction/participant.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  static const Scenario scenario = load_scenario("sweep_block_without_touching_line");
  const fs::path file = fuzz::write(fuzz::directory() / "person.json", fuzz::text_of(data, size));
  try {
    const Participant participant = read_participant(file);
    ParticipantAsHuman human(participant, scenario);
    canonical(to_json(human.specify(scenario.command(0))));
    canonical(to_json(human.edit(scenario.command(0), human.specify(scenario.command(0)))));
  } catch (const InputError&) {
  }
  return 0;
}
