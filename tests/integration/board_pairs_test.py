"""A board of errands, whose scenes come in pairs of commands: it ranks by the share of pairs that end right twice.

By hand: python3 board_pairs_test.py Pairs
"""
import csv
import json
import re
import shutil
import unittest

from case import BUILD, ENGINE, Case
from leaderboard_test import META
from verify_test import rewrite

ROWS = "human+policy=point", "errand+moment=first"
SUITE = {"id": "small_errands", "environment": "tabletop", "scenarios": ["errands_fruit", "errands_hammer_drill"],
         "layouts": ["continuous"], "engines": [ENGINE["run"][1]], "methods": [*ROWS], "demonstrations": [1], "seeds": [0],
         "episodes": 8, "scene_seed": 0, "options": {"errand": {"policy": "point"}},
         "presets": {"board": {"scene_seed": 77}}}


class Pairs(Case):
    def leaderboard(self, *words, expect=0):
        return self.call("leaderboard", *words, "--board", "board", expect=expect)

    def won(self, cells):
        """Of an entry's scenes 2k and 2k + 1: the shares of pairs and of episodes that ended right, means over scenarios."""
        pairs, episodes = [], []
        for cell in cells:
            letters = list(cell["outcomes"].values())
            both = [text[i:i + 2] == ".." for text in letters for i in range(0, len(text), 2)]
            pairs.append(sum(both) / len(both))
            episodes.append("".join(letters).count(".") / len("".join(letters)))
        return sum(pairs) / len(pairs), sum(episodes) / len(episodes)

    def test_pairs_are_entered_verified_superseded_and_ranked(self):
        shutil.copytree(BUILD / "share/lgabench", self.dir / "data", ignore=shutil.ignore_patterns("encoder"))
        (self.dir / "data/suites/small_errands.json").write_text(json.dumps(SUITE))
        self.environment["LGABENCH_DATA"] = str(self.dir / "data")
        (self.dir / "me.json").write_text(json.dumps(META))
        self.call("run", "small_errands", "--preset", "board", "--no-reference", "--out", "run")
        shutil.copytree(self.dir / "run", self.dir / "old")  # of another build, whose actions differ in a digit
        cell = next(path.parent for path in sorted((self.dir / "old").glob("cells/*/cell.json"))
                    if json.loads(path.read_text())["method"]["id"] == "errand")
        rewrite(cell, "episodes.jsonl", lambda e: {**e, "action": [x + 2 ** -40 for x in e["action"]]} if e["action"] else e)
        self.assertEqual(self.leaderboard("add", "old", "--entry", "me.json").stdout.count("added entries/"), 2)
        differs = re.search(r"^DIFFERS (entries/errand/\S+): 1 of 2 cells", self.leaderboard("verify", "--by", "B. Reader", expect=1).stdout, re.M)
        done = self.leaderboard("supersede", "run", "--by", "B. Maintainer", "--reason", "one order of additions")
        self.assertIn(f"superseded {differs[1]}\n", done.stdout)
        self.assertIn("the same bits already: ", done.stdout)

        board, entries = self.dir / "board", {}
        said = self.leaderboard("verify", "--by", "B. Reader").stdout
        self.assertEqual(len(re.findall(r"^agrees .*: 2 of 2 cells bit-identical, 0 of \d+ episodes ended differently", said, re.M)), 2, said)
        for place in board.glob("entries/*/*/*"):
            lines = (place / "verifications.jsonl").read_text().splitlines()
            self.leaderboard("vouch", place.relative_to(board), len(lines))
            entries[place.parts[-3]] = [json.loads(line) for line in (place / "cells.jsonl").read_text().splitlines()]
            entry = json.loads((place / "entry.json").read_text())
            self.assert_as_schema("entry", entry)
            self.assertEqual([one["pair"] for one in entry["preset"]["scenarios"]], SUITE["scenarios"])
        fresh = self.leaderboard("verify", "--fresh", "--by", "B. Reader").stdout
        self.assertEqual(len(re.findall(r"^agrees .* on fresh scenes", fresh, re.M)), 2, fresh)
        self.leaderboard("scenes")
        self.leaderboard("build")
        self.assertIn("2 entries, 0 problems", self.leaderboard("check").stdout)

        with open(board / "leaderboard.csv", newline="") as file:
            rows = {row["method"]: row for row in csv.DictReader(file) if (row["ranking"], row["demonstrations"]) == ("any policy", "all")}
        page, readme = ((board / name).read_text() for name in ("small_errands.html", "README.md"))
        for method, cells in entries.items():
            pairs, episodes = self.won(cells)
            self.assertAlmostEqual(float(rows[method]["paired_share"]), pairs, 5)
            self.assertAlmostEqual(float(rows[method]["success"]), episodes, 5)
            self.assertLessEqual(float(rows[method]["paired_low"]), pairs)
            self.assertIn(f"{pairs:.3f} [", readme)
        self.assertEqual(rows["errand"]["paired_share"], "0", "what mattered at first is the same in both")
        self.assertGreater(float(rows["errand"]["success"]), 0)
        self.assertGreater(float(rows["human"]["paired_share"]), .8)
        for text in page, readme:
            self.assertIn("Paired success: both commands of a pair right on one scene.", text)
        self.assertIn("| rank | method | policy | paired success |", readme)


if __name__ == "__main__":
    unittest.main()
