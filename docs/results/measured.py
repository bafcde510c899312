#!/usr/bin/env python3
"""Writes into the pages of docs/results, docs/results.md, docs/performance.md and docs/relatives.md what results/measured says: runs
that are no entries of the board, rules without language, tables.json, numbers read from reports, and speed.txt, the table of
`lgabench-benchmarks --summary`.
A page has a pair of markers <!-- measured:NAME --> and <!-- /measured --> for each table.

Usage: docs/results/measured.py [OUTPUT_DIR]     # without it the pages themselves are written
"""
import csv
import json
import pathlib
import re
import sys

PAGES = pathlib.Path(__file__).parent
sys.path.append(str(PAGES.parent / "pictures"))
from findings import cell

ROOT = PAGES.parents[1]
MEASURED = ROOT / "results/measured"
RUNS = {file.stem: json.loads(file.read_text()) for file in (MEASURED / "runs").glob("*.json")}
RIVALS = json.loads((MEASURED / "rivals.json").read_text())
TABLES = json.loads((MEASURED / "tables.json").read_text())
ABOUT = {file.stem: json.loads(file.read_text())["about"] for file in (ROOT / "envs").glob("*/suites/*.json")}


def table(heads, lines, words=(0,)):
    """A Markdown table whose columns are numbers but those of the indices in words."""
    rule = ["---" if i in words else "---:" for i in range(len(heads))]
    return "\n".join(f"| {' | '.join(line)} |" for line in [heads, rule, *lines]) + "\n"


def commands(*runs):
    return "".join(f"    {RUNS[run]['command']}\n" for run in runs) + "\n"


def number(rate):
    return f"{rate + 1e-9:.2f}"  # 0.125 is 0.13, as the programs print it


def interval(of):
    return f"{of['low']:.2f}, {of['high']:.2f}"


def success(run, method, arm, demonstrations=5):
    """The row's mean over scenarios in the arm."""
    return next(row for row in RUNS[run]["rows"] if (row["method"], row["arm"]) == (method, arm) and row["demonstrations"] in (demonstrations, 0))


ROWS = {"lga": "LGA", "human": "True mask", "lga_s": "LGA-S", "gcbc_seg": "GCBC-SEG", "factorial+input=object_mask_and_words": "mask of any object, and words",
        "factorial+input=object_mask": "mask of any object"}


def instruction():
    """Whether a policy hears the command."""
    lines = []
    for row in (row for row in RUNS["instruction"]["instruction"] if row["method"] in ROWS):
        levels, total = row["levels"], sum(row["control"].values())
        other = levels["another command"]
        share = [number(other["took"].get(what, 0) / total) for what in ("other", "own", "third", "none")]
        lines.append([ROWS[row["method"]], number(row["control"]["own"] / total), *(number(levels[level]["success"]) for level in ("empty", "nonsense")),
                      *share, f"{number(other['use']['difference'])} [{interval(other['use'])}]"])
    return commands("instruction") + table(
        ["", "own command", "no words", "nonsense", "another command: took what that means", "what the scene was made for", "a third", "nothing",
         "use of language"], lines)


# The paper's figure 3a, and the runs of the settings that were tried: layout and network's preset, batches.
SETTINGS = {"paper_drawn": "`paper`: layout `continuous`, `batches=drawn`", "paper_shuffled": "`paper`, `batches=shuffled`",
            "text_drawn": "`paper_text`: layout `cells`, `loss=squared`, `picture=rgb`, `batches=drawn`", "text_shuffled": "`paper_text`, `batches=shuffled`"}
PAPER = json.loads((ROOT / "results/paper/reference_results.json").read_text())["figure_3a_success_vs_demonstrations"]
COMPARED = {"LGA": "lga", "Human": "human", "GCBC-SEG": "gcbc_seg"}


def fidelity():
    """Every point of the paper's figure beside those of each setting."""
    lists = lambda rates: " ".join(number(rate) for rate in rates)
    lines = [["*the paper*", *(f"*{lists(PAPER[name]['mean'])}*" for name in COMPARED), "", "", ""],
             ["*its error bars*", *(f"*{lists(PAPER[name]['err'])}*" for name in COMPARED), "", "", ""]]
    for setting, words in SETTINGS.items():
        points = {name: [success(f"fidelity_{setting}", method, "test", n)["success"] for n in PAPER["demonstrations"]]
                  for name, method in COMPARED.items()}
        apart = [(abs(rate - mean), err) for name in COMPARED for rate, mean, err in zip(points[name], PAPER[name]["mean"], PAPER[name]["err"])]
        near = RUNS[f"fidelity_{setting}"].get("near_paper", sum(distance <= 1.5 * err for distance, err in apart))
        lines.append([words, *(lists(rates) for rates in points.values()), f"{near} of {len(apart)}", f"{sum(d for d, _ in apart) / len(apart):.3f}",
                      f"{sum(d / err for d, err in apart) / len(apart):.1f}"])
    return commands(*(f"fidelity_{setting}" for setting in SETTINGS)) + table(
        ["setting (13 scenarios, 3 seeds)", *(f"{name}, 10 to 50" for name in COMPARED), "points within 1.5 error bars", "mean distance", "in error bars"], lines)


PERSONS = {"person_rule+learns=words": "the words", "person_rule+learns=common_looks": "what taken objects share, one Selection",
           "person_rule+choice=scene+learns=common_looks": "the same, scene by scene", "person_rule": "exact Bayes, one Selection",
           "person_rule+choice=scene": "the same, scene by scene (the ceiling)", "person_rule+asks=random": "Bayes, random questions",
           "person_rule+learns=bayes_hint": "Bayes of the rules that the hint leaves, one Selection",
           "person_rule+choice=scene+learns=bayes_hint": "the same, scene by scene",
           "lga": "a model's answer to words and hint: types and textures", "lga+meaning=structured": "likewise, and a place",
           "plga": "plga, the grammar alone", "plga_active": "plga_active, likewise"}
LISTED = {"plga+unlisted=0.0": "a model's list alone", "plga": "the list, and 0.3 of the prior for the grammar"}


def persons(run="persons"):
    """Success by demonstrations, and what each row loses with as many questions: to the ceiling, and to exact Bayes with one Selection."""
    losses = [("regret", "regret", "person_rule+choice=scene"), ("to Bayes with one Selection", "to_bayes", "person_rule")]
    if not any("to_bayes" in one for one in RUNS[run]["regret"]):  # a run of before regret was to the ceiling
        losses = [("to Bayes with one Selection", "regret", "person_rule")]
    losses = [loss for loss in losses if any(one.get(loss[1]) for one in RUNS[run]["regret"])]
    found, names = {}, {**PERSONS, **(LISTED if run == "persons_lists" else {})}
    for one in RUNS[run]["regret"]:
        row = re.sub(r"\+questions=[^+]*", "", one["method"])
        found.setdefault((one["questions"], row), {})[one["demonstrations"]] = one
    ns = sorted({n for by_n in found.values() for n in by_n})
    lines = []
    for (questions, row), by_n in sorted(found.items(), key=lambda one: (one[0][0], list(names).index(one[0][1]))):
        last = by_n[ns[-1]]
        lost = [f"{last[member]:+.2f} [{interval(last[f'{member}_interval'])}]" if member in last and row != of else "" for _, member, of in losses]
        lines.append([names[row], str(questions), *(f"{number(by_n[n]['success'])} [{interval(by_n[n]['success_interval'])}]" for n in ns),
                      *lost])
    return commands(run) + table(["row", "questions", *(f"{n} demonstration{'' if n == 1 else 's'}" for n in ns), *(f"{word} at {ns[-1]}" for word, *_ in losses)], lines)


ERRANDS = {"human+policy=point": "truth", "human": "truth, heat map learned", "errand+readings=majority": "truth, most frequent reading",
           "errand+readings=first": "truth, first reading", "errand+moment=planned": "truth, planned once", "errand+moment=first": "truth, first moment",
           "errand+how=each": "key word *each*", "errand+how=words": "key words", "lga": "LGA", "lga+meaning=structured": "LGA, asked for turns",
           "errand+sets=part": "labels, told how", "errand+sets=part+shown_by=nearest": "labels of nearest words, told how",
           "errand+sets=bayes": "Bayesian labels, told how",
           "gcbc_seg": "GCBC-SEG",
           "errand+how=shown": "how by Bayes (ceiling)", "errand+how=habit": "most frequent number"}
# Rows of which it can be proved that they get no pair right in told; the page shows two of them.
THEOREMS = "errand+moment=first", "lga"


def both_right(row):
    return f"{number(row['paired']['share'])} [{interval(row['paired'])}]"


def errands():
    """Paired success in each arm, and how episodes of the main one went."""
    rows = {(row["method"], row["arm"]): row for row in RUNS["errands"]["rows"]}
    lines = []
    for row, name in ERRANDS.items():
        told = rows.get((row, "told"))
        if not told:
            continue
        course = told["course"]
        lines.append([f"{name}\\*" if row in THEOREMS else name, *(both_right(rows[row, arm]) for arm in ("told", "appears", "read")),
                      number(course["first_take"]["share"]), str(course["too_early"]), str(course["went_on"])])
    return commands("errands") + table(["both right", *("told", "appears", "read"), "first take", "too early", "went on"], lines)


def errands_shown():
    """Paired success where the words leave the how out, by demonstrations."""
    rows = {(row["method"], row["demonstrations"]): row for row in RUNS["errands_shown"]["rows"]}
    ns = sorted({n for _, n in rows if n})
    lines = [[name, *(both_right(rows.get((row, n), rows.get((row, 0)))) for n in ns)] for row, name in ERRANDS.items() if any(of == row for of, _ in rows)]
    return commands("errands_shown") + table(["row", *(f"{n} demonstration{'' if n == 1 else 's'}" for n in ns)], lines)


REFUSING = {"human+policy=point": "truth", "human": "truth, heat map learned", "lga+policy=point": "LGA", "lga": "LGA, heat map learned",
            "taken_names": "names of what was taken", "taken_features": "what was taken", "gcbc_seg": "GCBC-SEG", "stops_at_once": "done at once",
            "random_object": "random visible object"}


def refusing():
    """Right refusals where nothing is meant, and right takes on the same table with one thing exchanged."""
    rows = {(row["method"], row["arm"]): row for row in RUNS["refusing"]["rows"]}
    both = lambda row: [f"{number(one['success'])} [{interval(one)}]" for one in (rows[row, "gone"], rows[row, "control"])]
    return commands("refusing") + table(["row", *(ABOUT["refusing"]["arm_titles"][arm] for arm in ("gone", "control"))],
                                        [[name, *both(row)] for row, name in REFUSING.items()])


PICTURED = {"human": "the truth", "lga": "LGA", "taken_features": "most demonstrated names", "gcbc_seg": "GCBC-SEG",
            "taken_colours": "colours of what was taken", "oracle": "Oracle", "random_object": "random object in view"}
READ = "human", "lga", "taken_features"  # the others' masks need no names
READERS = {"simulator": "the simulator", "read": "`read`", "read_balanced": "`read_balanced`", "read_drawn": "`read_drawn`", "read_robust": "`read_robust`"}


def at_levels(found, row, axis):
    """Success at levels 2 and 4."""
    return f"{number(found[row, f'{axis}_2'])} {number(found[row, f'{axis}_4'])}"


def axes_of(found, suite):
    """Axes that were played up to level 4; a level's arm is none of the suite's own."""
    return list(dict.fromkeys(arm[:-2] for _, arm in found if arm.endswith("_4") and arm not in ABOUT[suite]["arms"]))


def read_by(method, reader):
    """The row's name in a run's summary."""
    return method if reader == "simulator" else f"{method}+names={reader}"


def pictures():
    """Success by where a mask's names come from, in each arm, and at levels 2 and 4 of each axis."""
    runs = "pictures_truth", "pictures_language", "pictures_looks"
    found = {(row["method"], row["arm"]): row["success"] for run in runs for row in RUNS[run]["rows"]}
    titles, axes = ABOUT["pictures"]["arm_titles"], axes_of(found, "pictures")
    lines = [[words, by if method in READ else "", *(number(found[row, arm]) for arm in titles), *(at_levels(found, row, axis) for axis in axes)]
             for method, words in PICTURED.items() for reader, by in READERS.items() if ((row := read_by(method, reader)), "near_4") in found]
    return commands(*runs) + table(["what is kept", "names from", *titles.values(), *(f"`{axis}` 2, 4" for axis in axes)], lines)


def reading():
    """Of each arm the shares of exact scenes, and of objects whose type and whose texture is read rightly."""
    value = json.loads((MEASURED / "reading.json").read_text())
    found = {(row["arm"], row["names"]): row for row in value["rows"]}
    readers = [reader for reader in READERS if reader != "simulator"]
    arms = sorted(dict.fromkeys(arm for arm, _ in found), key=lambda arm: arm not in ABOUT["pictures"]["arm_titles"])
    shares = lambda row: ", ".join(number(row[part] / row[of]) for part, of in (("exact_scenes", "scenes"), ("types_right", "objects"), ("textures_right", "objects")))
    return f"    {value['command'].removesuffix(' --json')}\n\n" + table(
        ["arm", *(READERS[reader] for reader in readers)],
        [[f"`{arm}`", *(shares(found[arm, reader]) for reader in readers)] for arm in arms])


def perturbations_read():
    """Success of the true mask by where its names come from, in the control and at levels 2 and 4 of each axis."""
    found = {(row["method"], row["arm"]): row["success"] for row in RUNS["perturbations_read"]["rows"]}
    rows = {reader: read_by("human", reader) for reader in ("simulator", "read", "read_robust")}
    return commands("perturbations_read") + table(
        ["axis, levels 2, 4", *(READERS[reader] for reader in rows)],
        [["control", *(number(found[row, "control"]) for row in rows.values())],
         *([f"`{axis}`", *(at_levels(found, row, axis) for row in rows.values())] for axis in axes_of(found, "perturbations"))])


RULES = {"random_object": "random object in view", "largest": "largest in the picture", "first_listed": "first that the simulator lists",
          "exclusion": "least often left", "last_demonstrated": "most like the last taken", "most_alike_names": "most demonstrated in meaning",
          "names": "names in the command", "word_vectors": "nearest by sentence embeddings", "constant_place": "nearest to the usual place",
          "nearest_colour": "nearest mean colour", "nearest_outline": "nearest outline", "nearest_size": "nearest size",
          "another_commands": "most demonstrated of another command", "least_demonstrated": "least demonstrated",
          "most_demonstrated": "most demonstrated", "names_and_demonstrated": "names and most demonstrated", "bayes": "Bayes over types, textures, pairs"}


# In rivals.json alone; and on other pages than that of few_members.
BRIEF = {"first_listed", "another_commands", "names_and_demonstrated"}
BRIEF_ELSEWHERE = BRIEF | {"exclusion", "last_demonstrated"}


def rival_arms(suite):
    """SUITE-PRESET-ARM -> what was found there, of the suite's presets that no later one replaces."""
    return {name: one for name, one in RIVALS["suites"].items()
            if name.split("-")[0] == suite and not ABOUT[suite].get("presets", {}).get(name.split("-")[1], "").startswith("Kept for its entries")}


def rivals(suite):
    """What finds the target without a language model and without training."""
    arms = rival_arms(suite)
    titles = ABOUT[suite].get("arm_titles", {})
    heads = []
    for name in arms:
        _, preset, arm = name.split("-")
        heads.append((titles.get(arm) or arm) + ("" if preset == "abstraction" else f" ({preset.removeprefix('abstraction_')})"))
    lines = [f"| share of test scenes, at 1, 5, 20 demonstrations | {' | '.join(heads)} |", "| --- |" + " --- |" * len(arms)]
    for rule in next(iter(arms.values()))["rivals"]:
        if rule in (BRIEF if suite == "few_members" else BRIEF_ELSEWHERE):
            continue
        rates = [" ".join(number(by_number["rate"]) for by_number in one["rivals"][rule].values()) for one in arms.values()]
        lines.append(f"| {RULES[rule]} | {' | '.join(rates)} |")
    return (f"    {RIVALS['command']}\n\nA rule's success in scenes that no preset publishes (more: `results/measured/rivals.json`):\n\n" +
            "\n".join(lines) + "\n")


def leaks(suite):
    """Which rules without language find the target of the main arm, and how often at best."""
    main = ABOUT[suite]["main_arm"]
    name, arm = [(name, one) for name, one in rival_arms(suite).items() if name.endswith(f"-{main}")][-1]
    best = lambda rule: max(one["rate"] for one in arm["rivals"][rule].values())
    rules = sorted(arm["leaks"], key=best, reverse=True)
    found = ", ".join(f"{RULES[rule]} {number(best(rule))}" for rule in rules)
    return (f"Rules without a language model find the target of the main arm (preset `{name.split('-')[1]}`) more often than chance, "
            f"{number(best('random_object'))}: {found} ([all rules](#without-a-language-model)).\n")


def shown(cell):
    """A rate; a rate, its interval, and a further number; rates in a row; a count; or words."""
    if isinstance(cell, dict):
        return " ".join(number(rate) for rate in cell["each"])
    if isinstance(cell, list):
        rate, low, high, *further = (str(part) if isinstance(part, int) else f"{part:.2f}" for part in cell)
        return f"{rate} [{low}, {high}]{''.join(f' ({part})' for part in further)}"
    return number(cell) if isinstance(cell, float) else str(cell)


def read_off(name):
    """A table of tables.json, with the commands whose reports show its numbers."""
    said = TABLES[name]
    words = [i for i in range(len(said["columns"])) if all(isinstance(row[i], str) for row in said["rows"])]
    return "".join(f"    {line}\n" for line in said.get("commands", [])) + ("\n" if "commands" in said else "") + table(
        said["columns"], [[shown(cell) for cell in row] for row in said["rows"]], words)


# What a policy is told: the row of robosuite's table, and its title on the page of clutter, where it has one.
SIMULATED = {"pixels": ("gcbc_seg", "GCBC-SEG"), "labels, counted": ("taken_features", "What was taken"),
             "labels, by names": ("taken_names", "What was taken, by names"), "command read": ("lga", "LGA"),
             "both": ("lga_then_taken", "LGA, then what was taken"), "true mask": ("human", "True mask"),
             "mask of any object": ("factorial", "")}


def simulators():
    """Success among four near misses after 1 and 5 demonstrations, in robosuite's table and in clutter's curve."""
    lines = []
    for told, (method, title) in SIMULATED.items():
        here = [success("robosuite", method, "near_4", n) for n in (1, 5)]
        tabletop = [list(cell("clutter", "On the board: curve", f"{title}|heat map", n)) for n in ("1", "5")] if title else []
        lines.append([told, *(f"{number(rate['success'])} [{interval(rate)}]" for rate in here),
                      *(map(shown, tabletop) if tabletop else ("–", "–"))])
    return commands("robosuite") + table(["told", "robosuite, 1", "5", "tabletop, 1", "5"], lines)


def of_board(suite, name, demonstrations):
    """A row's success over the suite, as the board's list of all rows has it."""
    with open(ROOT / "results/leaderboard/leaderboard.csv") as file:
        rows = [row for row in csv.DictReader(file) if (row["suite"], row["name"], row["demonstrations"], row["ranking"]) ==
                (suite, name, str(demonstrations), "any policy")]
    return float(rows[0]["success"])


def moves():
    """By how much a choice that a paper may leave out moves a row's success."""
    q1 = "lgabench run q1 --preset leaderboard"
    board = lambda method, how, n: of_board("q1", f"{method} {how}", n)
    ran = lambda run, method, arm, n=5: success(run, method, arm, n)["success"]
    heard = {row["method"]: row for row in RUNS["instruction"]["instruction"]}["lga"]
    own, nonsense = heard["control"]["own"] / sum(heard["control"].values()), heard["levels"]["nonsense"]["success"]
    regression, heat_map = "network=plain policy=regression", "network=text policy=heat_map"
    missed = TABLES["selection_errors"]
    lines = [
        ("policy, LGA", "the paper's network", "heat map", board("LGA", regression, 50), board("LGA", heat_map, 50), q1),
        ("policy, GCBC-SEG", "the paper's network", "heat map", board("GCBC-SEG", regression, 50), board("GCBC-SEG", heat_map, 50), q1),
        ("demonstrations, true mask", "10", "50", board("Human", regression, 10), board("Human", regression, 50), q1),
        ("order of batches, LGA", "drawn", "shuffled", ran("fidelity_paper_drawn", "lga", "test", 50), ran("fidelity_paper_shuffled", "lga", "test", 50),
         RUNS["fidelity_paper_shuffled"]["command"]),
        ("places, batches, picture: LGA", "`paper`", "`paper_text`", ran("fidelity_paper_drawn", "lga", "test", 50),
         ran("fidelity_text_drawn", "lga", "test", 50), RUNS["fidelity_text_drawn"]["command"]),
        ("what stands beside, labels", "one other", "four near misses", ran("clutter_labels", "taken_features", "others_1"),
         ran("clutter_labels", "taken_features", "near_4"), RUNS["clutter_labels"]["command"]),
        ("words, LGA", "the command", "nonsense", own, nonsense, RUNS["instruction"]["command"]),
        ("names, LGA", "the simulator's", "read from the picture", ran("pictures_language", "lga", "near_4"), ran("pictures_language", "lga+names=read", "near_4"),
         RUNS["pictures_language"]["command"]),
        ("answers, true mask", "all that belongs", "a tenth missing", missed["rows"][0][1][0], missed["rows"][1][1][0], missed["commands"][0].rstrip("\\ ") + " …"),
        ("sensor noise, true mask, names read", "none", "level 4", ran("perturbations_read", "human+names=read", "control", 10),
         ran("perturbations_read", "human+names=read", "sensor_noise_4", 10), RUNS["perturbations_read"]["command"].split(" --axes")[0] + " …")]
    lines.sort(key=lambda line: -abs(line[4] - line[3]))
    return table(["what, of which row", "from", "to", "before", "after", "moves", "command"],
                 [[what, before, after, number(a), number(b), f"{b - a:+.2f}", f"`{command}`"] for what, before, after, a, b, command in lines], (0, 1, 2, 6))


def rewritten(page):
    """The page's text with each marked table made anew."""
    tables = {"instruction": instruction, "fidelity": fidelity, "persons": persons,
              **{f"persons_{run}": lambda run=run: persons(f"persons_{run}") for run in ("lists", "hints", "policy")}, "pictures": pictures,
              "reading": reading, "errands": errands, "errands_shown": errands_shown, "refusing": refusing, "speed": lambda: (MEASURED / "speed.txt").read_text(), "perturbations_read": perturbations_read,
              "rivals": lambda: rivals(page.stem),
              "leaks": lambda: leaks(page.stem), "moves": moves, "simulators": simulators}
    made = lambda name: tables[name]() if name in tables else read_off(name)
    return re.sub(r"(<!-- measured:(\w+) -->\n).*?(<!-- /measured -->)", lambda found: f"{found[1]}\n{made(found[2])}\n{found[3]}",
                  page.read_text(), flags=re.S)


def main():
    out = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for page in [PAGES.parent / "results.md", PAGES.parent / "performance.md", PAGES.parent / "relatives.md", *sorted(PAGES.glob("*.md"))]:
        if "<!-- measured:" in page.read_text():
            (out / page.name if out else page).write_text(rewritten(page))


if __name__ == "__main__":
    main()
