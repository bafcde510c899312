"""Runs and demonstrations in Python, against what the programs and the scenes say."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import gymnasium
import h5py
import numpy

import lgabench
from lgabench import data
from scenes_test import ENGINE

FOUND = "LGABENCH_PLUGIN_PATH", "LGABENCH_SCENARIO_PATH"
PROGRAM = pathlib.Path(lgabench.__file__).parent / "_install/bin/lgabench"


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-test-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def call(self, *words):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.dir, capture_output=True, text=True, timeout=300,
                              env={"PATH": "/usr/bin:/bin", "HOME": str(self.dir), "LGABENCH_CACHE": str(self.dir / "cache"),
                                   **{name: value for name, value in os.environ.items() if name in FOUND}})
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return done


class Runs(Case):
    def setUp(self):
        super().setUp()
        self.call("run", "q1", "--preset", "smoke", "--scenarios", "heart", "--methods", "lga", "--engines", ENGINE,
                  "--demos", 10, "--seeds", 0, "--episodes", 5, "--out", "run")

    def test_a_run_is_what_episodes_csv_says(self):
        run = data.load_run(self.dir / "run")
        with open(self.dir / "run/episodes.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(run.episodes), len(rows))
        words = {True: "true", False: "false", None: ""}
        ours = sorted(run.episodes.iterrows(), key=lambda pair: (pair[0], pair[1]["arm"], pair[1]["index"]))
        for row, (cell, one) in zip(sorted(rows, key=lambda row: (row["cell"], row["arm"], int(row["index"]))), ours):
            self.assertEqual(row["cell"], cell)
            for name in set(row) - {"cell", "input_seen", "attribution"}:
                said = one[name] if name != "success" else words[bool(one[name])]
                self.assertEqual(row[name], str(said), name)
        self.assertEqual(run.cells.index.name, "cell")
        self.assertEqual(sorted(run.cells["method"]), sorted({row["method"] for row in rows}))
        self.assertIn("loss", run.training)
        self.assertTrue((run.timing["total_s"] > 0).all())
        self.assertEqual(run.failed, {})

    def test_its_actions_in_its_scenes_end_as_they_did(self):
        run = data.load_run(self.dir / "run")
        for _, one in run.episodes.iterrows():
            env = lgabench.Environment(one["scenario"], one["engine"], one["layout"])
            env.reset("test", one["index"], arm=one["arm"])
            self.assertEqual(env.scene_hash, one["scene"])
            self.assertEqual(env.step(one["action"]).failure, one["failure"])

    def test_what_was_changed_is_named(self):
        cell = next(path for path in (self.dir / "run/cells").iterdir())
        episodes = cell / "episodes.jsonl"
        episodes.write_text(episodes.read_text().replace('"index":0', '"index":7'))
        with self.assertRaisesRegex(ValueError, "episodes.jsonl: changed since it was written"):
            data.load_run(self.dir / "run")
        self.assertIn(7, set(data.load_run(self.dir / "run", verify=False).episodes["index"]))
        episodes.rename(cell / "moved")
        episodes.symlink_to("moved")
        with self.assertRaises(OSError):
            data.load_run(self.dir / "run", verify=False)
        (cell / "status.json").unlink()
        with self.assertWarnsRegex(UserWarning, r"run: 1 of \d+ cells have no result \(Run.failed says why\)"):
            self.assertEqual(data.load_run(self.dir / "run").failed, {cell.name: "not played yet"})

    def test_a_run_that_a_stranger_wrote(self):
        record, before = self.dir / "run/run.json", (self.dir / "run/run.json").read_bytes()
        for text in b"[]", b"{}", b"1", b"{", b"\xff", b"[" * 100000 + b"]" * 100000, before.replace(b'"cells": [', b'"cells": [1,'):
            record.write_bytes(text)
            with self.assertRaisesRegex(ValueError, "run: not a run as lgabench writes it: "):
                data.load_run(self.dir / "run")
        record.write_bytes(before)
        status = next((self.dir / "run/cells").iterdir()) / "status.json"
        status.write_text('{"state": "ok", "files": 1}')
        with self.assertRaisesRegex(ValueError, "run: not a run as lgabench writes it: AttributeError"):
            data.load_run(self.dir / "run")

    def test_a_key_that_leads_elsewhere(self):
        record = json.loads((self.dir / "run/run.json").read_text())
        record["cells"].append("../../etc")
        (self.dir / "run/run.json").write_text(json.dumps(record))
        with self.assertRaisesRegex(ValueError, "expected keys of 16 digits"):
            data.load_run(self.dir / "run")

    def test_a_run_of_an_older_version(self):
        old = (pathlib.Path(__file__).parents[1] / "integration/run_0_1.json").read_bytes()
        (self.dir / "run/run.json").write_bytes(old)
        with self.assertRaisesRegex(ValueError, r"run\.json: written by lgabench 0\.1\.0, whose runs this version cannot read"):
            data.load_run(self.dir / "run")


class Demonstrations(Case):
    def setUp(self):
        super().setUp()
        self.call("demos", "heart", "--n", 10, "--noisy", 1, "--seed", 3, "--engine", ENGINE, "--out", "d.hdf5")

    def test_they_are_what_the_scenes_show(self):
        shown = data.load_demonstrations(self.dir / "d.hdf5")
        self.assertEqual((shown.scenario, shown.layout, shown.split, shown.seed), ("heart", "cells", "train", 3))
        env = lgabench.Environment("heart", ENGINE, shown.layout)
        self.assertEqual(shown.action_space.names, env.action_space.names)
        self.assertTrue(numpy.array_equal(shown.action_space.low, env.action_space.low))
        self.assertEqual(len(shown), 10)
        for index, one in enumerate(shown):
            seen = env.reset(shown.split, index, seed=shown.seed)
            first = one.steps[0]
            self.assertEqual(one.instruction.utterance, env.utterance)
            self.assertTrue(numpy.array_equal(first.observation.rgb, seen.rgb))
            self.assertTrue(numpy.array_equal(first.observation.ids, seen.ids))
            self.assertEqual(first.observation.instances, seen.instances)
            self.assertTrue(numpy.allclose(first.label, env.expert_action(), atol=1e-6))
            self.assertEqual(one.instruction.selection, env.scenario.truth(0))
            mask = data.goal_mask(seen, one.instruction.selection)
            self.assertEqual(set(numpy.unique(mask)), {0, 1})

    def test_a_mask_of_nothing_warns(self):
        seen = lgabench.Environment("heart", ENGINE, "cells").reset("test", 0)
        with self.assertWarnsRegex(UserWarning, "goal_mask: the Selection is empty"):
            self.assertFalse(data.goal_mask(seen, data.Selection()).any())

    def test_they_carry_the_selection_that_they_were_drawn_from(self):
        self.call("run", "q1", "--scenarios", "heart", "--methods", "lga", "--demos", 10, "--seeds", 0, "--episodes", 1,
                  "--no-reference", "--set", "lga.epochs=1", "--out", "run")
        cell = next((self.dir / "run/cells").iterdir())
        self.call("demos", "heart", "--n", 2, "--engine", ENGINE, "--selection", cell / "selection.json", "--out", "lga.hdf5")
        selected = json.loads((cell / "selection.json").read_text())["commands"][0]["selection"]["target"]
        for one in data.load_demonstrations(self.dir / "lga.hdf5"):
            self.assertEqual(one.instruction.selection.target.object_types, selected["object_types"])

    def test_robomimics_members(self):
        env = lgabench.Environment("heart", ENGINE, "cells")
        with h5py.File(self.dir / "d.hdf5") as file:
            names = [name.decode().rstrip("\0") for mask in ("train", "valid") for name in file["mask"][mask]]
            self.assertEqual(names, [f"demo_{i}" for i in range(10)])
            self.assertEqual(len(file["mask/valid"]), 1)
            for i in range(10):
                one = file["data"][f"demo_{i}"]
                steps = one.attrs["num_samples"]
                self.assertEqual((one["rewards"][0], list(one["dones"])), (1, [1] * steps))
                env.reset("train", i, seed=3)
                after = env.step(one["actions"][0]).observation
                self.assertTrue(numpy.array_equal(one["next_obs/rgb"][0], after.rgb))
                self.assertTrue(numpy.array_equal(one["next_obs/ids"][0], after.ids))
                self.assertEqual(one["next_obs/rgb"].shape, one["obs/rgb"].shape)
            made = json.loads(file["data"].attrs["env_args"])
        self.assertEqual(made["type"], 2)
        again = gymnasium.make(made["env_name"], **made["env_kwargs"])
        self.assertEqual(again.unwrapped.environment.engine, ENGINE)

    def test_files_without_the_newer_members(self):
        with h5py.File(self.dir / "d.hdf5", "a") as file:
            for name in list(file["data"].attrs):
                if name not in ("total", "env_args"):
                    del file["data"].attrs[name]
            for i in range(10):
                for name in ("next_obs", "rewards", "dones", "selection"):
                    del file[f"data/demo_{i}/{name}"]
        shown = data.load_demonstrations(self.dir / "d.hdf5")
        self.assertEqual((len(shown), shown.scenario, shown.seed, shown.action_space), (10, "", None, None))
        self.assertIn("demo_9", self.call("demos", "--inspect", "d.hdf5").stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
