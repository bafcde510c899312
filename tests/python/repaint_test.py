"""repaint() in Python makes the bytes that C++ makes, of the scenes that C++ is tested with."""
import hashlib
import json
import pathlib
import unittest

import numpy

import lgabench
from lgabench_method import Demonstration, Instruction, Needs, RandomStream, Selection, Step, testing
from lgabench_method.repaint import (Background, Colour, Noise, RandomTextures, augmented, most_frequent_colour,
                                     repaint, unselected, usual_background)

GOLDEN = json.loads((pathlib.Path(__file__).parents[1] / "unit/golden/repaint.json").read_text())


def digest(array):
    return hashlib.sha256(array.tobytes()).hexdigest()


class Repaint(unittest.TestCase):
    def test_bytes_are_those_of_cpp(self):
        self.assertGreaterEqual(len(GOLDEN), 9)
        for case in GOLDEN:
            scenario = lgabench.Scenario(case["scenario"])
            name = f"golden/{case['scenario']}/{case['index']}"
            with self.subTest(name), lgabench.Environment(scenario, layout=scenario.layouts[-1], shadows=True) as env:
                seen = env.reset("train", case["index"], seed=7)
                self.assertEqual(digest(seen.rgb), case["seen"])
                which = unselected(seen, scenario.truth(0)) + [0]
                self.assertEqual(which, case["which"])
                usual = usual_background([Demonstration(Instruction("", Selection()), [Step(seen, numpy.zeros(1))])])
                one, noise = [seen.instances[0].id], RandomStream(name + "/noise")
                self.assertEqual(digest(usual.rgb), case["usual"])
                colour = most_frequent_colour(usual)
                self.assertEqual([colour.red, colour.green, colour.blue], case["table"])
                self.assertEqual(digest(repaint(seen, one, usual).rgb), case["erased"])
                coloured = repaint(seen, one, Colour(1, 2, 3))
                self.assertEqual(digest(coloured.rgb), case["colour"])
                self.assertTrue(numpy.array_equal(repaint(coloured, one, Colour(1, 2, 3)).rgb, coloured.rgb))
                self.assertEqual(digest(repaint(seen, which, Noise(noise)).rgb), case["noise"])
                self.assertEqual(digest(repaint(seen, one, Noise(noise)).rgb), case["noise_of_one"])
                textures = RandomTextures(RandomStream(name + "/textures"))
                self.assertEqual(digest(repaint(seen, which, textures).rgb), case["textures"])

    def test_an_observation_has_shadows_where_they_were_asked_for(self):
        with lgabench.Environment("heart") as env:
            self.assertIsNone(env.reset("train").shadows)
        (one,) = testing.demonstrations("heart", 1, shadows=True)
        self.assertEqual(one.steps[0].observation.shadows.dtype, numpy.uint16)
        self.assertGreater(numpy.count_nonzero(one.steps[0].observation.shadows), 100)

    def test_copies_follow_the_demonstrations(self):
        shown = testing.demonstrations("heart", 2, shadows=True)

        def noisy(step, selection, copy, stream):
            return Step(repaint(step.observation, unselected(step.observation, selection), Noise(stream)), step.label)

        more, again = augmented(shown, 3, noisy, 5), augmented(shown, 3, noisy, 5)
        self.assertEqual(len(more), 8)
        self.assertIs(more[0], shown[0])
        pictures = [digest(one.steps[0].observation.rgb) for one in more]
        self.assertEqual(pictures, [digest(one.steps[0].observation.rgb) for one in again])
        self.assertEqual(len(set(pictures)), 8)

    def test_a_step_that_says_that_nothing_is_left_has_no_copy(self):
        one = testing.demonstrations("heart", 1)[0]
        done = Step(one.steps[0].observation, numpy.zeros(0))
        rows = []

        def noted(step, selection, copy, stream):
            rows.append(len(step.label))
            return step

        shown = [Demonstration(one.instruction, [done]), Demonstration(one.instruction, [*one.steps, done])]
        more = augmented(shown, 2, noted, 5)
        self.assertEqual([len(each.steps) for each in more], [1, 2, 1, 1])
        self.assertEqual(rows, [12, 12])

    def test_a_method_may_ask_for_shadows(self):
        class Looks:
            options = {}

            def needs(self, options):
                return Needs(shadows=True)

            def select(self, command, space, services):
                return Selection()

            def learn(self, demonstrations, services):
                self.background = usual_background(demonstrations)
                return self

            def act(self, observation, instruction):
                empty = repaint(observation, [one.id for one in observation.instances], Background(self.background.rgb))
                off = numpy.abs(empty.rgb.astype(int) - self.background.rgb) > 1
                assert numpy.count_nonzero(off) < off.size / 100
                return [.5, 0, 0, 0, 0, 1, .5, 0, 0, 0, 0, 1]

        self.assertEqual(testing.try_out(Looks, "heart", 5, 3).episodes, 3)


if __name__ == "__main__":
    unittest.main()
