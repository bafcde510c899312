"""What is meant in a scene, in Python, against the cases that C++ is tested with."""
import json
import pathlib
import unittest

import numpy

from lgabench_method import FeatureSet, Instance, Observation, Selection, goal_mask, grounded, values

GOLDEN = json.loads((pathlib.Path(__file__).parents[1] / "unit/golden/grounded.json").read_text())


def drawn(case):
    ids = numpy.zeros((GOLDEN["rows"], GOLDEN["columns"]), numpy.uint8)
    instances = []
    for one in case["objects"]:
        if one["pixels"] is not None:
            row, column, height, width = one["pixels"]
            ids[row:row + height, column:column + width] = one["id"]
        instances.append(Instance(one["id"], one["object_type"], one["texture"], int((ids == one["id"]).sum())))
    return Observation(numpy.zeros((*ids.shape, 3), numpy.uint8), ids, instances)


class Meanings(unittest.TestCase):
    def test_what_is_meant_is_what_cpp_finds(self):
        self.assertGreaterEqual(len(GOLDEN["cases"]), 26)
        for case in GOLDEN["cases"]:
            with self.subTest(case["name"]):
                scene, selection = drawn(case), values.selection({"target": case["target"]})
                self.assertEqual(grounded(selection.meaning, scene), case["meant"])
                shown = set(numpy.unique(scene.ids[goal_mask(scene, selection) == 1]))
                self.assertEqual(shown, set(case["meant"]))

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


if __name__ == "__main__":
    unittest.main()
