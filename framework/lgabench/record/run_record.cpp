#include <lgabench/record/run_record.hpp>

#include <fmt/format.h>

#include <lgabench/core/version.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/record/suite_claims.hpp>

namespace lgabench {
namespace {

std::string text_at(const JsonReader& reader, const char* member) {
  return reader.has(member) ? reader.at(member).string() : "";
}

Json object_at(const JsonReader& reader, const char* member) {
  if (!reader.has(member)) return Json::object();
  const JsonReader value = reader.at(member);
  if (!value.json().is_object()) value.fail("an object");
  return value.json();
}

std::vector<RunRecord::Plugin> plugins_at(const JsonReader& reader) {
  std::vector<RunRecord::Plugin> plugins;
  if (reader.has("plugins"))
    for (const JsonReader& plugin : reader.at("plugins").elements())
      plugins.push_back({plugin.at("kind").string(), plugin.at("id").string(), plugin.at("version").string(),
                         plugin.at("sha256").string(), text_at(plugin, "asks")});
  return plugins;
}

std::optional<RunRecord::Shard> shard_at(const JsonReader& reader, std::size_t cells) {
  if (!reader.has("shard") || reader.at("shard").json().is_null()) return std::nullopt;
  const JsonReader shard = reader.at("shard");
  RunRecord::Shard one;
  one.count = static_cast<int>(shard.at("count").integer(1, 1 << 30));
  one.index = static_cast<int>(shard.at("index").integer(1, one.count));
  one.cells = static_cast<std::size_t>(shard.at("cells").integer(0, static_cast<long long>(cells)));
  return one;
}

// "0.3" of "0.3.0"
std::string series(const std::string& version) { return version.substr(0, version.rfind('.')); }

}  // namespace

Json RunRecord::programs() const {
  Json all = build;
  for (const Plugin& plugin : plugins) all[plugin.kind + " " + plugin.id] = plugin.sha256;
  return all;
}

fs::path record_file(const fs::path& run) { return run / "run.json"; }

bool is_run(const fs::path& directory) {
  std::error_code not_there;
  return fs::exists(record_file(directory), not_there);
}

RunRecord read_run_record(const fs::path& run) {
  return read_run_record(read_json(record_file(run), Links::refused), record_file(run).string());
}

RunRecord read_run_record(const Json& json, const std::string& file) {
  const JsonReader reader(json, file);
  RunRecord record;
  record.version = reader.at("version").string();
  if (const std::string old = series(record.version); old == "0.1" || old == "0.2")
    throw InputError(
        fmt::format("{}: of lgabench {}, whose runs {} does not read", file, record.version, LGABENCH_VERSION));
  record.suite = reader.at("suite").string();
  record.preset = text_at(reader, "preset");
  record.smoke = reader.at("smoke").boolean();
  record.cells = read_cell_keys(reader);
  record.program = text_at(reader, "program");
  record.command = text_at(reader, "command");
  record.started = text_at(reader, "started");
  record.confinement = text_at(reader, "confinement");
  record.plugins = plugins_at(reader);
  record.build = object_at(reader, "build");
  record.request = object_at(reader, "request");
  record.settings = object_at(reader, "settings");
  for (const auto& row : record.settings.items()) object_at(reader.at("settings"), row.key().c_str());
  reader.at("machine").at("processor").string();
  record.machine = reader.at("machine").json();
  if (reader.has("answers")) record.answers = reader.at("answers").json();
  if (reader.has("about")) record.about = reader.at("about").json();
  if (reader.has("claims")) {
    record.claims = reader.at("claims").json();
    read_suite_claims(record.claims, file + ": /claims");
  }
  record.shard = shard_at(reader, record.cells.size());
  if (reader.has("merged")) record.merged = reader.at("merged").json();
  return record;
}

Json to_json(const RunRecord& record) {
  Json plugins = Json::array();
  for (const RunRecord::Plugin& plugin : record.plugins) {
    plugins.push_back(
        {{"kind", plugin.kind}, {"id", plugin.id}, {"version", plugin.version}, {"sha256", plugin.sha256}});
    if (!plugin.asks.empty()) plugins.back()["asks"] = plugin.asks;
  }
  Json json{{"suite", record.suite},     {"preset", record.preset},     {"smoke", record.smoke},
            {"request", record.request}, {"settings", record.settings}, {"cells", record.cells},
            {"plugins", plugins},        {"build", record.build},       {"version", record.version},
            {"program", record.program}, {"command", record.command},   {"confinement", record.confinement},
            {"answers", record.answers}, {"started", record.started},   {"machine", record.machine}};
  if (!record.about.is_null()) json["about"] = record.about;
  if (!record.claims.is_null()) json["claims"] = record.claims;
  if (record.shard)
    json["shard"] = {{"index", record.shard->index}, {"count", record.shard->count}, {"cells", record.shard->cells}};
  if (!record.merged.is_null()) json["merged"] = record.merged;
  return json;
}

void write_run_record(const fs::path& run, const RunRecord& record) {
  write_file(record_file(run), to_json(record).dump(1) + '\n');
}

bool same_cells(const std::string& version, const std::string& other) { return series(version) == series(other); }

std::string difference(const RunRecord& there, const RunRecord& wanted) {
  for (const auto& [setting, value] : wanted.request.items())
    if (const Json before = there.request.value(setting, Json()); before != value)
      return fmt::format("{} {} there, {} wanted", setting, canonical(before), canonical(value));
  return "same settings, other data or versions";
}

}  // namespace lgabench
