// lgabench commands: as many commands as asked for, drawn from a grammar and a lexicon, as scenarios and a suite.
#include <fmt/format.h>

#include <memory>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/drawn/draw.hpp>

namespace lgabench::cli {
namespace {

struct DrawArguments {
  drawn::DrawRequest request;
  fs::path out, lexicon;
};

void draw(const DrawArguments& a) {
  const std::string suite = fmt::format("drawn_{}", a.request.seed);
  if (std::error_code error; fs::exists(a.out, error) && !fs::is_empty(a.out, error))
    throw InputError(fmt::format("--out {}: expected a new or an empty directory", a.out.string()));
  const drawn::Lexicon lexicon = drawn::load_lexicon(a.lexicon);
  const auto commands = drawn::draw_commands(lexicon, a.request, [&lexicon](const drawn::DrawnCommand& command) {
    return drawn::can_be_shown(drawn::scenario_of(command, lexicon.space));
  });
  for (const drawn::DrawnCommand& command : commands)
    write_file(a.out / (command.id + ".json"), drawn::readable(drawn::scenario_of(command, lexicon.space)));
  const fs::path file = a.out / (suite + ".json");
  write_file(file, drawn::readable(drawn::suite_of(suite, a.request, commands)));
  to_stdout(
      "{}\n\nWithout a policy:  lgabench select --suite {} --score --answers none\nWith one:          lgabench run {} "
      "--answers none\n",
      file.string(), file.string(), file.string());
}

}  // namespace

void add_drawn_commands(CLI::App& app, int& exit) {
  auto a = std::make_shared<DrawArguments>();
  Verb verb(app, "commands", "Draw new commands with their meanings and scenes, as a suite");
  verb.option("--seed SEED", a->request.seed, "What the draw depends on: the same seed, the same commands", required);
  verb.option("--n N", a->request.commands, "How many commands, of eight families in turn", CLI::Range(1, 100000),
              with_default);
  verb.option("--parts P", a->request.parts, "Of how many descriptions a compound command is made: how hard it is",
              CLI::Range(drawn::fewest_parts, drawn::most_parts), with_default);
  verb.option("--lexicon FILE", a->lexicon,
              "A file of words and what they hold; by default the shipped lexicon of household");
  verb.option("--out DIR", a->out, "The directory for the scenarios and their suite, drawn_SEED.json", required);
  verb->footer(
      "docs/own-scenarios.md says what is drawn, docs/formats/lexicon.schema.json how a lexicon is written.\n"
      "Example: lgabench commands --seed 7 --n 100 --out drawn");
  verb->callback([a, &exit] {
    draw(*a);
    exit = ok;
  });
}

}  // namespace lgabench::cli
