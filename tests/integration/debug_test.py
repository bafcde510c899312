"""What an author sees of a method that fails, and how to look into it: the terminal's lines, backtraces in the log, and
run --debug.

One CTest entry a class. In Python where the interpreter has NumPy (LGABENCH_TEST_PYTHON names one).
"""
import shutil
import subprocess
import unittest

from case import Case, FIXTURES, command_line
from python_test import HAS_NUMPY, PYTHON

RUN = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "2", "--no-reference",
       "--plugin-path", FIXTURES / "good", "--plugin-path", FIXTURES / "faulty", "--python", PYTHON]
METHOD = '''
import os
from lgabench_method import Needs, Selection

class Mine:
    options = {"how": {"default": "", "help": "what it does", "source": "test"}}

    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        if services.options["how"] == "abort":
            print("the last line")
            os.abort()
        if services.options["how"] == "stop":
            answer = 6 * 7
            breakpoint()
        return Selection()

    def learn(self, demonstrations, services):
        return self

    def act(self, observation, instruction):
        raise ValueError("its own | failure\\nin two lines")
'''


class Authors(Case):
    def log(self, key, run="out"):
        return (self.dir / run / "cells" / key / "log.txt").read_text()

    def debug(self, key, typed, *methods, expect=0):
        """What a person sees who types that."""
        done = subprocess.run(command_line(*RUN, "--methods", *methods, "--debug", key), input=typed, capture_output=True,
                              text=True, env=self.environment, cwd=self.dir, timeout=120)
        self.assertEqual(done.returncode, expect, done.stdout[-3000:] + done.stderr[-3000:])
        self.assertFalse((self.dir / "runs").exists())
        return done.stdout + done.stderr

    def keys(self, *methods):
        """The keys that --debug prints where it is given none, of the methods' cells."""
        said = self.debug("list", "", *methods, expect=2)
        return [line.split()[0] for line in said.splitlines() if line.startswith("  ")]


class Debugging(Authors):
    def test_an_act_that_fails_is_said(self):
        done = self.call(*RUN, "--methods", "fixture_constant,fixture_throw", "--out", "out")
        key, = (key for key, (cell, _) in self.cells("out").items() if cell["method"]["id"] == "fixture_throw")
        self.assertIn("2 of 2 episodes of fixture_throw are method_error: plugin fixture_throw: the fixture's own failure "
                      f"(out/cells/{key}/log.txt)", done.stdout)
        self.assertEqual(done.stdout.count("are method_error"), 1)
        self.assertRegex(done.stdout, r"fixture_throw +0.00 \[0.00, 0...\]!")
        self.assertIn("episode 0 of test: plugin fixture_throw: the fixture's own failure", self.log(key))
        self.assert_matches_schemas("out")
        self.assertIn("are method_error", self.call("report", "out").stdout)

    def test_a_crash_leaves_a_backtrace(self):
        self.call(*RUN, "--methods", "fixture_segfault,fixture_faulty+where=act+how=print", "--out", "out", expect=3)
        key, = (key for key, (cell, _) in self.cells("out").items() if cell["method"]["id"] == "fixture_segfault")
        self.assertRegex(self.log(key), r"(?s)lgabench-method crashed.*fixture_segfault.so\(.*lgabench-method\(")

    def test_a_key_names_one_cell(self):
        self.assertEqual(len({*self.keys("fixture_segfault,fixture_throw")}), 2)
        self.assertIn("0 of the run's cell keys begin so", self.debug("0" * 16, "", "fixture_throw", expect=2))

    def test_without_gdb(self):
        key, = self.keys("fixture_segfault")
        self.environment["PATH"] = str(self.dir)
        self.assertRegex(self.debug(key, "", "fixture_segfault", expect=2),
                         r"gdb is not installed .*\n  gdb -q -ex 'set breakpoint pending on' --args /.*/lgabench-method")

    @unittest.skipUnless(shutil.which("gdb"), "gdb is not installed")
    def test_gdb(self):
        key, = self.keys("fixture_throw")
        said = self.debug(key[:6], "break __cxa_throw\nrun\nbacktrace\nkill\nquit\n", "fixture_throw", expect=3)
        if "ptrace" in said:
            self.skipTest("no process may be traced here")
        self.assertRegex(said, r"#\d+ .*fixture_throw.so|P::act")
        self.assertIn("no result is kept", said)
        said = self.debug(key, "run\nquit\n", "fixture_throw")
        self.assertIn("exited normally", said)


@unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
class PythonDebugging(Authors):
    def setUp(self):
        super().setUp()
        (self.dir / "mine.py").write_text(METHOD)

    def test_an_act_that_fails_is_said(self):
        done = self.call(*RUN, "--methods", "mine.py:Mine", "--out", "out")
        key, = self.cells("out")
        line = (self.dir / "mine.py").read_text().split("raise ValueError")[0].count("\n") + 1
        self.assertIn("2 of 2 episodes of mine are method_error: plugin mine: ValueError: its own | failure "
                      f"(mine.py:{line}) (out/cells/{key}/log.txt)", done.stdout)
        self.assertIn("in act\n    raise ValueError", self.log(key))
        self.assertIn("its own \\| failure", (self.dir / "out/report.md").read_text())

    def test_a_crash_leaves_a_traceback(self):
        self.call(*RUN, "--methods", "mine.py:Mine+how=abort", "--out", "out", expect=3)
        key, = self.cells("out")
        self.assertRegex(self.log(key), r"(?s)the last line\n.*Aborted.*mine.py\", line \d+ in select")

    def test_breakpoint(self):
        key, = self.keys("mine.py:Mine+how=stop")
        said = self.debug(key, "p answer\ncontinue\n", "mine.py:Mine+how=stop")
        self.assertIn("(Pdb) 42", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
