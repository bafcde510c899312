#include <lgabench/core/environments.hpp>

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/suggest.hpp>

namespace lgabench {
namespace {

constexpr const char *prefix = "liblgabench_env_", *suffix = ".so";

// Never closed: objects of the environment may live as long as the program.
const EnvironmentType* load(const std::string& id) {
  const fs::path file = library_directory() / (prefix + id + suffix);
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

std::vector<std::string> environment_ids() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> found;
    const std::string first = prefix, last = suffix;
    for (const auto& entry : fs::directory_iterator(library_directory())) {
      const std::string name = entry.path().filename();
      if (name.size() > first.size() + last.size() && name.compare(0, first.size(), first) == 0 &&
          name.compare(name.size() - last.size(), last.size(), last) == 0)
        found.push_back(name.substr(first.size(), name.size() - first.size() - last.size()));
    }
    std::sort(found.begin(), found.end());
    return found;
  }();
  return ids;
}

const EnvironmentType& find_environment(const std::string& id) {
  const std::vector<std::string> ids = environment_ids();
  if (!contains(ids, id)) throw InputError(none_named("environment", id, ids));
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

std::vector<std::string> EnvironmentType::layouts_of(const Scenario& scenario) const {
  return find_task(*this, scenario.task).layouts;
}

std::vector<std::string> layouts_of(const Scenario& scenario) { return scenario.environment->layouts_of(scenario); }

const ActionSpace& actions_of(const Scenario& scenario) {
  const EnvironmentType& environment = *scenario.environment;
  return environment.action_space_of(find_task(environment, scenario.task));
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
