// What is known of an environment from its library: tasks, layouts, words.
#include <gtest/gtest.h>

#include <algorithm>

#include <lgabench/core/environments.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

using Words = std::vector<std::string>;

TEST(Environments, AreTheLibrariesBesideLgabenchsOwn) {
  EXPECT_EQ(environment_ids(), (Words{"mobile", "tabletop"}));
  EXPECT_EQ(find_environment("tabletop").id(), "tabletop");
  EXPECT_EQ(&find_environment("tabletop"), &find_environment("tabletop"));
  EXPECT_SAYS(message_of<InputError>([] { find_environment("tabletops"); }),
              "no environment \"tabletops\" (did you mean \"tabletop\"?)");
  for (const char* path : {"", "../lib/liblgabench_env_tabletop", "core"})
    EXPECT_THROW(find_environment(path), InputError) << path;
}

TEST(Environments, OfPluginsAreFoundByTheirIdAndChangeNothingElse) {
  const Words own = environment_ids(), words = failure_words();
  int loads = 0;
  const LoadEnvironment mobile = [&loads] { return ++loads, &find_environment("mobile"); };
  add_environment("added", "one hash", mobile);
  add_environment("added", "one hash", [] { return nullptr; });  // the same plugin, found again
  EXPECT_EQ(&find_environment("added"), &find_environment("mobile"));
  EXPECT_EQ(environment_if_there("added"), &find_environment("added"));
  EXPECT_EQ(loads, 1);
  EXPECT_EQ(environment_ids(), own);
  EXPECT_EQ(failure_words(), words);
  EXPECT_EQ(message_of<InputError>([&] { add_environment("added", "another hash", mobile); }),
            "environment added: another plugin has that id");
  EXPECT_EQ(message_of<InputError>([&] { add_environment("tabletop", "one hash", mobile); }),
            "environment tabletop: an environment of lgabench's own has that id");
  EXPECT_SAYS(message_of<InputError>([] { find_environment("addd"); }), "(did you mean \"added\"?)");
}

TEST(Environments, ThatCannotBeLoadedAreAnErrorWhereTheirIdIsUsed) {
  add_environment("broken", "a hash", []() -> const EnvironmentType* { throw PluginError("cannot be opened"); });
  EXPECT_EQ(message_of<PluginError>([] { find_environment("broken"); }), "cannot be opened");
  EXPECT_EQ(environment_if_there("broken"), nullptr);
  EXPECT_NO_THROW(installed_tasks());
  EXPECT_NO_THROW(failure_words());
}

TEST(Environments, TasksNameTheirLayoutsSecondSetAndExample) {
  const EnvironmentType& tabletop = find_environment("tabletop");
  const TaskInfo& sweep = find_task(tabletop, "sweep");
  EXPECT_EQ(sweep.layouts, (Words{"cells", "continuous", "released"}));
  ASSERT_TRUE(sweep.second);
  EXPECT_EQ(sweep.second->id, "avoid");
  EXPECT_EQ(sweep.second->phrase, "the object to be avoided");
  EXPECT_EQ(sweep.failures, (Words{"missed_zone", "touched_obstacle"}));
  EXPECT_FALSE(find_task(tabletop, "rotate").second);
  EXPECT_SAYS(message_of<InputError>([&] { find_task(tabletop, "swep"); }),
              "no task \"swep\" (did you mean \"sweep\"?)");
  for (const TaskInfo& task : installed_tasks()) {
    const Scenario example = load_scenario(task.example);
    EXPECT_EQ(example.task, task.id);
    EXPECT_EQ(example.second.has_value(), task.second.has_value()) << task.id;
  }
}

// The order of columns in summary.csv.
TEST(Environments, FailureWordsKeepTheirOrder) {
  const Words words = failure_words();
  EXPECT_EQ(words,
            (Words{"missed_object", "wrong_object", "blocked_way", "out_of_reach", "dropped_elsewhere", "moved_another",
                   "wrong_receiver", "bad_placement", "bad_angle", "missed_zone", "touched_obstacle", "left_workspace",
                   "not_meant", "truncated", "abstraction_empty", "method_error"}));
}

TEST(Environments, WordsThatTheyLackFollowTheirs) {
  Words expected = failure_words();
  expected.push_back("lost");
  EXPECT_EQ(failure_words({"lost", "missed_object"}), expected);
}

TEST(Environments, DrawWhatAnEpisodeBeginsWith) {
  const Scenario heart = load_scenario("heart");
  const EnvironmentType& tabletop = *heart.environment;
  const Scene scene = tabletop.sample(heart, {"cells", "test", "test"}, 3);
  const Observation seen = tabletop.draw(scene), again = tabletop.draw(scene);
  EXPECT_EQ(seen.rgb, again.rgb);
  EXPECT_EQ(seen.instances.size(), scene.objects.size());
}

}  // namespace
}  // namespace lgabench
