"""Methods of packages that pip installed beside this one: listed and run by id, and none of their code runs before a cell's."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import zipfile

import numpy

import lgabench
from data_test import Case
from scenes_test import ENGINE

PACKAGES = pathlib.Path(lgabench.__file__).parents[1]
METHOD = '''
import os
import numpy
from lgabench_method import select_features
from tiny_methods.actions import first  # hashed with the method

try:
    open(MARK, "w").write("ran")
except OSError:
    pass  # confined


class Tiny:
    """The first demonstration's action."""

    version = "0.1"

    def select(self, command, space, services):
        return select_features(command, space, services.lm)

    def learn(self, demonstrations, services):
        self.act = lambda observation, instruction: first(demonstrations)
        return self
'''


class Installed(Case):
    def setUp(self):
        super().setUp()
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", self.dir / "v"], check=True)
        self.site, = (self.dir / "v/lib").glob("python*/site-packages")
        folder = pathlib.Path(numpy.__file__).parents[1]
        for name in "numpy", "numpy.libs":
            if (folder / name).exists():
                shutil.copytree(folder / name, self.site / name, ignore=shutil.ignore_patterns("tests", "__pycache__"))
        self.mark = self.dir / "mark"

    def install(self, name, entries, files):
        """With pip, from a wheel that is written here."""
        wheel = self.dir / f"{name}-1.0-py3-none-any.whl"
        about = f"{name}-1.0.dist-info"
        files = {**files, f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n",
                 f"{about}/WHEEL": "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
                 f"{about}/entry_points.txt": "[console_scripts]\nother = other:main\n\n[lgabench.methods]\n" + entries}
        with zipfile.ZipFile(wheel, "w") as archive:
            for file, text in files.items():
                archive.writestr(file, text)
            archive.writestr(f"{about}/RECORD", "".join(f"{file},,\n" for file in [*files, f"{about}/RECORD"]))
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--no-compile",
                        "--no-warn-conflicts", "--disable-pip-version-check", "--root-user-action=ignore", "--target", self.site,
                        wheel], check=True, capture_output=True)

    def install_tiny(self, entries="tiny = tiny_methods.method:Tiny\n"):
        self.install("tiny_methods", entries, {
            "tiny_methods/__init__.py": "", "tiny_methods/method.py": METHOD.replace("MARK", repr(str(self.mark))),
            "tiny_methods/actions.py": "def first(demonstrations):\n    return demonstrations[0].steps[0].label\n"})

    def python(self, *words, expect=0):
        """`lgabench` as the package in that environment starts it."""
        done = subprocess.run([self.dir / "v/bin/python", "-m", "lgabench", *map(str, words)], cwd=self.dir, capture_output=True,
                              text=True, timeout=600, env={"PATH": "/usr/bin:/bin", "HOME": str(self.dir), "PYTHONPATH": str(PACKAGES),
                                                           "LGABENCH_CACHE": str(self.dir / "cache")})
        self.assertEqual(done.returncode, expect, done.stderr[-3000:])
        return done

    def listed(self, text):
        return re.findall(r"(?m)^  tiny +(.*)$", text)

    def run_of(self, method, *more, expect=0):
        return self.python("run", "q1", "--scenarios", "heart", "--methods", method, "--engines", ENGINE, "--demos", 2, "--seeds", 0,
                           "--episodes", 2, "--no-reference", *more, expect=expect)

    def test_a_package_is_listed_and_run_and_its_code_runs_in_the_confined_process_alone(self):
        self.install_tiny()
        said = self.python("list")
        self.assertEqual(self.listed(said.stdout), ["0.1  The first demonstration's action."])
        self.assertEqual(said.stderr, "")
        self.assertIn("tiny_methods/method.py", self.python("info", "tiny").stdout)
        self.assertIn("tiny", self.run_of("lga,tiny", "--dry-run").stdout)
        self.run_of("tiny", "--out", "run")
        self.assertFalse(self.mark.exists(), "its code ran where nothing confines it")
        cell, = (self.dir / "run/cells").iterdir()
        build = json.loads(json.loads((cell / "status.json").read_text())["build"]["python"])
        self.assertEqual({name for name in build if name.endswith(".py")},
                         {"tiny_methods/__init__.py", "tiny_methods/actions.py", "tiny_methods/method.py"})
        self.assertEqual(build["tiny_methods"], "1.0")
        self.python("verify", "run", "--all")
        self.run_of("tiny", "--out", "free", "--unconfined")
        self.assertTrue(self.mark.exists(), "that is how it is noticed")
        # A changed module beside the method's makes another run.
        actions = self.site / "tiny_methods/actions.py"
        actions.write_text(actions.read_text() + "\n")
        self.assertIn("python differs", self.run_of("tiny", "--out", "run", expect=2).stderr)

    def test_listing_imports_neither_module_nor_package(self):
        """Which would end the process that reads it; its confinement alone would hide a file that is written."""
        ends = "import os\nos._exit(7)\n"
        self.install("ending", "tiny = ending.method:Tiny\n", {"ending/__init__.py": ends, "ending/method.py": ends + METHOD})
        said = self.python("list")
        self.assertEqual((len(self.listed(said.stdout)), said.stderr), (1, ""))
        self.run_of("tiny", "--dry-run")

    def test_a_folder_is_named_where_no_package_starts_the_program(self):
        self.install_tiny()
        words = ("--python", self.dir / "v/bin/python", "--plugin-path", self.site)
        self.assertEqual(len(self.listed(self.call("list", *words).stdout)), 1)
        self.call("run", "q1", "--scenarios", "heart", "--methods", "tiny", "--engines", ENGINE, "--demos", 2, "--seeds", 0,
                  "--episodes", 2, "--no-reference", "--out", "run", *words)
        self.assertFalse(self.mark.exists())
        self.assertEqual(self.listed(self.call("list").stdout), [])

    def test_what_cannot_be_a_method_is_one_line(self):
        self.install_tiny("tiny = tiny_methods.method:Tiny\nno_module = tiny_methods.gone:Tiny\nno_class = tiny_methods.method:Gone\n"
                          "upwards = ..etc.passwd:Tiny\nno_object = tiny_methods.method\n")
        self.install("zz_other", "tiny = zz_other:Other\nlga = zz_other:Other\n", {"zz_other.py": "class Other:\n    def learn(self): pass\n"})
        said = [line for line in self.python("list").stderr.splitlines() if "entry_points.txt" in line]
        for expected in ("no_module: no module tiny_methods.gone in ", "no_class: .*: no class Gone, it has: Tiny",
                         'upwards: "..etc.passwd:Tiny", expected package.module:Class',
                         'no_object: "tiny_methods.method", expected package.module:Class',
                         "tiny: .*zz_other.py: tiny is also the id of .*tiny_methods/method.py",
                         "lga: .*zz_other.py: lga is also the id of .*lga.so"):
            self.assertEqual(sum(bool(re.search(f"^refused: .*entry_points.txt: {expected}", line)) for line in said), 1,
                             (expected, said))
        self.assertEqual(len(said), 6)
        self.assertIn("no class Gone", self.run_of("no_class", expect=4).stderr)
        self.run_of("tiny", "--dry-run")
        self.assertFalse(self.mark.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
