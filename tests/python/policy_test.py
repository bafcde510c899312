"""Policies that runs keep, against the episodes of their cells."""
import hashlib
import json
import os
import pickle
import shutil
import unittest

import numpy

import lgabench
from data_test import Case
from scenes_test import ENGINE

PYTHON = shutil.which("python3", path="/usr/bin:/bin")  # as the runs here find it
METHOD = '''
import numpy
from lgabench_method import goal_mask, select_features

class Mine:
    version = "1"
    summary = "moves with the picture"
    options = {"saved": {"default": True, "help": "pickle takes its policy", "source": "chosen"}}

    def select(self, command, space, services):
        return select_features(command, space, services.lm)

    def learn(self, demonstrations, services):
        return Policy(demonstrations[0].steps[0].label, services.options["saved"])

class Policy:
    def __init__(self, label, saved):
        self.label, self.sees = label, None if saved else (lambda: 0)

    def act(self, observation, instruction):
        seen = observation.rgb.mean() / 1e5 + goal_mask(observation, instruction.selection).mean()
        return self.label + seen * numpy.eye(12)[0]
'''


class Malicious:
    """Pickled, it writes a file where it is opened."""

    def __init__(self, file):
        self.file = file

    def __reduce__(self):
        return open, (str(self.file), "w")


def stored(action, space):
    """As episodes.jsonl has it."""
    action = numpy.asarray(action, numpy.float32)
    for rotation in map(list, space.rotations):
        if len(rotation) == 4 and action[rotation[3]] < 0:
            action[rotation] *= -1
    return action.astype(float).tolist()


def episodes_of(cell):
    return [json.loads(line) for line in (cell / "episodes.jsonl").read_text().splitlines()]


class Policies(Case):
    def setUp(self):
        super().setUp()
        (self.dir / "mine.py").write_text(METHOD)

    def play(self, *more, out="run"):
        self.call("run", "q1", "--scenarios", "heart", "--engines", ENGINE, "--demos", 10, "--seeds", 0, "--episodes", 5,
                  "--no-reference", "--out", out, *more)
        cells = {json.loads((path / "cell.json").read_text())["method"]["name"]: path
                 for path in (self.dir / out / "cells").iterdir() if not path.name.startswith(".")}
        return cells

    def expect_recorded_actions(self, cell, method=""):
        with lgabench.load_policy(cell, method, python=PYTHON) as policy:
            env = lgabench.Environment(policy.scenario, ENGINE, json.loads((cell / "cell.json").read_text())["layout"])
            played = episodes_of(cell)
            for one in played:
                seen = env.reset("test", one["index"], arm=one["arm"])
                self.assertEqual(env.scene_hash, one["scene"])
                self.assertEqual(stored(policy.act(seen, env.utterance), env.action_space), one["action"])
            self.assertGreater(len({str(one["action"]) for one in played}), 1, "an action for all tells nothing")

    def test_it_acts_as_in_its_cell(self):
        rows = ["lga+epochs=8", "lga+network=released+epochs=8", "lga+network=plain+epochs=8", "lga+network=spot+epochs=8",
                "lga+policy=heat_map", "lga+policy=centroid", "lga_l+epochs=8", "lga_s+policy=heat_map",
                "selected_by:lga", "mine.py:Mine"]
        cells = self.play("--methods", ",".join(rows), "--keep-policy")
        self.assertEqual(len(cells), len(rows))
        for name, cell in cells.items():
            with self.subTest(name):
                self.expect_recorded_actions(cell, str(self.dir / "mine.py") + ":Mine" if name == "mine" else "")

    def test_a_cell_is_the_same_without(self):
        kept = self.play("--methods", "lga+epochs=8", "--keep-policy")
        bare = self.play("--methods", "lga+epochs=8", out="bare")
        for name, cell in kept.items():
            self.assertEqual(cell.name, bare[name].name)
            self.assertEqual({path.name for path in cell.iterdir()} - {path.name for path in bare[name].iterdir()},
                             {"policy.bin"})
            status = [json.loads((path / "status.json").read_text()) for path in (cell, bare[name])]
            for one in status:
                del one["files"]["timing.json"]
            self.assertEqual(*status)
            with self.assertRaisesRegex(RuntimeError, "policy.bin: not there; `lgabench run --keep-policy`"):
                lgabench.load_policy(bare[name])
        self.call("merge", "merged", "run")
        self.assertTrue((self.dir / "merged/cells" / cell.name / "policy.bin").exists())

    def test_what_cannot_be_saved_is_said_in_the_log(self):
        cells = self.play("--methods", "mine.py:Mine+saved=false", "--keep-policy")
        for cell in cells.values():
            self.assertFalse((cell / "policy.bin").exists())
            self.assertIn("policy.bin is not kept: the method cannot save it", (cell / "log.txt").read_text())
            self.assertIn("the policy cannot be pickled: ", (cell / "log.txt").read_text())

    def test_a_damaged_file_is_named(self):
        cell, = self.play("--methods", "lga+epochs=1", "--keep-policy").values()
        file = cell / "policy.bin"
        whole = file.read_bytes()
        for damaged in (whole[:-1], whole[:500], b"", b"{}\n", whole[:-1] + bytes([whole[-1] ^ 1])):
            file.write_bytes(damaged)
            with self.assertRaisesRegex(RuntimeError, r"^\S*policy\.bin: [^\n]*$"):
                lgabench.load_policy(cell)
        head, body = whole.split(b"\n", 1)
        for forged in (body[:-4], body + b"1234", b"", bytes(len(body))):
            head = json.dumps({**json.loads(head), "sha256": hashlib.sha256(forged).hexdigest()}).encode()
            file.write_bytes(head + b"\n" + forged)
            with self.assertRaisesRegex(RuntimeError, r"^\S*policy\.bin: plugin lga: [^\n]*$"):
                lgabench.load_policy(cell)
        file.unlink()
        file.symlink_to("/etc/passwd")
        with self.assertRaisesRegex(RuntimeError, "policy.bin"):
            lgabench.load_policy(cell)

    def test_a_pickle_runs_in_the_confined_process_alone(self):
        cell, = self.play("--methods", "mine.py:Mine", "--keep-policy").values()
        body = pickle.dumps(Malicious(self.dir / "written"))
        head = {**json.loads((cell / "policy.bin").read_bytes().split(b"\n", 1)[0]), "sha256": hashlib.sha256(body).hexdigest()}
        (cell / "policy.bin").write_bytes(json.dumps(head).encode() + b"\n" + body)
        with self.assertRaisesRegex(RuntimeError, "policy.bin: plugin mine: PermissionError"):
            lgabench.load_policy(cell, str(self.dir / "mine.py") + ":Mine", python=PYTHON)
        self.assertFalse(os.path.exists(self.dir / "written"))


if __name__ == "__main__":
    unittest.main()
