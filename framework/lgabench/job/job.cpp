#include <lgabench/job/job.hpp>

#include <fmt/format.h>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/record/fields.hpp>

namespace lgabench {
namespace {

// Written in full.
struct FullPath {
  fs::path& value;
};
void visit(const Slot& slot, const FullPath& path, const Form& form) {
  visit(slot, path.value, form);
  if (slot.write) *slot.write = fs::absolute(path.value).string();
}

std::string text(const Json& line, const char* member) {
  return line.contains(member) && line[member].is_string() ? line[member].get<std::string>() : std::string();
}

long long number(const Json& line, const char* member) {
  return line.contains(member) && line[member].is_number_integer() ? line[member].get<long long>() : 0;
}

}  // namespace

// A plugin in Python cannot be read again without its interpreter: what was read of it goes along.
static void fields(PluginInfo& plugin, Fields& field) {
  const JsonReader* const reader = field.reading();
  field("file", FullPath{plugin.file});
  const bool python = reader ? reader->has("python") : !plugin.python.is_null();
  if (python) {
    field("kind", plugin.kind);
    field("id", plugin.id);
    field("asks", plugin.asks);
    field("axis", plugin.axis);
    field("python", plugin.python);
  }
  if (reader && python) plugin.sha256 = sha256_file(plugin.file);
  if (reader && !python) plugin = read_plugin(plugin.file);
  std::string sha256 = plugin.sha256;
  field("sha256", sha256);
  if (sha256 != plugin.sha256) throw PluginError(fmt::format("{}: changed since the run began", plugin.file.string()));
}

static void fields(Limits& limits, Fields& field) {
  field("cpu_s", limits.cpu_s, within(1, 1LL << 40));
  field("data_bytes", limits.data_bytes, within(1, 1LL << 60));
}

static void fields(LiveModel& live, Fields& field) {
  field("cassette", FullPath{live.cassette});
  field("asks", live.asks);
  field("max_queries", live.max_queries, within(-1, 1 << 30));
  field("reply_timeout_s", live.reply_timeout_s, within(1, 1 << 30));
  field("concurrency", live.concurrency, within(1, 64));
  field("any_served", live.any_served);
  field("prompt", live.prompt, when(!live.prompt.empty()));
}

static void fields(CellJob& job, Fields& field) {
  const JsonReader* const reader = field.reading();
  field("environment", job.environment, when(job.environment.has_value()));
  if (reader && job.environment) add_environment(*job.environment);  // before the cell's scenario is read
  if (reader)
    job.cell = read_cell(reader->at("cell").json(), reader->file() + ": /cell");
  else
    field("cell", job.cell);
  field("engine", job.engine, when(job.engine.has_value()));
  field("directory", FullPath{job.directory});
  field("cache", FullPath{job.cache});
  field("answers", FullPath{job.answers});
  field("scratch", job.scratch);
  field("build", job.build);
  field("confined", job.confined);
  field("limits", job.limits);
  field("method", job.method, when(job.method.has_value()));
  if (reader && job.cell.method.is_reference() == job.method.has_value())
    reader->at("cell").fail("\"method\" beside it exactly where a method runs");
  field("acts", job.acts, when(job.acts.has_value()));
  if (reader && job.cell.method.acts.has_value() != job.acts.has_value())
    reader->at("cell").fail("\"acts\" beside it exactly where another method acts");
  field("attributed", job.attributed);
  field("keeps_policy", job.keeps_policy);
  field("axes", job.axes, when(!job.axes.empty()));
  field("perceiver", job.perceiver, when(job.perceiver.has_value()));
  field("live", job.live, when(job.live.has_value()));
  field("debugger", job.debugger, when(job.debugger.has_value()));
}

static void fields(CheckJob& job, Fields& field) {
  field("engine", job.engine, when(job.engine.has_value()));
  field("options", job.options);
  field("scratch", job.scratch);
  field("perturb", job.perturb, within(0, 255));
  field("report", job.report);
  field("limits", job.limits);
  field("environment", job.environment);
  field("scenario", job.scenario, when(!job.scenario.is_null()));
  field("method", job.method, when(job.method.has_value()));
  field("perturbation", job.perturbation, when(job.perturbation.has_value()));
  field("checked_environment", job.checked_environment, when(job.checked_environment.has_value()));
  if (field.reading() && job.checked_environment) add_environment(*job.checked_environment);
}

static void fields(AskJob& job, Fields& field) {
  field("model", job.model);
  field("live", job.live);
  field("limits", job.limits);
  field("scenarios", job.scenarios);
}

static void fields(PictureRequest::End& end, Fields& field) {
  field("engine", end.engine);
  field("actions", end.actions);
}

static void fields(PictureRequest& request, Fields& field) {
  field("cell", request.cell);
  field("arm", request.arm);
  field("index", request.index);
  field("scene", request.scene);
  field("selections", request.selections);
  field("ends", request.ends, may_lack());
}

Limits read_limits(const JsonReader& job) { return value_of<Limits>(job.at("limits"), false); }

Json to_json(const CellJob& job) { return json_of(job); }
CellJob read_cell_job(const JsonReader& reader) { return value_of<CellJob>(reader, false); }

Json to_json(const CheckJob& job) { return json_of(job); }
CheckJob read_check_job(const JsonReader& reader) { return value_of<CheckJob>(reader, false); }

Json to_json(const AskJob& job) { return json_of(job); }
AskJob read_ask_job(const JsonReader& reader) { return value_of<AskJob>(reader, false); }

Json to_json(const PictureRequest& request) { return json_of(request); }
PictureRequest read_picture_request(const JsonReader& reader) { return value_of<PictureRequest>(reader, false); }

Json to_json(const PhaseCount& message) { return {{"phase", message.phase}, {"count", message.count}}; }

Json to_json(const Complaint& message) {
  return {{"reason", message.reason},
          {"fault", message.by_plugin ? "plugin" : "host"},
          {"signal", message.signal},
          {"refused", message.refused}};
}

Json to_json(const Waiting& message) { return {{"waits_for", message.whom}}; }

std::optional<PhaseCount> read_phase_count(const Json& line) {
  if (!line.is_object() || !line.contains("phase")) return std::nullopt;
  return PhaseCount{text(line, "phase"), number(line, "count")};
}

std::optional<Complaint> read_complaint(const Json& line) {
  if (!line.is_object() || !line.contains("reason")) return std::nullopt;
  return Complaint{text(line, "reason"), text(line, "fault") == "plugin", static_cast<int>(number(line, "signal")),
                   line.value("refused", Json()) == true};
}

std::optional<Waiting> read_waiting(const Json& line) {
  if (!line.is_object() || !line.contains("waits_for")) return std::nullopt;
  return Waiting{text(line, "waits_for")};
}

}  // namespace lgabench
