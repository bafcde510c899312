// Simulated people, who take part over HTTP as a browser does. They are invented: no number of theirs is a result.
#pragma once
#include <lgabench/study/protocol.hpp>

namespace lgabench::study {

/// One session from consent to debriefing at 127.0.0.1:`port`, on the pages that people get; `number` seeds the
/// person. They need no real time: the times that they report are drawn, slower in the condition human, and their
/// answers are the truth with slips. @throws InputError naming the page that did not answer as expected.
void simulate_person(const Protocol& protocol, int port, int number);

}  // namespace lgabench::study
