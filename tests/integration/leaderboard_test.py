"""`lgabench leaderboard`: from a run to a page, and what is refused on the way.

The suite is a tiny one of the test's own, in a copy of the installed data. By hand: python3 leaderboard_test.py Submissions
"""
import csv
import hashlib
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tarfile
import time
import unittest

from case import BUILD, ENGINE, FIXTURES, Case, command_line, read_entry
from published_test import cheapest_first, replay_one_cell
from verify_test import canonical, rewrite

SUITE = {"id": "tiny", "environment": "tabletop", "scenarios": ["heart", "letter"], "layouts": ["cells"],
         "engines": [ENGINE["run"][1]], "methods": ["fixture_constant"], "demonstrations": [2, 4], "seeds": [0, 1],
         "episodes": 4, "scene_seed": 0,
         "presets": {"paper": {}, "board": {"scene_seed": 77, "test_scenes": "per_seed"},
                     "small": {"scene_seed": 77, "test_scenes": "per_seed", "smoke": True}}}
META = {"authors": ["A. Author"], "license": "Apache-2.0", "by": "A. Author",
        "source": {"repository": "https://example.org/mine", "commit": "0" * 40}}
ROWS = "fixture_constant,fixture_constant+demonstration=1"
PLUGIN = ("--plugin-path", FIXTURES / "good")


class Board(Case):
    """A board beside one run of the tiny suite, which every test copies."""

    def prepare(self):
        shutil.copytree(BUILD / "share/lgabench", self.dir / "data", ignore=shutil.ignore_patterns("encoder"))
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(SUITE))
        self.environment["LGABENCH_DATA"] = str(self.dir / "data")
        (self.dir / "me.json").write_text(json.dumps(META))

    @classmethod
    def setUpClass(cls):
        cls.first = cls()
        cls.first.setUp()
        cls.addClassCleanup(cls.first.doCleanups)
        cls.first.prepare()
        cls.first.play("run")

    def runTest(self):
        pass

    def play(self, out, *words, expect=0):
        return self.call("run", "tiny", "--preset", "board", "--methods", ROWS, *PLUGIN, "--out", out, *words, expect=expect)

    def take_run(self):
        """This test's own copy of the class's run."""
        self.prepare()
        self.environment["LGABENCH_CACHE"] = str(self.first.dir / "cache")
        shutil.copytree(self.first.dir / "run", self.dir / "run")

    def leaderboard(self, *words, expect=0):
        return self.call("leaderboard", *words, "--board", "board", expect=expect)

    def replay(self):
        """Every entry is played again, and somebody vouches for it."""
        self.leaderboard("verify", "--by", "B. Reader", *PLUGIN)
        for file in (self.dir / "board").glob("entries/*/*/*/verifications.jsonl"):
            self.leaderboard("vouch", file.parent.relative_to(self.dir / "board"), len(file.read_text().splitlines()))
        self.leaderboard("build")

    def add(self, run="run", expect=0, *words):
        return self.leaderboard("add", run, "--entry", "me.json", *words, expect=expect)

    def refused(self, run="run"):
        """What is said, line by line; nothing is written."""
        done = self.add(run, 1)
        self.assertFalse((self.dir / "board/entries").exists())
        self.assertEqual(done.stdout, "")
        lines = done.stderr.splitlines()
        self.assertTrue(all(line.startswith("refused: ") for line in lines), lines)
        return [line[len("refused: "):] for line in lines]

    def cell(self, run="run", **wanted):
        """A cell of the run with these members, by their path."""
        for path in sorted((self.dir / run).glob("cells/*/cell.json")):
            cell = json.loads(path.read_text())
            if all(cell[name] == value for name, value in wanted.items()) and cell["method"]["id"] == "fixture_constant":
                return path.parent
        raise AssertionError(wanted)

    def change_run(self, run="run", **members):
        file = self.dir / run / "run.json"
        file.write_text(json.dumps({**json.loads(file.read_text()), **members}))

    def mark_failed(self, cell, fault):
        status = {"state": "failed", "reason": "ended by signal 11", "signal": 11, "fault": fault, "build": {}, "files": {},
                  "log_tail": []}
        for name in ("selection.json", "training.jsonl", "episodes.jsonl", "timing.json"):
            (cell / name).unlink()
        (cell / "status.json").write_text(canonical(status))


class Submissions(Board):
    def test_from_a_run_to_a_page(self):
        self.take_run()
        said = self.add().stdout
        self.assertEqual(len(re.findall(r"^added entries/\w+/[0-9a-f]{16}/tiny-board$", said, re.M)), 6, said)
        self.leaderboard("build")
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)
        board = self.dir / "board"
        self.assertRegex((board / "README.md").read_text(), r"\| not yet replayed \|(.*\n)*\| fixture_constant, demonstration=[01] \|")
        self.replay()
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)
        self.assertEqual(sorted(file.name for file in board.glob("*.*")),
                         ["README.md", "index.html", "leaderboard.csv", "tiny.html", "vouched.json", "vouched_entries.json"])
        self.assertRegex((board / "README.md").read_text(), r"\| 1 \| fixture_constant, demonstration=[01] \|")
        entry = json.loads(next(board.glob("entries/fixture_constant/*/tiny-board/entry.json")).read_text())
        self.assertEqual(entry["about"], META)
        self.assertEqual(entry["identity"]["scene_seed"], 77)
        self.assertRegex(entry["evidence"][0]["program"], r"^lgabench \S+ \(commit ")
        self.assertRegex(entry["evidence"][0]["command"], "^lgabench run tiny ")  # not where the program lies
        said = self.add(expect=1).stderr
        self.assertEqual(len(re.findall(": this run is on the board already$", said, re.M)), 6)

    def test_a_file_of_answers_goes_with_its_entry(self):
        self.prepare()
        (self.dir / "mine.json").write_text(json.dumps({"model": "me", "space": "tabletop", "answers": [
            {"scenario": name, "command": name, "target": {"object_types": ["heart"], "textures": "ALL"}} for name in ("heart", "letter")]}))
        self.play("out", "--answers", "mine.json", "--no-reference")
        self.add("out", 0, "--rows", "fixture_constant")
        kept = hashlib.sha256((self.dir / "mine.json").read_bytes()).hexdigest() + ".json"
        self.assertEqual((self.dir / "board/answers" / kept).read_bytes(), (self.dir / "mine.json").read_bytes())
        self.replay()
        self.assertIn("1 entry, 0 problems", self.leaderboard("check").stdout)
        self.assertIn(f"--answers answers/{kept}", (self.dir / "board/tiny.html").read_text())
        (self.dir / "board/answers/other.json").write_text("{}")
        self.assertIn("answers/other.json: no entry is based on it; remove it", self.leaderboard("check", expect=1).stderr)
        (self.dir / "board/answers/other.json").unlink()
        (self.dir / "board/answers" / kept).unlink()
        self.assertIn(f"{kept} is not there, or not what its name says", self.leaderboard("check", expect=1).stderr)

    def test_two_shards_make_the_same_entries(self):
        self.take_run()
        for shard in 1, 2:
            self.play(f"part{shard}", "--shard", f"{shard}/2")
        self.call("merge", "whole", "part1", "part2")
        self.add()
        cells = {file: file.read_bytes() for file in (self.dir / "board").rglob("cells.jsonl")}
        self.assertEqual(self.add("whole").stdout.count("evidence added to"), 6)
        self.assertEqual({file: file.read_bytes() for file in cells}, cells)
        self.assertIn("missing: ", self.add("part1", 1).stderr)

    def test_the_page_names_the_command_that_plays_a_cell_again(self):
        self.take_run()
        self.add()
        self.replay()
        page = (self.dir / "board/tiny.html").read_text()
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
        entry = next(entry for entry in data["entries"] if "demonstration=1" in entry["command"])
        words = entry["command"].replace("'", "").split()[1:]
        self.call(*words, *PLUGIN, "--scenarios", "heart", "--demos", "4", "--seeds", "1", "--out", "again")
        again = next((self.dir / "again/cells").iterdir())
        cells = [json.loads(line) for line in (self.dir / "board" / entry["place"] / "cells.jsonl").read_text().splitlines()]
        self.assertIn(again.name, [cell["key"] for cell in cells], "the cell has the board's key")
        results = "".join(hashlib.sha256((again / name).read_bytes()).hexdigest()
                          for name in ("selection.json", "training.jsonl", "episodes.jsonl"))
        digest = next(cell["digest"] for cell in cells if cell["key"] == again.name)
        self.assertEqual(hashlib.sha256(results.encode()).hexdigest(), digest)

    def test_rows_can_be_chosen(self):
        self.take_run()
        self.assertEqual(self.add("run", 0, "--rows", "fixture_constant").stdout.count("added"), 1)
        self.assertIn("no row nobody, the run has:", self.add("run", 2, "--rows", "nobody").stderr)

    def test_another_run_with_the_same_outcomes_is_evidence(self):
        self.take_run()
        self.add()
        self.change_run(started="2030-01-01T00:00:00Z")
        self.assertEqual(self.add().stdout.count("evidence added to"), 6)
        entry = json.loads(next((self.dir / "board").glob("entries/oracle/*/*/entry.json")).read_text())
        self.assertEqual(len(entry["evidence"]), 2)

    def test_an_add_that_was_killed_stops_nothing(self):
        """At each write, fsync and rename: of new entries, one with a file of answers, and of evidence for some that are there."""
        self.prepare()
        (self.dir / "mine.json").write_text(json.dumps({"model": "me", "space": "tabletop", "answers": [
            {"scenario": name, "command": name, "target": {"object_types": ["heart"], "textures": "ALL"}} for name in ("heart", "letter")]}))
        self.play("run", "--answers", "mine.json", "--no-reference")
        count, board = self.dir / "count", self.dir / "board"
        more = {"LD_PRELOAD": str(BUILD / "tests/full_disk.so"), "FULL_DISK_UNDER": str(board), "FULL_DISK_COUNT": str(count), "FULL_DISK_KILLS": "1"}

        def add_killed_at(number):
            count.write_bytes(struct.pack("i", 0))
            done = subprocess.run(command_line("leaderboard", "add", "run", "--entry", "me.json", "--board", "board"), cwd=self.dir,
                                  env={**self.environment, **more, "FULL_DISK_AT": str(number)}, capture_output=True, text=True)
            self.assertEqual(done.returncode, -9 if number else 0, done.stderr)
            return struct.unpack("i", count.read_bytes())[0]

        def files():
            return {file.relative_to(board): file.read_bytes() for file in board.rglob("*") if file.is_file()}

        for evidence in False, True:
            before = self.dir / f"before-{evidence}"
            shutil.copytree(board, before) if evidence else before.mkdir()
            if evidence:
                self.change_run(started="2030-01-01T00:00:00Z")
            calls = add_killed_at(0)
            self.assertGreater(calls, 9)
            self.leaderboard("build")
            whole = files()
            for number in range(1, calls + 1):
                with self.subTest(number, evidence=evidence):
                    shutil.rmtree(board)
                    shutil.copytree(before, board)
                    add_killed_at(number)
                    said = self.leaderboard("check", expect=1 - evidence).stderr  # pages are not those of new entries
                    self.assertEqual([line for line in said.splitlines() if line and "lgabench leaderboard build" not in line], [])
                    self.leaderboard("build")
                    self.leaderboard("check")
                    self.add()
                    self.leaderboard("build")
                    self.assertIn("2 entries, 0 problems", self.leaderboard("check").stdout)
                    self.assertEqual(files(), whole)

    def test_other_outcomes_of_one_identity_are_refused(self):
        self.take_run()
        self.add()
        cell = self.cell()
        rewrite(cell, "episodes.jsonl", lambda e: {**e, "success": not e["success"], "attribution": None,
                                                   "failure": "missed_object" if e["success"] else "none"})
        before = {file: file.read_bytes() for file in (self.dir / "board").rglob("*") if file.is_file()}
        self.assertIn("this identity is on the board, with other outcomes in 1 of 8 cells", self.add(expect=1).stderr)
        self.assertEqual({file: file.read_bytes() for file in (self.dir / "board").rglob("*") if file.is_file()}, before)

    def test_a_cell_that_the_method_failed_counts_as_lost(self):
        self.take_run()
        self.mark_failed(self.cell(demonstrations=4), "plugin")
        self.add()
        lines = [json.loads(line) for file in (self.dir / "board").glob("entries/fixture_constant/*/*/cells.jsonl")
                 for line in file.read_text().splitlines()]
        failed = [line for line in lines if "failed" in line]
        self.assertEqual([line["outcomes"] for line in failed], [{"test": "!!!!"}])

    def test_outside_of_a_checkout_a_board_is_asked_for(self):
        for action in (["check"], ["build"], ["verify", "--by", "B. Reader"], ["withdraw", "x", "--reason", "y"]):
            self.assertRegex(self.call("leaderboard", *action, expect=2).stderr,
                             "results/leaderboard: no leaderboard is there; give --board DIR, or run the command in a checkout")
        self.assertFalse((self.dir / "results").exists())

    def test_an_archive_has_what_checks_it_and_the_same_bytes_each_time(self):
        self.take_run()
        (self.dir / "board").mkdir()
        self.assertIn("no entry to pack", self.leaderboard("build", "--archive", "none.tar.gz", expect=2).stderr)
        self.add()
        self.leaderboard("build", "--archive", "one.tar.gz")
        for file in (self.dir / "board").rglob("*.json*"):
            os.utime(file, (0, 0))
            file.chmod(0o600)
        self.leaderboard("build", "--archive", "other.tar.gz")
        self.assertEqual((self.dir / "one.tar.gz").read_bytes(), (self.dir / "other.tar.gz").read_bytes())
        with tarfile.open(self.dir / "one.tar.gz") as archive:
            files = archive.getmembers()
            archive.extractall(self.dir / "away")
        self.assertEqual([file.name for file in files], sorted((file.name for file in files), key=lambda name: name.split("/")))
        self.assertEqual({(file.uid, file.gid) for file in files}, {(0, 0)})
        started = json.loads((self.dir / "run/run.json").read_text())["started"]
        self.assertEqual({time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(file.mtime)) for file in files}, {started})
        root = self.dir / "away/lgabench-leaderboard"
        readme = (root / "README.md").read_text()
        self.assertIn(f"6 entries, the newest computed on {started[:10]}", readme)
        self.assertEqual([link for link in re.findall(r"\]\(([^)]+)\)", readme) if not (root / link).exists()], [])
        self.assertRegex((root / "CITATION.cff").read_text(), "(?m)^cff-version: ")
        self.assertIn("6 entries, 0 problems", self.call("leaderboard", "check", "--board", root / "leaderboard").stdout)
        (self.dir / "board/elsewhere").symlink_to("/etc/passwd")
        self.assertIn("elsewhere: no file of a board", self.leaderboard("build", "--archive", "none.tar.gz", expect=1).stderr)
        self.assertFalse((self.dir / "none.tar.gz").exists())

    def test_withdrawn_entries_keep_their_record(self):
        self.take_run()
        self.add("run", 0, "--rows", "fixture_constant")
        ids = [path.name for path in (self.dir / "board/entries/fixture_constant").iterdir()]
        self.replay()
        self.assertIn("| 1 |", (self.dir / "board/README.md").read_text())
        self.leaderboard("withdraw", ids[0], "--reason", "a mistake in its training")
        self.leaderboard("vouch", ids[0], "withdrawn")
        self.leaderboard("build")
        self.assertIn("1 entry, 0 problems", self.leaderboard("check").stdout)
        self.assertNotIn("| 1 |", (self.dir / "board/README.md").read_text())
        self.assertIn("was withdrawn before", self.leaderboard("withdraw", ids[0], "--reason", "again", expect=2).stderr)
        self.change_run(started="2030-01-01T00:00:00Z")
        self.assertIn("this identity was withdrawn", self.add("run", 1, "--rows", "fixture_constant").stderr)


class Superseding(Board):
    """Entries with other bits than this build gives: a run whose first row was changed in a digit of an action."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.first.enter()

    def setUp(self):
        super().setUp()
        self.board = self.dir / "board"
        if self is getattr(type(self), "first", self):
            return
        self.take_run()
        for name in "old", "board":
            shutil.copytree(self.first.dir / name, self.dir / name)
        self.place, self.id = self.first.place, self.first.id

    def enter(self):
        shutil.copytree(self.dir / "run", self.dir / "old")
        rewrite(self.cell("old"), "episodes.jsonl", lambda e: {**e, "action": [x + 2 ** -40 for x in e["action"]]})
        self.add("old")
        said = self.leaderboard("verify", "--by", "B. Reader", *PLUGIN, expect=1).stdout
        self.place = pathlib.PurePath(re.search(r"^DIFFERS (entries/fixture_constant/\S+): 7 of 8 cells bit-identical, 0 of \d+ episodes ended "
                                                r"differently; the entry: (.+); here: \2 \(nonce", said, re.M)[1])
        for file in self.board.glob("entries/*/*/*/verifications.jsonl"):
            self.leaderboard("vouch", file.parent.relative_to(self.board), "1")
        self.id = self.place.parts[2]
        cell = json.loads((self.board / self.place / "cells.jsonl").read_text().splitlines()[0])
        won = cell["outcomes"]["test"].find(".")
        picture = b"not looked at"
        (self.board / "scenes").mkdir()
        (self.board / f"scenes/{self.id}-{'worst' if won < 0 else 'best'}.png").write_bytes(picture)
        (self.board / "scenes.json").write_text(json.dumps({self.id: {"worst" if won < 0 else "best": {
            "cell": cell["key"], "arm": "test", "index": max(won, 0), "command": "x", "sha256": hashlib.sha256(picture).hexdigest()}}}))
        self.leaderboard("build")
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)

    def supersede(self, *words, run="run", expect=0):
        return self.leaderboard("supersede", run, "--by", "B. Maintainer", "--reason", "one order of additions", *words, expect=expect)

    def files(self, directory):
        return {file.relative_to(directory): file.read_bytes() for file in directory.rglob("*") if file.is_file()}

    def test_cells_computed_anew_take_an_entrys_place(self):
        before, old = self.files(self.board / self.place), json.loads((self.board / self.place / "entry.json").read_text())
        digest = hashlib.sha256((self.id + "\n").encode() + before[pathlib.Path("cells.jsonl")]).hexdigest()
        self.assertIn(digest, json.loads((self.board / "vouched.json").read_text()))
        done = self.supersede()
        self.assertIn(f"superseded {self.place}\n", done.stdout)
        self.assertEqual(done.stdout.count("the same bits already: "), 5)
        self.assertIn("Next, for each: lgabench leaderboard verify ENTRY", done.stderr)
        self.assertEqual(self.files(self.board / "superseded"), {pathlib.Path(self.id) / digest[:16] / name: text for name, text in before.items()})
        self.assertEqual(sorted(map(str, self.files(self.board / self.place))), ["cells.jsonl", "entry.json"])
        entry = json.loads((self.board / self.place / "entry.json").read_text())
        self.assert_as_schema("entry", entry)
        self.assertEqual({**entry["supersedes"][0], "when": ""}, {"hash": digest, "when": "", "reason": "one order of additions"})
        self.assertEqual((entry["identity"], entry["about"], len(entry["evidence"])), (old["identity"], old["about"], 1))
        self.assertEqual(entry["evidence"][0]["by"], "B. Maintainer")
        for name in "vouched.json", "vouched_entries.json":
            self.assertEqual((digest in json.loads((self.board / name).read_text()), len(json.loads((self.board / name).read_text()))), (False, 5))
        self.assertEqual((json.loads((self.board / "scenes.json").read_text()), list((self.board / "scenes").iterdir())), ({}, []))
        self.leaderboard("build")
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)
        done = self.leaderboard("verify", self.id, "--by", "B. Maintainer", "--cells", "1", *PLUGIN)
        self.assertRegex(done.stdout, r"^agrees .*: 1 of 1 cells bit-identical, 0 of 4 episodes ended differently \(nonce")
        self.assertEqual(done.stderr.splitlines()[-1], "Too few cells to count: nobody vouches for a replay of fewer than 8 (--cells 8)")
        done = self.leaderboard("verify", self.id, "--by", "B. Maintainer", *PLUGIN)
        self.assertEqual(done.stderr.splitlines()[-1], f"To make it count: lgabench leaderboard vouch {self.id} 2 --board board")
        self.leaderboard("vouch", self.id, "2")
        self.leaderboard("build")
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)
        self.assertRegex((self.board / "README.md").read_text(), rf"\| \d \| fixture_constant.*{self.id}")
        page = json.loads(re.search(r'id="data">(.*?)</script>', (self.board / "tiny.html").read_text(), re.S)[1])
        self.assertEqual([entry["supersedes"] for entry in page["entries"] if "supersedes" in entry],
                         [[{"when": entry["supersedes"][0]["when"], "reason": "one order of additions", "place": f"superseded/{self.id}/{digest[:16]}"}]])
        self.assertEqual(self.supersede().stdout.count("the same bits already: "), 6)
        self.leaderboard("build", "--archive", "board.tar.gz")

    def test_an_entry_is_superseded_again(self):
        self.supersede()
        shutil.copytree(self.dir / "run", self.dir / "newer")
        rewrite(self.cell("newer"), "episodes.jsonl", lambda e: {**e, "action": [x + 2 ** -39 for x in e["action"]]})
        first = self.files(self.board / "superseded")
        self.assertIn(f"superseded {self.place}", self.supersede("--rows", "fixture_constant,fixture_constant+demonstration=1", run="newer").stdout)
        both = self.files(self.board / "superseded")
        self.assertEqual({name: text for name, text in both.items() if name in first}, first)
        self.assertEqual(len(list((self.board / "superseded" / self.id).iterdir())), 2)
        self.assertEqual(len(json.loads((self.board / self.place / "entry.json").read_text())["supersedes"]), 2)
        self.leaderboard("build")
        self.assertIn("6 entries, 0 problems", self.leaderboard("check").stdout)

    def test_what_supersede_refuses(self):
        before = self.files(self.board)
        rewrite(self.cell(), "episodes.jsonl", lambda e: {**e, "scene": "0" * 16})
        self.assertRegex(self.supersede(expect=1).stderr, rf"^refused: {self.place}: cell heart cells n=\d seed=\d has another with other test scenes in its place\n$")
        self.assertIn("expected RUN, --reason WORDS, and --by NAME", self.leaderboard("supersede", "old", "--reason", "x", expect=2).stderr)
        self.change_run("old", smoke=True)
        self.assertIn("refused: a smoke or limited run", self.supersede(run="old", expect=1).stderr)
        self.assertEqual(self.files(self.board), before)
        self.leaderboard("withdraw", self.id, "--reason", "a mistake")
        self.change_run("old", smoke=False)
        self.assertIn(f"refused: {self.place}: this identity was withdrawn", self.supersede(run="old", expect=1).stderr)
        shutil.rmtree(self.board / self.place.parent)
        self.assertIn(f"refused: {self.place}: not on the board", self.supersede(run="old", expect=1).stderr)

    def test_a_supersede_that_was_killed_is_given_again(self):
        """At each write, fsync and rename."""
        count, before = self.dir / "count", self.dir / "before"
        shutil.copytree(self.board, before)
        words = ["leaderboard", "supersede", "run", "--by", "B. Maintainer", "--reason", "one order of additions", "--board", "board"]

        def killed_at(number):
            count.write_bytes(struct.pack("i", 0))
            more = {"LD_PRELOAD": str(BUILD / "tests/full_disk.so"), "FULL_DISK_UNDER": str(self.board), "FULL_DISK_COUNT": str(count),
                    "FULL_DISK_KILLS": "1", "FULL_DISK_AT": str(number)}
            done = subprocess.run(command_line(*words), cwd=self.dir, env={**self.environment, **more}, capture_output=True, text=True)
            self.assertEqual(done.returncode, -9 if number else 0, done.stderr)
            return struct.unpack("i", count.read_bytes())[0]

        calls, whole = killed_at(0), self.files(self.board)
        self.assertGreater(calls, 9)
        for number in range(1, calls + 1):
            with self.subTest(number):
                shutil.rmtree(self.board)
                shutil.copytree(before, self.board)
                killed_at(number)
                self.supersede()
                self.assertEqual(self.files(self.board), whole)


class Refusals(Board):
    def setUp(self):
        super().setUp()
        if self is not getattr(type(self), "first", self):
            self.take_run()

    def test_a_smoke_run(self):
        self.change_run(smoke=True)
        self.assertIn("a smoke or limited run (run.json: smoke)", self.refused())

    def test_a_limited_run(self):
        self.play("limited", "--limit", "3")
        lines = self.refused("limited")
        self.assertIn("a smoke or limited run (run.json: smoke)", lines)
        self.assertTrue(any(line.startswith("missing: ") for line in lines))

    def test_an_unconfined_run(self):
        self.change_run(confinement="none, by --unconfined")
        self.assertEqual(self.refused(), ["methods were not confined (--unconfined)"])

    def test_a_preset_whose_scenes_methods_are_tuned_on(self):
        self.call("run", "tiny", "--preset", "paper", "--methods", "fixture_constant", *PLUGIN, "--out", "paper")
        self.assertRegex(self.refused("paper")[0], r'preset "paper" is not one of the leaderboard.s, which .*: play lgabench run tiny --preset board or small$')

    def test_another_scene_seed(self):
        suite = {**SUITE, "presets": {"board": {"scene_seed": 78, "test_scenes": "per_seed"}}}
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(suite))
        self.assertRegex(" ".join(self.refused()), r"scene_seed is 77, the board's preset has 78: .* and \d+ more cells")

    def test_a_cell_that_was_not_played(self):
        shutil.rmtree(self.cell(demonstrations=4, training_seed=1))
        lines = self.refused()
        self.assertIn("1 cell of the run not played yet", lines)
        self.assertIn("missing: fixture_constant", " ".join(lines))

    def test_a_part_of_the_preset(self):
        self.play("part", "--seeds", "0")
        missing = [line for line in self.refused("part") if line.startswith("missing: ")]
        self.assertIn("missing: fixture_constant heart cells n=2 seed=1", missing)
        self.assertIn("fixture_constant: 4 of the preset's 8 cells are there", self.refused("part"))
        self.assertEqual(len(missing), 4 * 4 + 2 * 2)  # two rows, two references that learn, and two that do not

    def test_a_cell_that_the_host_failed(self):
        self.mark_failed(self.cell(), "host")
        self.assertRegex(self.refused()[0], "^failed by the host, not by the method: fixture_constant.*: ended by signal 11$")

    def test_a_method_of_others_that_was_told_the_truth(self):
        for member, why in (("policy", 1), (None, 0)):
            rewrite(self.cell(), "episodes.jsonl", lambda e: e if e["success"] else {**e, "attribution": member})
            if why:
                self.assertRegex(" ".join(self.refused()), "^failures have causes, for which the method was told the truth: "
                                 "add a run without causes: fixture_constant")
        self.add()

    def test_errors_that_were_made_in_what_was_selected(self):
        self.play("wrong", "--selection-errors", "missing=0.5")
        self.assertRegex(" ".join(self.refused("wrong")),
                         r"errors were made in what was selected \(selection_errors\): fixture_constant.* and \d+ more cells")

    def test_demonstrations_that_were_seen_otherwise(self):
        self.play("through", "--train-on", "sensor_noise:1")
        self.assertRegex(" ".join(self.refused("through")),
                         r"demonstrations were seen through a perturbation \(train_on\): fixture_constant")

    def test_an_edited_file(self):
        file = self.cell() / "episodes.jsonl"
        file.write_text(file.read_text().replace('"success":false', '"success":true').replace('"failure":"missed_object"', '"failure":"none"'))
        self.assertEqual(len(self.refused()), 1)

    def test_a_setting_that_is_not_the_boards(self):
        self.play("more", "--episodes", "6")
        self.assertIn("episodes is 6, the board's preset has 4", " ".join(self.refused("more")))

    def test_other_scenes_under_the_scenarios_name(self):
        for cell in (self.dir / "run/cells").iterdir():
            rewrite(cell, "cell.json", lambda c: {**c, "scenario": {**c["scenario"], "note": "easier"}})
        self.assertIn("the scenario is not as the board's preset has it", " ".join(self.refused()))

    def test_a_suite_that_somebody_brings_along(self):
        shutil.copy(self.dir / "data/suites/tiny.json", self.dir / "tiny.json")
        self.change_run(suite=str(self.dir / "tiny.json"))
        self.assertRegex(self.refused()[0], "expected one that is installed, not a file$")

    def test_an_id_that_leads_elsewhere(self):
        for cell in (self.dir / "run/cells").iterdir():
            rewrite(cell, "cell.json", lambda c: c if c["method"]["kind"] == "reference" else
                    {**c, "method": {**c["method"], "id": "../../elsewhere"}})
        plugins = json.loads((self.dir / "run/run.json").read_text())["plugins"]
        self.change_run(plugins=[{**one, "id": one["id"].replace("fixture_constant", "../../elsewhere")} for one in plugins])
        self.assertIn("expected an id of letters, digits, _ and -", self.add(expect=2).stderr)
        self.assertFalse((self.dir / "elsewhere").exists())

    def test_live_answers_without_their_cassette(self):
        for cell in (self.dir / "run/cells").iterdir():
            rewrite(cell, "cell.json", lambda c: {**c, "answers": "openai:m", "data": {**c["data"], "prompt": "0" * 64}})
        self.assertIn("openai:m: a live model's answers without their cassette (answers/ of the run)", self.refused())

    def test_what_authors_must_say(self):
        (self.dir / "me.json").write_text(json.dumps({k: v for k, v in META.items() if k != "license"}))
        self.assertIn('me.json: /: expected a member "license"', self.add(expect=2).stderr)
        (self.dir / "me.json").write_text(json.dumps({**META, "source": {"repository": "r", "commit": "main"}}))
        self.assertIn("/source/commit: expected 40 hexadecimal digits", self.add(expect=2).stderr)


class NamesRead(Board):
    """Rows whose names are read from pictures, in a suite that has them."""

    def prepare(self):
        super().prepare()
        suite = {**SUITE, "methods": ["lga"], "names": ["simulator", "read"], "demonstrations": [2], "seeds": [0],
                 "options": {"*": {"policy": "centroid"}}}
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(suite))

    def play(self, out, *words, expect=0):
        return self.call("run", "tiny", "--preset", "board", "--no-reference", "--out", out, *words, expect=expect)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.first.play("found", "--names", "read", "--segments", "difference")

    def setUp(self):
        super().setUp()
        if self is getattr(type(self), "first", self):
            return
        self.take_run()
        shutil.copytree(self.first.dir / "found", self.dir / "found")
        self.add()
        self.add("found")

    def entries(self):
        """Entries' files by where their names and segments come from."""
        all = {file: json.loads(file.read_text())["identity"] for file in self.dir.glob("board/entries/*/*/*/entry.json")}
        return {(one.get("names"), one.get("segments")): file for file, one in all.items()}

    def rows(self):
        with open(self.dir / "board/leaderboard.csv", newline="") as file:
            return {(row["names"], row["segments"]): row for row in csv.DictReader(file) if row["demonstrations"] == "all"}

    def test_a_row_says_how_names_were_read_and_is_replayed_so(self):
        entries = self.entries()
        self.assertEqual(set(entries), {(None, None), ("read", None), ("read", "difference")})
        reader = hashlib.sha256((self.dir / "data/readers/tabletop/plain.forest").read_bytes()).hexdigest()
        for (names, _), file in entries.items():
            self.assertEqual(json.loads(file.read_text())["identity"].get("reader"), names and reader)
        self.replay()
        self.assertIn("3 entries, 0 problems", self.leaderboard("check").stdout)
        rows = self.rows()
        self.assertEqual({row["tier"] for row in rows.values()}, {"replayed"})
        self.assertEqual({key: row["not_ranked"] for key, row in rows.items()},
                         {("simulator", "simulator"): "", ("read", "simulator"): "names read from pictures",
                          ("read", "difference"): "names read from pictures"})
        (self.dir / "board/tracks.json").write_text(json.dumps({"open": ["tiny-board"], "names_read": ["tiny-board"]}))
        (self.dir / "board/labels.json").write_text(json.dumps({"values": {"names=read": "names by sight"}}))
        self.leaderboard("build")
        self.assertTrue(all(row["rank"] for row in self.rows().values()), self.rows())
        readme, page = ((self.dir / "board" / file).read_text() for file in ("README.md", "tiny.html"))
        for title in "LGA, names by sight, segments=difference", "LGA, names by sight", "LGA":
            self.assertTrue(f"| {title} |" in readme and title in page, title)
        for words in "--names read --segments difference", "--names simulator --segments simulator":
            self.assertTrue(words in page, words)

    def test_another_model_is_named_and_nothing_is_recorded(self):
        (self.dir / "data/readers/tabletop/plain.forest").write_bytes((self.dir / "data/readers/tabletop/drawn.forest").read_bytes())
        done = self.leaderboard("verify", "--by", "B. Reader", expect=2)
        self.assertEqual(len(re.findall(r"model that reads names \(read\): [0-9a-f]{64} here, [0-9a-f]{64} in the entry", done.stderr)), 2)
        self.assertEqual(len(done.stdout.splitlines()), 1, "the simulator's names")
        shutil.rmtree(self.dir / "board")
        self.assertIn("computed with other data than this installation's: lga+names=read ", " ".join(self.refused()))

    def test_what_was_changed_is_found(self):
        file = self.entries()[("read", None)]
        honest = read_entry(file)
        for member, value in ("names", "read_robust"), ("reader", "0" * 64), ("segments", "difference"):
            with self.subTest(member):
                file.write_text(json.dumps({**honest, "identity": {**honest["identity"], member: value}}, indent=1) + "\n")
                self.assertIn("the hash of /identity", self.leaderboard("check", expect=1).stderr)
        with self.subTest("with the id and place that follow"):
            identity = {**honest["identity"], "names": "read_robust"}
            new = hashlib.sha256(canonical(identity).strip().encode()).hexdigest()[:16]
            shutil.move(file.parent.parent, file.parent.parent.with_name(new))
            file = file.parent.parent.with_name(new) / "tiny-board/entry.json"
            file.write_text(json.dumps({**honest, "id": new, "identity": identity}, indent=1) + "\n")
            self.assertIn("model that reads names (read_robust): ", self.leaderboard("verify", new, "--by", "B. Reader", expect=2).stderr)

    def test_what_a_plugin_reads_stays_outside(self):
        self.play("mine", "--names", "fixture_reader", "--plugin-path", FIXTURES / "perceivers/fixture_reader.so")
        shutil.rmtree(self.dir / "board")
        self.assertIn("lga+names=fixture_reader: a plugin (fixture_reader) read its names, which no leaderboard ranks", self.refused("mine"))


class Replays(Board):
    """`leaderboard verify`: what somebody made up is found, and what was found stays."""

    def setUp(self):
        super().setUp()
        if self is not getattr(type(self), "first", self):
            self.take_run()
            self.add("run", 0, "--rows", "fixture_constant")
            self.entry = next((self.dir / "board/entries/fixture_constant").glob("*/tiny-board"))

    def verify(self, *words, expect=0):
        done = self.leaderboard("verify", "--by", "B. Reader", *PLUGIN, *words, expect=expect)
        self.leaderboard("build")
        self.assertIn("1 entry, 0 problems", self.leaderboard("check").stdout)
        return done.stdout

    def forge(self, change):
        """Changes each cell's line."""
        lines = [json.loads(line) for line in (self.entry / "cells.jsonl").read_text().splitlines()]
        (self.entry / "cells.jsonl").write_text("".join(canonical({**line, **change(line)}) for line in lines))

    def forge_success(self):
        self.forge(lambda line: {"outcomes": {"test": "...."}, "digest": "0" * 64})

    def tier(self):
        return (self.dir / "board/README.md").read_text().split("| fixture_constant |")[1].split("|")[2].strip()

    def test_an_honest_entry_is_bit_identical(self):
        said = self.verify("--cells", "3")
        self.assertRegex(said, r"^agrees  entries/\S+: 3 of 3 cells bit-identical, 0 of 12 episodes ended differently \(nonce [0-9a-f]{32}\)")
        self.assertEqual(self.tier(), "recomputed; not yet replayed; claimed by B. Reader: replayed")
        self.assertIn("a replay of 3 cells; expected 8 or more", self.leaderboard("vouch", self.entry.parent.name, "1", expect=2).stderr)
        self.verify(self.entry.parent.name)
        self.leaderboard("vouch", self.entry.parent.name, "2")
        self.leaderboard("build")
        self.assertEqual(self.tier(), "replayed; never on fresh scenes")
        lines = [json.loads(line) for line in (self.entry / "verifications.jsonl").read_text().splitlines()]
        self.assertEqual([len(line["cells"]) for line in lines], [3, 8])
        self.assertNotEqual(lines[0]["nonce"], lines[1]["nonce"])

    def test_scenes_are_drawn_of_what_the_entry_says(self):
        board, name = self.dir / "board", self.entry.parent.name
        said = self.leaderboard("scenes", *PLUGIN).stdout.split()
        scenes = json.loads((board / "scenes.json").read_text())[name]
        self.assertTrue(scenes)
        self.assertEqual(said, [f"scenes/{name}-{which}.png" for which in scenes])
        cells = {line["key"]: line for line in map(json.loads, (self.entry / "cells.jsonl").read_text().splitlines())}
        for which, scene in scenes.items():
            png = (board / f"scenes/{name}-{which}.png").read_bytes()
            self.assertEqual((png[:4], hashlib.sha256(png).hexdigest()), (b"\x89PNG", scene["sha256"]))
            letter = cells[scene["cell"]]["outcomes"][scene["arm"]][scene["index"]]
            self.assertEqual(letter == ".", which == "best")
            self.assertEqual(cells[scene["cell"]]["demonstrations"], 2, "the fewest")
        self.leaderboard("build")
        self.assertIn("1 entry, 0 problems", self.leaderboard("check").stdout)
        self.assertEqual(self.leaderboard("scenes", *PLUGIN).stdout, "", "it has its pictures")
        (board / "scenes.json").unlink()
        self.forge(lambda line: {"outcomes": {"test": "".join("a" if letter == "." else "." for letter in line["outcomes"]["test"])}})
        self.assertRegex(self.leaderboard("scenes", *PLUGIN, expect=2).stderr, "no scenes: .*none of the first 4 episodes ends here as in the entry")
        self.assertFalse((board / "scenes.json").exists())

    def test_a_made_up_cell_is_found_and_not_outvoted(self):
        honest = (self.entry / "cells.jsonl").read_bytes()
        self.forge_success()
        self.assertIn("DIFFERS", self.verify(expect=1))
        self.assertEqual(self.tier(), "recomputed; not yet replayed; claimed by B. Reader: a replay differed")
        self.leaderboard("vouch", self.entry.parent.name, "1")
        self.leaderboard("build")
        self.assertEqual(self.tier(), "recomputed; a replay differed")
        self.assertIn("a replay differed", (self.dir / "board/leaderboard.csv").read_text())
        (self.entry / "cells.jsonl").write_bytes(honest)
        self.assertIn("expected the cells that the nonce chooses", self.leaderboard("check", expect=1).stderr)

    def test_one_replayed_cell_finds_what_was_changed_in_all(self):
        """As ./test --full replays the published board; an honest digest does not hide what else was changed."""
        shutil.copytree(self.dir / "board", self.dir / "honest")
        opposite = lambda line: {"test": re.sub(".", lambda one: "a" if one[0] == "." else ".", line["outcomes"]["test"])}
        for change, says in [(lambda line: {}, "agrees "), (lambda line: {"outcomes": opposite(line)}, "DIFFERS"),
                             (lambda line: {"lm_queries": 1.0}, "DIFFERS"), (lambda line: {"scenes": "0" * 64}, "DIFFERS"),
                             (lambda line: {"digest": "0" * 64}, "DIFFERS")]:
            shutil.rmtree(self.dir / "board")
            shutil.copytree(self.dir / "honest", self.dir / "board")
            self.forge(change)
            places = cheapest_first(self.dir / "board")["fixture_constant"]
            self.assertRegex(replay_one_cell(self, places, *PLUGIN), f"^{says}")

    def on_fresh_scenes(self, status, most):
        """What `verify --fresh` says once it ends so: scenes are drawn by chance, at most so often."""
        for _ in range(most):
            (self.entry / "verifications.jsonl").unlink(missing_ok=True)
            done = subprocess.run(command_line("leaderboard", "verify", "--by", "B. Reader", *PLUGIN, "--fresh", "--board", "board"),
                                  capture_output=True, text=True, env=self.environment, cwd=self.dir)
            if done.returncode == status:
                break
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout

    def test_scenes_learned_by_heart_differ_from_fresh_ones(self):
        agrees = self.on_fresh_scenes(0, most=6)  # an honest row, too, differs in one draw of twenty
        self.assertRegex(agrees, r"^agrees .*: [+-]0.\d+ \[-.*\] on fresh scenes")
        self.forge_success()
        # ten scenes are few: a constant action can be lucky in many of them
        self.assertIn("DIFFERS", self.on_fresh_scenes(1, most=12))
        self.verify(expect=1)
        for line in "1", "2":
            self.leaderboard("vouch", self.entry.parent.name, line)
        self.leaderboard("build")
        self.assertIn("differs on fresh scenes", (self.dir / "board/leaderboard.csv").read_text())

    def test_another_version_or_preset_is_not_what_was_entered(self):
        suite = {**SUITE, "presets": {"board": {"scene_seed": 77, "test_scenes": "per_seed", "episodes": 5}}}
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(suite))
        self.assertRegex(self.leaderboard("verify", "--by", "B", *PLUGIN, expect=2).stderr,
                         r"preset tiny-board: [0-9a-f]{8} here, [0-9a-f]{8} in the entry")
        self.assertIn("expected --by NAME", self.leaderboard("verify", expect=2).stderr)
        self.assertFalse((self.entry / "verifications.jsonl").exists())


    def test_an_entry_that_cannot_be_verified_stops_no_other(self):
        stranger = self.dir / "board/entries/a_stranger/0123456789abcdef"
        shutil.copytree(self.entry, stranger / "tiny-board")  # before the other in their order, and not as it should be
        done = self.leaderboard("verify", "--by", "B. Reader", *PLUGIN, "--cells", "1", expect=2)
        self.assertRegex(done.stderr, r"not verified: entries/a_stranger/\S+: .*\n(.*\n)*1 of 2 entries were not verified")
        self.assertRegex(done.stdout, r"^agrees  entries/fixture_constant/")
        self.assertTrue((self.entry / "verifications.jsonl").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
