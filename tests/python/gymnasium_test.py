"""Scenes as Gymnasium environments. LGABENCH_WRITE_VERSIONS=1 writes versions.json anew: what changed gets a new version."""
import copy
import hashlib
import itertools
import json
import os
import pathlib
import pickle
import unittest
import warnings

import gymnasium
import numpy
from gymnasium.utils.env_checker import check_env

import lgabench
from lgabench import registration
from scenes_test import ENGINE, EXAMPLES, FULL

VERSIONS = pathlib.Path(__file__).parents[2] / "python/package/lgabench/versions.json"


def make(scenario, **arguments):
    return gymnasium.make(registration.names()[scenario], **{"engine": ENGINE, **arguments})


def make_vec(scenario, n, **arguments):
    return gymnasium.make_vec(registration.names()[scenario], n, **{"engine": ENGINE, **arguments})


class Gymnasium(unittest.TestCase):
    def same(self, a, b):
        self.assertEqual(type(a), type(b))
        if isinstance(a, dict):
            self.assertEqual(set(a), set(b))
            for key in a:
                self.same(a[key], b[key])
        elif isinstance(a, tuple) or isinstance(a, numpy.ndarray) and a.dtype == object:
            self.assertEqual(len(a), len(b))
            for one, other in zip(a, b):
                self.same(one, other)
        elif isinstance(a, numpy.ndarray):
            self.assertEqual(a.dtype, b.dtype)
            self.assertTrue(numpy.array_equal(a, b))
        else:
            self.assertEqual(a, b)

    def test_the_checker_has_nothing_to_say(self):
        for engine in lgabench.engines():
            for scenario in lgabench.scenarios() if FULL else EXAMPLES:
                with self.subTest(scenario, engine=engine), warnings.catch_warnings():
                    warnings.simplefilter("error")
                    check_env(make(scenario, engine=engine, render_mode="rgb_array").unwrapped)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(make("heart", split="test").unwrapped)

    def test_seeds_of_test_scenes_are_those_of_a_run(self):
        env, scenes = make("heart", split="test"), lgabench.Environment("heart", ENGINE)
        for index in (0, 1, 2, 41):
            obs, info = env.reset(seed=index)
            seen = scenes.reset("test", index)
            self.assertEqual(info["scene"], scenes.scene_hash)
            self.assertTrue(numpy.array_equal(obs["rgb"], seen.rgb))
        scenes.reset("test", 42)
        self.assertEqual(env.reset()[1]["scene"], scenes.scene_hash, "the next one")
        scenes.reset("train", 5, seed=3)
        self.assertEqual(env.reset(options={"split": "train", "index": 5, "scene_seed": 3})[1]["scene"], scenes.scene_hash)
        with self.assertRaisesRegex(ValueError, "expected split, arm, index, scene_seed"):
            env.reset(options={"scene": 3})

    def test_an_episode(self):
        env = make("heart", split="test", render_mode="rgb_array")
        with self.assertRaises((RuntimeError, gymnasium.error.ResetNeeded)):
            env.step(env.action_space.sample())
        obs, _ = env.reset(seed=0)
        self.assertEqual(set(obs), {"rgb", "ids", "instances", "instruction"})
        self.assertTrue(numpy.array_equal(env.render(), obs["rgb"]))
        _, reward, terminated, truncated, info = env.step(env.unwrapped.expert_action())
        self.assertEqual((reward, terminated, truncated, info), (1.0, True, False, {"is_success": True, "failure": "none"}))
        with self.assertRaisesRegex(RuntimeError, "expected a reset"):
            env.step(env.action_space.sample())
        env.reset(seed=0)
        self.assertEqual(env.step(numpy.zeros(12, numpy.float32))[1], 0, "no turn at the table's middle")
        env.reset(seed=0)
        for bad in (numpy.full(12, numpy.nan, numpy.float32), numpy.zeros(11, numpy.float32)):
            with self.assertRaises(ValueError):
                env.unwrapped.step(bad)
        env.close()
        env.close()
        with self.assertRaises(TypeError):
            copy.deepcopy(env.unwrapped)
        again = gymnasium.make(pickle.loads(pickle.dumps(env.spec)))
        self.assertTrue(numpy.array_equal(again.reset(seed=0)[0]["rgb"], obs["rgb"]))

    def test_threads_give_what_single_environments_give(self):
        same_step = {"autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP}
        for split in ("train", "test"):
            for threads in (1, 2, 7):
                sync = make_vec("heart", 4, vectorization_mode="sync", vector_kwargs=same_step, split=split)
                vector = make_vec("heart", 4, threads=threads, split=split)
                vector.action_space.seed(0)
                self.assertEqual(sync.observation_space, vector.observation_space)
                self.same(sync.reset(seed=11), vector.reset(seed=11))
                for turn in range(3):
                    actions = vector.unwrapped.expert_actions() if turn else vector.action_space.sample()
                    self.same(sync.step(actions), vector.step(actions))
                self.same(sync.reset(seed=[3, 1, 4, 1]), vector.reset(seed=[3, 1, 4, 1]))
                self.same(sync.reset(), vector.reset())
                self.assertTrue(vector.step(vector.unwrapped.expert_actions())[4]["final_info"]["is_success"].all())

    def test_autoreset(self):
        with self.assertRaisesRegex(ValueError, "every second step"):
            make_vec("heart", 2, autoreset_mode="NextStep")
        off = {"autoreset_mode": gymnasium.vector.AutoresetMode.DISABLED}
        sync, vector = make_vec("heart", 3, vectorization_mode="sync", vector_kwargs=off), make_vec("heart", 3, **off)
        self.same(sync.reset(seed=2), vector.reset(seed=2))
        actions = vector.unwrapped.expert_actions()
        self.same(sync.step(actions), vector.step(actions))
        mask = numpy.array([True, False, True])
        self.same(sync.reset(options={"reset_mask": mask}), vector.reset(options={"reset_mask": mask}))
        with self.assertRaisesRegex(RuntimeError, r"reset\(\) of environments \[1\]"):
            vector.step(actions)

    def test_a_scenario_of_ones_own(self):
        path = pathlib.Path(registration._core.data_directory()) / "scenarios/heart.json"
        own = gymnasium.make("lgabench/own-v1", path=path, engine=ENGINE, layout="cells", split="test")
        shipped = make("heart", layout="cells", split="test")
        self.same(own.reset(seed=1), shipped.reset(seed=1))
        with self.assertRaisesRegex(ValueError, "path=FILE.json"):
            gymnasium.make("lgabench/own-v1")

    def test_a_seed_beyond_a_splits_scenes_says_which_it_plays(self):
        env = make("heart", layout="cells", split="test")
        first = env.reset(seed=2**31 - 2)[1]["scene"]
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            self.assertEqual(env.reset(seed=2 * (2**31 - 1) - 1)[1]["scene"], first)
        self.assertIn(f"plays scene {2**31 - 2}", "".join(str(one.message) for one in said))

    def test_scaled_actions(self):
        env = make("bring_fruit").unwrapped
        for seed in range(5):
            env.reset(seed=seed)
            metres = env.environment.expert_action()
            self.assertTrue(numpy.allclose(env.to_metres(env.from_metres(metres)), metres, atol=1e-6))


class Versions(unittest.TestCase):
    """The same id gives the same bytes for good: whoever changes what is seen raises the version."""

    def seen(self, scenario):
        """Of three scenes of each split, arm and layout."""
        total = hashlib.sha256()
        scenario = lgabench.Scenario(scenario)
        for layout in scenario.layouts:
            with lgabench.Environment(scenario, ENGINE, layout) as env:
                for arm, index in itertools.product([None, *scenario.arms], range(3)):
                    try:
                        one = env.reset("test" if arm else "train", index, arm=arm)
                    except ValueError as nothing:
                        self.assertIn("can be shown", str(nothing))
                    else:
                        for array in (one.rgb, one.ids, env.instance_rows):
                            total.update(array.tobytes())
                        total.update(env.utterance.encode())
        return total.hexdigest()[:16]

    def test_what_an_id_shows(self):
        known, now = json.loads(VERSIONS.read_text()), {name: self.seen(name) for name in lgabench.scenarios()}
        if os.environ.get("LGABENCH_WRITE_VERSIONS"):
            new = {}
            for name, seen in now.items():
                before = known.get(name, {"version": 1, "seen": seen})
                new[name] = {"version": before["version"] + (before["seen"] != seen), "seen": seen}
            VERSIONS.write_text(json.dumps(new, indent=1, sort_keys=True) + "\n")
            return
        other = [name for name in now if known.get(name, {}).get("seen") != now[name]]
        self.assertEqual(other, [], "these show other bytes than their ids did: raise their versions with "
                                    "LGABENCH_WRITE_VERSIONS=1 ./test -R python.Versions")
        self.assertEqual(sorted(known), lgabench.scenarios())


if __name__ == "__main__":
    unittest.main()
