// What is meant next in an errand, by the truth with some of its parts replaced: what belongs, how it is used, when
// that is asked, and which reading of names counts. With all defaults it is the truth, asked anew at each step. The
// policy learns in all rows from the same masks, those of the truth, so that only what it is told differs.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/turns.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/plugin/plugin.hpp>

#include "hows.hpp"
#include "labels.hpp"

namespace lgabench {
namespace {

Named name_of(const Instance& one) { return {one.object_type, one.texture}; }

// In view, without places.
std::vector<Named> on_table(const Observation& seen) {
  std::vector<Named> names;
  for (const Instance& one : seen.instances)
    if (one.pixels > 0 && !is_place(one.object_type)) names.push_back(name_of(one));
  return names;
}

std::vector<Chosen> steps_of(const Demonstration& shown, const ActionSpace& actions) {
  std::vector<Chosen> steps;
  for (const Step& step : shown.steps) {
    steps.push_back({on_table(step.observation), step.observation.brought, std::nullopt});
    const auto id = taken(step, actions);
    for (const Instance& one : step.observation.instances)
      if (one.id == id) steps.back().took = name_of(one);
  }
  return steps;
}

// Of one word or more, in small letters and without a plural's s.
std::set<std::string> words_of(const std::string& text) {
  std::set<std::string> words;
  std::string word;
  for (const char c : text + ".") {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    while (word.size() > 1 && word.back() == 's') word.pop_back();
    if (!word.empty()) words.insert(word);
    word.clear();
  }
  return words;
}

// Of what was demonstrated, by utterance.
using Demonstrated = std::map<std::string, std::vector<std::vector<Chosen>>>;

// The demonstrated command that shares the rarest words with the utterance.
std::string nearest_in_words(const std::string& utterance, const Demonstrated& shown) {
  std::map<std::string, int> commands;  // that have a word
  for (const auto& one : shown)
    for (const std::string& word : words_of(one.first)) ++commands[word];
  const std::set<std::string> said = words_of(utterance);
  std::string nearest;
  double most = -1;
  for (const auto& one : shown) {
    double shared = 0;
    for (const std::string& word : words_of(one.first))
      if (said.count(word) > 0) shared += std::log(static_cast<double>(shown.size()) / commands[word]);
    if (shared <= most) continue;
    most = shared;
    nearest = one.first;
  }
  return nearest;
}

// Reads names at each step as they come, as they were read first, or as they were read most often.
class Readings {
 public:
  enum class Keeps { each, first, majority };
  explicit Readings(Keeps keeps) : keeps_(keeps) {}

  void clear() { *this = Readings(keeps_); }

  Observation read(Observation seen) {
    if (keeps_ == Keeps::each) return seen;
    note_brought(seen);
    last_.clear();
    for (Instance& one : seen.instances) {
      std::vector<Named>& readings = all_[one.id];
      readings.push_back(name_of(one));
      const Named& kept = keeps_ == Keeps::first ? readings.front() : most_frequent(readings);
      last_[one.id] = {readings.back(), kept};
      one.object_type = kept.object_type;
      one.texture = kept.texture;
    }
    seen.brought = brought_;
    return seen;
  }

 private:
  struct Read {
    Named now, kept;
  };

  static const Named& most_frequent(const std::vector<Named>& readings) {
    return *std::max_element(readings.begin(), readings.end(), [&readings](const Named& a, const Named& b) {
      return std::count(readings.begin(), readings.end(), a) < std::count(readings.begin(), readings.end(), b);
    });
  }

  // What left the table since has the name that was kept for it.
  void note_brought(const Observation& seen) {
    for (std::size_t i = brought_.size(); i < seen.brought.size(); ++i) {
      brought_.push_back(seen.brought[i]);
      for (auto one = last_.begin(); one != last_.end(); ++one) {
        const auto is_it = [&one](const Instance& other) { return other.id == one->first; };
        const bool is_there = std::any_of(seen.instances.begin(), seen.instances.end(), is_it);
        if (is_there || !(one->second.now == seen.brought[i])) continue;
        brought_.back() = one->second.kept;
        last_.erase(one);
        break;
      }
    }
  }

  Keeps keeps_;
  std::map<std::uint8_t, std::vector<Named>> all_;
  std::map<std::uint8_t, Read> last_;  // of the step before
  std::vector<Named> brought_;
};

// Names of what to bring next, any of them; none at all: nothing is left to do.
using Next = std::vector<Named>;
using Asks = std::function<Next(const std::vector<Named>& on_table, const std::vector<Named>& brought)>;

Next wanted_next(const Meaning& meaning, const std::vector<Named>& on_table, const std::vector<Named>& brought) {
  return is_done(meaning, on_table, brought) ? Next() : wanted(meaning, on_table, brought);
}

// What is most probably right; of "done" and a take that are as probable, "done".
Next likeliest_next(const Hows& hows, const std::vector<Named>& on_table, const std::vector<Named>& brought) {
  constexpr double equal = 1e-9;
  const Hows::Odds odds = hows.odds(on_table, brought);
  double most = odds.done;
  for (const auto& one : odds.wanted) most = std::max(most, one.second);
  Next next;
  if (odds.done >= most - equal) return next;
  for (const auto& [name, of_it] : odds.wanted)
    if (of_it >= most - equal) next.push_back(name);
  return next;
}

// All that is brought if nobody looks again, one after the other.
Next planned(const Asks& asks, std::vector<Named> on_table) {
  Next plan;
  while (true) {
    const Next next = asks(on_table, plan);
    if (next.empty()) return plan;
    plan.push_back(next.front());
    on_table.erase(std::find(on_table.begin(), on_table.end(), plan.back()));
  }
}

enum class Moment { each, first, planned };

// Tells a policy, at each step, the names of what to bring next.
class BringsNext : public Policy {
 public:
  BringsNext(std::unique_ptr<Policy> policy, Moment moment, Readings readings, std::map<std::string, Hows> hows,
             bool may_stop)
      : policy_(std::move(policy)),
        moment_(moment),
        readings_(std::move(readings)),
        hows_(std::move(hows)),
        may_stop_(may_stop) {}

  void reset() override {
    policy_->reset();
    readings_.clear();
    at_first_.reset();
  }

  Action act(const Observation& observation, const Instruction& instruction) override {
    const Meaning& meaning = instruction.selection.target;
    if (meaning.which) return policy_->act(observation, instruction);
    const Observation read = readings_.read(observation);
    const auto hows = hows_.find(instruction.utterance);
    const bool is_own = hows != hows_.end() && hows->second.likeliest() == meaning;  // not what somebody else is told
    const Next next = at_its_moment(
        [&](const std::vector<Named>& on_table, const std::vector<Named>& brought) {
          return is_own ? likeliest_next(hows->second, on_table, brought) : wanted_next(meaning, on_table, brought);
        },
        on_table(read), read.brought);
    if (next.empty() && may_stop_) return {};
    Instruction told = instruction;
    told.selection.target = Meaning();
    if (!next.empty()) told.selection.target.sets.clear();
    for (const Named& one : next) told.selection.target.sets.push_back({{one.object_type}, {one.texture}});
    return policy_->act(read, told);
  }
  std::optional<bool> seen_in_training() const override { return policy_->seen_in_training(); }
  Shown shown() const override { return policy_->shown(); }

 private:
  Next at_its_moment(const Asks& asks, const std::vector<Named>& on_table, const std::vector<Named>& brought) {
    if (moment_ == Moment::each) return asks(on_table, brought);
    if (!at_first_) at_first_ = moment_ == Moment::first ? asks(on_table, {}) : planned(asks, on_table);
    if (moment_ == Moment::planned)
      return brought.size() < at_first_->size() ? Next{(*at_first_)[brought.size()]} : Next();
    Next left;
    std::copy_if(at_first_->begin(), at_first_->end(), std::back_inserter(left),
                 [&on_table](const Named& one) { return contains(on_table, one); });
    return left;
  }

  std::unique_ptr<Policy> policy_;
  Moment moment_;
  Readings readings_;
  std::map<std::string, Hows> hows_;  // by utterance
  bool may_stop_;
  std::optional<Next> at_first_;  // of this episode
};

class ErrandMethod : public CloningMethod {
 public:
  Needs needs(const Json&) const override {
    Needs needs{Needs::Targets::truth};
    needs.revise = true;
    return needs;
  }

  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    space_ = space;
    return truth_[command.utterance] = services.truth(command);
  }

  // What is told: the truth with its parts replaced.
  Selection revise(const Command& command, const Selection& selected, const std::vector<Demonstration>& demonstrations,
                   Services& services) override {
    for (const Demonstration& one : demonstrations)
      if (!has_read_) shown_[one.instruction.utterance].push_back(steps_of(one, services.actions));
    has_read_ = true;
    Selection revised = selected;
    Meaning& meaning = revised.target;
    const std::string sets = services.options.at("sets");
    if (sets != "truth") {
      const bool nearest = services.options.at("shown_by") == "nearest";
      const std::vector<FeatureSet>& learnt =
          learnt_of(sets, nearest ? nearest_in_words(command.utterance, shown_) : "");
      for (Turn& turn : meaning.turns) turn.sets = learnt;
      if (meaning.turns.empty())
        meaning.sets = learnt;
      else
        meaning = in_turns(meaning.turns);
    }
    use(services.options.at("how"), command.utterance, meaning);
    return revised;
  }

  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    static const std::map<std::string, Moment> moments{
        {"each", Moment::each}, {"first", Moment::first}, {"planned", Moment::planned}};
    static const std::map<std::string, Readings::Keeps> names{
        {"each", Readings::Keeps::each}, {"first", Readings::Keeps::first}, {"majority", Readings::Keeps::majority}};
    std::vector<Demonstration> shown = demonstrations;
    for (Demonstration& one : shown) one.instruction.selection = truth_.at(one.instruction.utterance);
    return std::make_unique<BringsNext>(
        CloningMethod::learn(shown, services), moments.at(services.options.at("moment")),
        Readings(names.at(services.options.at("readings"))), std::move(hows_), services.may_stop);
  }

 private:
  // What was demonstrated of the command, or of all where it was not.
  std::vector<std::vector<Chosen>> shown_of(const std::string& utterance) const {
    if (const auto found = shown_.find(utterance); found != shown_.end()) return found->second;
    std::vector<std::vector<Chosen>> all;
    for (const auto& one : shown_) all.insert(all.end(), one.second.begin(), one.second.end());
    return all;
  }

  const std::vector<FeatureSet>& learnt_of(const std::string& rule, const std::string& utterance) {
    static const std::map<std::string, Labels::Rule> rules{{"counts", Labels::Rule::counts},
                                                           {"names", Labels::Rule::names},
                                                           {"bayes", Labels::Rule::bayes},
                                                           {"part", Labels::Rule::part}};
    const auto [known, is_new] = learnt_.try_emplace(utterance);
    if (!is_new) return known->second;
    std::vector<Named> taken, left;
    for (const std::vector<Chosen>& steps : shown_of(utterance)) {
      std::vector<Named> rest = steps.front().on_table;
      for (const Chosen& step : steps) {
        if (!step.took) continue;
        taken.push_back(*step.took);
        const auto it = std::find(rest.begin(), rest.end(), *step.took);
        if (it != rest.end()) rest.erase(it);
      }
      left.insert(left.end(), rest.begin(), rest.end());
    }
    if (rule == "names" && !embeddings_) embeddings_.emplace();
    const EmbeddingOf embedding = [this](const std::string& name) -> const std::vector<float>& {
      return embeddings_->of(name);
    };
    return known->second = Labels(rules.at(rule), taken, left, embedding).in(space_);
  }

  // Replaces how the sets are used.
  void use(const std::string& how, const std::string& utterance, Meaning& meaning) {
    const std::set<std::string> said = words_of(utterance);
    Turn turn{meaning.sets, std::nullopt, {}, {}, false};
    if (how == "truth") return;
    if (how == "shown") {
      Hows hows(meaning);
      if (shown_.count(utterance) > 0)
        for (const std::vector<Chosen>& steps : shown_.at(utterance))
          for (const Chosen& step : steps) hows.saw(step);
      meaning = hows.likeliest();
      hows_.emplace(utterance, std::move(hows));
      return;
    }
    if (how == "habit") turn.take = habit(utterance);
    if (how == "two" || (how == "words" && said.count("two") > 0)) turn.take = 2;
    if ((how == "words" || how == "each") && said.count("each") > 0)
      turn.different = {said.count("colour") > 0 ? Part::texture : Part::object_type};
    meaning = in_turns({turn});
  }

  // How many were taken most often, one at least; of equal numbers the smaller.
  int habit(const std::string& utterance) const {
    std::map<int, int> times;
    for (const std::vector<Chosen>& steps : shown_of(utterance))
      ++times[static_cast<int>(std::count_if(steps.begin(), steps.end(), [](const Chosen& one) { return one.took; }))];
    const auto most =
        std::max_element(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == times.end() ? 1 : std::max(most->first, 1);
  }

  FeatureSpace space_;
  std::optional<SentenceEmbeddings> embeddings_;  // once they were needed
  std::map<std::string, Selection> truth_;        // by utterance, as those below
  bool has_read_ = false;
  Demonstrated shown_;
  std::map<std::string, std::vector<FeatureSet>> learnt_;
  std::map<std::string, Hows> hows_;
};

}  // namespace
}  // namespace lgabench

LGABENCH_METHOD_ASKING(
    "truth", "errand", "0.1", "What is meant next, by the truth with some of its parts replaced",
    lgabench::ErrandMethod,
    "{"
    R"("sets": {"default": "truth", "values": ["truth", "counts", "names", "bayes", "part"], )"
    R"("help": "what belongs: the truth, or what demonstrations' labels say by a rule, the command unread: counts of )"
    R"(types and textures that were taken; those, weighed by what the names mean; counts of what was taken over those )"
    R"(of what was left; the types or the textures alone", "source": "docs/relatives.md"}, )"
    R"("shown_by": {"default": "all", "values": ["all", "nearest"], )"
    R"("help": "whose labels: of all demonstrated commands, or of the one that shares the rarest words", )"
    R"("source": "docs/relatives.md", "needs": {"nearest": {"sets": ["counts", "names", "bayes", "part"]}}}, )"
    R"("how": {"default": "truth", "values": ["truth", "all", "two", "each", "words", "habit", "shown"], )"
    R"("help": "how it is used: the truth; all of it, or any two; one of each where the command says each, else all; )"
    R"(words: likewise, and two where it says two; habit: as many as demonstrations took most often; shown: by Bayes' )"
    R"(rule over a finite list, from the command's demonstrations", "source": "docs/relatives.md"}, )"
    R"("moment": {"default": "each", "values": ["each", "first", "planned"], )"
    R"("help": "when it is asked what is meant next: at each step, or once; planned: once, for all steps", )"
    R"("source": "docs/relatives.md"}, )"
    R"("readings": {"default": "each", "values": ["each", "first", "majority"], )"
    R"("help": "an object's names: as read at each step, as read first, or as read most often so far", )"
    R"("source": "docs/relatives.md"}, )" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS
    "}")
