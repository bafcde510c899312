"""A row of answers alone, from a file that somebody wrote to a board's pages: shown, marked, and without a rank.

By hand: python3 board_answers_test.py AnswersAlone
"""
import hashlib
import json
import re
import shlex
import subprocess
import unittest

from answers_test import SECRET, Server
from case import BUILD, command_line, read_entry
from leaderboard_test import META, SUITE, Board
from python_test import PYTHON, has

PRESET = {"scene_seed": 77, "test_scenes": "per_seed"}
SMALL = {**SUITE, "methods": ["lga"], "demonstrations": [2], "seeds": [0], "presets": {"abstraction": PRESET}}
TRACKS = {"abstraction": {"tiny-abstraction": ["test"]}}


def command_of(scenario):
    file = BUILD / "share/lgabench/scenarios" / (scenario + ".json")
    command, = json.loads(file.read_text())["commands"]
    return command


def answers_of(model, targets):
    """A file of answers: the scenario's target set by its name."""
    return {"model": model, "space": "tabletop",
            "answers": [{"scenario": name, "command": command_of(name)["utterance"], "target": target}
                        for name, target in targets.items()]}


class AnswersAlone(Board):
    """Two files of answers, of a model that does not exist, and copied from the truth; a run with each."""
    MADE_UP = answers_of("made-up-1", {"heart": {"object_types": ["heart"], "textures": ["red", "blue"]},
                                       "letter": {"object_types": ["letter A", "letter E", "star"], "textures": "ALL"}})
    TRUTH = answers_of("made-up-2", {name: command_of(name)["truth"]["target"] for name in SMALL["scenarios"]})

    def prepare(self):
        super().prepare()
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(SMALL))
        for name, answers in (("made_up", self.MADE_UP), ("truth", self.TRUTH)):
            (self.dir / f"{name}.json").write_text(json.dumps(answers))
            source = {"file": f"{name}.json", "sha256": self.digest(name)}
            about = {**META, "source": source, "label": answers["model"], "answers": "written by hand"}
            (self.dir / f"{name}_entry.json").write_text(json.dumps(about))
        self.track(TRACKS)

    def play(self, out):
        for name in "made_up", "truth":
            self.call("run", "tiny", "--preset", "abstraction", "--methods", "selected_by:lga", "--answers", f"{name}.json",
                      "--no-reference", "--out", f"{out}/{name}")

    def digest(self, name):
        return hashlib.sha256((self.dir / f"{name}.json").read_bytes()).hexdigest()

    def track(self, tracks):
        (self.dir / "board").mkdir(exist_ok=True)
        (self.dir / "board/tracks.json").write_text(tracks if isinstance(tracks, str) else json.dumps(tracks))

    def enter(self, name):
        """Adds the run's one row; its place on the board."""
        said = self.leaderboard("add", f"run/{name}", "--entry", f"{name}_entry.json").stdout
        self.assertRegex(said, r"^added entries/lga/[0-9a-f]{16}/tiny-abstraction\n$")
        return self.dir / "board" / said.split()[1]

    def row(self, label, file="README.md"):
        line, = [line for line in (self.dir / "board" / file).read_text().splitlines() if f"| {label} |" in line]
        return [cell.strip() for cell in line.strip("|").split("|")]

    def test_a_made_up_models_answers_are_entered_verified_and_marked(self):
        self.take_run()
        place, digest = self.enter("made_up"), self.digest("made_up")
        kept = self.dir / "board/answers" / (digest + ".json")
        self.assertEqual(kept.read_bytes(), (self.dir / "made_up.json").read_bytes())
        entry = read_entry(place / "entry.json")
        self.assertEqual(entry["identity"]["answers"], {"source": "file:" + digest, "sha256": digest})
        self.assertEqual((entry["identity"]["acts"]["id"], entry["identity"]["acts"]["options"]["policy"]), ("lga", "heat_map"))
        selected, = entry["phi"]["letter"][0]
        self.assertEqual((selected["selection"]["source"], selected["selection"]["target"]["object_types"]),
                         ("made-up-1", ["letter A", "letter E", "star"]))

        self.leaderboard("build")
        self.assertEqual(self.row("made-up-1")[3], "recomputed; not yet replayed; answers as submitted")
        (self.dir / "made_up.json").unlink()  # the board has what its entry stands on
        said = self.leaderboard("verify", "--by", "B. Reader").stdout
        self.assertRegex(said, r"^agrees  entries/lga/\S+: 2 of 2 cells bit-identical, 0 of 8 episodes ended differently")
        self.leaderboard("vouch", entry["id"], "1")
        self.leaderboard("build")
        self.assertIn("1 entry, 0 problems", self.leaderboard("check").stdout)
        self.assertEqual([self.row("made-up-1")[i] for i in (0, 4)], ["–", "replayed; answers as submitted"])
        for file in "README.md", "index.html", "tiny.html":
            page = (self.dir / "board" / file).read_text()
            self.assertIn("answers as submitted", page.split("What the words mean")[0], file)
            self.assertIn("may be a copy of it", page.split("What the words mean")[-1], file)
        page = (self.dir / "board/tiny.html").read_text()
        shown, = json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])["entries"]
        self.assertEqual(shown["kept_answers"], f"answers/{digest}.json")
        words = shlex.split(shown["command"])[1:]
        self.assertEqual(words[-2:], ["--answers", shown["kept_answers"]])
        self.call(*words[:-1], "board/" + words[-1], "--scenarios", "letter", "--out", "again")
        keys = [json.loads(line)["key"] for line in (place / "cells.jsonl").read_text().splitlines()]
        self.assertEqual(list(self.cells("again")), keys[1:], "the page's command plays the entry's cell")
        self.assertIn(",answers as submitted,", (self.dir / "board/leaderboard.csv").read_text())

        # What the answers keep without a policy, beside what the policy makes of it.
        score = entry["score"]
        self.assertEqual((score["models"], score["asked"], score["questions"]), (["made-up-1"], "flat", 2 * 112))
        alone = {row["group"]: row for row in map(json.loads, self.call(
            "select", "--suite", "tiny", "--score", "--json", "--answers", str(kept)).stdout.splitlines()) if row["asked"] == "flat"}
        self.assertEqual(score["groups"]["all"]["exact_sets"], alone["all"]["exact_sets"])
        self.assertIn("letter T", score["wrong"]["letter"]["missed"])
        self.assertIn("What the answers keep, without a policy", page)
        self.assertRegex(page, r"missed: [^<]*letter T")
        text = (place / "entry.json").read_text()
        now = score["groups"]["all"]["exact_scenes"]
        better = read_entry(place / "entry.json")
        better["score"]["groups"]["all"]["exact_scenes"] = now + 1
        (place / "entry.json").write_text(json.dumps(better, indent=1, ensure_ascii=False) + "\n")
        refused = self.leaderboard("verify", "--by", "B. Reader", expect=2).stderr
        self.assertRegex(refused, r"^not verified: \S+: score of the answers, scenes exact: 0\.\d+ here, 0\.\d+ in the entry\n")
        better["score"]["groups"]["all"]["exact_scenes"] = better["score"]["groups"]["all"]["scenes"] + 1
        (place / "entry.json").write_text(json.dumps(better, indent=1, ensure_ascii=False) + "\n")
        self.assertIn("/score/groups/all/exact_scenes: expected", self.leaderboard("check", expect=1).stderr)
        (place / "entry.json").write_text(text)
        older = read_entry(place / "entry.json")  # of before the list
        last = older["score"].pop("models")[-1]
        older["score"] = dict(sorted({**older["score"], "model": last}.items()))
        (place / "entry.json").write_text(json.dumps(older, indent=1, ensure_ascii=False) + "\n")
        self.assertIn("agrees", self.leaderboard("verify", "--by", "B. Reader").stdout)
        older["score"]["model"] = "made-up-2"
        (place / "entry.json").write_text(json.dumps(older, indent=1, ensure_ascii=False) + "\n")
        self.assertIn("score of the answers: other groups", self.leaderboard("verify", "--by", "B. Reader", expect=2).stderr)
        (place / "entry.json").write_text(text)

        # The cells follow from these bytes.
        kept.write_text(kept.read_text().replace('"star"', '"moon"'))
        self.assertIn(f"{kept.name} is not there, or not what its name says", self.leaderboard("check", expect=1).stderr)
        self.assertIn("its SHA-256 is not the one in its name",
                      self.leaderboard("verify", "--by", "B. Reader", expect=2).stderr)

    def test_a_servers_replies_are_scored_with_their_price(self):
        self.take_run()
        server = Server({"heart", "red", "letter A"})
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.environment.update(OPENAI_BASE_URL=f"http://127.0.0.1:{server.server_port}/v1", OPENAI_API_KEY=SECRET)
        server.served = ["made-up-3-of-may"]
        self.call("select", "--suite", "tiny", "--answers", "openai", "--model", "made-up-3", "--cassette", "tape.jsonl")
        asked = len(server.asked)
        self.call("run", "tiny", "--preset", "abstraction", "--methods", "selected_by:lga", "--answers", "cassette:tape.jsonl",
                  "--no-reference", "--out", "run/tape")
        place = self.dir / "board" / self.leaderboard("add", "run/tape", "--entry", "made_up_entry.json").stdout.split()[1]
        score = json.loads((place / "entry.json").read_text())["score"]
        self.assertEqual((score["asked"], score["questions"], score["tokens"]), ("flat", 224, 9 * 224))
        self.assertEqual(score["models"], ["made-up-3 (served: made-up-3-of-may)"])
        self.assertIn("letter T", score["wrong"]["letter"]["missed"])
        self.assertIn("agrees", self.leaderboard("verify", "--by", "B. Reader").stdout)
        fresh = subprocess.run(command_line("leaderboard", "verify", "--fresh", "--by", "B. Reader", "--board", "board"),
                               capture_output=True, text=True, env=self.environment, cwd=self.dir, timeout=300)
        self.assertIn("nobody is asked about other commands (docs/language-models.md)", fresh.stderr)  # whether it agrees is chance
        self.assertEqual(len(server.asked), asked)

    def test_all_whose_answers_a_row_has_are_named(self):
        self.take_run()
        self.call("run", "tiny", "--preset", "abstraction", "--methods", "selected_by:lga", "--no-reference", "--out", "run/both")
        place = self.dir / "board" / self.leaderboard("add", "run/both", "--entry", "me.json").stdout.split()[1]
        models = json.loads((place / "entry.json").read_text())["score"]["models"]
        self.assertEqual(models, ["GPT-4 (released with the code, 2023-07)", "GPT-4, version not stated there"])
        self.leaderboard("build")
        self.assertIn(" and ".join(models), (self.dir / "board/tiny.html").read_text())

    def test_a_copy_of_the_truth_is_taken_and_ranked_in_no_track(self):
        self.take_run()
        for name in "made_up", "truth":
            self.enter(name)
        self.replay()
        entries = {entry["about"]["label"]: entry
                   for entry in map(read_entry, (self.dir / "board").glob("entries/lga/*/*/entry.json"))}
        for scenario in SMALL["scenarios"]:
            command, = entries["made-up-2"]["phi"][scenario][0]
            for part in command["quality"]["target"].values():
                self.assertEqual((part["precision"], part["recall"]), (1, 1))
        for tracks in TRACKS, {"open": ["tiny-abstraction"]}, {}:
            self.track(tracks)
            self.leaderboard("build")
            self.assertIn("2 entries, 0 problems", self.leaderboard("check").stdout)
            for label in entries:
                self.assertEqual([self.row(label)[i] for i in (0, 4)], ["–", "replayed; answers as submitted"], (label, tracks))
        # Each file competes for itself: neither is hidden as another row of one method.
        self.assertNotIn("<tr class=more>", (self.dir / "board/tiny.html").read_text())

    def test_other_bytes_than_the_run_was_played_on_are_not_taken(self):
        self.take_run()
        kept = self.dir / "run/made_up/answers" / (self.digest("made_up") + ".json")
        kept.write_text(kept.read_text().replace('"star"', '"moon"'))
        refused = self.leaderboard("add", "run/made_up", "--entry", "made_up_entry.json", expect=2)
        self.assertIn("its SHA-256 is not the one in its name", refused.stderr)
        kept.unlink()
        refused = self.leaderboard("add", "run/made_up", "--entry", "made_up_entry.json", expect=1)
        self.assertIn(f"refused: file:{kept.stem}: the file is not in answers/ of the run", refused.stderr)
        self.assertFalse((self.dir / "board/entries").exists())

    def test_tracks_that_are_malformed_are_one_line_with_its_place(self):
        self.take_run()
        self.enter("made_up")
        for wrong, place in (("{", ""), ("[]", "/: expected an object"), ({"opne": []}, '/: unknown member "opne" (did you mean "open"?)'),
                             ({"open": "tiny-abstraction"}, "/open: expected an array"), ({"open": [1]}, "/open/0: expected a string"),
                             ({"abstraction": ["tiny-abstraction"]}, "/abstraction: expected an object: arms by preset"),
                             ({"abstraction": {"tiny-abstraction": "test"}}, "/abstraction/tiny-abstraction: expected an array"),
                             ({**TRACKS, "open": ["tiny-abstraction"]}, "/open/0: expected each preset in one track"),
                             ({"abstraction": {"tiny-abstraction": ["test", "hard"]}},
                              '/abstraction/tiny-abstraction/1: expected an arm that the preset has, got "hard"')):
            with self.subTest(wrong):
                self.track(wrong)
                for action, status in (("build", 2), ("check", 1)):
                    lines = self.leaderboard(action, expect=status).stderr.splitlines()
                    self.assertEqual(len(lines), 1, lines)
                    self.assertIn(f"board/tracks.json: {place}", lines[0])
        self.assertFalse((self.dir / "board/README.md").exists())


TABLE = '''
from lgabench_method import FeatureSet, Selection, select_features

TRUTH = {}

class Table:
    """Knows the published commands' truths, and asks for the form alone."""
    version, summary = "1", "a table of truths"

    def select(self, command, space, services):
        asked = select_features(command, space, services.lm)
        truth = TRUTH.get(command.utterance)
        return Selection(FeatureSet(*truth) if truth else FeatureSet(list(space.object_types), list(space.textures)),
                         None, asked.provenance, asked.source)
'''


class FreshCommands(Board):
    """A method that maps the published commands to their truths, beside LGA on the same answers."""
    NONCE = "5eed" * 8

    def prepare(self):
        super().prepare()
        (self.dir / "data/suites/tiny.json").write_text(json.dumps(SMALL))
        (self.dir / "board").mkdir()
        (self.dir / "board/tracks.json").write_text(json.dumps({**TRACKS, "frozen": {"tiny-abstraction": "recorded"}}))
        truths = {}
        for scenario in SMALL["scenarios"]:
            space = json.loads((BUILD / "share/lgabench/spaces/tabletop.json").read_text())
            command = command_of(scenario)
            truths[command["utterance"]] = [space[part] if names == "ALL" else names for part, names in
                                            ((part, command["truth"]["target"][part]) for part in ("object_types", "textures"))]
        (self.dir / "table.py").write_text(TABLE.replace("TRUTH = {}", f"TRUTH = {truths!r}"))

    def play(self, out):
        self.call("run", "tiny", "--preset", "abstraction", "--methods", "selected_by:lga,selected_by:table.py:Table",
                  "--no-reference", "--python", PYTHON, "--out", out)

    def verify(self, *words, expect=0):
        return self.leaderboard("verify", "--by", "B. Maintainer", "--methods", "table.py:Table", "--python", PYTHON, *words, expect=expect)

    def standings(self):
        self.leaderboard("build")
        rows = [line.split("|") for line in (self.dir / "board/README.md").read_text().splitlines() if "entries/" in line]
        return {re.search(r"entries/(\w+)/", "|".join(row))[1]: (row[1].strip(), row[5].strip()) for row in rows}

    @unittest.skipUnless(has(PYTHON, "numpy"), "no NumPy")
    def test_a_table_of_published_truths_loses_its_rank(self):
        self.take_run()
        self.leaderboard("add", "run", "--entry", "me.json")
        self.verify()
        for file in (self.dir / "board").glob("entries/*/*/*/verifications.jsonl"):
            self.leaderboard("vouch", file.parent.parent.name, "1")
        before = self.standings()
        self.assertEqual(before["table"][0], "1")
        self.assertNotEqual(before["lga"][0], "–")
        for row in "table", "lga":
            self.assertIn("never on fresh scenes; never on fresh commands", before[row][1])
        said = self.verify("--fresh-commands", self.NONCE, expect=1).stdout
        self.assertRegex(said, r"(?m)^DIFFERS entries/table/\S+: 0 of 40 drawn commands exact \(lga: 40\), 2 of 2 published \(nonce 5eed")
        self.assertRegex(said, r"(?m)^agrees  entries/lga/\S+: 40 of 40 drawn commands exact \(lga: 40\), \d of 2 published")
        for file in (self.dir / "board").glob("entries/*/*/*/verifications.jsonl"):
            line = json.loads(file.read_text().splitlines()[-1])
            self.assertEqual((line["kind"], line["commands"], line["nonce"]), ("commands", 40, self.NONCE))
            self.assert_as_schema("verifications", line)
        self.assertIn("claimed by B. Maintainer: differs on fresh commands", self.standings()["table"][1])
        for file in (self.dir / "board").glob("entries/*/*/*/verifications.jsonl"):
            self.leaderboard("vouch", file.parent.parent.name, "2")
        after = self.standings()
        self.assertEqual(after["lga"][0], "1")
        self.assertEqual(after["table"][0], "–")
        self.assertIn("differs on fresh commands", after["table"][1])
        self.assertIn("; fresh commands; never on fresh scenes", after["lga"][1])
        self.leaderboard("check")

        # A nonce that anybody may know; what is none; too few; lines whose counts say otherwise.
        used = self.verify("--fresh-commands", self.NONCE, expect=2).stderr
        self.assertRegex(used, rf"^lgabench: --fresh-commands: {self.NONCE} was used, in \S+/verifications.jsonl; expected a new one\n$")
        self.assertIn("expected 32 hexadecimal digits", self.verify("--fresh-commands", "5eed", expect=2).stderr)
        self.assertIn("--commands", self.verify("--fresh-commands", "a" * 32, "--commands", "19", expect=2).stderr)
        forged = next((self.dir / "board").glob("entries/table/*/*/verifications.jsonl"))
        lines = forged.read_text().splitlines()
        forged.write_text("\n".join([*lines, json.dumps({**json.loads(lines[-1]), "nonce": "b" * 32, "passed": True})]) + "\n")
        self.assertIn("/passed: expected false, by its counts", self.leaderboard("check", expect=1).stderr)

    def test_a_row_that_selects_nothing_has_no_commands_to_draw(self):
        self.prepare()
        self.call("run", "tiny", "--preset", "abstraction", "--methods", "gcbc_seg", "--set", "*.epochs=2", "--no-reference", "--out", "none")
        self.leaderboard("add", "none", "--entry", "me.json")
        refused = self.leaderboard("verify", "--by", "B. Maintainer", "--fresh-commands", self.NONCE, expect=2).stderr
        self.assertRegex(refused, r"^not verified: entries/gcbc_seg/\S+: no command to draw: the row selects nothing\n")


if __name__ == "__main__":
    unittest.main(verbosity=2)
