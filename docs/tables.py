#!/usr/bin/env python3
"""Writes what docs/suites.md says from the suites' JSON files, between `<!-- suites:... -->` and `<!-- /suites -->`: overviews,
and of each suite its title, rows and arms; docs/protocol.md's table of the paper's claims, from results/paper; docs/leaderboard.md's of
tracks; and code of the examples on the pages for authors, between `<!-- code:FILE, FROM .. TO -->` and `<!-- /code -->`. With the built
program also the protocol's tables of reference rows and perturbation axes and, with --gallery, docs/gallery.md's sheets with their legends.

Usage: docs/tables.py [--program LGABENCH [--gallery]] [OUTPUT_DIR]
"""
import argparse
import json
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
SUITES = {file.stem: json.loads(file.read_text()) for file in sorted(HERE.parent.glob("envs/*/suites/*.json"))}
PAPER = {"network": "text", "loss": "norm", "batches": "drawn"}  # what these options are anyway
GENERAL = "paper_text", "smoke"  # docs/suites.md says what they are in any suite
# Arms whose scenes look as another picture: what differs does not show.
LOOKS_LIKE = {("robustness", "hard"): "q2_heart-hard", ("mobile", "perceived"): "bring_fruit-moved",
              ("mobile", "perceived_hard"): "bring_fruit-moved", ("fetch", "perceived"): "fetch_ripe_fruit-near",
              **{("pictures", arm): f"something_to_drink_water_out_of-{arm}" for arm in ("others_1", "near_4", "near_6")},
              ("pictures", "alike"): "something_to_drink_water_out_of-near_4"}


def listed(values):
    """1, 5 and 20; 0 to 9."""
    words = [str(value) for value in values]
    if len(words) > 2 and isinstance(values[0], int) and values == list(range(values[0], values[-1] + 1)):
        return f"{words[0]} to {words[-1]}"
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]]))


def code(values):
    return ", ".join(f"`{value}`" for value in values)


def options(of):
    """What every row has beside the paper's network, and what one method has."""
    every = [f"{name}={value}" for name, value in of.get("*", {}).items() if PAPER.get(name) != value]
    return code(every + [f"{method}: {name}={value}" for method, its in of.items() if method != "*" for name, value in its.items()])


def picture(suite, arm):
    """The small picture of an arm: of the suite's name or of a scenario's; else of the suite's first arm, where only words or labels differ."""
    for name in [suite["id"], *suite["scenarios"]]:
        if (HERE / f"pictures/suites/{name}-{arm}.png").exists():
            return f"![{suite['id']}, {arm}](pictures/suites/{name}-{arm}.png)"
    if (suite["id"], arm) in LOOKS_LIKE:
        return f"![{suite['id']}, {arm}](pictures/suites/{LOOKS_LIKE[suite['id'], arm]}.png)"
    return picture(suite, next(iter(suite["about"]["arms"])))


def differs(suite, preset):
    """In words, what a preset has otherwise than the suite."""
    parts = [f"{listed(preset['demonstrations'])} demonstrations"] if "demonstrations" in preset else []
    parts += [f"arms {code(preset['arms'])}"] if "arms" in preset else []
    parts += [f"{len(preset['methods'])} rows"] if "methods" in preset else []
    parts += [f"{len(preset['scenarios'])} {'other ' * (not set(preset['scenarios']) <= set(suite['scenarios']))}scenarios"] if "scenarios" in preset else []
    parts += [options(preset["options"]) or "the paper's network"] if "options" in preset else []
    parts += [f"axes {code(axis['axis'] for axis in preset['perturbations'])}"] if "perturbations" in preset else []
    return ", ".join(parts)


def sizes(order):
    """A line for each suite: how large it is, and its presets."""
    lines = ["| suite | rows | training seeds | test scenes an arm | `leaderboard` | further presets |", "| --- | --- | --- | --- | --- | --- |"]
    for suite in (SUITES[name] for name in order):
        board = suite["presets"].get("leaderboard")
        entries = f"{len(board.get('methods', suite['methods']))} rows, {board.get('episodes', suite['episodes'])} scenes" if board else "–"
        more = [f"`{name}`" + (f" ({said})" if said else "")
                for name, said in ((name, name not in GENERAL and differs(suite, preset)) for name, preset in suite["presets"].items())
                if name != "leaderboard"]
        own = ", others for each seed" if suite.get("test_scenes") == "per_seed" else ""
        lines.append(f"| `{suite['id']}` | {len(suite['methods'])} | {listed(suite['seeds'])} | {suite['episodes']}{own} | {entries} | {'; '.join(more)} |")
    return lines


def arms(suite):
    about = suite["about"]
    lines = ["| arm | test scenes | picture |", "| --- | --- | --- |"]
    for arm, scenes in about["arms"].items():
        name, title = f"`{arm}`", about.get("arm_titles", {}).get(arm, arm)
        lines.append(f"| {name if title.replace(',', '').split() == arm.split('_') else f'{name} ({title})'} | {scenes} | {picture(suite, arm)} |")
    return lines


def same_demonstrations(suite):
    trains = [json.loads(next(HERE.parent.glob(f"envs/*/scenarios/{scenario}.json")).read_text()).get("train", {}) for scenario in suite["scenarios"]]
    return not any({**train, **suite.get("train", {})}.get("as_method_asks", True) for train in trains)


def section(suite):
    about, every = suite["about"], options(suite["options"])
    said = [f"Main arm `{about['main_arm']}`." if len(about["arms"]) > 1 else "", f"Rows: {code(suite['methods'])}" + (f"; all with {every}." if every else ".")]
    said.append("All methods learn from the same demonstrations." if same_demonstrations(suite) else
                "A method that selects features learns from targets of its own selection, others from the truth.")
    said.append(f"Reference rows besides the usual ones: {code(suite['references'])}." if "references" in suite else "")
    if "variants" in suite:
        said.append(f"Each scenario is played in {len(suite['variants'])} variants, "
                    f"{listed([f'`{name}`' for name in suite['variants']])}; an arm's name ends in the name of its variant.")
    return [f"## `{suite['id']}`: {about['title']}", " ".join(filter(None, said)), "", *arms(suite)]


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def overview(order):
    lines = ["| suite | question | scenarios | demonstrations | policy |", "| --- | --- | --- | --- | --- |"]
    for suite in (SUITES[name] for name in order):
        policy = {"heat_map": "keeps spatial positions", "point": "none is learned"}.get(suite["options"]["*"].get("policy"), "the paper's network")
        lines.append(f"| [`{suite['id']}`](#{anchor(section(suite)[0][3:])}) | {suite['about']['question']} | {len(suite['scenarios'])} | "
                     f"{listed(suite['demonstrations'])} | {policy} |")
    return lines


def filled(page, kind, contents):
    """The page with the lines of contents(name) between `<!-- kind:name -->` and `<!-- /kind -->`."""
    return re.sub(rf"(<!-- {kind}:(\w+) -->\n).*?(<!-- /{kind} -->)",
                  lambda found: f"{found[1]}\n" + "\n".join(contents(found[2])) + f"\n\n{found[3]}", page, flags=re.S)


def coded(page):
    """The page with the code that its marks name: a file, or its lines from one text to another and the brace that closes them."""
    def block(found):
        name, part, first, last = found[2], *re.fullmatch(r"(?:, (.*?) \.\. (.*))?", found[3]).group(0, 1, 2)
        lines = (HERE.parent / name).read_text().splitlines()
        if part:
            begin = next(i for i, line in enumerate(lines) if first in line)
            end = next(i for i, line in enumerate(lines) if i >= begin and last in line) + 1
            lines = lines[begin:end + (lines[end].strip() == "}")]
        language = "cmake" if name.endswith("CMakeLists.txt") else "cpp"
        return "\n".join([found[1], "", f"```{language}", *lines, "```", "", "<!-- /code -->"])
    return re.sub(r"(<!-- code:([^ ,]+)(.*?) -->)\n.*?<!-- /code -->", block, page, flags=re.S)


def said(lgabench, *arguments):
    return subprocess.run([lgabench, *arguments], check=True, capture_output=True, text=True).stdout


def axes(lgabench):
    lines = ["| axis | level 1 | 2 | 3 | 4 | changes |", "| --- |" + " --- |" * 5]
    for of in json.loads(said(lgabench, "list", "--json"))["perturbations"]:
        axis = json.loads(said(lgabench, "info", of["id"], "--json"))
        levels = [re.sub(r"\bx\b", "×", re.sub(r"(?<!\d)\.(?=\d)", "0.", level)) for level in axis["levels"]] + ["–"] * (4 - len(axis["levels"]))
        changes = axis["changes"] + ([f"sometimes {', '.join(axis['may_change'])}"] if "may_change" in axis else [])
        lines.append(f"| `{axis['id']}` | {' | '.join(levels)} | {', '.join(changes)} |")
    return lines


def references(lgabench):
    return ["| reference row | is |", "| --- | --- |"] + [f"| `{row['id']}` | {row['summary']} |"
                                                       for row in json.loads(said(lgabench, "list", "--json"))["reference rows"]]


def claims():
    of = json.loads((HERE.parent / "results/paper/claims.json").read_text())["claims"]
    return ["| claim | says | suite |", "| --- | --- | --- |"] + [
        f"| {claim['id']} | {claim['statement']} | {code([claim['suite']]) if 'suite' in claim else 'any with both'} |" for claim in of]


def tracks():
    of = json.loads((HERE.parent / "results/leaderboard/tracks.json").read_text())
    lines = ["| track | suite | preset | frozen answers | where it decides |", "| --- | --- | --- | --- | --- |"]
    for track in "abstraction", "open":
        for name in of[track]:
            suite, preset = name.split("-")
            decides = code(of[track][name]) if track == "abstraction" else "–"
            lines.append(f"| {track} | `{suite}` | `{preset}` | {code(filter(None, [of['frozen'].get(name)])) or '–'} | {decides} |")
    return lines


def sheet(lgabench, what, pictures):
    pictures.mkdir(exist_ok=True)
    return said(lgabench, "render", "--gallery", what, "--out", pictures / f"{what}.png").split("\n\n", 1)[1].rstrip("\n").split("\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", nargs="?", type=pathlib.Path, default=HERE)
    parser.add_argument("--program", metavar="LGABENCH")
    parser.add_argument("--gallery", action="store_true")
    given = parser.parse_args()
    page = (HERE / "suites.md").read_text()
    order = [name for name in re.findall(r"<!-- suites:(\w+) -->", page) if name not in ("overview", "sizes")]
    if sorted(order) != sorted(SUITES):
        raise SystemExit(f"docs/suites.md has no place for {sorted(set(SUITES) ^ set(order))}")
    whole = {"overview": overview, "sizes": sizes}
    (given.output / "suites.md").write_text(filled(
        page, "suites", lambda name: whole[name](order) if name in whole else section(SUITES[name])))
    for name in "add-a-method.md", "extending.md":
        (given.output / name).write_text(coded((HERE / name).read_text()))
    page = filled((HERE / "protocol.md").read_text(), "paper", lambda name: {"claims": claims}[name]())
    if given.program:
        page = filled(page, "program", lambda name: {"axes": axes, "references": references}[name](given.program))
    (given.output / "protocol.md").write_text(page)
    (given.output / "leaderboard.md").write_text(filled((HERE / "leaderboard.md").read_text(), "tracks", lambda name: {"presets": tracks}[name]()))
    if given.program and given.gallery:
        page = (HERE / "gallery.md").read_text()
        (given.output / "gallery.md").write_text(filled(page, "gallery", lambda what: sheet(given.program, what, given.output / "pictures")))


if __name__ == "__main__":
    main()
