#!/usr/bin/env python3
"""Which row's rule of labels is best, for each preset of the abstraction track and number of demonstrations: `labels` of tracks.json.

It is fixed on development scenes, whose seed no preset publishes, before a run of the preset. A rule reads labels and what was
taken, and never the command: those of the rows taken_features and taken_names, and of the reference row least_demonstrated.
Success is that of the rule alone, without a policy, in the suite's main arm.

Usage, with the built package: PYTHONPATH=build/ci/python tests/measure/labels.py [--presets SUITE-PRESET,...]
It prints the table, and `labels` as tracks.json has them.
"""
import argparse
import json
import pathlib
import tempfile

import rivals

DEVELOPMENT_SEED, SCENES = 31337, 420  # at least so many scenes of an arm
ROWS = {"taken_features": "most_demonstrated", "taken_names": "most_alike_names"}  # by what they take
MARGIN = .02  # of success, by which another rule is better


def main_arm(preset):
    """The suite's, or where the preset lacks it the first that decides."""
    suite = preset.split("-")[0]
    about = json.loads(next(rivals.ROOT.glob(f"envs/*/suites/{suite}.json")).read_text())["about"]
    arms = json.loads((rivals.ROOT / "results/leaderboard/tracks.json").read_text())["abstraction"][preset]
    return about["main_arm"] if about.get("main_arm") in arms else arms[0]


def rates(preset, scenes=SCENES):
    """{demonstrations: {rule: success}} of a preset, "clutter-abstraction"."""
    with tempfile.TemporaryDirectory() as folder:
        scenarios = rivals.scenarios_of(*preset.split("-"), pathlib.Path(folder))
        table = rivals.measure(scenarios, main_arm(preset), scenes, DEVELOPMENT_SEED, {}, plain=("random_object",),
                               learners=(*ROWS.values(), "least_demonstrated"))["rivals"]
    return {n: {rule: by_n[str(n)]["rate"] for rule, by_n in table.items() if str(n) in by_n} for n in rivals.NUMBERS}


def best(by_rule):
    """The row of the best rule; the simpler one where they are alike."""
    counted, named = (by_rule[rule] for rule in ROWS.values())
    return "taken_names" if named > counted else "taken_features"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--presets", help="all of tracks.json's labels if not given")
    given = parser.parse_args()
    fixed = json.loads((rivals.ROOT / "results/leaderboard/tracks.json").read_text()).get("labels", {})
    for preset in given.presets.split(",") if given.presets else fixed:
        found = rates(preset)
        print(preset, json.dumps(found), flush=True)
        print(f'    "{preset}": {json.dumps({str(n): best(by_rule) for n, by_rule in found.items()})},', flush=True)


if __name__ == "__main__":
    main()
