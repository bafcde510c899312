#include <lgabench/abstraction/quality.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/fields.hpp>

namespace lgabench {
namespace {

NameQuality quality_of(const std::vector<std::string>& selected, const std::vector<std::string>& truth) {
  const auto right =
      std::count_if(selected.begin(), selected.end(), [&](const std::string& name) { return contains(truth, name); });
  const auto share = [right](std::size_t of) {
    return of == 0 ? std::nullopt : std::optional(static_cast<double>(right) / static_cast<double>(of));
  };
  return {share(selected.size()), share(truth.size()), static_cast<double>(selected.size()),
          static_cast<double>(truth.size())};
}

SetQuality quality_of(const FeatureSet& selected, const FeatureSet& truth) {
  return {quality_of(selected.object_types, truth.object_types), quality_of(selected.textures, truth.textures)};
}

// All names that any of the sets holds, and all its pairs, each once.
std::vector<std::string> names(const Meaning& meaning, std::vector<std::string> FeatureSet::*kind) {
  std::set<std::string> all;
  for (const FeatureSet& set : meaning.sets) all.insert((set.*kind).begin(), (set.*kind).end());
  return {all.begin(), all.end()};
}

std::vector<std::string> pairs(const Meaning& meaning) {
  std::set<std::string> all;
  for (const FeatureSet& set : meaning.sets)
    for (const std::string& type : set.object_types)
      for (const std::string& texture : set.textures) all.insert(type + '\n' + texture);
  return {all.begin(), all.end()};
}

SetQuality quality_of(const Meaning& selected, const Meaning& truth) {
  if (selected.sets.size() == 1 && truth.sets.size() == 1) return quality_of(selected.sets[0], truth.sets[0]);
  const auto of = [&](auto kind) { return quality_of(names(selected, kind), names(truth, kind)); };
  return {of(&FeatureSet::object_types), of(&FeatureSet::textures), quality_of(pairs(selected), pairs(truth))};
}

NameQuality mean_names(const std::vector<NameQuality>& all) {
  const auto over = [&all](auto member) {
    std::vector<std::optional<double>> numbers;
    for (const NameQuality& one : all) numbers.emplace_back(one.*member);
    return mean_of(numbers);
  };
  return {over(&NameQuality::precision), over(&NameQuality::recall), over(&NameQuality::size).value_or(0),
          over(&NameQuality::true_size).value_or(0)};
}

// Written as count_json() says.
struct Count {
  double& value;
};
void visit(const Slot& slot, const Count& count, const Form& form) {
  visit(slot, count.value, form);
  if (slot.write) *slot.write = count_json(count.value);
}

}  // namespace

void fields(NameQuality& names, Fields& field) {
  constexpr double most_names = 1e6;
  field("precision", names.precision, or_null(!names.precision, up_to(1)));
  field("recall", names.recall, or_null(!names.recall, up_to(1)));
  field("size", Count{names.size}, up_to(most_names));
  field("true_size", Count{names.true_size}, up_to(most_names));
}

void fields(SetQuality& set, Fields& field) {
  field("object_types", set.object_types);
  field("textures", set.textures);
  field("pairs", set.pairs, when(set.pairs.has_value()));
}

std::optional<double> mean_of(const std::vector<std::optional<double>>& all) {
  std::optional<double> first;
  bool agree = true;
  double sum = 0;
  int n = 0;
  for (const auto& one : all) {
    if (!one) continue;
    if (n++ == 0) first = one;
    agree = agree && one == first;
    sum += *one;
  }
  return agree ? first : sum / n;
}

Json count_json(double count) { return count == std::floor(count) ? Json(static_cast<long long>(count)) : Json(count); }

Quality quality(const Selection& selection, const Selection& truth) {
  if (selection.provenance == Provenance::none) return {};
  Quality all{{"target", quality_of(selection.target, truth.target)}};
  if (selection.second || truth.second) {
    const FeatureSet nothing;
    all[(truth.second ? truth : selection).second->role] =
        quality_of(selection.second ? *selection.second : nothing, truth.second ? *truth.second : nothing);
  }
  return all;
}

Quality mean_quality(const std::vector<Quality>& all) {
  Quality mean;
  if (all.empty()) return mean;
  for (const auto& [set, first] : all.front()) {
    std::vector<NameQuality> types, textures, both;
    for (const Quality& one : all)
      if (const auto found = one.find(set); found != one.end()) {
        types.push_back(found->second.object_types);
        textures.push_back(found->second.textures);
        if (found->second.pairs) both.push_back(*found->second.pairs);
      }
    mean[set] = {mean_names(types), mean_names(textures)};
    if (!both.empty()) mean[set].pairs = mean_names(both);
  }
  return mean;
}

Json to_json(const SetQuality& quality) { return json_of(quality); }

Json to_json(const Quality& quality) {
  Json json;
  for (const auto& [set, one] : quality) json[set] = to_json(one);
  return json;
}

Quality read_quality(const JsonReader& reader) {
  Quality all;
  if (reader.json().is_null()) return all;
  if (!reader.has("target") || reader.at("target").json().is_null()) reader.fail("the quality of the target");
  for (const auto& item : reader.json().items())
    if (const JsonReader set = reader.at(item.key()); !set.json().is_null())
      all[item.key()] = value_of<SetQuality>(set, false);
  return all;
}

}  // namespace lgabench
