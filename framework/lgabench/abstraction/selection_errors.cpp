#include <lgabench/abstraction/selection_errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/fields.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

using Names = std::vector<std::string>;

// Which names err, by one number for each name of the space, whatever was selected.
class Erring {
 public:
  Erring(const FeatureSpace& space, const SelectionErrors& errors, RandomStream& random, const std::string& never_meant)
      : errors_(errors), never_meant_(never_meant) {
    types_ = drawn(space.object_types, random);
    textures_ = drawn(space.textures, random);
  }

  FeatureSet operator()(const FeatureSet& selected, const FeatureSet& truth) const {
    FeatureSet set{after(types_, selected.object_types, truth.object_types),
                   after(textures_, selected.textures, truth.textures)};
    set.object_types.erase(std::remove(set.object_types.begin(), set.object_types.end(), never_meant_),
                           set.object_types.end());
    return set;
  }

 private:
  using Drawn = std::vector<std::pair<std::string, double>>;

  static Drawn drawn(const Names& names, RandomStream& random) {
    Drawn all;
    for (const std::string& name : names) all.emplace_back(name, random.uniform());
    return all;
  }
  Names after(const Drawn& all, const Names& selected, const Names& truth) const {
    Names some;
    for (const auto& [name, number] : all) {
      const bool right = contains(truth, name);
      if (number < (right ? errors_.missing : errors_.added) ? !right : contains(selected, name)) some.push_back(name);
    }
    return some;
  }

  SelectionErrors errors_;
  std::string never_meant_;
  Drawn types_, textures_;
};

Meaning erring(const Meaning& selected, const Meaning& truth, const Erring& errs) {
  if (selected.turns.empty() && !selected.is_product()) selected.product();  // which refuses it
  if (selected.sets.size() != truth.sets.size())
    throw MethodError(fmt::format("errors in what is selected: expected as many sets as are meant, {}, got {}",
                                  truth.sets.size(), selected.sets.size()));
  return with_each_set(selected, [&](const FeatureSet& set, std::size_t i) { return errs(set, truth.sets[i]); });
}

}  // namespace

std::string SelectionErrors::suffix() const {
  std::string words;
  if (added != 0) words += fmt::format("+added={}", added);
  if (missing != 0) words += fmt::format("+missing={}", missing);
  return words;
}

bool operator==(const SelectionErrors& a, const SelectionErrors& b) {
  return a.missing == b.missing && a.added == b.added;
}

void fields(SelectionErrors& errors, Fields& field) {
  field("missing", errors.missing, up_to(1, when(errors.missing != 0)));
  field("added", errors.added, up_to(1, when(errors.added != 0)));
}

Json to_json(const SelectionErrors& errors) { return json_of(errors); }

SelectionErrors read_selection_errors(const JsonReader& reader) { return value_of<SelectionErrors>(reader); }

std::string why_no_selection_errors(const Scenario& scenario) {
  for (const ScenarioCommand& command : scenario.commands)
    if (!command.truth.target.is_product() && command.truth.target.turns.empty())
      return fmt::format("expected commands that mean one product of types and textures, or turns, \"{}\" means more",
                         command.utterance);
  return "";
}

Selection with_errors(Selection selected, const Scenario& scenario, int command, const SelectionErrors& errors,
                      std::uint64_t training_seed, const std::string& never_meant) {
  const std::string& utterance = scenario.commands.at(static_cast<std::size_t>(command)).utterance;
  return with_errors(std::move(selected), scenario, command, errors,
                     RandomStream(fmt::format("selection_errors/{}/{}", utterance, training_seed)), never_meant);
}

Selection with_errors(Selection selected, const Scenario& scenario, int command, const SelectionErrors& errors,
                      RandomStream random, const std::string& never_meant) {
  if (errors.none() || selected.provenance == Provenance::none) return selected;
  const ScenarioCommand& meant = scenario.commands.at(static_cast<std::size_t>(command));
  selected.target = erring(selected.target, meant.truth.target, Erring(scenario.space, errors, random, never_meant));
  if (selected.second && meant.truth.second)
    static_cast<FeatureSet&>(*selected.second) =
        Erring(scenario.space, errors, random, never_meant)(*selected.second, *meant.truth.second);
  return selected;
}

}  // namespace lgabench
