"""The packages' types, as an author's type checker reads them; lgabench_method.testing, as an author's unit test calls it."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import lgabench
from lgabench_method import Selection, testing

SOURCE = pathlib.Path(__file__).parents[2]
METHOD = '''
from typing import Any

from lgabench_method import (Command, Demonstration, FeatureSpace, Instruction, Method, Numbers, Observation, Selection, Services,
                             goal_mask, select_features)


class Nearest:
    version = "0.1"
    summary = "the demonstration whose goal mask overlaps most"
    options: dict[str, dict[str, Any]] = {"first": {"default": 0, "help": "demonstrations left out", "source": "chosen"}}

    def select(self, command: Command, space: FeatureSpace, services: Services) -> Selection:
        return select_features(command, space, services.lm)

    def learn(self, demonstrations: list[Demonstration], services: Services) -> "Nearest":
        self.steps = [(one.steps[0], one.instruction.selection) for one in demonstrations[services.options["first"]:]]
        services.log.epoch(1, 1, 0.5)
        return self

    def act(self, observation: Observation, instruction: Instruction) -> Numbers:
        mask = goal_mask(observation, instruction.selection)
        overlaps = [int((mask & goal_mask(step.observation, selection)).sum()) for step, selection in self.steps]
        return self.steps[overlaps.index(max(overlaps))][0].label


method: Method = Nearest()
'''


def nearest():
    names = {}
    exec(METHOD, names)
    return names["Nearest"]


@unittest.skipUnless("mujoco" in lgabench.engines(), "scenes are of MuJoCo")
class Testing(unittest.TestCase):
    def test_a_method_is_tried_out_without_a_run(self):
        result = testing.try_out(nearest(), "heart", 10, 20)
        self.assertEqual(result.episodes, 20)
        self.assertGreater(result.success, .3)  # a constant has .1
        self.assertLess(testing.try_out(nearest(), "heart", 10, 20, first=9).success, result.success)

    def test_what_it_revises_is_what_it_learns_and_acts_on(self):
        class Revises(nearest()):
            def select(self, command, space, services):
                return Selection()

            def revise(self, command, selected, demonstrations, services):
                assert services.shows_truth and len(demonstrations) == 10 and not selected.target.object_types
                return super().select(command, self.space, services)

        Revises.space = lgabench.Scenario("heart").space
        self.assertEqual(testing.try_out(Revises, "heart", 10, 20), testing.try_out(nearest(), "heart", 10, 20))

    def test_what_it_is_lent_is_what_a_cell_lends(self):
        services = testing.services(nearest(), "heart", seed=3, first=1)
        self.assertEqual((services.options, services.seed), ({"first": 1}, 3))
        self.assertEqual(services.layout["observation"], {"rows": 128, "columns": 256, "channels": 3})
        one, = testing.demonstrations("heart", 1)
        self.assertEqual(len(one.steps[0].label), len(services.layout["action"]["numbers"]))
        self.assertEqual(one.instruction.selection.target.object_types, ["heart"])
        command = lgabench.Scenario("heart").command(0)
        chosen = nearest()().select(command, lgabench.Scenario("heart").space, services)
        self.assertEqual(chosen.target, one.instruction.selection.target)
        self.assertGreater(services.lm.asked, 50)
        with self.assertRaisesRegex(ValueError, "no second among first"):
            testing.services(nearest(), second=1)


class Types(unittest.TestCase):
    def mypy(self, *words):
        build = pathlib.Path(os.environ["LGABENCH_BUILD"])
        environment = os.environ | {"MYPYPATH": f"{SOURCE / 'python'}:{build / 'python'}"}
        with tempfile.TemporaryDirectory() as cache:
            done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--allow-any-generics",
                                   "--follow-imports=silent", "--disable-error-code=import-untyped",
                                   "--disable-error-code=import-not-found",  # harnesses, which ./test --full alone has
                                   f"--cache-dir={cache}", *words], capture_output=True, text=True, timeout=600, env=environment)
        return done.stdout

    def test_a_strict_checker_takes_the_packages_and_a_method(self):
        folder = SOURCE / "python/package/lgabench"
        with tempfile.TemporaryDirectory() as directory:
            own = pathlib.Path(directory, "own.py")
            own.write_text(METHOD)
            said = self.mypy(own, *(SOURCE / "python/lgabench_method" / name for name in ("__init__.py", "testing.py")),
                             *sorted(set(folder.glob("*.py")) - ({folder / "inspect_tasks.py"} if not importlib.util.find_spec("inspect_ai") else set())))
            self.assertIn("Success", said)
            own.write_text(METHOD.replace("-> Numbers:", "-> None:").replace("].label", "].name"))
            said = self.mypy(own)
            self.assertIn('"Step" has no attribute "name"', said)
            self.assertIn('expression has type "Nearest", variable has type "Method"', said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
