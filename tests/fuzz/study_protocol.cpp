// The protocol of somebody's study, who is asked what in it, and what the first person sees.
#include <lgabench/study/assignment.hpp>
#include <lgabench/study/session.hpp>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  using namespace lgabench::study;
  const fs::path folder = fuzz::directory() / "study", file = folder / "protocol.json";
  fuzz::write(folder / "consent.txt", "I agree. [[YOUR NAME]]");
  fuzz::write(file, fuzz::text_of(data, size));
  try {
    const Protocol protocol = read_protocol(file);
    blanks(protocol);
    not_ready(protocol, file);
    for (const int slot : {0, 1, 7, 1000}) canonical(to_json(assign(protocol, slot)));
    const fs::path events = folder / "person.events";
    fs::remove(events);
    EventLog log(events);
    log.append({{"kind", "begin"}, {"slot", 0}, {"key", "k"}, {"consent", {{"given", true}}}});
    const Session session(protocol, std::move(log));
    canonical(session.state());
  } catch (const InputError&) {
  }
  return 0;
}
