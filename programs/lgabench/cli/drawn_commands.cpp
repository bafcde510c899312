// lgabench draw-commands: as many commands as asked for, drawn from a grammar and a lexicon, as scenarios and a suite.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include <lgabench/cli/own_names.hpp>
#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/drawn/draw.hpp>
#include <lgabench/harness/counted_progress.hpp>

namespace lgabench::cli {
namespace {

struct DrawArguments {
  drawn::DrawRequest request;
  fs::path out, lexicon;
  int persons = 0;
  bool hints = false;
};

// What to do with the suite that was written. A shipped seed makes shipped scenarios again, which two files cannot be.
void print_next(const fs::path& suite, const std::string& first_scenario, bool of_words) {
  to_stdout("{}\n\n", suite.string());
  const std::string file = path_word(suite);
  if (!scenario_file(first_scenario).empty())
    to_stdout("lgabench has these scenarios already, such as {}: another --seed draws some that can be played\n",
              first_scenario);
  else if (of_words)
    to_stdout(
        "Without a policy:  lgabench select --suite {} --score --answers none\nWith one:          lgabench run {} "
        "--answers none\n",
        file, file);
  else
    to_stdout("lgabench run {} --answers none\n", file);
}

// In scenarios of so many.
void draw_persons(const DrawArguments& a) {
  constexpr int in_scenario = 25;
  const FeatureSpace space = load_feature_space(drawn::person_grammar_json().at("space"));
  const drawn::PersonGrammar& grammar = drawn::person_grammar(space);
  const std::string suite = fmt::format("persons_{}{}", a.hints ? "hints_" : "", a.request.seed);
  std::vector<std::string> ids;
  for (int first = 0; first < a.persons; first += in_scenario) {
    ids.push_back(fmt::format("{}_{:02}", suite, ids.size() + 1));
    const auto persons =
        drawn::draw_persons(grammar, a.request.seed, first, std::min(in_scenario, a.persons - first), a.hints);
    write_file(a.out / (ids.back() + ".json"), drawn::readable(drawn::scenario_of(ids.back(), persons, space)));
  }
  const fs::path file = a.out / (suite + ".json");
  write_file(file, drawn::readable(drawn::suite_of_persons(suite, ids, a.hints)));
  print_next(file, ids.front(), false);
}

void draw(const DrawArguments& a) {
  const std::string suite = fmt::format("drawn_{}", a.request.seed);
  if (std::error_code error; fs::exists(a.out, error) && !fs::is_empty(a.out, error))
    throw InputError(fmt::format("--out {}: expected a new or an empty directory", a.out.string()));
  expect_scenario_path(a.out);
  if (a.persons > 0) return draw_persons(a);
  const drawn::Lexicon lexicon = drawn::load_lexicon(a.lexicon);
  CountedProgress progress("commands drawn:", a.request.commands);
  const auto commands = drawn::draw_commands(lexicon, a.request, [&](const drawn::DrawnCommand& command) {
    const bool shown = drawn::can_be_shown(drawn::scenario_of(command, lexicon.space));
    if (shown) progress.tell_next();
    return shown;
  });
  progress.end();
  for (const drawn::DrawnCommand& command : commands)
    write_file(a.out / (command.id + ".json"), drawn::readable(drawn::scenario_of(command, lexicon.space)));
  const fs::path file = a.out / (suite + ".json");
  write_file(file, drawn::readable(drawn::suite_of(suite, a.request, commands)));
  print_next(file, commands.front().id, true);
}

}  // namespace

void add_drawn_commands(CLI::App& app, int& exit) {
  auto a = std::make_shared<DrawArguments>();
  Verb verb(app, "draw-commands", "Draw new commands with their meanings and scenes, as a suite");
  verb.option("--seed SEED", a->request.seed, "Seed of the draw; the same seed gives the same commands", required,
              a_seed());
  verb.option("--n N", a->request.commands, "Number of commands, from eight families in turn", CLI::Range(1, 100000),
              with_default);
  verb.option("--parts P", a->request.parts, "Number of descriptions in a compound command; more are harder",
              CLI::Range(drawn::fewest_parts, drawn::most_parts), with_default);
  verb.option("--lexicon FILE", a->lexicon,
              "A file of words and their meanings (default: the shipped lexicon of household)");
  verb.option("--persons N", a->persons, "Draw N persons with rules that they do not say, instead of commands",
              CLI::Range(1, 100000))
      ->excludes("--n")
      ->excludes("--parts")
      ->excludes("--lexicon");
  verb.option("--hints", a->hints, "Persons say a hint after their words")->needs("--persons");
  verb.option("--out DIR", a->out, "The directory for the scenarios and their suite, drawn_SEED.json", required);
  verb->footer(
      "docs/own-scenarios.md says what is drawn, docs/formats/lexicon.schema.json how a lexicon is written.\n"
      "Example: lgabench draw-commands --seed 7 --n 100 --out drawn");
  verb->callback([a, &exit] {
    draw(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli
