"""docs/python.md as its reader walks it: its code, in order, in an empty directory. LGABENCH_FULL: the notebook too."""
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, BUILD = pathlib.Path(__file__).parents[2], pathlib.Path(os.environ["LGABENCH_BUILD"])
os.environ.update({"LGABENCH_PLUGIN_PATH": str(BUILD / "tests/plugins/examples"),
                   "LGABENCH_SCENARIO_PATH": str(SOURCE / "examples/reach2d")})

import h5py
import numpy

import lgabench
from data_test import Case
from lgabench.data import load_demonstrations
from scenes_test import ENGINE, FULL


def code_of(page):
    """Indented blocks of Python, as one text each."""
    blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", page, re.M)
    texts = [re.sub("^    ", "", block, flags=re.M).strip() for block in blocks]
    return [text for text in texts if re.match("import|from|vector =|run =", text) and "MyMethod" not in text]


@unittest.skipUnless("mujoco" in lgabench.engines(), "the page plays on MuJoCo")
class Page(Case):
    def python(self, text):
        done = subprocess.run([sys.executable, "-c", text], cwd=self.dir, capture_output=True, text=True, timeout=600,
                              env=dict(os.environ, HOME=str(self.dir), LGABENCH_CACHE=str(self.dir / "cache")))
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return done.stdout

    def test_its_code(self):
        self.call("run", "q1", "--preset", "smoke", "--scenarios", "heart", "--methods", "lga", "--demos", 10, "--seeds", 0,
                  "--episodes", 3, "--no-reference", "--out", "runs/NAME")
        blocks = code_of((SOURCE / "docs/python.md").read_text())
        self.assertEqual(len(blocks), 6)
        scene, neighbour, masks, env, vector, run = blocks
        self.assertIn("True", self.python(scene))
        self.assertRegex(self.python(neighbour), r"Result\(success=0\.[0-9]+, low=")
        imports = "from lgabench.data import load_demonstrations\n"
        self.assertIn("[0, 1]", self.python(imports + masks + "\nprint(sorted({int(one) for mask in masks for one in mask.flat}))"))
        self.assertIn("True none", self.python(env + "\n" + vector))
        self.assertIn("lga", self.python(run))

    @unittest.skipUnless(FULL and importlib.util.find_spec("matplotlib"), "not installed: matplotlib, or no LGABENCH_FULL")
    def test_the_notebook(self):
        cells = json.loads((SOURCE / "examples/python/scenes.ipynb").read_text())["cells"]
        text = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        self.python(f"import matplotlib; matplotlib.use('Agg')\n{text}\nassert .5 < result.success and success['oracle'] == 1")


def installed(*packages):
    """Whether a long test of other houses' packages can run."""
    return FULL and all(map(importlib.util.find_spec, packages))


class Examples(Case):
    """On episodes of one step and of several, the latter with a state and recovery steps."""

    def setUp(self):
        super().setUp()
        sys.path.insert(0, str(SOURCE / "examples/python"))
        self.files = {}
        for scenario, words in ("heart", ("--engine", ENGINE, "--layout", "cells")), ("reach2d_red", ("--noisy", 1)):
            self.files[scenario] = self.dir / (scenario + ".hdf5")
            self.call("demos", scenario, *words, "--n", 12, "--out", self.files[scenario])

    @unittest.skipUnless(installed("lerobot"), "not installed: lerobot, or no LGABENCH_FULL")
    def test_lerobot_reads_what_its_writer_wrote(self):
        import to_lerobot
        from lerobot.datasets.lerobot_dataset import LeRobotDataset
        for scenario, file in self.files.items():
            to_lerobot.convert(file, self.dir / scenario)
            read, shown = LeRobotDataset("lgabench/" + scenario, root=self.dir / scenario), load_demonstrations(file)
            self.assertEqual(read.num_episodes, 12)
            steps = [step for one in shown for step in one.steps]
            self.assertEqual(len(read), len(steps))
            self.assertEqual([bool(one["next.done"]) for one in read], [step is one.steps[-1] for one in shown for step in one.steps])
            for one, step, action in zip(read, steps, shown.actions(steps)):
                numpy.testing.assert_array_equal(one["action"], action)
                numpy.testing.assert_allclose(one["observation.state"], [*step.observation.state] or [0, 0], atol=1e-6)
            numpy.testing.assert_array_equal(numpy.rint(255 * read[len(read) - 1]["observation.images.rgb"].numpy()).transpose(1, 2, 0),
                                             steps[-1].observation.rgb)
            self.assertEqual(read[0]["task"], shown[0].instruction.utterance)

    @unittest.skipUnless(installed("lerobot"), "not installed: lerobot, or no LGABENCH_FULL")
    def test_lerobots_rollout_counts_the_oracles_successes(self):
        import to_lerobot
        import torch
        from lerobot.scripts.lerobot_eval import rollout

        class Acts(torch.nn.Module):
            def __init__(self, scenes, act):
                super().__init__()
                self.scenes, self.act = scenes, act

            def reset(self):
                pass

            def select_action(self, observation):
                assert len(observation["task"]) == 4
                return torch.stack([torch.from_numpy(self.act(env.unwrapped)) for env in self.scenes.envs])

        def success(scenario, act):
            scenes = to_lerobot.environments(f"lgabench/{scenario}-v1", 4, split="test")
            as_it_is = [lambda values: values] * 4
            played = rollout(scenes, Acts(scenes, act), *as_it_is, seeds=[0, 1, 2, 3])
            first = played["done"].int().argmax(1)  # where each episode ends
            return played["success"][torch.arange(4), first].float().mean().item()

        for scenario in self.files:
            self.assertEqual(success(scenario, lambda env: env.expert_action()), 1)
            self.assertEqual(success(scenario, lambda env: numpy.zeros(env.action_space.shape, numpy.float32)), 0)

    @unittest.skipUnless(installed("robomimic", "torch"), "not installed: robomimic, or no LGABENCH_FULL")
    def test_robomimic_trains(self):
        import to_robomimic
        for scenario, file in self.files.items():
            folder = self.dir / (scenario + "_trained")
            result = to_robomimic.main(str(file), str(folder), "masked", epochs=2)
            self.assertEqual(result.episodes, 100)
            (first, last), = [re.findall(r'"Loss": ([0-9.]+)', log.read_text()) for log in folder.rglob("log.txt")]
            self.assertLess(float(last), float(first))  # a batch larger than the file would train nothing

    @unittest.skipUnless(importlib.util.find_spec("minari"), "not installed: minari")
    def test_minari_loads_what_its_writer_wrote(self):
        os.environ["MINARI_DATASETS_PATH"] = str(self.dir)
        import minari
        import to_minari
        for scenario, file in self.files.items():
            to_minari.convert(file, f"lgabench/{scenario}/oracle-v0")
            read, shown = minari.load_dataset(f"lgabench/{scenario}/oracle-v0"), load_demonstrations(file)
            self.assertEqual(read.total_episodes, 12)
            self.assertEqual(read.total_steps, sum(len(one.steps) for one in shown))
            with h5py.File(file) as opened:
                ends = [opened[f"data/demo_{number}/next_obs/rgb"][len(one.steps) - 1] for number, one in enumerate(shown)]
            for episode, one, end in zip(read, shown, ends):
                numpy.testing.assert_array_equal(episode.actions, shown.actions(one.steps))
                numpy.testing.assert_array_equal(episode.observations["rgb"][:-1], [step.observation.rgb for step in one.steps])
                if scenario != "heart":
                    numpy.testing.assert_array_equal(episode.observations["state"][:-1], [step.observation.state for step in one.steps])
                numpy.testing.assert_array_equal(episode.observations["rgb"][-1], end)
                self.assertEqual(episode.terminations.tolist(), [False] * (len(one.steps) - 1) + [True])
                self.assertEqual(episode.rewards[-1], 1)
                self.assertEqual(set(episode.observations["instruction"]), {one.instruction.utterance})
            env = read.recover_environment()
            self.assertEqual(env.unwrapped.scenario.id, scenario)
            self.assertTrue(env.action_space.contains(read[0].actions[0]))

    @unittest.skipUnless(importlib.util.find_spec("vla_eval"), "not installed: vla_eval")
    def test_vla_evals_server_has_the_oracles_successes(self):
        import vla_eval.api
        from lgabench.gym import SceneEnv
        from vla_eval.model_servers.predict import PredictModelServer

        shown = {}  # by what is seen: the command and what the oracle does then
        for scenario in self.files:
            env = SceneEnv(scenario, split="test")
            for scene in range(3):
                seen, ended = env.reset(seed=scene)[0], False
                while not ended:
                    action = shown[seen["rgb"].tobytes()] = seen["instruction"], env.expert_action()
                    seen, _, terminated, truncated, _ = env.step(action[1])
                    ended = terminated or truncated

        class Server(PredictModelServer):
            def __init__(self, scale):
                super().__init__()
                self.scale = scale

            def predict(self, obs, ctx):
                words, action = shown[obs["images"]["top"].tobytes()]
                assert words == obs["task_description"], obs["task_description"]
                return {"actions": self.scale * action}

        for scale in 1, 0:
            config = {"benchmarks": [{"benchmark": "to_vla_eval:Scenarios", "episodes_per_task": 3,
                                      "params": {"scenarios": list(self.files)}, "max_steps": None if scale else 1}]}  # what is seen after it is not in `shown`
            result, = vla_eval.api.evaluate(Server(scale), config, output_dir=self.dir / "out", no_save=True)
            self.assertEqual(result["num_errors"], 0)
            self.assertEqual({one["task"]: one["mean_success"] for one in result["tasks"]}, {one: scale for one in self.files})


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
