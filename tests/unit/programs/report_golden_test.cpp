// One small run in every form of its report, compared with files that people have read. LGABENCH_WRITE_GOLDEN=1 writes
// them anew (CONTRIBUTING.md): read the difference before it is committed.
#include <gtest/gtest.h>

#include <cstdlib>

#include <lgabench/report/report.hpp>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Spec = FabricatedRun::Spec;

// Two scenarios, one of them with a command that is tested only; two numbers of demonstrations; arms; reference rows;
// people; a second engine; marks; a failed cell; names that want to be more than names.
void fill(FabricatedRun& run) {
  const auto in_arms = [](Spec spec, int control, int hard) {
    spec.arms = {{"control", control, {0}, .5}, {"hard", hard, {0}, spec.method == "lga" ? .5 : .25}};
    return spec;
  };
  for (const int n : {10, 50}) {
    for (int seed = 0; seed < 2; ++seed) {
      Spec lga = in_arms({"lga", 0, "heart", n, seed}, 10 + n / 10 + seed, 9 + n / 10);
      lga.attribution = seed == 0 ? "abstraction" : "policy";
      lga.inputs_seen = 3 + seed;
      run.add(lga);
      for (const char* baseline : {"gcbc_seg", "gcbc_dart"})
        run.add(in_arms({baseline, 0, "heart", n, seed, "method", "cells", "wrong_object"}, 3, seed));
    }
    run.add(in_arms({"constant_action", 0, "heart", n, 0, "reference"}, 5, 4));
    for (const auto& [method, won] : {std::pair("lga", 15), {"gcbc_seg", 2}, {"gcbc_dart", 0}}) {
      Spec letter{method, 0, "letter", n};
      letter.arms = {{"control", won, {0}, .5}, {"hard", won / 3, {1}, .25}};
      letter.commands = {{"Bring me the <b>A</b>.", true}, {"Bring me a | \"letter\".", false}};
      letter.of_commands[1]["truth"] = {{"target", {{"sets", {{{"object_types", {"heart"}}, {"textures", "ALL"}}}}}}};
      run.add(letter);
    }
  }
  for (const char* id : {"p01", "p02"})
    for (const char* method : {"human", "lga_hill"}) {  // invented people
      Spec person = in_arms({method, 0, "heart", 50}, 18, 17);
      person.provenance = "human";
      person.participant = id;
      person.human_seconds = (*method == 'h' ? 150 : 50) + id[2];
      run.add(person);
    }
  Spec elsewhere = in_arms({"lga", 0, "heart", 50}, 13, 14);
  elsewhere.engine = "kinematic";
  run.add(elsewhere);
  run.add(in_arms({"=my_method+loss=\"x\"", 0, "heart", 50}, 7, 20));
  run.add_failed(in_arms({"lga", 0, "heart", 10, 2}, 0, 0), "host");
}

// Without what page/ holds, and without the data of the script.
std::string body_of(const std::string& page) {
  const std::size_t begin = page.find("<main>"), end = page.find("</main>");
  return page.substr(begin, end - begin);
}

TEST(Golden, TheReportOfASmallRunIsAsItWasRead) {
  FabricatedRun run;
  fill(run);
  run.save();
  const report::Report report = report::write_report(run.path);
  std::map<std::string, std::string> made{
      {"terminal.txt", document::terminal(report.document, "RUN")},
      {"claims.txt", document::terminal(report::claims_section(report.claims, statistics::MethodStyles(), "claims"))},
      {"report.html", body_of(read_file(run.path / "report.html"))},
  };
  for (const char* file : {"report.md", "summary.csv", "figures/success_cells_mujoco_control.svg",
                           "figures/success_cells_mujoco_control.pdf", "tables/cells_mujoco_50_scenarios.tex",
                           "tables/cells_mujoco_50_scenarios.csv", "tables/phi.tex"})
    made[fs::path(file).filename()] = read_file(run.path / file);

  for (auto& [name, bytes] : made)  // a note on pictures that could not be drawn names a file of the run
    for (std::size_t at; (at = bytes.find(run.path.string())) != std::string::npos;)
      bytes.replace(at, run.path.string().size(), "RUN");

  const fs::path golden = LGABENCH_GOLDEN;
  const bool write = std::getenv("LGABENCH_WRITE_GOLDEN") != nullptr;
  for (const auto& [name, bytes] : made) {
    if (write) write_file(golden / name, bytes);
    ASSERT_TRUE(fs::exists(golden / name)) << name;
    const std::string expected = read_file(golden / name);
    const auto at = std::mismatch(bytes.begin(), bytes.end(), expected.begin(), expected.end()).first - bytes.begin();
    EXPECT_TRUE(bytes == expected) << name << " differs from byte " << at << ":\n"
                                   << bytes.substr(static_cast<std::size_t>(at), 200) << "\nexpected\n"
                                   << expected.substr(std::min<std::size_t>(at, expected.size()), 200);
  }
}

}  // namespace
}  // namespace lgabench
