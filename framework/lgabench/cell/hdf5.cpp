#include <lgabench/cell/hdf5.hpp>

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {
namespace {

using Sizes = std::vector<hsize_t>;

// Owns an HDF5 identifier of any kind. A negative one is an error that names the file and the place.
class Handle {
 public:
  Handle(hid_t id, const std::string& file, const std::string& place) : id_(id) {
    if (id < 0) throw InputError(fmt::format("{}: {}: HDF5 cannot open or create it", file, place));
  }
  ~Handle() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};

// The library prints its error stack unless told not to; a property list for everything that is made.
class Library {
 public:
  explicit Library(std::string file) : file_(std::move(file)) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

  Handle handle(hid_t id, const std::string& place) const { return {id, file_, place}; }
  void check(herr_t status, const std::string& place) const {
    if (status < 0) fail(place, "HDF5 cannot read or write it");
  }
  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", file_, place, what));
  }
  const std::string& file() const { return file_; }

 private:
  std::string file_;
};

Handle text_type(const Library& h5, std::size_t size) {
  Handle type = h5.handle(H5Tcopy(H5T_C_S1), "string type");
  h5.check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "string type");
  h5.check(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
  return type;
}

void write_attribute(const Library& h5, hid_t object, const char* name, const std::string& text) {
  const Handle type = text_type(h5, text.size());
  const Handle space = h5.handle(H5Screate(H5S_SCALAR), name);
  const Handle attribute = h5.handle(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), name);
  h5.check(H5Awrite(attribute, type, text.c_str()), name);
}

void write_attribute(const Library& h5, hid_t object, const char* name, std::int64_t value) {
  const Handle space = h5.handle(H5Screate(H5S_SCALAR), name);
  const Handle attribute = h5.handle(H5Acreate2(object, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), name);
  h5.check(H5Awrite(attribute, H5T_NATIVE_INT64, &value), name);
}

void write_attribute(const Library& h5, hid_t object, const char* name, const std::vector<double>& values) {
  const hsize_t size = values.size();
  const Handle space = h5.handle(H5Screate_simple(1, &size, nullptr), name);
  const Handle attribute = h5.handle(H5Acreate2(object, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), name);
  h5.check(H5Awrite(attribute, H5T_NATIVE_DOUBLE, values.data()), name);
}

// Pictures are packed a step at a time: mostly background, they shrink twentyfold.
void write_dataset(const Library& h5, hid_t group, const char* name, hid_t type, const Sizes& sizes, const void* data,
                   bool packed) {
  const Handle properties = h5.handle(H5Pcreate(H5P_DATASET_CREATE), name);
  h5.check(H5Pset_obj_track_times(properties, false), name);
  if (packed) {
    Sizes chunk = sizes;
    chunk[0] = 1;
    h5.check(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()), name);
    h5.check(H5Pset_deflate(properties, 1), name);
  }
  const Handle space = h5.handle(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), name);
  const Handle set = h5.handle(H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), name);
  h5.check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
}

Handle make_group(const Library& h5, hid_t parent, const std::string& name) {
  const Handle properties = h5.handle(H5Pcreate(H5P_GROUP_CREATE), name);
  h5.check(H5Pset_obj_track_times(properties, false), name);
  return h5.handle(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), name);
}

Json instances_json(const Observation& observation) {
  Json table = Json::array();
  for (const Instance& i : observation.instances)
    table.push_back({{"id", i.id}, {"object_type", i.object_type}, {"texture", i.texture}, {"pixels", i.pixels}});
  return table;
}

std::vector<Instance> read_instances(const JsonReader& table, PictureSize picture) {
  std::vector<Instance> all;
  for (const JsonReader& i : table.elements())
    all.push_back({static_cast<std::uint8_t>(i.at("id").integer(1, 255)), i.at("object_type").string(),
                   i.at("texture").string(),
                   static_cast<int>(i.at("pixels").integer(0, static_cast<long long>(picture.pixels())))});
  return all;
}

std::array<hsize_t, 2> sizes(PictureSize picture) {
  return {static_cast<hsize_t>(picture.rows), static_cast<hsize_t>(picture.columns)};
}

// Of steps or of their results, which all are of one environment.
template <class WithObservations>
void write_state(const Library& h5, hid_t obs, const WithObservations& all) {
  std::vector<double> state;
  for (const auto& one : all) state.insert(state.end(), one.observation.state.begin(), one.observation.state.end());
  const std::size_t numbers = all.front().observation.state.size();
  if (numbers > 0) write_dataset(h5, obs, "state", H5T_IEEE_F64LE, {all.size(), numbers}, state.data(), false);
}

// Likewise.
template <class WithObservations>
void write_observations(const Library& h5, hid_t group, const char* name, const WithObservations& all) {
  std::vector<std::uint8_t> rgb, ids;
  std::vector<std::uint16_t> shadows;
  for (const auto& one : all) {
    shadows.insert(shadows.end(), one.observation.shadows.begin(), one.observation.shadows.end());
    rgb.insert(rgb.end(), one.observation.rgb.begin(), one.observation.rgb.end());
    ids.insert(ids.end(), one.observation.ids.begin(), one.observation.ids.end());
  }
  const auto [rows, columns] = sizes(all.front().observation.size);
  const hsize_t steps = all.size();
  const Handle obs = make_group(h5, group, name);
  write_dataset(h5, obs, "rgb", H5T_STD_U8LE, {steps, rows, columns, 3}, rgb.data(), true);
  write_dataset(h5, obs, "ids", H5T_STD_U8LE, {steps, rows, columns}, ids.data(), true);
  if (!shadows.empty()) write_dataset(h5, obs, "shadows", H5T_STD_U16LE, {steps, rows, columns}, shadows.data(), true);
  write_state(h5, obs, all);
}

Json brought_json(const Observation& observation) {
  Json all = Json::array();
  for (const Named& one : observation.brought)
    all.push_back({{"object_type", one.object_type}, {"texture", one.texture}});
  return all;
}

void write_text(const Library& h5, hid_t group, const char* name, const Json& json) {
  const std::string text = canonical(json);  // a dataset, not an attribute: attributes end at 64 KiB
  write_dataset(h5, group, name, H5T_STD_U8LE, {text.size()}, text.data(), false);
}

void write_demonstration(const Library& h5, hid_t group, const Demonstration& demonstration, std::size_t numbers) {
  std::vector<Step> all = demonstration.steps;
  all.insert(all.end(), demonstration.recovery.begin(), demonstration.recovery.end());
  std::vector<float> actions;
  std::vector<std::uint8_t> stops;
  Json instances = Json::array(), brought = Json::array();
  bool any_stops = false, any_brought = false;
  for (const Step& step : all) {
    actions.insert(actions.end(), step.label.begin(), step.label.end());
    actions.resize((stops.size() + 1) * numbers);  // zeros where there is no label
    stops.push_back(step.label.empty() ? 1 : 0);
    any_stops = any_stops || step.label.empty();
    instances.push_back(instances_json(step.observation));
    brought.push_back(brought_json(step.observation));
    any_brought = any_brought || !step.observation.brought.empty();
  }
  const hsize_t steps = all.size();
  write_attribute(h5, group, "num_samples", static_cast<std::int64_t>(steps));
  write_attribute(h5, group, "utterance", demonstration.instruction.utterance);
  if (demonstration.steps.size() != 1)
    write_attribute(h5, group, "trajectory_steps", static_cast<std::int64_t>(demonstration.steps.size()));
  write_dataset(h5, group, "actions", H5T_IEEE_F32LE, {steps, numbers}, actions.data(), false);
  write_text(h5, group, "instances", instances);
  write_observations(h5, group, "obs", all);
  if (any_stops) write_dataset(h5, group, "stops", H5T_STD_U8LE, {steps}, stops.data(), false);
  if (any_brought) write_text(h5, group, "brought", brought);
  if (demonstration.instruction.selection.empty()) return;  // as in the cache, whose steps serve whoever selects
  Json about = distribution_json(demonstration.instruction.selection);
  about["provenance"] = to_string(demonstration.instruction.selection.provenance);
  write_text(h5, group, "selection", about);
}

// Of an episode of so many steps, and recovery steps after it.
void write_results(const Library& h5, hid_t group, const std::vector<StepResult>& results, std::size_t trajectory) {
  write_observations(h5, group, "next_obs", results);
  std::vector<float> rewards;
  for (const StepResult& result : results) rewards.push_back(result.is_success ? 1 : 0);
  std::vector<std::uint8_t> dones(results.size(), 1);
  std::fill_n(dones.begin(), trajectory - 1, 0);
  write_dataset(h5, group, "rewards", H5T_IEEE_F32LE, {results.size()}, rewards.data(), false);
  write_dataset(h5, group, "dones", H5T_STD_U8LE, {results.size()}, dones.data(), false);
}

void write_circumstances(const Library& h5, hid_t data, const Circumstances& c) {
  write_attribute(h5, data, "scenario", c.scenario);
  write_attribute(h5, data, "layout", c.layout);
  write_attribute(h5, data, "split", c.split);
  write_attribute(h5, data, "seed", static_cast<std::int64_t>(c.seed));
  Json names = Json::array(), units = Json::array();
  std::vector<double> low, high;
  for (const ActionNumber& number : c.action_space.numbers) {
    names.push_back(number.name);
    units.push_back(number.unit);
    low.push_back(number.low);
    high.push_back(number.high);
  }
  write_attribute(h5, data, "action_names", canonical(names));
  write_attribute(h5, data, "action_units", canonical(units));
  write_attribute(h5, data, "action_rotations", canonical(Json(c.action_space.rotations)));
  write_attribute(h5, data, "action_low", low);
  write_attribute(h5, data, "action_high", high);
}

// Names of demonstrations first to last - 1: texts of a fixed length, one after the other.
void write_mask(const Library& h5, hid_t mask, const char* name, std::size_t first, std::size_t last) {
  constexpr std::size_t name_size = 16;
  std::string names;
  for (std::size_t i = first; i < last; ++i) {
    names += fmt::format("demo_{}", i);
    names.resize((i - first + 1) * name_size);
  }
  write_dataset(h5, mask, name, text_type(h5, name_size), {last - first}, names.data(), false);
}

std::string read_text(const Library& h5, hid_t object, const char* name, const std::string& place) {
  const Handle attribute = h5.handle(H5Aopen(object, name, H5P_DEFAULT), place + "@" + name);
  const Handle type = h5.handle(H5Aget_type(attribute), place);
  const Handle space = h5.handle(H5Aget_space(attribute), place);
  constexpr std::size_t longest = 1 << 16;  // attributes end there
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || size > longest ||
      H5Sget_simple_extent_npoints(space) != 1)
    h5.fail(place, fmt::format("expected one string attribute \"{}\" of fixed length", name));
  std::string text(size, '\0');
  h5.check(H5Aread(attribute, type, text.data()), place);
  return text.substr(0, text.find('\0'));
}

std::int64_t read_number(const Library& h5, hid_t object, const char* name, const std::string& place) {
  const Handle attribute = h5.handle(H5Aopen(object, name, H5P_DEFAULT), place + "@" + name);
  const Handle type = h5.handle(H5Aget_type(attribute), place), space = h5.handle(H5Aget_space(attribute), place);
  if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1)
    h5.fail(place, fmt::format("expected one whole number as attribute \"{}\"", name));
  std::int64_t number = 0;
  h5.check(H5Aread(attribute, H5T_NATIVE_INT64, &number), place);
  return number;
}

// Reads a dataset whose shape must be `sizes`; 0 stands for any, and becomes what was found.
template <class T>
std::vector<T> read_dataset(const Library& h5, hid_t group, const char* name, hid_t type, Sizes& sizes,
                            const std::string& place) {
  const std::string where = place + "/" + name;
  const Handle set = h5.handle(H5Dopen2(group, name, H5P_DEFAULT), where);
  const Handle space = h5.handle(H5Dget_space(set), where);
  std::array<hsize_t, H5S_MAX_RANK> found{};
  const int rank = H5Sget_simple_extent_dims(space, found.data(), nullptr);
  bool fits = rank == static_cast<int>(sizes.size());
  hsize_t count = 1;
  constexpr hsize_t most = hsize_t{1} << 28;  // bytes: a damaged size must not become an allocation
  for (std::size_t i = 0; fits && i < sizes.size(); ++i) {
    fits = (sizes[i] == 0 ? found[i] > 0 : found[i] == sizes[i]) && found[i] <= most / sizeof(T) / count;
    count *= found[i];
  }
  if (!fits) h5.fail(where, fmt::format("expected the shape [{}]", fmt::join(sizes, ", ")));
  const Handle stored = h5.handle(H5Dget_type(set), where);
  if (H5Tget_class(stored) != H5Tget_class(type) || H5Tget_size(stored) > sizeof(double))
    h5.fail(where, "its values are of another type");  // HDF5 allocates by the stored size when it converts
  std::copy_n(found.begin(), sizes.size(), sizes.begin());
  std::vector<T> values(count);
  h5.check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), where);
  return values;
}

Json read_json_text(const Library& h5, hid_t group, const char* name, const std::string& place) {
  Sizes size{0};
  const auto bytes = read_dataset<std::uint8_t>(h5, group, name, H5T_NATIVE_UINT8, size, place);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return parse_json(text, fmt::format("{}: {}/{}", h5.file(), place, name));
}

// What only some files have; none where this one has it not.
template <class T>
std::vector<T> read_optional(const Library& h5, hid_t group, const char* name, hid_t type, Sizes& sizes,
                             const std::string& place) {
  return H5Lexists(group, name, H5P_DEFAULT) > 0 ? read_dataset<T>(h5, group, name, type, sizes, place)
                                                 : std::vector<T>();
}

std::vector<std::vector<Named>> read_brought(const Library& h5, hid_t group, const std::string& place,
                                             std::size_t steps) {
  std::vector<std::vector<Named>> all(steps);
  if (H5Lexists(group, "brought", H5P_DEFAULT) <= 0) return all;
  const Json json = read_json_text(h5, group, "brought", place);
  const auto lists = JsonReader(json, h5.file(), place + "/brought").elements();
  if (lists.size() != steps) h5.fail(place + "/brought", fmt::format("expected {} lists", steps));
  for (std::size_t t = 0; t < steps; ++t)
    for (const JsonReader& one : lists[t].elements())
      all[t].push_back({one.at("object_type").string(), one.at("texture").string()});
  return all;
}

Demonstration read_demonstration(const Library& h5, hid_t group, const std::string& place) {
  const Json tables = read_json_text(h5, group, "instances", place);
  const auto instances = JsonReader(tables, h5.file(), place + "/instances").elements();
  const hsize_t steps = instances.size();
  if (steps == 0 || steps > 10000) h5.fail(place, "expected 1 to 10000 steps");
  Sizes actions_size{steps, 0}, rgb_size{steps, 0, 0, 3};
  const auto actions = read_dataset<float>(h5, group, "actions", H5T_NATIVE_FLOAT, actions_size, place);
  const auto rgb = read_dataset<std::uint8_t>(h5, group, "obs/rgb", H5T_NATIVE_UINT8, rgb_size, place);
  Sizes ids_size{steps, rgb_size[1], rgb_size[2]};
  const auto ids = read_dataset<std::uint8_t>(h5, group, "obs/ids", H5T_NATIVE_UINT8, ids_size, place);
  const auto shadows = read_optional<std::uint16_t>(h5, group, "obs/shadows", H5T_NATIVE_UINT16, ids_size, place);
  Sizes state_size{steps, 0}, stops_size{steps};
  const auto state = read_optional<double>(h5, group, "obs/state", H5T_NATIVE_DOUBLE, state_size, place);
  const auto stops = read_optional<std::uint8_t>(h5, group, "stops", H5T_NATIVE_UINT8, stops_size, place);
  auto brought = read_brought(h5, group, place, steps);
  std::int64_t trajectory = 1;  // the steps after it are recovery steps
  if (H5Aexists(group, "trajectory_steps") > 0) trajectory = read_number(h5, group, "trajectory_steps", place);
  if (trajectory < 1 || trajectory > static_cast<std::int64_t>(steps))
    h5.fail(place, fmt::format("expected 1 to {} trajectory_steps", steps));
  const PictureSize picture{static_cast<int>(ids_size[1]), static_cast<int>(ids_size[2])};

  Demonstration demonstration;
  demonstration.instruction.utterance = read_text(h5, group, "utterance", place);
  for (std::size_t t = 0; t < steps; ++t) {
    Step step;
    const auto slice = [t](const auto& all, std::size_t size) {
      const auto from = all.begin() + static_cast<std::ptrdiff_t>(t * size);
      return std::vector(from, from + static_cast<std::ptrdiff_t>(size));
    };
    step.observation = {picture, slice(rgb, picture.pixels() * 3), slice(ids, picture.pixels()),
                        read_instances(instances[t], picture)};
    if (!shadows.empty()) step.observation.shadows = slice(shadows, picture.pixels());
    if (!state.empty()) step.observation.state = slice(state, state_size[1]);
    step.observation.brought = std::move(brought[t]);
    const float* const label = actions.data() + t * actions_size[1];
    if (stops.empty() || stops[t] == 0) step.label.assign(label, label + actions_size[1]);
    auto& list = t < static_cast<std::size_t>(trajectory) ? demonstration.steps : demonstration.recovery;
    list.push_back(std::move(step));
  }
  return demonstration;
}

}  // namespace

std::string demonstrations_hdf5(const std::vector<Demonstration>& demonstrations, const std::string& environment_id,
                                const Circumstances* circumstances) {
  // Made in memory, so that the one writer of files (core/files.hpp) puts it on the disk.
  const Library h5("demonstrations");
  const Handle access = h5.handle(H5Pcreate(H5P_FILE_ACCESS), "/");
  h5.check(H5Pset_fapl_core(access, std::size_t{1} << 22, false), "/");
  const Handle creation = h5.handle(H5Pcreate(H5P_FILE_CREATE), "/");
  h5.check(H5Pset_obj_track_times(creation, false), "/");
  const Handle file = h5.handle(H5Fcreate("demonstrations", H5F_ACC_TRUNC, creation, access), "/");
  {
    const Handle data = make_group(h5, file, "data");
    std::int64_t total = 0;
    std::size_t numbers = 0;
    for (const Demonstration& one : demonstrations)
      for_each_step(one, [&](const Step& step) { numbers = std::max(numbers, step.label.size()); });
    for (std::size_t i = 0; i < demonstrations.size(); ++i) {
      const Handle group = make_group(h5, data, fmt::format("demo_{}", i));
      write_demonstration(h5, group, demonstrations[i], numbers);
      const std::size_t steps = demonstrations[i].steps.size();
      if (circumstances) write_results(h5, group, circumstances->outcomes.at(i), steps);
      total += static_cast<std::int64_t>(steps + demonstrations[i].recovery.size());
    }
    write_attribute(h5, data, "total", total);
    constexpr int gym_type = 2;  // robomimic's EnvType.GYM_TYPE
    Json arguments{{"env_name", environment_id}, {"type", gym_type}, {"env_kwargs", Json::object()}};
    if (circumstances)
      arguments["env_kwargs"] = {
          {"engine", circumstances->engine}, {"layout", circumstances->layout}, {"split", circumstances->split}};
    write_attribute(h5, data, "env_args", canonical(arguments));
    if (circumstances) write_circumstances(h5, data, *circumstances);
    const Handle mask = make_group(h5, file, "mask");
    const std::size_t count = demonstrations.size(), held_out = circumstances ? count / 10 : 0;
    write_mask(h5, mask, "train", 0, count - held_out);
    if (held_out > 0) write_mask(h5, mask, "valid", count - held_out, count);
  }
  h5.check(H5Fflush(file, H5F_SCOPE_GLOBAL), "/");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) h5.fail("/", "HDF5 cannot give its bytes");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) != size) h5.fail("/", "HDF5 cannot give its bytes");
  return bytes;
}

std::vector<Demonstration> read_demonstrations(std::string bytes, const std::string& name) {
  const Library h5(name);
  if (bytes.compare(0, 8, "\x89HDF\r\n\x1a\n") != 0) h5.fail("/", "expected an HDF5 file");
  const Handle access = h5.handle(H5Pcreate(H5P_FILE_ACCESS), "/");
  h5.check(H5Pset_fapl_core(access, std::size_t{1} << 16, false), "/");
  h5.check(H5Pset_file_image(access, bytes.data(), bytes.size()), "/");
  const Handle file = h5.handle(H5Fopen("demonstrations", H5F_ACC_RDONLY, access), "/");
  const Handle data = h5.handle(H5Gopen2(file, "data", H5P_DEFAULT), "/data");
  H5G_info_t info{};
  h5.check(H5Gget_info(data, &info), "/data");
  std::vector<Demonstration> all;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const std::string place = fmt::format("/data/demo_{}", i);
    all.push_back(read_demonstration(h5, h5.handle(H5Gopen2(file, place.c_str(), H5P_DEFAULT), place), place));
  }
  if (all.empty()) h5.fail("/data", "expected demonstrations");
  return all;
}

}  // namespace lgabench
