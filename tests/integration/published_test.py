"""What this repository publishes: the versions of its methods, and its own leaderboard.

By hand: LGABENCH_FULL=1 python3 published_test.py Published
"""
import csv
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import unittest

from case import Case, command_line
from visible_ids import ids_of_file

SOURCE = pathlib.Path(__file__).parents[2]
BOARD = SOURCE / "results/leaderboard"


def cheapest_first(board):
    """method -> its entries that were not withdrawn, relative to the board, by the mean seconds of a cell."""
    entries = {}
    for file in sorted(board.glob("entries/*/*/*/cells.jsonl")):
        if "withdrawn" not in json.loads((file.parent / "entry.json").read_text()):
            seconds = statistics.mean(json.loads(line)["total_s"] for line in file.read_text().splitlines())
            entries.setdefault(file.parts[-4], []).append((seconds, file.parent.relative_to(board)))
    return {method: [place for _, place in sorted(places)] for method, places in entries.items()}


def replay_one_cell(case, places, *words):
    """What `leaderboard verify` says of the first entry of the board in `case.dir` that this build can play."""
    for place in places:
        done = subprocess.run(command_line("leaderboard", "verify", place, "--board", "board", "--cells", "1", "--by", "a test", *words),
                              capture_output=True, text=True, env=case.environment, cwd=case.dir, timeout=1200)
        if not re.search("not verified: .*: (version of |no (method|engine) )", done.stderr):  # older, or a stranger's
            return done.stdout or done.stderr
    raise unittest.SkipTest(done.stderr)


class Versions(Case):
    """A version of a method promises its actions: entries of one version, by two builds, are one entry."""
    golden = pathlib.Path(__file__).parent / "golden/versions.json"

    def test_a_shipped_methods_actions_change_with_its_version_alone(self):
        self.call("run", "q1", "--engines", "kinematic", "--scenarios", "heart,sweep_block_without_touching_pan", "--demos", "6",
                  "--seeds", "0", "--episodes", "12", "--set", "*.epochs=30", "--no-reference", "--out", "run")
        found = {}
        for key, (cell, status) in self.cells("run").items():
            self.assertEqual(status["state"], "ok")
            episodes = (self.dir / "run/cells" / key / "episodes.jsonl").read_text().splitlines()
            # To a centimetre: last bits are the processor's.
            actions = [[round(x, 2) for x in json.loads(line)["action"][:2]] for line in episodes]
            found.setdefault(cell["method"]["id"], {"version": cell["method"]["version"]})[cell["scenario"]["id"]] = actions
        if os.environ.get("LGABENCH_WRITE_GOLDEN"):
            self.golden.parent.mkdir(exist_ok=True)
            self.golden.write_text(json.dumps(found, sort_keys=True) + "\n")
        promised = json.loads(self.golden.read_text())
        self.assertEqual(sorted(found), sorted(promised))
        for method, now in found.items():
            if now["version"] != promised[method]["version"]:
                self.fail(f"{method}: version {now['version']}: LGABENCH_WRITE_GOLDEN=1 writes what it promises")
            for scenario in set(now) - {"version"}:
                for one, other in zip(now[scenario], promised[method][scenario]):
                    for x, y in zip(one, other):
                        self.assertAlmostEqual(x, y, delta=.021, msg=f"{method} acts otherwise in {scenario}, and is still "
                                               f"version {now['version']}: give it a new one")


class Published(Case):
    """The repository's own board, and the tables of it in docs/results, as continuous integration checks them."""

    def test_it_is_what_its_entries_make(self):
        done = self.call("leaderboard", "check", "--board", BOARD, "--documents", f"{SOURCE}/docs/results.md,{SOURCE}/docs/results")
        self.assertRegex(done.stdout, r"^\d+ entr(y|ies), 0 problems\n$")

    def test_fresh_commands_are_drawn_where_an_arm_has_words_of_its_own(self):
        shutil.copytree(BOARD, self.dir / "board", ignore=shutil.ignore_patterns("scenes", "*.html", "superseded"))
        entry = next(file.parent.parent.name for file in sorted((self.dir / "board/entries/lga").glob("*/perturbations-*/entry.json")))
        said = self.call("leaderboard", "verify", entry, "--fresh-commands", "f0" * 16, "--by", "a test", "--board", "board").stdout
        self.assertRegex(said, r"^agrees  \S+: 40 of 40 drawn commands exact \(lga: 40\), \d+ of \d+ published")

    def test_no_entry_has_another_order_of_additions(self):
        """Heat maps that AVX2 trained before vectors of every width added in one order."""
        inferred = json.loads((BOARD / "instructions.json").read_text())
        found = []
        for file in BOARD.glob("entries/*/*/*/entry.json"):
            entry = json.loads(file.read_text())
            if entry["identity"].get("options", {}).get("policy") == "heat_map" and "withdrawn" not in entry \
                    and inferred.get(entry["id"]) == "AVX2" and "instructions" not in entry["evidence"][0]["machine"]:
                found.append(entry["preset"]["suite"])
        self.assertEqual(found, [])

    def test_tables_of_a_suite_have_titles_of_their_own_and_the_newest_stands_first(self):
        for suite in re.split(r"^## ", (BOARD / "README.md").read_text(), flags=re.M)[1:]:
            titles, seeds = re.findall(r"^### (.*)$", suite, re.M), re.findall(r"scene seed (\d+)\.", suite)
            self.assertEqual(len(set(titles)), len(titles), suite.splitlines()[0])
            self.assertEqual(seeds, sorted(seeds, reverse=True), suite.splitlines()[0])
        tables = re.findall(r"success of every method in every suite.*?</thead>", (BOARD / "index.html").read_text(), re.S)
        self.assertEqual(len(tables), 3)
        for table in tables:
            heads = re.findall(r"<th\b.*?</th>", table, re.S)
            self.assertEqual(len(set(heads)), len(heads))

    def test_rows_have_words_and_no_options(self):
        rows = re.findall(r"^\| (?:\d+|–) \| ([^|]+) \|", (BOARD / "README.md").read_text(), re.M)
        self.assertGreater(len(rows), 300)
        self.assertEqual([row for row in rows if re.search("[_=]", row)], [], "labels.json has words for each")

    def test_ranks_change_on_purpose_alone(self):
        """Rank and success of each published entry; each was replayed, and somebody vouches for that."""
        golden = pathlib.Path(__file__).parent / "golden/ranks.json"
        with open(BOARD / "leaderboard.csv", newline="") as file:  # what its entries make, as the test above has seen
            rows = {(row["id"], row["ranking"]): row for row in csv.DictReader(file) if row["demonstrations"] == "all"}
        found = {" ".join(name): f'{row["rank"] or "-"} {row["paired_share"] or row["success"]}' for name, row in rows.items()}
        if os.environ.get("LGABENCH_WRITE_GOLDEN"):
            golden.write_text(json.dumps(found, sort_keys=True, indent=0) + "\n")
        self.assertEqual(found, json.loads(golden.read_text()))
        self.assertEqual({row["tier"] for row in rows.values()} - {"replayed", "reproduced"}, set())

    def test_a_ranking_is_sorted_by_success_and_its_ranks_do_not_decrease(self):
        with open(BOARD / "leaderboard.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["demonstrations"] == "all"]
        rankings = {}
        for row in rows:
            rankings.setdefault((row["suite"], row["preset"], row["ranking"]), []).append(row)
        self.assertEqual({ranking for _, _, ranking in rankings}, {"any policy", "paper's network", "answers only"})
        for name, own in rankings.items():
            success, ranks = [float(row["paired_share"] or row["success"]) for row in own], [int(row["rank"]) for row in own if row["rank"]]
            self.assertEqual(success, sorted(success, reverse=True), name)
            self.assertEqual(ranks, sorted(ranks), name)
            self.assertTrue(all(row["not_ranked"] for row in own if not row["rank"]), "a row without a rank says why")

    def test_a_reader_meets_no_ids(self):
        """Suites, arms, scenarios, methods, policies: a page has their titles."""
        for page in sorted(BOARD.glob("*.html")):
            with self.subTest(page.name):
                self.assertEqual(ids_of_file(page.read_text()), [])

    def test_tables_of_a_page_have_titles_of_their_own(self):
        for page in sorted(BOARD.glob("*.html")):
            titles = re.findall(r'<h2 id="table\d+-title">([^<]*)<', page.read_text())
            self.assertEqual(len(titles), len(set(titles)), page.name)

    def test_what_build_does_for_a_new_entry_is_what_its_page_shows(self):
        """docs/entering-the-leaderboard.md, step 4, with the entry of steps 1 to 3 as it was played once."""
        step = (SOURCE / "docs/entering-the-leaderboard.md").read_text().split("## 4. Add it")[1].split("\n## ")[0]
        place, = re.findall(r"`added (entries/\S+)`", step)
        shutil.copytree(BOARD, self.dir / "results/leaderboard")
        board = pathlib.Path("results/leaderboard")
        shutil.copytree(pathlib.Path(__file__).parent / "golden/entered", self.dir / board / place)
        printed = self.call("leaderboard", "build", "--board", board).stdout + self.call("leaderboard", "check", "--board", board).stdout
        shown = [line.strip() for line in re.findall("^    (.*)$", step, re.M)]
        self.assertEqual([line for line in shown if line in printed.splitlines()], printed.splitlines(), "build and check print these lines")
        readme = (self.dir / board / "README.md").read_text().splitlines()
        self.assertTrue([line for line in shown if line.startswith("|")])
        for line in shown:
            if line.startswith("|"):
                self.assertIn(line, readme)

    @unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays it")
    def test_a_cell_of_each_method_is_what_this_build_plays(self):
        shutil.copytree(BOARD, self.dir / "board")  # into which each replay is written
        entries = cheapest_first(self.dir / "board")
        if not entries:
            self.skipTest("the board has no entry")
        for method, places in entries.items():
            with self.subTest(method):
                self.assertRegex(replay_one_cell(self, places), "^agrees ")


if __name__ == "__main__":
    unittest.main(verbosity=2)
