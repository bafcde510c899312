#include <lgabench/record/episode.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace lgabench {

Json to_json(const Episode& e) {
  Json json{{"arm", e.arm},
            {"index", e.index},
            {"command", e.command},
            {"scene", e.scene},
            {"success", e.success()},
            {"failure", e.failure},
            {"action", e.action.empty() ? Json() : Json(e.action)},
            {"attribution", e.attribution.empty() ? Json() : Json(e.attribution)}};
  if (e.input_seen) json["input_seen"] = *e.input_seen;
  if (!e.took.empty()) json["took"] = e.took;
  if (e.told) json["told"] = *e.told;
  return json;
}

Episode read_episode(const JsonReader& reader) {
  constexpr long long most = std::numeric_limits<int>::max();
  Episode e;
  e.arm = reader.at("arm").string();
  e.index = static_cast<int>(reader.at("index").integer(0, most));
  e.command = static_cast<int>(reader.at("command").integer(0, most));
  e.scene = reader.at("scene").string();
  e.failure = reader.at("failure").string();
  if (reader.at("success").boolean() != e.success()) reader.at("failure").fail("\"none\" exactly on success");
  if (const JsonReader blamed = reader.at("attribution"); !blamed.json().is_null()) {
    e.attribution = blamed.string();
    if (e.success() || std::find(attributions.begin(), attributions.end(), e.attribution) == attributions.end())
      blamed.fail(fmt::format("{} on a method's failure, or null", fmt::join(attributions, ", ")));
  }
  if (const JsonReader action = reader.at("action"); !action.json().is_null()) {
    if (!action.json().is_array() || action.json().empty()) action.fail("the numbers of an action, or null");
    for (const Json& number : action.json()) {  // a reader for each would cost more than the numbers
      if (!number.is_number()) action.elements().at(e.action.size()).fail("a number");
      e.action.push_back(number.get<double>());
    }
  }
  if (reader.has("input_seen")) e.input_seen = reader.at("input_seen").boolean();
  if (reader.has("told")) e.told = static_cast<int>(reader.at("told").integer(0, most));
  if (reader.has("took")) {
    e.took = reader.at("took").string();
    if (std::find(takings.begin(), takings.end(), e.took) == takings.end())
      reader.at("took").fail(fmt::format("{}", fmt::join(takings, ", ")));
  }
  return e;
}

}  // namespace lgabench
