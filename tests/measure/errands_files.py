#!/usr/bin/env python3
"""Writes the scenarios of the suites `errands` and `refusing` from errands.json, where their commands stand together.

A scenario of `told` demonstrates the heard commands of all of its group and tests the two that nobody demonstrated. Two scenarios of
`shown` have words that leave the how out, one for each of the two, on the same scenes. Those of `refusing` have the command of another
scenario of the tabletop; what is fetched has a receiver too, and no suite.

Usage: python3 tests/measure/errands_files.py [errands.json]
"""
import json
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "envs/tabletop/scenarios"
MISREAD = .05  # each of a thing's two names, so that one name of ten or less is wrong


def parts(scenario):
    """The lists of sets that turns of the pair's first command take, each once."""
    found = []
    for turn in next(one for one in scenario["commands"] if not one.get("seen", True))["truth"]["target"]["turns"]:
        if turn["sets"] not in found:
            found.append(turn["sets"])
    return found


def of_class(scenario):
    return {"parts": parts(scenario), **{key: scenario[key] for key in ("near_miss_sets", "undecided", "belong")}}


def head(scenario, key, group):
    return {"id": key, "environment": "tabletop", "task": "errands", "feature_space": scenario["feature_space"], "may_stop": True,
            "answers": {"recorded": "errands/claude"},
            "classes": [of_class(one) for one in [scenario] + [one for one in group if one is not scenario]],
            "train": {"as_method_asks": False}}


def told(scenario, group):
    needed = scenario["tests"][0]["needed"]
    commands = [one for other in group for one in other["commands"] if one.get("seen", True)]
    commands += [one for one in scenario["commands"] if not one.get("seen", True)]
    arms = [{"arm": "told", "unseen": True, "needed": needed}, {"arm": "read", "unseen": True, "needed": needed, "label_noise": MISREAD}]
    if taken := [one for one in needed if 0 not in one]:
        arms.insert(1, {"arm": "appears", "unseen": True, "needed": taken, "appears": True})
    return {**head(scenario, scenario["id"], group), "commands": commands, "tests": arms, "note": scenario["note"]}


def shown(scenario, group):
    pair = [one["truth"]["target"] for one in scenario["commands"] if not one.get("seen", True)]
    for number, target in enumerate(pair, 1):
        yield {**head(scenario, f"{scenario['id']}_shown_{number}", group), "scenes_of": scenario["id"], "pair": pair,
               "commands": [{"utterance": scenario["shown"], "truth": {"target": target}}],
               "tests": [{"arm": "shown", "needed": scenario["tests"][0]["needed"]}],
               "note": "The words leave out how the objects are used; demonstrations hold it."}


def refusing(one):
    of = json.loads((FOLDER / f"{one['of']}.json").read_text())
    return {"id": one["id"], "environment": "tabletop", "task": "refusing", "feature_space": of["feature_space"], "may_stop": True,
            "answers": {"recorded": "claude_track"}, **{key: one[key] for key in ("near_miss_sets", "undecided") if one[key]},
            "train": {"as_method_asks": False}, "commands": of["commands"],
            "tests": [{"arm": "gone", "is_there": False}, {"arm": "control", "is_there": True}],
            "note": f"The command of {one['of']}. Nothing that it means stands there, or one thing in another's place."}


def text(value, depth=1):
    """JSON with a member or an element a line, where a line would be longer than 120."""
    line = json.dumps(value, ensure_ascii=False)
    if depth > 1 and len(line) + depth <= 120 or not isinstance(value, (dict, list)):
        return line
    lines = [f"{json.dumps(key)}: {text(one, depth + 1)}" for key, one in value.items()] if isinstance(value, dict) else [text(one, depth + 1) for one in value]
    begin, end = "{}" if isinstance(value, dict) else "[]"
    return begin + "\n" + ",\n".join(" " * depth + one for one in lines) + "\n" + " " * (depth - 1) + end


def main(file=pathlib.Path(__file__).parent / "errands.json"):
    data = json.loads(pathlib.Path(file).read_text())
    written = [refusing(one) for one in data["refusing"] if one["environment"] == "tabletop"]
    for scenario in data["scenarios"]:
        group = [one for one in data["scenarios"] if one["group"] == scenario["group"]]
        written += [told(scenario, group), *shown(scenario, group)]
    for one in written:
        (FOLDER / f"{one['id']}.json").write_text(text(one) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
