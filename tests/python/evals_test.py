"""Tasks for language-model harnesses: their score is that of `lgabench select --score` with the same replies.

LGABENCH_FULL: in the harnesses themselves, where they are installed (last tried: inspect_ai 0.3.285, lm_eval 0.4.13).
"""
import http.server
import importlib.util
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import threading
import unittest
import zlib

import lgabench
from data_test import PROGRAM, Case
from lgabench import evals
from scenes_test import FULL

SOURCE = pathlib.Path(__file__).parents[2]
SCENES = 4
TYPES = ("bowl", "heart", "block", "star", "ring")


def reply_to(user):
    """What a made-up model says: a function of the words alone. Some of its meanings cannot be read."""
    number = zlib.crc32(user.encode())
    if "Final answer: yes" in user:
        return f"Let me think.\n\nFinal answer: {'no' if number % 2 else 'yes'}"
    if "block" in user.split("Which objects")[0]:
        return "I would have to see the table.\n"
    types = [name for i, name in enumerate(TYPES) if number >> i & 1] or ["heart"]
    meaning = {"sets": [{"object_types": {"except": types}, "textures": "ALL"}], "which": None}
    return "Step by step.\n\nFinal answer:\n" + json.dumps(meaning)


def replies(questions):
    return [{**one, "reply": reply_to(one["user"])} for one in questions]


class Server(http.server.ThreadingHTTPServer):
    """The made-up model behind OpenAI's API, on loopback. Told that it cannot be read, it says the same again."""
    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.asked = set()
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        messages = json.loads(self.rfile.read(int(self.headers["Content-Length"])))["messages"]
        self.server.asked.add((messages[0]["content"], messages[1]["content"]))
        body = json.dumps({"choices": [{"index": 0, "message": {"content": reply_to(messages[1]["content"])}, "finish_reason": "stop"}],
                           "usage": {"total_tokens": 9}}).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


class Suites(Case):
    """Two suites, one of a task with a second set, and how the program itself scores the made-up model."""
    def setUp(self):
        super().setUp()
        self.server = Server()
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)

    def suite(self, name="words", scenarios=("words_relation_heart_left_of_bowl", "words_superlative_smallest_block")):
        file = next((SOURCE / "envs").glob(f"*/suites/{name}.json"))
        suite = {**json.loads(file.read_text()), "id": "small", "scenarios": list(scenarios), "presets": {}}
        for of_all in "groups", "near_miss":
            suite.pop(of_all, None)
        (self.dir / "small.json").write_text(json.dumps(suite))
        return str(self.dir / "small.json")

    def fetch(self):
        return self.suite("fetch", json.loads((SOURCE / "envs/mobile/suites/fetch.json").read_text())["scenarios"][:1])

    def select(self, *words, scenes=SCENES):
        done = subprocess.run([PROGRAM, "select", "--score", "--json", "--scenes", str(scenes), *words], capture_output=True, text=True,
                              cwd=self.dir, env={**os.environ, "OPENAI_BASE_URL": f"http://127.0.0.1:{self.server.server_port}/v1"})
        rows = {row["asked"]: row for row in map(json.loads, done.stdout.splitlines()) if row["group"] == "all"}
        self.assertEqual(done.returncode, 3 if any(row["unanswered"] for row in rows.values()) else 0, done.stderr)
        return rows

    def of_the_program(self, suite, scenes=SCENES):
        """Form -> what it prints where it asks the server itself."""
        return self.select("--suite", suite, "--answers", "openai", "--model", "m", "--cassette", "asked.jsonl", scenes=scenes)


class Evals(Suites):
    def test_a_score_is_the_programs_own_to_the_last_digit(self):
        for make in self.suite, self.fetch:
            suite = make()
            rows = self.of_the_program(suite)
            for form in evals.FORMS:
                row = rows[form]
                self.assertEqual(evals.score(replies(evals.questions(suite, form)), SCENES),
                                 {"scenes_exact": row["exact_scenes"] / row["scenes"], "exact_sets": row["exact_sets"] / row["commands"],
                                  "precision": row["right"] / row["kept"], "recall": row["right"] / row["meant"],
                                  "answered": row["commands"] / (row["commands"] + row["unanswered"])})
        self.assertEqual([(one["commands"], one["unanswered"]) for one in map(self.of_the_program(self.suite()).get, evals.FORMS)],
                         [(2, 0), (1, 1)], "a meaning that cannot be read is in no mean")

    def test_the_questions_are_those_that_it_asks_and_hold_no_truth(self):
        for make, counts in (self.suite, (2 * 112, 2)), (self.fetch, (2 * 138, 1 + 138)):
            suite = make()
            self.server.asked.clear()
            self.of_the_program(suite)
            (self.dir / "asked.jsonl").unlink()
            both = [evals.questions(suite, form) for form in evals.FORMS]
            self.assertEqual(tuple(map(len, both)), counts)
            told = {(one["system"], one["user"]) for one in both[0] + both[1]}
            self.assertEqual({asked for asked in self.server.asked if "unstated preference" not in asked[1]}, told)
            for one in both[0] + both[1]:
                self.assertEqual(sorted(one), ["about", "command", "form", "id", "suite", "system", "user"])
            self.assertEqual(len({one["id"] for one in both[0]}), counts[0])

    def test_what_cannot_be_an_answer_is_named_and_never_a_no(self):
        given = replies(evals.questions(self.suite()))
        command, about = given[5]["command"], given[5]["about"]
        for change, said in (("It depends.", "expected a last line"), (None, "no reply in")):
            some = [{**one, "reply": change} if one is given[5] else one for one in given]
            named = f'no answer: "{command}", asked about "{about}": .*{said}.*; .*1 questions have no answer'
            with self.assertRaisesRegex(ValueError, named):
                evals.score([one for one in some if one["reply"]], SCENES)
        with self.assertRaisesRegex(ValueError, "the model was shown others"):
            evals.score([{**one, "system": "Be brief. " + one["system"]} for one in given], SCENES)
        with self.assertRaisesRegex(ValueError, "one reply to each question"):
            evals.score(given + [{**given[0], "reply": "Final answer: maybe"}], SCENES)
        with self.assertWarnsRegex(UserWarning, "no score: .*have no answer"):
            self.assertNotEqual(*[evals.score_or_nan(given[1:])["recall"]] * 2)

    def test_a_task_of_lm_evaluation_harness_gives_that_score(self):
        suite = self.suite()
        names = evals.write_tasks(self.dir / "tasks", [suite])
        self.assertEqual(names, ["lgabench_small_flat", "lgabench_small_structured"])
        text = (self.dir / "tasks/lgabench_small_structured.yaml").read_text()
        for function in re.findall(r"!function lgabench\.evals\.(\w+)", text):
            self.assertTrue(callable(getattr(evals, function)))
        docs = list(map(json.loads, (self.dir / "tasks/lgabench_small_structured.jsonl").read_text().splitlines()))
        results = [evals.process_results(doc, [reply_to(doc["user"])]) for doc in docs]
        expected = evals.score(replies(docs))
        for metric in evals.METRICS:
            self.assertEqual(getattr(evals, metric)([one[metric] for one in results]), expected[metric])

    def test_its_log_becomes_a_cassette(self):
        suite = self.suite()
        lines = [{"doc_id": i, "doc": doc, "resps": [[doc["reply"]]], "arguments": {"gen_args_0": {
            "arg_0": [json.dumps([{"role": role, "content": doc[role]} for role in ("system", "user")])],
            "arg_1": {"until": [], "temperature": 0, "max_gen_toks": 99}}}} for i, doc in enumerate(replies(evals.questions(suite)))]
        log = self.dir / "samples_lgabench_small_flat_2026-11-27T12-00-00.jsonl"
        log.write_text("".join(json.dumps(line) + "\n" for line in lines))
        words = [sys.executable, "-m", "lgabench", "answers", "--from", log, "--cassette", self.dir / "c.jsonl"]
        refused = subprocess.run(words, capture_output=True, text=True, env=dict(os.environ))
        self.assertEqual(refused.returncode, 2)
        self.assertIn("expected --model MODEL", refused.stderr)
        (self.dir / "results_2026-11-27T12-00-00.json").write_text('{"model_name": "made-up"}')
        done = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('replies of made-up {"max_tokens":99}\n', done.stdout)
        self.assertEqual(self.select("--suite", suite, "--answers", "cassette:c.jsonl")["flat"], self.of_the_program(suite)["flat"])
        self.call("run", suite, "--methods", "lga", "--answers", "cassette:c.jsonl", "--demos", 1, "--seeds", 0, "--episodes", 1,
                  "--no-reference", "--engines", "kinematic", "--dry-run", "--out", "run")
        renamed = log.rename(self.dir / "samplesx.jsonl")
        named = [*words[:5], renamed, "--model", "made-up", "--cassette", self.dir / "d.jsonl"]
        self.assertEqual(subprocess.run(named, capture_output=True).returncode, 0)

        def said_of(*changed, text=None):
            """Of the first line with these changes, or of the text; of a log that a stranger sends."""
            first = dict(lines[0])
            first.update(*changed)
            renamed.write_text(json.dumps(first) + "\n" if text is None else text)
            done = subprocess.run(named, capture_output=True, text=True)
            self.assertIn(done.returncode, (2, 3), done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            return done.stderr

        for change in ({"resps": []}, {"resps": [[]]}, {"resps": None}, {"doc": []}, {"doc": None}, {"arguments": []},
                       {"arguments": {"gen_args_0": {"arg_0": 1, "arg_1": {"max_gen_toks": 1}}}}):
            self.assertRegex(said_of(change), "^lgabench: .*samplesx.jsonl: no log of lgabench's tasks: (Type|Index|Key|Attribute)Error: ")
        self.assertIn("RecursionError", said_of(text='{"doc_id": 1, "doc": ' + "[" * 100000 + "]" * 100000 + "}\n"))
        self.assertIn("line 1: /reply: expected a string", said_of({"resps": [[{"deep": 1}]]}))
        self.assertIn("expected", said_of(text="\xff\n"))
        self.assertIn("JSONDecodeError", said_of(text='{"doc_id"\n'))

    def test_seconds_of_a_reply_are_bounded(self):
        given = replies(evals.questions(self.suite()))
        for seconds in -1e300, -1, 1e300:
            with self.assertRaisesRegex(ValueError, "/seconds: expected seconds from 0 to 1e.09"):
                evals.score([{**given[0], "seconds": seconds}, *given[1:]], SCENES)


INSPECT = """
import sys
sys.path.insert(0, {here!r})
import evals_test
from inspect_ai import eval
from inspect_ai.model import ModelOutput, ModelUsage, get_model

def says(messages, tools, choice, config):
    assert config.temperature == 0 and [one.role for one in messages] == ["system", "user"]
    output = ModelOutput.from_content("mockllm", evals_test.reply_to(messages[1].text))
    output.usage = ModelUsage(total_tokens=9)  # else it counts with what it downloads
    return output

model = get_model("mockllm/model", custom_outputs=says)
log, = eval("lgabench/words", model=model, task_args={{"form": "structured"}}, limit=1, display="none", log_dir="one")
assert log.status == "success" and log.results.scores[0].metrics["recall"].value != 1, log.error  # there is none
for form in "flat", "structured":
    log, = eval("lgabench/own", model=model, task_args={{"suite": sys.argv[1], "form": form}}, log_dir=form, display="none")
    assert log.status == "success", log.error
    print(form, *(repr(log.results.scores[0].metrics[name].value) for name in evals_test.evals.METRICS))
"""


def installed(package):
    return FULL and importlib.util.find_spec(package)


class Batches(Suites):
    """`lgabench answers --batch`, and what an API's batch gives back."""

    def asked(self, suite, form, *more):
        self.call("answers", suite, "--form", form, "--questions", "batch.jsonl", "--batch", "--model", "m", *more)
        return [json.loads(line) for line in (self.dir / "batch.jsonl").read_text().splitlines()]

    def output(self, requests):
        return [{"id": f"batch_req_{i}", "custom_id": one["custom_id"], "error": None, "response": {
            "status_code": 200, "request_id": str(i), "body": {"id": "c", "object": "chat.completion", "model": "m-2026", "choices": [
                {"index": 0, "message": {"role": "assistant", "content": reply_to(one["body"]["messages"][1]["content"])},
                 "finish_reason": "stop"}], "usage": {"total_tokens": 9}}}} for i, one in enumerate(requests)]

    def keep(self, lines, *more, expect=0):
        (self.dir / "out.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
        done = subprocess.run([PROGRAM, "answers", "--from", "out.jsonl", "--model", "m", "--cassette", "kept.jsonl", *more],
                              capture_output=True, text=True, cwd=self.dir)
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def test_its_replies_score_as_those_of_the_server(self):
        for make, form in itertools.product((self.suite, self.fetch), evals.FORMS):
            suite = make()
            requests = self.asked(suite, form)
            self.assertEqual({(one["method"], one["url"]) for one in requests}, {("POST", "/v1/chat/completions")})
            self.assertEqual(len({one["custom_id"] for one in requests}), len(requests))
            for one, question in zip(requests, evals.questions(suite, form), strict=True):
                self.assertEqual(one["body"], {"model": "m", "temperature": 0, "messages": [
                    {"role": "system", "content": question["system"]}, {"role": "user", "content": question["user"]}]})
            self.assertIn("replies of m", self.keep(reversed(self.output(requests))).stdout)
            kept = self.select("--suite", suite, "--answers", "cassette:kept.jsonl")[form]
            asked = self.of_the_program(suite)[form]
            clock = {name for name in asked if name.endswith("_s") or name in ("source", "tokens", "queries")}
            self.assertEqual({name: value for name, value in kept.items() if name not in clock},
                             {name: value for name, value in asked.items() if name not in clock})
            (self.dir / "kept.jsonl").unlink()
            (self.dir / "asked.jsonl").unlink()

    def test_lines_that_failed_are_named_and_counted_and_asked_for_again(self):
        suite = self.suite()
        requests = self.asked(suite, "flat")
        lines = self.output(requests)
        lines[0] = {**lines[0], "response": None, "error": {"code": "batch_expired", "message": "not done in 24 h"}}
        lines[1]["response"].update(status_code=429, body={"error": {"message": "too many"}})
        lines[2]["response"]["body"]["choices"][0]["finish_reason"] = "length"
        lines[3]["response"]["body"] = {}
        whole = self.output(requests)
        said = self.keep(lines[:-1], expect=3).stderr
        for why in ("the server says: not done in 24 h", "status 429: too many", "finish_reason is length", "expected a member \"choices\"", "no reply in out.jsonl"):
            self.assertEqual(len(re.findall(f"no answer: .*{re.escape(why)}", said)), 1, said)
        self.assertIn("5 questions have no answer", said)
        self.keep([*lines[:-1], *whole[:4], whole[-1]])  # a second batch's output behind the first's

    def test_what_is_no_batch_is_refused_in_a_line(self):
        suite = self.suite()
        line = self.output(self.asked(suite, "flat"))[0]
        for custom_id in "1", f"{suite}/loud/{line['custom_id'][-16:]}", "/flat/x":
            self.assertIn("out.jsonl: line 1: /custom_id: expected SUITE/FORM/ID",
                          self.keep([{**line, "custom_id": custom_id}], expect=2).stderr)
        for words in (["--batch"], ["--model", "m"], ["--request", "{}"]):
            done = subprocess.run([PROGRAM, "answers", suite, "--questions", "q.jsonl", *words], capture_output=True, text=True, cwd=self.dir)
            self.assertEqual(done.returncode, 2)
            self.assertIn("--batch", done.stderr)
        with_effort = self.asked(suite, "flat", "--request", '{"temperature": null, "reasoning_effort": "low"}')
        self.assertEqual(set(with_effort[0]["body"]), {"model", "messages", "reasoning_effort"})


class Harnesses(Suites):
    """Inspect and lm-evaluation-harness themselves, offline: their score, and what `select --score` says of their logs."""
    def python(self, *words, program=sys.executable, **more):
        path = os.pathsep.join([str(pathlib.Path(__file__).parent), *sys.path])
        done = subprocess.run([program, *map(str, words)], cwd=self.dir, capture_output=True, text=True, timeout=1200, env={
            **os.environ, "HOME": str(self.dir), "PYTHONPATH": path, "HF_HUB_OFFLINE": "1", "HF_DATASETS_OFFLINE": "1", **more})
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return done.stdout

    def assert_kept(self, log, suite, form, own, *model):
        """The log's cassette scores as the program's own; `own`: its rows."""
        said = self.python("-m", "lgabench", "answers", "--from", log, "--cassette", f"{form}.jsonl", *model)
        self.assertEqual(self.select("--suite", suite, "--answers", f"cassette:{form}.jsonl", scenes=30)[form], own[form])
        return said

    def shares(self, row):
        return [row["exact_scenes"] / row["scenes"], row["exact_sets"] / row["commands"], row["right"] / row["kept"],
                row["right"] / row["meant"], row["commands"] / (row["commands"] + row["unanswered"])]

    @unittest.skipUnless(installed("inspect_ai"), "not installed: inspect_ai, or no LGABENCH_FULL")
    def test_inspect_finds_the_tasks_by_their_entry_point(self):
        sys.path.insert(0, str(SOURCE / "cmake"))
        import wheel
        site = self.dir / "site-packages"
        (site / "lgabench-0.dist-info").mkdir(parents=True)
        (site / "lgabench-0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: lgabench\nVersion: 0\n")
        (site / "lgabench-0.dist-info/entry_points.txt").write_text(wheel.ENTRY_POINTS)
        for name in "lgabench", "lgabench_method":
            (site / name).symlink_to(pathlib.Path(lgabench.__file__).parents[1] / name)
        sys.path.insert(0, str(site))
        self.addCleanup(sys.path.remove, str(site))
        suite = self.suite()
        own = self.of_the_program(suite, 30)
        said = self.python("-c", INSPECT.format(here=str(pathlib.Path(__file__).parent)), suite)
        for line, form in zip(said.splitlines(), evals.FORMS):
            self.assertEqual(line.split(), [form, *map(repr, self.shares(own[form]))])
            log, = (self.dir / form).glob("*.eval")
            self.assertIn("replies of mockllm/model\n", self.assert_kept(log, suite, form, own))

    @unittest.skipUnless(installed("lm_eval"), "not installed: lm_eval, or no LGABENCH_FULL")
    def test_lm_evaluation_harness_asks_a_server(self):
        suite = self.suite()
        own = self.of_the_program(suite, 30)
        self.server.asked.clear()
        self.python("-m", "lgabench.evals", "tasks", "--suites", suite)
        address = f"http://127.0.0.1:{self.server.server_port}/v1/chat/completions"
        names = [f"lgabench_small_{form}" for form in evals.FORMS]
        self.python("-m", "lm_eval", "run", "--model", "local-chat-completions", "--model_args", f"base_url={address},model=made-up",
                    "--include_path", "tasks", "--tasks", ",".join(names), "--apply_chat_template", "--log_samples",
                    "--output_path", "out", OPENAI_API_KEY="none")
        self.assertEqual(self.server.asked, {(one["system"], one["user"]) for form in evals.FORMS for one in evals.questions(suite, form)})
        results, = self.dir.glob("out/*/results_*.json")
        scored = json.loads(results.read_text())["results"]
        for name, form in zip(names, evals.FORMS):
            self.assertEqual([scored[name][f"{metric},none"] for metric in evals.METRICS], self.shares(own[form]))
            log, = results.parent.glob(f"samples_{name}_*.jsonl")
            self.assertIn("replies of made-up ", self.assert_kept(log, suite, form, own))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
