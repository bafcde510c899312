"""lgabench's scenes without Gymnasium: bytes, order of calls, threads, errors."""
import multiprocessing
import os
import pathlib
import pickle
import resource
import threading
import unittest

import numpy

import lgabench

FULL = os.environ.get("LGABENCH_FULL") == "1"
ENGINE = "kinematic"  # always built
EXAMPLES = ("heart", "rotate_block", "stack_small_block_on_hexagon", "sweep_block_without_touching_line", "bring_fruit",
            "throw_away_drink", "fetch_fruit")  # one of each task and environment


def same(a, b):
    return all(numpy.array_equal(x, y) for x, y in ((a.rgb, b.rgb), (a.ids, b.ids))) and a.instances == b.instances


class Scenes(unittest.TestCase):
    def test_what_is_installed(self):
        self.assertIn("heart", lgabench.scenarios())
        self.assertIn(ENGINE, lgabench.engines())

    def test_the_oracle_succeeds_in_every_task_on_every_engine(self):
        for engine in lgabench.engines():
            for scenario in lgabench.scenarios() if FULL else EXAMPLES:
                with self.subTest(scenario, engine=engine), lgabench.Environment(scenario, engine) as env:
                    seen = env.reset("test", 0)
                    self.assertEqual(seen.rgb.shape, (*env.scenario.picture_size, 3))
                    self.assertLessEqual(len(seen.instances), env.scenario.most_instances)
                    self.assertTrue((env.instance_rows[:len(seen.instances)] >= 0).all(), "a word that the space lacks")
                    result = env.step(env.expert_action())
                    self.assertEqual(result.success, result.failure == "none")
                    self.assertTrue(result.success or scenario not in EXAMPLES, "of other scenarios it misses a few scenes")

    def test_stations_are_told(self):
        space = lgabench.Scenario("fetch_fruit").action_space
        self.assertEqual(len(space.stations), 5)
        self.assertEqual(lgabench.Scenario("heart").action_space.stations, ())
        led = set()
        with lgabench.Environment("fetch_fruit", ENGINE) as env:
            for index in range(8):
                env.reset("test", index)
                values = tuple(env.expert_action()[list(space.station_numbers)])
                led |= {i for i, one in enumerate(space.stations) if numpy.allclose(one.values, values, atol=1e-5)}
        self.assertGreater(len(led), 1, "the oracle's actions lead to stations")
        for one in space.stations:
            self.assertEqual(len(one.values), len(space.station_numbers))

    def test_calls_out_of_order(self):
        env = lgabench.Environment("heart", ENGINE)
        action = [0.0] * len(env.action_space.names)
        for call in (lambda: env.step(action), env.expert_action, lambda: env.expert_action(1), lambda: env.scene_hash,
                     lambda: env.utterance, lambda: env.instance_rows):
            with self.assertRaisesRegex(RuntimeError, "expected a reset"):
                call()
        env.reset()
        with self.assertRaisesRegex(ValueError, "layout|arm|split"):
            env.reset("test", 0, arm="nope")
        env.reset()
        env.step(env.expert_action())
        env.step(env.expert_action())  # goes on from the state that was reached
        env.close()
        env.close()
        with self.assertRaisesRegex(RuntimeError, "closed"):
            env.reset()

    def test_a_scenario_is_pickled_as_its_arguments(self):
        file = pathlib.Path(lgabench._core.data_directory()) / "scenarios/heart.json"
        for one in lgabench.Scenario("red_heart"), lgabench.Scenario(path=os.path.relpath(file)):
            again = pickle.loads(pickle.dumps(one))
            self.assertEqual((again.id, again.commands, again.truth(0)), (one.id, one.commands, one.truth(0)))
        for one in lgabench.Environment("heart", ENGINE), lgabench.Pool("heart", 2, engine=ENGINE):
            with self.assertRaisesRegex(TypeError, "^a scene's physics cannot be copied or pickled"):
                pickle.dumps(one)

    def test_bad_arguments(self):
        env = lgabench.Environment("heart", ENGINE)
        env.reset()
        good = env.expert_action()
        nan = good.copy()
        nan[0] = numpy.nan
        for bad in (nan, good[:-1], good[None], numpy.zeros(12), "text", None):
            with self.subTest(bad=bad), self.assertRaises((ValueError, TypeError)):
                env.step(bad)
        for index in (-1, 2**31):
            with self.assertRaises(ValueError):
                env.reset("train", index)
        with self.assertRaisesRegex(ValueError, "id"):
            env.expert_action(0)
        with self.assertRaisesRegex(ValueError, 'no scenario "haert"'):
            lgabench.Scenario("haert")
        with self.assertRaisesRegex(ValueError, "engine"):
            lgabench.Environment("heart", "nope")
        with self.assertRaisesRegex(ValueError, "layout"):
            lgabench.Environment("heart", ENGINE, "nope")
        wide = numpy.stack([good, good], axis=1)  # neither contiguous
        self.assertTrue(env.step(wide[:, 0].astype(numpy.float32)).success, "nor double")

    def test_arrays_are_never_reused(self):
        env = lgabench.Environment("heart", ENGINE)
        seen = env.reset("train", 0)
        before = seen.rgb.copy(), seen.ids.copy()
        env.step(env.expert_action())
        env.reset("train", 1)
        del env
        self.assertTrue(numpy.array_equal(seen.rgb, before[0]) and numpy.array_equal(seen.ids, before[1]))
        seen.rgb[:] = 0  # one's own

    def test_the_same_scene_gives_the_same_bytes(self):
        env, other = lgabench.Environment("bring_fruit", ENGINE), lgabench.Environment("bring_fruit", ENGINE)
        for arm in env.scenario.arms:
            first = env.reset("test", 3, arm=arm)
            other.reset("train", 7)
            self.assertTrue(same(first, other.reset("test", 3, arm=arm)), arm)

    def test_a_pool_equals_single_environments(self):
        env = lgabench.Environment("heart", ENGINE)
        alone = []
        for index in range(7):
            seen = env.reset("test", index)
            rows = env.instance_rows
            alone.append((seen, rows, env.step(env.expert_action())))
        for threads in (1, 2, 7):
            pool = lgabench.Pool("heart", 7, threads, ENGINE)
            batch = pool.reset("test", range(7))
            after, success, failures, distances = pool.step(pool.expert_actions())
            for i, (seen, rows, result) in enumerate(alone):
                self.assertTrue(numpy.array_equal(batch.rgb[i], seen.rgb) and numpy.array_equal(batch.ids[i], seen.ids))
                self.assertTrue(numpy.array_equal(batch.instances[i], rows))
                self.assertTrue(numpy.array_equal(after.rgb[i], result.observation.rgb))
                self.assertEqual((bool(success[i]), failures[i]), (result.success, result.failure))

    def test_an_error_in_a_pool_leaves_it_usable(self):
        pool = lgabench.Pool("heart", 3, 2, ENGINE)
        with self.assertRaisesRegex(RuntimeError, "expected a reset"):
            pool.step(numpy.ones((3, 12)))
        pool.reset("test", [0, 1, 2])
        actions = pool.expert_actions()
        actions[1] = numpy.nan
        with self.assertRaises(ValueError):
            pool.step(actions)
        for at in ([0, 0], [3], [-1]):
            with self.assertRaisesRegex(ValueError, "numbers of environments"):
                pool.reset("test", [0] * len(at), at=at)
        pool.reset("test", [0, 1, 2])
        self.assertTrue(pool.step(pool.expert_actions())[1].all())

    def test_a_pool_says_that_it_was_forked(self):
        pool = lgabench.Pool("heart", 2, 2, ENGINE)
        context = multiprocessing.get_context("fork")
        said = context.SimpleQueue()

        def child():
            try:
                pool.reset("test", [0, 1])
            except RuntimeError as error:
                said.put(str(error))
            else:
                said.put("nothing")

        process = context.Process(target=child)
        process.start()
        process.join(60)
        self.assertEqual(process.exitcode, 0)
        self.assertIn("before this process was forked", said.get())

    def test_threads_of_python(self):
        def play(found):
            env = lgabench.Environment("heart", ENGINE)
            found.append([(env.reset("test", i).rgb.sum(), env.step(env.expert_action()).success) for i in range(10)])

        results = [[] for _ in range(4)]
        threads = [threading.Thread(target=play, args=(found,)) for found in results]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(all(found == results[0] for found in results))
        env = lgabench.Environment("heart", ENGINE)
        refused = []

        def disturb():
            for i in range(100):
                try:
                    env.reset("test", i)
                except RuntimeError as error:
                    refused.append(str(error))

        threads = [threading.Thread(target=disturb) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(all("another thread" in text for text in refused), refused[:1])

    def test_python_keeps_its_arithmetic(self):
        env = lgabench.Environment("heart", ENGINE)
        env.reset()
        env.step(env.expert_action())
        self.assertGreater(float(numpy.float64(5e-324) * 1), 0, "subnormal numbers are flushed to zero")

    def test_memory_does_not_grow(self):
        env = lgabench.Environment("heart", ENGINE)

        def play(episodes):
            for i in range(episodes):
                env.reset("train", i)
                env.step(env.expert_action())
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

        before = play(300)
        self.assertLess(play(10000 if FULL else 700) - before, 5 << 10)  # KiB

    def test_truth_and_commands(self):
        scenario = lgabench.Scenario("heart")
        self.assertEqual(scenario.truth(0).target.object_types, ["heart"])
        self.assertEqual(scenario.truth(0).provenance, "truth")
        self.assertEqual(scenario.command(0).utterance, scenario.commands[0])
        with self.assertRaises(IndexError):
            scenario.truth(1)
        sweep = lgabench.Scenario("sweep_block_without_touching_line")
        self.assertEqual(sweep.truth(0).second.role, "avoid")
        self.assertEqual(sweep.command(0).second.id, "avoid")

    def test_evaluate(self):
        env = lgabench.Environment("heart", ENGINE)
        result = lgabench.evaluate(lambda seen, utterance: env.expert_action(), env, 20)
        self.assertEqual((result.success, result.high, result.failures), (1, 1, {}))
        self.assertAlmostEqual(result.low, .8389, 4)
        numbers = iter([[.5, 0, 0, 0, 0, 0] * 2, [float("nan")] * 12, [.5] * 3] + [[.26, .49, 0, 0, 0, 1] * 2] * 2)
        none = lgabench.evaluate(lambda seen, utterance: next(numbers), env, 5)
        self.assertEqual((none.success, none.failures["method_error"]), (0, 3))
        with self.assertRaisesRegex(ValueError, "rotation of norm"):
            lgabench.evaluate(lambda seen, utterance: [.5, 0, 0, 0, 0, 0] * 2, env, 1, strict=True)
        with self.assertRaisesRegex(ValueError, "rotation of norm"):  # no action at all was played
            lgabench.evaluate(lambda seen, utterance: [.5, 0, 0, 0, 0, 0] * 2, env, 3)
        nowhere = lgabench.evaluate(lambda seen, utterance: [.26, .49, 0, 0, 0, 1] * 2, env, 5)
        self.assertEqual((nowhere.success, nowhere.failures), (0, {"missed_object": 5}))


if __name__ == "__main__":
    unittest.main()
