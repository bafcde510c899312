#include <lgabench/job/check_report.hpp>

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

}  // namespace lgabench
