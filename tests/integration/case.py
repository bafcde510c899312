"""What the integration tests share: the built programs, called in a directory of their own, and what they leave there.

LGABENCH_BUILD names the build tree, LGABENCH_TEST_ENGINE the engine that ./test --full plays on where a test does not say.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import json_schema

BUILD = pathlib.Path(os.environ["LGABENCH_BUILD"])
PROGRAM = BUILD / "bin" / "lgabench"
FULL = os.environ.get("LGABENCH_FULL") == "1"
PHYSICS = os.environ["LGABENCH_TEST_ENGINE"]
if not FULL:  # the engine that takes least time, but where a test names one: what engines do has tests of its own
    os.environ["LGABENCH_TEST_ENGINE"] = "kinematic"
FIXTURES = BUILD / "tests" / "plugins"
ENGINE = {verb: (flag, os.environ["LGABENCH_TEST_ENGINE"]) for verb, flag in (("run", "--engines"), ("demos", "--engine"))}
NO_CLOCK = ("cell.json", "selection.json", "training.jsonl", "episodes.jsonl")


def command_line(*arguments):
    """The program's command line. Where a test names no engine, it is the one under test: MuJoCo may not be built."""
    words = [*map(str, arguments)]
    flag, engine = ENGINE.get(words[0] if words else "", (None, "mujoco"))
    if words[1:2] == ["perturbations"]:  # of friction too
        engine = PHYSICS
    return [PROGRAM, *words] + ([flag, engine] if engine != "mujoco" and flag not in words else [])


def some_of(words):
    """The first and the last of them, which stand for the others but in ./test --full."""
    words = list(words)
    return words if FULL else words[:1] + words[1:][-1:]


def with_options(words, *more):
    """The words and `more`, whose options (of one value each) take the place of those that are there."""
    kept, words = [], list(words)
    while words:
        word = words.pop(0)
        if word in more and str(word).startswith("--"):
            words.pop(0)
        else:
            kept.append(word)
    return [*kept, *more]


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-test-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)
        self.environment = dict(os.environ, LGABENCH_CACHE=str(self.dir / "cache"), TMPDIR=str(self.dir))

    def call(self, *arguments, expect=0, timeout=300, **more):
        done = subprocess.run(command_line(*arguments), capture_output=True, text=True, env=self.environment,
                              cwd=self.dir, timeout=timeout, **more)
        self.assertEqual(done.returncode, expect, done.stderr[-3000:])
        return done

    def start(self, *arguments):
        process = subprocess.Popen(command_line(*arguments), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, env=self.environment, cwd=self.dir)
        self.addCleanup(process.stderr.close)
        return process

    def cells(self, run):
        """key -> (cell, status) of every finished cell."""
        return {path.name: tuple(json.loads((path / name).read_text()) for name in ("cell.json", "status.json"))
                for path in (self.dir / run / "cells").iterdir() if not path.name.startswith(".")}

    def results(self, run):
        """All bytes that must not depend on how the run went."""
        bytes_of = {f"{path.name}/{name}": (path / name).read_bytes()
                    for path in (self.dir / run / "cells").iterdir() for name in NO_CLOCK if (path / name).exists()}
        for name in ("summary.json", "summary.csv"):
            bytes_of[name] = (self.dir / run / name).read_bytes()
        return bytes_of

    def assert_same_results(self, run, other):
        a, b = self.results(run), self.results(other)
        self.assertEqual(sorted(a), sorted(b))
        self.assertEqual([name for name in a if a[name] != b[name]], [])

    def assert_matches_schemas(self, run):
        done = subprocess.run([BUILD / "bin" / "schema_check", self.dir / run], capture_output=True, text=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)

    def assert_as_schema(self, name, document):
        """As docs/formats/NAME.schema.json says, which knows each of its members."""
        schema = json.loads((BUILD / f"share/lgabench/formats/{name}.schema.json").read_text())
        self.assertEqual(json_schema.complaints(document, schema), [])


def read_entry(file):
    """A board's entry.json in its long form, which `leaderboard` reads as well."""
    entry = json.loads(file.read_text())
    said = entry.pop("said", [])

    def value(one):
        return said[one] if isinstance(one, int) else one

    def whole(part):
        if isinstance(part, dict):
            return {name: one if name == "cost" else whole(one) for name, one in part.items()}
        return [whole(one) for one in part] if isinstance(part, list) else value(part)

    for scenario, lists in entry["phi"].items():
        entry["phi"][scenario] = [[{**command, "selection": whole(value(command["selection"])), "quality": value(command["quality"])}
                                   for command in map(value, one)] for one in lists]
    return entry


class BesideOneRun(Case):
    """Cases whose class plays one run first, which they copy or compare with."""
    run_of_class = ()

    @classmethod
    def setUpClass(cls):
        cls.first = cls()
        cls.first.setUp()
        cls.addClassCleanup(cls.first.doCleanups)
        cls.first.call(*cls.run_of_class, "--out", "run")

    def runTest(self):  # without it `first` could not be made
        pass

    def copy_first(self, run):
        """Puts a copy of the class's run in this test's directory, in place of what is there, on the class's cache."""
        shutil.rmtree(self.dir / run, ignore_errors=True)
        shutil.copytree(self.first.dir / "run", self.dir / run)
        self.environment["LGABENCH_CACHE"] = str(self.first.dir / "cache")
