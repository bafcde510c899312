"""A number that is no measurement: where nothing, or less than was said, was measured, the exit status and a line say so.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 unmeasured_test.py Unread
"""
import http.server
import json
import re
import shutil
import threading

import case

DATA = case.BUILD / "share/lgabench"
MEANT = 'Final answer:\n{"object_types": ["heart"], "textures": "ALL"}'
HYPOTHESES = 'Final answer:\n{"hypotheses": [{"text": "Any.", "meaning": {"object_types": "ALL", "textures": "ALL"}}]}'
JUNK = "It depends on the table."


def form_of(question):
    """As which question of a suite's score the words are known."""
    return "flat" if "Final answer: yes" in question else "hypotheses" if "unstated preference" in question else "structured"


class Server(http.server.ThreadingHTTPServer):
    """A chat server on loopback that can be read; junk(form, question) says where not."""
    daemon_threads = True

    def __init__(self, junk):
        super().__init__(("127.0.0.1", 0), Handler)
        self.junk, self.asked = junk, []
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        question = json.loads(self.rfile.read(int(self.headers["Content-Length"])))["messages"][1]["content"]
        form = form_of(question)
        self.server.asked.append(form)
        usual = {"flat": "Final answer: no" if "triangle" in question else "Final answer: yes", "structured": MEANT, "hypotheses": HYPOTHESES}
        text = JUNK if self.server.junk(form, question) else usual[form]
        reply = json.dumps({"choices": [{"message": {"content": text}, "finish_reason": "stop"}], "usage": {"total_tokens": 7}}).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(reply)))
        self.end_headers()
        self.wfile.write(reply)

    def log_message(self, *_):
        pass


class Unread(case.Case):
    """`select --score` of a server whose replies cannot be read, in each form."""

    RELATION = ["words_relation_heart_left_of_bowl", "words_relation_rightmost_block"]
    PREFERENCE = ["words_preference_letter_of_meg", "words_preference_plain_star"]

    def score(self, scenarios, junk=None, *more, tape="tape.jsonl", expect=0):
        suite = {**json.loads((DATA / "suites/words.json").read_text()), "id": "small", "scenarios": scenarios, "presets": {}}
        suite.pop("groups")
        (self.dir / "small.json").write_text(json.dumps(suite))
        answers = [f"cassette:{tape}"]
        if junk:
            self.server = Server(junk)
            self.addCleanup(self.server.server_close)
            self.addCleanup(self.server.shutdown)
            self.environment["OPENAI_BASE_URL"] = f"http://127.0.0.1:{self.server.server_port}/v1"
            answers = ["openai", "--model", "m", "--cassette", tape]
        return self.call("select", "--suite", "small.json", "--score", "--scenes", "2", "--answers", *answers, *more, expect=expect)

    def rows(self, done):
        return {row["asked"]: row for row in map(json.loads, done.stdout.splitlines()) if row["group"] == "all"}

    def test_a_server_of_junk_alone_is_asked_no_further(self):
        done = self.score(self.RELATION, lambda form, question: True, expect=3)
        self.assertIn("none of its first 20 replies has an answer, lgabench stopped asking", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertLess(len(self.server.asked), 60)

    def test_a_form_of_junk_is_asked_no_further_and_in_no_row(self):
        eight = [*self.RELATION, *self.PREFERENCE, *(f"words_relation_{name}" for name in (
            "fruit_right_of_plate", "cutlery_nearest_to_plate", "letter_farthest_from_pan", "leftmost_drink"))]
        done = self.score(eight, lambda form, question: form == "structured", expect=3)
        self.assertEqual(self.server.asked.count("structured"), 20)
        self.assertRegex(done.stdout, r"\nall +flat +8 ")
        self.assertNotRegex(done.stdout, r"\nall +structured ")
        self.assertIn("structured: m, asked about what it means: none of its first 20 replies has an answer", done.stdout)
        rows = self.score(eight, lambda form, question: form == "structured", "--json", expect=3)
        self.assertEqual(sorted(self.rows(rows)), ["flat", "hypotheses", "named"])
        self.assertIn("structured: m, asked about what it means", rows.stderr, "where JSON has no place for it")

    def test_a_meaning_that_cannot_be_read_is_in_no_mean(self):
        alone = self.rows(self.score(self.RELATION[:1], lambda form, question: False, "--json"))
        done = self.score(self.RELATION, lambda form, question: form == "structured" and "block" in question.split("Which objects")[0],
                          tape="two.jsonl", expect=3)
        self.assertEqual(self.server.asked.count("structured"), 1 + 3)
        self.assertRegex(done.stdout, r"\nall +structured +1 .* 1 of 2 commands have no answer\n")
        self.assertNotIn("structured, words_relation_rightmost_block: ", done.stdout)
        self.assertRegex(done.stderr, r'no answer: "[^"]*block[^"]*", asked about what it means: expected a JSON object .* \(asked 3 times\)\n')
        again = self.score(self.RELATION, None, "--json", tape="two.jsonl", expect=3)
        of_two = self.rows(again)
        self.assertEqual((of_two["structured"].pop("unanswered"), alone["structured"].pop("unanswered")), (1, 0))
        self.assertEqual(of_two["structured"], alone["structured"])
        self.assertEqual((of_two["flat"]["commands"], of_two["flat"]["unanswered"]), (2, 0))

    def test_a_feature_without_an_answer_takes_no_other_command_along(self):
        done = self.score(self.RELATION, lambda form, question: form == "flat" and "leftmost" not in question and '"heart"?' in question
                          and "block" in question, expect=3)
        self.assertRegex(done.stdout, r"\nall +flat +1 .* 1 of 2 commands have no answer\n")
        self.assertRegex(done.stdout, r"\nall +structured +2 ")
        self.assertRegex(done.stderr, 'no answer: "[^"]*block[^"]*", asked about "heart": .*expected a last line')
        self.assertIn("1 questions have no answer; their commands are in no mean", done.stderr)

    def test_hypotheses_that_cannot_be_read_are_counted(self):
        junk = lambda form, question: form == "hypotheses" and "star" in question.split("unstated")[0]
        done = self.score(self.PREFERENCE, junk, expect=3)
        self.assertRegex(done.stdout, r"hold the truth for \d of 1 commands.*; 1 more have no answer\n")
        self.assertRegex(done.stderr, r'no answer: "[^"]*star[^"]*", asked about what it leaves unsaid: ')
        row = self.rows(self.score(self.PREFERENCE, junk, "--json", expect=3))["hypotheses"]
        self.assertEqual((row["commands"], row["unanswered"]), (1, 1))

    def test_a_cassette_that_answers_nothing_is_no_score(self):
        self.score(self.RELATION[:1], lambda form, question: False)
        done = self.score(self.RELATION[1:], None, expect=2)
        self.assertIn("no answer was scored: flat: tape.jsonl: expected replies of m", done.stderr)


class Unplayed(case.BesideOneRun):
    """What reads a run says which of its cells it lacks, and that nothing is left where that is all of them."""
    run_of_class = ("run", "q1", "--scenarios", "heart,rotate_block", "--methods", "human+policy=centroid,gcbc_seg+policy=heat_map",
                    "--demos", "2", "--seeds", "0", "--episodes", "2", "--set", "*.epochs=2", "--no-reference", "--layout", "cells")

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def cell_folders(self, run="run"):
        return sorted((self.dir / run / "cells").iterdir())

    def damage(self, folder):
        (folder / "timing.json").write_text("{}")

    def crash(self, folder):
        """As the harness leaves a cell whose worker crashed."""
        status = json.loads((folder / "status.json").read_text())
        failed = {"state": "failed", "fault": "plugin", "reason": "it crashed", "log_tail": []}
        (folder / "status.json").write_text(json.dumps({**{k: status[k] for k in status if k in ("build",)}, **failed}))

    def test_rescore_names_what_it_could_not_judge(self):
        whole = self.call("rescore", "run").stdout
        self.damage(self.cell_folders()[0])
        done = self.call("rescore", "run", expect=3)
        self.assertNotEqual(done.stdout, whole)
        said = self.call("report", "run", expect=2).stderr
        why, = re.findall("^left out: .*timing.json.*$", said, re.M)
        self.assertIn(why, done.stderr.splitlines(), "in report's words")
        for folder in self.cell_folders()[1:]:
            self.damage(folder)
        done = self.call("rescore", "run", expect=3)
        self.assertEqual(len(re.findall("^left out: ", done.stderr, re.M)), 4)
        self.assertEqual(done.stdout.splitlines()[-1].split()[0], "row", "no number below the heads")

    def test_rescore_of_a_part_says_so(self):
        shutil.rmtree(self.cell_folders()[0])
        self.assertIn("1 cells have not been played", self.call("rescore", "run", expect=3).stderr)

    def test_a_report_without_a_number_is_no_success(self):
        for folder in self.cell_folders():
            self.crash(folder)
        for words in ((), ("--claims",), ("--format", "json")):
            self.assertIn("run: all its 4 cells failed: nothing was measured", self.call("report", "run", *words, expect=3).stderr)
        self.copy_first("whole")
        self.call("report", "whole", "run", expect=3)

    def test_compare_says_what_it_leaves_out(self):
        self.copy_first("b")
        self.assertEqual(self.call("compare", "run", "b").stderr, "")
        for run in "run", "b":
            self.crash(self.cell_folders(run)[0])
            shutil.rmtree(self.cell_folders(run)[1])
        said = self.call("compare", "run", "b").stderr
        for run in "run", "b":
            self.assertIn(f"{run}: of 4 cells 1 failed and 1 have not been played: only the others are compared", said)
        for folder in self.cell_folders("run"):
            self.crash(folder)
        self.assertIn("no cell finished in both", self.call("compare", "run", "b", expect=2).stderr)
        said = self.call("compare", "run", "--difference", "human,gcbc_seg", expect=3)
        self.assertIn("not tested", said.stdout)
        self.assertIn("run: all its 3 cells failed: nothing was measured", said.stderr)

    def test_a_difference_to_a_row_without_a_policy_is_none(self):
        for folder in self.cell_folders():
            if json.loads((folder / "cell.json").read_text())["method"]["id"] == "human":
                self.crash(folder)
        said = self.call("compare", "run", "--difference", "human,gcbc_seg", expect=3)
        self.assertIn("run: nothing was compared, the reason stands above", said.stderr)


class Empty(case.Case):
    """A Selection that keeps no object, a board without an entry."""

    def test_select_and_run_say_so(self):
        (self.dir / "mine.json").write_text(json.dumps({"model": "me", "space": "tabletop", "answers": [
            {"command": "Bring me the heart.", "target": {"object_types": ["heart"], "textures": []}},
            {"command": "Bring me the red heart.", "target": {"object_types": ["heart"], "textures": ["red"]}}]}))
        for json_too in ((), ("--json",)):
            said = self.call("select", "heart", "--answers", "mine.json", *json_too).stderr
            self.assertEqual(said, 'heart: "Bring me the heart." keeps no object: the target has no texture\n')
        self.assertEqual(self.call("select", "red_heart", "--answers", "mine.json").stderr, "")
        done = self.call("run", "q1", "--scenarios", "heart,red_heart", "--methods", "lga+policy=centroid", "--demos", "2", "--seeds", "0",
                         "--episodes", "2", "--no-reference", "--layout", "cells", "--answers", "mine.json", "--out", "run")
        self.assertIn("LGA keeps no object in heart: the target has no texture.\n", done.stdout)
        self.assertIn("LGA keeps no object in heart: the target has no texture.", (self.dir / "run/report.md").read_text())
        self.assertNotIn("keeps no object in red_heart", done.stdout)

    def test_no_entry_is_no_verification(self):
        (self.dir / "board/entries").mkdir(parents=True)
        said = self.call("leaderboard", "verify", "--board", "board", "--by", "me", expect=2).stderr
        self.assertIn("board: no entry that is not withdrawn: nothing was verified", said)


if __name__ == "__main__":
    case.unittest.main()
