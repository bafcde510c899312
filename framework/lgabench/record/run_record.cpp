#include <lgabench/record/run_record.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/fields.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/record/suite_claims.hpp>

namespace lgabench {
namespace {

// "0.3" of "0.3.0"
std::string series(const std::string& version) { return version.substr(0, version.rfind('.')); }

}  // namespace

Json RunRecord::programs() const {
  Json all = build;
  for (const Plugin& plugin : plugins) all[plugin.kind + " " + plugin.id] = plugin.sha256;
  return all;
}

Processor RunRecord::processor() const { return read_processor(JsonReader(machine, "run.json", "/machine")); }

std::vector<Processor> RunRecord::processors() const {
  std::vector<Processor> all{processor()};
  if (merged.is_null()) return all;
  for (const JsonReader& part : JsonReader(merged, "run.json", "/merged").elements()) {
    const Processor one = read_processor(part.at("machine"));
    if (std::none_of(all.begin(), all.end(),
                     [&](const Processor& known) { return to_string(known) == to_string(one); }))
      all.push_back(one);
  }
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

static void fields(RunRecord::Plugin& plugin, Fields& field) {
  field("kind", plugin.kind);
  field("id", plugin.id);
  field("version", plugin.version);
  field("sha256", plugin.sha256);
  field("asks", plugin.asks, when(!plugin.asks.empty()));
}

static void fields(RunRecord::Shard& shard, Fields& field) {
  field("count", shard.count, within(1, 1 << 30));
  field("index", shard.index, within(1, field.reading() ? shard.count : 1 << 30));
  field("cells", shard.cells);
}

// What may lack was not said by an older version.
void fields(RunRecord& record, Fields& field) {
  const JsonReader* const reader = field.reading();
  field("version", record.version);
  if (const std::string old = series(record.version); reader && (old == "0.1" || old == "0.2"))
    throw InputError(fmt::format("{}: written by lgabench {}, whose runs {} cannot read", reader->file(),
                                 record.version, LGABENCH_VERSION));
  field("suite", record.suite);
  field("preset", record.preset, may_lack());
  field("smoke", record.smoke);
  field("cells", record.cells);
  if (reader) read_cell_keys(*reader);
  field("program", record.program, may_lack());
  field("command", record.command, may_lack());
  field("started", record.started, may_lack());
  field("confinement", record.confinement, may_lack());
  field("plugins", record.plugins, may_lack());
  field("build", record.build, object(may_lack()));
  field("request", record.request, object(may_lack()));
  field("settings", record.settings, object(may_lack()));
  for (const auto& row : record.settings.items())
    if (reader && !row.value().is_object()) reader->at("settings").at(row.key()).fail("an object");
  field("machine", record.machine);
  if (reader) read_processor(reader->at("machine"));
  field("answers", record.answers, may_lack());
  field("about", record.about, when(!record.about.is_null()));
  field("claims", record.claims, when(!record.claims.is_null()));
  if (reader && reader->has("claims")) read_suite_claims(record.claims, reader->file() + ": /claims");
  if (reader && reader->has("shard") && reader->at("shard").has("cells"))
    reader->at("shard").at("cells").integer(0, static_cast<long long>(record.cells.size()));
  field("shard", record.shard, or_null(false, when(record.shard.has_value())));
  field("merged", record.merged, when(!record.merged.is_null()));
}

RunRecord read_run_record(const Json& json, const std::string& file) {
  return value_of<RunRecord>(JsonReader(json, file), false);
}

Json to_json(const RunRecord& record) { return json_of(record); }

void write_run_record(const fs::path& run, const RunRecord& record) {
  write_file(record_file(run), to_json(record).dump(1) + '\n');
}

bool same_cells(const std::string& version, const std::string& other) {
  // 0.5 computes the cells of 0.4, to the last bit but for heat maps without AVX-512 (docs/from-0.4-to-0.5.md).
  const auto cells_of = [](const std::string& v) { return series(v) == "0.5" ? "0.4" : series(v); };
  return cells_of(version) == cells_of(other);
}

std::string difference(const RunRecord& there, const RunRecord& wanted) {
  for (const auto& [setting, value] : wanted.request.items())
    if (const Json before = there.request.value(setting, Json()); before != value)
      return fmt::format("{} {} there, {} wanted", setting, canonical(before), canonical(value));
  return "same settings, other data or versions";
}

}  // namespace lgabench
