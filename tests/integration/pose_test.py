"""Success by pose: the same actions judged by their distance from the oracle's.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 pose_test.py ByPose
"""
import csv
import io
import unittest

import case

PLAYED = ("--seeds", "0", "--demos", "2", "--episodes", "20", "--methods", "lga+policy=heat_map", "--answers", "recorded")


class ByPose(case.BesideOneRun):
    run_of_class = ("run", "q1", "--scenarios", "heart,rotate_block", *PLAYED)

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def rates(self, *judge):
        """(scenario, method) -> success."""
        printed = self.call("rescore", "run", "--format", "csv", *judge).stdout
        return {(row["scenario"], row["method"]): float(row["success"]) for row in csv.DictReader(io.StringIO(printed))}

    def test_a_wider_tolerance_takes_more_and_the_oracle_always_succeeds(self):
        def judged(begin, end):
            return self.rates("--judge", "pose", "--within", f"{begin},{end}")

        exact, near, anywhere = judged(0.0001, 0.0001), judged(0.07, 0.1), judged(10, 10)
        for scenario in "heart", "rotate_block":
            self.assertEqual(exact[scenario, "oracle"], 1)
            self.assertEqual(exact[scenario, "lga"], 0)
            self.assertGreater(near[scenario, "lga"], .5)
            random = [rates[scenario, "random_object"] for rates in (exact, near, anywhere)]
            self.assertEqual(random, sorted(random))
        self.assertEqual(anywhere["heart", "constant_action"], 1)
        self.assertEqual(self.rates("--judge", "pose"), near)  # the default

    def test_a_turn_counts_where_the_task_asks_for_one(self):
        turned = self.rates("--judge", "pose", "--within", "10,10")
        self.assertEqual(turned["rotate_block", "constant_action"], 1)  # the asked turn is a constant
        self.assertEqual(turned["rotate_block", "oracle"], 1)

    def test_nothing_of_the_run_changes(self):
        self.call("report", "run")
        before = {path: path.read_bytes() for path in (self.dir / "run").rglob("*") if path.is_file()}
        said = self.call("rescore", "run", "--judge", "pose", "--format", "tables").stdout
        self.assertTrue(said.startswith("Judged by pose: begins within 0.07 m of the oracle's action, ends within 0.1 m"), said[:200])
        old = self.call("report", "run", "--judge", "pose")
        self.assertEqual(old.stdout, said)
        self.assertIn("report --judge pose is accepted for one more release; write lgabench rescore run --judge pose --format tables\n",
                      old.stderr)
        after = {path: path.read_bytes() for path in (self.dir / "run").rglob("*") if path.is_file()}
        self.assertEqual(before, after)

    def test_what_cannot_be_judged_is_refused_in_a_line(self):
        self.call("run", "mobile", "--preset", "smoke", "--seeds", "0", "--demos", "1", "--episodes", "2", "--methods",
                  "lga+policy=centroid", "--no-reference", "--out", "mobile")
        said = self.call("rescore", "mobile", "--judge", "pose", expect=2).stderr
        self.assertIn("mobile does not compare actions by pose", said)
        self.assertIn("expected --judge pose", self.call("report", "run", "--within", "1,1", expect=2).stderr)
        self.assertIn("expected --format text, json or csv",
                      self.call("report", "run", "--judge", "pose", "--format", "latex", expect=2).stderr)
        self.call("report", "run", "mobile", "--judge", "pose", expect=2)


if __name__ == "__main__":
    unittest.main()
