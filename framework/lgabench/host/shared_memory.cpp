#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include <lgabench/core/refused.hpp>
#include <lgabench/host/messages.hpp>

#if !defined(F_SEAL_FUTURE_WRITE)
#define F_SEAL_FUTURE_WRITE 0x0010
#endif

namespace lgabench::host {
namespace {

constexpr std::size_t instance_numbers = 5;
constexpr std::size_t most_bytes = std::size_t{1} << 36;

[[noreturn]] void fail(const char* what) { throw EngineError(refused_text(what)); }

// Places arrays one after another, each at a multiple of 64 bytes.
class Arrays {
 public:
  std::size_t add(const char* name, const char* type, std::size_t item_bytes, std::vector<std::size_t> shape) {
    const std::size_t offset = size;
    std::size_t bytes = item_bytes;
    for (const std::size_t length : shape) bytes *= length;
    json[name] = {{"offset", offset}, {"type", type}, {"shape", std::move(shape)}};
    size = (offset + bytes + 63) / 64 * 64;
    return offset;
  }
  Json json = Json::object();
  std::size_t size = 0;
};

// An array that the header names: where it begins, checked to lie within the file.
struct Array {
  std::size_t offset = 0;
  std::vector<std::size_t> shape;
};
Array array_at(const JsonReader& arrays, const char* name, const char* type, std::size_t item_bytes,
               std::size_t file_bytes) {
  const JsonReader reader = arrays.at(name);
  if (reader.at("type").string() != type) reader.at("type").fail(type);
  Array array{static_cast<std::size_t>(reader.at("offset").integer(0, static_cast<long long>(file_bytes))), {}};
  std::size_t bytes = item_bytes;
  for (const JsonReader& length : reader.at("shape").elements()) {
    array.shape.push_back(static_cast<std::size_t>(length.integer(0, 1LL << 31)));
    if (array.shape.back() != 0 && bytes > file_bytes / array.shape.back()) reader.fail("an array within the file");
    bytes *= array.shape.back();
  }
  if (bytes > file_bytes - array.offset) reader.fail("an array within the file");
  return array;
}

template <class T>
T value_at(const std::uint8_t* bytes, std::size_t index) {
  T value;
  std::memcpy(&value, bytes + index * sizeof value, sizeof value);
  return value;
}

Descriptor memory_file(std::size_t size) {
  Descriptor file(::memfd_create("array", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (file.fd < 0) fail("memfd_create");
  if (::ftruncate(file.fd, static_cast<off_t>(size)) != 0) fail("ftruncate");
  return file;
}

// A map that is there stays writable; nothing else is from now on (Linux 5.1).
void seal(const Descriptor& file) {
  if (::fcntl(file.fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL) != 0)
    fail("seals");
}

// Half as long as filling a map, which takes a page fault for every 4 KiB.
void write_at(const Descriptor& file, std::size_t offset, const void* data, std::size_t size) {
  for (const auto* bytes = static_cast<const char*>(data); size > 0;) {
    const ssize_t n = ::pwrite(file.fd, bytes, size, static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("pwrite");
    bytes += n;
    offset += static_cast<std::size_t>(n);
    size -= static_cast<std::size_t>(n);
  }
}

}  // namespace

SharedMemory::SharedMemory(std::size_t size) : file_(memory_file(size)), size_(size) {
  if (size == 0) return;
  data_ = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_.fd, 0);
  if (data_ == MAP_FAILED) fail("mmap");
  seal(file_);
}

SharedMemory::SharedMemory(const Descriptor& file, std::size_t size) : size_(size) {
  struct stat status {};
  if (::fstat(file.fd, &status) != 0 || static_cast<std::size_t>(status.st_size) < size)
    throw InputError(fmt::format("shared memory: expected {} bytes", size));
  if (size == 0) return;
  data_ = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.fd, 0);
  if (data_ == MAP_FAILED) fail("mmap");
}

SharedMemory::~SharedMemory() {
  if (data_) ::munmap(data_, size_);
}

void write(const Observation& observation, SharedMemory& memory) {
  const std::size_t pixels = observation.size.pixels();
  if (observation_bytes(observation.size) != memory.size())
    throw Error(fmt::format("observation: expected the environment's size, got {} x {}", observation.size.rows,
                            observation.size.columns));
  std::memcpy(memory.data(), observation.rgb.data(), 3 * pixels);
  std::memcpy(memory.data() + 3 * pixels, observation.ids.data(), pixels);
  if (!observation.shadows.empty()) std::memcpy(memory.data() + 4 * pixels, observation.shadows.data(), 2 * pixels);
}

Json instances_json(const Observation& observation) {
  Json all = Json::array();
  for (const Instance& i : observation.instances)
    all.push_back({{"id", i.id}, {"object_type", i.object_type}, {"texture", i.texture}, {"pixels", i.pixels}});
  return all;
}

void read_observation(const SharedMemory& memory, PictureSize picture, const JsonReader& instances, bool shadows,
                      Observation& observation) {
  const std::size_t pixels = picture.pixels();
  observation.size = picture;
  observation.rgb.assign(memory.data(), memory.data() + 3 * pixels);
  observation.ids.assign(memory.data() + 3 * pixels, memory.data() + 4 * pixels);
  observation.shadows.resize(shadows ? pixels : 0);
  if (shadows) std::memcpy(observation.shadows.data(), memory.data() + 4 * pixels, 2 * pixels);
  observation.instances.clear();
  for (const JsonReader& one : instances.elements())
    observation.instances.push_back({static_cast<std::uint8_t>(one.at("id").integer(0, 255)),
                                     one.at("object_type").string(), one.at("texture").string(),
                                     static_cast<int>(one.at("pixels").integer(0, static_cast<long long>(pixels)))});
}

DemonstrationFile pack(const Layout& layout, const std::vector<Demonstration>& demonstrations) {
  const auto rows = static_cast<std::size_t>(layout.picture.rows), columns = layout.picture.pixels() / rows;
  const std::size_t pixels = layout.picture.pixels();
  std::size_t steps = 0, instances = 0;
  bool shaded = true, brings = false;  // every one of them; any
  Json instructions = Json::array(), lengths = Json::array();
  for (const Demonstration& demonstration : demonstrations) {
    instructions.push_back(to_json(demonstration.instruction));
    lengths.push_back(demonstration.steps.size());
    for_each_step(demonstration, [&](const Step& step) {
      ++steps;
      instances += step.observation.instances.size();
      shaded = shaded && !step.observation.shadows.empty();
      brings = brings || !step.observation.brought.empty();
    });
  }
  Arrays arrays;
  const std::size_t rgb = arrays.add("rgb", "u1", 1, {steps, rows, columns, 3});
  const std::size_t ids = arrays.add("ids", "u1", 1, {steps, rows, columns});
  const std::size_t labels = arrays.add("labels", "f8", 8, {steps, layout.actions.size()});
  const std::size_t owners = arrays.add("demonstration", "i4", 4, {steps});
  const std::size_t table = arrays.add("instances", "i4", 4, {instances, instance_numbers});
  const std::size_t shadows = shaded ? arrays.add("shadows", "u2", 2, {steps, rows, columns}) : 0;
  const std::size_t numbers = layout.state.size();
  const std::size_t state = numbers > 0 ? arrays.add("state", "f8", 8, {steps, numbers}) : 0;
  const std::size_t stops = layout.may_stop ? arrays.add("stops", "u1", 1, {steps}) : 0;
  Descriptor file = memory_file(arrays.size);

  std::map<std::string, std::int32_t> indices;
  Json words = Json::array();
  const auto word = [&](const std::string& text) {
    const auto [found, is_new] = indices.emplace(text, static_cast<std::int32_t>(words.size()));
    if (is_new) words.push_back(text);
    return found->second;
  };
  std::string label_bytes, state_bytes, stop_bytes;
  Json brought = Json::array();
  std::vector<std::int32_t> owner_of, rows_of_instances;
  std::size_t step = 0;
  for (std::size_t d = 0; d < demonstrations.size(); ++d)
    for_each_step(demonstrations[d], [&](const Step& s) {
      write_at(file, rgb + step * 3 * pixels, s.observation.rgb.data(), 3 * pixels);
      write_at(file, ids + step * pixels, s.observation.ids.data(), pixels);
      if (shaded) write_at(file, shadows + step * 2 * pixels, s.observation.shadows.data(), 2 * pixels);
      label_bytes += to_bytes(s.label.empty() ? Action(layout.actions.size()) : s.label);
      if (s.observation.state.size() != numbers)
        throw Error(fmt::format("state: expected {} numbers, got {}", numbers, s.observation.state.size()));
      state_bytes += to_bytes(s.observation.state);
      stop_bytes += static_cast<char>(s.label.empty() ? 1 : 0);
      if (brings) brought.push_back(beside_pictures(s.observation).value("brought", Json::array()));
      owner_of.push_back(static_cast<std::int32_t>(d));
      const auto at = static_cast<std::int32_t>(step++);
      for (const Instance& i : s.observation.instances) {
        const std::int32_t type = word(i.object_type), texture = word(i.texture);
        rows_of_instances.insert(rows_of_instances.end(), {at, i.id, type, texture, i.pixels});
      }
    });
  write_at(file, labels, label_bytes.data(), label_bytes.size());
  write_at(file, owners, owner_of.data(), owner_of.size() * sizeof owner_of[0]);
  write_at(file, table, rows_of_instances.data(), rows_of_instances.size() * sizeof rows_of_instances[0]);
  if (numbers > 0) write_at(file, state, state_bytes.data(), state_bytes.size());
  if (layout.may_stop) write_at(file, stops, stop_bytes.data(), stop_bytes.size());
  seal(file);
  Json header{{"instructions", std::move(instructions)},
              {"trajectory_steps", std::move(lengths)},
              {"words", std::move(words)},
              {"arrays", std::move(arrays.json)}};
  if (brings) header["brought"] = std::move(brought);
  return {std::move(header), std::move(file), arrays.size};
}

std::vector<Demonstration> unpack(const Layout& layout, const JsonReader& header, const Descriptor& file) {
  struct stat status {};
  if (::fstat(file.fd, &status) != 0) throw InputError("demonstrations: no file came with them");
  const auto size = std::min(static_cast<std::size_t>(status.st_size), most_bytes);
  const SharedMemory memory(file, size);
  const std::vector<std::string> words = header.at("words").strings();
  const JsonReader arrays = header.at("arrays");
  const Array rgb = array_at(arrays, "rgb", "u1", 1, size), ids = array_at(arrays, "ids", "u1", 1, size),
              labels = array_at(arrays, "labels", "f8", 8, size),
              owners = array_at(arrays, "demonstration", "i4", 4, size),
              table = array_at(arrays, "instances", "i4", 4, size);
  const auto rows = static_cast<std::size_t>(layout.picture.rows), columns = layout.picture.pixels() / rows;
  const std::size_t pixels = layout.picture.pixels(), numbers = layout.actions.size();
  const std::size_t steps = owners.shape.size() == 1 ? owners.shape[0] : 0;
  using Shape = std::vector<std::size_t>;
  if (rgb.shape != Shape{steps, rows, columns, 3} || ids.shape != Shape{steps, rows, columns} ||
      labels.shape != Shape{steps, numbers} || table.shape.size() != 2 || table.shape[1] != instance_numbers)
    arrays.fail("arrays of the shapes that the protocol names");
  const bool shaded = arrays.has("shadows");
  const Array shadows = shaded ? array_at(arrays, "shadows", "u2", 2, size) : Array();
  if (shaded && shadows.shape != ids.shape) arrays.at("shadows").fail("an array of the shape of ids");
  const std::size_t of_state = layout.state.size();
  const Array state = of_state > 0 ? array_at(arrays, "state", "f8", 8, size) : Array();
  if (of_state > 0 && state.shape != Shape{steps, of_state})
    arrays.at("state").fail("a row of the state for each step");
  const Array stops = layout.may_stop ? array_at(arrays, "stops", "u1", 1, size) : Array();
  if (layout.may_stop && stops.shape != Shape{steps}) arrays.at("stops").fail("a byte for each step");
  std::vector<JsonReader> brought;
  if (header.has("brought")) brought = header.at("brought").elements();
  if (!brought.empty() && brought.size() != steps) header.at("brought").fail("a list for each step");
  const std::vector<JsonReader> trajectories = header.at("trajectory_steps").elements();

  std::vector<Demonstration> all;
  for (const JsonReader& instruction : header.at("instructions").elements())
    all.push_back({read_instruction(instruction), {}});
  if (trajectories.size() != all.size()) header.at("trajectory_steps").fail("a number for each demonstration");
  std::vector<Step*> by_index;
  std::vector<std::size_t> lengths(all.size());
  for (std::size_t s = 0; s < steps; ++s)
    ++lengths.at(static_cast<std::size_t>(value_at<std::int32_t>(memory.data() + owners.offset, s)));
  std::vector<std::size_t> own;                   // steps of each that are its episode's
  for (std::size_t d = 0; d < all.size(); ++d) {  // rows stay where they are put
    own.push_back(static_cast<std::size_t>(trajectories[d].integer(0, static_cast<long long>(lengths[d]))));
    all[d].steps.reserve(own[d]);
    all[d].recovery.reserve(lengths[d] - own[d]);
  }
  for (std::size_t s = 0; s < steps; ++s) {
    const auto d = static_cast<std::size_t>(value_at<std::int32_t>(memory.data() + owners.offset, s));
    std::vector<Step>& owner = all[d].steps.size() < own[d] ? all[d].steps : all[d].recovery;
    Step step;
    const std::uint8_t* const colours = memory.data() + rgb.offset + s * 3 * pixels;
    const std::uint8_t* const labelled = memory.data() + ids.offset + s * pixels;
    step.observation.size = layout.picture;
    step.observation.rgb.assign(colours, colours + 3 * pixels);
    step.observation.ids.assign(labelled, labelled + pixels);
    if (shaded) {
      step.observation.shadows.resize(pixels);
      std::memcpy(step.observation.shadows.data(), memory.data() + shadows.offset + s * 2 * pixels, 2 * pixels);
    }
    const auto* const label = reinterpret_cast<const char*>(memory.data() + labels.offset + s * numbers * 8);
    if (!layout.may_stop || memory.data()[stops.offset + s] == 0)
      step.label = read_action({label, numbers * 8}, numbers);
    if (of_state > 0) {
      step.observation.state.resize(of_state);
      std::memcpy(step.observation.state.data(), memory.data() + state.offset + s * of_state * 8, of_state * 8);
    }
    if (!brought.empty())
      for (const JsonReader& thing : brought[s].elements())
        step.observation.brought.push_back({thing.at("object_type").string(), thing.at("texture").string()});
    owner.push_back(std::move(step));
    by_index.push_back(&owner.back());
  }
  for (std::size_t i = 0; i < table.shape[0]; ++i) {
    std::int32_t row[instance_numbers];
    std::memcpy(row, memory.data() + table.offset + i * sizeof row, sizeof row);
    by_index.at(static_cast<std::size_t>(row[0]))
        ->observation.instances.push_back({static_cast<std::uint8_t>(row[1]),
                                           words.at(static_cast<std::size_t>(row[2])),
                                           words.at(static_cast<std::size_t>(row[3])), row[4]});
  }
  return all;
}

}  // namespace lgabench::host
