"""Commands that mean nothing that stands there: what the smoke preset of `refusing` gives whoever knows the truth.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 refusing_test.py NothingMeant
"""
import json
import unittest

from case import Case


class NothingMeant(Case):
    def test_the_truth_is_right_in_both_arms_and_who_stops_at_once_in_one(self):
        self.call("run", "refusing", "--preset", "smoke", "--methods", "human+policy=point", "--out", "run", timeout=600)
        self.assert_matches_schemas("run")
        rows = {(row["method"], row["arm"]): row["success"] for row in json.loads((self.dir / "run/summary.json").read_text())["rows"]
                if row["scenario"] == "(mean)"}
        self.assertEqual([rows["human", arm] for arm in ("gone", "control")], [1, 1])
        self.assertEqual([rows["oracle", arm] for arm in ("gone", "control")], [1, 1])
        self.assertEqual([rows["stops_at_once", arm] for arm in ("gone", "control")], [1, 0])
        self.assertEqual(rows["random_object", "gone"], 0)
        self.assertIn("identical", self.call("verify", "run").stdout)
        self.call("rescore", "run")
        for option in ("--judge", "pose"), ("--position-tolerance", "0.1"):
            self.assertIn("may have none", self.call("rescore", "run", *option, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
