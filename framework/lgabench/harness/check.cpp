#include <lgabench/harness/check.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>

#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

std::vector<std::string> beyond(const std::vector<std::string>& before, const std::vector<std::string>& after) {
  std::vector<std::string> more;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(more));
  return more;
}

// Of each entry of a directory of /proc, which may be gone by the time it is read.
template <class Describe>
std::vector<std::string> entries(const fs::path& directory, Describe describe) {
  std::vector<std::string> all;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string text = describe(entry.path(), gone);
    if (!gone) all.push_back(text);
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

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

ProcessState ProcessState::now() {
  ProcessState state;
  state.threads = entries("/proc/self/task", [](const fs::path& task, std::error_code& gone) {
    gone.clear();
    try {
      std::string name = read_file(task / "comm");
      return name.substr(0, name.find('\n'));
    } catch (const InputError&) {
      gone = std::make_error_code(std::errc::no_such_process);
      return std::string();
    }
  });
  state.descriptors = entries("/proc/self/fd", [](const fs::path& link, std::error_code& gone) {
    return fs::read_symlink(link, gone).string();
  });
  const struct mallinfo2 heap = ::mallinfo2();
  state.heap_bytes = static_cast<long long>(heap.uordblks + heap.hblkhd);
  return state;
}

void judge_leftovers(CheckReport& report, const ProcessState& before) {
  ProcessState after = ProcessState::now();
  for (int wait = 0; wait < 50 && after.threads.size() > before.threads.size(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    after = ProcessState::now();
  }
  const std::vector<std::string> threads = beyond(before.threads, after.threads);
  report.judge("threads", threads.empty() ? "" : fmt::format("left running: {}", fmt::join(threads, ", ")),
               "none left behind",
               "join every thread before the call that started it returns, or in the destructor; a library's own pool "
               "is kept small by its settings (one thread)");
  const std::vector<std::string> files = beyond(before.descriptors, after.descriptors);
  report.judge("descriptors", files.empty() ? "" : fmt::format("left open: {}", fmt::join(files, ", ")),
               "none left open", "close every file and socket, or hold it in an object that does");
}

}  // namespace lgabench
