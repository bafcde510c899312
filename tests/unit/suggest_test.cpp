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
  EXPECT_EQ(none_named("scenario", "moon", {"heart", "letter"}),
            "no scenario \"moon\", expected one of: heart, letter");
}

}  // namespace
}  // namespace lgabench
