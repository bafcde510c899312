"""Episodes of several steps, of examples/reach2d, in Python and as Gymnasium environments."""
import os
import pathlib
import unittest
import warnings

BUILD, ROOT = pathlib.Path(os.environ["LGABENCH_BUILD"]), pathlib.Path(__file__).parents[2]
os.environ.update({"LGABENCH_PLUGIN_PATH": str(BUILD / "tests/plugins/examples"),
                   "LGABENCH_SCENARIO_PATH": str(ROOT / "examples/reach2d")})

import gymnasium
import h5py
import numpy
from gymnasium.utils.env_checker import check_env

import lgabench
from lgabench.data import load_demonstrations
from lgabench_method import testing
from data_test import Case


def make(**arguments):
    return gymnasium.make("lgabench/reach2d_red-v1", split="test", **arguments)


def make_vec(n, **arguments):
    return gymnasium.make_vec("lgabench/reach2d_red-v1", n, split="test", **arguments).unwrapped


class Steps(Case):
    def test_the_checker_has_nothing_to_say(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(make(render_mode="rgb_array").unwrapped)

    def test_an_episode_goes_on_until_it_is_over(self):
        env = make().unwrapped
        self.assertEqual(env._max_episode_steps, 20)
        for seed in range(5):
            seen, _ = env.reset(seed=seed)
            for step in range(20):
                self.assertTrue(env.observation_space["state"].contains(seen["state"]))
                seen, reward, terminated, truncated, info = env.step(env.expert_action())
                self.assertFalse(truncated)
                if terminated:
                    break
                self.assertEqual((reward, info["failure"]), (0, "goes_on"))
            self.assertEqual((reward, info["failure"]), (1, "none"))
            with self.assertRaisesRegex(RuntimeError, "the episode is over"):
                env.step(env.action_space.sample())

    def test_dense_rewards_are_refused(self):
        for build in make, lambda **arguments: make_vec(2, **arguments):
            with self.assertRaisesRegex(ValueError, "an episode of reach2d_red has several steps"):
                build(reward_mode="dense")

    def test_several_at_once_end_at_other_times_and_play_what_one_plays(self):
        for mode in gymnasium.vector.AutoresetMode.SAME_STEP, gymnasium.vector.AutoresetMode.NEXT_STEP:
            vector = make_vec(3, threads=2, autoreset_mode=mode)
            alone = [make(stride=3).unwrapped for _ in range(3)]
            begun = vector.reset(seed=0)[0]
            seen = [env.reset(seed=i)[0] for i, env in enumerate(alone)]
            ended, begins = 0, [False] * 3
            for _ in range(40):
                for i in range(3):
                    self.assertTrue(numpy.array_equal(begun["state"][i], seen[i]["state"]))
                    self.assertTrue(numpy.array_equal(begun["rgb"][i], seen[i]["rgb"]))
                actions = vector.expert_actions()
                begun, rewards, terminated, truncated, infos = vector.step(actions)
                for i, env in enumerate(alone):
                    if begins[i]:
                        seen[i], begins[i] = env.reset()[0], False
                        self.assertEqual((rewards[i], bool(terminated[i])), (0, False))
                        continue
                    seen[i], reward, over, _, info = env.step(actions[i])
                    self.assertEqual((rewards[i], bool(terminated[i]), bool(truncated[i])), (reward, over, False))
                    if over:
                        ended += 1
                        if mode == gymnasium.vector.AutoresetMode.SAME_STEP:
                            self.assertTrue(numpy.array_equal(infos["final_obs"][i]["state"], seen[i]["state"]))
                            self.assertTrue(infos["final_info"]["is_success"][i])
                            seen[i] = env.reset()[0]
                        else:
                            begins[i] = True
            self.assertGreater(ended, 6)

    def test_a_file_has_what_the_gymnasium_environment_plays(self):
        self.call("demos", "reach2d_red", "--n", 4, "--noisy", 2, "--out", "d.hdf5")
        shown = load_demonstrations(self.dir / "d.hdf5")
        env = make().unwrapped
        for number, one in enumerate(shown):
            seen, _ = env.reset(options={"split": "train", "index": number})
            self.assertTrue(2 <= len(one.steps) <= 20 and one.recovery)
            for step, action in zip(one.steps, shown.actions(one.steps)):
                numpy.testing.assert_allclose(step.observation.state, seen["state"], atol=1e-5)
                seen, _, over, _, info = env.step(action)
                self.assertEqual(over, step is one.steps[-1])
            self.assertTrue(info["is_success"])

    def test_nothing_left_to_do_is_a_number_of_an_action(self):
        self.call("demos", "reach2d_red", "--n", 2, "--out", "d.hdf5")
        before = load_demonstrations(self.dir / "d.hdf5")
        self.assertEqual(before.actions(before[0].steps).shape, (len(before[0].steps), 2))
        with h5py.File(self.dir / "d.hdf5", "r+") as file:
            demo = file["data/demo_0"]
            demo["stops"] = numpy.arange(len(demo["actions"])) == len(demo["actions"]) - 1
        shown = load_demonstrations(self.dir / "d.hdf5")
        self.assertTrue(shown.may_stop)
        self.assertEqual(shown[0].steps[-1].label.shape, (0,))
        for one, other in zip(shown, before):
            rows, stops = shown.actions(one.steps), [not len(step.label) for step in one.steps]
            self.assertEqual(rows[:, 2].tolist(), [1 if stop else -1 for stop in stops])
            numpy.testing.assert_array_equal(rows[:, :2], numpy.where(numpy.array(stops)[:, None], 0, before.actions(other.steps)))
        shown.action_space = None
        with self.assertRaisesRegex(ValueError, "the file names no action space"):
            shown.actions(shown[0].steps)

    def test_methods_get_trajectories_and_states(self):
        for one in testing.demonstrations("reach2d_red", 3):
            self.assertGreater(len(one.steps), 2)
            self.assertEqual(one.recovery, [])
            self.assertEqual([step.observation.state.shape for step in one.steps], [(2,)] * len(one.steps))
        with lgabench.Environment("reach2d_red") as environment:
            won = lgabench.evaluate(lambda seen, words: environment.expert_action(), environment, 10)
        self.assertEqual(won.success, 1)
        names = [number.name for number in lgabench.Scenario("reach2d_red").state]
        self.assertEqual(names, ["down", "across"])
        self.assertEqual(lgabench.Scenario("reach2d_blind").state, ())


if __name__ == "__main__":
    unittest.main()
