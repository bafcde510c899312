// From a file's bytes to a PluginInfo: nothing of the plugin runs.
#include <elf.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/perturbations.hpp>
#include <lgabench/plugin/fingerprint.hpp>
#include <lgabench/plugin/reader.hpp>

namespace lgabench {
namespace {

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

#if defined(__x86_64__)
constexpr int own_machine = EM_X86_64;
#elif defined(__aarch64__)
constexpr int own_machine = EM_AARCH64;
#elif defined(__riscv)
constexpr int own_machine = EM_RISCV;
#elif defined(__powerpc64__)
constexpr int own_machine = EM_PPC64;
#endif

struct Range {
  std::size_t offset, size;
};

// What of the file is mapped when it is loaded. Checked to be there: past the end of a file that was cut off lies a
// SIGBUS.
std::vector<Range> loaded_ranges(std::string_view bytes) {
  if (bytes.empty()) throw PluginError("not a shared library: the file is empty");
  if (bytes.size() < sizeof(Elf64_Ehdr) || bytes.substr(0, SELFMAG) != ELFMAG)
    throw PluginError("not a shared library: no ELF header");
  const auto elf = value_at<Elf64_Ehdr>(bytes, 0);
  if (elf.e_ident[EI_CLASS] != ELFCLASS64 || elf.e_type != ET_DYN)
    throw PluginError("not a shared library: an ELF file of another kind");

  if (elf.e_machine != own_machine)
    throw PluginError(fmt::format("built for ELF machine {} (this program: {})", elf.e_machine, own_machine));

  const auto check_end = [&bytes](std::uint64_t offset, std::uint64_t size, const char* what) {
    if (offset > bytes.size() || size > bytes.size() - offset)
      throw PluginError(
          fmt::format("cut off: {} bytes of file, but {} at {} of {} bytes", bytes.size(), what, offset, size));
  };
  check_end(elf.e_shoff, std::uint64_t{elf.e_shnum} * elf.e_shentsize, "section headers");
  check_end(elf.e_phoff, std::uint64_t{elf.e_phnum} * sizeof(Elf64_Phdr), "program headers");
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < elf.e_phnum; ++i) {
    const auto segment = value_at<Elf64_Phdr>(bytes, elf.e_phoff + i * sizeof(Elf64_Phdr));
    if (segment.p_type != PT_LOAD) continue;
    check_end(segment.p_offset, segment.p_filesz, "a segment");
    ranges.push_back({segment.p_offset, segment.p_filesz});
  }
  return ranges;
}

// "a=b;c=d" as {a: b, c: d}.
std::map<std::string, std::string> components(const std::string& fingerprint) {
  std::map<std::string, std::string> all;
  std::size_t begin = 0;
  while (begin < fingerprint.size()) {
    const std::size_t end = std::min(fingerprint.find(';', begin), fingerprint.size());
    const std::string part = fingerprint.substr(begin, end - begin);
    const std::size_t equals = std::min(part.find('='), part.size());
    all[part.substr(0, equals)] = equals < part.size() ? part.substr(equals + 1) : "";
    begin = end + 1;
  }
  return all;
}

void check_fingerprint(const std::string& fingerprint) {
  auto theirs = components(fingerprint), ours = components(LGABENCH_FINGERPRINT);
  if (theirs["LibTorch"] == "none" || ours["LibTorch"] == "none")  // either may do without
    theirs["LibTorch"] = ours["LibTorch"];
  std::vector<std::string> differences;
  for (const auto& [key, our] : ours)
    if (key != "compiler" && theirs[key] != our)
      differences.push_back(fmt::format("{} \"{}\" (this program: \"{}\")", key, theirs[key], our));
  if (differences.empty()) return;
  const auto same = [&](const char* key) { return theirs[key] == ours[key]; };
  const char* what_to_do = !same("SDK") ? ": build it again with this lgabench's package (docs/from-0.4-to-0.5.md)"
                           : !same("string ABI")
                               ? ": build it without -D_GLIBCXX_USE_CXX11_ABI=0, which older builds of LibTorch add"
                           : !same("iterators") ? ": build it without -D_GLIBCXX_DEBUG"
                           : !same("sanitizer") ? ": build it without -fsanitize, or lgabench with the same"
                                                : "";
  throw PluginError(fmt::format("built with {}{}", fmt::join(differences, ", "), what_to_do));
}

template <std::size_t Size>
std::string text(const char (&field)[Size], const char* name) {
  const auto* end = static_cast<const char*>(std::memchr(field, 0, Size));
  if (!end) throw PluginError(fmt::format("descriptor: {} has no end within {} bytes", name, Size));
  std::string value(field, end);
  try {
    canonical(value);
  } catch (const InputError&) {
    throw PluginError(fmt::format("descriptor: {}: expected valid UTF-8", name));
  }
  return value;
}

bool offers(const Json& option, const Json& value) {
  const Json values = option.is_object() ? option.value("values", Json()) : Json();
  return values.is_array() && contains(values, value);
}

// {"value": {"other option": [values of that one]}}: each is to be one that the option has.
void check_needs(const JsonReader& option, const Json& options) {
  const JsonReader needs = option.at("needs");
  if (!needs.json().is_object()) needs.fail("an object");
  for (const auto& [value, others] : needs.json().items()) {
    if (!offers(option.json(), value)) needs.fail(fmt::format("one of the option's values, got \"{}\"", value));
    if (!others.is_object()) needs.at(value).fail("an object");
    for (const auto& [other, allowed] : others.items())
      for (const JsonReader& one : needs.at(value).at(other).elements())
        if (!offers(options.value(other, Json()), one.json())) one.fail(fmt::format("a value of option {}", other));
  }
}

}  // namespace

bool is_name(const std::string& id) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  return !id.empty() && lower(id[0]) &&
         std::all_of(id.begin(), id.end(), [&lower](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; });
}

// Complaints of InputError's kind are the plugin's fault here.
DeclaredOptions read_options(const std::string& options_json) {
  try {
    DeclaredOptions declared{parse_json(options_json, "options")};
    Json& options = declared.options;
    if (!options.is_object()) JsonReader(options, "options").fail("an object");
    for (const auto& [name, says] :
         {std::pair{"questionnaire", &declared.questionnaire}, {"kinematic", &declared.kinematic}})
      if (const auto said = options.find(name); said != options.end() && said->is_boolean()) {
        *says = said->get<bool>();
        options.erase(said);
      }
    for (const auto& [name, option] : options.items()) {
      const JsonReader reader(option, "options", "/" + name);
      reader.only({"default", "help", "source", "values", "min", "max", "words", "needs", "framework", "added"});
      const Json& usual = reader.at("default").json();
      if (usual.is_structured() || usual.is_null()) reader.at("default").fail("a text, number or boolean");
      reader.at("help").string();
      reader.at("source").string();
      if (reader.has("values")) {
        const Json& values = reader.at("values").json();
        if (!values.is_array() || !contains(values, usual)) reader.at("values").fail("a list that holds the default");
      }
      if (reader.has("min") && (!usual.is_number() || usual.get<double>() < reader.at("min").number()))
        reader.at("min").fail("a number, not above a default that is one");
      if (reader.has("max") && (!usual.is_number() || usual.get<double>() > reader.at("max").number()))
        reader.at("max").fail("a number, not below a default that is one");
      if (reader.has("words") && (!usual.is_number() || reader.at("words").strings().empty()))
        reader.at("words").fail("texts, beside a default that is a number");
      if (reader.has("needs")) check_needs(reader, options);
      if (reader.has("framework")) reader.at("framework").boolean();
      if (reader.has("added")) reader.at("added").boolean();
    }
    return declared;
  } catch (const InputError& e) {
    throw PluginError(e.what());
  }
}

Json read_declared_axis(const PluginInfo& plugin, const std::string& declared) {
  try {
    Json json = parse_json(declared, "axis");
    if (json.is_object() && json.contains("version"))
      JsonReader(json, "axis").fail("no \"version\", which the plugin declares");
    json["version"] = plugin.version;
    return axis_json(read_axis(plugin.id, JsonReader(json, "axis")));
  } catch (const InputError& e) {
    throw PluginError(e.what());
  }
}

void check_asks(const std::string& kind, const std::string& asks) {
  constexpr std::array<const char*, 6> known{"", "specify", "edit", "accept", "truth", "network"};
  if (!contains(known, asks) || (kind != "method" && !asks.empty()))
    throw PluginError(
        fmt::format("descriptor: asks \"{}\", expected \"specify\", \"edit\", \"accept\", \"truth\" or \"network\" of "
                    "a method, or \"\"",
                    asks));
}

PluginDescriptor find_descriptor(std::string_view bytes) {
  constexpr std::string_view magic(LGABENCH_PLUGIN_MAGIC, sizeof(PluginDescriptor::magic));
  constexpr std::size_t size_at = offsetof(PluginDescriptor, struct_size), abi_at = offsetof(PluginDescriptor, abi);
  constexpr std::size_t header = abi_at + sizeof(PluginDescriptor::abi);

  // Debug information repeats constants, so only what is loaded counts.
  const std::vector<Range> loaded = loaded_ranges(bytes);
  std::vector<std::string_view> found;  // from the magic to the end of its range
  for (std::size_t at = bytes.find(magic); at != bytes.npos; at = bytes.find(magic, at + 1)) {
    const auto holds = [at](const Range& r) { return at >= r.offset && at - r.offset < r.size; };
    const auto range = std::find_if(loaded.begin(), loaded.end(), holds);
    if (range != loaded.end()) found.push_back(bytes.substr(at, range->offset + range->size - at));
  }
  if (found.empty()) throw PluginError("no lgabench descriptor: a library, but not a plugin of this framework");
  if (found.size() > 1) throw PluginError(fmt::format("{} lgabench descriptors, expected one", found.size()));

  if (found[0].size() < header) throw PluginError("descriptor: cut off");
  const auto abi = value_at<std::uint32_t>(found[0], abi_at);
  if (abi != LGABENCH_PLUGIN_ABI)
    throw PluginError(fmt::format("plugin interface {} (this program: {}): build it with this lgabench's package", abi,
                                  LGABENCH_PLUGIN_ABI));
  const auto size = value_at<std::uint32_t>(found[0], size_at);
  if (size != sizeof(PluginDescriptor))
    throw PluginError(fmt::format("descriptor of {} bytes (this program: {})", size, sizeof(PluginDescriptor)));
  if (found[0].size() < size) throw PluginError("descriptor: cut off");
  return value_at<PluginDescriptor>(found[0], 0);
}

PluginInfo inspect_plugin(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw PluginError("not a regular file");  // opening a FIFO would wait
  std::string bytes;
  try {
    bytes = read_file(file);
  } catch (const InputError& e) {
    throw PluginError(e.what());
  }
  const PluginDescriptor d = find_descriptor(bytes);
  PluginInfo plugin;
  plugin.file = file;
  plugin.fingerprint = text(d.fingerprint, "fingerprint");
  check_fingerprint(plugin.fingerprint);
  plugin.kind = text(d.kind, "kind");
  constexpr std::array kinds{"method", "engine", "perturbation", "perceiver", "environment"};
  if (!contains(kinds, plugin.kind))
    throw PluginError(fmt::format("descriptor: kind \"{}\", expected one of: {}", plugin.kind, fmt::join(kinds, ", ")));
  plugin.asks = text(d.asks, "asks");
  check_asks(plugin.kind, plugin.asks);
  plugin.id = text(d.id, "id");
  if (!is_name(plugin.id))
    throw PluginError(
        fmt::format("descriptor: id \"{}\", expected lower-case letters, digits and underscores", plugin.id));
  if (plugin.kind == "engine" && plugin.id == own_engine)
    throw PluginError(fmt::format("descriptor: id \"{}\" stands for no engine plugin, expected another", plugin.id));
  plugin.version = text(d.version, "version");
  plugin.summary = text(d.summary, "summary");
  const std::string declarations = text(d.options_json, "options");
  if (plugin.kind == "perturbation") {
    plugin.options = Json::object();
    plugin.axis = read_declared_axis(plugin, declarations);
  } else {
    DeclaredOptions declared = read_options(declarations);
    plugin.options = std::move(declared.options);
    plugin.questionnaire = declared.questionnaire;
    plugin.kinematic = declared.kinematic;
  }
  plugin.sha256 = sha256(bytes);
  return plugin;
}

PluginInfo read_plugin(const fs::path& file) {
  try {
    return inspect_plugin(file);
  } catch (const PluginError& e) {
    throw PluginError(fmt::format("{}: {}", file.string(), e.what()));
  }
}

}  // namespace lgabench
