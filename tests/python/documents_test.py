"""docs/python.md as its reader walks it: its code, in order, in an empty directory. LGABENCH_FULL: the notebook too."""
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

import numpy

import lgabench
from data_test import Case
from lgabench.data import load_demonstrations
from scenes_test import ENGINE, FULL

SOURCE = pathlib.Path(__file__).parents[2]


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
    def setUp(self):
        super().setUp()
        sys.path.insert(0, str(SOURCE / "examples/python"))
        self.call("demos", "heart", "--engine", ENGINE, "--layout", "cells", "--n", 12, "--out", "heart.hdf5")
        self.file = self.dir / "heart.hdf5"

    @unittest.skipUnless(installed("lerobot"), "not installed: lerobot, or no LGABENCH_FULL")
    def test_lerobot_reads_what_its_writer_wrote(self):
        import to_lerobot
        from lerobot.datasets.lerobot_dataset import LeRobotDataset
        to_lerobot.convert(self.file, self.dir / "written")
        read = LeRobotDataset("lgabench/heart", root=self.dir / "written")
        self.assertEqual(read.num_episodes, 12)
        shown = load_demonstrations(self.file)
        numpy.testing.assert_allclose(read[0]["action"], shown.action_space.from_metres(shown[0].steps[0].label), atol=1e-6)
        self.assertEqual(read[0]["task"], shown[0].instruction.utterance)

    @unittest.skipUnless(installed("lerobot"), "not installed: lerobot, or no LGABENCH_FULL")
    def test_lerobots_rollout_counts_the_oracles_successes(self):
        import to_lerobot
        import torch
        from lerobot.scripts.lerobot_eval import rollout
        scenes = to_lerobot.environments("lgabench/heart-v1", 4, split="test")

        class Acts(torch.nn.Module):
            def __init__(self, act):
                super().__init__()
                self.act = act

            def reset(self):
                pass

            def select_action(self, observation):
                assert observation["observation.image"].shape == (4, 3, 128, 256) and len(observation["task"]) == 4
                return torch.stack([torch.from_numpy(self.act(env.unwrapped)) for env in scenes.envs])

        def success(act):
            as_it_is = [lambda values: values] * 4
            return rollout(scenes, Acts(act), *as_it_is, seeds=[0, 1, 2, 3])["success"].float().mean().item()

        self.assertEqual(success(lambda env: env.expert_action()), 1)
        self.assertEqual(success(lambda env: numpy.zeros(env.action_space.shape, numpy.float32)), 0)

    @unittest.skipUnless(installed("robomimic", "torch"), "not installed: robomimic, or no LGABENCH_FULL")
    def test_robomimic_trains(self):
        import to_robomimic
        result = to_robomimic.main(str(self.file), str(self.dir / "trained"), "masked", epochs=2)
        self.assertEqual(result.episodes, 100)
        (first, last), = [re.findall(r'"Loss": ([0-9.]+)', log.read_text()) for log in self.dir.rglob("log.txt")]
        self.assertLess(float(last), float(first))  # a batch larger than the file would train nothing


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
