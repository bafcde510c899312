#include <lgabench/harness/check.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <thread>

namespace lgabench {

std::string to_string(Finding::State state) {
  return state == Finding::State::ok ? "ok" : state == Finding::State::note ? "note" : "problem";
}

Json to_json(const Finding& f) {
  return {{"check", f.check}, {"state", to_string(f.state)}, {"detail", f.detail}, {"fix", f.fix}};
}

Finding read_finding(const JsonReader& reader) {
  Finding finding{Finding::State::ok, reader.at("check").string(), reader.at("detail").string(),
                  reader.at("fix").string()};
  const std::string state = reader.at("state").string();
  for (const auto known : {Finding::State::ok, Finding::State::note, Finding::State::problem})
    if (to_string(known) == state) finding.state = known;
  if (to_string(finding.state) != state) reader.at("state").fail("ok, note or problem");
  return finding;
}

void CheckReport::ok(const std::string& check, const std::string& detail) {
  findings.push_back({Finding::State::ok, check, detail, ""});
}
void CheckReport::note(const std::string& check, const std::string& detail, const std::string& fix) {
  findings.push_back({Finding::State::note, check, detail, fix});
}
void CheckReport::problem(const std::string& check, const std::string& detail, const std::string& fix) {
  findings.push_back({Finding::State::problem, check, detail, fix});
}
void CheckReport::judge(const std::string& check, const std::string& fault, const std::string& detail,
                        const std::string& fix) {
  fault.empty() ? ok(check, detail) : problem(check, fault, fix);
}

Json to_json(const CheckReport& report) {
  Json findings = Json::array();
  for (const Finding& finding : report.findings) findings.push_back(to_json(finding));
  return {{"findings", findings}, {"hashes", report.hashes}};
}

CheckReport read_check_report(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  CheckReport report;
  for (const JsonReader& finding : reader.at("findings").elements()) report.findings.push_back(read_finding(finding));
  report.hashes = reader.at("hashes").json();
  return report;
}

void judge_leftovers(CheckReport& report, const std::function<ProcessState()>& now) {
  ProcessState left = now();
  for (int wait = 0; wait < 50 && !left.threads.empty(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    left = now();
  }
  report.judge("threads", left.threads.empty() ? "" : fmt::format("left running: {}", fmt::join(left.threads, ", ")),
               "none left behind",
               "join every thread before the call that started it returns, or in the destructor; a library's own pool "
               "is kept small by its settings (one thread)");
  const auto& files = left.descriptors;
  report.judge("descriptors", files.empty() ? "" : fmt::format("left open: {}", fmt::join(files, ", ")),
               "none left open", "close every file and socket, or hold it in an object that does");
}

}  // namespace lgabench
