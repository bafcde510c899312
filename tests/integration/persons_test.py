"""Persons who do not say all that they want: the exact row again in Python, a method that asks, and what is refused."""
import collections
import json
import re
import shutil
import subprocess
import unittest

from case import BUILD, FULL, Case, command_line
from python_test import HAS_NUMPY, PYTHON

SHARE = BUILD / "share" / "lgabench"
RUN = ["--no-reference", "--answers", "none", "--engines", "kinematic"]

# Written from docs/protocol.md and persons.json alone: rules, priors, Bayes' rule.
BAYES = '''
import fnmatch, itertools, json, math
import numpy
from lgabench_method import Meaning, FeatureSet, Needs, Selection, Which, taken

GRAMMAR = json.loads(r"""@GRAMMAR@""")

def rules_of(types, textures):
    prior, n = GRAMMAR["prior"], len(types)
    sets = [(tuple(types), prior["types"]["all"])] + [((one,), prior["types"]["one"] / n) for one in types]
    if n > 3:
        pairs = list(itertools.combinations(types, 2))
        sets += [(pair, prior["types"]["two"] / len(pairs)) for pair in pairs]
    looks = [("any", frozenset(textures), prior["looks"]["any"])]
    for look in GRAMMAR["looks"]:
        held = frozenset(t for t in textures if any(fnmatch.fnmatchcase(t, p) for p in look["textures"]))
        looks += [("is", held, prior["looks"]["is"] / len(GRAMMAR["looks"])),
                  ("is_not", frozenset(textures) - held, prior["looks"]["is_not"] / len(GRAMMAR["looks"]))]
    rules = [(set(some), held, place, p * q * r)
             for some, p in sets for kind, held, q in looks for place, r in prior["places"].items()
             if not (len(some) == n and place == "any" and kind != "is")]
    total = sum(rule[3] for rule in rules)
    return [(some, held, place, p / total) for some, held, place, p in rules]

def objects(observation):
    found = {}
    for one in observation.instances:
        rows, columns = numpy.nonzero(observation.ids == one.id)
        if len(rows):
            found[one.id] = (one.object_type, one.texture, rows.mean(), columns.mean())
    goal = next(v for v in found.values() if v[0] == "pallet")
    return {k: v for k, v in found.items() if v[0] != "pallet"}, goal

def takes(rule, seen, goal):
    some, held, place, _ = rule
    of = {k: v for k, v in seen.items() if v[0] in some and v[1] in held}
    if place == "any" or not of:
        return set(of)
    away = lambda v: math.hypot(v[2] - goal[2], v[3] - goal[3])
    number = {"leftmost": lambda v: v[3], "rightmost": lambda v: -v[3], "nearest_to": away, "farthest_from": lambda v: -away(v)}[place]
    least = min(map(number, of.values()))
    return {k for k, v in of.items() if number(v) <= least + .5}

class Bayes:
    version = "1"
    summary = "the likeliest rule"

    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        self.space = space
        types = next(w["types"] for w in GRAMMAR["words"] if command.utterance.endswith(" " + w["a"] + "."))
        self.types = dict(getattr(self, "types", {}), **{command.utterance: types})
        return Selection(meaning=Meaning([FeatureSet(types, space.textures)]))

    def revise(self, command, selected, demonstrations, services):
        rules = rules_of(self.types[command.utterance], self.space.textures)
        weights = [rule[3] for rule in rules]
        for one in demonstrations:
            if one.instruction.utterance != command.utterance:
                continue
            seen, goal = objects(one.steps[0].observation)
            took = taken(one, services.layout)
            for i, rule in enumerate(rules):
                held = takes(rule, seen, goal)
                weights[i] *= 1 / len(held) if took in held else 0
        total = sum(weights)
        most = max(weights)
        best = [i for i, weight in enumerate(weights) if weight / total > most / total - 1e-9]
        some, held, place, _ = rules[min(best, key=lambda i: (len(rules[i][0]) * len(rules[i][1]), i))]
        which = None
        if place in ("leftmost", "rightmost"):
            which = Which(place)
        elif place != "any":
            which = Which(place, of=FeatureSet(["pallet"], self.space.textures))
        return Selection(meaning=Meaning([FeatureSet([t for t in self.space.object_types if t in some],
                                                     [t for t in self.space.textures if t in held])], which))

    def learn(self, demonstrations, services):
        return Nothing([(n["low"] + n["high"]) / 2 for n in services.layout["action"]["numbers"]])

class Nothing:
    def __init__(self, action):
        self.action = action

    def act(self, observation, instruction):
        return [1 if i in (5, 11) else value for i, value in enumerate(self.action)]
'''

# From docs/add-a-method.md alone: asks which one, and as often as it is told whether they would take the first.
ASKING = BAYES + '''
class Asking(Bayes):
    asks = "accept"
    options = {"questions": {"default": 4, "help": "to each person", "source": "a test"},
               "more": {"default": 0, "help": "beyond them", "source": "a test"},
               "wrong": {"default": "", "help": "what is asked wrongly", "source": "a test"}}

    def revise(self, command, selected, demonstrations, services):
        wrong = services.options["wrong"]
        scene = services.human.scene(command, 99 if wrong == "scene" else 0)
        things = [one["id"] for one in scene if one["object_type"] != "pallet"]
        assert len(things) == 5
        if wrong == "instance":
            services.human.takes(command, 0, 77)
        one = services.human.which(command, 0)
        assert one is None or one in things
        again = services.human.takes(command, 1, [it["id"] for it in services.human.scene(command, 1)
                                                  if it["object_type"] != "pallet"][0])
        assert again in (True, False)
        for _ in range(services.options["more"]):
            services.human.takes(command, 0, things[0])
        return selected
'''


class Persons(Case):
    def write(self):
        grammar = (SHARE / "persons" / "persons.json").read_text()
        (self.dir / "bayes.py").write_text(BAYES.replace("@GRAMMAR@", grammar))
        (self.dir / "asking.py").write_text(ASKING.replace("@GRAMMAR@", grammar))

    def selections(self, run):
        """(method, demonstrations) -> the commands of its selection.json in all scenarios."""
        found = collections.defaultdict(list)
        for key, (cell, _) in sorted(self.cells(run).items(), key=lambda one: one[1][0]["scenario"]["id"]):
            file = self.dir / run / "cells" / key / "selection.json"
            found[cell["method"]["name"], cell["demonstrations"]] += json.loads(file.read_text())["commands"]
        return found

    def test_the_shipped_persons_are_those_of_their_seeds(self):
        for seed, count, *more in ((1, 25), (20261127, 200), (20261127, 200, "--hints")):
            out = f"{seed}{''.join(more)}"
            self.call("draw-commands", "--persons", str(count), "--seed", str(seed), *more, "--out", out)
            files = list((self.dir / out).glob("persons_*_??.json"))
            self.assertEqual(len(files), count // 25)
            for file in files:
                self.assertEqual(file.read_text(), (SHARE / "scenarios" / file.name).read_text(), file.name)

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_the_exact_row_is_the_likeliest_rule(self):
        """On 25 persons, in ./test --full on fifty, computed anew from the grammar's file and from what a method sees."""
        self.write()
        scenarios = ["persons_20261127_01", "persons_20261127_02"][:2 if FULL else 1]
        self.call("run", "persons", "--scenarios", ",".join(scenarios), "--methods",
                  "bayes.py:Bayes,person_rule", "--demos", "0,3", "--episodes", "1", "--seeds", "0", *RUN, "--python", PYTHON,
                  "--out", "out")
        found = self.selections("out")
        for n in 0, 3:
            mine, theirs = found["bayes", n], found["person_rule", n]
            self.assertEqual(len(mine), 25 * len(scenarios))
            for one, other in zip(mine, theirs):
                self.assertEqual(one["selection"]["target"], other["selection"]["target"], one["utterance"])

    @unittest.skipUnless(HAS_NUMPY, f"{PYTHON} has no NumPy")
    def test_a_method_of_ones_own_asks(self):
        self.write()
        run = ["run", "persons", "--scenarios", "persons_1_01", "--demos", "1", "--episodes", "1", "--seeds", "0", *RUN, "--python",
               PYTHON, "--methods"]
        self.call(*run, "asking.py:Asking", "--out", "out")
        self.assertEqual({one["selection"]["cost"]["human_queries"] for one in self.selections("out")["asking", 1]}, {4})
        self.assert_matches_schemas("out")
        for option, said in (("more=1", "expected at most 4 questions to a person"), ("wrong=scene", "0 to 4, got 99"),
                             ("wrong=instance", "expected an object that is in it, got instance 77")):
            error = self.call(*run, f"asking.py:Asking+{option}", "--out", option, expect=3).stderr
            self.assertIn(said, error)

    def test_the_report_says_what_a_row_loses_to_exact_bayes(self):
        """And the true rule, which policy=point acts by, never fails."""
        self.call("run", "persons", "--preset", "smoke", "--methods", "person_rule+learns=words,person_rule,person_rule+choice=scene,human", *RUN,
                  "--out", "out")
        self.assert_matches_schemas("out")
        success = {}
        for key, (cell, _) in self.cells("out").items():
            episodes = [json.loads(line) for line in (self.dir / "out/cells" / key / "episodes.jsonl").read_text().splitlines()]
            persons = collections.defaultdict(list)
            for one in episodes:
                persons[one["command"]].append("failure" not in one or one["failure"] in ("", "none", None))
            self.assertEqual(len(persons), 25)
            success[cell["method"]["name"], cell["demonstrations"]] = sum(sum(of) / len(of) for of in persons.values()) / len(persons)
        said = {(one["method"], one["demonstrations"]): one for one in json.loads((self.dir / "out/summary.json").read_text())["regret"]}
        self.assertEqual(set(said), set(success))
        for (row, n), one in said.items():
            self.assertAlmostEqual(one["success"], success[row, n], msg=row)
            self.assertAlmostEqual(one["regret"], success["person_rule+choice=scene", n] - success[row, n], msg=row)
            if row == "person_rule+choice=scene":  # it does not select once
                self.assertNotIn("to_bayes", one)
                continue
            self.assertAlmostEqual(one["to_bayes"], success["person_rule", n] - success[row, n], msg=row)
            for interval, member in ((one["regret_interval"], "regret"), (one["to_bayes_interval"], "to_bayes")):
                self.assertLessEqual(interval["low"], one[member] + 1e-9)
                self.assertGreaterEqual(interval["high"], one[member] - 1e-9)
            self.assertEqual((one["persons"], one["questions"]), (25, 0))
        self.assertEqual((success["human", 0], success["human", 3]), (1, 1))
        self.assertGreater(success["person_rule", 3], success["person_rule", 0])
        page = (self.dir / "out/report.md").read_text()
        self.assertIn("What rows lose to exact Bayes", page)
        self.assertIn("to Bayes with one Selection", page)

    def test_a_hint_leaves_fewer_rules(self):
        """And a person with a rule that their hint excludes is refused."""
        self.call("run", "persons", "--preset", "hints", "--scenarios", "persons_hints_20261127_01", "--methods",
                  "person_rule,person_rule+learns=bayes_hint", "--demos", "0", "--episodes", "25", *RUN, "--out", "out")
        found = {cell["method"]["name"]: json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"]
                 for key, (cell, _) in self.cells("out").items()}
        grammar = json.loads((SHARE / "persons" / "persons.json").read_text())
        without = {}
        for one, hinted in zip(found["person_rule"], found["person_rule+learns=bayes_hint"]):
            words, hint = re.fullmatch(r"Bring person \d+ (.*?)\. (.*)", one["utterance"]).groups()
            target = json.dumps(one["selection"]["target"])
            self.assertEqual(without.setdefault(words, target), target, "a row that reads no hint")
            leaves, = [each for each in grammar["hints"] if each["says"] == hint and words in each.get("words", [words])]
            selected = hinted["selection"]["target"]
            which = (selected.get("which") or {}).get("rule")
            types = (selected.get("sets") or [selected])[0]["object_types"]
            self.assertTrue(which in leaves.get("places", [which]), (hint, selected))
            self.assertTrue(sorted(types) in map(sorted, leaves.get("types", [types])), (hint, selected))
        good = json.loads((SHARE / "scenarios" / "persons_hints_20261127_01.json").read_text())
        good["id"] = "bad"
        typed = [(one, each) for one in good["commands"] for each in grammar["hints"] if "types" in each
                 and one["utterance"].endswith(". " + each["says"])]
        command, hint = typed[0]
        truth = command["truth"]["target"]
        truth = truth.get("sets", [truth])[0]
        words, = [one for one in grammar["words"] if f" {one['a']}. " in command["utterance"]]
        truth["object_types"] = [next(one for one in words["types"] if [one] not in hint["types"])]
        (self.dir / "bad.json").write_text(json.dumps(good))
        error = self.call("check-scenario", "bad.json", expect=2).stderr
        self.assertIn("/truth: expected a rule that the command's hint allows", error)

    def test_a_row_of_the_board_meets_other_persons(self):
        """Truths of the published persons, as answers, are of no use with others, whose words are the same."""
        shutil.copytree(SHARE, self.dir / "data", ignore=shutil.ignore_patterns("encoder"))
        self.environment["LGABENCH_DATA"] = str(self.dir / "data")
        suite = json.loads((SHARE / "suites" / "persons.json").read_text())
        suite.update(id="few", scenarios=["persons_1_01"], presets={"board": {"demonstrations": [1], "episodes": 25, "scene_seed": 7}})
        (self.dir / "data/suites/few.json").write_text(json.dumps(suite))
        persons = json.loads((SHARE / "scenarios/persons_1_01.json").read_text())["commands"]
        (self.dir / "truth.json").write_text(json.dumps({"model": "a copy", "space": "household", "answers": [
            {"command": one["utterance"], "target": (one["truth"]["target"].get("sets") or [one["truth"]["target"]])[0],
             "structured": one["truth"]["target"]} for one in persons]}))
        (self.dir / "me.json").write_text(json.dumps(
            {"authors": ["A. Author"], "license": "MIT", "by": "A. Author", "source": {"file": "a.json", "sha256": "0" * 64}}))
        for method, *answers in (("lga+meaning=structured", "--answers", "truth.json"), ("person_rule+questions=1", "--answers", "none")):
            self.call("run", "few", "--preset", "board", "--methods", method, *answers, "--no-reference", "--out", method)
            self.call("leaderboard", "add", method, "--entry", "me.json", "--board", "board")
        self.assertEqual(self.call("leaderboard", "verify", "--by", "B. Reader", "--board", "board").stdout.count("agrees"), 2)
        copied, learned = (next((self.dir / "board/entries" / name).glob("*/*")) for name in ("lga", "person_rule"))
        outcomes = json.loads((copied / "cells.jsonl").read_text())["outcomes"]["test"]
        self.assertEqual(set(outcomes), {"."}, "the copy knows them all")
        (self.dir / "board/tracks.json").write_text(json.dumps({"abstraction": {"few-board": ["test"]}, "persons": ["few-board"]}))
        self.call("leaderboard", "vouch", learned.parent.name, "1", "--board", "board")
        self.call("leaderboard", "build", "--board", "board")
        self.assertIn("not yet played with other persons", (self.dir / "board/README.md").read_text())
        said = self.call("leaderboard", "verify", copied.parent.name, "--fresh", "--by", "B. Reader", "--board", "board", expect=1).stdout
        self.assertIn("DIFFERS", said)
        verify = command_line("leaderboard", "verify", learned.parent.name, "--fresh", "--by", "B. Reader", "--board", "board")
        subprocess.run(verify, capture_output=True, env=self.environment, cwd=self.dir, timeout=300)  # whether it agrees is chance
        for entry in copied, learned:
            line = json.loads((entry / "verifications.jsonl").read_text().splitlines()[-1])
            self.assertEqual((line["kind"], line["persons"]), ("fresh", 25))
            self.assert_as_schema("verifications", line)

    def test_hostile_persons_are_refused(self):
        good = json.loads((SHARE / "scenarios" / "persons_1_01.json").read_text())
        place = {"object_types": ["apple", "banana"], "textures": ["red"]}
        for change, said in (({"utterance": "Bring me a dragon."}, "/commands/0/utterance: expected words of the grammar"),
                             ({"truth": {"target": place}}, "/commands/0/truth: expected a rule of the grammar of persons"),
                             ({"truth": {"target": {"object_types": [], "textures": "ALL"}}}, "/commands/0/truth: expected"),
                             ({"utterance": "Bring person 1 a fruit. It is raining."}, "/commands/0/utterance: expected words of the grammar")):
            bad = json.loads(json.dumps(good))
            bad["id"] = "bad"
            bad["commands"][0].update(change)
            (self.dir / "bad.json").write_text(json.dumps(bad))
            error = self.call("check-scenario", "bad.json", expect=2).stderr
            self.assertIn(said, error)
            self.assertEqual(len(error.strip().splitlines()), 1, error)


if __name__ == "__main__":
    unittest.main(verbosity=2)
