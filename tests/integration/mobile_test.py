"""The second environment through the same programs, methods and files.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 mobile_test.py Mobile
"""
import json
import unittest

from case import BUILD, Case, FULL

SMALL = ("--seeds", "0", "--demos", "1", "--episodes", "6", "--set", "*.epochs=2")


class Mobile(Case):
    def test_one_demonstration_is_enough_where_places_are_kept(self):
        methods = "lga+policy=centroid,lga+policy=heat_map,lga,gcbc_dart,gcbc_seg"
        self.call("run", "mobile", "--preset", "smoke", *SMALL, "--methods", methods, "--out", "run")
        self.assert_matches_schemas("run")
        rows = {(row["method"], row["arm"]): row for row in json.loads((self.dir / "run/summary.json").read_text())["rows"]
                if row["scenario"] == "(mean)"}
        for arm in "same_place", "moved":
            for policy in "centroid", "heat_map":
                self.assertGreaterEqual(rows[f"lga+policy={policy}", arm]["success"], .9, arm)
            self.assertEqual(rows["oracle", arm]["success"], 1)
        self.assertLess(rows["constant_action", "same_place"]["success"], .2)
        for row in rows.values():  # nothing is wrong with what is selected
            self.assertEqual(row["attribution"]["abstraction"], 0)
        self.assertIn("moved", (self.dir / "run/report.html").read_text())
        self.call("verify", "run", "--sample", "2" if FULL else "1")

    def test_what_to_fetch_and_where_to_put_it_is_found(self):
        methods = "human,factorial+scenes=truth+input=object_mask"
        self.call("run", "fetch", "--preset", "smoke", "--scenarios", "fetch_fruit", "--methods", methods, "--out", "run")
        self.assert_matches_schemas("run")
        rows = {(row["method"], row["arm"]): row for row in json.loads((self.dir / "run/summary.json").read_text())["rows"]
                if row["scenario"] == "(mean)"}
        for arm in "few", "many", "near":
            self.assertEqual(rows["human", arm]["success"], 1)
            self.assertEqual(rows["oracle", arm]["success"], 1)
            self.assertLess(rows["constant_action", arm]["success"], .3)
        self.assertLess(rows["factorial", "near"]["success"], .6)
        self.assertLess(rows["human", "perceived"]["success"], 1)
        self.call("verify", "run", "--sample", "2" if FULL else "1")

    def test_every_shipped_plugin_plays_here_as_on_the_tabletop(self):
        listed = json.loads(self.call("list", "--json").stdout)
        methods, engines = ([plugin["id"] for plugin in listed[kind]] for kind in ("methods", "engines"))
        self.assertGreater(len(methods), 7)
        # On the tabletop each is played by learning_test as well.
        for suite, scenario in (("mobile", "bring_fruit"), ("q1", "heart"))[:2 if FULL else 1]:
            tiny = ("run", suite, "--scenarios", scenario, "--demos", "1", "--seeds", "0", "--episodes", "1",
                    "--set", "*.epochs=1", "--no-reference")
            players = [method for method in methods if suite == "mobile" or method != "person_rule"]  # which reads words of a grammar alone
            self.call(*tiny, "--methods", ",".join(players), "--engines", "kinematic", "--out", suite)
            self.call(*tiny, "--methods", "lga", "--engines", ",".join(engines), "--out", f"{suite}-engines")
            for run, count in (suite, len(players)), (f"{suite}-engines", len(engines)):
                self.assert_matches_schemas(run)
                played = [[json.loads(line)["failure"] for line in file.read_text().splitlines()]
                          for file in (self.dir / run / "cells").glob("*/episodes.jsonl")]
                self.assertEqual(len(played), count)
                self.assertNotIn("method_error", sum(played, []))

    def test_every_arm_can_be_drawn(self):
        for arm in "few", "many", "near", "perceived":
            self.call("render", "fetch_ripe_fruit", "--suite", "fetch", "--arm", arm, "--out", f"{arm}.png")
            self.assertTrue((self.dir / f"{arm}.png").read_bytes().startswith(b"\x89PNG"))
        for scenario in "bring_fruit", "throw_away_drink":
            for arm in "train", "same_place", "moved", "crowd", "perceived", "perceived_hard":
                split = "train" if arm == "train" else "test"
                self.call("render", scenario, "--arm", arm, "--split", split, "--out", f"{arm}.png")
                self.assertTrue((self.dir / f"{arm}.png").read_bytes().startswith(b"\x89PNG"))

    def test_environments_are_listed_and_a_name_of_two_things_shows_both(self):
        self.assertIn("\nenvironments\n  mobile    tasks: bring, throw_away, fetch\n  tabletop  tasks: pick_and_place, ", self.call("list").stdout)
        said = self.call("info", "mobile").stdout
        self.assertIn("mobile, a suite in mobile\n", said)
        self.assertIn("\nmobile, an environment\n  task        bring\n", said)
        self.assertRegex(said, r"\n    waypoint\.cos  -1 to 1\n")
        self.assertEqual([thing["kind"] for thing in json.loads(self.call("info", "mobile", "--json").stdout)], ["suite", "environment"])
        self.assertEqual(json.loads(self.call("info", "tabletop", "--json").stdout)["kind"], "environment")

    def test_another_environments_members_are_refused_with_their_place(self):
        shipped = json.loads((BUILD / "share/lgabench/scenarios/bring_fruit.json").read_text())
        scenario = {**shipped, "id": "mine"}
        for member, value in ("hard", True), ("barrier_distances_m", [.2]):
            scenario["tests"] = [{"arm": "moved", member: value}]
            (self.dir / "mine.json").write_text(json.dumps(scenario))
            said = self.call("check-scenario", "mine.json", expect=2).stderr
            self.assertIn("mine.json: /tests/0", said)
            self.assertIn(member, said)


if __name__ == "__main__":
    unittest.main()
