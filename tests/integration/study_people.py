"""A study for tests: its directory, its server, people who answer over HTTP as the page's script does."""
import http.client
import json
import pathlib
import re
import secrets
import signal
import subprocess
import threading

from case import BUILD, Case, command_line

SCALES = ("mental", "physical", "temporal", "performance", "effort", "frustration")
# Two commands, one of them with a second set.
SMALL = {"sets": [[{"scenario": "red_heart"}, {"scenario": "sweep_block_without_touching_pan"}]], "seed": 1,
         "exclusions": {"fewest_trials": 1}}


def events(file):
    """Of an event file."""
    return [json.loads(line.split(" ", 2)[2]) for line in file.read_text().splitlines()]


class Server:
    """`lgabench study serve` on a port that stays the same when it is killed and started again."""

    def __init__(self, case, data, *more, environment=None):
        self.case, self.data, self.port = case, data, 0
        self.more, self.environment = more, environment or case.environment
        self.start()
        case.addCleanup(self.kill)

    def start(self):
        self.process = subprocess.Popen(
            command_line("study", "serve", "study/protocol.json", "--out", self.data, "--port", self.port, *self.more),
            stdout=subprocess.PIPE, text=True, env=self.environment, cwd=self.case.dir)
        line = self.process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
        self.case.assertTrue(found, line)
        self.port = int(found[1])
        self.address = f"http://127.0.0.1:{self.port}/"

    def end(self, how):
        self.process.send_signal(how)  # nothing where it has ended
        self.process.wait(timeout=30)
        self.process.stdout.close()

    def kill(self):
        self.end(signal.SIGKILL)

    def kill_and_start(self):
        self.kill()
        self.start()

    def ask(self, method, path, body=None, headers=None, raw=None):
        """(status, headers, body as JSON where it is JSON); raises where the connection breaks."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            headers = dict({"Content-Type": "application/json"} if method == "POST" else {}, **(headers or {}))
            connection.request(method, path, raw if raw is not None else None if body is None else json.dumps(body), headers)
            answer = connection.getresponse()
            text = answer.read()
            is_json = answer.headers.get("Content-Type") == "application/json"
            return answer.status, answer.headers, json.loads(text) if is_json else text
        finally:
            connection.close()

    def people(self):
        return sorted((self.case.dir / self.data / "people").glob("*.events"))


class Person:
    """Takes part as the page does: each event until it is acknowledged, with one key."""

    def __init__(self, server, post=None):
        self.server, self.page, self.ms = server, secrets.token_hex(16), 100.0
        self.post = post or self.deliver
        about = server.ask("GET", "/study.json")[2]
        begun = self.post("/begin", {"key": secrets.token_hex(16), "consent": about["consent_sha256"]})
        self.id = begun["id"]
        self.state = self.say("opened")

    def deliver(self, path, body):
        status, _, answer = self.server.ask("POST", path, body)
        self.server.case.assertEqual(status, 200, answer)
        return answer

    def say(self, kind, **more):
        event = dict(more, key=secrets.token_hex(16), page=self.page, kind=kind, page_ms=self.ms)
        return self.post(f"/p/{self.id}/events", {"events": [event]})

    def answer(self):
        """One command."""
        trial = self.say("start")["trial"]
        self.say("shown")
        if "pairs" in trial:
            self.ms += 1000
            self.state = self.say("submit", answers=["can't tell"] * len(trial["pairs"]), longest_wait_ms=1)
            return
        selection = {}
        for one in trial["sets"]:
            self.ms += 400
            chosen = {feature: sorted({*one["first"][feature], trial[feature][0]}) for feature in ("object_types", "textures")}
            for feature, words in chosen.items():
                added = [word for word in words if word not in one["first"][feature]]
                if added:
                    self.say("edit", role=one["role"], feature=feature, values=added, on=True)
            selection[one["role"]] = chosen
        self.ms += 1000
        self.state = self.say("submit", selection=selection, longest_wait_ms=1)

    def take_part(self):
        self.state = self.say("familiarised")
        if self.state["step"] == "example":
            self.state = self.say("example_seen")
        while self.state["step"] != "debriefing":
            if self.state["step"] == "trial":
                self.answer()
            else:
                self.state = self.say("questionnaire", tlx=dict.fromkeys(SCALES, 50), free_text="")
        return self


class StudyCase(Case):
    def new(self, protocol="paper", pin=True, **changes):
        """A study in ./study with its blanks filled."""
        self.call("study", "new", "study", "--protocol", protocol)
        for name in "protocol.json", "consent.txt":
            file = self.dir / "study" / name
            file.write_text(re.sub(r"\[\[.*?\]\]", "invented for a test", file.read_text()))
        file = self.dir / "study/protocol.json"
        file.write_text(json.dumps(dict(json.loads(file.read_text()), **changes)))
        if pin:
            self.call("study", "check", "study", "--pin")

    def rehearse(self, people):
        """So many simulated people take part in ./study, whose answers lie in ./data."""
        done = subprocess.run([BUILD / "bin/rehearse", "study/protocol.json", "data", str(people)], cwd=self.dir, env=self.environment,
                              stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def participants(self, data="data"):
        return sorted(path.name for path in (self.dir / data / "participants").glob("*.json"))
