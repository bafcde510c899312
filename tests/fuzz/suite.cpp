// A suite's file, and the cells of its presets where they are few.
#include <lgabench/harness/expand.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

// Two engines and a method, as their descriptors say; no file of theirs is read.
const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue some;
    for (const char* engine : {"mujoco", "kinematic"})
      some.plugins.push_back({{}, "engine", engine, "1", "", "", {}, ""});
    const Json options{{"network", {{"default", "text"}, {"values", {"text", "plain"}}, {"help", ""}, {"source", ""}}},
                       {"epochs", {{"default", 750}, {"min", 1}, {"help", ""}, {"source", ""}}},
                       {"noise", {{"default", 0.5}, {"help", ""}, {"source", ""}}}};
    some.plugins.push_back({{}, "method", "lga", "1", "", "", options, ""});
    return some;
  }();
  return all;
}

bool few_cells(const Design& design) {
  std::size_t cells = design.scenarios.size() > 2 ? 0 : 1;  // a scenario's data take time to be hashed
  for (const std::size_t factor : {design.layouts.size(), design.engines.size(), design.methods.size(),
                                   design.seeds.size(), design.demonstrations.size()})
    cells = cells > 100 ? cells : cells * factor;
  return cells > 0 && cells <= 100;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path file = fuzz::write(fuzz::directory() / "fuzzed.json", fuzz::text_of(data, size));
  try {
    const Suite suite = load_suite(file.string());
    std::vector<std::string> presets{""};
    for (const auto& preset : suite.presets.items()) presets.push_back(preset.key());
    for (const std::string& preset : presets) {
      const Design design = preset_design(suite, preset);
      canonical(to_json(design));
      if (few_cells(design))
        for (const Cell& cell : expand(suite, design, {}, catalogue())) key(read_cell(to_json(cell), "cell.json"));
    }
  } catch (const InputError&) {
  } catch (const PluginError&) {
  }
  return 0;
}
