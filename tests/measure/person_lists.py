#!/usr/bin/env python3
"""What a model's lists of what somebody may leave unsaid are worth among the published persons: a list for each words, written blind.

Usage: tests/measure/person_lists.py            # of how many persons a list holds the rule, and the log-loss of the rules
       tests/measure/person_lists.py OUT.json   # answers, for `lgabench run persons --answers OUT.json` and `select --suite persons --score`
The lists are results/measured/person_lists.json: the model, the day, and of each "Bring ..." up to 50 hypotheses with weights.
"""
import collections
import fnmatch
import itertools
import json
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LISTS = json.loads((ROOT / "results/measured/person_lists.json").read_text())
GRAMMAR = json.loads((ROOT / "framework/lgabench/drawn/persons/persons.json").read_text())
SPACE = json.loads((ROOT / "envs/tabletop/spaces/household.json").read_text())
WORDS = {one["a"]: one["types"] for one in GRAMMAR["words"]}
SCENARIOS = [json.loads(file.read_text()) for file in sorted((ROOT / "envs/tabletop/scenarios").glob("persons_20261127_*.json"))]
UNLISTED = .3  # of the prior, as plga has it


def said(command):
    return re.sub(r"person \d+ ", "", command["utterance"])


def types_of(words):
    return WORDS[words.removeprefix("Bring ").removesuffix(".")]


def answers():
    """An answer for each person's command."""
    all_of_them = [{"command": command["utterance"], "target": {"object_types": types_of(said(command)), "textures": "ALL"},
                    "hypotheses": LISTS["lists"][said(command)]} for scenario in SCENARIOS for command in scenario["commands"]]
    return {"model": f"{LISTS['model']}, {LISTS['date']}", "space": "household", "answers": all_of_them}


def held(names, of_space):
    if names == "ALL":
        return frozenset(of_space)
    if isinstance(names, dict):
        return frozenset(of_space) - frozenset(names["except"])
    return frozenset(one for name in names for one in of_space if fnmatch.fnmatchcase(one, name))


def rule(meaning):
    """(pairs of type and texture, place), by which two meanings are the same."""
    sets = meaning.get("sets") or [meaning]
    pairs = frozenset(pair for one in sets for pair in itertools.product(held(one["object_types"], SPACE["object_types"]),
                                                                         held(one["textures"], SPACE["textures"])))
    return pairs, meaning["which"]["rule"] if meaning.get("which") else "any"


def prior_of(words):
    """{rule: its prior in the grammar} (docs/protocol.md, persons)."""
    prior, types, everything = GRAMMAR["prior"], types_of(words), frozenset(SPACE["textures"])
    sets = [(types, prior["types"]["all"])] + [([one], prior["types"]["one"] / len(types)) for one in types]
    if len(types) > 3:
        pairs = list(itertools.combinations(types, 2))
        sets += [(pair, prior["types"]["two"] / len(pairs)) for pair in pairs]
    looks = [("any", everything, prior["looks"]["any"])]
    for look in GRAMMAR["looks"]:
        of_look = held(look["textures"], SPACE["textures"])
        looks += [(kind, textures, prior["looks"][kind] / len(GRAMMAR["looks"]))
                  for kind, textures in (("is", of_look), ("is_not", everything - of_look))]
    rules = {(frozenset(itertools.product(some, textures)), place): p * q * r
             for some, p in sets for kind, textures, q in looks for place, r in prior["places"].items()
             if not (len(some) == len(types) and place == "any" and kind != "is")}
    total = sum(rules.values())
    return {one: p / total for one, p in rules.items()}


def score():
    priors = {words: prior_of(words) for words in LISTS["lists"]}
    listed = {words: collections.Counter() for words in LISTS["lists"]}
    for words, hypotheses in LISTS["lists"].items():
        for one in hypotheses:
            listed[words][rule(one["meaning"])] += one["weight"] / sum(other["weight"] for other in hypotheses)
    bits, parts = collections.Counter(), collections.defaultdict(list)
    persons = [(said(command), rule(command["truth"]["target"])) for scenario in SCENARIOS for command in scenario["commands"]]
    for words, truth in persons:
        pairs, place = truth
        kinds, textures = ({pair[i] for pair in pairs} for i in (0, 1))
        joined = (len(kinds) < len(types_of(words))) + (len(textures) < len(SPACE["textures"])) + (place != "any")
        parts[joined].append(truth in listed[words])
        bits["grammar"] -= math.log2(priors[words][truth]) / len(persons)
        bits["list and grammar"] -= math.log2((1 - UNLISTED) * listed[words][truth] + UNLISTED * priors[words][truth]) / len(persons)
    for joined, covered in sorted(parts.items()):
        print(f"rules of {joined} parts: {sum(covered)} of {len(covered)} listed")
    print(", ".join(f"{name}: {value:.2f} bits a person" for name, value in bits.items()))


def main():
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1]).write_text(json.dumps(answers()))
    else:
        score()


if __name__ == "__main__":
    main()
