#include <lgabench/record/episode.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/fields.hpp>

namespace lgabench {
namespace {

Action read_action(const JsonReader& reader) {
  if (reader.json().is_null()) return {};
  if (!reader.json().is_array() || reader.json().empty()) reader.fail("the numbers of an action, or null");
  Action action;
  for (const Json& number : reader.json()) {  // a reader for each would cost more than the numbers
    if (!number.is_number()) reader.elements().at(action.size()).fail("a number");
    action.push_back(number.get<double>());
  }
  return action;
}

}  // namespace

static void fields(Progress& progress, Fields& field) {
  field("right", progress.right);
  field("needed", progress.needed, at_least(1));
}

void fields(Episode& e, Fields& field) {
  const JsonReader* const reader = field.reading();
  bool success = e.success();
  field("arm", e.arm);
  field("index", e.index);
  field("command", e.command);
  field("scene", e.scene);
  field("failure", e.failure);
  field("success", success);
  if (reader && success != e.success()) reader->at("failure").fail("\"none\" exactly on success");
  constexpr const char* blamed = "{} on a method's failure, or null";
  field("attribution", e.attribution, or_null(e.attribution.empty(), one_of(attributions, {}, blamed)));
  if (reader && success && !e.attribution.empty())
    reader->at("attribution").fail(fmt::format(blamed, fmt::join(attributions, ", ")));
  if (reader)
    e.action = read_action(reader->at("action"));
  else
    field("action", e.action, or_null(e.action.empty()));
  field("then", e.then, when(!e.then.empty()));
  if (reader && !e.then.empty() && (e.action.empty() || contains(e.then, Action())))
    reader->at("then").fail("the numbers of actions, and of an \"action\" before them");
  field("done", e.done, when(e.done));
  field("pair", e.pair, when(!e.pair.empty()));
  field("progress", e.progress, when(e.progress.has_value()));
  if (reader && e.progress && (e.progress->right > e.progress->needed || (e.progress->share() == 1) != success))
    reader->at("progress").fail("at most as many right steps as are needed, and as many exactly on success");
  field("input_seen", e.input_seen, when(e.input_seen.has_value()));
  field("told", e.told, when(e.told.has_value()));
  field("took", e.took, one_of(takings, when(!e.took.empty()), "{}"));
}

std::vector<Action> Episode::actions() const {
  std::vector<Action> all;
  if (!action.empty()) all.push_back(action);
  all.insert(all.end(), then.begin(), then.end());
  if (done) all.emplace_back();
  return all;
}

void Episode::add(Action next) {
  if (next.empty())
    done = true;
  else if (action.empty())
    action = std::move(next);
  else
    then.push_back(std::move(next));
}

Json to_json(const Episode& episode) { return json_of(episode); }

Episode read_episode(const JsonReader& reader) { return value_of<Episode>(reader, false); }

}  // namespace lgabench
