"""What is meant in a scene, in Python, against the cases that C++ is tested with."""
import itertools
import json
import pathlib
import unittest

import numpy

import lgabench
from lgabench_method import (Demonstration, FeatureSet, Instance, Instruction, Observation, Selection, Step, goal_mask, grounded,
                             is_done, taken, values, wanted)

GOLDEN, TURNS = (json.loads((pathlib.Path(__file__).parents[1] / f"unit/golden/{name}.json").read_text()) for name in ("grounded", "turns"))


def drawn(case):
    ids = numpy.zeros((GOLDEN["rows"], GOLDEN["columns"]), numpy.uint8)
    instances = []
    for one in case["objects"]:
        if one["pixels"] is not None:
            row, column, height, width = one["pixels"]
            ids[row:row + height, column:column + width] = one["id"]
        instances.append(Instance(one["id"], one["object_type"], one["texture"], int((ids == one["id"]).sum())))
    return Observation(numpy.zeros((*ids.shape, 3), numpy.uint8), ids, instances, brought=things(case.get("brought", [])))


def things(names):
    return [tuple(one) for one in names]


class Meanings(unittest.TestCase):
    def test_what_is_meant_is_what_cpp_finds(self):
        self.assertGreaterEqual(len(GOLDEN["cases"]), 29)
        for case in GOLDEN["cases"]:
            with self.subTest(case["name"]):
                scene, selection = drawn(case), values.selection({"target": case["target"]})
                self.assertEqual(grounded(selection.meaning, scene), case["meant"])
                shown = set(numpy.unique(scene.ids[goal_mask(scene, selection) == 1]))
                self.assertEqual(shown, set(case["meant"]))

    def test_what_is_wanted_next_and_when_all_is_done(self):
        self.assertGreaterEqual(len(TURNS["cases"]), 33)
        for case in TURNS["cases"]:
            with self.subTest(case["name"]):
                meaning = values.meaning({"turns": case["turns"]})
                on_table, brought = things(case["on_table"]), things(case["brought"])
                self.assertEqual(wanted(meaning, on_table, brought), things(case["wanted"]))
                self.assertEqual(is_done(meaning, on_table, brought), case["done"])

    def test_a_meaning_comes_back_from_the_frame(self):
        for case in GOLDEN["cases"]:
            frame = {"target": case["target"]}
            self.assertEqual(values.selection_json(values.selection(frame), "select() returned"), frame)

    def test_the_one_product_of_a_target_raises_where_there_is_more(self):
        product = FeatureSet(["heart"], ["red"])
        self.assertIs(Selection(product).target, product)
        two = values.selection({"target": {"sets": [{"object_types": ["heart"], "textures": ["red"]}] * 2}})
        with self.assertRaisesRegex(ValueError, "more than one product"):
            two.target
        self.assertTrue(two.belongs("heart", "red"))

    def test_what_is_taken_is_what_the_oracle_was_told_to_take(self):
        """In every task; C++ has a test of its own."""
        tasks = set()
        for id in lgabench.scenarios():
            with self.subTest(id), lgabench.Environment(id) as env:
                tasks.add(env.scenario.command(0).task)
                layout = {"action": json.loads(env.scenario._core.action_space_json)}
                for index in range(2):
                    scene = env.reset("train", index)
                    action = env.expert_action()
                    found = taken(Demonstration(Instruction("", Selection()), [Step(scene, action)]), layout)
                    numpy.testing.assert_array_equal(env.expert_action(found), action)
                    self.assertEqual(taken(Step(scene, action), layout), found)
                    self.assertIsNone(taken(Step(scene, action[:0]), layout), "nothing is left to do")
        self.assertEqual(tasks, {"pick_and_place", "rotate", "sweep", "stack", "bring", "throw_away", "fetch", "errands", "refusing"})

    def test_the_object_meant_is_the_samplers_target(self):
        """Of every command of the suite words: C++ made a target of what its own grounding finds."""
        commands = [id for id in lgabench.scenarios() if id.startswith("words_")]
        self.assertEqual(len(commands), 56)
        rules = set()
        for id in commands:
            with self.subTest(id), lgabench.Environment(id, "kinematic") as env:
                truth = env.scenario.truth(0)
                rules.add(truth.meaning.which.rule if truth.meaning.which else None)
                for split, index in itertools.product(("train", "test"), range(6)):
                    scene = env.reset(split, index)
                    meant = grounded(truth.meaning, scene)
                    self.assertEqual(len(meant), 1)
                    numpy.testing.assert_array_equal(env.expert_action(meant[0]), env.expert_action())
                    numpy.testing.assert_array_equal(goal_mask(scene, truth) == 1, scene.ids == meant[0])
        self.assertEqual(rules, {None, "left_of", "right_of", "nearest_to", "farthest_from", "leftmost", "rightmost", "first_in"})


if __name__ == "__main__":
    unittest.main()
