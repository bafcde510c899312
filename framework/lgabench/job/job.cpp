#include <lgabench/job/job.hpp>

#include <fmt/format.h>

#include <limits>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {
namespace {

std::string full_path(const fs::path& path) { return fs::absolute(path).string(); }

Json to_json(const Limits& limits) { return {{"cpu_s", limits.cpu_s}, {"data_bytes", limits.data_bytes}}; }

// A plugin in Python cannot be read again without its interpreter: what was read of it goes along.
Json plugin_json(const PluginInfo& plugin) {
  Json json{{"file", full_path(plugin.file)}, {"sha256", plugin.sha256}};
  if (!plugin.python.is_null())
    json.update({{"kind", plugin.kind},
                 {"id", plugin.id},
                 {"asks", plugin.asks},
                 {"axis", plugin.axis},
                 {"python", plugin.python}});
  return json;
}

PluginInfo plugin_of(const JsonReader& reader) {
  PluginInfo info;
  if (reader.has("python")) {
    info.file = reader.at("file").string();
    info.kind = reader.at("kind").string();
    info.id = reader.at("id").string();
    info.asks = reader.at("asks").string();
    info.sha256 = sha256_file(info.file);
    info.axis = reader.at("axis").json();
    info.python = reader.at("python").json();
  } else {
    info = read_plugin(reader.at("file").string());
  }
  if (info.sha256 != reader.at("sha256").string())
    throw PluginError(fmt::format("{}: changed since the run began", info.file.string()));
  return info;
}

Json to_json(const LiveModel& live) {
  return {{"cassette", full_path(live.cassette)},
          {"asks", live.asks},
          {"max_queries", live.max_queries},
          {"reply_timeout_s", live.reply_timeout_s},
          {"concurrency", live.concurrency}};
}

LiveModel live_of(const JsonReader& reader) {
  return {reader.at("cassette").string(), reader.at("asks").boolean(),
          static_cast<int>(reader.at("max_queries").integer(-1, 1 << 30)),
          static_cast<long>(reader.at("reply_timeout_s").integer(1, 1 << 30)),
          static_cast<int>(reader.at("concurrency").integer(1, 64))};
}

Action action_of(const JsonReader& numbers) {
  Action action;
  for (const JsonReader& number : numbers.elements()) action.push_back(number.number());
  return action;
}

std::string text(const Json& line, const char* member) {
  return line.contains(member) && line[member].is_string() ? line[member].get<std::string>() : std::string();
}

long long number(const Json& line, const char* member) {
  return line.contains(member) && line[member].is_number_integer() ? line[member].get<long long>() : 0;
}

}  // namespace

Limits read_limits(const JsonReader& job) {
  const JsonReader limits = job.at("limits");
  return {limits.at("cpu_s").integer(1, 1LL << 40), limits.at("data_bytes").integer(1, 1LL << 60)};
}

Json to_json(const CellJob& job) {
  Json json{{"cell", to_json(job.cell)},
            {"engine", plugin_json(job.engine)},
            {"directory", full_path(job.directory)},
            {"cache", full_path(job.cache)},
            {"answers", full_path(job.answers)},
            {"scratch", job.scratch.string()},
            {"build", job.build},
            {"confined", job.confined},
            {"attributed", job.attributed},
            {"keeps_policy", job.keeps_policy},
            {"limits", to_json(job.limits)}};
  if (job.method) json["method"] = plugin_json(*job.method);
  if (job.acts) json["acts"] = plugin_json(*job.acts);
  for (const PluginInfo& axis : job.axes) json["axes"].push_back(plugin_json(axis));
  if (job.perceiver) json["perceiver"] = plugin_json(*job.perceiver);
  if (job.live) json["live"] = to_json(*job.live);
  if (job.debugger) json["debugger"] = *job.debugger;
  return json;
}

CellJob read_cell_job(const JsonReader& reader) {
  CellJob job{read_cell(reader.at("cell").json(), reader.file() + ": /cell"),
              plugin_of(reader.at("engine")),
              std::nullopt,
              reader.at("directory").string(),
              reader.at("cache").string(),
              reader.at("answers").string(),
              reader.at("scratch").string(),
              reader.at("build").json(),
              reader.at("confined").boolean(),
              read_limits(reader)};
  if (reader.has("method")) job.method = plugin_of(reader.at("method"));
  if (job.cell.method.is_reference() == job.method.has_value())
    reader.at("cell").fail("a plugin for a method, and only there");
  if (reader.has("acts")) job.acts = plugin_of(reader.at("acts"));
  if (job.cell.method.acts.has_value() != job.acts.has_value()) reader.at("cell").fail("a plugin for what acts");
  job.attributed = reader.at("attributed").boolean();
  job.keeps_policy = reader.at("keeps_policy").boolean();
  if (reader.has("axes"))
    for (const JsonReader& axis : reader.at("axes").elements()) job.axes.push_back(plugin_of(axis));
  if (reader.has("perceiver")) job.perceiver = plugin_of(reader.at("perceiver"));
  if (reader.has("live")) job.live = live_of(reader.at("live"));
  if (reader.has("debugger")) job.debugger = reader.at("debugger").strings();
  return job;
}

Json to_json(const CheckJob& job) {
  Json json{{"engine", plugin_json(job.engine)}, {"options", job.options},
            {"scratch", job.scratch.string()},   {"perturb", job.perturb},
            {"report", job.report.string()},     {"limits", to_json(job.limits)},
            {"environment", job.environment}};
  if (job.method) json["method"] = plugin_json(*job.method);
  if (job.perturbation) json["perturbation"] = plugin_json(*job.perturbation);
  return json;
}

CheckJob read_check_job(const JsonReader& reader) {
  CheckJob job{plugin_of(reader.at("engine")),
               std::nullopt,
               reader.at("options").json(),
               reader.at("scratch").string(),
               static_cast<int>(reader.at("perturb").integer(0, 255)),
               reader.at("report").string(),
               read_limits(reader),
               reader.at("environment").string()};
  if (reader.has("method")) job.method = plugin_of(reader.at("method"));
  if (reader.has("perturbation")) job.perturbation = plugin_of(reader.at("perturbation"));
  return job;
}

Json to_json(const AskJob& job) {
  return {
      {"model", job.model}, {"live", to_json(job.live)}, {"scenarios", job.scenarios}, {"limits", to_json(job.limits)}};
}

AskJob read_ask_job(const JsonReader& reader) {
  AskJob job{reader.at("model").string(), live_of(reader.at("live")), {}, read_limits(reader)};
  for (const JsonReader& scenario : reader.at("scenarios").elements()) job.scenarios.push_back(scenario.json());
  return job;
}

Json to_json(const PictureRequest& request) {
  Json json{{"cell", request.cell.string()}, {"arm", request.arm},    {"index", request.index},
            {"scene", request.scene},        {"ends", Json::array()}, {"selections", request.selections}};
  for (const PictureRequest::End& end : request.ends)
    json["ends"].push_back({{"engine", end.engine}, {"action", end.action}});
  return json;
}

Json to_json(const OracleRequest& request) {
  return {{"cell", request.cell.string()}, {"arm", request.arm}, {"index", request.index}, {"scene", request.scene}};
}

OracleRequest read_oracle_request(const JsonReader& reader) {
  return {reader.at("cell").string(), reader.at("arm").string(),
          static_cast<int>(reader.at("index").integer(0, std::numeric_limits<int>::max())),
          reader.at("scene").string()};
}

Json to_json(const OracleActions& answer) {
  return answer.problem.empty() ? Json{{"actions", answer.actions}} : Json{{"problem", answer.problem}};
}

OracleActions read_oracle_actions(const JsonReader& reader) {
  OracleActions answer;
  if (reader.has("problem")) {
    answer.problem = reader.at("problem").string();
    return answer;
  }
  for (const JsonReader& action : reader.at("actions").elements()) answer.actions.push_back(action_of(action));
  return answer;
}

PictureRequest read_picture_request(const JsonReader& reader) {
  PictureRequest request{reader.at("cell").string(), reader.at("arm").string(),
                         static_cast<int>(reader.at("index").integer(0, std::numeric_limits<int>::max())),
                         reader.at("scene").string()};
  for (const JsonReader& selection : reader.at("selections").elements()) request.selections.push_back(selection.json());
  if (!reader.has("ends")) return request;
  for (const JsonReader& end : reader.at("ends").elements())
    request.ends.push_back({end.at("engine").string(), action_of(end.at("action"))});
  return request;
}

Json to_json(const PhaseCount& message) { return {{"phase", message.phase}, {"count", message.count}}; }

Json to_json(const Complaint& message) {
  return {{"reason", message.reason},
          {"fault", message.by_plugin ? "plugin" : "host"},
          {"signal", message.signal},
          {"refused", message.refused}};
}

std::optional<PhaseCount> read_phase_count(const Json& line) {
  if (!line.is_object() || !line.contains("phase")) return std::nullopt;
  return PhaseCount{text(line, "phase"), number(line, "count")};
}

std::optional<Complaint> read_complaint(const Json& line) {
  if (!line.is_object() || !line.contains("reason")) return std::nullopt;
  return Complaint{text(line, "reason"), text(line, "fault") == "plugin", static_cast<int>(number(line, "signal")),
                   line.value("refused", Json()) == true};
}

}  // namespace lgabench
