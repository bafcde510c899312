"""tests/measure/rivals.py against the rows that a run has, and its table against the track."""
import json
import os
import pathlib
import sys
import unittest

import lgabench
from data_test import Case
from scenes_test import ENGINE

SOURCE = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(SOURCE / "tests/measure"))
import labels  # noqa: E402
import rivals  # noqa: E402


class Rivals(Case):
    def expect_the_rows(self, suite, *rows):
        """Where a rule has no tie it is right in the very scenes in which the row of its name succeeds."""
        self.call("run", suite, "--preset", "smoke", "--methods", "human+policy=centroid", "--engines", ENGINE, "--demos", 5, "--seeds", 0,
                  "--episodes", 6, "--jobs", 1, "--out", suite)
        outcomes = {row: [] for row in rows}
        for file in sorted((self.dir / suite / "cells").glob("*/cell.json")):
            cell = json.loads(file.read_text())
            row = cell["method"]["id"]
            if row not in rows:
                continue
            own = self.dir / "scenario.json"
            own.write_text(json.dumps(cell["scenario"]))
            env = lgabench.Environment(lgabench.Scenario(path=own), ENGINE, cell["layout"])
            taught = rivals.Demonstrations(env, 0, sum(one.get("seen", True) for one in cell["scenario"]["commands"]))
            for line in (file.parent / "episodes.jsonl").read_text().splitlines():
                episode = json.loads(line)
                test = rivals.record(env, env.reset("test", episode["index"], arm=episode["arm"], seed=cell["scene_seed"]))
                self.assertEqual(env.scene_hash, episode["scene"])
                every = taught.of(None, 5)
                likely, _ = rivals.picks(rivals.TAUGHT[row], test, taught.of(test.utterance, 5), every, every)
                if likely in (0, 1):
                    outcomes[row].append(likely)
                    self.assertEqual(likely == 1, episode["success"], (cell["scenario"]["id"], episode["arm"], episode["index"]))
        for row, seen in outcomes.items():
            self.assertGreater(len(seen), 9, row)
        return set().union(*outcomes.values())

    def test_of_a_demonstrated_command(self):
        self.assertIn(1, self.expect_the_rows("clutter", "most_demonstrated"))

    def test_of_a_command_that_nobody_demonstrated(self):
        self.assertEqual(self.expect_the_rows("many_commands", "most_demonstrated", "least_demonstrated"), {0, 1})

    def test_no_rule_of_labels_is_better_than_the_one_that_was_fixed(self):
        """Played in development scenes: results compare what a command is worth with the best that is known without it."""
        track = json.loads((SOURCE / "results/leaderboard/tracks.json").read_text())
        for preset in track["abstraction"]:
            suite, name = preset.split("-")
            about = json.loads(next((SOURCE / "envs").glob(f"*/suites/{suite}.json")).read_text())["about"]
            if suite != "persons" and not about.get("presets", {}).get(name, "").startswith("Kept for its entries"):
                self.assertEqual(set(track["labels"][preset]), set(map(str, rivals.NUMBERS)), preset)
        for preset, fixed in track["labels"].items():
            if preset in rivals.CURVES:
                self.assertEqual(fixed, track["labels"][rivals.CURVES[preset]], preset)
                continue
            if preset.split("-")[0] in ("words", "drawn", "fetch") and not os.environ.get("LGABENCH_FULL"):
                continue  # minutes of demonstrations
            for n, by_rule in labels.rates(preset).items():
                for rule, rate in by_rule.items():
                    self.assertLessEqual(rate, by_rule[labels.ROWS[fixed[str(n)]]] + labels.MARGIN, (preset, n, rule))

    def test_names_in_a_command(self):
        one = lambda object_type, texture: rivals.Thing(1, object_type, texture, 1, None, None, None)
        self.assertEqual(rivals.named(one("heart", "dark red"), "Bring me the red heart."), 1.5)
        self.assertEqual(rivals.named(one("letter A", "red"), "Bring me a letter."), .5)
        self.assertEqual(rivals.named(one("spoon", "red and green stripe"), "The spoons without stripes."), 1.25)

    def test_the_table_has_every_arm_of_the_track(self):
        measured = json.loads((SOURCE / "results/measured/rivals.json").read_text())
        arms = {f"{name}-{arm}" for name, arms in rivals.arms_of_the_track().items() for arm in arms}
        self.assertEqual(set(measured["suites"]), arms)
        for file in (SOURCE / "envs").glob("*/suites/*.json"):
            suite = json.loads(file.read_text())
            for seed in [suite["scene_seed"], *(one.get("scene_seed") for one in suite["presets"].values())]:
                self.assertNotIn(seed, (measured["scene_seed"], labels.DEVELOPMENT_SEED), file.name)
        for name, table in measured["suites"].items():
            self.assertGreaterEqual(table["scenes"], 200, name)
            self.assertEqual(table["rivals"]["random_object"]["0"]["rate"], table["chance"], name)
            self.assertEqual(list(table["rivals"]), [*rivals.UNTAUGHT, *rivals.TAUGHT], name)
            for by_number in table["rivals"].values():
                self.assertIn(set(by_number), ({"0"}, set(map(str, rivals.NUMBERS))), name)
                self.assertTrue(all(one["low"] <= one["rate"] <= one["high"] for one in by_number.values()), name)


if __name__ == "__main__":
    unittest.main()
