#include <lgabench/job/check_report.hpp>

#include <algorithm>
#include <array>

#include <lgabench/core/fields.hpp>

namespace lgabench {

namespace {

constexpr std::array states{"ok", "note", "problem"};  // of Finding::State

}  // namespace

std::string to_string(Finding::State state) { return states.at(static_cast<std::size_t>(state)); }

static void fields(Finding& finding, Fields& field) {
  std::string state = states.at(static_cast<std::size_t>(finding.state));
  field("check", finding.check);
  field("detail", finding.detail);
  field("fix", finding.fix);
  field("state", state, one_of(states));
  finding.state = static_cast<Finding::State>(std::find(states.begin(), states.end(), state) - states.begin());
}

void fields(CheckReport& report, Fields& field) {
  field("findings", report.findings);
  field("hashes", report.hashes);
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

Json to_json(const CheckReport& report) { return json_of(report); }

CheckReport read_check_report(const Json& json, const std::string& file) {
  return value_of<CheckReport>(JsonReader(json, file), false);
}

}  // namespace lgabench
