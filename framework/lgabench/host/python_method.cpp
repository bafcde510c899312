#include <lgabench/host/python_method.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/host/installed_methods.hpp>
#include <lgabench/host/python_environment.hpp>
#include <lgabench/host/reach.hpp>
#include <lgabench/plugin/reader.hpp>

namespace lgabench {
namespace {

struct Output {
  std::string out, error;
  int status = 0;
};

// Nothing but the interpreter's own paths and lgabench's package: no module of the directory that it starts in.
constexpr const char* start =
    "import sys; sys.path[:] = [sys.argv.pop(1), *filter(None, sys.path)]; "
    "from lgabench_method.__main__ import main; sys.exit(main(sys.argv[1:]))";

// What an interpreter is found by, and its packages: no key or token of whoever names a stranger's method.
std::vector<std::string> describing_environment() {
  std::vector<std::string> all{"LC_ALL=C.UTF-8", "PYTHONDONTWRITEBYTECODE=1", "OPENBLAS_NUM_THREADS=1"};
  for (const char* name : {"PATH", "HOME", "LD_LIBRARY_PATH", "PYTHONUSERBASE", "PYTHONNOUSERSITE", "PYENV_ROOT",
                           "PYENV_VERSION", "MUJOCO_GL", "PYOPENGL_PLATFORM"})
    if (const char* value = std::getenv(name)) all.push_back(fmt::format("{}={}", name, value));
  return all;
}

// What reading a method's file may take: a parser needs 200 times its size. Time is the processor's, so that a slow
// disk costs none.
constexpr rlim_t most_mib = 8, most_seconds = 10, most_gib = 2;

// In the process that reads the file. False where the system refused.
bool confine(const Confinement& confinement) {
  const auto limit = [](auto resource, rlim_t value) {
    rlimit both{};
    ::getrlimit(resource, &both);
    both.rlim_cur = std::min(value, both.rlim_max);
    return ::setrlimit(resource, &both) == 0;
  };
  return limit(RLIMIT_CORE, 0) && limit(RLIMIT_CPU, most_seconds) && limit(RLIMIT_DATA, most_gib << 30) &&
         confinement.apply();
}

// Why an interpreter did not start, or lgabench's package in it, and what to do.
std::string not_started_text(const std::string& interpreter, const std::string& why) {
  std::error_code no_link;
  const fs::path leads = fs::read_symlink(interpreter, no_link);
  if (interpreter.find('/') != interpreter.npos && !no_link && !fs::exists(interpreter))
    return fmt::format(
        "{}: a link to {}, which does not exist: make the virtual environment again, or name another "
        "interpreter with --python",
        interpreter, leads.string());
  return fmt::format("{}; --python names the interpreter", why);
}

// What the interpreter prints, without a shell, started in an empty directory; confined where the method's file is
// read.
Output output_of(const std::string& interpreter, const std::string& word, const Confinement* confinement) {
  const Scratch scratch("python");
  const std::string out = (scratch.path / "out").string(), error = (scratch.path / "error").string();
  const std::string package = python_package().string();
  const bool is_path = interpreter.find('/') != std::string::npos;
  const fs::path empty = scratch.path / "empty";
  fs::create_directory(empty);
  const auto made = [](const std::string& file) {
    return Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  };
  const Descriptor to_out = made(out), to_error = made(error);
  pid_t pid = -1;
  try {
    pid = start_process({{is_path ? fs::absolute(interpreter).string() : interpreter, "-c", start, package, word},
                         describing_environment(),
                         {{to_out.fd, 1}, {to_error.fd, 2}},
                         empty,
                         [confinement] { return !confinement || confine(*confinement); }});
  } catch (const Refused& e) {
    throw PluginError(not_started_text(interpreter, e.what()));
  }
  const int status = wait_for(pid);
  return {read_file(out), read_file(error), status};
}

// The last line: a traceback's has the error.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

// What it printed. @throws PluginError with its last words where it failed.
std::string answer_of(const std::string& interpreter, const std::string& word, const Confinement* confinement) {
  const auto [out, error, status] = output_of(interpreter, word, confinement);
  if (status != 0 && error.find("No module named 'numpy'") != error.npos)
    throw PluginError(fmt::format(
        "{0}: has no NumPy, which plugins in Python need: {0} -m pip install numpy, or name an interpreter that has it "
        "with --python (/usr/bin/python3 with Debian's python3-numpy)",
        interpreter));
  const std::string last = last_line(error);
  if (confinement && (WIFSIGNALED(status) || last.rfind("MemoryError", 0) == 0))
    throw PluginError(fmt::format("{}: reading it took more than {} s of processor time or {} GiB of memory",
                                  word.substr(0, word.rfind(':')), most_seconds, most_gib));
  if (status != 0) throw PluginError(fmt::format("{}: {}", interpreter, last));
  return out;
}

// Asked before a file is opened: opening a FIFO would wait for ever. The reader of the file reports a missing one.
void check_is_readable(const fs::path& file) {
  std::error_code not_there;
  const fs::file_status status = fs::status(file, not_there);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw PluginError(fmt::format("{}: expected a regular file", file.string()));
  if (const std::uintmax_t bytes = fs::file_size(file, not_there); !not_there && bytes > most_mib << 20)
    throw PluginError(fmt::format("{}: expected at most {} MiB, got {} bytes", file.string(), most_mib, bytes));
}

// The descriptor that the file holds, by its absolute name, with where its interpreter reads. That is asked first,
// without the file: its reader then reaches nothing else.
Json description_of(const std::string& interpreter, const std::string& file, const fs::path& site) {
  Json python = parse_json(answer_of(interpreter, "--interpreter", nullptr), interpreter);
  if (!site.empty() && python.is_object()) python["reads"].push_back(site.string());
  const JsonReader reader(python, interpreter);
  reader.at("reads").strings();
  Reach reach = system_reach();
  add_python(reach, python);
  std::error_code not_there;  // the reader of the file reports a missing one
  reach.reads.push_back(fs::weakly_canonical(file.substr(0, file.rfind(':')), not_there).parent_path());
  const Confinement confinement(reach);
  python.update(parse_json(answer_of(reader.at("interpreter").string(), file, &confinement), file));
  return python;
}

// Of the file as text: its classes at the outermost level, for a message.
std::vector<std::string> classes_of(const fs::path& file) {
  std::vector<std::string> names;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && names.size() < 20;)
    if (line.rfind("class ", 0) == 0) names.push_back(line.substr(6, line.find_first_of("(: ", 6) - 6));
  if (names.empty()) names.emplace_back("no class");
  return names;
}

}  // namespace

void add_once(const PluginInfo& plugin, Catalogue& catalogue) {
  const auto same_id = [&plugin](const PluginInfo& p) { return p.kind == plugin.kind && p.id == plugin.id; };
  const auto known = std::find_if(catalogue.plugins.begin(), catalogue.plugins.end(), same_id);
  if (known == catalogue.plugins.end())
    catalogue.plugins.push_back(plugin);
  else if (known->file != plugin.file || known->python != plugin.python)
    throw PluginError(
        fmt::format("{}: {} is also the id of {}", plugin.file.string(), plugin.id, known->file.string()));
}

bool is_python_method(const std::string& word) {
  const std::string written = row_words(word).front();
  return written.find(".py:") != written.npos || fs::path(written).extension() == ".py";
}

PluginInfo describe_python(const std::string& written, const std::string& interpreter) {
  PluginInfo plugin = describe_python(written, interpreter, {}, "");
  warn_of_home(plugin.file.parent_path());
  return plugin;
}

PluginInfo describe_python(const std::string& written, const std::string& interpreter, const fs::path& site,
                           const std::string& id) {
  PluginInfo plugin;
  const bool has_class = written.find(".py:") != written.npos;
  check_is_readable(has_class ? written.substr(0, written.rfind(':')) : written);
  if (!has_class) {
    std::error_code not_there;
    if (!fs::exists(written, not_there)) throw PluginError(written + ": no such file");
    throw PluginError(
        fmt::format("{0}: expected {0}:CLASS; it has: {1}", written, fmt::join(classes_of(written), ", ")));
  }
  try {
    const Json json = description_of(interpreter, fs::absolute(written).string(), site);
    const JsonReader reader(json, written);
    plugin.file = reader.at("file").string();
    plugin.kind = reader.at("kind").string();
    plugin.id = id.empty() ? reader.at("id").string() : id;
    plugin.version = reader.at("version").string();
    plugin.summary = reader.at("summary").string();
    plugin.asks = reader.at("asks").string();
    plugin.sha256 = reader.at("sha256").string();
    plugin.questionnaire = reader.at("questionnaire").boolean();
    if (plugin.kind == "perturbation") plugin.axis = read_declared_axis(plugin, canonical(reader.at("axis").json()));
    plugin.options = read_options(canonical(reader.at("options").json())).options;
    for (const auto& option : plugin.options.items())  // a CloningMethod's alone
      JsonReader(option.value(), "options", "/" + option.key())
          .only({"default", "help", "source", "values", "min", "max", "needs"});
    for (const char* member : {"class", "interpreter", "reads", "selects_alone", "user_base", "versions"})
      plugin.python[member] = reader.at(member).json();
    if (plugin.kind == "environment") {
      plugin.python["environment"] = reader.at("environment").json();
      expect_environment(plugin);
    }
    plugin.fingerprint = canonical(plugin.python["versions"]);
  } catch (const InputError& e) {
    throw PluginError(fmt::format("{}: {}", written, e.what()));
  }
  check_asks(plugin.kind, plugin.asks);
  if (!is_name(plugin.id))
    throw PluginError(fmt::format(
        "{}: id \"{}\", expected lower-case letters, digits and underscores (an attribute id, else the file's name)",
        written, plugin.id));
  if (plugin.asks == "truth")
    throw PluginError(fmt::format("{}: asks \"truth\", which only shipped methods may", written));
  return plugin;
}

std::string with_python_method(const std::string& row, const std::string& interpreter, Catalogue& catalogue) {
  if (selects_alone(row)) return selected_by + with_python_method(without_selected_by(row), interpreter, catalogue);
  if (!is_python_method(row)) return row;
  const std::string written = row_words(row).front();
  const PluginInfo plugin = describe_python(written, interpreter);
  if (plugin.kind != "method")
    throw PluginError(fmt::format("{}: expected a method, it is a {}", written, plugin.kind));
  add_once(plugin, catalogue);
  return plugin.id + row.substr(written.size());
}

Catalogue plugins_at(const std::vector<fs::path>& paths, const std::string& interpreter) {
  const auto is_python = [](const fs::path& path) { return is_python_method(path.string()); };
  const std::vector<fs::path> directories = plugin_directories(paths);
  Catalogue catalogue = scan_plugins(directories);
  std::set<fs::path> folders;  // each once, also where an option and the variable name it
  std::error_code unreachable;
  for (const fs::path& one : directories)
    if (const fs::path folder = fs::is_directory(one, unreachable) ? one : fs::absolute(one).parent_path();
        !is_python(one))
      folders.insert(fs::weakly_canonical(folder, unreachable));
  for (const fs::path& folder : folders) warn_of_home(folder);
  for (const fs::path& directory : directories)
    if (is_site_packages(directory)) add_installed_methods(directory, interpreter, catalogue);
  const auto add = [&](const fs::path& path) {
    const PluginInfo plugin = describe_python(path.string(), interpreter);
    if (plugin.kind == "environment") add_environment(plugin);
    add_once(plugin, catalogue);
  };
  for (const fs::path& path : paths)
    if (is_python(path)) add(path);
  for (const fs::path& path : directories) {  // of $LGABENCH_PLUGIN_PATH: a broken one stops nothing else
    if (!is_python(path) || contains(paths, path)) continue;
    try {
      add(path);
    } catch (const Error& e) {
      catalogue.refused.push_back({path, e.what()});
    }
  }
  add_axes(catalogue);
  return catalogue;
}

}  // namespace lgabench
