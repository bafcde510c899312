"""The packages' types, as an author's type checker reads them; lgabench_method.testing, as an author's unit test calls it."""
import importlib
import importlib.util
import inspect
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

import lgabench
import lgabench_method
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
        with self.assertRaisesRegex(ValueError, "unknown second, expected among: first"):
            testing.services(nearest(), second=1)


class Docstrings(unittest.TestCase):
    MODULES = ("lgabench", "lgabench.scenes", "lgabench.gym", "lgabench.data", "lgabench.evaluation", "lgabench.kept", "lgabench.evals",
               "lgabench.registration", "lgabench_method", "lgabench_method.testing", "lgabench_method.repaint",
               "lgabench_method.embeddings")

    def without(self, module):
        """Public names of a module, and of its classes, that say nothing of themselves."""
        for name in getattr(module, "__all__", None) or [one for one in vars(module) if not one.startswith("_")]:
            thing = getattr(module, name)
            if not (inspect.isroutine(thing) or inspect.isclass(thing)):
                continue
            if not hasattr(module, "__all__") and thing.__module__ != module.__name__:
                continue
            if not (inspect.getdoc(thing) or "").strip() or (thing.__doc__ or "").startswith(f"{name}("):  # a dataclass's own
                yield f"{module.__name__}.{name}"
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                is_named = inspect.isroutine(value) or isinstance(value, (property, classmethod, staticmethod))
                if is_named and not member.startswith("_") and not (inspect.getdoc(getattr(thing, member)) or "").strip():
                    yield f"{module.__name__}.{name}.{member}"

    def test_every_public_name_has_one(self):
        self.assertEqual([name for module in self.MODULES for name in self.without(importlib.import_module(module))], [])

    def test_one_without_is_found(self):
        module = types.ModuleType("own")
        exec("class Own:\n    'a class'\n    def act(self): pass\ndef plain(): pass\n", vars(module))
        self.assertEqual(list(self.without(module)), ["own.Own.act", "own.plain"])


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cache = tempfile.mkdtemp(prefix="lgabench-test-")  # what NumPy declares is read once
        cls.addClassCleanup(shutil.rmtree, cls.cache)

    def mypy(self, *words):
        build = pathlib.Path(os.environ["LGABENCH_BUILD"])
        environment = os.environ | {"MYPYPATH": f"{SOURCE / 'python'}:{build / 'python'}"}
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--allow-any-generics",
                               "--follow-imports=silent", "--disable-error-code=import-untyped",
                               "--disable-error-code=import-not-found",  # harnesses, which ./test --full alone has
                               f"--cache-dir={self.cache}", *words], capture_output=True, text=True, timeout=600, env=environment)
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

    def test_a_users_scenes_are_checked(self):
        for package in lgabench, lgabench_method:
            self.assertTrue(pathlib.Path(package.__file__).with_name("py.typed").exists(), "a checker would take it as untyped")
        with tempfile.TemporaryDirectory() as directory:
            own = pathlib.Path(directory, "own.py")
            own.write_text("import lgabench\nfrom lgabench.gym import SceneEnv, dense_reward\n\n"
                           "env: SceneEnv = SceneEnv('heart', reward_mode='dense')\n"
                           "result = lgabench.Environment('heart').step([0.0])\n"
                           "reward: float = dense_reward(result.success, result.distance)\n")
            self.assertIn("Success", self.mypy(own))
            own.write_text(own.read_text().replace("result.distance", "result.failure"))
            self.assertIn('Argument 2 to "dense_reward" has incompatible type "str"', self.mypy(own))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
