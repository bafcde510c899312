"""A scenario of one's own: written, checked, drawn, run, without touching what is installed.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 scenario_test.py OwnScenario
"""
import json
import os
import re
import shlex
import subprocess
import unittest

from case import BUILD, Case
from python_test import HAS_NUMPY, PYTHON

NAME = ("round", "--command", "Bring me something round.", "--types", "round,ring")
SMALL = ("--demos", "2", "--seeds", "0", "--episodes", "2", "--set", "*.epochs=2")


class OwnScenario(Case):
    def new(self, *words, expect=0):
        return self.call("new-scenario", *words, expect=expect)

    def test_from_nothing_to_a_table(self):
        said = self.new(*NAME, "--textures", "red,blue", "--hard", "--unseen", "Bring me the wheel.").stdout
        self.assertIn("lgabench check-scenario round.json", said)
        arms = [arm["arm"] for arm in json.loads((self.dir / "round.json").read_text())["tests"]]
        self.assertEqual(arms, ["test", "hard", "unseen"])
        checked = self.call("check-scenario", "round.json", "--scenes", "4").stdout
        for arm in "train", *arms:
            self.assertRegex(checked, rf"ok +{arm}, cells +the oracle succeeds in 4 of 4")
        self.assertIn("note     recorded answers", checked)
        self.assertTrue((self.dir / "round.png").read_bytes().startswith(b"\x89PNG"))
        self.call("render", "round", "--scenario-path", ".", "--arm", "hard", "--index", "1")

        run = ("run", "q1", "--scenarios", "round,heart", "--scenario-path", ".", *SMALL)
        self.assertIn("expected answers for round", self.call(*run, "--methods", "human", expect=2).stderr)
        self.call(*run, "--answers", "none", "--methods", "human,gcbc_seg", "--out", "out")
        self.assertEqual({cell["scenario"]["id"] for cell, _ in self.cells("out").values()}, {"round", "heart"})
        (self.dir / "round.json").unlink()  # a run holds the scenarios that it played
        self.call("report", "out")
        self.call("verify", "out", "--sample", "2")

    def test_the_command_that_is_printed_learns_what_the_truth_tells(self):
        said = self.new(*NAME).stdout
        self.assertEqual(self.call("check-scenario", "round.json", "--scenes", "2").returncode, 0)
        words, = re.findall(r"^  lgabench (run .*)$", said, re.M)
        self.call(*shlex.split(words), "--no-reference", "--out", "out")
        rows = json.loads((self.dir / "out/summary.json").read_text())["rows"]
        self.assertGreaterEqual(min(row["success"] for row in rows if row["method"] == "human"), .9)

    def test_near_misses_and_crowds_are_checked_for_what_they_test(self):
        self.new(*NAME, "--near-miss", "--distractors", "2:2")
        checked = self.call("check-scenario", "round.json", "--scenes", "4", "--layout", "continuous").stdout
        self.assertRegex(checked, r"ok +near_miss, continuous .* what shares most in \d; near misses in 4")
        self.new("usual", *NAME[1:], "--near-miss")
        arms = {arm["arm"]: arm["distractors"] for arm in json.loads((self.dir / "usual.json").read_text())["tests"]}
        self.assertEqual(arms, {"test": [1, 2], "near_miss": [4, 4]})
        self.new("anything", "--command", "Bring me anything.", "--types", "ALL", "--near-miss")
        checked = self.call("check-scenario", "anything.json", "--scenes", "4", "--layout", "continuous", expect=1).stdout
        self.assertIn("near_miss: expected a command that leaves out types or textures", checked)
        self.new("crowd", *NAME[1:], "--distractors", "4:6")
        checked = self.call("check-scenario", "crowd.json", "--scenes", "4", "--layout", "cells", expect=1).stdout
        self.assertIn("expected places for all", checked)
        checked = self.call("check-scenario", "heart", "--suite", "clutter", "--scenes", "2").stdout
        self.assertRegex(checked, r"ok +near_6, continuous")
        self.assertNotIn(", cells", checked, "the layouts of the suite alone")

    def test_a_leak_is_not_good(self):
        """Two hearts share their type, so that a policy without the command finds the target in half of the scenes."""
        left = ("--command", "Bring me the heart left of the bowl.", "--types", "heart", "--which", "left_of", "--relative-to", "bowl")
        self.new("left", *left)
        checked = self.call("check-scenario", "left.json", "--layout", "continuous").stdout
        self.assertRegex(checked, r"note +test, continuous +the object that shares most with the others is the target in [23]\d of 50 scenes")
        self.assertIn('-> give the arm "near_miss": true, and its objects share alike', checked)
        self.assertRegex(checked, r"\nno problem, \d notes: see above\n$")
        self.new("apart", "--space", "household", "--command", "Bring me the cutlery left of the bowl.", "--types", "fork,spoon,knife",
                 "--which", "left_of", "--relative-to", "bowl")  # docs/own-scenarios.md
        self.assertNotIn("shares most", self.call("check-scenario", "apart.json", "--layout", "continuous").stdout)

    def test_a_command_of_each_family_of_words(self):
        household = ("--space", "household")
        families = {
            "lookup": ("a red heart", "--types", "heart", "--textures", "red", "--careless", "heart/blue,green"),
            "category": ("a citrus fruit", *household, "--types", "orange,lemon", "--careless", "apple"),
            "colour": ("a heart in the colour of lava", "--types", "heart", "--textures", "red", "--careless", "heart/blue"),
            "negation": ("a heart of any colour but red", "--types", "heart", "--textures", "ALL but red", "--careless", "heart/red"),
            "union": ("a red heart or a blue star", "--types", "heart", "--textures", "red", "--also", "star/blue",
                      "--careless", "heart/blue", "--careless", "star/red"),
            "either": ("a red heart or a blue star", "--types", "heart", "--textures", "red", "--also", "star/blue"),
            "relation": ("the heart left of the bowl", "--types", "heart", "--which", "left_of", "--relative-to", "bowl"),
            "superlative": ("the letter that comes first in 'grate'", "--types", "letter A,letter E,letter G", "--which",
                            "first_in", "--order", "letter G,letter A,letter E"),
            "preference": ("something to drink", *household, "--types", "water bottle", "--words",
                           "soda can,water bottle,juice box", "--careless", "soda can,juice box", "--undecided", "mug"),
            "compound": ("the fruit nearest to the spoon, unless it is red", *household, "--types", "apple,pear",
                         "--textures", "ALL but red", "--which", "nearest_to", "--relative-to", "spoon", "--careless", "apple,pear/red"),
        }
        for family, (what, *words) in families.items():
            with self.subTest(family):
                self.new(family, "--command", f"Bring me {what}.", *words)
                checked = self.call("check-scenario", f"{family}.json", "--scenes", "4", "--layout", "continuous").stdout
                for arm in "train", "test":
                    self.assertRegex(checked, rf"ok +{arm}, continuous +the oracle succeeds in 4 of 4")
        made = json.loads((self.dir / "compound.json").read_text())
        self.assertEqual(made["commands"][0]["truth"]["target"]["which"], {
            "rule": "nearest_to", "of": {"object_types": ["spoon"], "textures": "ALL"}})
        self.assertEqual(made["commands"][0]["truth"]["target"]["sets"][0]["textures"], {"except": ["red"]})
        self.assertEqual(made["near_miss_sets"], [{"object_types": ["apple", "pear"], "textures": ["red"]}])

    def test_a_rule_that_is_wrong_is_one_line(self):
        for words, says in ((("--which", "behind"), "which/rule: expected one of left_of, right_of"),
                            (("--which", "left_of"), 'which: expected a member "of"'),
                            (("--which", "first_in", "--order", "heart,red"), "object types of the feature space alone")):
            with self.subTest(words):
                said = self.new("bad", "--command", "Bring me the heart.", "--types", "heart", *words, expect=2).stderr
                self.assertIn(says, said)
                self.assertEqual(said.count("\n"), 1)

    def test_a_method_that_asks_fails_where_nobody_answers(self):
        self.new(*NAME)
        words = ("--scenario-path", ".", *SMALL, "--answers", "none", "--methods", "lga", "--out", "out")
        done = self.call("run", "q1", "--scenarios", "round", *words, expect=3)
        self.assertIn('the method asks a language model about "Bring me something round.", and --answers none has no answers', done.stderr)

    def test_where_the_sentence_encoder_is_missing_that_is_said_first(self):
        self.environment["LGABENCH_ENCODER"] = str(self.dir / "none")
        lacks = '"Bring me something round." has no committed embedding, and the sentence encoder is not in'
        self.assertIn("First: " + lacks, self.new(*NAME).stdout)
        self.assertIn(lacks, self.call("check-scenario", "round.json", "--scenes", "2").stdout)
        run = ("run", "q1", "--scenario-path", ".", *SMALL, "--answers", "none", "--methods", "human")
        self.assertIn("note: " + lacks, self.call(*run, "--scenarios", "round", "--out", "own").stderr)
        self.assertNotIn("encoder", self.call(*run, "--scenarios", "heart", "--out", "shipped").stderr)
        del self.environment["LGABENCH_ENCODER"]
        (self.dir / "round.json").unlink()
        self.assertNotIn("encoder", self.new(*NAME).stdout)

    def test_scenarios_beside_a_suite_are_found(self):
        self.new(*NAME)
        suite = {"id": "mine", "environment": "tabletop", "scenarios": ["round"], "layouts": ["cells"],
                 "engines": ["mujoco"], "methods": ["human"], "demonstrations": [2], "seeds": [0], "episodes": 2,
                 "scene_seed": 0}
        (self.dir / "suites").mkdir()
        (self.dir / "round.json").rename(self.dir / "suites/round.json")
        (self.dir / "suites/mine.json").write_text(json.dumps(suite))
        self.call("run", "suites/mine.json", "--answers", "none", "--set", "*.epochs=2", "--out", "out")

    def test_what_is_wrong_is_said_and_nothing_is_written(self):
        for words, reason in [
            (("round", "--command", "Bring it."), "expected --types"),
            (("round", "--types", "round"), "expected --command"),
            ((*NAME, "--textures", "rde"), "rde"),
            ((*NAME, "--task", "sweep"), '"avoid" for sweep'),
            ((*NAME, "--task", "rotate"), "angle_deg"),
            ((*NAME, "--distractors", "x"), "--distractors: expected FEWEST:MOST"),
            ((*NAME, "--distractors", "01:2"), "--distractors: expected FEWEST:MOST"),
            ((*NAME, "--also", "heart,"), "a name of the feature space"),
            ((*NAME, "--directory", "a:b"), "a:b: expected a path without a colon"),
            (("round", "--command", "", "--types", "round"), "/commands/0/utterance: expected words, in a line"),
            ((*NAME, "--unseen", NAME[2]), "/commands/1/utterance: expected other words than those of a command that is demonstrated"),
        ]:
            with self.subTest(words):
                self.assertIn(reason, self.new(*words, expect=2).stderr)
                self.assertFalse((self.dir / "round.json").exists())
        self.assertNotIn("throw_away", self.new(*NAME, "--task", "none", expect=2).stderr, "a task of another environment")
        self.new(*NAME)
        self.assertIn("exists already", self.new(*NAME, expect=2).stderr)

    def test_what_cannot_be_shown_or_solved_is_a_problem(self):
        self.new("fixed", "--command", "Bring me the pallet.", "--types", "pallet")
        said = self.call("check-scenario", "fixed.json", "--scenes", "2", expect=1).stdout
        self.assertRegex(said, r"problem +test, cells +.*expected a distribution with a target that can be shown")
        self.assertFalse((self.dir / "fixed.png").exists())
        self.new("lone", "--command", "Bring me the heart.", "--types", "heart", "--distractors", "0:0")
        said = self.call("check-scenario", "lone.json", "--scenes", "2").stdout
        self.assertRegex(said, r"note +test, cells +any visible object is right")

    def test_ids_are_unique(self):
        said = self.new("heart", "--command", "Bring me the heart.", "--types", "heart", expect=2).stderr
        self.assertRegex(said, "new-scenario: expected another id than heart, which .*/heart.json has; nothing was written\n$")
        self.assertEqual(list(self.dir.iterdir()), [])
        self.new("other", "--command", "Bring me the heart.", "--types", "heart")
        own = json.loads((self.dir / "other.json").read_text())
        (self.dir / "heart.json").write_text(json.dumps({**own, "id": "heart"}))
        (self.dir / "other.json").unlink()
        for words in ("list",), ("render", "heart"):
            done = self.call(*words, "--scenario-path", ".", expect=2)
            self.assertIn("heart.json: expected another id", done.stderr)
        self.assertIn('no scenario "../suites/q1"', self.call("render", "../suites/q1", expect=2).stderr)
        self.assertIn("expected a directory", self.call("list", "--scenario-path", "missing", expect=2).stderr)
        os.rename(self.dir / "heart.json", self.dir / "mine.json")
        done = self.call("render", "mine", "--scenario-path", ".", expect=2)
        self.assertIn('/id: expected "mine", as the file is named', done.stderr)


    def test_names_are_those_of_plugins(self):
        for name in "bad name", "Round", "1bad", "a,b", "-x", "../x", "x" * 64:
            for verb in "new-scenario", "new-suite", "new-plugin":
                words = NAME[1:] if verb != "new-plugin" else ()
                said = self.call(verb, *words, "--", name, expect=2).stderr
                self.assertEqual(said, f'lgabench: {verb}: "{name}": expected at most 63 lower-case letters, digits and underscores, a letter first\n')
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_a_file_of_another_kind_is_said_to_be_one(self):
        self.call("select", "--suite", "q1", "--best-product", "best.json")
        said = self.call("check-scenario", "best.json", expect=2).stderr
        self.assertEqual(said, 'lgabench: best.json: /: expected a member "id"\n')

    def test_what_a_later_command_would_refuse_is_refused_when_it_is_read(self):
        self.new(*NAME)
        made = json.loads((self.dir / "round.json").read_text())
        for change, says in [({"id": "a,b"}, '/id: expected a name of at most 64 letters'),
                             ({"feature_space": "kitchen"}, '/feature_space: no feature space "kitchen", expected one of: '),
                             ({"commands": [{**made["commands"][0], "utterance": "two\nlines"}]}, "/commands/0/utterance: expected words, in a line")]:
            file = self.dir / f"{change.get('id', 'round')}.json"
            file.write_text(json.dumps({**made, **change}))
            for words in ("check-scenario", file.name), ("info", file.stem, "--scenario-path", "."), ("run", "q1", "--scenarios=" + file.stem, "--scenario-path", "."):
                said = self.call(*words, expect=2).stderr
                self.assertEqual(len(said.splitlines()), 1, said)
                if "," not in file.stem or words[0] != "run":
                    self.assertIn(f"{file.name}: {says}", said)


class Printed(Case):
    """What a command prints to be run next, run as it stands by a shell, in a directory with a space and a quote."""
    odd = "it's odd"

    def setUp(self):
        super().setUp()
        self.environment["PATH"] = f"{BUILD / 'bin'}:{self.environment['PATH']}"

    def shell(self, line, *more, expect=0):
        done = subprocess.run(["bash", "-c", f"{line} {shlex.join(more)}"], capture_output=True, text=True, cwd=self.dir,
                              env=self.environment, timeout=300)
        self.assertEqual(done.returncode, expect, (line, done.stderr))
        return done.stdout

    def run_all(self, said):
        """Runs each command in the text, runs and scores with few scenes. @returns the verbs."""
        few = {"run": ("--engines", "kinematic", "--limit", "2", "--episodes", "2", "--set", "*.epochs=1"),
               "check-scenario": ("--scenes", "2"), "select": ("--scenes", "2")}
        lines = re.findall(r"(lgabench (?:check-scenario|run|report|select) .*)$", said, re.M)
        for line in lines:
            verb = line.split()[1]
            out = () if "--out " in line or verb != "run" else ("--out", f"out {len(line)}")
            self.shell(line, *few.get(verb, ()), *out)
        return [line.split()[1] for line in lines]

    def test_of_new_scenario(self):
        for directory in self.odd, "-dash":
            (self.dir / directory).mkdir()
            said = self.call("new-scenario", *NAME, f"--directory={directory}").stdout
            self.assertEqual(self.run_all(said), ["check-scenario", "run"])

    def test_of_new_suite(self):
        for name, words in ("round_things", NAME[1:]), ("shipped", ("--scenarios", "heart,letter")):
            said = self.call("new-suite", name, *words, f"--directory={self.odd} {name}").stdout
            self.assertEqual(self.run_all(said), ["run", "run", "report"])
        said = self.call("new-suite", "near", *NAME[1:], "--near-miss").stdout
        arms = {arm["arm"]: arm["distractors"] for arm in json.loads((self.dir / "near/near_1.json").read_text())["tests"]}
        self.assertEqual(arms, {"test": [1, 2], "near_miss": [4, 4]})

    def test_of_commands(self):
        said = self.call("draw-commands", "--seed", "3", "--n", "8", "--out", self.odd).stdout
        self.assertEqual(self.run_all(said), ["select", "run"])
        said = self.call("draw-commands", "--seed", "3", "--persons", "2", "--out", self.odd + "/people").stdout
        self.assertEqual(self.run_all(said), ["run"])
        for words in ("--seed", "20261127", "--persons", "2"), ("--seed", "2026", "--n", "8"):
            said = self.call("draw-commands", *words, "--out", f"shipped {words[1]}").stdout
            self.assertRegex(said, r"lgabench has these scenarios already, such as \w+: another --seed draws some that can be played\n$")
            self.assertEqual(self.run_all(said), [])

    def test_of_study(self):
        said = self.call("study", "new", self.odd).stdout
        check, serve = re.findall(r"^  (lgabench study .*)$", said, re.M)
        self.shell(check, expect=2)  # blanks to fill in
        self.shell(f"timeout -s INT 5 {serve} --port 0", expect=124)  # it serves until it is stopped
        report, = re.findall(r"`(lgabench study report [^`]*)`", (self.dir / self.odd / "README.md").read_text())
        self.shell(report, expect=3)  # nobody took part

    def test_of_new_plugin(self):
        said = self.call("new-plugin", "none", "--kind", "python", "--directory", self.odd).stdout
        self.assertIn("none.py", said)
        check, = re.findall(r"^    (lgabench check-plugin .*)$", (self.dir / self.odd / "README.md").read_text(), re.M)
        if HAS_NUMPY:
            self.shell(f"cd {shlex.quote(self.odd)} && {check}", "--python", PYTHON)
        for name, kind in ("lga", "method"), ("lga", "python"), ("oracle", "method"), ("mujoco", "engine"), ("camera_turn", "perturbation"), ("read", "perceiver"):
            said = self.call("new-plugin", name, "--kind", kind, expect=2).stderr
            self.assertRegex(said, f"new-plugin: expected another id than {name}, which an? ")
        self.assertIn("which CMake has a target of", self.call("new-plugin", "test", expect=2).stderr)


class OwnSuite(Case):
    def first_look(self, said):
        """Runs the printed command for a first look. @returns success of each row in its summary."""
        words = re.findall(r"^  lgabench (run .* --preset smoke.*)$", said, re.M)
        self.call(*shlex.split(words[0]), "--out", "out")
        self.assert_matches_schemas("out")
        self.call("report", "out", "--claims")
        claims = json.loads((self.dir / "out/claims.json").read_text())
        self.assertIn("abstraction_helps", json.dumps(claims))
        return json.loads((self.dir / "out/summary.json").read_text())["rows"]

    def assert_suite(self, name):
        self.assert_as_schema("suite", json.loads((self.dir / name / f"{name}.json").read_text()))
        self.assert_as_schema("suite_claims", json.loads((self.dir / name / "claims" / f"{name}.json").read_text()))

    def test_of_its_own_scenario_runs_at_once_and_the_truth_succeeds(self):
        said = self.call("new-suite", "round_things", "--command", "Bring me something round.", "--types", "round,ring", "--hard",
                         "--title", "Round things", "--question", "Does round help?").stdout
        self.assert_suite("round_things")
        self.assert_as_schema("scenario", json.loads((self.dir / "round_things/round_things_1.json").read_text()))
        rows = self.first_look(said)
        self.assertEqual({row["arm"] for row in rows}, {"test", "hard"})
        for row in rows:
            if row["method"] in ("human", "oracle"):
                self.assertGreaterEqual(row["success"], .9, row)
        page = (self.dir / "out/report.html").read_text()
        self.assertIn("Does round help?", page)

    def test_of_scenarios_that_there_are_has_the_language_model_too(self):
        said = self.call("new-suite", "two", "--scenarios", "heart,letter").stdout
        self.assert_suite("two")
        self.assertNotIn("--answers none", said)
        rows = self.first_look(said)
        self.assertLessEqual({"lga", "human"}, {row["method"] for row in rows})
        self.assertGreaterEqual(min(row["success"] for row in rows if (row["method"], row["scenario"]) == ("human", "heart")), .9)

    def test_nothing_is_written_where_something_is_wrong(self):
        for words, says in [((), "new-suite: expected --command TEXT"), (("--scenarios", "hart"), 'no scenario "hart"'),
                            (("--scenarios", "heart,fetch_fruit"), "scenarios of one environment"),
                            (("--command", "x", "--types", "hart"), "hart")]:
            said = self.call("new-suite", "mine", *words, expect=2, stdin=subprocess.DEVNULL).stderr
            self.assertEqual(said.count("\n"), 1, said)
            self.assertIn(says, said)
        self.assertIn("which a shipped suite has", self.call("new-suite", "q1", "--scenarios", "heart", expect=2).stderr)
        self.assertEqual(list(self.dir.iterdir()), [])
        self.call("new-suite", "mine", "--scenarios", "heart")
        self.assertIn("exists already", self.call("new-suite", "mine", "--scenarios", "heart", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
