#!/usr/bin/env python3
"""Writes a file of answers for the published persons from a model's lists of what somebody may leave unsaid, a list for each words.

Usage: tests/measure/person_lists.py OUT.json
The lists are results/measured/person_lists.json: the model, the day, and of each "Bring ..." up to 50 hypotheses with weights. OUT.json is for
`lgabench run persons --preset abstraction --answers OUT.json --methods person_rule,plga,plga+unlisted=0 --no-reference` and for
`lgabench select --suite persons --score --answers OUT.json`, which says of how many persons the list holds the rule.
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LISTS = ROOT / "results/measured/person_lists.json"
PERSONS = sorted((ROOT / "envs/tabletop/scenarios").glob("persons_20261127_*.json"))


def answers_of(lists, scenarios, words):
    """An answer for each person's command. `words`: {"a fruit": its types}."""
    answers = []
    for scenario in scenarios:
        for command in scenario["commands"]:
            said = re.sub(r"person \d+ ", "", command["utterance"])
            target = {"object_types": words[said.removeprefix("Bring ").removesuffix(".")], "textures": "ALL"}
            answers.append({"command": command["utterance"], "target": target, "hypotheses": lists["lists"][said]})
    return {"model": f"{lists['model']}, {lists['date']}", "space": "household", "answers": answers}


def main():
    grammar = json.loads((ROOT / "framework/lgabench/drawn/persons/persons.json").read_text())
    words = {one["a"]: one["types"] for one in grammar["words"]}
    scenarios = [json.loads(file.read_text()) for file in PERSONS]
    pathlib.Path(sys.argv[1]).write_text(json.dumps(answers_of(json.loads(LISTS.read_text()), scenarios, words)))


if __name__ == "__main__":
    main()
