// The protocol of somebody's study, who is asked what in it, and what the first person sees.
#include <lgabench/study/assignment.hpp>
#include <lgabench/study/session.hpp>

#include "fuzz.hpp"

using namespace lgabench;
using namespace lgabench::study;

// A person who has agreed, whatever they are to be asked.
const EventLog& begun() {
  static const EventLog log = [] {
    EventLog made(fuzz::directory() / "person.events");
    made.append({{"kind", "begin"}, {"slot", 0}, {"key", "k"}, {"consent", {{"given", true}}}});
    return made;
  }();
  return log;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::use_small_data();
  static const fs::path file = fuzz::directory() / "protocol.json";
  static const fs::path consent = fuzz::write(fuzz::directory() / "consent.txt", "I agree. [[YOUR NAME]]");
  fuzz::write(file, fuzz::text_of(data, size));
  try {
    const Protocol protocol = read_protocol(file);
    blanks(protocol);
    not_ready(protocol, file);
    for (const int slot : {0, 1, 7, 1000}) canonical(to_json(assign(protocol, slot)));
    const Session session(protocol, begun());
    canonical(session.state());
  } catch (const InputError&) {
  }
  return 0;
}
