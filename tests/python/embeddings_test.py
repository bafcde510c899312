"""The committed sentence embeddings, as a method in Python gets them."""
import unittest

import numpy

from lgabench import Scenario
from lgabench_method.embeddings import embedding


class Embeddings(unittest.TestCase):
    def test_names_and_commands_that_are_shipped_have_one(self):
        space = Scenario("heart").space
        for name in [*space.object_types, *space.textures, Scenario("heart").command(0).utterance]:
            vector = embedding(name)
            self.assertEqual(vector.shape, (384,))
            self.assertAlmostEqual(numpy.linalg.norm(vector), 1, places=3)
            self.assertFalse(vector.flags.writeable)
        self.assertGreater(embedding("letter A") @ embedding("letter V"), embedding("letter A") @ embedding("ring"))

    def test_others_are_refused(self):
        with self.assertRaisesRegex(ValueError, '"no such thing": expected a name or a command that lgabench ships'):
            embedding("no such thing")


if __name__ == "__main__":
    unittest.main()
