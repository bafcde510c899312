"""`results/accept`: a request to the board, from a fork to a commit that a maintainer merges.

By hand: python3 accept_test.py Accepting
"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import unittest

from case import PROGRAM
from leaderboard_test import META, Board
from python_test import PYTHON, has

ACCEPT = pathlib.Path(__file__).parents[2] / "results/accept"


@unittest.skipUnless(has(PYTHON, "numpy") and shutil.which("git"), "needs NumPy and git")
class Accepting(Board):
    """The maintainers' checkout has one entry; a fork adds one of a method in Python, whose source is a repository of its own."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        first = cls.first
        first.add("run", 0, "--rows", "fixture_constant")
        first.leaderboard("build")
        first.git("init", "-q", "-b", "main", "trusted")
        (first.dir / "trusted/results").mkdir()
        shutil.move(first.dir / "board", first.dir / "trusted/results/leaderboard")
        (first.dir / "trusted/.gitignore").write_text("/build\n")
        first.commit("trusted", "a board")
        first.call("new-plugin", "mine", "--kind", "python")
        first.git("init", "-q", "-b", "main", "mine")
        first.commit("mine", "a method")
        first.git("clone", "-q", "trusted", "fork")
        first.git("switch", "-qc", "theirs", cwd="fork")
        first.call("run", "tiny", "--preset", "board", "--methods", "mine/mine.py:Mine", "--python", PYTHON, "--no-reference", "--out", "theirs")
        source = {"repository": str(first.dir / "mine"), "commit": first.git("rev-parse", "HEAD", cwd="mine").strip()}
        (first.dir / "them.json").write_text(json.dumps({**META, "source": source}))
        for words in ("add", "theirs", "--entry", "them.json"), ("build",):
            first.call("leaderboard", *words, "--board", "fork/results/leaderboard")
        first.commit("fork", "an entry")

    def setUp(self):
        super().setUp()
        if self is not type(self).first:
            self.prepare()
            for name in "trusted", "fork", "mine":
                shutil.copytree(self.first.dir / name, self.dir / name)

    def git(self, *words, cwd="."):
        return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words], cwd=self.dir / cwd, check=True,
                              capture_output=True, text=True).stdout

    def commit(self, where, why):
        self.git("add", "--all", cwd=where)
        self.git("commit", "-qm", why, cwd=where)

    def accept(self, *words, expect=0):
        named = {f"GIT_{who}_{what}": "m@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        done = subprocess.run([ACCEPT, "../fork", "theirs", "--program", PROGRAM, "--python", PYTHON, *words], cwd=self.dir / "trusted",
                              env={**self.environment, **named}, capture_output=True, text=True)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        self.assertEqual(self.git("status", "--short", cwd="trusted"), "", "what is checked out stays")
        return done.stdout + done.stderr

    def test_what_would_be_done_comes_first(self):
        (self.dir / "fork/results/accept").write_text("echo theirs")
        self.commit("fork", "a program")
        said = self.accept()
        self.assertRegex(said, r"^2 files of entries and answers are taken\nnot taken: results/accept\n2 entries, 0 problems\n")
        self.assertRegex(said, r"to replay, .*: results/leaderboard/entries/mine/[0-9a-f]{16}/tiny-board\n")
        self.assertEqual(self.git("branch", "--list", "accepted/*", cwd="trusted"), "")

    def test_an_entry_becomes_a_commit_with_its_replays(self):
        said = self.accept("--by", "The maintainers")
        self.assertRegex(said, r"agrees .*: 8 of 8 cells bit-identical(.*\n)+.* on fresh scenes")
        self.git("merge", "-q", "--ff-only", "accepted/theirs", cwd="trusted")
        board = self.dir / "trusted/results/leaderboard"
        with open(board / "leaderboard.csv") as file:
            tiers = {row["tier"] for row in csv.DictReader(file) if (row["method"], row["demonstrations"]) == ("mine", "all")}
        self.assertEqual(tiers, {"replayed"})
        self.assertEqual(len(list((board / "scenes").glob("*.png"))), 2)
        self.assertIn("2 entries, 0 problems", self.call("leaderboard", "check", "--board", board).stdout)

    def test_what_is_refused(self):
        old = next((self.dir / "fork/results/leaderboard/entries/fixture_constant").glob("*/*/cells.jsonl"))
        honest = old.read_text()
        old.write_text(honest.replace('"demonstrations":2', '"demonstrations":3'))
        self.commit("fork", "an old entry is changed")
        self.assertIn("refused: lgabench leaderboard", self.accept("--by", "M", expect=1))
        old.write_text(honest)
        os.symlink("/etc/passwd", old.parent / "more.json")
        self.commit("fork", "a link")
        self.assertIn("no usual file (mode 120000)", self.accept(expect=1))
        (old.parent / "more.json").unlink()
        old.unlink()
        self.commit("fork", "an old entry is removed")
        self.assertIn("cells.jsonl: removed", self.accept(expect=1))

    def test_what_changed_here_meanwhile(self):
        lines = next((self.dir / "fork/results/leaderboard/entries/fixture_constant").glob("*/*/entry.json"))
        lines.write_text(lines.read_text() + "\n")
        self.commit("fork", "theirs")
        ours = self.dir / "trusted" / lines.relative_to(self.dir / "fork")
        ours.write_text(ours.read_text() + " \n")
        self.commit("trusted", "ours")
        self.assertIn("entry.json: changed here since; ask for a rebase", self.accept(expect=1))


if __name__ == "__main__":
    unittest.main()
