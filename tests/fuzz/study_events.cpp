// What a page posts: an event a line, to a session in which a trial is shown.
#include <lgabench/study/session.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;
using namespace lgabench::study;

const Protocol& protocol() {
  static const Protocol shipped = [] {
    std::string text = read_file(data_directory() / "protocols" / "paper.json.in");
    text.replace(text.find("@SEED@"), 6, "1");
    fuzz::write(fuzz::directory() / "consent.txt", "I agree.");
    return read_protocol(fuzz::write(fuzz::directory() / "protocol.json", text));
  }();
  return shipped;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path file = fuzz::directory() / "person.events";
  fs::remove(file);
  EventLog log(file);
  log.append({{"kind", "begin"}, {"slot", 0}, {"key", "k"}, {"consent", {{"given", true}}}});
  Session session(protocol(), std::move(log));
  int sent = 0;
  for (const char* kind : {"opened", "familiarised", "example_seen", "start", "shown"}) {
    ++sent;
    session.post({{"key", std::to_string(sent)}, {"page", "p"}, {"kind", kind}, {"page_ms", 1}}, sent);
  }
  for (const std::string_view line : fuzz::split(fuzz::text_of(data, size), "\n")) try {
      session.post(json_or_null(line), ++sent);
      canonical(session.state());
    } catch (const Refused&) {
    }
  const Session again(protocol(), EventLog(file));  // whatever was taken is read again
  if (canonical(again.state()) != canonical(session.state())) throw std::logic_error("another state after a restart");
  return 0;
}
