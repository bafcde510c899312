"""Environments that are plugins: examples/reach2d, found by --plugin-path, beside runs of lgabench's own environments.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 environment_test.py PluginEnvironments
"""
import json
import pathlib
import shutil
import unittest

from case import BUILD, Case

SOURCE = pathlib.Path(__file__).resolve().parents[2] / "examples/reach2d"
PLUGIN = BUILD / "tests/plugins/examples/reach2d.so"
TABLETOP = ("run", "q1", "--scenarios", "heart", "--layout", "cells", "--methods", "human", "--demos", "2", "--seeds", "0", "--episodes", "2",
            "--set", "*.epochs=2", "--no-reference", "--out", "tabletop")


class PluginEnvironments(Case):
    def setUp(self):
        super().setUp()
        self.environment["LGABENCH_SCENARIO_PATH"] = str(SOURCE)
        self.plugins = self.dir / "plugins"
        self.plugins.mkdir()

    def installed(self):
        return shutil.copy(PLUGIN, self.plugins)

    def run_suite(self, *more, expect=0):
        return self.call("run", str(SOURCE / "reach2d_suite.json"), "--answers", "none", "--methods", "human", "--demos", "1", "--seeds", "0",
                         "--episodes", "2", "--set", "human.epochs=1", "--engines", "own", "--out", "run", *more, expect=expect)

    def test_one_is_run_reported_replayed_and_verified_by_its_path(self):
        path = ("--plugin-path", self.installed())
        self.run_suite(*path)
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertIn(("environment", "reach2d"), {(plugin["kind"], plugin["id"]) for plugin in record["plugins"]})
        builds = [json.loads(file.read_text())["build"] for file in self.dir.glob("run/cells/*/status.json")]
        self.assertTrue(builds)
        for build in builds:
            self.assertEqual([name for name in build if "env" in name], ["environment reach2d"])
        self.assertIn("identical", self.call("verify", "run", *path).stdout)
        cell = next(self.dir.glob("run/cells/*/episodes.jsonl")).parent.name
        self.call("replay", "run", f"{cell}/test/0", *path, "--out", "episode.png")
        said = self.call("info", "reach2d", *path).stdout
        for words in ("reach_blind", "steps       20 at most", "state       down  -0.5 to 0.5", "spaces      tabletop", "picture     "):
            self.assertIn(words, said)
        self.assertNotRegex(said, r"failures *\n")
        self.assertIn("reach2d", self.call("list", "environments", "--short", *path).stdout)

    def test_one_without_an_engine_plugin_says_so(self):
        path = ("--plugin-path", self.installed())
        self.run_suite(*path)
        for file in self.dir.glob("run/cells/*/cell.json"):
            self.assertEqual(json.loads(file.read_text())["engine"], "own")
        for file in self.dir.glob("run/cells/*/status.json"):
            self.assertNotIn("engine", json.loads(file.read_text())["build"])
        self.assertNotIn("engine", {plugin["kind"] for plugin in json.loads((self.dir / "run/run.json").read_text())["plugins"]})
        self.assertIn("own: no engine plugin", self.call("info", "reach2d", *path).stdout)
        for words, reason in ((("run", str(SOURCE / "reach2d_suite.json"), "--answers", "none", "--engines", "kinematic"), "reach2d has no engine plugin: expected own"),
                              (("demos", "reach2d_red", "--engine", "kinematic", "--out", "a.hdf5"), "reach2d has no engine plugin: expected own"),
                              (("run", "q1", "--engines", "own"), "environment tabletop needs an engine plugin")):
            said = self.call(*words, *path, expect=2).stderr
            self.assertIn(reason, said)
            self.assertEqual(said.count("\n"), 1)

    def test_axes_of_an_engine_are_refused_without_one(self):
        path = ("--plugin-path", self.installed())
        for axis in ("friction_mass", "object_size"):
            scenario = json.loads((SOURCE / "reach2d_red.json").read_text())
            scenario["id"] = "own"
            scenario["tests"].append({"arm": "changed", "perturbation": {axis: 1}})
            (self.dir / "own.json").write_text(json.dumps(scenario))
            said = self.call("check-scenario", "own.json", *path, expect=2).stderr
            self.assertIn(f"{axis}: expected an environment with an engine plugin, reach2d has none", said)

    def test_a_board_of_ones_own_suite_in_ones_own_environment(self):
        path = ("--plugin-path", self.installed())
        shutil.copytree(SOURCE, self.dir / "mine")
        self.environment["LGABENCH_SCENARIO_PATH"] = str(self.dir / "mine")
        suite = json.loads((SOURCE / "reach2d_suite.json").read_text())
        suite["presets"] = {"board": {"demonstrations": [1], "episodes": 4, "scene_seed": 5}}
        (self.dir / "mine/reach2d_suite.json").write_text(json.dumps(suite))
        (self.dir / "me.json").write_text(json.dumps({"by": "A. Author", "authors": ["A. Author"], "license": "Apache-2.0",
                                                      "source": {"repository": "https://example.org/a", "commit": "0" * 40}}))
        self.call("run", "reach2d_suite", "--preset", "board", "--answers", "none", "--engines", "own", "--no-reference", "--out", "run", *path)
        added = self.call("leaderboard", "add", "run", "--entry", "me.json", "--board", "board", *path).stdout
        self.assertIn("added entries/human/", added)
        file, = self.dir.glob("board/entries/human/*/*/entry.json")
        entry = json.loads(file.read_text())
        self.assertEqual(entry["identity"]["engine"], {"id": "own", "version": "0.1"})
        self.assertEqual([(one["kind"], one["id"]) for one in entry["evidence"][0]["plugins"]], [("environment", "reach2d"), ("method", "human")])
        board = ("--board", "board", *path)
        self.assertIn("2 of 2 cells bit-identical", self.call("leaderboard", "verify", entry["id"], "--by", "B", *board).stdout)
        self.call("leaderboard", "vouch", entry["id"], "1", *board)
        self.call("leaderboard", "build", *board)
        self.assertIn("1 entry, 0 problems", self.call("leaderboard", "check", *board).stdout)
        self.assertIn("| replayed; the truth stands in for people |", (self.dir / "board/README.md").read_text())
        said = self.call("leaderboard", "verify", entry["id"], "--by", "B", "--board", "board", expect=2)
        self.assertIn("reach2d", said.stdout + said.stderr, "not without the environment")
        self.environment["LGABENCH_SCENARIO_PATH"] = ""
        self.assertRegex(self.call("run", "reach2d_suite", *path, expect=2).stderr, 'no suite "reach2d_suite", expected one of')

    def test_a_report_needs_none(self):
        self.run_suite("--plugin-path", self.installed())
        before = (self.dir / "run/summary.csv").read_text()
        (self.plugins / PLUGIN.name).unlink()
        self.call("report", "run")
        self.assertEqual((self.dir / "run/summary.csv").read_text(), before)
        said = self.call("verify", "run", expect=2).stderr
        self.assertIn('no environment "reach2d"', said)
        self.assertEqual(said.count("\n"), 1)

    def test_a_run_goes_on_after_one_was_installed_and_computes_nothing_again(self):
        self.call(*TABLETOP)
        finished = {file: file.stat().st_mtime_ns for file in self.dir.glob("tabletop/cells/*/status.json")}
        self.installed()
        self.environment["LGABENCH_PLUGIN_PATH"] = str(self.plugins)
        self.call(*TABLETOP, "--resume")
        self.assertEqual({file: file.stat().st_mtime_ns for file in self.dir.glob("tabletop/cells/*/status.json")}, finished)

    def test_a_broken_one_is_a_line_and_an_error_where_its_id_is_used(self):
        broken = self.plugins / PLUGIN.name
        broken.write_bytes(PLUGIN.read_bytes()[:5000])
        self.environment["LGABENCH_PLUGIN_PATH"] = str(self.plugins)
        listed = self.call("list")
        self.assertIn("tabletop", listed.stdout)
        self.assertRegex(listed.stderr, "refused: .*reach2d.so: cut off")
        self.call(*TABLETOP)
        said = self.run_suite(expect=2).stderr
        self.assertRegex(said, 'no environment "reach2d".*reach2d.so was refused: cut off')
        self.assertEqual(said.count("\n"), 1)

    def test_an_id_of_lgabenchs_own_is_refused(self):
        self.assertIn("which an environment that lgabench finds has", self.call("new-plugin", "mobile", "--kind", "environment", expect=2).stderr)

    def test_a_run_that_names_a_file_opens_none(self):
        """Who sends a run would choose what its reader runs."""
        self.run_suite("--plugin-path", self.installed())
        said = self.call("verify", "run", expect=2).stderr  # the file is there, and nobody names it
        self.assertIn('no environment "reach2d"', said)


if __name__ == "__main__":
    unittest.main()
