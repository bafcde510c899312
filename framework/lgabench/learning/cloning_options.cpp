#include <lgabench/learning/cloning_options.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lgabench {
namespace {

template <class T>
using Names = std::vector<std::pair<std::string, T>>;

template <class T>
T named(const JsonReader& option, const Names<T>& known) {
  const std::string word = option.string();
  std::string names;
  for (const auto& [name, value] : known) {
    if (name == word) return value;
    names += (names.empty() ? "" : ", ") + name;
  }
  option.fail("one of " + names);
}

template <class T>
void read_if_there(const JsonReader& options, const char* name, const Names<T>& known, T& value) {
  if (options.has(name)) value = named(options.at(name), known);
}

}  // namespace

CloningOptions read_cloning_options(const Json& json) {
  constexpr int most = 1'000'000;
  const JsonReader options(json, "options");
  CloningOptions read;
  const JsonReader epochs = options.at("epochs");
  if (epochs.json().is_string())
    read.training.until_converged = named<bool>(epochs, {{"converged", true}});
  else
    read.training.epochs = static_cast<int>(epochs.integer(1, most));
  read.training.batch_size = static_cast<int>(options.at("batch_size").integer(1, most));
  read.training.learning_rate = options.at("learning_rate").number();
  read.training.batches =
      named<Batches>(options.at("batches"), {{"drawn", Batches::drawn}, {"shuffled", Batches::shuffled}});
  read_if_there(options, "copy_steps", {{"equal", true}, {"all", false}}, read.training.equal_steps);
  read_if_there(options, "instances", {{"all", Instances::all}, {"first", Instances::first}}, read.instances);
  read_if_there(options, "mask", {{"binary", false}, {"signed", true}}, read.signed_mask);
  read.points = options.has("policy") && options.at("policy").json() == "point";
  read_if_there(options, "policy",
                {{"regression", PolicyKind::regression},
                 {"centroid", PolicyKind::centroid},
                 {"heat_map", PolicyKind::heat_map},
                 {"point", PolicyKind::regression}},
                read.policy);
  return read;
}

bool read_picture_option(const Json& json) {
  bool picture = false;
  read_if_there({json, "options"}, "picture", {{"none", false}, {"rgb", true}}, picture);
  return picture;
}

NetworkOptions read_network_options(const Json& json) {
  const JsonReader options(json, "options");
  const JsonReader network = options.at("network");
  return {named<Architecture>(network, {{"text", Architecture::text},
                                        {"released", Architecture::released},
                                        {"plain", Architecture::plain},
                                        {"spot", Architecture::plain}}),
          network.string() == "spot",
          named<Loss>(options.at("loss"), {{"norm", Loss::norm}, {"squared", Loss::squared}})};
}

}  // namespace lgabench
