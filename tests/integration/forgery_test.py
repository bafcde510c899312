"""What a pull request to the board could contain, and what comes of it: the steps of docs/maintaining.md on forged entries.

The board is this repository's entries of q2. By hand: python3 forgery_test.py Forgeries
"""
import hashlib
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import time
import unittest

from case import Case, command_line, read_entry
from verify_test import canonical

BOARD = pathlib.Path(__file__).parents[2] / "results/leaderboard"


def sha256(text):
    return hashlib.sha256(text.encode()).hexdigest()


def entry_hash(entry):
    return sha256(json.loads((entry / "entry.json").read_text())["id"] + "\n" + (entry / "cells.jsonl").read_text())


class Forgeries(Case):
    """Every test has a copy of one board, which was built and committed once."""

    @classmethod
    def setUpClass(cls):
        cls.first = cls()
        cls.first.setUp()
        cls.addClassCleanup(cls.first.doCleanups)

    def runTest(self):  # without it `first` could not be made
        pass

    def setUp(self):
        super().setUp()
        self.board = self.dir / "board"
        if self is self.first:
            self.publish()
        else:
            self.before = self.first.before
            for name in "board", ".git":
                shutil.copytree(self.first.dir / name, self.dir / name)
        self.lga = self.entry("lga", network="text", policy="regression", picture="none")
        self.rival = self.entry("lga_s", network="plain")

    def publish(self):
        for entry in BOARD.glob("entries/*/*/q2-leaderboard"):
            shutil.copytree(entry, self.board / entry.relative_to(BOARD))
        dropped = set()  # each entry has a replay alone
        for file in self.board.glob("entries/*/*/*/verifications.jsonl"):
            lines = file.read_text().splitlines()
            kept = [line for line in lines if json.loads(line)["kind"] != "commands"]
            dropped |= {sha256(line) for line in set(lines) - set(kept)}
            file.write_text("".join(line + "\n" for line in kept))
        hashes = {entry_hash(entry) for entry in self.board.glob("entries/*/*/*")}
        for name in "vouched.json", "vouched_entries.json":
            if (BOARD / name).exists():
                vouched = json.loads((BOARD / name).read_text())
                kept = {key: [line for line in vouched[key] if line not in dropped] if isinstance(vouched[key], list) else vouched[key]
                        for key in hashes & vouched.keys()}
                (self.board / name).write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
        inferred, ids = json.loads((BOARD / "instructions.json").read_text()), {entry.parent.name for entry in self.board.glob("entries/*/*/*")}
        (self.board / "instructions.json").write_text(json.dumps({id: inferred[id] for id in sorted(ids & inferred.keys())}, indent=1) + "\n")
        self.before = self.rows()
        for words in (["init", "-q", "-b", "main"], ["add", "board"], ["commit", "-qm", "before"]):
            self.git(*words)

    def git(self, *words, cwd=None):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words], cwd=cwd or self.dir, check=True, capture_output=True)

    def leaderboard(self, *words, expect=0):
        return self.call("leaderboard", *words, "--board", "board", expect=expect)

    def entry(self, method, **options):
        return next(file.parent for file in sorted(self.board.glob(f"entries/{method}/*/*/entry.json"))
                    if options.items() <= json.loads(file.read_text())["identity"]["options"].items())

    def rows(self):
        """id -> (rank, rest of the row) in README.md; and what waits for a replay."""
        self.leaderboard("build")
        text = (self.board / "README.md").read_text()
        rows = {}
        for line in text.splitlines():
            if line.startswith("|") and "entries/" in line:
                words = [word.strip() for word in line.split("|")[1:6]]
                del words[2 if re.fullmatch(r"\d+|–", words[0]) else 1]  # the policy
                rows.setdefault(re.search(r"entries/\w+/(\w+)/", line)[1], words[:4])
        return rows

    def check(self, *words, expect):
        """What `check` of the request says, its pages built by whoever forged it."""
        subprocess.run(command_line("leaderboard", "build", "--board", "board"), cwd=self.dir, env=self.environment, capture_output=True)
        done = self.leaderboard("check", "--against", "HEAD", *words, expect=expect)
        return done.stdout + done.stderr

    def forge(self, change=lambda entry: None, line=lambda line: line, like=None):
        """A new entry, a copy that is changed, with its id, place and the hash of its preset made right."""
        like = like or self.lga
        entry = read_entry(like / "entry.json")
        change(entry)
        preset = {name: value for name, value in entry["preset"].items() if name != "scene_seed"}
        entry["identity"]["preset"] = sha256(canonical(preset).strip())
        entry["id"] = sha256(canonical(entry["identity"]).strip())[:16]
        place = self.board / "entries" / entry["identity"]["method"] / entry["id"] / f"{entry['preset']['suite']}-{entry['preset']['preset']}"
        place.mkdir(parents=True)
        (place / "entry.json").write_text(json.dumps(entry, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
        lines = [line(json.loads(text)) for text in (like / "cells.jsonl").read_text().splitlines()]
        (place / "cells.jsonl").write_text("".join(canonical(one) for one in lines if one))
        return place

    def invent(self, change=lambda entry: None):
        def newer(entry):
            entry["identity"]["version"] = "0.2"
            change(entry)
        return self.forge(newer, lambda line: {**line, "digest": "0" * 64, "outcomes": {
            arm: "." * len(letters) for arm, letters in line["outcomes"].items()}})

    def add_line(self, entry, by="Prof. B. Independent", cells=30, nonce="7" * 32, **members):
        """A verification that nobody made, of the cells that its nonce chooses."""
        lines = [json.loads(text) for text in (entry / "cells.jsonl").read_text().splitlines()]
        chosen = sorted(lines, key=lambda line: sha256(entry_hash(entry) + nonce + line["key"]))[:cells]
        line = {"kind": "replay", "nonce": nonce, "cells": [one["key"] for one in chosen], "bit_identical": 0, "flips": 0,
                "episodes": sum(len(letters) for one in chosen for letters in one["outcomes"].values()), "passed": True, "by": by,
                "when": "2026-12-01", "program": "lgabench 0.2.0", "build": {}, "machine": {"processor": "another"},
                "confinement": "Landlock 7, seccomp", **members}
        with open(entry / "verifications.jsonl", "a") as file:
            file.write(canonical(line))

    def test_an_invented_entry_has_no_rank_before_a_replay(self):
        forged = self.invent()
        self.assertIn("0 problems", self.check(expect=0))
        rows = self.rows()
        self.assertEqual(rows.pop(forged.parent.name)[:3], ["LGA", "1.000", "recomputed; not yet replayed"])
        self.assertEqual(rows, self.before)
        self.assertIn("| not yet replayed | policy | claimed success |", (self.board / "README.md").read_text())
        self.assertNotIn(forged.parent.name, (self.board / "leaderboard.csv").read_text())

    def test_lines_of_its_own_make_it_no_better(self):
        forged = self.invent()
        self.add_line(forged)
        self.add_line(forged, nonce="8" * 32, kind="fresh", difference=0, low=-.1, high=.1, scene_seed=1, demonstrations=50, training_seed=0)
        self.assertIn("0 problems", self.check(expect=0))
        row = self.rows()[forged.parent.name]
        self.assertEqual(row[2], "recomputed; not yet replayed; claimed by Prof. B. Independent: reproduced; "
                                 "claimed by Prof. B. Independent: agrees on fresh scenes")

    def test_arms_that_were_learned_by_heart(self):
        """Perfect in all arms but the first, which alone was looked at before."""
        honest = next(BOARD.glob("entries/random_object/*/knowledge-leaderboard"))  # few episodes, and nothing is learned
        forged = shutil.copytree(honest, self.board / honest.relative_to(BOARD))
        (forged / "verifications.jsonl").unlink()
        arms = json.loads((forged / "entry.json").read_text())["preset"]["scenarios"][0]["arms"]
        lines = [json.loads(text) for text in (forged / "cells.jsonl").read_text().splitlines()]
        for line in lines:
            line["outcomes"] = {arm: letters if arm == arms[0] else "." * len(letters) for arm, letters in line["outcomes"].items()}
        (forged / "cells.jsonl").write_text("".join(map(canonical, lines)))
        said = self.leaderboard("verify", forged.parent.name, "--fresh", "--by", "B. Reader", expect=1).stdout
        self.assertRegex(said, rf"^DIFFERS .*: -0.\d+ \[.*\] on fresh scenes; arm (?!{arms[0]} )\w+ differs: -0")

    def test_people_who_are_the_truth(self):
        def human(entry):
            entry["identity"]["version"] = "0.2"
            text = json.dumps(entry["phi"]).replace("simulated_edit", "human")
            entry["phi"] = json.loads(text)
        forged = self.forge(human, like=self.entry("lga_hill"))
        self.check(expect=0)
        rows = self.rows()
        self.assertEqual(rows.pop(forged.parent.name)[2], "recomputed; not yet replayed")
        self.assertEqual(rows, self.before)

    def test_a_rival_keeps_its_rank(self):
        self.add_line(self.rival, by="Anonymous", passed=False)
        entry = read_entry(self.rival / "entry.json")
        entry["withdrawn"] = {"when": "2026-12-01", "reason": "cheated"}
        (self.rival / "entry.json").write_text(json.dumps(entry, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
        self.assertIn("0 problems", self.check(expect=0))
        row, before = self.rows()[self.rival.parent.name], self.before[self.rival.parent.name]
        self.assertEqual([row[0], row[2]], [before[0], before[2]])
        self.assertEqual(row[3], "replayed; never on fresh scenes; claimed by Anonymous: a replay differed; claimed: withdrawn")

    def test_evidence_that_somebody_adds_changes_no_tier(self):
        entry = read_entry(self.rival / "entry.json")
        entry["evidence"].append({**entry["evidence"][0], "machine": {"processor": "another"}, "by": "B. Reader"})
        (self.rival / "entry.json").write_text(json.dumps(entry, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
        self.add_line(self.rival, by="B. Reader", cells=12)
        self.leaderboard("vouch", self.rival.parent.name, "2")
        self.assertEqual(self.rows()[self.rival.parent.name][3], "reproduced; never on fresh scenes")

    def test_a_replay_of_few_cells_is_not_vouched_for(self):
        self.add_line(self.rival, cells=3)
        said = self.leaderboard("vouch", self.rival.parent.name, "2", expect=2).stderr
        self.assertIn("line 2 is a replay of 3 cells; expected 12 or more: verify it with --cells 12", said)
        self.assertIn('no line "3"; expected one of its 2', self.leaderboard("vouch", self.rival.parent.name, "3", expect=2).stderr)
        self.assertIn("is vouched for already", self.leaderboard("vouch", self.rival.parent.name, "1", expect=2).stderr)
        self.assertEqual(self.rows()[self.rival.parent.name][3], "replayed; never on fresh scenes; claimed by Prof. B. Independent: reproduced")

    def test_what_is_vouched_for_is_said(self):
        self.add_line(self.rival, by="Prof. B.\n", cells=12)
        self.add_line(self.rival, nonce="8" * 32, cells=12, passed=False, flips=999, only_recorded=999)
        self.leaderboard("withdraw", self.rival.parent.name, "--reason", "its replay differed")
        for line, says in (("2", r"replay by Prof. B.\\n on 2026-12-01: agrees, 0 of 12 cells bit-identical, 0 of "),
                           ("3", "replay by Prof. B. Independent on 2026-12-01: DIFFERS, 0 of 12 cells bit-identical, 999 of "),
                           ("withdrawn", "withdrawal on ")):
            self.assertRegex(self.leaderboard("vouch", self.rival.parent.name, line).stdout, f"^vouched for {says}.*: [0-9a-f]{{64}}\n$")

    def test_what_is_vouched_for_counts(self):
        self.add_line(self.rival, by="Anonymous", cells=12, passed=False)
        self.leaderboard("vouch", self.rival.parent.name, "2")
        self.assertEqual(self.rows()[self.rival.parent.name][3], "recomputed; a replay differed")
        self.leaderboard("withdraw", self.rival.parent.name, "--reason", "its replay differed")
        self.assertIn(self.rival.parent.name, self.rows())
        self.leaderboard("vouch", self.rival.parent.name, "withdrawn")
        self.assertNotIn(self.rival.parent.name, self.rows())
        vouched = json.loads((self.board / "vouched.json").read_text())
        vouched["0" * 64] = ["1" * 64]
        (self.board / "vouched.json").write_text(json.dumps(vouched, indent=1) + "\n")
        self.assertIn("vouched.json: /" + "0" * 64 + ": no entry of this hash has the line", self.leaderboard("check", expect=1).stderr)

    def test_maintainers_files_and_old_lines_stay(self):
        file = self.board / "vouched.json"
        text = file.read_text()
        file.write_text(text.replace("\n ", "\n  "))
        said = "vouched.json: changed since HEAD: it is the maintainers' (--maintainer)"
        self.assertIn(said, self.check(expect=1))
        self.assertIn("0 problems", self.check("--maintainer", expect=0))
        file.unlink()
        self.assertIn(said, self.check(expect=1))
        file.write_text(text)
        (self.board / "instructions.json").write_text("{}")
        self.assertIn("instructions.json: changed since HEAD: it is the maintainers'", self.check(expect=1))
        self.git("checkout", "board/instructions.json")
        (self.board / "tracks.json").write_text(json.dumps({"open": ["q2-leaderboard"]}))
        self.assertIn("tracks.json: changed since HEAD: it is the maintainers'", self.check(expect=1))
        (self.board / "tracks.json").unlink()
        (self.board / "scenes.json").write_text("{}")
        self.assertIn("scenes.json: changed since HEAD: it is the maintainers'", self.check(expect=1))
        (self.board / "scenes.json").unlink()
        (self.rival / "verifications.jsonl").write_text("")
        self.assertIn("verifications.jsonl: a verification changed since HEAD", self.check(expect=1))

    def test_what_surrounds_a_pages_tables_stays(self):
        """A script, or a heading above the table, that no entry made."""
        def against(expect):  # without building, as a request brings its pages
            done = self.leaderboard("check", "--against", "HEAD", expect=expect)
            return done.stdout + done.stderr

        page = self.board / "q2.html"
        text = page.read_text()
        for forged in (text.replace("</head>", "<script>alert(1)</script></head>"), text.replace("<main>", "<h1>LGA is first</h1><main>"),
                       text.replace("</body>", "<script src=//evil></script></body>")):
            self.assertNotEqual(forged, text)
            page.write_text(forged)
            self.assertIn("0 problems", self.leaderboard("check").stdout)
            self.assertIn("q2.html: changed outside its tables; lgabench leaderboard build writes it", against(1))
        page.write_text(text)
        (self.board / "more.html").write_text("<h1>Ranks</h1>")
        self.assertIn("more.html: no file of a board", against(1))
        (self.board / "more.html").unlink()
        self.assertIn("0 problems", against(0))

    def request(self):
        """What somebody sends, as docs/maintaining.md has it: a worktree beside the one whose build checks it."""
        self.git("worktree", "add", "-q", "--detach", "request")
        return self.dir / "request/board"

    def check_request(self, expect, against="main", cwd=None, **more):
        done = subprocess.run(command_line("leaderboard", "check", "--board", self.dir / "request/board", "--against", against),
                              capture_output=True, text=True, env={**self.environment, **more}, cwd=cwd or self.dir)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def win(self, board):
        """Every episode of the rival succeeds, and what was vouched for is made to fit."""
        place = self.rival.relative_to(self.board)
        before, cells = entry_hash(board / place), board / place / "cells.jsonl"
        cells.write_text("".join(canonical({**line, "outcomes": {arm: "." * len(letters) for arm, letters in line["outcomes"].items()}})
                                 for line in map(json.loads, cells.read_text().splitlines())))
        (board / place / "verifications.jsonl").unlink()
        self.add_line(board / place, cells=12)
        line = (board / place / "verifications.jsonl").read_text()
        for name, value in ("vouched.json", [sha256(line.strip())]), ("vouched_entries.json", None):
            if (board / name).exists():
                vouched = json.loads((board / name).read_text())
                vouched[entry_hash(board / place)] = value or vouched[before]
                del vouched[before]
                (board / name).write_text(json.dumps(vouched, indent=1, sort_keys=True) + "\n")
        self.call("leaderboard", "build", "--board", board)

    def test_a_board_that_is_a_repository_runs_nothing(self):
        """git takes a directory with HEAD, objects and refs for a repository, and its config names commands."""
        board = self.request()
        for forged in False, True:
            with self.subTest(forged=forged):
                if forged:
                    self.win(board)
                git = ("git", "--git-dir", board, "--work-tree", board, "-c", "user.name=a", "-c", "user.email=a@b.c")
                if not forged:
                    subprocess.run(["git", "init", "-q", "--bare", "-b", "main", board], check=True)
                (board / "config").write_text("[core]\n\trepositoryformatversion = 0\n\tbare = false\n\tworktree = .\n")
                subprocess.run([*git, "add", "-A", "."], cwd=board, check=True)
                blob = subprocess.run([*git, "rev-parse", ":README.md"], cwd=board, check=True, capture_output=True, text=True).stdout.strip()
                for name in "index", "COMMIT_EDITMSG", "objects/x", "refs/x", "logs/x", "branches/x":  # git adds none of them
                    subprocess.run([*git, "update-index", "--add", "--cacheinfo", f"100644,{blob},{name}"], cwd=board, check=True)
                subprocess.run([*git, "commit", "-qm", "mine"], cwd=board, check=True)
                with open(board / "config", "a") as config:
                    config.write(f'\tfsmonitor = "touch {self.dir}/PWNED; false"\n')
                for where in self.dir, board, self.dir / "request":
                    said = self.check_request(1, cwd=where)
                    self.assertFalse((self.dir / "PWNED").exists())
                    for name in "HEAD", "config", "index", "objects", "refs":
                        self.assertIn(f"\n{name}: no file of a board", said)
                    self.assertEqual("an outcome or a cell changed since main" in said, forged)
        for name in "HEAD", "config", "index", "objects", "refs", "description", "hooks", "info", "branches", "logs", "COMMIT_EDITMSG":
            shutil.rmtree(board / name) if (board / name).is_dir() else (board / name).unlink(missing_ok=True)
        self.assertIn("cells.jsonl: an outcome or a cell changed since main", self.check_request(1))
        (board / ".git").write_text("gitdir: ../../.git\n")
        self.assertIn("request/board: a repository of its own; a board is a directory of one", self.check_request(2))

    def test_a_revision_is_that_of_the_repository_in_which_check_is_called(self):
        """Not of the board's, nor of one that variables name; a branch is none of a fork's tags."""
        board = self.request()
        self.assertIn("0 problems", self.check_request(0))
        self.win(board)
        for words in ["add", "board"], ["commit", "-qm", "forged"], ["checkout", "-q", "-b", "theirs"], ["tag", "main"]:
            self.git(*words, cwd=board.parent)
        self.git("clone", "-q", "-b", "theirs", ".", "fork")
        self.git("branch", "-qf", "main", cwd=self.dir / "fork")
        said = "cells.jsonl: an outcome or a cell changed since main"
        self.assertIn(said, self.check_request(1))
        self.git("tag", "-d", "main")
        self.assertIn(said, self.check_request(1, GIT_DIR=str(self.dir / "fork/.git")))
        shutil.rmtree(board.parent)
        (self.dir / "fork").rename(board.parent)
        self.assertIn(said, self.check_request(1))
        shutil.rmtree(board.parent / ".git")
        outside = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-test-"))
        self.addCleanup(shutil.rmtree, outside)
        self.assertIn("--against main: run the command in the checkout that has this revision", self.check_request(2, cwd=outside))
        board.parent.rename(outside / "request")
        (board.parent).symlink_to(outside / "request")
        self.assertIn("request: a symbolic link; a board is in a working tree of git", self.check_request(2))

    def test_what_a_board_does_not_have(self):
        """A web server, git or a browser may obey it."""
        shutil.copytree(self.board, self.dir / "before")
        for name, says in ((".htaccess", ".htaccess: no file of a board"), (".gitattributes", ".gitattributes: no file of a board"),
                           (".well-known/x.html", ".well-known: no file of a board"), ("answers/.htaccess", "answers/.htaccess: no entry is based on it"),
                           ("vouched.json.1234abcd.tmp", "vouched.json.1234abcd.tmp: no file of a board"), ("q9.html", "q9.html: no file of a board"),
                           ("entries/.gitattributes", "entries/.gitattributes: expected only directories"), (".adding/x.html", ".adding/x.html: no file of a board"),
                           (".adding/entries/a/b/.htaccess", ".adding/entries/a/b/.htaccess: no file of a board"),
                           (".adding/README.md", ".adding/README.md: no file of a board"),
                           ("scenes/x.html", "scenes/x.html: no picture that scenes.json lists"),
                           ("scenes/.git/config", "scenes/.git: no picture that scenes.json lists"),
                           ("entries/lga/.htaccess", "entries/lga/.htaccess: expected only directories"), ("entries/lga/a/HEAD", "a/HEAD: expected only directories"),
                           (f"{self.rival.relative_to(self.board)}/.git/config", ".git: expected only entry.json, cells.jsonl and verifications.jsonl")):
            for words in [], ["--against", "HEAD"]:
                with self.subTest(name, words=words):
                    file = self.board / name
                    file.parent.mkdir(parents=True, exist_ok=True)
                    file.write_text("<script>alert(1)</script>")
                    self.assertIn(says, self.leaderboard("check", *words, expect=1).stderr)
                    shutil.rmtree(self.board)
                    shutil.copytree(self.dir / "before", self.board)
        (self.rival / "cells.jsonl").unlink()
        (self.rival / "cells.jsonl").symlink_to(self.dir / "before" / self.rival.relative_to(self.board) / "cells.jsonl")
        self.assertIn("cells.jsonl: a symbolic link, which a run may not hold", self.leaderboard("check", "--against", "HEAD", expect=1).stderr)
        shutil.rmtree(self.board)
        shutil.copytree(self.dir / "before", self.board)
        (self.board / ".adding").symlink_to("/")
        self.assertIn(".adding: a symbolic link", self.leaderboard("check", expect=1).stderr)
        (self.board / "answers").symlink_to(self.dir / "request")
        (self.dir / "request").mkdir()
        (self.dir / "request/mine").write_text("")
        self.assertIn("answers: a symbolic link", self.leaderboard("check", expect=1).stderr)
        self.leaderboard("build")
        self.assertTrue((self.dir / "request/mine").exists())

    def test_a_score_that_nobody_computed(self):
        score = json.loads((next(BOARD.glob("entries/lga/*/words-abstraction/entry.json"))).read_text())["score"]
        file = self.rival / "entry.json"
        entry = read_entry(file)
        self.assertNotIn("score", entry)
        file.write_text(json.dumps({**entry, "score": {**score, "wrong": {}}}, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
        said = self.check(expect=1)
        self.assertIn("entry.json: /score appeared since HEAD", said)
        self.assertIn(f"{self.rival.relative_to(self.board)}: entry.json is not the one that vouched_entries.json has the hash of", said)
        self.assertEqual(self.rows()[self.rival.parent.name][2], "recomputed; not yet replayed; claimed by The lgabench authors: replayed")
        (self.board / "vouched_entries.json").unlink()
        self.assertIn("q2-leaderboard: vouched_entries.json has no hash of its entry.json", self.leaderboard("check", expect=1).stderr)

    def test_a_revision_that_is_not_there(self):
        for revision in "origin/mian", "main:board", "main\nmain:board/entries\nmain":  # none, a directory, three names of which one is a board without files
            said = self.leaderboard("check", "--against", revision, expect=2).stderr
            self.assertIn(f"--against {revision}: expected a revision of git that {self.dir} has, and its history", said)

    def test_a_preset_or_an_engine_that_nobody_has(self):
        def few(entry):
            entry["preset"].update(seeds=[0], episodes=10)
        forged = self.forge(few, lambda line: None if line["training_seed"] else {**line, "outcomes": {
            arm: "." * 10 for arm in line["outcomes"]}})
        self.assertRegex(self.check(expect=1), rf"{forged.parent.name}/q2-leaderboard: preset q2-leaderboard: \w+ here, \w+ in the entry")
        shutil.rmtree(forged)
        self.invent(lambda entry: entry["identity"]["engine"].update(version="9.9"))
        self.assertIn("version of mujoco: 0.1 here, 9.9 in the entry", self.check(expect=1))

    def test_sizes_are_bounded_before_anything_is_computed(self):
        self.forge(lambda entry: entry["preset"].update(episodes=1000000), like=self.entry("random_object"))
        started = time.monotonic()
        self.assertIn("/preset/episodes: expected a whole number from 1 to 10000", self.leaderboard("check", "--against", "HEAD", expect=1).stderr)
        self.assertLess(time.monotonic() - started, 60)

    def test_commands_on_pages_are_words(self):
        evil = "text'; touch owned; '"
        forged = self.invent(lambda entry: entry["identity"]["options"].update(network=evil))
        self.add_line(forged, cells=12)
        self.leaderboard("vouch", forged.parent.name, "1")
        self.rows()
        data = json.loads(re.search(r'id="data">(.*?)</script>', (self.board / "q2.html").read_text(), re.S)[1])
        command = next(entry["command"] for entry in data["entries"] if entry["id"] == forged.parent.name)
        self.assertIn(f"network={evil}", next(word for word in shlex.split(command) if word.startswith("lga+")))
        subprocess.run(["sh", "-c", f"lgabench() {{ :; }}; {command}"], cwd=self.dir, check=True)
        self.assertFalse((self.dir / "owned").exists())

    def test_a_replay_compares_what_a_method_asks_and_its_options(self):
        """Before anything is played: a plugin that asks for more than its entry says would be given it."""
        for like, change, says in (
                ("human", lambda entry: entry["identity"].pop("asks"), "whom human asks: specify here, nobody in the entry"),
                ("lga", lambda entry: entry["identity"]["options"].pop("loss"), 'options of lga: {"batch_size"'),
                ("lga", lambda entry: entry["identity"]["options"].update(loss="none"), "loss")):
            with self.subTest(says):
                forged = self.forge(change, like=self.entry(like))
                said = self.leaderboard("verify", forged.parent.name, "--by", "B. Reader", "--cells", "1", expect=2).stderr
                self.assertIn(says, said)
                self.assertFalse((forged / "verifications.jsonl").exists())

    def test_counts_that_contradict_each_other(self):
        for members, says in (({"flips": 99999}, "/flips: expected a whole number from 0"),
                              ({"bit_identical": 31}, "/bit_identical: expected a whole number from 0"),
                              ({"bit_identical": 12, "cells_": 1, "flips": 1}, "/flips: expected"),
                              ({"flips": 99}, "/passed: expected false, by its counts"),
                              ({"machine": {"processor": "AMD EPYC", "instructions": "AVX-512"}}, "/passed: expected false, by its counts"),
                              ({"machine": {"processor": "AMD EPYC with AVX-512"}}, "/passed: expected false, by its counts"),
                              ({"machine": {"processor": "AMD EPYC", "instructions": "MMX"}}, "/machine/instructions: expected AVX-512"),
                              ({"flips": 8, "only_recorded": 8}, "/passed: expected false, by its counts"),
                              ({"episodes": 1}, "/episodes: expected"), ({"by": "B" * 201}, "/by: expected at most 200 bytes"), ({"when": "now"}, "/when: expected a date")):
            with self.subTest(says, **members):
                file = self.rival / "verifications.jsonl"
                text = file.read_text()
                members.pop("cells_", None)
                self.add_line(self.rival, cells=12, **members)
                self.assertIn(says, self.leaderboard("check", expect=1).stderr)
                file.write_text(text)

    def test_instructions_are_inferred_of_no_other_entry(self):
        file = self.board / "instructions.json"
        inferred = json.loads(file.read_text())
        for id, value, says in (("0" * 16, "AVX2", "no entry of this id whose record lacks its instructions"),
                                (self.rival.parent.name, "MMX", "expected one of AVX-512, AVX2, without FMA")):
            file.write_text(json.dumps({**inferred, id: value}))
            self.assertIn(f"instructions.json: /{id}: {says}", self.leaderboard("check", expect=1).stderr)

    def supersede(self, entry, outcome=".", **evidence):
        """By hand: other outcomes in an entry's place, whose files go where leaderboard supersede puts them."""
        old, before = read_entry(entry / "entry.json"), entry_hash(entry)
        kept = self.board / "superseded" / old["id"] / before[:16]
        shutil.copytree(entry, kept)
        (entry / "verifications.jsonl").unlink()
        lines = [{**line, "digest": "0" * 64, "outcomes": {arm: outcome * len(letters) for arm, letters in line["outcomes"].items()}}
                 for line in map(json.loads, (entry / "cells.jsonl").read_text().splitlines())]
        (entry / "cells.jsonl").write_text("".join(map(canonical, lines)))
        new = {**old, "supersedes": [*old.get("supersedes", []), {"hash": before, "when": "2026-12-01", "reason": "one order"}]}
        (entry / "entry.json").write_text(json.dumps(new, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
        return kept

    def forget(self, *hashes):
        for name in "vouched.json", "vouched_entries.json":
            vouched = json.loads((self.board / name).read_text())
            (self.board / name).write_text(json.dumps({key: value for key, value in vouched.items() if key not in hashes}, indent=1, sort_keys=True) + "\n")

    def test_only_the_maintainers_supersede(self):
        """With all old bytes where they belong: an entry that nobody vouches for, and the rival's."""
        forged, rival = self.invent(), self.rival.relative_to(self.board)
        self.leaderboard("build")
        self.git("add", "board")
        self.git("commit", "-qm", "an entry")
        self.add_line(forged, cells=3)
        self.git("add", "board")
        self.git("commit", "-qm", "a line")
        place = forged.relative_to(self.board)
        self.supersede(forged, "a")
        said = self.check(expect=1)
        self.assertIn(f"{place}: superseded since HEAD: only the maintainers do that (--maintainer)", said)
        self.assertIn("1 problem\n", said)
        self.assertIn("0 problems", self.check("--maintainer", expect=0))
        before = entry_hash(self.rival)
        self.supersede(self.rival)
        self.assertIn("vouched.json: /" + before, self.check(expect=1))
        self.forget(before)
        said = self.check(expect=1)
        self.assertIn(f"{rival}: superseded since HEAD: only the maintainers do that", said)
        self.assertIn("vouched.json: changed since HEAD: it is the maintainers'", said)
        self.assertIn("0 problems", self.check("--maintainer", expect=0))
        self.assertEqual(self.rows()[rival.parts[2]][2], "recomputed; not yet replayed")

    def test_what_was_superseded_stays(self):
        before = entry_hash(self.rival)
        self.add_line(self.rival, cells=3)  # what made somebody look
        kept, place = self.supersede(self.rival), self.rival.relative_to(self.board)
        at = kept.relative_to(self.board)
        self.forget(before)
        lines = (kept / "verifications.jsonl").read_text()
        (kept / "verifications.jsonl").write_text("")  # not the bytes that the board had
        said = self.check("--maintainer", expect=1)
        self.assertIn(f"{place}/cells.jsonl: an outcome or a cell changed since HEAD", said)
        self.assertIn(f"{at}: is no entry of the board whose place another took", said)
        (kept / "verifications.jsonl").write_text(lines)
        self.assertIn("0 problems", self.check("--maintainer", expect=0))
        self.git("add", "board")
        self.git("commit", "-qm", "superseded")
        self.assertIn("0 problems", self.check(expect=0))
        entry = (kept / "entry.json").read_text()
        (kept / "entry.json").write_text(entry.replace('"confinement": "Landlock 7, seccomp"', '"confinement": "none"'))
        self.assertNotEqual((kept / "entry.json").read_text(), entry)
        self.assertIn(f"{at}: changed since HEAD", self.check("--maintainer", expect=1))
        (kept / "entry.json").write_text(entry)
        cells = (kept / "cells.jsonl").read_text()
        (kept / "cells.jsonl").write_text(cells.replace('"digest":"', '"digest":"0', 1).replace(cells.split('"digest":"')[1][63], "", 1))
        self.check(expect=1)
        (kept / "cells.jsonl").write_text(cells)
        shutil.copytree(kept, kept.with_name("0" * 16))
        self.assertIn(f"expected at {at}, by what it is", self.check(expect=1))
        shutil.rmtree(kept.with_name("0" * 16))
        shutil.copytree(kept, kept.parent.parent / self.lga.parent.name / kept.name)
        self.assertIn(f"expected at {at}, by what it is", self.check(expect=1))
        shutil.rmtree(kept.parent.parent / self.lga.parent.name)
        (kept / "more.txt").write_text("")
        self.assertIn("expected only entry.json", self.check(expect=1))
        (kept / "more.txt").unlink()
        shutil.rmtree(kept)
        said = self.check("--maintainer", expect=1)
        self.assertIn(f"{at}, whose place it took, is not there", said)
        self.assertIn(f"{at}/cells.jsonl: is gone since HEAD", said)

    def test_a_history_that_nobody_has(self):
        """Beside an entry that is as it was."""
        kept = self.board / "superseded" / self.rival.parent.name / entry_hash(self.rival)[:16]
        shutil.copytree(self.rival, kept)
        self.assertIn(f"{kept.relative_to(self.board)}: no entry of this id names it in /supersedes", self.check("--maintainer", expect=1))
        shutil.rmtree(kept.parent.parent)
        entry = json.loads((self.rival / "entry.json").read_text())
        for history, says in (([{"hash": "0" * 64, "when": "2026-12-01", "reason": "x"}], "/supersedes appeared"), ([], "at least one entry"),
                              ([{"hash": "0" * 64, "when": "2026-12-01", "reason": "a\nb"}], "in one line")):
            (self.rival / "entry.json").write_text(json.dumps({**entry, "supersedes": history}, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
            self.assertIn(says, self.check("--maintainer", expect=1))

    def test_an_unconfined_run_cannot_hide(self):
        forged = self.invent(lambda entry: entry["evidence"][0].update(confinement="N/A"))
        self.assertEqual(self.rows()[forged.parent.name][2], "recomputed; not yet replayed; unconfined")


if __name__ == "__main__":
    unittest.main(verbosity=2)
