"""docs/python.md as its reader walks it: its code, in order, in an empty directory. LGABENCH_FULL: the notebook too."""
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

import lgabench
from data_test import Case
from scenes_test import FULL

SOURCE = pathlib.Path(__file__).parents[2]


def code_of(page):
    """Indented blocks of Python, as one text each."""
    blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", page, re.M)
    texts = [re.sub("^    ", "", block, flags=re.M).strip() for block in blocks]
    return [text for text in texts if re.match("import|from|vector =|run =", text) and "MyMethod" not in text]


@unittest.skipUnless("mujoco" in lgabench.engines(), "the page plays on MuJoCo")
class Page(Case):
    def python(self, text):
        done = subprocess.run([sys.executable, "-c", text], cwd=self.dir, capture_output=True, text=True, timeout=600,
                              env=dict(os.environ, HOME=str(self.dir), LGABENCH_CACHE=str(self.dir / "cache")))
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return done.stdout

    def test_its_code(self):
        self.call("run", "q1", "--preset", "smoke", "--scenarios", "heart", "--methods", "lga", "--demos", 10, "--seeds", 0,
                  "--episodes", 3, "--no-reference", "--out", "runs/NAME")
        blocks = code_of((SOURCE / "docs/python.md").read_text())
        self.assertEqual(len(blocks), 5)
        scene, neighbour, env, vector, run = blocks
        self.assertIn("True", self.python(scene))
        self.assertRegex(self.python(neighbour), r"Result\(success=0\.[0-9]+, low=")
        self.assertIn("True none", self.python(env + "\n" + vector))
        self.assertIn("lga", self.python(run))

    @unittest.skipUnless(FULL and importlib.util.find_spec("matplotlib"), "not installed: matplotlib, or no LGABENCH_FULL")
    def test_the_notebook(self):
        cells = json.loads((SOURCE / "examples/python/scenes.ipynb").read_text())["cells"]
        text = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        self.python(f"import matplotlib; matplotlib.use('Agg')\n{text}\nassert .5 < result.success and success['oracle'] == 1")


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
