#include <lgabench/core/environments.hpp>

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <sstream>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

constexpr const char *prefix = "liblgabench_env_", *suffix = ".so";

constexpr const char* path_variable = "LGABENCH_ENVIRONMENT_PATH";

// Libraries of all that are installed, by id; the first directory that has one wins.
const std::map<std::string, fs::path>& installed() {
  static const std::map<std::string, fs::path> files = [] {
    std::vector<fs::path> directories{library_directory()};
    const char* const listed = std::getenv(path_variable);
    std::istringstream words(listed ? listed : "");
    for (std::string word; std::getline(words, word, ':');)
      if (!word.empty()) directories.emplace_back(word);
    std::map<std::string, fs::path> found;
    const std::string first = prefix, last = suffix;
    for (const fs::path& directory : directories) {
      std::error_code none_to_list;
      for (const auto& entry : fs::directory_iterator(directory, none_to_list)) {
        const std::string name = entry.path().filename();
        if (name.size() > first.size() + last.size() && name.compare(0, first.size(), first) == 0 &&
            name.compare(name.size() - last.size(), last.size(), last) == 0)
          found.emplace(name.substr(first.size(), name.size() - first.size() - last.size()), entry.path());
      }
    }
    return found;
  }();
  return files;
}

// Never closed: objects of the environment may live as long as the program.
const EnvironmentType* load(const std::string& id) {
  const fs::path file = environment_file(id);
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw InputError(fmt::format("environment {}: {}", id, ::dlerror()));
  const auto entry = reinterpret_cast<decltype(&lgabench_environment)>(::dlsym(library, "lgabench_environment"));
  if (!entry) throw InputError(fmt::format("environment {}: {}", id, ::dlerror()));
  return entry();
}

void append_new(std::vector<std::string>& words, const std::vector<std::string>& more) {
  for (const std::string& word : more)
    if (!contains(words, word)) words.push_back(word);
}

}  // namespace

NothingToShow::~NothingToShow() = default;

std::string own_stream(std::optional<std::uint64_t> training_seed) {
  return training_seed ? fmt::format("/training seed {}", *training_seed) : "";
}

std::string later_stream(int step) { return step == 0 ? "" : fmt::format("/step {}", step); }

std::vector<std::string> environment_ids() {
  std::vector<std::string> ids;
  for (const auto& [id, file] : installed()) ids.push_back(id);
  return ids;
}

fs::path environment_file(const std::string& id) {
  const auto found = installed().find(id);
  if (found == installed().end()) throw InputError(none_named("environment", id, environment_ids()));
  return found->second;
}

const EnvironmentType& find_environment(const std::string& id) {
  environment_file(id);  // says which there are
  static std::mutex mutex;
  static std::map<std::string, const EnvironmentType*> loaded;
  const std::lock_guard lock(mutex);
  const EnvironmentType*& type = loaded[id];
  if (!type) type = load(id);
  return *type;
}

const EnvironmentType& environment_with_task(const std::string& id) {
  for (const std::string& name : environment_ids()) {
    const EnvironmentType& environment = find_environment(name);
    for (const TaskInfo& task : environment.tasks())
      if (task.id == id) return environment;
  }
  throw InputError(none_named("task", id, installed_task_ids()));
}

std::vector<TaskInfo> installed_tasks() {
  std::vector<TaskInfo> all;
  for (const std::string& id : environment_ids())
    for (const TaskInfo& task : find_environment(id).tasks()) all.push_back(task);
  return all;
}

std::vector<std::string> installed_task_ids() {
  std::vector<std::string> ids;
  for (const TaskInfo& task : installed_tasks()) ids.push_back(task.id);
  return ids;
}

std::vector<std::string> installed_layouts() {
  std::vector<std::string> layouts;
  for (const TaskInfo& task : installed_tasks()) append_new(layouts, task.layouts);
  return layouts;
}

std::vector<std::string> failure_words() {
  std::vector<std::string> words;
  for (const std::string& id : environment_ids()) append_new(words, find_environment(id).failures());
  append_new(words, {failure::truncated, failure::abstraction_empty, failure::method_error});
  const std::vector<TaskInfo> tasks = installed_tasks();
  if (std::any_of(tasks.begin(), tasks.end(), [](const TaskInfo& task) { return task.most_steps > 1; }))
    append_new(words, {failure::goes_on});
  return words;
}

Scene EnvironmentType::with_distractors(const Scenario&, Scene, int, bool, RandomStream) const {
  throw NothingToShow(fmt::format("environment {}: its scenes have no room for more distractors", id()));
}

Scene EnvironmentType::resized(Scene, double) const {
  throw InputError(fmt::format("environment {}: its objects have one size each", id()));
}

Scene EnvironmentType::with_larger_target(Scene, const std::vector<double>&) const {
  throw InputError(fmt::format("environment {}: its objects have one size each", id()));
}

const std::vector<StateNumber>& EnvironmentType::state_of(const TaskInfo&) const {
  static const std::vector<StateNumber> none;
  return none;
}

std::vector<std::string> EnvironmentType::layouts_of(const Scenario& scenario) const {
  return find_task(*this, scenario.task).layouts;
}

std::vector<std::string> layouts_of(const Scenario& scenario) { return scenario.environment->layouts_of(scenario); }

const ActionSpace& actions_of(const Scenario& scenario) {
  const EnvironmentType& environment = *scenario.environment;
  return environment.action_space_of(find_task(environment, scenario.task));
}

const std::vector<StateNumber>& state_of(const Scenario& scenario) {
  const EnvironmentType& environment = *scenario.environment;
  return environment.state_of(find_task(environment, scenario.task));
}

int most_instances_of(const Scenario& scenario) {
  const EnvironmentType& environment = *scenario.environment;
  return environment.most_instances(find_task(environment, scenario.task));
}

const TaskInfo& find_task(const EnvironmentType& environment, const std::string& id) {
  std::vector<std::string> known;
  for (const TaskInfo& task : environment.tasks()) {
    if (task.id == id) return task;
    known.push_back(task.id);
  }
  throw InputError(none_named("task", id, known));
}

}  // namespace lgabench
