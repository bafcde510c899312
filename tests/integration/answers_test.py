"""Answers that people bring along: a cassette of a language model, files of participants.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 answers_test.py Cassettes
"""
import contextlib
import datetime
import hashlib
import http.server
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import textwrap
import threading
import time
import unittest

from case import BUILD, Case, FIXTURES, command_line, with_options
from python_test import PYTHON, has

DATA = BUILD / "share/lgabench"
SECRET = "sk-secret-1234567890"
RUN = ["--methods", "lga", "--demos", "10", "--seeds", "0", "--episodes", "2", "--set", "lga.epochs=2"]


class Server(http.server.ThreadingHTTPServer):
    """A chat server on loopback that says yes to the candidates `yes`, to everything else no."""
    daemon_threads = True

    def __init__(self, yes):
        super().__init__(("127.0.0.1", 0), Handler)
        self.yes, self.asked, self.seconds, self.out_of_order = yes, [], 0, False
        self.bodies = []
        self.served = []  # what it calls its model, in a reply after another; the last from then on
        self.odd = {}  # candidate -> what is not as usual in its reply: "seconds", or members of the choice
        self.refuses_temperature = False
        self.under_way, self.most_at_once, self.counting = 0, 0, threading.Lock()
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        with self.server.counting:
            self.server.under_way += 1
            self.server.most_at_once = max(self.server.most_at_once, self.server.under_way)
        try:
            reply = self.answer()
        finally:
            # Whoever reads the reply asks the next question at once, so that this one must have ended before.
            with self.server.counting:
                self.server.under_way -= 1
        if isinstance(reply, str):
            self.send_error(400, reply)
            return
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(reply)))
        self.end_headers()
        with contextlib.suppress(BrokenPipeError):  # whoever asked was killed
            self.wfile.write(reply)

    def answer(self):
        """The body of a reply, or why the request is refused."""
        request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        question = request["messages"][1]["content"]
        self.server.asked.append(question)
        self.server.bodies.append(request)
        if self.server.refuses_temperature and "temperature" in request:
            return "Unsupported value: temperature"
        if self.server.out_of_order:
            return "out of order"
        time.sleep(self.server.seconds)
        about = re.search(r'have the object (?:type|color) "([^"]*)"\?', question)
        candidate = about[1] if about else "what it means"
        text = "Final answer: " + ("yes" if candidate in self.server.yes else "no")
        if not about:
            text = 'Final answer: {"sets": [{"object_types": ["heart"], "textures": "ALL"}]}'
        odd = dict(self.server.odd.get(candidate, {}))
        time.sleep(odd.pop("seconds", 0))
        served = {}
        if names := self.server.served:
            served = {"model": names.pop(0) if len(names) > 1 else names[0]}
        return json.dumps({"choices": [{"message": {"content": text}, "finish_reason": "stop", **odd}],
                           "usage": {"total_tokens": 9, "prompt_tokens": 6, "completion_tokens": 3}, **served}).encode()

    def log_message(self, *_):
        pass


class Asking(Case):
    """A suite of two scenarios, and a server to ask about them."""
    def setUp(self):
        super().setUp()
        suite = json.loads((DATA / "suites/q1.json").read_text())
        suite.update(id="small", scenarios=["heart", "red_heart"], presets={})
        self.suite = self.dir / "small.json"
        self.suite.write_text(json.dumps(suite))
        self.server = Server({"heart", "red", "dark red"})
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)


class Cassettes(Asking):
    def ask(self, *more, **options):
        self.environment.update(OPENAI_BASE_URL=f"http://127.0.0.1:{self.server.server_port}/v1", OPENAI_API_KEY=SECRET)
        return self.call("select", "--suite", self.suite, "--answers", "openai", "--model", "made-up-1", "--cassette",
                         "tape.jsonl", *more, **options)

    def test_a_suite_is_asked_once_and_played_without_a_server(self):
        # The first command fits; the second would take more than is left, and goes on where the first ended.
        said = self.ask("--max-queries", "200", expect=2).stderr
        self.assertIn("takes 112 queries, expected no more than 88", said)
        self.assertIn("224 questions, 0 answered already, 4 at once\n", said)
        self.assertNotIn("asked 100 of", said, "a line a question")
        self.assertEqual(len(self.server.asked), 112)
        run = ["run", self.suite, *RUN, "--out", "out", "--answers", "cassette:tape.jsonl"]
        refused = self.call(*run, expect=2)
        self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)
        fill = re.search(r"expected replies of made-up-1 to \"Bring me the red heart.\", 112 of 112 are missing; to ask: "
                         r"lgabench (select .*)$", refused.stderr)
        self.assertFalse((self.dir / "out").exists())
        self.call(*shlex.split(fill[1]))
        self.assertEqual(len(self.server.asked), 224)
        self.assertIn("224 questions, 224 answered already", self.ask().stderr)
        shown = self.ask("--json").stdout.splitlines()
        self.assertEqual(len(self.server.asked), 224, "what is on the cassette is not asked again")
        self.assertEqual([json.loads(line)["selection"]["provenance"] for line in shown], ["cassette"] * 2)
        for line in (self.dir / "tape.jsonl").read_text().splitlines():
            self.assert_as_schema("cassette", json.loads(line))

        self.server.shutdown()
        del self.environment["OPENAI_BASE_URL"], self.environment["OPENAI_API_KEY"]
        table = self.call(*run, "--tables").stdout
        self.assertIn("made-up-1", table)
        self.assert_matches_schemas("out")
        tape = (self.dir / "tape.jsonl").read_bytes()
        digest = hashlib.sha256(tape).hexdigest()
        self.assertEqual({cell["answers"] for cell, _ in self.cells("out").values()}, {"cassette:" + digest})
        self.assertEqual((self.dir / "out/answers" / (digest + ".jsonl")).read_bytes(), tape)
        record = json.loads((self.dir / "out/run.json").read_text())
        self.assertEqual(record["answers"], [{"file": "tape.jsonl", "model": "made-up-1", "name": digest + ".jsonl"}])
        for path in (self.dir / "out").rglob("*"):
            self.assertFalse(path.is_file() and SECRET.encode() in path.read_bytes(), path)
        for key, (cell, _) in self.cells("out").items():
            if cell["method"]["id"] == "lga":
                selection, = json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"]
                self.assertEqual(selection["selection"]["target"], {"object_types": ["heart"], "textures": ["red", "dark red"]})
                self.assertEqual(selection["selection"]["source"], "made-up-1")
                self.assertEqual(selection["selection"]["cost"]["lm_queries"], 112)

        # The run holds what it stands on: it is verified, and merged, where the cassette is not.
        (self.dir / "tape.jsonl").rename(self.dir / "elsewhere.jsonl")
        self.assertIn("bit-identical", self.call("verify", "out", "--sample", "1").stdout)
        self.call("merge", "merged", "out")
        self.assertIn("bit-identical", self.call("verify", "merged", "--sample", "1").stdout)
        self.assertIn("tape.jsonl: cannot be read", self.call(*run, expect=2).stderr)
        kept = self.dir / "out/answers" / (digest + ".jsonl")
        kept.write_bytes(kept.read_bytes().replace(b"Final answer: no", b"Final answer: yes", 1))
        self.assertIn("its SHA-256 is not the one in its name", self.call("verify", "out", expect=2).stderr)

        # One answer that is another makes other cells.
        (self.dir / "tape.jsonl").write_bytes(tape.replace(b"Final answer: no", b"Final answer: yes", 1))
        self.assertIn("out: holds another run (answers", self.call(*run, expect=2).stderr)
        self.call(*run[:-4], "--out", "edited", *run[-2:])
        self.assertFalse(set(self.cells("edited")) & set(self.cells("out")))

    def test_a_reply_without_an_answer_stops_no_other_question(self):
        self.server.odd = {
            "star": {"message": {"content": "It is"}, "finish_reason": "length"},
            "red": {"message": {"content": None, "refusal": "I cannot say."}},
            "blue": {"message": {"content": None}},
            "moon": {"seconds": 3},
            "green": {"finish_reason": None}, "heart": {"finish_reason": "eos_token"}}
        candidates = [c for c in self.server.odd if c not in ("green", "heart")]
        said = self.ask("--reply-timeout", "1", expect=3).stderr
        asked = [re.search(r'"([^"]*)"\?', question)[1] for question in self.server.asked]
        known = [c for c in candidates if c in asked]
        self.assertGreater(len(known), 2)
        self.assertEqual(len(self.server.asked), 224, "each once, both commands")
        listed = re.findall(r'^no answer: "([^"]*)", asked about "([^"]*)": (.*)$', said, re.M)
        self.assertEqual(sorted((about, why) for _, about, why in listed), sorted(2 * [(c, {
            "star": "the reply was cut off: finish_reason is length", "red": "the model refused: I cannot say.",
            "blue": "the reply is empty", "moon": "no reply within 1 s (--reply-timeout)"}[c]) for c in known]))
        self.assertIn(f"{2 * len(known)} questions have no answer; all others are answered in tape.jsonl", said)
        self.assertEqual(len((self.dir / "tape.jsonl").read_text().splitlines()), 224 - 2 * len(known))
        self.server.odd = {}
        self.ask()
        self.assertEqual(len(self.server.asked), 224 + 2 * len(known), "these alone are asked again")

    def test_a_server_that_refuses_a_field_is_asked_without_it(self):
        self.server.refuses_temperature = True
        self.assertIn("status 400", self.ask(expect=3).stderr)
        patch = '{"temperature": null, "reasoning_effort": "low"}'
        self.ask("--request", patch)
        self.assertEqual({(body["reasoning_effort"], "temperature" in body) for body in self.server.bodies[-200:]}, {("low", False)})
        self.server.shutdown()
        model = 'made-up-1 {"reasoning_effort":"low","temperature":null}'
        run = ["run", self.suite, *RUN, "--no-reference", "--out", "out", "--answers", "cassette:tape.jsonl"]
        self.call(*run)
        self.assertEqual(json.loads((self.dir / "out/run.json").read_text())["answers"][0]["model"], model)
        self.assert_matches_schemas("out")
        self.assertIn("bit-identical", self.call("verify", "out", "--all").stdout)
        # What another request was answered is not mixed with it.
        line = json.loads((self.dir / "tape.jsonl").read_text().splitlines()[0])
        line["request"]["temperature"] = 0
        del line["request"]["reasoning_effort"]
        with (self.dir / "tape.jsonl").open("a") as tape:
            tape.write(json.dumps(dict(line, key="k")) + "\n")
        self.assertIn(f"expected replies of one model, it has those of made-up-1, {model}", self.call(*run, expect=2).stderr)
        self.assertIn("expected --answers openai with them",
                      self.call("select", "heart", "--request", "{}", expect=2).stderr)

    def test_every_method_that_asks_runs_on_another_models_answers(self):
        """Words made of answers that nobody has seen have no committed embedding."""
        self.ask()
        self.call("run", self.suite, *RUN[2:], "--methods", "lga,lga_s,lga_l", "--set", "*.epochs=2", "--answers",
                  "cassette:tape.jsonl", "--out", "own", "--no-reference")
        self.assertEqual(sorted({cell["method"]["id"] for cell, _ in self.cells("own").values()}), ["lga", "lga_l", "lga_s"])

    def test_who_answered_is_kept_and_another_model_stops_the_command(self):
        self.server.served = ["m-2026-01-10"] * 56 + ["m-2026-09-30"]
        one = ["--concurrency", "1"]
        said = self.ask(*one, expect=3).stderr
        self.assertRegex(said, r'made-up-1, asked about "[^"]+": the server now names its model "m-2026-09-30", the replies in tape.jsonl '
                               r'are of "m-2026-01-10"; give another --cassette, or --any-served')
        self.assertEqual(len(self.server.asked), 57)
        lines = [json.loads(line) for line in (self.dir / "tape.jsonl").read_text().splitlines()]
        self.assertEqual({(line["served"], line["tokens"], line["prompt_tokens"], line["reply_tokens"]) for line in lines},
                         {("m-2026-01-10", 9, 6, 3)})
        today = datetime.datetime.now(datetime.timezone.utc).date()
        self.assertLessEqual({line["day"] for line in lines}, {str(today), str(today - datetime.timedelta(days=1))})
        for line in lines:
            self.assert_as_schema("cassette", line)
        self.ask(*one, expect=3)
        self.assertIn("made-up-1 (served: m-2026-01-10, m-2026-09-30) (live)", self.ask(*one, "--any-served").stdout)
        both = "made-up-1 (served: m-2026-01-10, m-2026-09-30)"
        self.assertIn(f"answers of {both}; ", self.call("select", "--suite", self.suite, "--score", "--scenes", "1", "--answers",
                                                        "cassette:tape.jsonl").stdout)
        self.call("run", self.suite, *RUN, "--out", "out", "--answers", "cassette:tape.jsonl")
        sources = {one["source"] for some in selections(self.dir / "out").values() for one in some}
        self.assertEqual(sources, {both, "made-up-1 (served: m-2026-09-30)"})
        self.assertIn(both, (self.dir / "out/report.md").read_text())
        self.assertIn("--any-served: expected --answers openai", self.call("run", self.suite, "--any-served", expect=2).stderr)

    def test_a_score_that_is_asked_for_says_how_far_it_is(self):
        self.server.seconds = .1  # more than five seconds in all
        self.environment.update(OPENAI_BASE_URL=f"http://127.0.0.1:{self.server.server_port}/v1")
        said = self.call("select", "--suite", self.suite, "--score", "--scenes", "1", "--answers", "openai", "--model", "made-up-1", "--cassette",
                         "slow.jsonl", "--concurrency", "2").stderr
        self.assertRegex(said, r"(?m)^asked \d+$")
        self.assertNotIn("of 0", said)
        self.assertNotIn("about -", said)
        self.assertRegex(said, r"(?m)^commands scored: \d of 6, about \d+ s left$")

    def test_what_is_no_cassette_of_one_model_is_refused(self):
        run = ["run", self.suite, *RUN, "--out", "out", "--answers"]
        for word in ("gpt5", "gpt4"):
            self.assertIn("--answers: expected recorded, claude, claude_clutter, claude_drawn, claude_fetch, claude_instruction, claude_paraphrases, claude_track, claude_unheard, claude_words, gpt4_released, gpt4_study, errands/claude, openai, none, cassette:FILE or FILE.json",
                          self.call(*run, word, expect=2).stderr)
        (self.dir / "empty.jsonl").write_text("")
        self.assertIn("expected replies of one model, it has none", self.call(*run, "cassette:empty.jsonl", expect=2).stderr)
        line = {"key": "k", "request": {"temperature": 0}, "reply": "Final answer: no", "tokens": 1, "seconds": 1.0}
        (self.dir / "two.jsonl").write_text("".join(json.dumps(dict(line, model=m, key=m)) + "\n" for m in "ab"))
        self.assertIn("it has those of a, b", self.call(*run, "cassette:two.jsonl", expect=2).stderr)
        self.assertIn("expected a command", self.call("select", expect=2).stderr)


def selections(run):
    """Row and scenario -> the Selections of its cells, in the order of their keys."""
    found = {}
    for path in sorted((run / "cells").iterdir()):
        cell = json.loads((path / "cell.json").read_text())
        if cell["method"]["kind"] == "method":
            command, = json.loads((path / "selection.json").read_text())["commands"]
            found.setdefault((cell["method"]["name"], cell["scenario"]["id"]), []).append(command["selection"])
    return found


class Live(Asking):
    ANSWERS = ["--answers", "openai", "--model", "made-up-1", "--cassette", "tape.jsonl"]

    def setUp(self):
        super().setUp()
        self.environment.update(OPENAI_BASE_URL=f"http://me:{SECRET}@127.0.0.1:{self.server.server_port}/v1",
                                OPENAI_API_KEY=SECRET)
        self.run_it = ["run", self.suite, "--methods", "lga", "--demos", "10", "--seeds", "0,1", "--episodes", "2", "--set",
                       "lga.epochs=2", "--no-reference", "--jobs", "2"]

    def play(self, *more, **options):
        return self.call(*self.run_it, *self.ANSWERS, "--out", "out", *more, **options)

    def test_as_many_questions_at_once_as_were_allowed(self):
        self.server.seconds = .05
        self.play("--concurrency", "9")
        self.assertGreater(self.server.most_at_once, 4, "the default")
        self.assertLessEqual(self.server.most_at_once, 9)

    def test_cells_ask_and_pay_once(self):
        table = self.play("--tables").stdout
        self.assertEqual(len(self.server.asked), 224, "two cells of each scenario, at once")
        self.assertEqual(len(set(self.server.asked)), 224)
        self.assertIn("Language model: made-up-1, asked during the run; its replies are in answers/.", table)
        self.assert_matches_schemas("out")
        tape = (self.dir / "tape.jsonl").read_bytes()
        digest = hashlib.sha256(tape).hexdigest()
        self.assertEqual([path.name for path in (self.dir / "out/answers").iterdir()], [digest + ".jsonl"])
        answers, = json.loads((self.dir / "out/run.json").read_text())["answers"]
        prompt = hashlib.sha256((DATA / "prompts/selection.txt").read_bytes()).hexdigest()
        self.assertEqual(answers, {"name": digest + ".jsonl", "file": "tape.jsonl", "model": "made-up-1", "prompt": prompt,
                                   "provider": f"http://127.0.0.1:{self.server.server_port}/v1"})
        for cell, _ in self.cells("out").values():
            self.assertEqual((cell["answers"], cell["data"]["prompt"]), ("openai:made-up-1", prompt))
        for path in (self.dir / "out").rglob("*"):
            self.assertFalse(path.is_file() and SECRET.encode() in path.read_bytes(), path)
        for both in selections(self.dir / "out").values():
            self.assertEqual(both[0], both[1], "who asked first makes no difference")
            self.assertEqual((both[0]["provenance"], both[0]["source"]), ("live", "made-up-1"))
            self.assertEqual((both[0]["cost"]["lm_queries"], both[0]["cost"]["lm_tokens"]), (112, 112 * 9))
            self.assertGreater(both[0]["cost"]["lm_seconds"], 0)

        # With the replies alone, and with nobody to ask.
        self.server.shutdown()
        del self.environment["OPENAI_BASE_URL"], self.environment["OPENAI_API_KEY"]
        before = self.results("out")
        (self.dir / "tape.jsonl").rename(self.dir / "elsewhere.jsonl")
        self.assertIn("4 bit-identical", self.call("verify", "out", "--all").stdout)
        shutil.rmtree(next((self.dir / "out/cells").iterdir()))
        self.assertIn(f"tape.jsonl: lacks replies that the run out used; copy out/answers/{digest}.jsonl there",
                      self.play("--resume", expect=2).stderr)
        shutil.copy(self.dir / f"out/answers/{digest}.jsonl", self.dir / "tape.jsonl")
        self.play("--resume")
        self.assertEqual(self.results("out"), before)
        self.assertEqual(len(self.server.asked), 224)
        kept = self.dir / "out/answers" / (digest + ".jsonl")
        kept.rename(self.dir / "kept.jsonl")
        self.assertIn("answers/ lacks the language model's replies", self.call("verify", "out", expect=2).stderr)
        kept.write_bytes(tape.replace(b"Final answer: no", b"Final answer: yes", 1))
        self.assertIn("its SHA-256 is not the one in its name", self.call("verify", "out", expect=2).stderr)

    def test_declared_questions_are_asked_before_any_cell(self):
        """So their time is no cell's, and how many there are is said beforehand and meanwhile."""
        dry = ["--dry-run", "--concurrency", "8"]
        self.assertIn("before the cells: 224 questions, 0 answered already, 8 at once\n", self.play(*dry).stdout)
        self.server.seconds = .5
        said = self.play("--timeout", "12").stderr  # 14 s of questions a command
        self.assertIn("224 questions, 0 answered already, 4 at once\n", said)
        self.assertRegex(said, r"asked 224 of 224 in \d+ s\n")
        self.assertLess(len(re.findall("asked ", said)), 10)
        self.assertRegex(self.play(*dry, "--fresh").stdout, r"before the cells: 224 questions, 224 answered already, 8 at once\n")
        self.assertNotIn("questions", self.call(*self.run_it, "--dry-run", "--out", "other").stdout)
        self.server.shutdown()
        self.call(*with_options(self.run_it, "--seeds", "2"), *self.ANSWERS, "--out", "more")  # nothing is asked again

    def test_only_those_of_the_shard_are_asked(self):
        one_seed = with_options(self.run_it, "--seeds", "0")  # a cell of each scenario
        for words, questions in ([], 224), (["--shard", "1/2"], 112), (["--scenarios", "heart"], 112):
            said = self.call(*one_seed, *self.ANSWERS, "--out", "out", "--dry-run", *words).stdout
            self.assertIn(f"before the cells: {questions} questions, 0 answered", said)

    @unittest.skipUnless(has(PYTHON, "numpy"), "needs NumPy")
    def test_a_python_method_declares_them_too(self):
        (self.dir / "mine.py").write_text(textwrap.dedent("""
            import lgabench_method as lgabench

            class Mine:
                questionnaire = True

                def select(self, command, space, services):
                    return lgabench.select_features(command, space, services.lm)

                def learn(self, demonstrations, services):
                    return None
            """))
        words = ["run", self.suite, "--python", PYTHON, "--methods", "mine.py:Mine", "--demos", "10", "--seeds", "0", "--episodes", "2", "--out", "out"]
        self.assertIn("before the cells: 224 questions", self.call(*words, *self.ANSWERS, "--dry-run").stdout)
        (self.dir / "mine.py").write_text((self.dir / "mine.py").read_text().replace("questionnaire = True", "pass"))
        self.assertNotIn("before the cells", self.call(*words, *self.ANSWERS, "--dry-run").stdout)

    @unittest.skipUnless(has(PYTHON, "numpy"), "needs NumPy")
    def test_finding_causes_asks_nothing_again(self):
        (self.dir / "mine.py").write_text(textwrap.dedent("""
            import lgabench_method as lgabench

            class Mine:
                def select(self, command, space, services):
                    return lgabench.select_features(command, space, services.lm)

                def learn(self, demonstrations, services):
                    services.log.epoch(1, 1, 0.0)
                    return Elsewhere()

            class Elsewhere:
                def act(self, observation, instruction):
                    return [.5, 0, 0, 0, 0, 1, .5, 0, 0, 0, 0, 1]
            """))
        words = with_options(self.run_it, "--methods", "mine.py:Mine")
        words = words[:words.index("--set")] + words[words.index("--set") + 2:]
        said = self.call(*words, "--python", PYTHON, *self.ANSWERS, "--max-queries", "112", "--out", "out").stderr
        self.assertIn("finding the causes of failures of mine: 4 cells, about ", said)
        self.assertNotIn("left out", said)
        self.assertEqual(len(self.server.asked), 224)
        causes = {json.loads(line)["attribution"] for path in (self.dir / "out/cells").glob("*/episodes.jsonl")
                  for line in path.read_text().splitlines()}
        self.assertLessEqual(causes, {"abstraction", "policy"})

    def test_waiting_for_others_questions_is_no_time_of_a_cell(self):
        """Methods that do not declare them ask as they run, in turn: the second of two cells waits, then asks itself."""
        self.server.seconds = 8
        rows = "fixture_probe+how=ask_in_learn+path=First,fixture_probe+how=ask_in_learn+path=Second"
        said = self.call("run", "q1", "--scenarios", "heart", "--methods", rows, "--demos", "10", "--seeds", "0", "--episodes", "2",
                         "--no-reference", "--plugin-path", FIXTURES / "faulty", "--jobs", "2", "--timeout", "15", "--out", "out",
                         *self.ANSWERS).stderr
        self.assertNotIn("before the cells", said)
        self.assertEqual(len(self.server.asked), 4)

    def test_shards_on_one_cassette_are_one_run(self):
        for i in (1, 2):
            self.call(*self.run_it, *self.ANSWERS, "--shard", f"{i}/2", "--out", f"part{i}")
        self.assertEqual(len(self.server.asked), 224)
        self.call("merge", "merged", "part1", "part2")
        self.assert_matches_schemas("merged")
        self.assertIn("4 bit-identical", self.call("verify", "merged", "--all").stdout)
        self.call(*self.run_it, *self.ANSWERS[:-1], "other.jsonl", "--shard", "2/2", "--out", "apart")
        self.assertIn("asked the same questions for two cassettes", self.call("merge", "both", "part1", "apart", expect=2).stderr)
        self.assertFalse((self.dir / "both").exists())

    def test_questions_while_learning_are_paid_for_too(self):
        self.call("run", "q1", "--scenarios", "heart", "--methods", "fixture_probe+how=ask_in_learn", "--demos", "10",
                  "--seeds", "0", "--episodes", "2", "--no-reference", "--plugin-path", FIXTURES / "faulty", "--out", "out",
                  *self.ANSWERS)
        self.assertEqual(len(self.server.asked), 2)
        ((selection,),) = selections(self.dir / "out").values()
        self.assertEqual((selection["cost"]["lm_queries"], selection["cost"]["lm_tokens"]), (2, 18))

    def test_a_server_that_fails_is_nobodys_fault(self):
        self.server.out_of_order = True
        self.play(expect=3)
        for _, status in self.cells("out").values():
            self.assertEqual((status["state"], status["fault"]), ("failed", "host"))
            self.assertRegex(status["reason"], 'made-up-1, asked about "[^"]+": status 400')
        self.server.out_of_order = False
        self.assertIn("takes 112 queries, expected no more than 100", self.play("--max-queries", "100", expect=3).stderr)
        self.play()
        self.assertIn("expected --model MODEL and --cassette FILE too",
                      self.call(*self.run_it, "--answers", "openai", expect=2).stderr)
        self.assertIn("expected --answers openai with them", self.call(*self.run_it, "--model", "m", expect=2).stderr)

    def test_a_reply_without_an_answer_is_named_and_the_rest_is_kept(self):
        self.server.odd = {"star": {"message": {"content": "It is"}, "finish_reason": "length"}}
        said = self.play(expect=3).stderr
        self.assertIn('1 of 1 questions have no answer from made-up-1: "star"; the first: ', said)
        self.assertIn('asking beforehand: 2 questions have no answer; the first: "Bring me the heart.", asked about "star"', said)
        for _, status in self.cells("out").values():
            self.assertEqual((status["state"], status["fault"]), ("failed", "host"))
        self.assertEqual(len((self.dir / "tape.jsonl").read_text().splitlines()), 2 * 111)

    def test_what_would_be_asked_can_be_seen_and_asks_nobody(self):
        said = self.call("select", "red_heart", "--show-prompt").stdout
        system, user = said.split("\n---\n")
        self.assertIn("Object types: ", system)
        self.assertIn('The command is: "Bring me the red heart."', user)
        self.assertIn('Could the target object have the object type "', user)
        self.assertEqual(len(self.server.asked), 0)
        self.assertIn("--score excludes --show-prompt", self.call("select", "--suite", "q1", "--score", "--show-prompt", expect=2).stderr)

    OWN = ('You see a table. Types: {object_types}. Looks: {textures}.\n---\nSomebody says "{command}". Might {about} '
           'have the {group} "{candidate}"? Answer at once: "Final answer: yes" or "Final answer: no".\n')

    def test_words_of_ones_own_ask_in_place_of_the_shipped_ones(self):
        own = self.dir / "own.txt"
        own.write_text(self.OWN)
        shown = self.call("select", "red_heart", "--show-prompt", "--prompt", own).stdout
        self.assertIn('Somebody says "Bring me the red heart.". Might the target object have the object type "', shown)
        self.play("--prompt", own)
        self.assertEqual(len(self.server.asked), 224)
        for body in self.server.bodies:
            self.assertTrue(body["messages"][0]["content"].startswith("You see a table. Types: L-shaped block, "), body)
            self.assertTrue(body["messages"][1]["content"].startswith('Somebody says "Bring me the '), body)
        digest = hashlib.sha256(self.OWN.encode()).hexdigest()
        named = f"made-up-1 (prompt {digest})"
        self.assert_matches_schemas("out")
        answers, = json.loads((self.dir / "out/run.json").read_text())["answers"]
        self.assertEqual((answers["model"], answers["prompt"]), (named, digest))
        for cell, _ in self.cells("out").values():
            self.assertEqual((cell["answers"], cell["data"]["prompt"]), ("openai:" + named, digest))
        for both in selections(self.dir / "out").values():
            self.assertEqual(both[0]["source"], named)
        first, *others = map(json.loads, (self.dir / "tape.jsonl").read_text().splitlines())
        self.assert_as_schema("cassette", first)
        self.assertEqual((first["prompt"], [line for line in others if "prompt" in line]), (self.OWN, []))

        # The cassette has the words: nobody needs the file again who replays it.
        own.rename(self.dir / "away.txt")
        self.assertIn("4 bit-identical", self.call("verify", "out", "--all").stdout)
        self.call("run", self.suite, *RUN, "--no-reference", "--answers", "cassette:tape.jsonl", "--out", "kept")
        for both in selections(self.dir / "kept").values():
            self.assertEqual(both[0]["source"], named)
        self.assertEqual(len(self.server.asked), 224)
        self.assertIn("tape.jsonl: expected replies to lgabench's own prompt, it has those to the prompt " + digest,
                      self.play(expect=2).stderr)
        for said, expected in (("", "own.txt: expected a prompt with {object_types}"),
                               (self.OWN.replace("{about}", "it"), "own.txt: expected {about} in it too"),
                               (self.OWN + "{color}", "own.txt: line 4: expected {object_types}"),
                               (self.OWN + " " * 65536, "own.txt: cannot be read")):
            own.write_text(said)
            refused = self.play("--prompt", own, expect=2).stderr
            self.assertIn(expected, refused)
            self.assertEqual(len(refused.splitlines()), 1, refused)
        self.assertIn("--prompt, --reply-timeout, --concurrency and --any-served: expected --answers openai with them",
                      self.call(*self.run_it, "--prompt", own, expect=2).stderr)

    def test_the_request_is_part_of_what_the_answers_are(self):
        self.server.refuses_temperature = True
        self.play("--request", '{"temperature": null}')
        asked = len(self.server.asked)
        self.assertEqual({cell["answers"] for cell, _ in self.cells("out").values()}, {'openai:made-up-1 {"temperature":null}'})
        self.assert_matches_schemas("out")
        (selection, *_), *_ = selections(self.dir / "out").values()
        self.assertEqual(selection["source"], 'made-up-1 {"temperature":null}')
        self.assertIn("4 bit-identical", self.call("verify", "out", "--all").stdout)
        self.play("--request", '{ "temperature" :null, "seed": null}')
        self.assertEqual(len(self.server.asked), asked, "the same patch in other words")
        self.assertIn("out: holds another run (answers", self.play("--request", '{"temperature":null,"seed":1}', expect=2).stderr)
        self.assertIn("out: holds another run (answers", self.play(expect=2).stderr)
        self.assertIn("--request: /model: expected no such member, which lgabench sets", self.play("--request", '{"model":"n"}', expect=2).stderr)
        self.assertIn("expected --answers openai with them", self.call(*self.run_it, "--request", "{}", expect=2).stderr)

    def test_a_worker_that_is_killed_leaves_a_cassette_that_goes_on(self):
        self.server.seconds = 0.05
        run = self.start(*self.run_it, *self.ANSWERS, "--out", "out")
        while len(self.server.asked) < 30:
            time.sleep(0.01)
        workers = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        for worker in workers:
            os.kill(int(worker), signal.SIGKILL)
        said = run.communicate(timeout=300)[1]
        self.assertEqual(run.returncode, 0, said)
        self.assertIn("asking beforehand: signal 9 (Killed)", said)
        self.assertLessEqual(len(self.server.asked), 224 + 4 * len(workers), "but for those under way")
        self.assertEqual(len(set(self.server.asked)), 224)
        lines = (self.dir / "tape.jsonl").read_text().splitlines()
        self.assertEqual((len(lines), len({json.loads(line)["key"] for line in lines})), (224, 224))


@unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays it")
@unittest.skipUnless(os.environ.get("LGABENCH_TEST_SERVER"), "LGABENCH_TEST_SERVER=URL names no server of chat completions")
class RealServer(Case):
    """A server that nobody here wrote: LGABENCH_TEST_SERVER is its address up to /v1, LGABENCH_TEST_MODEL a model of its,
    LGABENCH_TEST_REQUEST its --request, OPENAI_API_KEY its key if it wants one. Whatever the model says, nothing is lost and nothing asked twice."""

    def setUp(self):
        super().setUp()
        key = os.environ.get("OPENAI_API_KEY", "")
        self.environment.update(OPENAI_BASE_URL=os.environ["LGABENCH_TEST_SERVER"], OPENAI_API_KEY=key or SECRET)
        self.words = ["--answers", "openai", "--model", os.environ.get("LGABENCH_TEST_MODEL", "any"), "--cassette", "tape.jsonl",
                      "--request", os.environ.get("LGABENCH_TEST_REQUEST", '{"max_tokens": 200}')]

    def lines(self):
        tape = self.dir / "tape.jsonl"
        return [json.loads(line) for line in tape.read_text().splitlines()] if tape.exists() else []

    def ask(self):
        """What is said, and whether every question was answered."""
        done = subprocess.run(command_line("select", "heart", *self.words), cwd=self.dir, env=self.environment, capture_output=True,
                              text=True, timeout=3000)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        self.assertNotIn(self.environment["OPENAI_API_KEY"], done.stdout + done.stderr + (json.dumps(self.lines())))
        return done.stderr, done.returncode == 0

    def test_every_reply_is_kept_and_used(self):
        said, all_answered = self.ask()
        kept = self.lines()
        self.assertEqual(len({line["key"] for line in kept}), len(kept))
        for line in kept:
            self.assertIn("final answer", line["reply"].lower())
        if not all_answered:  # a small model: each question without an answer is named, or it is given up early
            unanswered = re.findall(r"^no answer: ", said, re.M)
            if "lgabench stopped asking" in said:
                self.assertEqual(kept, [])
                return
            self.assertEqual(len(kept) + len(unanswered), 112, said)
            return
        self.assertEqual(len(kept), 112)
        self.assertIn("112 questions, 112 answered already", self.ask()[0])
        self.environment["OPENAI_BASE_URL"] = "http://127.0.0.1:1"  # it is not needed any more
        self.call("run", "q1", *RUN, "--scenarios", "heart", "--no-reference", "--out", "out", *self.words)
        self.assertIn("bit-identical", self.call("verify", "out", "--all").stdout)


class Recorded(Case):
    def test_one_source_alone_refuses_what_it_lacks_before_any_cell(self):
        run = ["run", "q1", *RUN, "--out", "out", "--scenarios", "heart,letter,rotate_block", "--answers"]
        for source, lacking in (("gpt4_released", "letter, rotate_block"), ("gpt4_study", "rotate_block")):
            self.assertIn(f"--answers {source}: expected answers for {lacking}; it has those for: red_heart",
                          self.call(*run, source, expect=2).stderr)
        self.assertFalse((self.dir / "out").exists())

    def test_a_form_or_a_second_set_that_lacks_is_refused_before_the_forecast(self):
        second = self.dir / "second.json"  # of a sweep, without what to avoid
        second.write_text(json.dumps({"model": "m", "space": "tabletop", "answers": [
            {"command": "Sweep the block without touching the pan.", "target": {"object_types": ["block"], "textures": "ALL"}}]}))
        sweep = "sweep_block_without_touching_pan"
        for words, says in (
                (["clutter", "--methods", "lga+meaning=structured"],
                 r'^lgabench: lga: answers of gpt4_released: expected "structured" for "Bring me the red heart", which meaning=structured asks '
                 r"for \(scenarios that lack this: red_heart, heart, .*, something_that_looks_like_stone\)\n$"),
                (["clutter", "--methods", "human,selected_by:lga+meaning=structured,lga", "--scenarios", "heart"],
                 r"^lgabench: selected_by:lga\S*: answers of gpt4_released: .* \(scenarios that lack this: heart\)\n$"),
                (["q1", "--methods", "lga", "--scenarios", sweep, "--answers", second],
                 rf"^lgabench: lga: m: no recorded answer on .* in \"Sweep.* \(scenarios that lack this: {sweep}\)\n$"),
                (["q1", "--methods", "lga+meaning=structured", "--scenarios", "heart", "--answers", self.write_flat()],
                 r'^lgabench: lga: answers of flat: expected "structured" for "Bring me the heart\."')):
            for dry in [], ["--dry-run"]:
                with self.subTest(words + dry):
                    done = self.call("run", *words, "--demos", "1", "--seeds", "0", "--out", "out", *dry, expect=2)
                    self.assertEqual(done.stdout, "")
                    self.assertRegex(done.stderr, says)
        self.assertFalse((self.dir / "out").exists())
        self.call("run", "clutter", "--methods", "lga+meaning=named,human,gcbc_seg", "--dry-run")  # which ask nobody for a meaning

    def write_flat(self):
        file = self.dir / "flat.json"
        file.write_text(json.dumps({"model": "m", "space": "tabletop", "answers": [
            {"command": "Bring me the heart.", "target": {"object_types": ["heart"], "textures": "ALL"}}]}))
        return file

    def test_scores_name_all_whose_answers_were_used(self):
        self.assertIn("answers of GPT-4 (released with the code, 2023-07) and GPT-4, version not stated there and Claude (Anthropic, 2026); ",
                      self.call("select", "--suite", "clutter", "--score", "--scenes", "2").stdout)

    def test_one_model_answers_the_whole_track_in_both_forms(self):
        def answers(source):
            document = json.loads((DATA / f"answers/{source}.json").read_text())
            return {(one.get("space", document.get("space")), one["command"]):
                    {name: value for name, value in one.items() if name not in ("space", "rationale")} for one in document["answers"]}

        track = answers("claude_track")
        for source in "claude", "claude_clutter", "claude_fetch", "claude_words", "claude_drawn":
            for command, one in answers(source).items():
                if command in track or source in ("claude_words", "claude_drawn"):
                    self.assertEqual({name: value for name, value in track[command].items() if name in one}, one, command)
        for suite in "clutter", "few_members", "many_commands", "fetch", "words", "drawn", "knowledge":
            self.call("run", suite, "--methods", "lga,lga+meaning=structured", "--answers", "claude_track", "--dry-run")
        said = self.call("select", "--suite", "clutter", "--score", "--scenes", "2", "--answers", "claude_track").stdout
        self.assertTrue(said.startswith("answers of Claude (Anthropic, 2026); "))
        self.assertRegex(said, r"\nall +structured +14 ")

    def test_select_refuses_options_of_a_server_without_one(self):
        self.assertIn("--model: expected --answers openai or cassette:FILE with it, not recorded",
                      self.call("select", "heart", "--model", "m", expect=2).stderr)
        self.assertIn("expected --answers openai with them",
                      self.call("select", "heart", "--max-queries", "5", expect=2).stderr)

    def test_the_best_single_product_is_the_truth_where_one_product_says_it(self):
        suite = json.loads((DATA / "suites/words.json").read_text())
        commands = ["words_lookup_tiger_mug", "words_union_green_apple_yellow_banana"]
        suite.update(id="two", scenarios=commands, groups={})
        suite.pop("presets")
        (self.dir / "two.json").write_text(json.dumps(suite))
        self.call("select", "--suite", "two.json", "--best-product", "best.json")
        best = {one["scenario"]: one["target"] for one in json.loads((self.dir / "best.json").read_text())["answers"]}
        truths = [json.loads((DATA / f"scenarios/{id}.json").read_text())["commands"][0]["truth"]["target"] for id in commands]
        self.assertEqual(best[commands[0]], truths[0])
        scored = self.call("select", "--suite", "two.json", "--score", "--answers", "best.json", "--json").stdout
        exact = {}
        for row in map(json.loads, scored.splitlines()):
            exact[row["asked"]] = row["exact_scenes"] / row["scenes"]
        self.assertEqual(exact["flat"], .5, "all scenes of one command, none of the other, whose near misses are in the product")
        said = self.call("select", "heart", "--best-product", "x.json", expect=2).stderr
        self.assertIn("--suite", said)

    def test_a_scenario_without_answers_is_played_by_methods_that_ask_no_model(self):
        run = ["run", "q1", "--scenarios", "stack_small_block_on_hexagon", "--demos", "10", "--seeds", "0", "--episodes", "2",
               "--set", "*.epochs=2", "--out"]
        self.call(*run, "out", "--methods", "human", "--answers", "none")
        self.assert_matches_schemas("out")
        (selection,) = {(self.dir / "out/cells" / key / "selection.json").read_text()
                        for key, (cell, _) in self.cells("out").items() if cell["method"]["id"] == "human"}
        self.assertEqual(json.loads(selection)["commands"][0]["selection"]["onto"]["object_types"], ["hexagon"])
        self.assertIn("expected answers for stack_small_block_on_hexagon",
                      self.call(*run, "refused", "--methods", "lga", expect=2).stderr)
        said = self.call(*run, "planned", "--methods", "lga,lga_l,lga_s+meaning=named,human", "--answers", "none", "--dry-run").stderr
        self.assertIn("note: --answers none, and a language model is asked by lga, lga_l, whose cells will fail\n", said)

    def selections(self, *more):
        """Method -> the one Selection of its one cell."""
        run = ["run", "q1", "--scenarios", "red_heart", "--demos", "10", "--seeds", "0", "--episodes", "2", "--no-reference",
               "--fresh", "--out", "out", "--methods", "lga,lga_hill,human", *more]
        self.call(*run, *(word for m in ("lga", "lga_hill", "human") for word in ("--set", f"{m}.epochs=2")))
        self.assert_matches_schemas("out")
        found = {}
        for key, (cell, _) in self.cells("out").items():
            command, = json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"]
            found[cell["method"]["id"]] = command["selection"], cell
        return found

    def test_a_method_that_edits_starts_from_the_answers_that_people_were_given(self):
        found = self.selections()
        self.assertEqual(found["lga"][0]["target"]["textures"], ["red", "red paisley"])
        self.assertEqual(len(found["lga_hill"][0]["target"]["textures"]), 5)
        self.assertIn("version not stated there", found["lga_hill"][0]["source"])
        self.assertEqual({m: cell["method"].get("asks") for m, (_, cell) in found.items()},
                         {"lga": None, "lga_hill": "edit", "human": "specify"})
        alone = self.selections("--answers", "gpt4_released")
        self.assertEqual(len(alone["lga_hill"][0]["target"]["textures"]), 2)

    def test_the_truth_is_the_released_one_or_the_printed_one(self):
        self.assertEqual(len(self.selections()["human"][0]["target"]["textures"]), 5)
        selection, cell = self.selections("--truth", "printed")["human"]
        self.assertEqual(selection["target"]["textures"], ["red", "dark red", "dark red swirl", "red paisley"])
        self.assertEqual(cell["scenario"]["truth"], "printed")
        self.assertEqual(json.loads((self.dir / "out/run.json").read_text())["request"]["truth"], "printed")
        shown = json.loads(self.call("select", "red_heart", "--truth", "printed", "--json").stdout)
        self.assertEqual(shown["quality"]["target"]["textures"]["true_size"], 4)


class Paraphrases(Case):
    def test_a_method_is_asked_about_the_words_of_the_episode(self):
        table = self.call("run", "paraphrases", "--preset", "smoke", "--scenarios", "paraphrase_red_heart,paraphrase_rotate_block",
                          "--methods", "lga", "--episodes", "4", "--set", "lga.epochs=2", "--tables", "--out", "run").stdout
        self.assert_matches_schemas("run")
        selected = {cell["scenario"]["id"]: (cell["scenario"]["commands"], json.loads((path.parent / "selection.json").read_text()))
                    for path in (self.dir / "run/cells").glob("*/cell.json")
                    for cell in [json.loads(path.read_text())] if cell["method"]["id"] == "lga"}
        for commands, selections in selected.values():
            for command, one in zip(commands, selections["commands"], strict=True):
                self.assertEqual(one["selection"]["asked_as"], command["utterance"])
                self.assertEqual(one["selection"]["source"], "Claude (Anthropic, 2026)")
        rows = {(row["scenario"], row["arm"]): row for row in json.loads((self.dir / "run/summary.json").read_text())["rows"]
                if row["method"] == "lga"}
        self.assertEqual(rows["paraphrase_red_heart", "implied"]["marks"].count("ambiguous"), 1)
        self.assertEqual(rows["(mean)", "implied"]["episodes"], 4, "of rotate_block alone")
        self.assertEqual(rows["(mean)", "described"]["shift"]["selected_otherwise"], 1, "both changed")
        self.assertEqual(rows["(mean)", "synonym"]["shift"]["selected_otherwise"], .5)
        self.assertIn("implied (1 of 2)", table)

    def test_answers_are_scored_by_arm_without_a_policy(self):
        score = ["select", "--suite", "paraphrases", "--score", "--scenes", "4"]
        rows = {(row["group"], row["asked"]): row for row in map(json.loads, self.call(*score, "--json").stdout.splitlines())}
        self.assertEqual([group for group, asked in rows if asked == "flat"],
                         ["original", "synonym", "polite", "described", "implied", "all"])
        self.assertEqual([rows[group, "flat"]["commands"] for group in ("original", "described", "implied", "all")],
                         [13, 12, 7, 58], "without the ambiguous ones")
        self.assertEqual([rows[group, "flat"]["otherwise"] for group in ("original", "synonym", "described")], [0, 3, 6])
        self.assertEqual(rows["original", "flat"]["scenes"], 13 * 4)
        text = self.call(*score).stdout
        self.assertIn("flat, paraphrase_red_heart, implied (ambiguous, in no mean): ", text)
        self.assertNotIn("flat, paraphrase_heart", text, "answered exactly, and clear")
        self.assertRegex(text, r'structured: answers of claude_paraphrases: expected "structured" for "Bring me the red heart."')

    def test_where_nothing_is_recorded_one_line_says_so(self):
        refused = self.call("run", "paraphrases", "--preset", "smoke", "--methods", "lga", "--answers", "claude", "--out", "run",
                            expect=2).stderr
        self.assertIn("--answers claude: expected answers for paraphrase_red_heart, paraphrase_rotate_block; it has those for: ",
                      refused)


class Written(Case):
    """A file of answers that somebody wrote, in the format of the recorded ones."""
    def setUp(self):
        super().setUp()
        self.file = self.dir / "mine.json"
        self.answers = {"model": "me, by hand", "space": "tabletop", "answers": [
            {"scenario": "heart", "command": "Bring me the heart", "target": {"object_types": ["heart"], "textures": "ALL"}},
            {"scenario": "sweep_block_without_touching_line", "command": "Sweep the block without touching the line",
             "target": {"object_types": ["small block"], "textures": "ALL"},
             "avoid": {"object_types": ["line"], "textures": "ALL"}}]}
        self.write(self.answers)
        self.run_it = ["run", "q1", *RUN, "--scenarios", "heart", "--no-reference", "--answers", "mine.json"]

    def write(self, answers):
        self.file.write_text(json.dumps(answers))

    def test_a_run_is_based_on_it_and_holds_it(self):
        self.call(*self.run_it, "--out", "out")
        self.assert_matches_schemas("out")
        digest = hashlib.sha256(self.file.read_bytes()).hexdigest()
        record = json.loads((self.dir / "out/run.json").read_text())
        self.assertEqual(record["answers"], [{"file": "mine.json", "model": "me, by hand", "name": digest + ".json"}])
        (cell, _), = self.cells("out").values()
        self.assertEqual(cell["answers"], "file:" + digest)
        ((selection,),) = selections(self.dir / "out").values()
        self.assertEqual((selection["target"]["object_types"], selection["source"], selection["provenance"]),
                         (["heart"], "me, by hand", "recorded"))
        self.file.unlink()
        self.assertIn("bit-identical", self.call("verify", "out", "--all").stdout)
        self.call("merge", "merged", "out")
        self.assertIn("bit-identical", self.call("verify", "merged", "--all").stdout)
        self.answers["answers"][0]["target"]["textures"] = ["red"]
        self.write(self.answers)
        self.assertIn("out: holds another run (answers", self.call(*self.run_it, "--out", "out", expect=2).stderr)

    def test_select_shows_it(self):
        shown = self.call("select", "sweep_block_without_touching_line", "--answers", "mine.json").stdout
        self.assertIn("me, by hand (recorded)", shown)
        self.assertIn("avoid\n  object types  line\n", shown)

    def test_what_is_malformed_is_refused_with_its_place(self):
        def answer(**members):
            return {**self.answers, "answers": [{**self.answers["answers"][0], **members}]}

        twice = {**self.answers, "answers": self.answers["answers"][:1] * 2}
        for wrong, place in (
                (answer(target={"object_types": ["hart"], "textures": []}), "/answers/0/target/object_types/0: expected a name of the feature space"),
                (answer(target={"object_types": ["heart"]}), '/answers/0/target: expected a member "textures"'),
                (answer(aviod={}), '/answers/0: unknown member "aviod" (did you mean "avoid"?)'), (answer(space="kitchen"), "/answers/0/space: no feature space \"kitchen\", expected one of: "),
                (twice, "/answers/1: expected each scenario"),
                ({**self.answers, "model": ""}, "/model: expected words"), ({**self.answers, "answers": []}, "/answers: expected at least one"),
                ({**self.answers, "modle": 1}, '/: unknown member "modle"')):
            with self.subTest(place):
                self.write(wrong)
                for words in (["run", "q1", *RUN, "--scenarios", "heart", "--out", "out"], ["select", "heart"]):
                    self.assertIn("mine.json: " + place, self.call(*words, "--answers", "mine.json", expect=2).stderr)
        self.file.write_text("{")
        self.assertIn("mine.json: ", self.call(*self.run_it, "--out", "out", expect=2).stderr)
        self.assertIn("there.json: cannot be read", self.call(*self.run_it[:-1], "there.json", "--out", "out", expect=2).stderr)
        self.write(self.answers)
        self.assertIn("--answers mine.json: expected answers for letter; it has those for: heart | sweep_block_without_touching_line",
                      self.call("run", "q1", *RUN, "--scenarios", "letter", "--answers", "mine.json", expect=2).stderr)
        self.assertFalse((self.dir / "out").exists())


class Humans(Case):
    """Three people who are invented here, with what they would have answered."""
    RUN = ["run", "q1", "--scenarios", "heart,red_heart", "--methods", "lga,lga_hill,human", "--demos", "10", "--seeds",
           "0", "--episodes", "4", *(word for method in ("lga", "lga_hill", "human")
                                     for word in ("--set", f"{method}.epochs=2"))]
    # textures chosen for the red heart, and seconds from scratch and edited
    PEOPLE = {"made-up-1": (["red"], 150, 50), "made-up-2": (["red", "dark red"], 160, 59),
              "made-up-3": (["red", "red swirl"], 170, 71)}

    def setUp(self):
        super().setUp()
        (self.dir / "people").mkdir()
        self.proposals = {}
        for scenario in ("heart", "red_heart"):
            said = json.loads(self.call("select", scenario, "--answers", "gpt4_study", "--json").stdout)
            self.proposals[scenario] = said["utterance"], {"target": said["selection"]["target"]}
        for person in self.PEOPLE:
            self.write(person)

    def write(self, person, **changes):
        textures, specified_s, edited_s = self.PEOPLE[person]
        answers = []
        for scenario, (utterance, proposal) in self.proposals.items():
            chosen = {"target": {"object_types": ["heart"], "textures": "ALL" if scenario == "heart" else textures}}
            answers.append({"scenario": scenario, "command": utterance,
                            "specified": {"selection": chosen, "seconds": specified_s},
                            "edited": {"proposal": proposal, "proposed_by": "gpt-4", "selection": chosen,
                                       "seconds": edited_s}})
        (self.dir / "people" / (person + ".json")).write_text(json.dumps(dict({
            "participant": person, "study": "invented for a test", "license": "CC0-1.0", "answers": answers,
            "consent": {"given": True, "statement": "invented", "ethics": "none needed"}}, **changes)))

    def test_a_cell_for_each_of_them(self):
        stand_ins = self.call(*self.RUN, "--tables", "--out", "without")
        self.assertIn("True mask: true φ̂: no human data.", stand_ins.stdout)
        table = self.call(*self.RUN, "--tables", "--out", "out", "--humans", "people").stdout
        self.assertIn("Human: 3 participants.", table)
        self.assertIn("LGA-HILL: 3 participants, who edited a language model's φ̂.", table)
        self.assertNotIn("no human data", table)
        self.assert_matches_schemas("out")

        found = {}
        for key, (cell, status) in self.cells("out").items():
            self.assertEqual(status["state"], "ok")
            self.assertEqual("participant" in cell, cell["method"]["id"] in ("human", "lga_hill"))
            if "participant" not in cell:
                continue
            person = cell["participant"]["id"]
            file = (self.dir / "people" / (person + ".json")).read_bytes()
            self.assertEqual(cell["participant"]["sha256"], hashlib.sha256(file).hexdigest())
            self.assertEqual((self.dir / "out/answers" / (cell["participant"]["sha256"] + ".json")).read_bytes(), file)
            command, = json.loads((self.dir / "out/cells" / key / "selection.json").read_text())["commands"]
            found[cell["method"]["id"], cell["scenario"]["id"], person] = command["selection"]
        self.assertEqual(len(found), 2 * 2 * 3)
        for person, (textures, specified_s, edited_s) in self.PEOPLE.items():
            for method, seconds, source in (("human", specified_s, f"participant {person}"),
                                            ("lga_hill", edited_s, f"gpt-4, edited by participant {person}")):
                selection = found[method, "red_heart", person]
                self.assertEqual(selection["target"]["textures"], textures)
                self.assertEqual(selection["provenance"], "human")
                self.assertEqual(selection["source"], source)
                self.assertEqual(selection["cost"]["human_seconds"], seconds)
                self.assertEqual(selection["cost"]["lm_queries"], 112 if method == "lga_hill" else 0)

        summary = json.loads((self.dir / "out/summary.json").read_text())
        rows = {(row["method"].split("+")[0], row["scenario"]): row for row in summary["rows"]}
        self.assertEqual([rows["human", s]["participants"] for s in ("heart", "(mean)")], [3, 3])
        self.assertEqual((rows["human", "heart"]["seeds"], rows["human", "heart"]["episodes"]), (1, 12))
        self.assertEqual(rows["human", "red_heart"]["phi"][0]["source"], "3 participants")
        self.assertEqual(rows["lga_hill", "red_heart"]["phi"][0]["source"], "gpt-4, edited by 3 participants")
        self.assertAlmostEqual(rows["human", "red_heart"]["phi"][0]["human_seconds"], 160)
        claims = {claim["claim"]: claim for claim in json.loads((self.dir / "out/claims.json").read_text())["claims"]}
        self.assertEqual(claims["C5"]["verdict"], "held")
        self.assertAlmostEqual(claims["C5"]["differences"][0]["difference"], 100)
        self.assertEqual(claims["C2"]["reason"], "no human data at 50 demonstrations")
        self.assertIn("bit-identical", self.call("verify", "out", "--sample", "4", "--seed", "1").stdout)

        # Who takes another texture is another cell; nobody else is.
        self.PEOPLE = dict(self.PEOPLE, **{"made-up-2": (["red"], 160, 59)})
        self.write("made-up-2")
        self.call(*self.RUN, "--out", "edited", "--humans", "people")
        changed = set(self.cells("out")) - set(self.cells("edited"))
        self.assertEqual({self.cells("out")[key][0]["participant"]["id"] for key in changed}, {"made-up-2"})
        self.assertEqual(len(changed), 4)

    def test_who_was_not_asked_has_no_cell(self):
        answers = json.loads((self.dir / "people/made-up-1.json").read_text())["answers"]
        del answers[0]["edited"], answers[1]["specified"]
        self.write("made-up-1", answers=answers)
        table = self.call(*self.RUN, "--out", "out", "--humans", "people", "--no-reference").stdout
        who = sorted((cell["method"]["id"], cell["scenario"]["id"], cell["participant"]["id"][-1])
                     for cell, _ in self.cells("out").values() if "participant" in cell)
        self.assertEqual(who, [("human", "heart", "1"), ("human", "heart", "2"), ("human", "heart", "3"),
                               ("human", "red_heart", "2"), ("human", "red_heart", "3"),
                               ("lga_hill", "heart", "2"), ("lga_hill", "heart", "3"),
                               ("lga_hill", "red_heart", "1"), ("lga_hill", "red_heart", "2"), ("lga_hill", "red_heart", "3")])
        for person in ("made-up-2", "made-up-3"):
            (self.dir / "people" / (person + ".json")).unlink()
        one = self.call(*self.RUN, "--out", "one", "--humans", "people", "--no-reference").stdout
        self.assertRegex(one, r"Human .*‡")  # a scenario is missing from the mean
        refused = self.call(*self.RUN[:2], "--scenarios", "letter", *self.RUN[4:], "--out", "none", "--humans", "people", expect=2)
        self.assertIn("--humans: no person answered for lga_hill in a scenario of this run", refused.stderr)

    def test_where_nobody_is_asked_nobodys_answers_are_taken(self):
        refused = self.call("run", "q1", "--scenarios", "heart", "--methods", "gcbc_seg", "--demos", "10", "--seeds", "0",
                            "--out", "none", "--humans", "people", expect=2)
        self.assertIn("--humans: expected a method that asks people", refused.stderr)
        self.assertFalse((self.dir / "none").exists())

    def test_what_no_layout_shows_is_an_empty_answer(self):
        """The pallet is the goal; a second one is never shown."""
        answers = json.loads((self.dir / "people/made-up-1.json").read_text())["answers"]
        for answer in answers:
            answer["specified"]["selection"]["target"]["object_types"] = ["pallet"]
        self.write("made-up-1", answers=answers)
        self.call(*self.RUN, "--out", "out", "--humans", "people", "--no-reference")
        own = [key for key, (cell, _) in self.cells("out").items()
               if (cell["method"]["id"], cell.get("participant", {}).get("id")) == ("human", "made-up-1")]
        self.assertEqual(len(own), 2)
        for key in own:
            episodes = [json.loads(line) for line in (self.dir / "out/cells" / key / "episodes.jsonl").read_text().splitlines()]
            self.assertEqual({(e["failure"], e["attribution"]) for e in episodes}, {("abstraction_empty", "abstraction")})
        self.assert_matches_schemas("out")

    def test_what_was_edited_must_be_what_is_proposed(self):
        proposal = self.proposals["red_heart"][1]
        proposal["target"]["textures"].pop()
        self.write("made-up-1")
        self.call(*self.RUN, "--out", "out", "--humans", "people", expect=3)
        (failed, status), = [(cell, status) for cell, status in self.cells("out").values() if status["state"] == "failed"]
        self.assertEqual((failed["method"]["id"], failed["participant"]["id"]), ("lga_hill", "made-up-1"))
        self.assertEqual(status["fault"], "host")
        self.assertIn("the edit began with another proposal than this run's language model makes", status["reason"])
        self.write("made-up-1", consent={"given": False, "statement": "-", "ethics": "-"})
        self.assertIn("answers are used only with consent", self.call(*self.RUN, "--humans", "people", expect=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
