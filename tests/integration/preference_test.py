"""What a person leaves unsaid: plga and plga_active, and methods in Python that ask likewise."""
import json
import unittest

from case import Case
from python_test import HAS_NUMPY, PYTHON

DRINK = "words_preference_drink_without_sugar"
RUN = ["--seeds", "0", "--episodes", "2", "--no-reference"]
ASKING = '''
from lgabench_method import Selection, select_features, taken

class Asking:
    version = "1"
    summary = "what a person says of the first object that was taken"
    asks = "accept"

    def select(self, command, space, services):
        self.space = space
        return select_features(command, space, services.lm)

    def revise(self, command, selected, demonstrations, services):
        assert services.shows_truth
        first = demonstrations[0]
        one, = [it for it in first.steps[0].observation.instances if it.id == taken(first, services.layout)]
        assert services.human.accepts(command, one.object_type, one.texture)
        assert not services.human.accepts(command, "hammer", one.texture)
        chosen = next(it for it in services.lm.hypotheses(command, self.space) if it.text.endswith("takes only water."))
        assert chosen.meaning.belongs(one.object_type, one.texture)
        return Selection(meaning=chosen.meaning)

    def learn(self, demonstrations, services):
        return Policy(demonstrations[0].steps[0].label)

class Policy:
    def __init__(self, label):
        self.label = label

    def act(self, observation, instruction):
        return self.label
'''


class Preferences(Case):
    def selections(self, run):
        """(method, demonstrations) -> the one command of its selection.json, the cell's directory."""
        found = {}
        for key, (cell, _) in self.cells(run).items():
            directory = self.dir / run / "cells" / key
            command, = json.loads((directory / "selection.json").read_text())["commands"]
            found[cell["method"]["name"], cell["demonstrations"]] = command, directory
        return found

    def test_five_demonstrations_tell_what_one_does_not(self):
        self.call("run", "words", "--preset", "preference", "--scenarios", DRINK, "--demos", "1,5", *RUN, "--out", "out")
        self.assert_matches_schemas("out")
        found = self.selections("out")
        truth, words = found["human", 5][0]["selection"]["target"], found["lga", 5][0]["selection"]["target"]
        self.assertEqual(truth["object_types"], ["water bottle"])
        narrower = found["plga", 1][0]["selection"]["target"]
        self.assertLess(set(narrower["object_types"]), set(words["object_types"]), "of what explains one demonstration alike, the narrower")
        learned = found["plga", 5][0]
        self.assertEqual(learned["selection"]["target"], truth)
        self.assertEqual(learned["before_revision"]["target"], words)
        self.assertEqual((learned["selection"]["provenance"], learned["selection"]["source"]),
                         ("recorded", 'Claude (Anthropic, 2026), supposing "The person avoids sugar and takes only water."'))
        self.assertEqual(learned["selection"]["cost"]["lm_queries"], found["lga", 5][0]["selection"]["cost"]["lm_queries"] + 1)
        self.assertNotIn("human_queries", learned["selection"]["cost"])
        self.assertEqual(learned["quality"]["target"]["object_types"]["precision"], 1)
        asked = found["plga_active", 1][0]["selection"]
        self.assertEqual((asked["target"], asked["provenance"], asked["cost"]["human_queries"]), (truth, "simulated_edit", 1))
        for (method, _), (_, directory) in found.items():
            said = (directory / "log.txt").read_text()
            self.assertEqual("avoids sugar" in said, method.startswith("plga"), said)
            self.assertNotIn("no sugar in them", said, "what the person says of it is told to no method")
        self.assertIn("simulated edit", (self.dir / "out/report.html").read_text())

    def test_where_nothing_tells_more_it_is_lga(self):
        """Targets of q1 follow what was selected; of the other commands of words no hypotheses are recorded."""
        for suite, scenario in (("q1", "heart"), ("words", "words_lookup_rainbow_cross")):
            with self.subTest(suite):
                self.call("run", suite, "--scenarios", scenario, "--methods", "lga,plga,plga_active", "--demos", "5",
                          "--set", "*.policy=heat_map", *RUN, "--out", suite)
                found = self.selections(suite)
                for name in ("episodes.jsonl", "selection.json"):
                    for method in "plga", "plga_active":
                        self.assertEqual((found[method, 5][1] / name).read_bytes(), (found["lga", 5][1] / name).read_bytes())
                said = (found["plga", 5][1] / "log.txt").read_text()
                self.assertEqual("no hypotheses are known; the Selection stays as the words say" in said, suite == "words", said)
        self.call("run", "words", "--scenarios", DRINK, "--methods", "plga+meaning=named", "--answers", "none", "--demos", "5",
                  *RUN, "--out", "nobody")
        (command, directory), = self.selections("nobody").values()
        self.assertEqual(command["selection"]["provenance"], "rule")
        self.assertIn("no hypotheses are known", (directory / "log.txt").read_text())

    def test_hypotheses_are_read_strictly(self):
        answer = {"command": "Bring me something to drink.", "target": {"object_types": ["mug"], "textures": "ALL"}}
        for hypotheses, said in (([], "/answers/0/hypotheses: expected 1 to 50 hypotheses"),
                                 ([{"text": "Mugs."}], '/answers/0/hypotheses/0: expected a member "meaning"'),
                                 ([{"text": "a\nb", "meaning": answer["target"]}], "/answers/0/hypotheses/0/text: expected words, in a line"),
                                 ([{"text": "x", "meaning": {"object_types": ["mugg"], "textures": "ALL"}}],
                                  "/answers/0/hypotheses/0/meaning/object_types/0")):
            (self.dir / "mine.json").write_text(json.dumps(
                {"model": "me", "space": "household", "answers": [{**answer, "hypotheses": hypotheses}]}))
            error = self.call("select", DRINK, "--answers", "mine.json", expect=2).stderr
            self.assertIn(said, error)
            self.assertIn("mine.json", error)

    def test_the_score_tells_how_often_hypotheses_hold_the_truth(self):
        score = ("select", "--suite", "words", "--score", "--scenes", "10")
        rows = [json.loads(line) for line in self.call(*score, "--json").stdout.splitlines()]
        self.assertEqual([row for row in rows if row["asked"] == "hypotheses"],
                         [{"group": group, "asked": "hypotheses", "commands": 6, "covered": 4, "unanswered": 0} for group in ("preference", "all")])
        said = self.call(*score).stdout
        self.assertIn("hold the truth for 4 of 6 commands, not for words_preference_letter_of_meg, words_preference_plate", said)

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_method_in_python_asks_likewise(self):
        (self.dir / "asking.py").write_text(ASKING)
        run = ["run", "words", "--scenarios", DRINK, "--demos", "2", *RUN, "--python", PYTHON]
        self.call(*run, "--methods", "asking.py:Asking", "--out", "out")
        (command, _), = self.selections("out").values()
        self.assertEqual(command["selection"]["target"]["object_types"], ["water bottle"])
        self.assertEqual(command["selection"]["provenance"], "simulated_edit")
        self.assertEqual(command["selection"]["cost"]["human_queries"], 2)
        self.assert_matches_schemas("out")
        (self.dir / "undeclared.py").write_text(ASKING.replace('    asks = "accept"\n', ""))
        done = self.call(*run, "--methods", "undeclared.py:Asking", "--out", "refused", expect=3)
        self.assertIn('services.human.accepts(): expected a method declared as LGABENCH_METHOD_ASKING("accept", ...)', done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
