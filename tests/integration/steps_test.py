"""Episodes of several steps through the programs, in examples/reach2d, which is found by its folders.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 steps_test.py Steps
"""
import json
import math
import pathlib
import unittest

from case import BUILD, FULL, Case

SOURCE = pathlib.Path(__file__).resolve().parents[2] / "examples/reach2d"
FOUND = {"LGABENCH_PLUGIN_PATH": str(BUILD / "tests/plugins/examples"), "LGABENCH_SCENARIO_PATH": str(SOURCE)}
# Enough to see what a state is worth: 0.76 of 200 episodes with it, 0.21 without.
LEARNS = ("--methods", "human+network=spot", "--no-reference", "--demos", "100", "--seeds", "0", "--episodes", "200", "--set", "human.epochs=200")

# How an environment breaks the interface (LGABENCH_TEST_BREAKS of tests/bad_plugins/environments) -> what check-plugin says.
AT = "environment reach2d: scene 0 of test, step "
BREAKS = {
    "nan": AT + "1: state: down: expected -0.5 to 0.5, got nan",
    "length": AT + "0: state: expected 2 numbers, got 1",
    "wins_and_goes_on": AT + "4: a success in an episode that did not end",
    "wins_and_fails": AT + '4: the failure is "not_reached" of a success',
    "ends_without_a_word": AT + '1: the failure of an episode that is over is "goes_on"',
    "fails_and_goes_on": AT + '1: the failure of an episode that goes on is "not_reached"',
    "never_ends": "one of them: scene 9 of test, step 20: the oracle has not ended it",
    "oracle_waits": "one of them: scene 9 of test, step 20: not_reached",
    "oracle_stops": AT + "0: the oracle says that nothing is left to do, and the scenario has no may_stop",
    "remembers": "a scene played again ended differently",
    "word": ': the failure is "lost_way", expected one that the environment names: not_reached, wrong_disc',
    "one_object": "any object in scenes of reach2d_red: only what is meant is taken",
}


class Steps(Case):
    def setUp(self):
        super().setUp()
        self.environment.update(FOUND)

    def run_suite(self, *more):
        self.call("run", str(SOURCE / "reach2d_suite.json"), "--answers", "none", "--engines", "own", *more, "--out", "run", timeout=2000)
        self.assert_matches_schemas("run")

    def lines(self, row):
        for cell in sorted((self.dir / "run/cells").iterdir()):
            if json.loads((cell / "cell.json").read_text())["method"]["name"] == row:
                for line in (cell / "episodes.jsonl").read_text().splitlines():
                    yield cell.name, json.loads(line)

    @unittest.skipUnless(FULL, "./test --full plays it")  # two minutes of learning
    def test_a_state_is_worth_what_it_says(self):
        self.run_suite(*LEARNS)
        rows = {(row["method"], row["scenario"]): row for row in json.loads((self.dir / "run/summary.json").read_text())["rows"]}
        seen, blind = (rows["human", scenario] for scenario in ("reach2d_red", "reach2d_blind"))
        # Newcombe's 95 % interval of the difference, from Wilson's of each.
        off = math.hypot(seen["success"] - seen["low"], blind["high"] - blind["success"])
        self.assertGreater(seen["success"] - blind["success"] - off, .4)

    def test_every_step_is_recorded_shown_and_computed_again(self):
        self.run_suite("--methods", "human", "--demos", "1", "--seeds", "0", "--episodes", "6", "--set", "human.epochs=1")
        self.assertEqual({episode["success"] for _, episode in self.lines("oracle")}, {True})
        cell, longest = max(self.lines("oracle"), key=lambda one: len(one[1].get("then", [])))
        steps = 1 + len(longest["then"])
        self.assertGreater(steps, 3)
        episode = f"{cell}/test/{longest['index']}"
        told = self.call("replay", "run", episode, "--out", "episode.gif").stdout
        self.assertIn(f"episode.gif: {steps + 1} frames; {steps} steps, success as recorded", told)
        self.call("replay", "run", episode, "--out", "episode.png")
        self.assertIn("identical", self.call("verify", "run").stdout)
        page = (self.dir / "run/report.html").read_text()
        self.assertIn('"ends":{"0":["', page, "a picture after each step")
        self.assertIn("several steps", self.call("rescore", "run", "--judge", "pose", expect=2).stderr)
        self.assertIn("several steps", self.call("rescore", "run", "--position-tolerance", "0.1", expect=2).stderr)
        self.call("rescore", "run")

    def test_a_replay_in_another_environment_says_where_it_parts(self):
        self.run_suite("--methods", "human", "--demos", "1", "--seeds", "0", "--episodes", "2", "--set", "human.epochs=1")
        cell, episode = next(self.lines("oracle"))
        file = self.dir / "run/cells" / cell / "episodes.jsonl"
        changed = [json.loads(line) for line in file.read_text().splitlines()]
        changed[0]["then"] = changed[0].get("then", []) + [[0, 0], [0, 0]]
        file.write_text("".join(json.dumps(one) + "\n" for one in changed))
        steps = 1 + len(episode.get("then", []))
        self.assertIn(f"scene 0 of test, step {steps}: the episode is over here (none), recorded with {steps + 2} steps",
                      self.call("replay", "run", f"{cell}/test/0", "--out", "a.gif", expect=2).stderr)

    def test_demonstrations_are_trajectories(self):
        self.call("demos", "reach2d_red", "--engine", "own", "--n", "3", "--noisy", "2", "--out", "a.hdf5")
        self.assertRegex(self.call("demos", "--inspect", "a.hdf5").stdout, r"demo_0: ([5-9]|1\d|2\d) steps")

    def test_plugins_are_checked_on_sequences(self):
        plugins = BUILD / "lib/lgabench/plugins"
        self.assertIn("good", self.call("check-plugin", str(plugins / "human.so"), "--environment", "reach2d", "--set", "epochs=2").stdout)
        refused = self.call("check-plugin", str(plugins / "kinematic.so"), "--environment", "reach2d", expect=2).stderr
        self.assertIn("engine kinematic: environment reach2d has no engine plugin: expected own", refused)
        self.assertIn("the oracle succeeds in 50 of 50 scenes", self.call("check-scenario", "reach2d_red").stdout)

    def broken(self, how):
        self.environment.update(LGABENCH_PLUGIN_PATH=str(BUILD / "tests/plugins/broken"), LGABENCH_TEST_BREAKS=how)

    def test_what_breaks_the_interface_is_found_by_check_plugin(self):
        for how, said in BREAKS.items():
            with self.subTest(how):
                self.broken(how)
                told = self.call("check-plugin", str(BUILD / "tests/plugins/broken/reach2d.so"), expect=1).stdout
                self.assertIn(said, told)
        self.broken("")
        self.assertIn("no problem", self.call("check-plugin", str(BUILD / "tests/plugins/broken/reach2d.so")).stdout)

    def test_what_breaks_the_interface_costs_its_cells_alone(self):
        self.broken("nan")  # where there is a state
        self.call("run", str(SOURCE / "reach2d_suite.json"), "--answers", "none", "--methods", "human", "--demos", "1", "--seeds", "0",
                  "--episodes", "2", "--set", "human.epochs=1", "--engines", "own", "--out", "run", expect=3)
        for folder in (self.dir / "run/cells").iterdir():
            status = json.loads((folder / "status.json").read_text())
            if json.loads((folder / "cell.json").read_text())["scenario"]["id"] == "reach2d_blind":
                self.assertEqual(status["state"], "ok")
            else:
                self.assertEqual((status["state"], status["fault"]), ("failed", "host"))
                self.assertRegex(status["reason"], "^environment reach2d: scene 0 of (train|test), step 1: state: down: .*got nan$")


if __name__ == "__main__":
    unittest.main()
