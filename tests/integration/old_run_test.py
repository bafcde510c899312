"""A run of lgabench 0.1.0 in the hands of this version: what is read, and what is refused with its reason.

run_0_1/ holds the two shards of `lgabench run q1 --scenarios heart --methods lga,lga+batch_norm=true,lga_l --demos 10
--seeds 0 --episodes 4 --set lga.epochs=20 --set lga_l.epochs=20`, as that version wrote them.
"""
import json
import pathlib
import shutil
import unittest

from case import Case

SHARDS = pathlib.Path(__file__).parent / "run_0_1"
SAME = ["run", "q1", "--layout", "cells", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "4",
        "--engines", "mujoco"]


class OldRuns(Case):
    def setUp(self):
        super().setUp()
        for shard in ("shard1", "shard2"):
            shutil.copytree(SHARDS / shard, self.dir / shard)

    def rows(self, run):
        rows = json.loads((self.dir / run / "summary.json").read_text())["rows"]
        return {row["method"]: row["successes"] for row in rows if row["scenario"] == "heart"}

    def test_is_merged_and_reported(self):
        said = self.call("merge", "old", "shard1", "shard2")
        self.assertIn("6 cells finished, 0 failed, 0 left out, 0 in none", said.stderr)
        self.assertEqual(json.loads((self.dir / "old/run.json").read_text())["version"], "0.1.0")
        self.assertRegex(self.call("report", "old").stderr, r"(?m)^old: made by lgabench 0\.1\.0, read by \d+\.\d+\.\d+$")
        won = {}
        for key, (cell, _) in self.cells("old").items():
            lines = (self.dir / "old/cells" / key / "episodes.jsonl").read_text().splitlines()
            won[cell["method"]["name"]] = sum(json.loads(line)["success"] for line in lines)
        self.assertEqual(self.rows("old"), won)
        self.assertEqual(set(won), {"lga+epochs=20", "lga+batch_norm=true+epochs=20", "lga_l+epochs=20",
                                    "constant_action", "random_object", "oracle"})
        page = (self.dir / "old/report.html").read_text()
        self.assertNotIn("samples another scene", page)
        self.assertEqual(self.call("merge", "old", "shard1", "shard2").stdout, said.stdout)  # again, into the same

    def test_is_neither_verified_nor_continued(self):
        before = {path: path.read_bytes() for path in (self.dir / "shard1").rglob("*") if path.is_file()}
        done = self.call("verify", "shard1", expect=2)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"shard1: a run of lgabench 0\.1\.0, and this is 0\.3\.0, .*: verify it with 0\.1\.0")
        for flags in ([], ["--resume"]):
            done = self.call(*SAME, "--methods", "lga", "--out", "shard1", *flags, expect=2)
            self.assertRegex(done.stderr, r"shard1: a run of lgabench 0\.1\.0, whose cells 0\.3\.0 cannot go on with")
        self.assertEqual(before, {path: path.read_bytes() for path in (self.dir / "shard1").rglob("*") if path.is_file()})

    def test_is_compared_by_what_its_rows_are(self):
        self.call("merge", "old", "shard1", "shard2")
        self.call(*SAME, "--methods", "lga,lga+network=plain,lga_l+network=plain+image=none", "--set", "*.epochs=20",
                  "--set", "*.batches=shuffled",
                  "--out", "new")
        done = self.call("compare", "old", "new", "--json")
        self.assertRegex(done.stderr, r"^old: made by lgabench 0\.1\.0, read by \d+\.\d+\.\d+\n$")
        compared = json.loads(done.stdout)
        self.assertEqual({(row["method_a"], row["method"]) for row in compared["rows"] if row["method_kind"] == "method"},
                         {("lga+batch_norm=true+epochs=20", "lga"), ("lga+epochs=20", "lga+network=plain"),
                          ("lga_l+epochs=20", "lga_l")})
        self.assertEqual((compared["only_a"], compared["only_b"], compared["other_scenes"]), (0, 1, []))  # most_demonstrated is newer
        loading = {time["method"]: (time["mean_a"], time["mean_b"] > 0) for time in compared["times"] if time["phase"] == "load_s"}
        self.assertEqual(loading["lga"], (0, True), "timing.json of 0.1.0 has it in select_s")
        for row in compared["rows"]:
            if row["method_kind"] == "reference":
                self.assertTrue(row["same_actions"], row["method"])
        elsewhere = ["continuous" if word == "cells" else word for word in SAME]
        self.call(*elsewhere, "--methods", "lga+network=plain", "--set", "lga.epochs=20", "--out", "other",
                  "--no-reference")
        self.assertRegex(self.call("compare", "old", "other", expect=2).stderr, "no cell finished in both")


if __name__ == "__main__":
    unittest.main()
