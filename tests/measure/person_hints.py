#!/usr/bin/env python3
"""Hints in persons' commands: which were kept, how much each leaves, and a model's recorded answers to the commands.

Usage: tests/measure/person_hints.py            # kept hints, and of published persons how many rules a hint leaves
       tests/measure/person_hints.py OUT.json   # answers, for `lgabench run persons --preset hints --answers OUT.json`
results/measured/person_hints.json has what was written of each hint, two blind judgements, and the model's answers.
"""
import json
import pathlib
import re
import sys

from person_lists import GRAMMAR, ROOT, SPACE, WORDS, held, prior_of

HINTS = json.loads((ROOT / "results/measured/person_hints.json").read_text())
SCENARIOS = [json.loads(file.read_text()) for file in sorted((ROOT / "envs/tabletop/scenarios").glob("persons_hints_*.json"))]


def parted(utterance):
    """(words, hint) of "Bring person 1 a fruit. I am having soup."."""
    return re.fullmatch(r"Bring person \d+ (.*?)\. (.*)", utterance).groups()


def kept():
    """(hint, words or None for any) -> the parts that it leaves, where all who judged agree."""
    same = lambda rules: sorted("+".join(sorted(rule.split("+"))) for rule in rules)
    return {(one["says"], one.get("words")): same(one["written"]) for one in HINTS["judged"]
            if same(one["written"]) == same(one["a"]) == same(one["b"])}


def published():
    """Likewise, as the grammar's file has them."""
    found = {}
    for one in GRAMMAR["hints"]:
        parts = ["+".join(sorted(part)) for part in one.get("types", [])] + one.get("looks", []) + one.get("places", [])
        found.update({(one["says"], words): sorted(parts) for words in one.get("words", [None])})
    return found


def left(words, hint):
    """(rules before, after, their share of the prior)."""
    prior = prior_of(f"Bring {words}.")
    one, = [each for each in GRAMMAR["hints"] if each["says"] == hint and words in each.get("words", [words])]
    everything = frozenset(SPACE["textures"])
    looks = {}
    for look in GRAMMAR["looks"]:
        textures = held(look["textures"], SPACE["textures"])
        looks.update({look["is"]: textures, "not " + look["is"]: everything - textures})

    def stays(rule):
        pairs, place = rule
        types, textures = ({pair[i] for pair in pairs} for i in (0, 1))
        return (("types" not in one or any(types == set(part) for part in one["types"])) and
                ("looks" not in one or any(textures == looks[part] for part in one["looks"])) and
                ("places" not in one or place in one["places"]))
    after = [p for rule, p in prior.items() if stays(rule)]
    return len(prior), len(after), sum(after)


def answers():
    """A model's answer to each person's command: a product of types and textures and, structured, a place."""
    by_hint = {(one["says"], one.get("words")): one for one in HINTS["answers"]}
    all_of_them = []
    for scenario in SCENARIOS:
        for command in scenario["commands"]:
            words, hint = parted(command["utterance"])
            said = by_hint.get((hint, words)) or by_hint[hint, None]
            types = HINTS["words"][words] if said["object_types"] == "WORDS" else said["object_types"]
            textures = held(said["textures"]["except"], SPACE["textures"]) if isinstance(said["textures"], dict) else \
                held(said["textures"], SPACE["textures"])
            excepted = isinstance(said["textures"], dict)
            one = {"object_types": types, "textures": [name for name in SPACE["textures"] if (name in textures) != excepted]}
            which = said["which"] and dict(said["which"])
            if which and which["rule"] in ("nearest_to", "farthest_from"):
                which["of"] = {"object_types": ["pallet"], "textures": "ALL"}
            all_of_them.append({"command": command["utterance"], "target": one, "structured": {"sets": [one], "which": which}})
    return {"model": f"Claude (Anthropic), blind, {HINTS['date']}", "space": "household", "answers": all_of_them}


def score():
    assert kept() == published(), "persons.json has other hints than those on which all agree"
    persons = [parted(command["utterance"]) for scenario in SCENARIOS for command in scenario["commands"]]
    before, after, share = (sum(column) / len(persons) for column in zip(*(left(*one) for one in persons)))
    kinds = {kind: sum(kind in one for one in GRAMMAR["hints"]) for kind in ("types", "looks", "places")}
    print(f"{len(kept())} of {len(HINTS['judged'])} hints kept, {kinds}")
    print(f"{len(persons)} persons, {len(set(persons))} words with a hint: a hint leaves {after:.0f} of {before:.0f} rules on average, "
          f"{share:.2f} of the prior")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1]).write_text(json.dumps(answers()))
    else:
        score()
