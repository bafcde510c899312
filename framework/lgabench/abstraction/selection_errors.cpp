#include <lgabench/abstraction/selection_errors.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/fields.hpp>
#include <lgabench/core/random.hpp>

namespace lgabench {
namespace {

using Names = std::vector<std::string>;

// Of all names in their order, those that are selected after errors.
Names erring(const Names& all, const Names& selected, const Names& truth, const SelectionErrors& errors,
             RandomStream& random) {
  Names some;
  for (const std::string& name : all) {
    const double drawn = random.uniform();  // for every name, so that no other's depends on what was selected
    const bool right = contains(truth, name);
    if (drawn < (right ? errors.missing : errors.added) ? !right : contains(selected, name)) some.push_back(name);
  }
  return some;
}

FeatureSet erring(const FeatureSpace& space, const FeatureSet& selected, const FeatureSet& truth,
                  const SelectionErrors& errors, RandomStream& random, const std::string& never_meant) {
  FeatureSet set{erring(space.object_types, selected.object_types, truth.object_types, errors, random),
                 erring(space.textures, selected.textures, truth.textures, errors, random)};
  set.object_types.erase(std::remove(set.object_types.begin(), set.object_types.end(), never_meant),
                         set.object_types.end());
  return set;
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
    if (!command.truth.target.is_product())
      return fmt::format("expected commands that mean one product of types and textures, \"{}\" means more",
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
  selected.target =
      erring(scenario.space, selected.target.product(), meant.truth.target.product(), errors, random, never_meant);
  if (selected.second && meant.truth.second)
    static_cast<FeatureSet&>(*selected.second) =
        erring(scenario.space, *selected.second, *meant.truth.second, errors, random, never_meant);
  return selected;
}

}  // namespace lgabench
