// What a run kept of a learned policy: the bytes as a cell's file, or as what a policy saved, whose kind the first
// names.
#include <algorithm>
#include <array>
#include <cstring>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/record/kept_policy.hpp>
#include <lgabench/record/layout.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

class Masked : public CloningMethod {
 public:
  Selection select(const Command&, const FeatureSpace&, Services&) override { return {}; }
};

// Restoring asks nobody.
class NoModel : public LanguageModel {
  std::vector<bool> answer(const Command&, const FeatureSpace&, const std::vector<Question>&) override { return {}; }
  std::string model() const override { return {}; }
  Provenance provenance() const override { return {}; }
  SelectionCost cost() const override { return {}; }
};
class NoHuman : public HumanAnswers {
  Selection specify(const Command&) override { return {}; }
  Selection edit(const Command&, const Selection& proposal) override { return proposal; }
};
class NoLog : public TrainingLog {
  void epoch(int, long long, double) override {}
};

Json options_of(const char* kind) {
  return {{"policy", kind},     {"epochs", 1},        {"batch_size", 1}, {"learning_rate", .1},
          {"batches", "drawn"}, {"network", "plain"}, {"loss", "norm"}};
}

void read_file_of(std::string_view text) {
  static const fs::path file = fuzz::directory() / cell_file::policy;
  fuzz::write(file, text);
  try {
    read_kept_policy(file.parent_path());
  } catch (const InputError&) {
  }
}

// A picture's rows and columns, which stand first, no larger than a policy needs them. What is refused stays as it is.
void make_small(std::string& saved) {
  constexpr std::int32_t enough = 64, longest = 4096;
  for (const std::size_t at : {std::size_t{0}, sizeof enough}) {
    if (saved.size() < at + sizeof enough) return;
    std::int32_t side;
    std::memcpy(&side, saved.data() + at, sizeof side);
    if (side > enough && side <= longest) side = enough;
    std::memcpy(saved.data() + at, &side, sizeof side);
  }
}

// A heart of 4 x 4 pixels.
Observation one_object() {
  const PictureSize picture{32, 64};
  Observation seen{picture,
                   std::vector<std::uint8_t>(3 * picture.pixels()),
                   std::vector<std::uint8_t>(picture.pixels()),
                   {{1, "heart", "red", 16}}};
  for (int pixel = 0; pixel < 16; ++pixel)
    seen.ids[static_cast<std::size_t>((10 + pixel / 4) * picture.columns + 20 + pixel % 4)] = 1;
  return seen;
}

void restore(const std::string& saved, const Json& options, bool acts) {
  static const ActionSpace actions = find_environment("tabletop").action_space();
  static const Observation observation = one_object();
  static NoModel model;
  static NoHuman human;
  static NoLog log;
  Services services{model, human, options, 1, log, actions};
  try {
    const auto policy = Masked().restore(saved, services);
    Selection all;
    all.target = Meaning({"heart"}, {"red"});
    if (acts) policy->act(observation, {"the heart", all});
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array of_kinds{options_of("centroid"), options_of("heat_map"), options_of("regression")};
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data, size);
  enum : std::uint8_t { centroid, heat_map, regression, file, kinds };  // file: as that of "{"
  const auto kind = data[0] % kinds;
  const bool whole = fuzz::takes_long(text);
  std::string saved(text.substr(1));
  if (!whole) make_small(saved);
  // The network of a regression takes long to be made, and reads nothing but its megabytes.
  if (kind == file)
    read_file_of(text);
  else if (kind == centroid || whole)
    restore(saved, of_kinds[kind], true);
  else if (kind == heat_map)
    restore(saved, of_kinds[kind], fuzz::takes_long(text, 20));
  return 0;
}
