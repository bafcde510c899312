"""Methods that mean harm, as plugins and in Python: each ends as a cell of its own, well or failed, nothing else changes,
and nothing survives (docs/trust.md).

One CTest entry a class. In Python where the interpreter has NumPy (LGABENCH_TEST_PYTHON names one).
"""
import hashlib
import json
import pathlib
import re
import shutil
import time
import unittest

from case import Case, FIXTURES, with_options
from python_test import HAS_NUMPY, PYTHON

HOSTILE = pathlib.Path(__file__).parents[1] / "bad_plugins/python/hostile.py"
RUN = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "3", "--no-reference",
       "--memory", ".5", "--timeout", "60", "--python", PYTHON, "--plugin-path", FIXTURES / "good", "--plugin-path",
       FIXTURES / "faulty"]
# What it tries -> the reason that its cell fails for; None where the cell goes well, as an honest one.
KINDS = {"": None, "rounding": None, "others": None, "link": None, "directory_link": None, "daemon": None, "fork": None,
         "flood": None, "descriptors": None, "shared_memory": "out of memory",
         "processes": "it had more than 1000 processes and threads", "threads": "it had more than 1000 processes and threads",
         "kill": r"signal 9 \(Killed\) in phase learn",
         "people": "expected a method declared as", "spoof": "sent a malformed frame", "input_error": "the disk is full",
         "exit_4": "exited with 4 in phase learn", "epoch": "training log: /epoch: expected a whole number from 1"}


class Harm(Case):
    def setUp(self):
        super().setUp()
        self.writers = ["fixture_hostile"]
        if HAS_NUMPY:
            for file in HOSTILE, FIXTURES / "faulty/many":
                shutil.copy(file, self.dir)
            self.writers.append("hostile.py:Hostile")

    def row(self, writer, how):
        return f"{writer}+how={how}+run={self.dir}/out+cache={self.dir}/cache" if how else writer

    def assert_nothing_survives(self):
        mark, deadline = f"HOME={self.dir}/".encode(), time.monotonic() + 10
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                while mark in (process / "environ").read_bytes():
                    self.assertLess(time.monotonic(), deadline, f"{process} outlived its run")
                    time.sleep(.01)
            except OSError:
                pass  # it is gone, or another user's


class Hostile(Harm):
    @staticmethod
    def bytes_of(directory):
        return {path.relative_to(directory): path.read_bytes() for path in directory.rglob("*") if path.is_file()}

    def test_each_costs_its_own_cell_alone(self):
        self.call(*RUN, "--methods", "fixture_constant,fixture_hostile", "--out", "alone")
        honest = {cell["method"]["id"]: key for key, (cell, _) in self.cells("alone").items()}
        before = self.bytes_of(self.dir / "alone/cells" / honest["fixture_constant"])
        cache = self.bytes_of(self.dir / "cache")
        rows = [self.row(writer, how) for writer in self.writers for how in KINDS]
        done = self.call(*RUN, "--methods", ",".join(["fixture_constant", *rows]), "--out", "out", expect=3)
        self.assert_nothing_survives()
        self.assert_matches_schemas("out")
        failed = sum(1 for reason in KINDS.values() if reason) * len(self.writers)
        self.assertEqual(re.search(r"\d+ cells computed, .*", done.stderr)[0],
                         f"{1 + len(rows) - failed} cells computed, 0 reused, {failed} failed")
        self.assertEqual(self.bytes_of(self.dir / "cache"), cache)
        after = self.bytes_of(self.dir / "out/cells" / honest["fixture_constant"])
        for name in ("cell.json", "selection.json", "training.jsonl", "episodes.jsonl"):
            self.assertEqual(after[pathlib.Path(name)], before[pathlib.Path(name)], name)
        self.assertEqual([path for path in (self.dir / "out").rglob("*") if path.is_symlink()], [])
        landlock = "Landlock" in json.loads((self.dir / "out/run.json").read_text())["confinement"]
        well = self.bytes_of(self.dir / "alone/cells" / honest["fixture_hostile"])[pathlib.Path("episodes.jsonl")]
        for key, (cell, status) in self.cells("out").items():
            if cell["method"]["id"] == "fixture_constant":
                continue
            how, directory = cell["method"]["options"]["how"], self.dir / "out/cells" / key
            with self.subTest(method=cell["method"]["id"], how=how, status=status):
                if KINDS[how] is None:
                    self.assertEqual(status["state"], "ok")
                    self.assertEqual((directory / "episodes.jsonl").read_bytes(), well)
                    self.assertFalse((directory / "files").exists())
                else:
                    self.assertEqual((status["state"], status["fault"]), ("failed", "plugin"))
                    self.assertRegex(status["reason"], KINDS[how])
                if how == "others" and landlock:
                    log = (directory / "log.txt").read_text()
                    self.assertEqual((log.count(": refused"), log.count(": reached")), (4, 0), log)
                self.assertLess((directory / "log.txt").stat().st_size, 3 << 20)

    def test_a_training_log_cannot_hold_a_report_up(self):
        rows = [self.row(writer, "loss") for writer in self.writers]
        self.call(*RUN, "--methods", ",".join(rows), "--out", "out", timeout=60)
        for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]:
            self.assertIsNotNone(row["success"])

    def test_bad_seeds_cannot_be_left_out_unseen(self):
        rows = [self.row(writer, "game") for writer in self.writers]
        done = self.call(*with_options(RUN, "--seeds", "0:3"), "--methods", ",".join(rows), "--out", "out", expect=3)
        self.assertIn("‡ incomplete", done.stdout)
        faults = [status["fault"] for _, status in self.cells("out").values() if status["state"] == "failed"]
        self.assertEqual(faults, ["plugin"] * 2 * len(rows))
        for row in json.loads((self.dir / "out/summary.json").read_text())["rows"]:
            self.assertIn("incomplete", row["marks"])


class Keepers(Harm):
    """A method that keeps the truth that it is told when its failures are attributed, where a next cell could find it."""

    def setUp(self):
        super().setUp()
        self.addCleanup(pathlib.Path("/tmp/lgabench-kept").unlink, missing_ok=True)

    def play(self, keep, out, *more):
        folder = self.dir / f"mine_{keep}"
        if not folder.exists():
            folder.mkdir()
            shutil.copy(FIXTURES / "faulty/fixture_keeper.so", folder)
        words = with_options(["run", "q1", "--scenarios", "heart", "--layout", "cells", "--demos", "10", "--seeds", "0:3",
                              "--episodes", "3", "--no-reference", "--jobs", "1"], *more)
        return self.call(*words, "--plugin-path", folder, "--methods", f"fixture_keeper+keep={keep}+folder={folder}", "--out", out)

    def selected(self, run):
        """Seed -> what was selected."""
        return {cell["training_seed"]: (self.dir / run / "cells" / key / "selection.json").read_text()
                for key, (cell, _) in self.cells(run).items()}

    def scored(self, run):
        """Seed -> what was selected and done."""
        return {cell["training_seed"]: [(e["failure"], e["action"]) for e in self.episodes(self.dir / run / "cells" / key)]
                for key, (cell, _) in self.cells(run).items()}, self.selected(run)

    @staticmethod
    def episodes(cell):
        return [json.loads(line) for line in (cell / "episodes.jsonl").read_text().splitlines()]

    def causes(self, run):
        return {episode["attribution"] for cell in (self.dir / run / "cells").iterdir() for episode in self.episodes(cell)}

    def assert_keeping_helps_nothing(self, *more):
        for keep in "no", "yes":
            self.play(keep, keep, *more)                          # one run, then a cell of it again
            shutil.rmtree(next((self.dir / keep / "cells").glob("[0-9a-f]*")))
            self.play(keep, keep, *more, "--resume")
            self.play(keep, f"{keep}_jobs", *more, "--jobs", "2")
        self.assertEqual(self.selected("yes"), self.selected("no"))
        self.assertEqual(self.selected("yes_jobs"), self.selected("no"))

    def test_nothing_is_kept_from_a_run_that_tells_the_truth(self):
        self.assert_keeping_helps_nothing()
        self.assertLessEqual(self.causes("yes"), {"abstraction", "policy"})
        self.call("verify", "yes", "--all", "--plugin-path", "mine_yes")  # which tells no truth

    def test_nothing_true_is_told_before_the_last_cell_of_the_run_is_scored(self):
        """Unconfined, so that what one cell is told another hears: who hears it in time selects and acts otherwise."""
        for jobs in "1", "2":
            out = {keep: f"{keep}_{jobs}" for keep in ("no", "yes")}
            said = {keep: self.play(keep, out[keep], "--unconfined", "--jobs", jobs).stderr for keep in out}
            self.assertEqual(self.scored(out["yes"]), self.scored(out["no"]))
            self.assertLessEqual(self.causes(out["no"]), {"abstraction", "policy"})
            self.assertNotIn("left out", said["no"])
            # There it is heard by the cells that are computed again, else this test would show nothing.
            self.assertIn("is left out, its failures have no causes: ", said["yes"])
            self.assertEqual(self.causes(out["yes"]), {None})
            shutil.rmtree(self.dir / "mine_yes")
            pathlib.Path("/tmp/lgabench-kept").unlink()

    def test_causes_are_those_of_attribute_and_nothing_else_of_a_cell_changes(self):
        said = self.play("no", "whole").stderr
        self.assertIn("finding the causes of failures of fixture_keeper: 3 cells, about ", said)
        for part in "1", "2":
            said = self.play("no", "part" + part, "--shard", part + "/2").stderr
            self.assertIn("the causes of failures of fixture_keeper are found after the run's last cell: merge the parts, "
                          "then run lgabench attribute MERGED\n", said)
            self.assertEqual(self.causes("part" + part), {None})
        refused = self.call("attribute", "part1", "--plugin-path", "mine_no", expect=2).stderr
        self.assertRegex(refused, r"part1: 1 of its cells have not been played, expected a finished run")
        self.call("merge", "both", "part1", "part2")
        (self.dir / "file").write_text("")
        unplaced = self.call("attribute", "both", "--plugin-path", "mine_no", "--out", "file/x", expect=2).stderr
        self.assertEqual(unplaced, "lgabench: file: cannot be made: file is not a directory\n")
        self.call("attribute", "both", "--plugin-path", "mine_no")
        self.assert_same_results("both-attributed", "whole")
        before = Hostile.bytes_of(self.dir / "both/cells")
        said = self.play("no", "both").stderr  # in place, as all cells are there
        self.assertIn("0 cells computed, 3 reused", said)
        self.assert_same_results("both", "whole")
        self.assert_matches_schemas("both")
        after = Hostile.bytes_of(self.dir / "both/cells")
        self.assertEqual({path.name for path in after if after[path] != before.get(path)}, {"episodes.jsonl", "status.json"})
        self.assertEqual(set(after), set(before))
        self.assertNotIn("finding", self.play("no", "both").stderr)

    def test_a_method_that_acts_otherwise_each_time_is_left_out_by_name(self):
        def play(*rows, expect=0):
            return self.call(*with_options(RUN, "--methods", ",".join(rows)), "--out", "out", "--resume", expect=expect).stderr
        self.assertRegex(play("fixture_keeper", "fixture_unsound+how=clock"),
                         r"\nfixture_unsound is left out, its failures have no causes: fixture_unsound heart .*: not the same when computed again\n")
        causes = {cell["method"]["id"]: {e["attribution"] for e in self.episodes(self.dir / "out/cells" / key)}
                  for key, (cell, _) in self.cells("out").items()}
        self.assertLessEqual(causes["fixture_keeper"], {"abstraction", "policy"})
        self.assertEqual(causes["fixture_unsound"], {None})
        # Where a cell is still to be scored, as it failed, nobody is told anything.
        shutil.rmtree(self.dir / "out")
        self.assertIn("the causes of failures of fixture_keeper are found after the run's last cell: compute the failed cells, or run "
                      "lgabench attribute out\n", play("fixture_keeper", "fixture_faulty+where=learn+how=throw", expect=3))
        self.call("attribute", "out", "--plugin-path", FIXTURES / "faulty")

    def test_presets_of_the_board_tell_others_methods_no_truth(self):
        board = "--preset", "leaderboard"
        self.assert_keeping_helps_nothing(*board)
        self.assertEqual(self.causes("yes"), {None})
        self.call("verify", "yes", "--all", "--plugin-path", "mine_yes")
        self.call("run", "q1", *board, "--methods", "lga_hill", "--scenarios", "heart", "--layout", "cells", "--demos", "10",
                  "--seeds", "0", "--episodes", "20", "--set", "*.epochs=1", "--no-reference", "--out", "own")
        self.assertLessEqual(self.causes("own"), {None, "abstraction", "policy"})
        self.assertNotEqual(self.causes("own"), {None})

    def test_causes_are_found_afterwards_in_a_copy(self):
        self.play("no", "run", "--preset", "leaderboard")
        before = {path: path.read_bytes() for path in (self.dir / "run").rglob("*") if path.is_file()}
        done = self.call("attribute", "run", "--plugin-path", "mine_no")
        self.assertRegex(done.stderr, r"3 cells")
        self.assertRegex(done.stdout, r"report: \S*run-attributed/report\.html")
        self.assertLessEqual(self.causes("run-attributed"), {"abstraction", "policy"})
        self.assertEqual({path: path.read_bytes() for path in (self.dir / "run").rglob("*") if path.is_file()}, before)
        self.call("verify", "run-attributed", "--all", "--plugin-path", "mine_no")
        self.assert_matches_schemas("run-attributed")
        for words, expect, says in ((["run", "--out", "run-attributed"], 2, "exists already"),
                                    (["run-attributed", "--out", "x"], 2, "every failure that can be attributed has its cause"),
                                    (["run", "--rows", "lga", "--out", "x"], 2, "no row lga, the run has: fixture_keeper")):
            self.assertIn(says, self.call("attribute", *words, "--plugin-path", "mine_no", expect=expect).stderr)

    def test_a_row_that_acts_otherwise_is_left_out(self):
        self.play("no", "run", "--preset", "leaderboard")
        for cell in (self.dir / "run").glob("cells/*"):
            episodes = cell / "episodes.jsonl"
            episodes.write_text(episodes.read_text().replace('"action":[0.5,', '"action":[0.25,', 1))
            status = json.loads((cell / "status.json").read_text())
            status["files"]["episodes.jsonl"] = hashlib.sha256(episodes.read_bytes()).hexdigest()
            (cell / "status.json").write_text(json.dumps(status, sort_keys=True, separators=(",", ":")) + "\n")
        said = self.call("attribute", "run", "--plugin-path", "mine_no", expect=1).stderr
        self.assertIn("left out", said)
        self.assertEqual(self.causes("run-attributed"), {None})


class Neighbours(Case):
    """Two cells that are computed at the same time tell each other a number."""

    def heard(self, how):
        """Training seed -> what its method heard."""
        plugin = FIXTURES / "faulty/fixture_neighbour.so"
        self.call("run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0:2", "--episodes", "1", "--no-reference",
                  "--jobs", "2", "--plugin-path", FIXTURES / "faulty", "--methods", f"fixture_neighbour+how={how}+file={plugin}",
                  "--out", how, expect=3)
        return {cell["training_seed"]: re.search(r"heard \d+|$", status["reason"])[0] for cell, status in self.cells(how).values()}

    def test_nothing_is_heard_by_process_groups(self):
        self.assertEqual(self.heard("group"), {0: "heard 0", 1: "heard 0"})

    def test_what_remains_possible(self):
        """Where a kernel gives these no longer, docs/trust.md says too much."""
        for how in "futex", "threads":
            self.assertEqual(self.heard(how), {0: "heard 41", 1: "heard 40"}, how)


class Cheats(Harm):
    """Who knows the scenes: as a plugin that would act on them, and as a search for them in Python."""

    def success(self, *more, expect=0):
        self.call(*with_options(RUN, "--episodes", "20"), "--layout", "cells", "--methods", "fixture_cheat", "--out", "out",
                  *more, expect=expect)
        rows = json.loads((self.dir / "out/summary.json").read_text())["rows"]
        return rows[0]["success"]

    def test_a_plugin_that_makes_the_scenes_itself(self):
        self.assertGreaterEqual(self.success("--unconfined"), .9)  # else this test would show nothing
        shutil.rmtree(self.dir / "out")
        self.assertIsNone(self.success(expect=3))
        (_, status), = self.cells("out").values()
        if "Landlock" not in json.loads((self.dir / "out/run.json").read_text())["confinement"]:
            self.skipTest("this kernel has no Landlock")
        self.assertEqual((status["state"], status["fault"]), ("failed", "plugin"))
        self.assertRegex(status["reason"], "Permission denied|scenario")

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_search_for_them_in_python(self):
        def reached(*more):
            self.call(*RUN, "--methods", self.row("hostile.py:Hostile", "cheat"), "--out", "out", *more, expect=3)
            (_, status), = self.cells("out").values()
            shutil.rmtree(self.dir / "out")
            return status["reason"].partition("reached: ")[2].partition(" (hostile.py:")[0]
        self.assertEqual(reached(), "nothing")
        self.assertIn("the scenario, the suite, the answers, the sampler", reached("--unconfined"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
