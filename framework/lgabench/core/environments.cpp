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

// Every environment that was asked for or added.
class KnownEnvironments {
 public:
  std::function<std::string(const std::string& id)> look;  // set before main()

  void add(const std::string& id, const std::string& sha256, LoadEnvironment load) {
    if (contains(environment_ids(), id))
      throw InputError(fmt::format("environment {}: an environment of lgabench's own has that id", id));
    const std::lock_guard lock(mutex_);
    const Known& known = known_.emplace(id, Known{sha256, std::move(load)}).first->second;
    if (known.sha256 != sha256) throw InputError(fmt::format("environment {}: another plugin has that id", id));
  }

  const EnvironmentType& find(const std::string& id) {
    if (const EnvironmentType* loaded = if_loaded(id)) return *loaded;
    const std::vector<std::string> own = environment_ids();
    if (contains(own, id)) {
      const std::lock_guard lock(mutex_);
      known_.emplace(id, Known{"", [id] { return load(id); }});
    } else if (!has(id)) {
      const std::string refused = look ? look(id) : "";
      if (!has(id)) throw InputError(none_named("environment", id, ids(own)) + refused);
    }
    const std::lock_guard lock(mutex_);
    Known& known = known_.at(id);
    if (!known.type) known.type = known.load();
    return *known.type;
  }

 private:
  struct Known {
    std::string sha256;
    LoadEnvironment load;
    const EnvironmentType* type = nullptr;
  };

  const EnvironmentType* if_loaded(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(id);
    return known == known_.end() ? nullptr : known->second.type;
  }

  bool has(const std::string& id) {
    const std::lock_guard lock(mutex_);
    return known_.count(id) != 0;
  }

  std::vector<std::string> ids(std::vector<std::string> own) {
    const std::lock_guard lock(mutex_);
    for (const auto& one : known_)
      if (!contains(own, one.first)) own.push_back(one.first);
    return own;
  }

  std::recursive_mutex mutex_;  // an environment may ask for another one while it is loaded
  std::map<std::string, Known> known_;
};

KnownEnvironments& known_environments() {
  static auto& known = *new KnownEnvironments;  // never destroyed: a plugin's threads may still ask
  return known;
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

const EnvironmentType& find_environment(const std::string& id) { return known_environments().find(id); }

const EnvironmentType* environment_if_there(const std::string& id) {
  try {
    return &find_environment(id);
  } catch (const Error&) {
    return nullptr;
  }
}

void add_environment(const std::string& id, const std::string& sha256, LoadEnvironment load) {
  known_environments().add(id, sha256, std::move(load));
}

void look_for_environments(std::function<std::string(const std::string& id)> look) {
  known_environments().look = std::move(look);
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

std::vector<std::string> failure_words(const std::set<std::string>& found) {
  std::vector<std::string> words;
  for (const std::string& id : environment_ids()) append_new(words, find_environment(id).failures());
  append_new(words, {failure::truncated, failure::abstraction_empty, failure::method_error});
  append_new(words, {found.begin(), found.end()});
  return words;
}

// NOLINTBEGIN(performance-unnecessary-value-param): who overrides these changes the scene.
Scene EnvironmentType::with_distractors(const Scenario&, Scene, int, bool, RandomStream) const {
  throw NothingToShow(fmt::format("environment {}: its scenes have no room for more distractors", id()));
}

Scene EnvironmentType::resized(Scene, double) const {
  throw InputError(fmt::format("environment {}: its objects have one size each", id()));
}

Scene EnvironmentType::with_larger_target(Scene, const std::vector<double>&) const {
  throw InputError(fmt::format("environment {}: its objects have one size each", id()));
}
// NOLINTEND(performance-unnecessary-value-param)

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
