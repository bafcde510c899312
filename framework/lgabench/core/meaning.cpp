#include <lgabench/core/meaning.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/turns.hpp>

namespace lgabench {
namespace {

constexpr std::size_t most_sets = 100, most_turns = 10;
constexpr int most_taken = 100;
constexpr const char* all_of_them = "all";  // of Turn::take

using Rule = Which::Rule;
constexpr std::array<std::pair<Rule, const char*>, 7> rules{{{Rule::left_of, "left_of"},
                                                             {Rule::right_of, "right_of"},
                                                             {Rule::nearest_to, "nearest_to"},
                                                             {Rule::farthest_from, "farthest_from"},
                                                             {Rule::leftmost, "leftmost"},
                                                             {Rule::rightmost, "rightmost"},
                                                             {Rule::first_in, "first_in"}}};

using ReadSet = std::function<FeatureSet(const JsonReader&)>;

Rule read_rule(const JsonReader& reader) {
  std::vector<std::string> words;
  for (const auto& [rule, word] : rules) {
    if (reader.json() == word) return rule;
    words.emplace_back(word);
  }
  reader.fail(fmt::format("one of {}", fmt::join(words, ", ")));
}

std::vector<std::string> read_order(const JsonReader& reader) {
  std::vector<std::string> order = reader.strings();
  if (order.empty()) reader.fail("at least one name");
  for (const JsonReader& name : reader.elements())
    if (std::count(order.begin(), order.end(), name.string()) > 1) name.fail("each name once");
  return order;
}

Which read_which(const JsonReader& reader, const ReadSet& read_set) {
  Which which;
  which.rule = read_rule(reader.at("rule"));
  if (which.needs_reference()) {
    reader.only({"rule", "of"});
    which.of = read_set(reader.at("of"));
    if (which.of->empty()) reader.at("of").fail("at least one object type and one texture");
  } else if (which.rule == Rule::first_in) {
    reader.only({"rule", "order"});
    which.order = read_order(reader.at("order"));
  } else {
    reader.only({"rule"});
  }
  return which;
}

std::vector<FeatureSet> read_sets(const JsonReader& reader, const ReadSet& read_set) {
  std::vector<FeatureSet> sets;
  const auto elements = reader.elements();
  if (elements.empty() || elements.size() > most_sets) reader.fail(fmt::format("1 to {} sets", most_sets));
  for (const JsonReader& set : elements) sets.push_back(read_set(set));
  return sets;
}

std::vector<Part> read_parts(const JsonReader& turn, const char* member) {
  std::vector<Part> parts;
  if (!turn.has(member)) return parts;
  for (const JsonReader& word : turn.at(member).elements()) {
    const auto is_it = [&word](Part part) { return word.json() == to_string(part); };
    if (!is_it(Part::object_type) && !is_it(Part::texture)) word.fail("object_type or texture");
    const Part part = is_it(Part::object_type) ? Part::object_type : Part::texture;
    if (contains(parts, part)) word.fail("each part once");
    parts.push_back(part);
  }
  if (parts.empty()) turn.at(member).fail("object_type, texture or both");
  return parts;
}

Turn read_turn(const JsonReader& reader, const ReadSet& read_set, bool is_first) {
  reader.only({"sets", "take", "same", "different", "only_if_nothing"});
  Turn turn{read_sets(reader.at("sets"), read_set), std::nullopt, read_parts(reader, "same"),
            read_parts(reader, "different"), reader.has("only_if_nothing") && reader.at("only_if_nothing").boolean()};
  if (const JsonReader take = reader.at("take"); take.json().is_string()) {
    if (take.json() != all_of_them) take.fail("\"all\" or a number");
  } else {
    turn.take = static_cast<int>(take.integer(1, most_taken));
  }
  if (turn.only_if_nothing && is_first) reader.at("only_if_nothing").fail("a turn before it");
  for (const Part part : turn.different)
    if (contains(turn.same, part)) reader.at("different").fail("no part in which they are alike");
  return turn;
}

Meaning read_turns(const JsonReader& reader, const ReadSet& read_set) {
  const auto elements = reader.elements();
  if (elements.empty() || elements.size() > most_turns) reader.fail(fmt::format("1 to {} turns", most_turns));
  std::vector<Turn> turns;
  for (const JsonReader& turn : elements) turns.push_back(read_turn(turn, read_set, turns.empty()));
  Meaning meaning = in_turns(std::move(turns));
  if (meaning.sets.size() > most_sets) reader.fail(fmt::format("1 to {} sets in all turns", most_sets));
  return meaning;
}

Meaning read_meaning(const JsonReader& reader, const ReadSet& read_set) {
  if (reader.has("turns")) {
    reader.only({"turns"});
    return read_turns(reader.at("turns"), read_set);
  }
  if (!reader.has("sets")) return read_set(reader);
  reader.only({"sets", "which"});
  Meaning meaning;
  meaning.sets = read_sets(reader.at("sets"), read_set);
  if (reader.has("which") && !reader.at("which").json().is_null())
    meaning.which = read_which(reader.at("which"), read_set);
  return meaning;
}

Json sets_json(const std::vector<FeatureSet>& sets) {
  Json json = Json::array();
  for (const FeatureSet& set : sets) json.push_back(to_json(set));
  return json;
}

Json turn_json(const Turn& turn) {
  Json json{{"sets", sets_json(turn.sets)}, {"take", turn.take ? Json(*turn.take) : Json(all_of_them)}};
  for (const auto& [member, parts] : {std::pair("same", &turn.same), std::pair("different", &turn.different)})
    for (const Part part : *parts) json[member].push_back(to_string(part));
  if (turn.only_if_nothing) json["only_if_nothing"] = true;
  return json;
}

bool all_in(const std::vector<std::string>& names, const std::vector<std::string>& space) {
  return std::all_of(names.begin(), names.end(), [&space](const std::string& name) { return contains(space, name); });
}

double distance(const Placed& a, const Placed& b) { return std::hypot(a.row - b.row, a.column - b.column); }

std::vector<Placed> those(const std::vector<Placed>& all, const std::function<bool(const Instance&)>& wanted) {
  std::vector<Placed> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some),
               [&wanted](const Placed& one) { return wanted(one.instance); });
  return some;
}

// By how much a candidate is the one: the smallest number is. Nothing for one that the rule does not rank.
std::optional<double> number_of(const Meaning& meaning, const Placed& one, const std::vector<Placed>& references) {
  const Which& which = *meaning.which;
  switch (which.rule) {
    case Rule::leftmost:
      return one.column;
    case Rule::rightmost:
      return -one.column;
    case Rule::first_in:
      return static_cast<double>(place_in_order(meaning, one.instance.object_type, one.instance.texture));
    default:
      break;
  }
  const auto nearer = [&one](const Placed& a, const Placed& b) { return distance(one, a) < distance(one, b); };
  const Placed& reference = *std::min_element(references.begin(), references.end(), nearer);
  if (which.rule == Rule::left_of && !(one.column < reference.column)) return std::nullopt;
  if (which.rule == Rule::right_of && !(one.column > reference.column)) return std::nullopt;
  return which.rule == Rule::farthest_from ? -distance(one, reference) : distance(one, reference);
}

std::vector<std::uint8_t> next_in_turn(const Meaning& meaning, const std::vector<Placed>& visible,
                                       const std::vector<Named>& brought) {
  const auto name = [](const Placed& one) { return Named{one.instance.object_type, one.instance.texture}; };
  std::vector<Named> on_table;
  std::transform(visible.begin(), visible.end(), std::back_inserter(on_table), name);
  const std::vector<Named> next = wanted(meaning, on_table, brought);
  std::vector<std::uint8_t> meant;
  for (const Placed& one : visible)
    if (contains(next, name(one))) meant.push_back(one.instance.id);
  return meant;
}

}  // namespace

bool operator==(const Which& a, const Which& b) { return a.rule == b.rule && a.of == b.of && a.order == b.order; }

std::string to_string(Which::Rule rule) {
  for (const auto& [value, word] : rules)
    if (value == rule) return word;
  throw Error("a Which::Rule outside its enumeration");
}

FeatureSet& Meaning::product() { return const_cast<FeatureSet&>(std::as_const(*this).product()); }

const FeatureSet& Meaning::product() const {
  if (!is_product())
    throw MethodError(turns.empty()
                          ? "a meaning that is more than one product of types and textures, where one product "
                            "was expected"
                          : "a meaning with turns, where one product of types and textures was expected: turns "
                            "are for commands that may stop (Command::may_stop)");
  return sets.front();
}

bool Meaning::belongs(const std::string& object_type, const std::string& texture) const {
  return any_contains(sets, object_type, texture);
}

bool Meaning::empty() const {
  return std::all_of(sets.begin(), sets.end(), [](const FeatureSet& set) { return set.empty(); });
}

bool operator==(const Meaning& a, const Meaning& b) {
  return a.sets == b.sets && a.which == b.which && a.turns == b.turns;
}

std::string to_string(Part part) { return part == Part::object_type ? "object_type" : "texture"; }

bool operator==(const Turn& a, const Turn& b) {
  return a.sets == b.sets && a.take == b.take && a.same == b.same && a.different == b.different &&
         a.only_if_nothing == b.only_if_nothing;
}

Meaning with_each_set(Meaning meaning, const std::function<FeatureSet(const FeatureSet&, std::size_t)>& change) {
  std::vector<FeatureSet> changed;
  for (const FeatureSet& set : meaning.sets) changed.push_back(change(set, changed.size()));
  for (Turn& turn : meaning.turns)
    for (FeatureSet& set : turn.sets) {
      const auto number = std::find(meaning.sets.begin(), meaning.sets.end(), set) - meaning.sets.begin();
      set = changed.at(static_cast<std::size_t>(number));
    }
  if (!meaning.turns.empty()) return in_turns(std::move(meaning.turns));
  meaning.sets = std::move(changed);
  return meaning;
}

Meaning in_turns(std::vector<Turn> turns) {
  Meaning meaning;
  meaning.sets.clear();
  for (const Turn& turn : turns)
    std::copy_if(turn.sets.begin(), turn.sets.end(), std::back_inserter(meaning.sets),
                 [&meaning](const FeatureSet& set) { return !contains(meaning.sets, set); });
  meaning.turns = std::move(turns);
  return meaning;
}

bool is_place(const std::string& object_type) { return object_type == "pallet"; }

std::size_t place_in_order(const Meaning& meaning, const std::string& object_type, const std::string& texture) {
  const auto& order = meaning.which->order;
  const auto held = [&](std::vector<std::string> FeatureSet::*kind) {
    return std::count_if(order.begin(), order.end(), [&](const std::string& name) {
      return std::any_of(meaning.sets.begin(), meaning.sets.end(),
                         [&](const FeatureSet& set) { return all_in({name}, set.*kind); });
    });
  };
  const bool textures = held(&FeatureSet::textures) > held(&FeatureSet::object_types);
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), textures ? texture : object_type) -
                                  order.begin());
}

std::vector<Placed> placed(const Observation& observation) {
  struct Sum {
    double rows = 0, columns = 0, pixels = 0;
  };
  std::array<Sum, 256> sums{};
  const auto columns = static_cast<std::size_t>(observation.size.columns);
  for (std::size_t i = 0; i < observation.ids.size(); ++i) {
    Sum& sum = sums[observation.ids[i]];
    sum.rows += static_cast<double>(i / columns);
    sum.columns += static_cast<double>(i % columns);
    ++sum.pixels;
  }
  std::vector<Placed> all;
  for (const Instance& instance : observation.instances)
    if (const Sum& sum = sums[instance.id]; sum.pixels > 0)
      all.push_back({instance, sum.rows / sum.pixels, sum.columns / sum.pixels});
  return all;
}

std::vector<std::uint8_t> grounded(const Meaning& meaning, const Observation& observation) {
  return grounded(meaning, placed(observation), observation.brought);
}

std::vector<std::uint8_t> grounded(const Meaning& meaning, const std::vector<Placed>& visible,
                                   const std::vector<Named>& brought) {
  if (!meaning.turns.empty()) return next_in_turn(meaning, visible, brought);
  const auto belongs = [&meaning](const Instance& one) { return meaning.belongs(one.object_type, one.texture); };
  std::vector<std::uint8_t> meant;
  if (!meaning.which) {
    for (const Placed& one : those(visible, belongs)) meant.push_back(one.instance.id);
    return meant;
  }
  const Which& which = *meaning.which;
  const auto matches = [&which](const Instance& one) {
    return which.of && which.of->contains(one.object_type, one.texture);
  };
  const std::vector<Placed> references = those(visible, matches);
  if (which.needs_reference() && references.empty()) return meant;
  std::vector<std::pair<double, std::uint8_t>> ranked;
  for (const Placed& one : visible) {
    if (!belongs(one.instance) || matches(one.instance) || is_place(one.instance.object_type)) continue;
    if (const auto number = number_of(meaning, one, references)) ranked.emplace_back(*number, one.instance.id);
  }
  if (ranked.empty()) return meant;
  constexpr double tie = .5;  // pixels, or less than a place in an order
  const double least = std::min_element(ranked.begin(), ranked.end())->first;
  for (const auto& [number, id] : ranked)
    if (number <= least + tie) meant.push_back(id);
  return meant;
}

Json to_json(const Meaning& meaning) {
  if (meaning.is_product()) return to_json(meaning.sets.front());
  if (!meaning.turns.empty()) {
    Json turns = Json::array();
    for (const Turn& turn : meaning.turns) turns.push_back(turn_json(turn));
    return {{"turns", std::move(turns)}};
  }
  Json json{{"sets", sets_json(meaning.sets)}};
  if (!meaning.which) return json;
  json["which"]["rule"] = to_string(meaning.which->rule);
  if (meaning.which->of) json["which"]["of"] = to_json(*meaning.which->of);
  if (!meaning.which->order.empty()) json["which"]["order"] = meaning.which->order;
  return json;
}

Meaning read_meaning(const JsonReader& reader, const FeatureSpace& space) {
  Meaning meaning = read_meaning(reader, [&space](const JsonReader& set) { return read_feature_set(set, space); });
  if (meaning.which && meaning.which->rule == Rule::first_in && !all_in(meaning.which->order, space.object_types) &&
      !all_in(meaning.which->order, space.textures))
    reader.at("which").at("order").fail("object types of the feature space alone, or textures alone");
  return meaning;
}

void expect_possible(const Meaning& meaning, const JsonReader& reader) {
  for (std::size_t i = 0; i < meaning.turns.size(); ++i) {
    const Turn& turn = meaning.turns[i];
    for (const Part part : turn.different) {
      std::set<std::string> names;
      for (const FeatureSet& set : turn.sets)
        for (const std::string& name : part == Part::object_type ? set.object_types : set.textures)
          if (!is_place(name)) names.insert(name);
      if (turn.take && static_cast<std::size_t>(*turn.take) > names.size())
        reader.at("turns").elements()[i].at("take").fail(
            fmt::format("at most {}: its sets have no more {}", names.size(),
                        part == Part::object_type ? "object types" : "textures"));
    }
  }
}

Meaning read_unchecked_meaning(const JsonReader& reader) {
  return read_meaning(reader, [](const JsonReader& set) {
    set.only({"object_types", "textures"});
    return FeatureSet{set.at("object_types").strings(), set.at("textures").strings()};
  });
}

}  // namespace lgabench
