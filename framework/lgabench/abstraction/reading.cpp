#include <lgabench/abstraction/reading.hpp>

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/shadows.hpp>

namespace lgabench {
namespace {

// Never closed: readers live as long as a cell.
const SeeingLibrary& library() {
  static const SeeingLibrary* const opened = [] {
    void* const file = ::dlopen((library_directory() / seeing_library).c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto entry = file ? reinterpret_cast<decltype(&lgabench_seeing)>(::dlsym(file, "lgabench_seeing")) : nullptr;
    if (!entry) throw InputError(fmt::format("the library that reads names cannot be opened: {}", ::dlerror()));
    return entry();
  }();
  return *opened;
}

bool is_read(const std::string& names) {
  const std::vector<std::string>& all = names_read();
  return contains(all, names);
}

bool balances(const std::string& names) { return names == "read_balanced" || names == "read_robust"; }

void count_pixels(Observation& seen) {
  std::array<int, 256> pixels{};
  for (const std::uint8_t id : seen.ids) ++pixels[id];
  for (Instance& one : seen.instances) one.pixels = pixels[one.id];
}

// Each segment gets the name of what covers most of it; one that covers nothing is none.
void name_by_overlap(Observation& found, const Observation& seen) {
  std::array<std::array<int, 256>, 256> common{};
  for (std::size_t i = 0; i < found.ids.size(); ++i) ++common[found.ids[i]][seen.ids[i]];
  std::array<bool, 256> kept{};
  for (std::size_t id = 1; id < common.size(); ++id) {
    const Instance* best = nullptr;
    for (const Instance& one : seen.instances)
      if (common[id][one.id] > (best ? common[id][best->id] : 0)) best = &one;
    if (!best) continue;
    kept[id] = true;
    found.instances.push_back({static_cast<std::uint8_t>(id), best->object_type, best->texture});
  }
  for (std::uint8_t& id : found.ids)
    if (!kept[id]) id = 0;
}

}  // namespace

std::string Reading::plugin() const { return names == simulator || is_read(names) ? "" : names; }

std::string Reading::suffix() const {
  std::string words;
  if (names != simulator) words += "+names=" + names;
  if (segments != simulator) words += "+segments=" + segments;
  return words;
}

bool operator==(const Reading& a, const Reading& b) { return a.names == b.names && a.segments == b.segments; }

std::string read_segments(const JsonReader& reader) {
  const std::string word = reader.string();
  if (word != Reading::simulator && word != Reading::difference)
    reader.fail(fmt::format("\"{}\" or \"{}\"", Reading::simulator, Reading::difference));
  return word;
}

const std::vector<std::string>& names_read() {
  static const std::vector<std::string> all{"read", "read_balanced", "read_drawn", "read_robust"};
  return all;
}

fs::path reader_file(const std::string& environment, const Reading& reading) {
  if (!is_read(reading.names)) return "";
  const bool drawn = reading.names == "read_drawn" || reading.names == "read_robust";
  const fs::path file = data_directory() / "readers" / environment / (drawn ? "drawn.forest" : "plain.forest");
  if (!fs::exists(file))
    throw InputError(fmt::format("{}: expected the reader of the pictures of {}", file.string(), environment));
  return file;
}

std::string why_not_read(const Scenario& scenario, const Reading& reading) {
  if (reading.none()) return "";
  const EnvironmentType& environment = *scenario.environment;
  if (reading.needs_library() && !fs::is_directory(data_directory() / "readers" / environment.id()))
    return fmt::format("no reader was trained on pictures of {}", environment.id());
  for (const std::string& id : played_arms(scenario.json))
    if (const Arm& arm = scenario.arm(id);
        arm.label_noise != 0 || arm.missed_segment != 0 || environment.perception(*arm.scenes))
      return fmt::format("arm {} makes errors in the names, which reading would overwrite", arm.id);
  return "";
}

ReadPicture reading_of(const Scenario& scenario, const Reading& reading, std::shared_ptr<Perceiver> perceiver) {
  if (reading.none()) return nullptr;
  std::shared_ptr<const Observation> empty;
  if (reading.needs_library()) {
    Scene nothing;
    nothing.task = scenario.task;
    empty = std::make_shared<const Observation>(scenario.environment->draw(nothing));
  }
  const bool whitens = balances(reading.names), finds = reading.segments == Reading::difference;
  if (const fs::path file = reader_file(scenario.environment->id(), reading); !file.empty())
    perceiver = library().reader(file, whitens, *empty, scenario.space);
  return [space = scenario.space, empty, perceiver, whitens, finds](const Observation& seen, const Scene& scene) {
    Observation read{seen.size, seen.rgb, seen.ids, {}};
    if (finds)
      read = library().segments(std::move(read), *empty, whitens,
                                RandomStream(fmt::format("segments/{}/{}/{}/{}", scene.scenario, scene.layout,
                                                         scene.seed, scene.drawn_as())));
    if (perceiver)
      read = perceiver->read(std::move(read), space);
    else
      name_by_overlap(read, seen);
    read.rgb = seen.rgb;
    count_pixels(read);
    read.state = seen.state;
    read.brought = seen.brought;
    if (!finds) read.shadows = shadows_of(seen.shadows, seen.instances, read.instances);
    return read;
  };
}

Observation marked(const Observation& seen, const std::vector<std::uint8_t>& ids) {
  return library().marked(seen, ids);
}

}  // namespace lgabench
