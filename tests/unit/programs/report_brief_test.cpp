// The table that a run ends with.
#include <gtest/gtest.h>

#include "report_run.hpp"

namespace lgabench {
namespace {

using Arm = FabricatedRun::Arm;
using Spec = FabricatedRun::Spec;

std::vector<std::string> lines_of(const FabricatedRun& run, std::vector<std::string>* notes = nullptr) {
  const report::Report report = report::write_report(run.save().path);
  if (notes) *notes = report.brief.notes;
  std::vector<std::string> lines;
  std::istringstream text(document::terminal(report.brief.means));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  for (const std::string& line : lines) EXPECT_LE(line.size(), 80u + 2u) << line;  // "–" has three bytes
  return {lines.begin() + 2, lines.end()};                                         // without caption
}

TEST(Brief, ManyMethodsAreEightTheFirstAndTheReadersOwnAmongThem) {
  FabricatedRun run;
  for (const char* method :
       {"lga", "lga_hill", "human", "lga_s", "lga_l", "gcbc_dart", "gcbc_seg", "factorial", "mine", "yours", "theirs"})
    run.add({method, 10});
  Spec reference{"random_object", 12};
  reference.kind = "reference";
  reference.demonstrations = 0;
  run.add(reference);
  std::vector<std::string> notes;
  const std::vector<std::string> lines = lines_of(run, &notes);
  EXPECT_EQ(lines.size(), 11u) << "heads, eight methods, a rule and a reference";
  EXPECT_LE(lines.size(), 12u);
  const auto has = [&lines](const std::string& name) {
    return std::any_of(lines.begin(), lines.end(),
                       [&name](const std::string& line) { return line.rfind("  " + name + " ", 0) == 0; });
  };
  EXPECT_TRUE(has("LGA"));
  EXPECT_TRUE(has("mine"));
  EXPECT_TRUE(has("theirs"));
  EXPECT_FALSE(has("LGA-HILL"));
  EXPECT_EQ(notes, (std::vector<std::string>{"§ below the random visible object, which needs no demonstration.",
                                             "More rows in the report: 3."}));
}

// Who asks for errors of the Selection sees what they cost; where rows do not fit, in the report.
TEST(Brief, ErrorsOfTheSelectionAreRowsWhereTheyFit) {
  for (const int wrong : {1, 9}) {
    FabricatedRun run;
    run.add({"human", 20});
    for (int i = 1; i <= wrong; ++i) {
      Spec spec{fmt::format("human+missing={}", i / 10.), 10};
      spec.provenance = "truth";
      spec.selection_errors = {{"missing", i / 10.}};
      run.add(spec);
    }
    std::vector<std::string> notes;
    const std::vector<std::string> lines = lines_of(run, &notes);
    const auto found = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find("missing=0.1") != line.npos && line.find(" 0.50 ") != line.npos;
    });
    EXPECT_EQ(found != lines.end(), wrong == 1);
    EXPECT_EQ(notes.empty(), wrong == 1);
    if (wrong == 9) {
      EXPECT_EQ(notes.front(), "More rows in the report: 9.");
    }
  }
}

TEST(Brief, NumbersOfDemonstrationsStandSideBySide) {
  FabricatedRun run;
  for (const int n : {10, 20}) run.add({"lga", n, "heart", n});
  const std::vector<std::string> lines = lines_of(run);
  EXPECT_EQ(lines.at(0), "  demonstrations  10                 20");
  EXPECT_EQ(lines.at(1), "  LGA             0.50 [0.30, 0.70]  1.00 [0.84, 1.00]");
}

TEST(Brief, ArmsThatDoNotFitGiveWayToTheMainOneAndTheMean) {
  for (const std::size_t arms : {2u, 6u, 20u}) {
    FabricatedRun run;
    Spec spec{"lga"};
    for (std::size_t i = 0; i < arms; ++i) spec.arms.push_back({"arm_" + std::to_string(i), i == 0 ? 20 : 10});
    run.add(spec);
    const std::vector<std::string> lines = lines_of(run);
    const std::string &head = lines.at(0), &row = lines.at(1);
    if (arms == 2) {
      EXPECT_EQ(row, "  LGA                1.00 [0.84, 1.00]  0.50 [0.30, 0.70]");
    } else if (arms == 6) {
      EXPECT_SAYS(head, "arm_0  arm_1");
      EXPECT_SAYS(row, "1.00   0.50   0.50");
    } else {
      EXPECT_SAYS(head, "arm_19             mean of 20 arms");
      EXPECT_SAYS(row, "0.50 [0.30, 0.70]  0.53");
    }
  }
}

TEST(Brief, SaysWhatTheRunLacks) {
  FabricatedRun run;
  run.add({"lga", 10});
  run.run["cells"].push_back(std::string(16, '0'));
  std::vector<std::string> notes;
  lines_of(run, &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_SAYS(notes[0], "have not run yet: the tables are partial.");
}

}  // namespace
}  // namespace lgabench
