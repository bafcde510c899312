"""Scenes as Gymnasium environments. LGABENCH_WRITE_VERSIONS=1 writes versions.json anew: what changed gets a new version."""
import copy
import hashlib
import itertools
import json
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import unittest
import warnings

import gymnasium
import numpy
from gymnasium.utils.env_checker import check_env

import lgabench
from lgabench import registration
from lgabench.gym import dense_reward
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
        self.assertEqual((reward, terminated, truncated), (1.0, True, False))
        self.assertEqual((info["is_success"], info["failure"]), (True, "none"))
        self.assertEqual(set(info["distance"].values()), {0.})
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
        for one in env.unwrapped, make_vec("heart", 2).unwrapped:
            with self.assertRaisesRegex(TypeError, "^a scene's physics cannot be copied or pickled"):
                pickle.dumps(one)
        again = gymnasium.make(pickle.loads(pickle.dumps(env.spec)))
        self.assertTrue(numpy.array_equal(again.reset(seed=0)[0]["rgb"], obs["rgb"]))

    def test_threads_give_what_single_environments_give(self):
        same_step = {"autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP}
        for split in ("train", "test"):
            for threads in (1, 2, 7):
                mode = {"split": split, "reward_mode": "dense" if threads == 2 else "sparse"}
                sync = make_vec("heart", 4, vectorization_mode="sync", stride=4, vector_kwargs=same_step, **mode)
                vector = make_vec("heart", 4, threads=threads, **mode)
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
        sync, vector = make_vec("heart", 3, vectorization_mode="sync", stride=3, vector_kwargs=off), make_vec("heart", 3, **off)
        self.same(sync.reset(seed=2), vector.reset(seed=2))
        actions = vector.unwrapped.expert_actions()
        self.same(sync.step(actions), vector.step(actions))
        mask = numpy.array([True, False, True])
        self.same(sync.reset(options={"reset_mask": mask}), vector.reset(options={"reset_mask": mask}))
        with self.assertRaisesRegex(RuntimeError, r"reset\(\) of environments \[1\]"):
            vector.step(actions)

    def scenes(self, split, count):
        """Of scene 0, 1, ... of a split."""
        with lgabench.Environment("heart", ENGINE) as env:
            return [env.reset(split, index) and env.scene_hash for index in range(count)]

    def test_a_vector_plays_each_scene_once(self):
        """Batch k of n environments plays scenes kn to kn + n - 1, whoever steps and begins them."""
        n, batches = 3, 4
        same_step = {"autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP}
        off = {"autoreset_mode": gymnasium.vector.AutoresetMode.DISABLED}
        for split in ("dev", "test"):
            scenes = self.scenes(split, n * batches)
            self.assertEqual(len(set(scenes)), n * batches)
            for mode, seeds in (("threads", (None, 0)), ("sync", (0,)), ("async", (0,))):
                own = {} if mode == "threads" else {"vectorization_mode": mode, "stride": n}
                for seed in seeds:
                    with self.subTest(mode, split=split, seed=seed, autoreset="SameStep"):
                        vector = make_vec("heart", n, split=split, **own, **({"vector_kwargs": same_step} if own else same_step))
                        played = list(vector.reset(seed=seed)[1]["scene"])
                        for _ in range(batches - 1):
                            played += list(vector.step(vector.action_space.sample())[4]["scene"])
                        self.assertEqual(played, scenes)
                        vector.close()
                    with self.subTest(mode, split=split, seed=seed, autoreset="Disabled"):
                        vector = make_vec("heart", n, split=split, **own, **({"vector_kwargs": off} if own else off))
                        played = list(vector.reset(seed=seed)[1]["scene"])
                        for _ in range(batches - 1):
                            vector.step(vector.action_space.sample())
                            for mask in (numpy.array([i != 1 for i in range(n)]), numpy.array([i == 1 for i in range(n)])):
                                info = vector.reset(options={"reset_mask": mask})[1]
                                self.assertEqual(list(info["_scene"]), list(mask))
                                played += list(info["scene"][mask])
                        self.assertEqual(sorted(played), sorted(scenes))
                        vector.close()

    def test_what_options_name_moves_nothing(self):
        """Else all environments of a vector would go on with one scene."""
        scenes = self.scenes("test", 8)
        vector = make_vec("heart", 2, split="test")
        self.assertEqual(list(vector.reset()[1]["scene"]), scenes[:2])
        self.assertEqual(list(vector.reset(options={"index": 7})[1]["scene"]), [scenes[7]] * 2)
        self.assertEqual(list(vector.reset()[1]["scene"]), scenes[2:4])

    def test_a_stride_needs_a_seed(self):
        with self.assertRaisesRegex(ValueError, "^stride 0: expected 1 or more$"):
            make("heart", split="test", stride=0)
        env = make("heart", split="test", stride=4)
        with self.assertRaisesRegex(ValueError, r"^reset: expected a seed: with stride 4 environment i of several begins at seed \+ i$"):
            env.reset()
        self.assertEqual([env.reset(seed=1)[1]["scene"], env.reset()[1]["scene"]], self.scenes("test", 6)[1::4])
        make("heart", stride=4).reset()  # split train draws

    def test_processes_are_told_the_words(self):
        """Shared memory holds texts too, which Gymnasium reads but once."""
        same_step = {"autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP}
        for scenario in EXAMPLES if FULL else EXAMPLES[:1]:
            for shared in (True, False):
                with self.subTest(scenario, shared_memory=shared):
                    sync = make_vec(scenario, 2, vectorization_mode="sync", split="test", stride=2, vector_kwargs=same_step)
                    vector = make_vec(scenario, 2, vectorization_mode="async", split="test", stride=2,
                                      vector_kwargs={"shared_memory": shared, **same_step})
                    for one, other in ((sync.reset(seed=0), vector.reset(seed=0)),
                                       (sync.step(sync.action_space.sample()), vector.step(vector.action_space.sample()))):
                        self.assertTrue(all(one[0]["instruction"]))
                        self.same(one[0], other[0])
                        self.assertIn(other[0], vector.observation_space)
                    vector.close()
        bare = make_vec("heart", 2, vectorization_mode="async", split="test", vector_kwargs={"copy": False})
        words = bare.reset(seed=0)[0]["instruction"]
        self.assertEqual((len(words), words[0], list(words)), (2, "Bring me the heart.", ["Bring me the heart."] * 2))
        bare.close()
    def test_a_list_of_options_has_a_value_for_each_environment(self):
        vector = make_vec("many_hearts", 3, split="test", layout="continuous")
        control, other = vector.unwrapped.scenario.arms[:2]
        single = make("many_hearts", split="test", layout="continuous")
        _, infos = vector.reset(options={"arm": [control, other, control], "index": numpy.array([4, 4, 7]), "scene_seed": 2})
        expected = [single.reset(options={"arm": arm, "index": index, "scene_seed": 2})[1]["scene"]
                    for arm, index in ((control, 4), (other, 4), (control, 7))]
        self.assertEqual(list(infos["scene"]), expected)
        self.assertEqual(len(set(expected)), 3)
        for options, says in (({"arm": [control]}, "^options arm: expected one value, or 3, one for each environment, got 1$"),
                              ({"index": (0, 1)}, "^options index: expected one value, or 3, .*, got 2$"),
                              ({"split": ["test"] * 3}, "^options split: expected one for all environments$")):
            with self.assertRaisesRegex(ValueError, says):
                vector.reset(options=options)

    def test_options_of_one_environment_are_its_own(self):
        env = make("many_hearts", split="test", layout="continuous")
        for options, says in (({"arm": ["seen"]}, r"^options: expected a split of .* and an arm of .*, got 'test', \['seen'\]$"),
                              ({"arm": "nope", "split": "train"}, "^options: .*, got 'train', 'nope'$"), ({"split": "tests"}, "got 'tests'"),
                              ({"index": 1.5}, "^options: index: expected a whole number, got 1.5$"),
                              ({"index": [0, 1]}, r"^options: index: .*, got \[0, 1\]$"), ({"scene_seed": "1"}, "scene_seed: .*, got '1'$")):
            with self.assertRaisesRegex(ValueError, says):
                env.reset(options=options)
        vector = make_vec("many_hearts", 2, split="test", layout="continuous")
        self.assertEqual(list(vector.reset(seed=numpy.int64(3))[1]["scene"]), [env.reset(seed=seed)[1]["scene"] for seed in (3, 4)])

    def test_a_scenario_of_ones_own(self):
        path = pathlib.Path(registration._core.data_directory()) / "scenarios/heart.json"
        own = gymnasium.make("lgabench/own-v1", path=path, engine=ENGINE, layout="cells", split="test")
        shipped = make("heart", layout="cells", split="test")
        self.same(own.reset(seed=1), shipped.reset(seed=1))
        with self.assertRaisesRegex(ValueError, "path=FILE.json"):
            gymnasium.make("lgabench/own-v1")

    def test_a_seed_without_a_scene_is_refused(self):
        env, vector = make("heart", layout="cells", split="test"), make_vec("heart", 2, layout="cells", split="test")
        env.reset(seed=2**31 - 1)
        for call in (lambda: env.reset(seed=2**31), lambda: env.reset(), lambda: vector.reset(seed=2**31 - 1)):
            with self.assertRaisesRegex(ValueError, "^seed 2147483648: expected 0 to 2147483647, as split test has a scene for each$"):
                call()
        make("heart", layout="cells").reset(seed=2**64)  # of split train it begins a random stream
        for options in ({"index": 2**31}, {"index": -1}):
            with self.assertRaisesRegex(ValueError, "^index -?[0-9]+: expected 0 to 2147483647$"):
                env.reset(options=options)
            with self.assertRaisesRegex(ValueError, "^index -?[0-9]+: expected 0 to 2147483647$"):
                vector.reset(options=options)
        env.reset(seed=0), vector.reset(seed=0)
        for seed in (-1, 2**64):
            for call in (lambda: env.reset(options={"scene_seed": seed}), lambda: vector.reset(options={"scene_seed": seed}),
                         lambda: lgabench.Environment("heart", ENGINE).reset("test", seed=seed)):
                with self.assertRaisesRegex(ValueError, f"^seed {seed}: expected 0 to {2**64 - 1}$"):
                    call()
        with self.assertRaisesRegex(ValueError, "^own_scenes -1: expected 0 to"):
            lgabench.Environment("heart", ENGINE).reset("test", own_scenes=-1)

    def test_what_success_lacks(self):
        """Every task names its parts, the same in all scenes; a success has none left, and a dense reward of 1 exactly then."""
        for scenario in EXAMPLES:
            with self.subTest(scenario):
                sparse, dense = (make(scenario, split="test", reward_mode=mode) for mode in ("sparse", "dense"))
                parts = set()
                dense.action_space.seed(0)
                for index in range(6):
                    sparse.reset(seed=index)
                    dense.reset(seed=index)
                    action = dense.action_space.sample() if index % 2 else dense.unwrapped.expert_action()
                    _, reward, _, _, info = dense.step(action)
                    _, zero_or_one, _, _, same = sparse.step(action)
                    self.assertEqual((info, zero_or_one), (same, float(info["is_success"])))
                    self.assertEqual(reward == 1, info["is_success"])
                    self.assertEqual(not any(info["distance"].values()), info["is_success"])
                    self.assertTrue(0 < reward <= (1 if info["is_success"] else .9), reward)
                    parts.add(tuple(info["distance"]))
                self.assertEqual(len(parts), 1)

    def test_a_dense_reward_falls_with_every_distance(self):
        parts = {"reach_m": .2, "pick": 1., "turn_deg": 30., "reach_px": 10.}
        usual = dense_reward(False, parts)
        for part, value in parts.items():
            self.assertEqual(dense_reward(True, parts), 1.)
            self.assertGreater(dense_reward(False, {**parts, part: value / 2}), usual)
            self.assertLess(dense_reward(False, {**parts, part: value * 2}), usual)
            self.assertLess(dense_reward(False, {**parts, part: 1e300}), 1e-200)
        self.assertEqual(dense_reward(False, dict.fromkeys(parts, 0.)), .9)
        self.assertAlmostEqual(dense_reward(False, {"place_m": .1, "turn_deg": 15., "reach_px": 50., "pick": 1.}), .9 / 16)

    def test_a_dense_reward_rises_on_the_way_to_the_target(self):
        env = make("heart", split="test", reward_mode="dense")
        env.reset(seed=0)
        expert = env.unwrapped.environment.expert_action()
        rewards = []
        for away in (.4, .3, .2, .1, 0.):
            env.reset(seed=0)
            action = expert.copy()
            action[0] += away if expert[0] < .5 else -away
            rewards.append(env.step(env.unwrapped.from_metres(action))[1])
        self.assertEqual(rewards, sorted(rewards))
        self.assertEqual(rewards[-1], 1)
        with self.assertRaisesRegex(ValueError, "reward_mode 'shaped': expected sparse or dense"):
            make("heart", reward_mode="shaped")

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


class InPython(unittest.TestCase):
    """An environment that is a class in Python, of the template, in a process that finds it by its variables."""
    INTERPRETER = os.environ.get("LGABENCH_TEST_PYTHON", "/usr/bin/python3")  # this one's NumPy may come from PYTHONPATH
    PLAYED = """if True:
        import gymnasium, lgabench
        env = gymnasium.make("lgabench/my_world_red-v1", split="test")
        rewards = []
        for seed in (0, 1, 0):
            obs, start = env.reset(seed=seed)
            over = False
            while not over:
                obs, reward, terminated, truncated, info = env.step(env.unwrapped.expert_action())
                over = terminated or truncated
            rewards.append((reward, start["scene"], obs["rgb"].tobytes()))
        assert [one[0] for one in rewards] == [1, 1, 1] and rewards[0] == rewards[2] != rewards[1]
        vector = gymnasium.make_vec("lgabench/my_world_blind-v1", 2, threads=2)
        vector.reset(seed=0)
        vector.step(vector.action_space.sample())"""

    def test_it_is_played(self):
        if subprocess.run([self.INTERPRETER, "-c", "import numpy"], env={"PATH": os.environ["PATH"]}, capture_output=True).returncode != 0:
            self.skipTest(f"{self.INTERPRETER} has no NumPy")
        with tempfile.TemporaryDirectory() as folder:
            new = [pathlib.Path(os.environ["LGABENCH_BUILD"]) / "bin/lgabench", "new-plugin", "my_world", "--kind", "environment", "--language", "python"]
            subprocess.run(new, cwd=folder, check=True, capture_output=True)
            mine = pathlib.Path(folder) / "my_world"
            where = {"LGABENCH_PYTHON": self.INTERPRETER, "LGABENCH_SCENARIO_PATH": str(mine), "LGABENCH_PLUGIN_PATH": f"{mine}/my_world.py:MyWorld"}
            done = subprocess.run([sys.executable, "-c", self.PLAYED], env={**os.environ, **where}, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)


if __name__ == "__main__":
    unittest.main()
