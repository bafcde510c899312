"""lgabench rescore: recorded actions judged by other tolerances, without the method.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 rescore_test.py Rescore
"""
import hashlib
import json
import unittest

import case

Q1 = ("run", "q1", "--scenarios", "heart,rotate_block", "--methods", "lga+policy=heat_map",
      "--demos", "3", "--seeds", "0", "--episodes", "6", "--layout", "cells")
MOBILE = ("run", "mobile", "--preset", "smoke", "--scenarios", "bring_fruit", "--episodes", "4", "--methods", "lga+policy=centroid")


class Rescore(case.BesideOneRun):
    run_of_class = (*Q1, "--engines", ",".join(sorted({"kinematic", case.PHYSICS})))

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def rescored(self, run, *judge, expect=0):
        """(cell, arm, index) -> the line of each episode."""
        self.said = self.call("rescore", run, *judge, "--json", "lines.jsonl", expect=expect)
        lines = [json.loads(line) for line in (self.dir / "lines.jsonl").read_text().splitlines()]
        for line in lines:
            self.assert_as_schema("rescored", line)
        return {(line["cell"], line["arm"], line["index"]): line for line in lines}

    def recorded(self, run):
        return {(path.parent.name, episode["arm"], episode["index"]): episode["success"]
                for path in self.dir.glob(f"{run}/cells/*/episodes.jsonl")
                for episode in map(json.loads, path.read_text().splitlines())}

    def assert_default_is_the_record(self, run):
        before = {path: path.read_bytes() for path in (self.dir / run).rglob("*") if path.is_file()}
        lines = self.rescored(run)
        self.assertEqual({key: line["rescored"] for key, line in lines.items()}, self.recorded(run))
        self.assertEqual({key: line["success"] for key, line in lines.items()}, self.recorded(run))
        self.assertEqual(before, {path: path.read_bytes() for path in (self.dir / run).rglob("*") if path.is_file()})
        return lines

    def assert_narrower_never_adds(self, run, options):
        """@returns how many succeed under each of them, from the widest to the narrowest."""
        counts, wider = [], None
        for option in options:
            succeed = {key for key, line in self.rescored(run, *option).items() if line["rescored"]}
            self.assertTrue(wider is None or succeed <= wider, option)
            counts.append(len(succeed))
            wider = succeed
        return counts

    def test_the_protocols_limits_give_what_was_recorded_and_narrower_ones_never_more(self):
        lines = self.assert_default_is_the_record("run")
        engines = {cell["engine"] for cell, _ in self.cells("run").values()}
        self.assertEqual(engines, {"kinematic", case.PHYSICS})
        brought = [line["distance_m"] for line in lines.values() if line["scenario"] == "heart" and line["success"]]
        self.assertLessEqual(max(brought), .1)
        limits = [("--position-tolerance", str(m)) for m in (10, .1, .03, .005, 0)]
        counts = self.assert_narrower_never_adds("run", [*limits[:1], (), *limits[2:]])
        self.assertGreater(counts[0], counts[-2])
        self.assertGreater(counts[1], counts[-1])
        turns = self.assert_narrower_never_adds("run", [("--angle-tolerance", str(d)) for d in (180, 15, 1, 0)])
        self.assertGreater(turns[0], turns[-1])

    def test_the_second_environment_likewise(self):
        self.call(*MOBILE, "--out", "mobile")
        self.assert_default_is_the_record("mobile")
        counts = self.assert_narrower_never_adds("mobile", [(), *(("--position-tolerance", str(m)) for m in (.1, .02, 0))])
        self.assertGreater(counts[0], 0)
        self.assertEqual(counts[-1], 0)
        self.assertIn("mobile does not compare actions by pose", self.call("rescore", "mobile", "--judge", "pose", expect=2).stderr)

    def test_its_lines_and_its_summary_agree(self):
        lines = self.rescored("run", "--judge", "pose", "--within", "0.05,0.06")
        printed = json.loads(self.call("rescore", "run", "--judge", "pose", "--within", "0.05,0.06", "--format", "json").stdout)
        rows = {(row["engine"], row["scenario"], row["method"]): row["success"] for row in printed["rows"]}
        cells = {key: cell for key, (cell, _) in self.cells("run").items()}
        for (engine, scenario, method), success in rows.items():
            some = [line["rescored"] for key, line in lines.items() if cells[key[0]]["method"]["id"] == method
                    and cells[key[0]]["engine"] == engine and line["scenario"] == scenario]
            if some:  # no mean
                self.assertAlmostEqual(sum(some) / len(some), success)
        self.assertTrue(all(line["distance_m"] < 1e-6 for line in lines.values() if line["row"] == "oracle"))

    def test_the_protocols_judge_makes_the_reports_summary(self):
        self.call("report", "run")
        self.assertEqual(self.call("rescore", "run", "--format", "csv").stdout, (self.dir / "run/summary.csv").read_text())

    def test_the_table_has_the_means_of_the_lines(self):
        lines = self.rescored("run", "--position-tolerance", "0.03").values()
        lga = [line for line in lines if line["row"].startswith("lga")]
        off = [line["distance_m"] for line in lga if line["distance_m"] is not None]
        row = next(line.split() for line in self.said.stdout.splitlines() if line.startswith("lga"))
        self.assertEqual(row[1:4], ["test", "3", str(len(lga))])
        for printed, exact in zip(row[4:7], [sum(line["success"] for line in lga) / len(lga),
                                             sum(line["rescored"] for line in lga) / len(lga), sum(off) / len(off)]):
            self.assertAlmostEqual(float(printed), exact, delta=.0005)

    def test_what_cannot_be_played_again_is_named_and_left_out(self):
        key, cell = next((key, cell) for key, (cell, _) in sorted(self.cells("run").items()) if cell["method"]["id"] == "oracle")
        file = self.dir / "run/cells" / key / "episodes.jsonl"
        episodes = [json.loads(line) for line in file.read_text().splitlines()]
        episodes[1]["scene"] = "0" * 16
        episodes[2].update(success=False, failure="wrong_object", attribution=None)
        self.rewrite(key, "episodes.jsonl", "".join(json.dumps(e) + "\n" for e in episodes))
        lines = self.rescored("run", expect=3)
        for index, why in (1, "samples another scene"), (2, "ends as none here, recorded as wrong_object"):
            line = lines[key, "test", index]
            self.assertIsNone(line["rescored"])
            self.assertIn(why, line["problem"])
            self.assertIn(f"left out: {key}/test/{index}: ", self.said.stderr)
        self.assertIn("2 episodes could not be judged again and are left out", self.said.stderr)
        refused = self.call("rescore", "run", "--format", "tables", expect=2)
        self.assertIn("--format tables: expected that each episode can be judged again", refused.stderr)
        self.assertEqual(refused.stdout, "")
        self.assertTrue(all("problem" not in line for at, line in lines.items() if at not in ((key, "test", 1), (key, "test", 2))))

    def test_what_is_wrong_is_said_in_a_line(self):
        for words, says in [(("--within", "1,1"), "expected --judge pose"), (("--judge", "eye"), 'no judge "eye"'),
                            (("--judge", "pose", "--position-tolerance", "1"), "expected --judge physics"),
                            (("--position-tolerance", "-1"), "expected a number from 0 to 10")]:
            said = self.call("rescore", "run", *words, expect=2).stderr
            self.assertEqual(said.count("\n"), 1, said)
            self.assertIn(says, said)
        self.assertIn("run.json", self.call("rescore", "nowhere", expect=2).stderr)

    def rewrite(self, cell, name, text):
        """As the worker would have written it: read_cell() checks the bytes."""
        (self.dir / "run/cells" / cell / name).write_text(text)
        file = self.dir / "run/cells" / cell / "status.json"
        status = json.loads(file.read_text())
        status["files"][name] = hashlib.sha256(text.encode()).hexdigest()
        file.write_text(json.dumps(status))


if __name__ == "__main__":
    unittest.main()
