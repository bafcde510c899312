// lgabench verify: computes cells of a finished run again, and says whether they are what was recorded.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <set>

#include <lgabench/cli/outcome.hpp>
#include <lgabench/cli/recorded_run.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/recompute.hpp>
#include <lgabench/harness/run_suite.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/statistics/agreement.hpp>
#include <lgabench/statistics/pairs.hpp>

namespace lgabench::cli {
namespace {

struct VerifyArguments : RecomputeArguments {
  int sample = 3;
  std::optional<std::uint32_t> seed;
  bool all = false, strict = false, json = false;
};

std::vector<Recorded> sampled(std::vector<Recorded> cells, std::size_t wanted, std::uint32_t seed) {
  if (wanted >= cells.size()) return cells;
  std::vector<int> order = RandomStream(fmt::format("verify/{}", seed)).permutation(static_cast<int>(cells.size()));
  order.resize(wanted);
  std::sort(order.begin(), order.end());
  std::vector<Recorded> chosen;
  for (const int i : order) chosen.push_back(std::move(cells[static_cast<std::size_t>(i)]));
  return chosen;
}

// "WHAT abcdef01 there, 23456789 here" for every hash that differs.
void add_differences(std::set<std::string>& why, const Json& there, const Json& here, const std::string& prefix) {
  for (const auto& [name, hash] : here.items()) {
    const std::string before = there.is_object() && there.contains(name) && there[name].is_string()
                                   ? there[name].get<std::string>().substr(0, 8)
                                   : "none";
    if (!there.is_object() || there.value(name, Json()) != hash)
      why.insert(fmt::format("{}{} ({} there, {} here)", prefix, name, before, hash.get<std::string>().substr(0, 8)));
  }
}

// The cell as this installation's data make it; the worker refuses to compute with other data than the cell names.
Cell with_present_data(const Recorded& recorded, std::set<std::string>& why) {
  Cell cell = recorded.cell;
  const std::string file = (recorded.directory / cell_file::configuration).string();
  cell.data = data_hashes(read_scenario(*cell.scenario, file + ": /scenario"), cell.answers, cell.reading);
  add_differences(why, recorded.cell.data, cell.data, "data: ");
  return cell;
}

struct Compared {
  std::string key, title, row;
  statistics::CellAgreement agreement;  // "differs" unless it says otherwise
};

Compared compared(const Recorded& recorded, const fs::path& recomputed, bool excused) {
  Compared cell{recorded.directory.filename().string(), recorded.cell.title(), recorded.cell.method.name, {}};
  if (const CellStatus status = read_cell_status(recomputed); status.failed)
    cell.agreement.detail = "fails now: " + status.reason;
  else
    cell.agreement = statistics::compare_cells(recorded.directory, recomputed, excused);
  return cell;
}

// "14 bit-identical, 2 same outcomes"
std::string counts(const std::vector<Compared>& cells) {
  using statistics::Agreement;
  std::vector<std::string> parts;
  for (const Agreement one :
       {Agreement::identical, Agreement::same_outcomes, Agreement::other_outcomes, Agreement::differs})
    if (const auto n = std::count_if(cells.begin(), cells.end(),
                                     [one](const Compared& c) { return c.agreement.agreement == one; }))
      parts.push_back(fmt::format("{} {}", n, to_string(one)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Those that the record names, of a merged run several, and this one.
struct Processors {
  std::vector<Processor> recorded;
  Processor here;

  bool are_one() const { return recorded.size() == 1 && to_string(recorded.front()) == to_string(here); }
  bool owe(bool own_arithmetic) const {
    return std::all_of(recorded.begin(), recorded.end(),
                       [&](const Processor& one) { return owe_same_bits(one, here, own_arithmetic); });
  }
  // "the record: AMD EPYC, instructions not recorded; here: AMD EPYC with AVX2"
  std::string text() const {
    std::vector<std::string> words;
    for (const Processor& one : recorded) words.push_back(to_string(one));
    return fmt::format("the record: {}; here: {}", fmt::join(words, " and "), to_string(here));
  }
};

using Agreements = std::vector<std::pair<std::string, statistics::CellAgreement>>;
Agreements agreements(const std::vector<Compared>& cells) {
  Agreements all;
  for (const Compared& cell : cells) all.emplace_back(cell.row, cell.agreement);
  return all;
}

std::ptrdiff_t other_bytes(const std::vector<Compared>& cells) {
  return std::count_if(cells.begin(), cells.end(),
                       [](const Compared& c) { return c.agreement.agreement != statistics::Agreement::identical; });
}

std::ptrdiff_t differing(const std::vector<Compared>& cells) {
  return std::count_if(cells.begin(), cells.end(),
                       [](const Compared& c) { return c.agreement.agreement == statistics::Agreement::differs; });
}

// What the words of the cells' lines come to, where not all of them are "bit-identical".
void print_other_bytes(const std::vector<Compared>& cells, const std::string& processors) {
  const std::ptrdiff_t others = other_bytes(cells);
  if (others == 0) return;
  int flips = 0, episodes = 0;
  for (const Compared& cell : cells) {
    flips += cell.agreement.only_recorded + cell.agreement.only_recomputed;
    episodes += cell.agreement.episodes;
  }
  for (const statistics::PooledAgreement& pool : statistics::pooled(agreements(cells)))
    to_stdout("{}: {} episodes succeeded only in the record, {} only here; {} cells are worse here, {} better ({}){}\n",
              pool.row.empty() ? "all rows" : pool.row, pool.only_recorded, pool.only_recomputed, pool.worse,
              pool.better, statistics::p_text(pool.p_holm), pool.differs() ? ": differs" : "");
  to_stdout("NOT bit-identical: {} of {} cells; {} of {} episodes that can be compared ended differently\n", others,
            cells.size(), flips, episodes);
  if (const auto excused = others - differing(cells))
    to_stdout(
        "For {} of them the record names another build, processor or data: its own word, which proves nothing.\n"
        "To get the same bytes, verify with the recorded build on the recorded processor.\n",
        excused);
  to_stdout("{}\n", processors);
  to_stdout("verdict: {}\n", to_string(statistics::verdict_of(agreements(cells))));
}

// A cell's builds, its plugins by their ids: "engine mujoco" for "engine".
Json by_plugin(const Json& build, const Cell& cell) {
  Json named = Json::object();
  for (const auto& [program, hash] : build.items())
    named[program == "engine"   ? "engine " + cell.engine
          : program == "method" ? "method " + cell.method.id
                                : program] = hash;
  return named;
}

void print_cells(const VerifyArguments& a, const Inventory& inventory, std::uint32_t seed, std::size_t of,
                 const std::set<std::string>& why, const std::vector<Compared>& compared_cells,
                 const Processors& processors) {
  if (a.json) {
    Json cells = Json::array();
    for (const Compared& cell : compared_cells)
      cells.push_back({{"cell", cell.key},
                       {"title", cell.title},
                       {"agreement", to_string(cell.agreement.agreement)},
                       {"detail", cell.agreement.detail}});
    Json pools = Json::array();
    for (const statistics::PooledAgreement& pool : statistics::pooled(agreements(compared_cells)))
      pools.push_back({{"row", pool.row},
                       {"cells", pool.cells},
                       {"only_recorded", pool.only_recorded},
                       {"only_recomputed", pool.only_recomputed},
                       {"worse", pool.worse},
                       {"better", pool.better},
                       {"p_holm", pool.p_holm}});
    to_stdout("{}\n", canonical({{"cells", cells},
                                 {"pooled", pools},
                                 {"not_identical", other_bytes(compared_cells)},
                                 {"verdict", compared_cells.empty()
                                                 ? Json()
                                                 : Json(to_string(statistics::verdict_of(agreements(compared_cells))))},
                                 {"edited", inventory.edited},
                                 {"other", why},
                                 {"seed", seed},
                                 {"finished", of},
                                 {"failed", inventory.failed},
                                 {"not_played", inventory.not_played}}));
    return;
  }
  to_stdout("{} of {} finished cells computed again{}\n", compared_cells.size(), of,
            compared_cells.size() < of ? fmt::format(" (--sample {} --seed {})", a.sample, seed) : "");
  if (!why.empty())
    to_stdout("not as recorded:\n  {}\n", fmt::join(why, "\n  "));
  else if (processors.are_one())
    to_stdout("build, processor and data are those of the record\n");
  else
    to_stdout("build and data are those of the record; {}: the same bytes are owed\n", processors.text());
  for (const Compared& cell : compared_cells)
    to_stdout("{:<16} {} {}{}\n", to_string(cell.agreement.agreement), cell.key, cell.title,
              cell.agreement.detail.empty() ? "" : ": " + cell.agreement.detail);
  if (compared_cells.size() > 1) to_stdout("{}\n", counts(compared_cells));
  print_other_bytes(compared_cells, processors.text());
  if (inventory.failed) to_stdout("{} cells failed when they were recorded: nothing to verify\n", inventory.failed);
  if (inventory.not_played) to_stdout("{} cells have not been played\n", inventory.not_played);
  if (!inventory.edited.empty()) to_stdout("{} cells were edited: not verified\n", inventory.edited.size());
}

int verify(const VerifyArguments& a) {
  const RunRecord record = record_to_recompute(a.run, "verify");
  const Inventory inventory = take_stock(a.run, record);
  for (const std::string& line : inventory.edited) to_stderr("edited: {}\n", one_line(line));
  if (inventory.cells.empty() && inventory.edited.empty())
    throw InputError((a.run / "cells").string() + ": no finished cell: nothing to verify");

  const std::uint32_t seed = a.seed ? *a.seed : std::random_device()();
  const std::size_t of = inventory.cells.size();
  const std::vector<Recorded> cells = sampled(inventory.cells, a.all ? of : static_cast<std::size_t>(a.sample), seed);
  std::set<std::string> why;  // of all cells
  Processors processors{record.processors(), this_processor()};
  std::vector<Compared> now;
  if (!cells.empty()) {
    std::vector<Cell> present;
    std::vector<std::set<std::string>> excuses(cells.size());  // of each cell: why the same bytes are not owed
    for (std::size_t i = 0; i < cells.size(); ++i) present.push_back(with_present_data(cells[i], excuses[i]));
    RunPlan plan = plan_again(a.run, record, std::move(present), a.jobs, a.timeout_s);
    plan.command = "lgabench verify";
    const Catalogue catalogue = a.catalogue();
    const std::optional<Recomputed> recomputed = recompute(plan, catalogue);
    if (!recomputed) return interrupted;

    for (std::size_t i = 0; i < cells.size(); ++i) {
      const fs::path& directory = recomputed->cells[i];
      if (!processors.owe(has_own_arithmetic(plan.cells[i], catalogue)))
        excuses[i].insert("processor: " + processors.text());
      add_differences(excuses[i], by_plugin(cells[i].build, cells[i].cell),
                      by_plugin(read_cell_status(directory).build, cells[i].cell), "build: ");
      now.push_back(compared(cells[i], directory, !excuses[i].empty()));
      why.insert(excuses[i].begin(), excuses[i].end());
    }
  }
  print_cells(a, inventory, seed, of, why, now, processors);
  if (now.empty() || !inventory.edited.empty()) return regression;
  const statistics::Reproduction verdict = statistics::verdict_of(agreements(now));
  if (verdict == statistics::Reproduction::identical) return ok;
  return verdict == statistics::Reproduction::differs || a.strict ? regression : not_identical;
}

}  // namespace

void add_verify(CLI::App& app, int& exit) {
  auto a = std::make_shared<VerifyArguments>();
  Verb verb(app, "verify",
            "Compute cells of a finished run again with this build, and say whether the results are the recorded ones");
  verb.option("RUN", a->run, "The run's directory", required);
  add_methods_in_python(verb, *a);
  add_plugin_path(verb, a->plugin_path, any_plugin);
  add_scenario_path(verb);
  verb.option("--json", a->json, "Print JSON instead of lines");
  verb.below("Which cells");
  auto* sample =
      verb.option("--sample N", a->sample, "Number of cells, drawn at random", CLI::Range(1, 1 << 30), with_default);
  verb.option("--seed N", a->seed, "Seed of that draw (default: a new one each time, which is printed)");
  verb.option("--all", a->all, "Every finished cell")->excludes(sample);
  verb.below("How they are computed and judged");
  verb.option("--strict", a->strict, "Demand the same bytes whatever build the record names: exit 1 instead of 5");
  add_pool(verb, a->jobs, a->timeout_s);
  verb->footer(
      "Example: lgabench verify runs/q1 --sample 5\nverify calls each cell bit-identical, same outcomes, other "
      "outcomes, or differs. With the recorded build and data the bytes must be the same on the recorded processor, "
      "and with the shipped methods on every processor with FMA. If the record names others, the verdict "
      "over all cells is \"agrees\" if at most 1 % of the episodes ended differently (of fewer than 1,000, ten but at "
      "most 4 %), "
      "and no row has more cells that are worse, or better, than chance allows.\n"
      "Exit 0: every cell is bit-identical. Exit 1: the verdict is \"differs\", or a cell was edited. Exit 5: the "
      "verdict is \"agrees\": bytes differ, and the record "
      "names another build, processor or data.");
  verb->callback([a, &exit] { exit = verify(*a); });
}

}  // namespace lgabench::cli
