"""A model that is shown pictures: `select --score --names looked`, against a server of the test's own and, in ./test --full, a real one.

By hand: python3 looked_test.py Looking
"""
import base64
import hashlib
import http.server
import json
import os
import re
import struct
import subprocess
import threading
import unittest

from case import Case, command_line

SECRET = "sk-secret-1234567890"


class Server(http.server.ThreadingHTTPServer):
    """Says `reply` to every picture, or what a function of the request makes."""
    daemon_threads = True

    def __init__(self, reply):
        super().__init__(("127.0.0.1", 0), Handler)
        self.reply, self.pictures, self.bodies, self.refuses = reply, [], [], ""
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        words, picture = request["messages"][1]["content"]
        assert words["type"] == "text" and "The command is: " in words["text"], words
        prefix, data = picture["image_url"]["url"].split(",")
        assert (picture["type"], prefix) == ("image_url", "data:image/png;base64"), prefix
        self.server.bodies.append(request)
        self.server.pictures.append(base64.b64decode(data))
        if self.server.refuses:
            body, status = {"error": {"message": self.server.refuses}}, 400
        else:
            text = self.server.reply(request) if callable(self.server.reply) else self.server.reply
            body, status = {"choices": [{"message": {"content": text}, "finish_reason": "stop"}], "usage": {"total_tokens": 11}}, 200
        reply = json.dumps(body).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(reply)))
        self.end_headers()
        self.wfile.write(reply)

    def log_message(self, *_):
        pass


class Pictures(Case):
    ARGUMENTS = ["select", "--suite", "pictures", "--score", "--names", "looked", "--arms", "others_1", "--scenes", "1", "--json"]

    def score(self, answers, *more, expect=0):
        return self.call(*self.ARGUMENTS, "--answers", *answers, *more, expect=expect)


class Looking(Pictures):
    SCENES = 14  # one of each command

    def ask(self, reply, tape="tape.jsonl", *more, expect=0):
        self.server = Server(reply)
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)
        self.environment.update(OPENAI_BASE_URL=f"http://127.0.0.1:{self.server.server_port}/v1", OPENAI_API_KEY=SECRET)
        return self.score(["openai", "--model", "eyes", "--cassette", tape], *more, expect=expect)

    def test_each_scene_is_right_under_one_mark(self):
        """A target, at most two others and the pallet: of the answers 1 to 3 or 4 one is right in every scene."""
        exact = 0
        for mark in range(1, 5):
            done = self.ask(lambda request: "Final answer: none" if len(request["messages"]) > 2 else f"I see it.\nFinal answer: {mark}",
                            f"{mark}.jsonl")  # none where there is no such mark
            row = json.loads(done.stdout)
            exact += row["exact_scenes"]
            self.assertEqual((row["scenes"], row["unanswered"], row["arm"], row["names"]), (self.SCENES, 0, "others_1", "looked"))
            self.assertEqual(row["segments_right"], row["objects"])
            self.assertEqual(row["lm_queries"] > self.SCENES, mark == 4, "asked again where there is no such mark")
            self.assertEqual(row["lm_tokens"], 11 * row["lm_queries"])
            self.assertEqual(len(self.server.pictures), row["lm_queries"])
        self.assertEqual(exact, self.SCENES)

    def test_the_cassette_has_hashes_and_replays_without_a_server(self):
        first = self.ask("Final answer: 1").stdout
        pictures = {hashlib.sha256(png).hexdigest() for png in self.server.pictures}
        text = (self.dir / "tape.jsonl").read_text()
        self.assertEqual(set(re.findall(r"sha256:([0-9a-f]{64})", text)), pictures)
        self.assertEqual(len(pictures), self.SCENES)
        for words in "base64", SECRET:
            self.assertNotIn(words, text)
        for png in self.server.pictures:
            self.assertEqual((png[:8], struct.unpack(">II", png[16:24])), (b"\x89PNG\r\n\x1a\n", (1536, 768)))
        self.environment["OPENAI_BASE_URL"] = "http://127.0.0.1:1"
        self.assertEqual(self.score(["cassette:tape.jsonl"]).stdout, first)
        other = self.score(["cassette:tape.jsonl"], "--segments", "difference", expect=2).stderr
        self.assertIn("to ask: lgabench select --suite SUITE --score --names looked --answers openai --model eyes --cassette", other)

    def test_replies_that_cannot_be_read_are_told_and_then_named(self):
        for reply, why in (("I see a heart.", 'expected a last line "Final answer:" and numbers, or none'),
                           ("Final answer: 1\nFinal answer: 2", "one final answer, got a reply with two"),
                           ("Final answer: 9", "there is no mark 9, there are 1 to ")):
            with self.subTest(reply):
                done = self.ask(reply, hashlib.sha256(reply.encode()).hexdigest(), expect=3)
                self.assertEqual(done.stdout, "")
                self.assertEqual(len(self.server.pictures), 20, "and no more is asked")
                self.assertIn("eyes, asked about a picture: none of its first 20 replies has an answer, lgabench stopped asking", done.stderr)
                self.assertIn(why, done.stderr)
                last = self.server.bodies[5]["messages"]
                self.assertEqual([message["role"] for message in last], ["system", "user", "assistant", "user", "assistant", "user"])
                self.assertIn(why, last[-1]["content"])

    def test_a_scene_without_an_answer_is_named_and_in_no_mean(self):
        said = {}  # by picture: those of every second scene cannot be read

        def reply(request):
            picture = request["messages"][1]["content"][1]["image_url"]["url"]
            return "Final answer: 1" if said.setdefault(picture, len(said) % 2 == 0) else "I see a heart."

        done = self.ask(reply, expect=3)
        row = json.loads(done.stdout)
        self.assertEqual((row["scenes"], row["unanswered"], row["lm_queries"]), (7, 7, 7 + 3 * 7))
        self.assertLessEqual(row["exact_scenes"], row["scenes"])
        lines = re.findall(r'^no answer: \w+, others_1, scene 0: "[^"]+", asked about a picture: .* \(asked 3 times\)$', done.stderr, re.M)
        self.assertEqual(len(lines), 7, done.stderr)
        self.assertIn("7 scenes have no answer and are in no mean", done.stderr)
        again = self.score(["cassette:tape.jsonl"], expect=3)
        self.assertEqual((again.stdout, again.stderr), (done.stdout, done.stderr))
        self.assertIn("; 7 of 14 scenes have no answer\n",
                      self.call(*self.ARGUMENTS[:-1], "--answers", "cassette:tape.jsonl", expect=3).stdout)

    def test_a_second_try_counts_and_costs(self):
        done = self.ask(lambda request: "Final answer: none" if len(request["messages"]) > 2 else "it is mark 1")
        row = json.loads(done.stdout)
        self.assertEqual((row["unanswered"], row["lm_queries"]), (0, 2 * self.SCENES))

    def test_a_model_that_takes_no_pictures_is_told_in_a_line(self):
        server = Server("")
        server.refuses = "image input is not supported"
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.environment.update(OPENAI_BASE_URL=f"http://127.0.0.1:{server.server_port}/v1", OPENAI_API_KEY=SECRET)
        done = self.score(["openai", "--model", "blind", "--cassette", "tape.jsonl"], expect=3)
        self.assertIn("blind, asked about a picture: status 400: image input is not supported", done.stderr)
        self.assertEqual(len(server.pictures), 1)

    def test_what_is_missing_is_said(self):
        self.assertIn("--names looked: expected --answers openai or cassette:FILE with it",
                      self.call(*self.ARGUMENTS, expect=2).stderr)
        self.assertIn('no arm "othres_1" (did you mean "others_1"?)',
                      self.call("select", "--suite", "pictures", "--score", "--names", "read", "--arms", "othres_1", expect=2).stderr)
        self.assertIn("--arms: expected --names or --segments with it",
                      self.call("select", "--suite", "pictures", "--score", "--arms", "near_4", expect=2).stderr)


@unittest.skipUnless(os.environ.get("LGABENCH_FULL"), "./test --full plays it")
@unittest.skipUnless(os.environ.get("LGABENCH_TEST_SERVER"), "LGABENCH_TEST_SERVER=URL names no server of chat completions")
class RealEyes(Pictures):
    """A server that nobody here wrote, as of answers_test.RealServer: one scene of each command."""

    def test_a_picture_is_answered_or_refused_in_a_line(self):
        key = os.environ.get("OPENAI_API_KEY", "")
        self.environment.update(OPENAI_BASE_URL=os.environ["LGABENCH_TEST_SERVER"], OPENAI_API_KEY=key or SECRET)
        words = ["--answers", "openai", "--model", os.environ.get("LGABENCH_TEST_MODEL", "any"), "--cassette", "tape.jsonl",
                 "--request", os.environ.get("LGABENCH_TEST_REQUEST", '{"max_tokens": 200}')]
        done = subprocess.run(command_line(*self.ARGUMENTS, *words), cwd=self.dir, env=self.environment, capture_output=True, text=True,
                              timeout=3000)
        self.assertIn(done.returncode, (0, 3), done.stderr)
        self.assertNotIn(self.environment["OPENAI_API_KEY"], done.stdout + done.stderr)
        if re.search("asked about a picture: status 4", done.stderr):
            self.skipTest("the model takes no pictures: " + done.stderr.splitlines()[-1])
        row = json.loads(done.stdout)
        self.assertEqual((row["scenes"] + row["unanswered"], done.stderr.count("no answer: ")), (Looking.SCENES, row["unanswered"]))
        if done.returncode == 0:
            self.assertEqual(self.score(["cassette:tape.jsonl"]).stdout, done.stdout)


if __name__ == "__main__":
    unittest.main()
