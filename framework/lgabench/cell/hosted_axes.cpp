#include <lgabench/cell/hosted_axes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include <lgabench/cell/runs_below.hpp>
#include <lgabench/core/contains.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/host/hosted_perturbation.hpp>

namespace lgabench {
namespace {

const PluginInfo& plugin_of(const PerturbationAxis& axis, const CellJob& job) {
  const auto found =
      std::find_if(job.axes.begin(), job.axes.end(), [&axis](const PluginInfo& one) { return one.id == axis.id; });
  if (found == job.axes.end())
    throw PluginError(fmt::format("perturbation {}: the job names no plugin for it", axis.id));
  if (found->axis != axis_json(axis))
    throw PluginError(fmt::format("perturbation {}: {} declares {}, the scenario {}", axis.id, found->file.string(),
                                  canonical(found->axis), canonical(axis_json(axis))));
  return *found;
}

}  // namespace

void expect_perceived(const Observation& seen, const FeatureSpace& space) {
  std::array<bool, 256> listed{true};  // 0 is no object
  for (const Instance& one : seen.instances) {
    if (std::exchange(listed.at(one.id), true))
      throw MethodError(fmt::format("instance id {}: expected each once, and not 0", one.id));
    if (!contains(space.object_types, one.object_type))
      throw MethodError(fmt::format("instance {}: no object type \"{}\" in {}", one.id, one.object_type, space.id));
    if (!contains(space.textures, one.texture))
      throw MethodError(fmt::format("instance {}: no texture \"{}\" in {}", one.id, one.texture, space.id));
  }
  for (const std::uint8_t id : seen.ids)
    if (!listed.at(id)) throw MethodError(fmt::format("ids: {}, expected 0 or the id of an instance", id));
}

HostJob host_job(const CellJob& job, const PluginInfo& plugin, const Json& options, const fs::path& scratch) {
  HostJob host{plugin,
               job.cell.environment,
               options,
               job.cell.training_seed,
               scratch,
               job.confined,
               {job.directory.parent_path().parent_path(), job.cache, job.answers, job.scratch.parent_path()},
               job.limits.data_bytes};
  const std::vector<fs::path> earlier = runs_below(plugin.file.parent_path());
  host.hidden.insert(host.hidden.end(), earlier.begin(), earlier.end());
  if (job.live) host.hidden.push_back(job.live->cassette);
  return host;
}

void host_axes(const Scenario& scenario, const CellJob& job) {
  for (const auto& axis : scenario.axes) {
    const fs::path scratch = job.scratch / ("axis_" + axis->id);
    fs::create_directory(scratch);
    const auto name = [id = axis->id](int level) { return fmt::format("{} (perturbation, level {})", id, level); };
    const PluginInfo& plugin = plugin_of(*axis, job);
    const auto process = guarded(
        axis->id, [&] { return std::make_shared<HostedPerturbation>(host_job(job, plugin, Json::object(), scratch)); });
    axis->perceive = [process, name](Observation seen, const Scenario& of, int level, RandomStream stream) {
      return guarded(name(level), [&] {
        Observation perceived = process->perceive(std::move(seen), level, stream);
        expect_perceived(perceived, of.space);
        return perceived;
      });
    };
  }
}

namespace {

// A plugin's, in a process of its own, whose answers are checked.
class CheckedPerceiver final : public Perceiver {
 public:
  CheckedPerceiver(const CellJob& job, const fs::path& scratch)
      : name_(job.perceiver->id + " (perceiver)"), process_(guarded(name_, [&] {
          return std::make_unique<HostedPerturbation>(host_job(job, *job.perceiver, Json::object(), scratch));
        })) {}

  Observation read(Observation seen, const FeatureSpace& space) override {
    return guarded(name_, [&] {
      const std::string picture = hash_of(seen);
      Observation read = process_->read(std::move(seen), space);
      expect_perceived(read, space);
      const std::string answer = hash_of(read);
      if (answers_.emplace(picture, answer).first->second != answer)
        throw MethodError("it read other names in the same picture than before");
      return read;
    });
  }

 private:
  static std::string hash_of(const Observation& seen) {
    std::string bytes(seen.rgb.begin(), seen.rgb.end());
    bytes.append(seen.ids.begin(), seen.ids.end());
    for (const Instance& one : seen.instances) bytes += fmt::format("{} {} {}\n", one.id, one.object_type, one.texture);
    return hex(hash64(bytes));
  }

  const std::string name_;
  std::unique_ptr<HostedPerturbation> process_;
  std::map<std::string, std::string> answers_;
};

}  // namespace

ReadPicture reading_in(const Scenario& scenario, const CellJob& job) {
  if (job.cell.reading.plugin().empty()) return reading_of(scenario, job.cell.reading);
  if (!job.perceiver)
    throw PluginError(fmt::format("perceiver {}: the job names no plugin for it", job.cell.reading.plugin()));
  const fs::path scratch = job.scratch / "perceiver";
  fs::create_directory(scratch);
  return reading_of(scenario, job.cell.reading, std::make_shared<CheckedPerceiver>(job, scratch));
}

}  // namespace lgabench
