"""Names read from pictures: the shipped readers in a run, and perceivers as plugins, in C++ and in Python.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 perceiver_test.py Perceivers
"""
import json
import shutil
import unittest

import case
from leaderboard_test import META
from python_test import HAS_NUMPY, PYTHON

READER = case.FIXTURES / "perceivers/fixture_reader.so"
IN_PYTHON = '''
from lgabench_method import Instance
import numpy

class Reader:
    id = "fixture_reader"
    version = "0.1"
    summary = "names every segment alike"

    def read(self, seen, space):
        assert not seen.instances
        for number in numpy.unique(seen.ids):
            if number:
                seen.instances.append(Instance(int(number), space.object_types[0], space.textures[0], 0))
        return seen
'''


class Perceivers(case.Case):
    def setUp(self):
        super().setUp()
        shutil.copy(READER, self.dir)
        (self.dir / "reader.py").write_text(IN_PYTHON)

    def run_names(self, names, *more, out="run", plugin="fixture_reader.so", expect=0):
        return self.call("run", "q1", "--scenarios", "heart", "--methods", "human", "--demos", "2", "--seeds", "0", "--episodes", "4",
                         "--layout", "continuous", "--engines", "kinematic", "--set", "*.policy=centroid", "--names", names,
                         "--plugin-path", plugin, "--python", PYTHON, "--out", out, *more, expect=expect)

    def failure(self, way, *more):
        """Why the cell whose names are read failed; the other one, in the same run, did not."""
        (self.dir / "way").write_text(way)
        self.run_names("simulator,fixture_reader", "--fresh", "--no-reference", *more, expect=3)
        states = {cell.get("names"): status for cell, status in self.cells("run").values()}
        self.assertEqual(states[None]["state"], "ok")
        return states["fixture_reader"]["reason"]

    def test_the_shipped_readers_are_settings_of_a_run(self):
        self.run_names("simulator,read", "--segments", "simulator,difference")
        self.assert_matches_schemas("run")
        cells = [cell for cell, _ in self.cells("run").values()]
        self.assertEqual({cell["method"]["name"] for cell in cells if cell["method"]["kind"] == "method"},
                         {"human", "human+names=read", "human+segments=difference", "human+names=read+segments=difference"})
        self.assertEqual({(cell.get("names"), cell.get("segments")) for cell in cells if cell["method"]["kind"] == "reference"},
                         {(None, None)})
        for cell, status in self.cells("run").values():
            self.assertEqual("reader" in cell["data"], "names" in cell)
            self.assertEqual("liblgabench_seeing.so" in status["build"], bool({"names", "segments"} & set(cell)))
        said = self.call("verify", "run", "--all").stdout
        self.assertEqual(said.count("\nbit-identical "), len(cells), said)
        (self.dir / "me.json").write_text(json.dumps(META))
        done = self.call("leaderboard", "add", "run", "--board", "board", "--entry", "me.json", expect=1)
        self.assertFalse(list(self.dir.glob("board/**/entry.json")), done.stdout)

    def test_a_plugin_reads_and_failures_are_the_readings(self):
        self.run_names("simulator,fixture_reader", "--no-reference")
        self.assert_matches_schemas("run")
        for key, (cell, status) in self.cells("run").items():
            episodes = [json.loads(line) for line in (self.dir / "run/cells" / key / "episodes.jsonl").read_text().splitlines()]
            self.assertEqual(len(episodes), 4)
            if "names" in cell:
                self.assertIn("perceiver fixture_reader", status["build"])
                self.assertNotIn("liblgabench_seeing.so", status["build"])
                self.assertLess(len([e for e in episodes if e["failure"] == "none"]), 4, "nothing is named what the command means")
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertIn(("perceiver", "fixture_reader", "0.1"), [(p["kind"], p["id"], p["version"]) for p in record["plugins"]])
        said = self.call("verify", "run", "--all", "--plugin-path", "fixture_reader.so").stdout
        self.assertEqual(said.count("\nbit-identical "), 2, said)

    def test_nobody_knows_what_one_takes(self):
        said = self.run_names("simulator,read,fixture_reader", "--dry-run").stdout
        self.assertRegex(said, r"\nhuman\+names=fixture_reader +1 +0 +at least .* nobody: what its own plugin takes is unknown\n")
        self.assertRegex(said, r"\nhuman\+names=read +1 +0 +\d.* cells measured elsewhere\n")

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_the_same_reader_in_python_acts_alike(self):
        self.run_names("fixture_reader", "--no-reference", out="library")
        self.run_names("fixture_reader", "--no-reference", out="python", plugin="reader.py:Reader")
        texts = [next((self.dir / run).glob("cells/*/episodes.jsonl")).read_text() for run in ("library", "python")]
        self.assertEqual(*texts)

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_new_one_in_python(self):
        self.call("new-plugin", "my_eyes", "--kind", "perceiver", "--language", "python", "--directory", "eyes")
        report = json.loads(self.call("check-plugin", "eyes/my_eyes.py:MyEyes", "--python", PYTHON, "--json").stdout)
        self.assertEqual(self.noted(report), {"names, tabletop", "names, mobile"}, "a new one gives all objects one name")
        self.run_names("my_eyes", "--no-reference", plugin="eyes/my_eyes.py:MyEyes")
        self.assertEqual({status["state"] for _, status in self.cells("run").values()}, {"ok"})

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_wrong_reply_in_python_names_its_function(self):
        (self.dir / "reader.py").write_text(IN_PYTHON.replace("return seen", "return seen.instances"))
        self.run_names("fixture_reader", "--no-reference", plugin="reader.py:Reader", expect=3)
        (_, status), = self.cells("run").values()
        self.assertIn("read() returned list, expected a lgabench_method.Observation", status["reason"])

    def noted(self, report):
        """Which checks have a note; none has a problem."""
        self.assertEqual([one for one in report["findings"] if one["state"] == "problem"], [])
        return {one["check"] for one in report["findings"] if one["state"] == "note"}

    def test_what_fails_costs_its_own_cell(self):
        for way, reason in (("throws", "fixture_reader (perceiver): its own failure"), ("crashes", "signal 11 (Segmentation fault)"),
                            ("wrong size", "read() returned 3 bytes of rgb and 32768 of ids, expected 98304 and 32768"),
                            ("unknown id", "ids: 200, expected 0 or the id of an instance"), ("unknown name", 'no texture "of glass"'),
                            ("two names", "expected each once, and not 0"), ("truth", "scenario: EACCES")):
            with self.subTest(way):
                self.assertIn(reason, self.failure(way))

    def test_one_that_hangs_is_stopped(self):
        self.assertEqual(self.failure("hangs", "--timeout", "5"),
                         "stopped after 5 s in phase demonstrate: plugin fixture_reader (perceiver) did not answer")

    def test_one_that_takes_all_memory_is_named(self):
        self.assertEqual(self.failure("allocates", "--memory", ".5"), "plugin fixture_reader (perceiver): out of memory (the limit is --memory)")

    def test_what_there_is_not_is_refused_in_a_line(self):
        said = self.run_names("raed", "--dry-run", expect=2).stderr
        self.assertIn('no names or perceiver "raed" (did you mean "read"?)', said)
        self.assertIn("expected \"simulator\" or \"difference\"", self.run_names("read", "--segments", "x", "--dry-run", expect=2).stderr)

    def test_check_plugin_finds_it(self):
        good = json.loads(self.call("check-plugin", "fixture_reader.so", "--json").stdout)
        self.assertEqual(self.noted(good), {"names, tabletop", "names, mobile"}, "it gives all objects one name")
        said = self.call("check-plugin", "fixture_reader.so", "--environment", "tabletop").stdout
        self.assertRegex(said, r"note +names, tabletop +0 of \d+ objects as the simulator names them; one name for all would be right for [1-9]")
        self.assertTrue(said.endswith("\nno problem, 1 note: see above\n"), said)
        for way, check, detail in (("changes", "read, tabletop", "has other names"), ("unknown name", "read, tabletop", "of glass"),
                                   ("crashes", "process", "signal 11")):
            (self.dir / "way").write_text(way)
            report = json.loads(self.call("check-plugin", "fixture_reader.so", "--environment", "tabletop", "--json", expect=1).stdout)
            found = {finding["check"]: finding for finding in report["findings"] if finding["state"] == "problem"}
            self.assertIn(detail, found[check]["detail"])

    def test_scores_without_a_policy(self):
        said = self.call("select", "--suite", "q2", "--score", "--names", "simulator,read", "--scenes", "1", "--json").stdout
        rows = [json.loads(line) for line in said.splitlines()]
        for row in rows:
            if row["names"] == "simulator":
                self.assertEqual(row["types_right"], row["objects"])
                if row["arm"] != "hard":  # a later letter belongs to the Selection, and is not meant
                    self.assertEqual(row["exact_scenes"], row["scenes"])
        read = [row for row in rows if row["names"] == "read"]
        self.assertGreater(sum(row["textures_right"] for row in read), .9 * sum(row["objects"] for row in read))
        self.assertIn("and no plugin's", self.call("select", "--suite", "q2", "--score", "--names", "mine", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
