"""Perturbation axes as plugins, in C++ and in Python: what they change, what becomes of a bad one, and who ranks it.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 axis_test.py PluginAxes
"""
import json
import unittest

import case
from leaderboard_test import META
from python_test import EXAMPLES, HAS_NUMPY, PYTHON

AXIS = case.FIXTURES / "perturbations/fixture_axis.so"
IN_PYTHON = '''
from dataclasses import replace
import numpy

class Axis:
    id = "fixture_axis"
    version = "0.1"
    summary = "the rule of the fixture's first level"
    levels = ["as it should", "dead", "leaking", "throwing", "a picture of floats", "an id of nothing"]
    changes = ["rgb"]
    named = True

    def perceive(self, seen, level, stream):
        if level == 2:
            return seen
        if level == 4:
            raise RuntimeError("its own failure")
        more = 1 + (30 * stream.uniform(size=len(seen.rgb))).astype(int)
        rgb = numpy.minimum(255, seen.rgb + more[:, None, None])
        if level == 3:
            seen.ids[seen.ids > 0] = 0
        if level == 6:
            seen.ids[0, 0] = 200
        return replace(seen, rgb=rgb if level == 5 else rgb.astype(numpy.uint8))
'''


class PluginAxes(case.Case):
    def setUp(self):
        super().setUp()
        self.own = json.loads((case.BUILD / "share/lgabench/suites/perturbations.json").read_text())
        (self.dir / "fog.py").write_text(IN_PYTHON)

    def suite(self, *lines, name="mine", **members):
        """A suite of `heart` and another scenario, which does not play the lines' axes."""
        scenarios = ["heart", "tiger_colored_object"]
        lines = [{"except": scenarios[1:], **line} for line in lines]
        suite = {**self.own, "id": name, "presets": {}, "scenes": {}, "paraphrases": {}, "answers": {}, "scenarios": scenarios,
                 "methods": ["lga"], "demonstrations": [2], "seeds": [0], "episodes": 2, "perturbations": lines, **members}
        (self.dir / f"{name}.json").write_text(json.dumps(suite))
        return f"{name}.json"

    def run_axis(self, level, *more, out="run", plugin=AXIS, expect=0):
        return self.call("run", self.suite({"axis": "fixture_axis", "levels": [level]}), "--plugin-path", plugin, "--python", PYTHON,
                         "--no-reference", "--set", "lga.epochs=2", "--out", out, *more, expect=expect)

    def hashes(self, run):
        """(arm, index) -> what perturbed.jsonl says of that episode."""
        (file,) = (self.dir / run).glob("cells/*/perturbed.jsonl")
        return {(e["arm"], e["index"]): e for e in map(json.loads, file.read_text().splitlines())}

    def failure(self, level, *more, **options):
        """Why the cell failed; the other scenario's, in the same run, did not."""
        self.run_axis(level, *more, expect=3, **options)
        states = {cell["scenario"]["id"]: status for cell, status in self.cells("run").values()}
        self.assertEqual(states["tiger_colored_object"]["state"], "ok")
        self.assertEqual((states["heart"]["state"], states["heart"]["fault"]), ("failed", "plugin"))
        self.assertIn("fixture_axis (perturbation", states["heart"]["reason"])
        return states["heart"]["reason"]

    def test_it_is_an_axis_like_any_other(self):
        said = self.run_axis(1, "--tables").stdout
        self.assertIn("Axes of plugins, under which no leaderboard ranks a row: fixture_axis 0.1.", said)
        self.assert_matches_schemas("run")
        seen = self.hashes("run")
        for index in range(2):
            control, arm = seen["control", index], seen["fixture_axis_1", index]
            self.assertEqual({part for part in control if control[part] != arm[part]} - {"arm", "axis", "level", "read"},
                             {"rgb", "input"})
        (status,) = [status for cell, status in self.cells("run").values() if "axes" in cell["scenario"]]
        self.assertIn("perturbation fixture_axis", status["build"])
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertIn(("perturbation", "fixture_axis", "0.1"), [(p["kind"], p["id"], p["version"]) for p in record["plugins"]])
        self.call("report", "run")  # which needs no plugin
        curves = json.loads((self.dir / "run/summary.json").read_text())["perturbations"]
        self.assertEqual([(c["axis"], c["named"], [level["name"] for level in c["levels"]]) for c in curves],
                         [("fixture_axis", True, ["as it should"])])
        said = self.call("verify", "run", "--all", "--plugin-path", AXIS).stdout
        self.assertEqual(said.count("\nbit-identical "), 2, said)
        self.assertIn('no perturbation "fixture_axis"', self.call("verify", "run", "--all", expect=4).stderr)

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_the_same_rule_in_python_gives_the_same_pictures(self):
        self.run_axis(1, out="library")
        self.run_axis(1, out="python", plugin="fog.py:Axis")
        self.assert_matches_schemas("python")
        self.assertEqual(self.hashes("library"), self.hashes("python"))
        said = self.call("verify", "python", "--all", "--plugin-path", "fog.py:Axis", "--python", PYTHON).stdout
        self.assertEqual(said.count("\nbit-identical "), 2, said)

    def test_an_axis_that_is_not_as_it_declares_fails_its_cell(self):
        self.assertIn("at level 2: rgb equals the control's in 2 of 2 episodes, though the axis declares a change",
                      self.failure(2))
        self.assertIn("at level 3: ids differs from the control's in episode 0, which the axis does not declare",
                      self.failure(3, "--fresh"))

    def test_what_fails_costs_its_own_cell(self):
        for level, reason in ((4, "level 4): its own failure"), (5, "level 5): signal 11 (Segmentation fault)"),
                              (7, "level 7): perceive() returned 3 bytes of rgb and 32768 of ids, expected 98304 and 32768"),
                              (8, "level 8): ids: 200, expected 0 or the id of an instance"),
                              (9, 'level 9): instance ')):
            self.assertIn(reason, self.failure(level, "--fresh"))

    def test_one_that_hangs_is_stopped(self):
        self.run_axis(6, "--timeout", "5", expect=3)
        reasons = {cell["scenario"]["id"]: status.get("reason") for cell, status in self.cells("run").values()}
        self.assertEqual(reasons, {"heart": "stopped after 5 s in phase evaluate: plugin fixture_axis (perturbation) did not answer", "tiger_colored_object": None})

    def test_it_reaches_neither_scenarios_nor_the_method(self):
        self.assertIn("scenario: EACCES, the method's directory: EACCES", self.failure(10))

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_what_fails_in_python(self):
        for level, reason in ((2, "though the axis declares a change"), (3, "ids differs"), (4, "RuntimeError: its own failure (fog.py:17)"),
                              (5, "perceive() returned rgb as int64 of shape (128, 256, 3), expected uint8 of shape (128, 256, 3)"),
                              (6, "ids: 200, expected 0 or the id of an instance")):
            self.assertIn(reason, self.failure(level, "--fresh", plugin="fog.py:Axis"))

    def test_what_there_is_not_is_refused_in_a_line(self):
        suite = self.suite({"axis": "fixture_axi", "levels": [1]})
        said = self.call("run", suite, "--dry-run", "--plugin-path", AXIS, expect=2).stderr
        self.assertIn('mine.json: /perturbations/0: no axis "fixture_axi" (did you mean "fixture_axis"?)', said)
        suite = self.suite({"axis": "moon", "levels": [1]})
        said = self.call("run", suite, "--dry-run", "--plugin-path", AXIS, expect=2).stderr
        self.assertIn('no axis "moon", expected one of: distractors, ', said)
        self.assertIn("selection_errors, fixture_axis, all", said)
        suite = self.suite({"axis": "fixture_axis", "levels": [11]})
        self.assertIn("expected a level from 1 to 10 (as it should; dead; ",
                      self.call("run", suite, "--dry-run", "--plugin-path", AXIS, expect=2).stderr)
        self.assertIn('no axis "fixture_axis"', self.call("run", suite, "--dry-run", expect=2).stderr)
        self.assertIn("expected an axis that changes only the observation",
                      self.call("run", "q1", "--dry-run", "--plugin-path", AXIS, "--train-on", "fixture_axis:1", expect=2).stderr)

    def test_the_axis_of_another_version_is_refused(self):
        self.run_axis(1)
        for file in self.dir.glob("run/cells/*/cell.json"):
            file.chmod(0o644)
        other = IN_PYTHON.replace('version = "0.1"', 'version = "0.2"')
        (self.dir / "fog.py").write_text(other)
        said = self.call("verify", "run", "--all", "--plugin-path", "fog.py:Axis", "--python", PYTHON, expect=1)
        self.assertIn("declares", said.stdout + said.stderr)

    def test_it_is_listed(self):
        for plugin in (AXIS, "fog.py:Axis") if HAS_NUMPY else (AXIS,):
            self.assertIn("fixture_axis", self.call("list", "perturbations", "--plugin-path", plugin, "--python", PYTHON).stdout.split())
        said = self.call("info", "fixture_axis", "--plugin-path", AXIS).stdout
        self.assertIn("fixture_axis 0.1, a perturbation", said)
        self.assertIn("level 2     dead", said)
        self.assertIn("changes     rgb", said)
        self.assertIn("sensor_noise, a perturbation axis", self.call("info", "sensor_noise").stdout)

    def test_check_plugin_says_what_is_wrong(self):
        report = json.loads(self.call("check-plugin", AXIS, "--environment", "tabletop", "--json", expect=1).stdout)
        found = {finding["check"]: (finding["state"], finding["detail"]) for finding in report["findings"]}
        self.assertEqual(found["process"][0], "problem")  # which level 5 ends
        self.assertIn("signal 11", found["process"][1])
        if HAS_NUMPY:
            report = json.loads(self.call("check-plugin", "fog.py:Axis", "--python", PYTHON, "--environment", "tabletop", "--json",
                                          expect=1).stdout)
            found = {finding["check"]: (finding["state"], finding["detail"]) for finding in report["findings"]}
            self.assertEqual(found["level 1, tabletop"][0], "ok")
            self.assertEqual(found["level 2, tabletop"], ("problem", "rgb is declared and changes in only 0 of 20 scenes"))
            self.assertEqual(found["level 3, tabletop"], ("problem", "ids changes and is not declared"))
            self.assertEqual(found["level 4, tabletop"], ("problem", "RuntimeError: its own failure (fog.py:17)"))
            self.assertEqual(found["two processes"][0], "ok")

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_new_one_in_python(self):
        self.call("new-plugin", "rain", "--kind", "perturbation", "--language", "python", "--directory", "rain")
        for file in ("rain/rain.py:Rain", EXAMPLES / "lens_drop.py:LensDrop")[:2 if case.FULL else 1]:
            report = json.loads(self.call("check-plugin", file, "--python", PYTHON, "--json").stdout)
            self.assertEqual({finding["state"] for finding in report["findings"]}, {"ok"}, report)
        self.call("run", "rain/rain_suite.json", "--plugin-path", "rain/rain.py:Rain", "--python", PYTHON, "--methods", "lga",
                  "--episodes", "2", "--no-reference", "--set", "lga.epochs=2", "--out", "run")
        self.assertIn("an engine is in C++", self.call("new-plugin", "x", "--kind", "engine", "--language", "python", expect=2).stderr)

    def test_no_leaderboard_takes_its_rows(self):
        self.run_axis(1)
        (self.dir / "me.json").write_text(json.dumps(META))
        done = self.call("leaderboard", "add", "run", "--board", "board", "--entry", "me.json", expect=1)
        self.assertIn("arms under an axis of a plugin (fixture_axis), which no leaderboard ranks", done.stdout + done.stderr)
        self.assertFalse(list(self.dir.glob("board/**/entry.json")))


if __name__ == "__main__":
    unittest.main()
