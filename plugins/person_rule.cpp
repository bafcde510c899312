// What a person wants, of whose words the grammar of persons is known: by the words, by what taken objects share, or by
// Bayes' rule, as one Selection or chosen anew in each scene.
#include <algorithm>
#include <cmath>
#include <map>

#include <lgabench/abstraction/preference.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/drawn/person_belief.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/pointing.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;
using drawn::Belief;
using drawn::Standing;

constexpr double errs = .05;  // that an answer is wrong

// Scenes of a command, with what was taken there.
using Shown = std::vector<std::pair<Standing, std::size_t>>;

// What objects of a scene have, and all that were taken have in common: a type, looks, places.
std::vector<bool> features_of(const Standing& scene, std::size_t one, const drawn::PersonGrammar& grammar) {
  std::vector<bool> all(grammar.space.object_types.size(), false);
  all[scene.things[one].type] = true;
  for (const auto& look : grammar.looks)
    all.push_back(
        std::count(look.textures.begin(), look.textures.end(), grammar.space.textures[scene.things[one].texture]) > 0);
  drawn::PersonRule any;
  any.types.set();
  any.textures.set();
  for (const auto& place : grammar.places) {
    any.place = place.first;
    all.push_back(drawn::taken_by(any, scene.things, scene.goal).front() == one);
  }
  return all;
}

std::vector<bool> shared_by(const Shown& shown, const drawn::PersonGrammar& grammar) {
  std::vector<bool> shared;
  for (const auto& [scene, one] : shown) {
    const std::vector<bool> had = features_of(scene, one, grammar);
    if (shared.empty()) shared.assign(had.size(), true);
    for (std::size_t i = 0; i < had.size(); ++i) shared[i] = shared[i] && had[i];
  }
  return shared;
}

// All shared features as one meaning, of places the first.
Meaning meaning_of_shared(const std::vector<bool>& shared, const drawn::PersonGrammar::Words& words,
                          const drawn::PersonGrammar& grammar) {
  Meaning meaning(words.types, grammar.space.textures);
  if (shared.empty()) return meaning;
  const std::size_t types = grammar.space.object_types.size();
  for (std::size_t i = 0; i < types; ++i)
    if (shared[i]) meaning.sets.front().object_types = {grammar.space.object_types[i]};
  for (std::size_t i = 0; i < grammar.looks.size(); ++i) {
    if (!shared[types + i]) continue;
    auto& textures = meaning.sets.front().textures;
    const auto& look = grammar.looks[i].textures;
    textures.erase(std::remove_if(textures.begin(), textures.end(),
                                  [&](const auto& name) { return std::count(look.begin(), look.end(), name) == 0; }),
                   textures.end());
  }
  for (std::size_t i = 0; i < grammar.places.size() && !meaning.which; ++i)
    if (shared[types + grammar.looks.size() + i]) {
      drawn::PersonRule place;
      place.place = grammar.places[i].first;
      meaning.which = drawn::meaning_of(place, grammar.space).which;
    }
  return meaning;
}

// Takes what scores most.
using Score = std::function<std::vector<double>(const Standing& scene)>;

class ByScene final : public Policy {
 public:
  ByScene(ActionSpace actions, FeatureSpace space, std::map<std::string, Score> scores)
      : actions_(std::move(actions)), space_(std::move(space)), scores_(std::move(scores)) {}

  Action act(const Observation& observation, const Instruction& instruction) override {
    const Standing scene = drawn::standing(placed(observation), space_);
    const std::vector<double> scores = scores_.at(instruction.utterance)(scene);
    const double most = *std::max_element(scores.begin(), scores.end());
    std::vector<std::uint8_t> ids;
    for (std::size_t i = 0; i < scores.size(); ++i)
      if (scores[i] >= most - 1e-9) ids.push_back(scene.ids[i]);
    return pointed_at(observation, any_in_view(ids, observation), actions_);
  }

 private:
  ActionSpace actions_;
  FeatureSpace space_;
  std::map<std::string, Score> scores_;
};

class PersonRuleMethod final : public CloningMethod {
 public:
  Needs needs(const Json& options) const override {
    Needs needs = CloningMethod::needs(options);
    needs.targets = Needs::Targets::truth;
    needs.revise = true;
    return needs;
  }

  Selection select(const Command& command, const FeatureSpace& space, Services&) override {
    if (!grammar_) grammar_ = drawn::person_grammar(space);
    Selection selection;
    selection.target = Meaning(words_of(command).types, space.textures);
    selection.provenance = Provenance::rule;
    return selection;
  }

  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override {
    const std::string learns = services.options.at("learns");
    if (learns == "words") return selected;
    Shown shown;
    for (const Demonstration& one : demonstrations) {
      if (one.instruction.utterance != command.utterance) continue;
      if (one.steps.size() != 1)
        throw MethodError("learns " + learns + ": expected demonstrations of one step, got " +
                          std::to_string(one.steps.size()) + ": a person's rule says what is taken once");
      const std::vector<Placed> visible = placed(one.steps.at(0).observation);
      const auto is_goal = [](const Placed& object) { return is_place(object.instance.object_type); };
      if (std::none_of(visible.begin(), visible.end(), is_goal)) continue;  // rules speak of a place in view
      Standing scene = drawn::standing(visible, grammar_->space);
      const auto instance = taken(one, services.actions);
      const auto at = std::find(scene.ids.begin(), scene.ids.end(), instance.value_or(0));
      if (at == scene.ids.end()) continue;
      const auto number = static_cast<std::size_t>(at - scene.ids.begin());
      shown.emplace_back(std::move(scene), number);
    }
    Selection revised = selected;
    if (learns == "common_looks") {
      const std::vector<bool> shared = shared_by(shown, *grammar_);
      revised.target = meaning_of_shared(shared, words_of(command), *grammar_);
      scores_[command.utterance] = [shared, grammar = *grammar_](const Standing& scene) {
        std::vector<double> all;
        for (std::size_t i = 0; i < scene.things.size(); ++i) {
          const std::vector<bool> had = features_of(scene, i, grammar);
          double count = 0;
          for (std::size_t k = 0; k < shared.size(); ++k) count += shared[k] && had[k];
          all.push_back(count);
        }
        return all;
      };
      return revised;
    }
    std::vector<drawn::PersonRule> rules = drawn::rules_of(*grammar_, words_of(command).types);
    if (learns == "bayes_hint")
      if (const auto* const hint = drawn::hint_in(*grammar_, command.utterance)) rules = drawn::left_by(*hint, rules);
    Belief belief(std::move(rules));
    for (const auto& [scene, one] : shown) belief.took(scene, one);
    ask(command, shown, belief, services);
    revised.target = drawn::meaning_of(belief.rules()[belief.likeliest()], grammar_->space);
    scores_[command.utterance] = [belief](const Standing& scene) { return belief.takes(scene); };
    return revised;
  }

  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    if (services.options.at("choice") == "selection") return CloningMethod::learn(demonstrations, services);
    return std::make_unique<ByScene>(services.actions, grammar_->space, scores_);
  }

 private:
  const drawn::PersonGrammar::Words& words_of(const Command& command) const {
    const auto* const words = drawn::words_in(*grammar_, command.utterance);
    if (!words) throw MethodError("\"" + command.utterance + "\": expected words of the grammar of persons");
    return *words;
  }

  // As long as the budget lasts, what tells most for its price, or anything; no question twice.
  void ask(const Command& command, const Shown& shown, Belief& belief, Services& services) const {
    const int budget = services.options.at("questions");
    const bool random = services.options.at("asks") == "random";
    if (budget == 0) return;
    constexpr int undemonstrated = 4;
    std::vector<Standing> scenes;
    for (int i = 0; i < static_cast<int>(shown.size()) + undemonstrated; ++i)
      scenes.push_back(drawn::standing(services.human.scene(command, i), grammar_->space));
    struct Asked {
      std::size_t scene;
      std::optional<std::size_t> one;
    };
    std::vector<Asked> open;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      open.push_back({i, std::nullopt});
      for (std::size_t k = 0; k < scenes[i].things.size(); ++k) open.push_back({i, k});
    }
    RandomStream stream("person_rule/asks/" + command.utterance);
    for (int left = budget; left > 0;) {
      open.erase(std::remove_if(open.begin(), open.end(),
                                [left](const Asked& one) { return !one.one && left < price_of_which; }),
                 open.end());
      if (open.empty()) return;
      std::size_t best = 0;
      if (random) {
        best = stream.below(static_cast<std::uint32_t>(open.size()));
      } else {
        double most = -1;
        for (std::size_t i = 0; i < open.size(); ++i) {
          const double learnt =
              belief.expected_bits(scenes[open[i].scene], open[i].one, errs) / (open[i].one ? 1 : price_of_which);
          if (learnt > most + 1e-9) {
            most = learnt;
            best = i;
          }
        }
      }
      const Asked asked = open[best];
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(best));
      const Standing& scene = scenes[asked.scene];
      const int number = static_cast<int>(asked.scene);
      if (asked.one) {
        belief.said(scene, *asked.one, services.human.takes(command, number, scene.ids[*asked.one]), errs);
        --left;
        continue;
      }
      const std::optional<std::uint8_t> id = services.human.which(command, number);
      std::optional<std::size_t> one;
      for (std::size_t k = 0; k < scene.ids.size(); ++k)
        if (id == scene.ids[k]) one = k;
      belief.said(scene, one, errs);
      left -= price_of_which;
    }
  }

  std::optional<drawn::PersonGrammar> grammar_;
  std::map<std::string, Score> scores_;
};

}  // namespace

LGABENCH_METHOD_ASKING(
    "accept", "person_rule", "0.1", "What a person wants and does not say, by the grammar of persons", PersonRuleMethod,
    "{"
    R"("learns": {"default": "bayes", "values": ["words", "common_looks", "bayes", "bayes_hint"], )"
    R"("help": "words: nothing; common_looks: what all taken objects share; bayes: the rules' probabilities; )"
    R"(bayes_hint: those of the rules that the command's hint leaves", )"
    R"("source": "ours"}, "choice": {"default": "selection", "values": ["selection", "scene"], )"
    R"("help": "one Selection, of the likeliest rule; scene: what is likeliest taken, or shares most, in each scene", )"
    R"("source": "ours", "needs": {"scene": {"learns": ["common_looks", "bayes", "bayes_hint"]}}}, )"
    R"("questions": {"default": 0, "min": 0, "help": "to each person at most; which of these counts three", )"
    R"("source": "ours"}, "asks": {"default": "best", "values": ["best", "random"], )"
    R"("help": "what is expected to tell most for its price, or anything", "source": "ours"}, )" LGABENCH_CLONING_OPTIONS
    "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
