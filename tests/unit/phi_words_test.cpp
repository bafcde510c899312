// A Selection in words: each name of the space is right, missed, wrong, or left out by both.
#include <gtest/gtest.h>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/statistics/phi_words.hpp>

namespace lgabench::statistics {
namespace {

using Names = std::vector<std::string>;

CommandResult command(const Json& selected, const Json& meant) {
  CommandResult result;
  result.truth = {{"target", meant}};
  result.selection = {{"target", selected}, {"provenance", "recorded"}};
  result.quality = {{"target", {}}};
  return result;
}

CellResult cell(const std::string& space) {
  CellResult result;
  result.space = space;
  return result;
}

TEST(PhiWords, AreRightMissedOrWrong) {
  const FeatureSpace space = load_feature_space("tabletop");
  const auto words =
      phi_words(cell("tabletop"), command({{"object_types", {"ring", "heart"}}, {"textures", {"red", "blue"}}},
                                          {{"object_types", {"heart", "star"}}, {"textures", "ALL"}}));
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0].about + " " + words[0].feature, "target object types");
  EXPECT_EQ(words[0].right, Names{"heart"});
  EXPECT_EQ(words[0].missed, Names{"star"});
  EXPECT_EQ(words[0].wrong, Names{"ring"});
  EXPECT_EQ(words[1].right, (Names{"blue", "red"})) << "in the order of the space";
  EXPECT_EQ(words[1].missed.size(), space.textures.size() - 2);
  EXPECT_EQ(words[1].wrong, Names{});
}

TEST(PhiWords, AreNoneWithoutASelectionOrItsSpace) {
  const Json set{{"object_types", "ALL"}, {"textures", "ALL"}};
  CommandResult selects_nothing = command(set, set);
  selects_nothing.quality.clear();
  EXPECT_TRUE(phi_words(cell("tabletop"), selects_nothing).empty());
  EXPECT_TRUE(phi_words(cell("of another version"), command(set, set)).empty());
  for (const Json& broken : {Json(1), Json{{"object_types", 3}}, Json{{"textures", {1, 2}}}})
    for (const PhiWords& of : phi_words(cell("tabletop"), command(broken, set))) EXPECT_TRUE(of.right.empty());
}

TEST(PhiWords, AreCountedWhereTheyAreMany) {
  EXPECT_EQ(listed({}, 3), "–");
  EXPECT_EQ(listed({"a", "b", "c"}, 3), "any of 3");
  EXPECT_EQ(listed({"a", "b"}, 3), "a, b");
  EXPECT_EQ(listed({"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"}, 11), "a, b, c, d, e, f, g, h and 2 more");
}

}  // namespace
}  // namespace lgabench::statistics
