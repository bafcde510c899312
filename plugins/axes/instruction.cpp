// Another instruction for the same scene: none, one that means nothing, or one that means another thing in view.
#include <lgabench/core/perturbations.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace lgabench::perturbations {
namespace {

constexpr int sentences = 8, words_of_each = 4, syllables = 3;

// Four words of three syllables, as "Bring me the heart." is written. They are the same whatever is played, so that a
// model can be asked beforehand.
std::string nonsense(int number) {
  constexpr std::string_view consonants = "bdfgklmnprstvz", vowels = "aeiou";
  RandomStream random(fmt::format("perturbation/instruction/nonsense/{}", number));
  const auto any_of = [&random](std::string_view letters) {
    return letters[random.below(static_cast<std::uint32_t>(letters.size()))];
  };
  std::string text;
  for (int word = 0; word < words_of_each; ++word) {
    if (word > 0) text += ' ';
    for (int syllable = 0; syllable < syllables; ++syllable) text += {any_of(consonants), any_of(vowels)};
    text += any_of(consonants);
  }
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + '.';
}

// Of the demonstrated commands that do not mean the target, one that means another thing in view, drawn.
int other_command(const Scene& scene, const Scenario& scenario, RandomStream stream) {
  std::vector<int> others, in_view;
  for (const int command : scenario.commands_of("train")) {
    const ScenarioCommand& one = scenario.commands[static_cast<std::size_t>(command)];
    const auto meant = [&](const Role& is, bool it_is) {
      return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
        return (object.role == is) == it_is && object.role != role::goal && means(one, object);
      });
    };
    if (command != scene.command) others.push_back(command);
    if (!meant(role::target, true) && meant(role::target, false)) in_view.push_back(command);
  }
  const std::vector<int>& some = in_view.empty() ? others : in_view;
  return some[stream.below(static_cast<std::uint32_t>(some.size()))];
}

}  // namespace

PerturbationAxis instruction() {
  PerturbationAxis axis{"instruction",
                        {"empty", "nonsense", "another command"},
                        {EpisodePart::words},
                        {EpisodePart::answers, EpisodePart::selection}};
  axis.named = true;
  axis.of_all = false;
  axis.other = other_command;
  axis.words = [](int level) -> std::vector<std::string> {
    if (level == 1) return {""};
    std::vector<std::string> all;
    for (int i = 0; level == 2 && i < sentences; ++i) all.push_back(nonsense(i));
    return all;
  };
  axis.lacks = [](const Scenario& scenario, int) -> std::string {
    if (scenario.second) return "expected a task without a second set";
    return scenario.commands_of("train").size() > 1 ? "" : "expected several commands that are demonstrated";
  };
  return axis;
}

}  // namespace lgabench::perturbations
