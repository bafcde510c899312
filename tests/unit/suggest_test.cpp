#include <lgabench/core/suggest.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

TEST(Nearest, IsASlipAway) {
  const std::vector<std::string> commands{"list", "info", "run", "report", "compare", "verify", "new-plugin"};
  for (const auto& [typed, meant] : {std::pair{"lst", "list"},
                                     {"lists", "list"},
                                     {"lost", "list"},
                                     {"rnu", "run"},
                                     {"reprot", "report"},
                                     {"comp", "compare"},
                                     {"newplugin", "new-plugin"},
                                     {"run", "run"}})
    EXPECT_EQ(nearest(typed, commands), meant) << typed;
  for (const char* far : {"", "q1", "merge", "x", "information"}) EXPECT_EQ(nearest(far, commands), "") << far;
  EXPECT_EQ(nearest("q9", {"q1", "q2"}), "") << "two are equally near";
  EXPECT_EQ(nearest("lag", {"lga", "lga_s", "lga_l"}), "lga");
  EXPECT_EQ(nearest("rotate", {"rotate_block", "rotate_cup"}), "") << "two begin so";
  EXPECT_EQ(nearest(std::string(100000, 'x'), {std::string(100000, 'x') + "y"}), "") << "and not for hours";
}

TEST(NoneNamed, SuggestsAndLists) {
  EXPECT_EQ(none_named("scenario", "hart", {"heart", "letter"}), "no scenario \"hart\" (did you mean \"heart\"?)");
  EXPECT_EQ(none_named("layout", "plane", {}), "no layout \"plane\", there is none");
  EXPECT_EQ(none_named("scenario", "moon", {"heart", "letter"}),
            "no scenario \"moon\", expected one of: heart, letter; others are found with --scenario-path or "
            "$LGABENCH_SCENARIO_PATH");
}

TEST(NoneNamed, OfManyNamesSome) {
  std::vector<std::string> many;
  for (int i = 100; i < 200; ++i) many.push_back(std::to_string(i));
  many.emplace_back("best_of_all");
  EXPECT_EQ(
      none_named("scenario", "best_x", many),
      "no scenario \"best_x\", expected one of 101, such as: best_of_all, 100, 101, 102, 103, 104, 105, 106 (lgabench "
      "list scenarios); others are found with --scenario-path or $LGABENCH_SCENARIO_PATH");
  EXPECT_EQ(none_named("row", "moon", many).find("lgabench list"), std::string::npos) << "no command lists these";
  EXPECT_EQ(some_of({"a", "b"}), "a, b");
  EXPECT_EQ(some_of(many, " | "), "100 | 101 | 102 | 103 | 104 | 105 | 106 | 107 | ... (93 more)");
}

}  // namespace
}  // namespace lgabench
