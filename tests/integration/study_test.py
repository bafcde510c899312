"""The user study without a browser: its directory, its server, kills, a disk that is full, and what runs make of it."""
import gzip
import json
import os
import re
import resource
import shutil
import signal
import socket
import stat
import struct
import threading
import time
import unittest
from pathlib import Path

from case import BUILD
from study_people import Person, SMALL, Server, StudyCase, events

FULL = os.environ.get("LGABENCH_FULL") == "1"
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
          "form-action 'none'; frame-ancestors 'none'")


class StudyProtocols(StudyCase):
    def test_from_nothing_to_pinned(self):
        said = self.call("study", "new", "study").stdout
        self.assertIn("study check study", said)
        self.assertIn("holds a study already", self.call("study", "new", "study", expect=2).stderr)
        serve = ["study", "serve", "study/protocol.json", "--out", "data", "--port", "0"]
        unfilled = self.call("study", "check", "study", expect=2)
        self.assertIn("to fill: consent: [[UNTIL WHEN]]", unfilled.stdout)
        self.assertIn("to fill: protocol: [[YOUR NAME]]", unfilled.stdout)
        self.assertIn("blanks to fill in", self.call(*serve, expect=2).stderr)
        self.assertRegex(self.call("study", "check", "study", "--pin", expect=2).stderr, r"\d+ blanks to fill in$")
        for name in "protocol.json", "consent.txt":
            file = self.dir / "study" / name
            file.write_text(re.sub(r"\[\[.*?\]\]", "invented", file.read_text()))
        self.assertIn("not pinned", self.call("study", "check", "study", expect=2).stderr)
        self.assertIn("not pinned", self.call(*serve, expect=2).stderr)
        self.call("study", "check", "study", "--pin")
        self.assertIn("18 commands a person", self.call("study", "check", "study").stdout)
        consent = self.dir / "study/consent.txt"
        consent.write_text(consent.read_text() + "\nAnd more.\n")
        for command in (["study", "check", "study"], ["study", "check", "study", "--pin"], serve):
            self.assertIn("the consent differs from what", self.call(*command, expect=2).stderr)
        consent.unlink()
        self.assertIn("consent.txt: cannot be read", self.call(*serve, expect=2).stderr)
        self.assertFalse((self.dir / "data").exists())

    def test_mistakes_are_named(self):
        self.new(pin=False)
        for words, says in [
            (["serve", "study"], "expected --out DIR"),
            (["serve", "study", "--out", "d", "--bind", "0.0.0.0"], "not pinned"),
            (["serve", "study", "--out", "d", "--rehearsal", "--bind", "0.0.0.0"], "plain HTTP, which others on the network"),
            (["serve", "study", "--out", "d", "--rehearsal", "--bind", "0.0.0.0", "--behind-tls-proxy"], "expected --host NAME"),
            (["report", "study"], "expected a study's directory"),
            (["serve", "elsewhere", "--out", "d"], "elsewhere"),
            (["new", "x", "--protocol", "papers"], 'did you mean "paper"'),
            (["begin", "x"], "expected one of"),
        ]:
            self.assertIn(says, self.call("study", *words, expect=2).stderr)
        self.assertFalse((self.dir / "d").exists())
        busy = socket.socket()
        self.addCleanup(busy.close)
        busy.bind(("127.0.0.1", 0))
        busy.listen()
        self.assertIn("cannot listen there", self.call("study", "serve", "study", "--out", "d", "--rehearsal", "--port",
                                                         busy.getsockname()[1], expect=2).stderr)


class StudyServer(StudyCase):
    def setUp(self):
        super().setUp()
        self.new(**SMALL)
        self.server = Server(self, "data")

    def test_every_page_is_guarded(self):
        person = Person(self.server)
        pages = ["/", "/withdraw", "/study.css", "/study.js", "/study.json", "/object_types.png", "/textures.png",
                 f"/p/{person.id}", "/favicon.ico", "/nothing", "/../protocol.json", "/p/..%2f..%2fstudy.events"]
        for path in pages:
            status, headers, _ = self.server.ask("GET", path)
            self.assertEqual(status, 204 if path == "/favicon.ico" else 404 if pages.index(path) > 8 else 200, path)
            self.assertEqual(headers["Content-Security-Policy"], POLICY, path)
            self.assertEqual(headers["Referrer-Policy"], "no-referrer", path)
            self.assertEqual(headers["Cache-Control"], "no-store", path)
            self.assertIsNone(headers["Set-Cookie"], path)
        for file in (BUILD / "share/lgabench/study").iterdir():
            text = file.read_text()
            self.assertNotRegex(text, r"https?://|localStorage|sessionStorage|document\.cookie|innerHTML|\son\w+=|style=|eval\(",
                                file.name)

    def test_who_may_ask(self):
        own = f"127.0.0.1:{self.server.port}"
        for host, status in ((own, 200), (f"localhost:{self.server.port}", 200), ("study.example", 421), ("", 421)):
            self.assertEqual(self.server.ask("GET", "/", headers={"Host": host})[0], status, host)
        body = {"key": "0" * 32, "consent": "another"}
        for headers, status in (({"Origin": "http://" + own}, 400), ({"Origin": "http://study.example"}, 403),
                                ({"Content-Type": "text/plain"}, 415)):
            self.assertEqual(self.server.ask("POST", "/begin", body, headers=headers)[0], status, headers)
        self.assertEqual(self.server.ask("DELETE", "/")[0], 405)
        self.assertEqual(self.server.people(), [])
        with self.assertRaises(OSError):  # another address of this machine
            socket.create_connection(("127.0.0.2", self.server.port), timeout=2)

    def test_a_browser_leaves_port_80_out(self):
        with socket.socket() as free:
            free.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                free.bind(("127.0.0.1", 80))
            except OSError as e:
                self.skipTest(f"port 80: {e}")
        self.server.kill()
        self.server.port = 80
        self.server.start()
        for host, status in (("localhost", 200), ("127.0.0.1:80", 200), ("study.example", 421)):
            self.assertEqual(self.server.ask("GET", "/", headers={"Host": host})[0], status, host)
        answer = self.server.ask("POST", "/begin", {"key": "0" * 32}, headers={"Host": "localhost", "Origin": "http://localhost"})
        self.assertEqual(answer[0], 400, "its own Origin: only consent is missing")

    def test_bodies_and_ids_are_checked(self):
        person = Person(self.server)
        at = f"/p/{person.id}/events"
        before = self.server.people()[0].read_bytes()
        for body, status in (("x" * (257 << 10), 413), ("{", 400), ("[]", 400), ('{"events": []}', 400), ('{"events": [7]}', 400),
                             ("[" * 100000, 400), (json.dumps({"events": [{}] * 51}), 400), ("\xff", 400)):
            self.assertEqual(self.server.ask("POST", at, raw=body.encode("latin1"))[0], status, body[:20])
        for path in ("/p/" + "0" * 32 + "/events", "/p/../people/events", f"/p/{person.id.upper()}x/events"):
            self.assertEqual(self.server.ask("POST", path, {"events": [{"key": "k", "page": "p", "kind": "opened", "page_ms": 1}]})[0],
                             404)
        self.assertEqual(self.server.people()[0].read_bytes(), before)

    def test_nothing_of_the_browser_is_kept(self):
        mark = "a-very-own-browser/7.0"
        self.server.ask("GET", "/", headers={"User-Agent": mark, "X-Forwarded-For": "203.0.113.9", "Referer": "http://me.example"})
        person = Person(self.server).take_part()
        for path in (self.dir / "data").rglob("*"):
            if path.is_file():
                text = path.read_text()
                for word in (mark, "203.0.113.9", "me.example", "127.0.0.1"):
                    self.assertNotIn(word, text, path)
                self.assertEqual(stat.S_IMODE(path.stat().st_mode) & 0o077, 0, path)
        log = (self.dir / "data/study.events").read_text() + "".join(self.participants())
        self.assertNotIn(person.id, log)
        self.assertEqual(self.participants(), ["p01.json"])

    def test_withdrawal(self):
        first, second = Person(self.server).take_part(), Person(self.server).take_part()
        self.assertEqual(self.server.ask("POST", "/withdraw", {"code": "0000-0000-0000-0000"})[0], 404)
        code = first.state["withdrawal_code"]
        self.assertEqual(self.server.ask("POST", "/withdraw", {"code": code.lower().replace("-", " ")})[0], 200)
        self.assertEqual([path.stem for path in self.server.people()], [second.id])
        self.assertEqual(self.participants(), ["p02.json"])
        self.assertEqual([e["slot"] for e in events(self.dir / "data/study.events") if e["kind"] == "withdrawn"], [0])
        for event in [event for file in (self.dir / "data").rglob("*.events") for event in events(file)]:
            self.assert_as_schema("study_events", event)
        self.assertEqual(self.server.ask("POST", f"/p/{first.id}/events", {"events": [{"key": "k"}]})[0], 404)
        self.server.end(signal.SIGTERM)
        self.assertEqual(self.server.process.returncode, 0)
        self.assertIn("1 withdrew", self.call("study", "report", "data").stdout)

    def test_slow_clients_keep_nobody_out(self):
        """A byte every two seconds begins each timeout of reading anew; a whole request has ten seconds."""
        slow = []
        for _ in range(64):
            slow.append(socket.create_connection(("127.0.0.1", self.server.port)))
            self.addCleanup(slow[-1].close)
        started, ended = time.monotonic(), None
        while time.monotonic() - started < 30 and ended is None:
            for one in slow:
                try:
                    one.send(b"G")
                except OSError:
                    ended = time.monotonic() - started
            if 3 < time.monotonic() - started < 6:
                begun = time.monotonic()
                self.assertEqual(self.server.ask("GET", "/")[0], 200)
                self.assertLess(time.monotonic() - begun, 10)
            time.sleep(2)
        self.assertIsNotNone(ended, "a connection lasts for ever")
        self.assertEqual(self.server.ask("GET", "/")[0], 200)

    def test_who_may_begin(self):
        server = Server(self, "invited", "--invitation", "abc", "--begins", "3")
        about = server.ask("GET", "/study.json")[2]
        begin = lambda key, **more: server.ask("POST", "/begin", {"key": key * 32, "consent": about["consent_sha256"], **more})
        for more in {}, {"invitation": "abd"}, {"invitation": 7}:
            status, _, answer = begin("0", **more)
            self.assertEqual((status, answer["error"]), (400, "this study is by invitation: open the link that you were sent"))
        people = [begin(key, invitation="abc") for key in "123"]
        self.assertEqual([status for status, *_ in people], [200, 200, 200])
        self.assertEqual(begin("4", invitation="abc")[0], 429)
        status, _, answer = begin("1", invitation="abc")  # the answer was lost
        self.assertEqual((status, answer), (200, people[0][2]))
        self.assertEqual(len(server.people()), 3)
        self.assertIn("expected letters and digits", self.call("study", "serve", "study", "--out", "x", "--invitation", "a&b", expect=2).stderr)

    def test_the_terminal_says_who_comes_and_goes(self):
        first = Person(self.server)
        Person(self.server).take_part()
        self.server.ask("POST", "/withdraw", {"code": first.state["withdrawal_code"]})
        self.server.process.send_signal(signal.SIGTERM)
        said = re.sub(r"^\d\d:\d\d ", "", self.server.process.stdout.read(), flags=re.M).splitlines()
        self.assertEqual(said, ["p01 began, with human first; 1 under way, 0 of 18 finished",
                                "p02 began, with lga_hill first; 2 under way, 0 of 18 finished",
                                "p02 finished; 1 under way, 1 of 18 finished",
                                "p01 withdrew; 0 under way, 1 of 18 finished"])

    def test_two_at_once(self):
        people = [threading.Thread(target=lambda: Person(self.server).take_part()) for _ in range(4)]
        for one in people:
            one.start()
        for one in people:
            one.join()
        self.assertEqual(self.participants(), [f"p0{i}.json" for i in range(1, 5)])
        slots = [e["slot"] for e in events(self.dir / "data/study.events") if e["kind"] == "assigned"]
        self.assertEqual(slots, [0, 1, 2, 3])


class StudyMemory(StudyCase):
    """Nobody who lacks an invitation takes memory from those who have one."""

    def setUp(self):
        super().setUp()
        self.new(**SMALL)
        self.server = Server(self, "data")

    def peak_mib(self):
        return int(re.search(r"VmHWM:\s+(\d+)", Path(f"/proc/{self.server.process.pid}/status").read_text())[1]) >> 10

    def statuses(self, count, request, *headers, body=()):
        """What `count` clients at once are answered, while somebody else asks: a set of statuses, 0 where a connection was ended."""
        head = [f"{request} HTTP/1.1", f"Host: 127.0.0.1:{self.server.port}", *headers]
        said = set()

        def one():
            with socket.create_connection(("127.0.0.1", self.server.port), timeout=5 if body else 30) as connection:
                answer = b""
                try:
                    connection.sendall("\r\n".join(head).encode() + (b"\r\n" if callable(body) else b"\r\n\r\n"))
                    for part in body() if callable(body) else body:
                        connection.sendall(part)
                except OSError:
                    pass  # refused before it was sent
                try:
                    while part := connection.recv(1 << 16):
                        answer = answer[:12] or part
                except OSError:
                    pass
                said.add(int(answer[9:12] or 0))

        clients = [threading.Thread(target=one) for _ in range(count)]
        for client in clients:
            client.start()
        self.assertEqual(self.server.ask("GET", "/")[0], 200)
        for client in clients:
            client.join()
        return said

    def test_ranges(self):
        many = "bytes=" + ",".join(["0-"] * 2600)
        for path, ranges, status in (("/object_types.png", "bytes=0-", 200), ("/object_types.png", many, 200), ("/nothing", many, 404),
                                     ("/object_types.png", many + ",5-1", 416), ("/object_types.png", "bytes=" + "0" * 7900, 416)):
            with self.subTest(path=path, ranges=ranges[-9:]):
                before = self.peak_mib()
                self.assertEqual(self.statuses(24, f"GET {path}", f"Range: {ranges}"), {status})
                self.assertLess(self.peak_mib() - before, 50)

    def test_bodies_that_hide_their_length(self):
        zeros = gzip.compress(bytes(100 << 20))
        chunk = b"100000\r\n" + bytes(1 << 20) + b"\r\n"
        for headers, body, status in ((["Transfer-Encoding: chunked"], [chunk] * 100 + [b"0\r\n\r\n"], 411),
                                      ([], [bytes(1 << 20)] * 100, 411),
                                      ([f"Content-Length: {100 << 20}"], [bytes(1 << 20)] * 100, 413),
                                      (["Content-Encoding: gzip", f"Content-Length: {len(zeros)}"], [zeros], 415)):
            with self.subTest(headers):
                before = self.peak_mib()
                said = self.statuses(4, "POST /begin", "Content-Type: application/json", *headers, body=body)
                self.assertLessEqual(said, {status, 0})
                self.assertLess(self.peak_mib() - before, 50)

    def test_heads_without_end(self):
        many = b"".join(b"a%d: b\r\n" % i for i in range(100000))
        for name, parts in (("a line", [b"a: "] + [b"x" * (1 << 20)] * 100), ("lines", [many] * 50)):
            with self.subTest(name):
                before = self.peak_mib()
                self.assertEqual(self.statuses(4, "GET /", body=lambda: parts), {0})
                self.assertLess(self.peak_mib() - before, 100)

    def test_a_stack_of_any_size(self):
        """httplib reads a Range by a regular expression that goes as deep as the header is long."""
        self.server.kill()
        limits = resource.getrlimit(resource.RLIMIT_STACK)
        resource.setrlimit(resource.RLIMIT_STACK, (1 << 20, limits[1]))
        try:
            self.server.start()
        finally:
            resource.setrlimit(resource.RLIMIT_STACK, limits)
        self.assertEqual(self.statuses(1, "GET /", "Range: bytes=" + ",".join(["0-"] * 2600)), {200})


class StudyKilled(StudyCase):
    """kill -9 while an event is under way: a whole session loses nothing and counts nothing twice."""

    def setUp(self):
        super().setUp()
        self.new(**SMALL)
        self.server = Server(self, "data")
        self.sent, self.said = 0, []

    def stubborn(self, path, body):
        """As deliver() of study.js; the server is killed under some of the requests."""
        self.sent += 1
        self.said.append(body)
        if FULL or self.sent % 5 == 0:
            late = 0.0003 * (self.sent % 12)
            killer = threading.Timer(late, self.server.process.kill)
            killer.start()
            try:
                self.server.ask("POST", path, body)
            except OSError:
                pass
            except Exception as e:  # half an answer
                self.assertIn(type(e).__module__, ("http.client", "json.decoder"))
            killer.join()
            self.server.kill_and_start()
        status, _, answer = self.server.ask("POST", path, body)
        self.assertEqual(status, 200, answer)
        return answer

    def test_at_every_event(self):
        person = Person(self.server, self.stubborn).take_part()
        file, = self.server.people()
        told = [body["events"][0] for body in self.said[1:]]
        kept = [{k: v for k, v in event.items() if k != "at"} for event in events(file)[1:]]
        self.assertEqual(kept, told)
        self.assertEqual(person.state["step"], "debriefing")
        answers = json.loads((self.dir / "data/participants/p01.json").read_text())["answers"]
        self.assertEqual([sorted(a) for a in answers], [["asked_as", "command", "edited", "scenario", "specified"]] * 2)
        self.assertEqual(len([e for e in events(self.dir / "data/study.events") if e["kind"] == "assigned"]), 1)


class StudyFullDisk(StudyCase):
    def test_what_cannot_be_written_is_not_acknowledged(self):
        self.new(**SMALL)
        count = self.dir / "count"
        count.write_bytes(struct.pack("i", 0))
        more = {"LD_PRELOAD": str(BUILD / "tests/full_disk.so"), "FULL_DISK_UNDER": str(self.dir / "data"),
                "FULL_DISK_COUNT": str(count), "FULL_DISK_AT": "-1"}
        server = Server(self, "data", environment={**self.environment, **more})
        refused = []

        def until_it_is_kept(path, body):
            """Every third event meets a disk that is full once, at its write or at its fsync."""
            if len(refused) % 3 == 0:
                with count.open("r+b") as file:  # the next call but 0 or 1 is number -1
                    file.write(struct.pack("i", -2 - len(refused) % 2))
            for _ in range(4):
                status, _, answer = server.ask("POST", path, body)
                refused.append(status)
                if status == 200:
                    return answer
                self.assertEqual((status, answer), (507, {"error": "it cannot be saved now"}))
            self.fail("never kept")

        person = Person(server, until_it_is_kept).take_part()
        self.assertGreater(refused.count(507), 5)
        self.assertEqual(person.state["step"], "debriefing")
        keys = [event["key"] for event in events(server.people()[0])]
        self.assertEqual(len(keys), len(set(keys)))
        self.assertEqual(self.participants(), ["p01.json"])
        server.kill_and_start()  # reads all of it again


class StudyRehearsal(StudyCase):
    def test_simulated_people_end_in_verdicts_that_say_so(self):
        self.new(pin=False)
        self.rehearse(6)
        self.assertEqual(len(self.participants()), 6)
        said = self.call("study", "report", "data").stdout
        self.assertIn("rehearsal, not people", said)
        self.assertRegex(said, r"Primary: Human − LGA-HILL \+\d+\.\d s \[.*6 people")
        for name in "report.html", "report.md", "results.json", "trials.csv", "figures/seconds.svg", "figures/seconds.pdf", "tables/commands.tex":
            self.assertTrue((self.dir / "data" / name).exists(), name)
        self.assertIn(r"simulated \<b>words\</b> \| of \*nobody\*", (self.dir / "data/report.md").read_text())
        self.assertIn("holds a study of rehearsal", self.refused_as_people())

        run = ["run", "q1", "--humans", "data/participants", "--scenarios", "heart,red_heart,rotate_block", "--methods",
               "lga,lga_hill,human", "--demos", "50", "--seeds", "0", "--episodes", "3", "--set", "*.epochs=1", "--out", "out"]
        self.assertIn("p01.json: /rehearsal: answers of a rehearsal; --rehearsal", self.call(*run, expect=2).stderr)
        table = self.call(*run, "--rehearsal", "--tables").stdout
        self.assertIn("rehearsal, not people: not for the leaderboard.", table)
        self.assertIn("Human: 6 participants (rehearsal, not people).", table)
        self.assert_matches_schemas("out")
        claims = {c["claim"]: c for c in json.loads((self.dir / "out/claims.json").read_text())["claims"]}
        for claim in "C2", "C5":
            self.assertNotEqual(claims[claim]["verdict"], "not tested", claims[claim])
            self.assertTrue(claims[claim]["rehearsal"])
        self.assertEqual(len(claims["C2"]["differences"][0]["by_scenario"]), 2, "nobody was asked about the third")
        self.assertNotIn("rehearsal", claims["C1"])
        self.assertRegex(self.call("report", "out", "--claims").stdout, r"C5 .*\n.*(held|undecided) \(rehearsal, not people\)")
        self.assertIn("--humans DIR", self.call(*run[:2], "--rehearsal", expect=2).stderr)

    def refused_as_people(self):
        for name in "protocol.json", "consent.txt":
            file = self.dir / "study" / name
            self.assertTrue(file.exists())
        self.call("study", "check", "study", "--pin")
        return self.call("study", "serve", "study", "--out", "data", "--port", "0", expect=2).stderr

    def test_people_may_say_several_kinds_and_which_of_several_is_meant(self):
        near, either, first = "words_relation_cutlery_nearest_to_plate", "words_union_spoon_or_wooden_fork", "words_superlative_rainbow_order_mug"
        words = dict(SMALL, sets=[[{"scenario": name} for name in (near, either, first)]])
        self.new(pin=False, meanings=True, **words)
        self.rehearse(2)
        self.assertEqual(len(self.participants()), 2)
        for name in self.participants():
            answers = {a["scenario"]: a for a in json.loads((self.dir / "data/participants" / name).read_text())["answers"]}
            for way in "specified", "edited":
                said = {scenario: answer[way]["selection"]["target"] for scenario, answer in answers.items()}
                self.assertEqual(said[near]["which"]["rule"], "nearest_to")
                self.assertGreater(len(said[either]["sets"]), 1)
                self.assertGreater(len(said[first]["which"]["order"]), 2)
            self.assertEqual(answers[near]["edited"]["proposal"]["target"]["which"]["rule"], "nearest_to")
        self.call("study", "report", "data")
        self.assertEqual(json.loads((self.dir / "data/results.json").read_text())["trials"]["clicks_disagree"], 0)
        self.call("run", "words", "--scenarios", near, "--methods", "human", "--humans", "data/participants", "--rehearsal", "--demos", "5",
                  "--seeds", "0", "--episodes", "2", "--no-reference", "--out", "out")
        selected = [file.read_text() for file in (self.dir / "out").glob("cells/*/selection.json")]
        self.assertEqual(['"nearest_to"' in text for text in selected], [True, True])  # a cell for each participant
        self.assert_matches_schemas("out")

        shutil.rmtree(self.dir / "study")
        self.new(pin=False, **words)  # without: the paper's lists
        person = Person(Server(self, "paper", "--rehearsal"))
        person.say("familiarised")
        person.say("example_seen")
        person.say("start")
        person.say("shown")
        status, _, answer = person.server.ask("POST", f"/p/{person.id}/events", {"events": [dict(
            key="k", page=person.page, page_ms=200, kind="meant", target={"sets": [{"object_types": [], "textures": []}]})]})
        self.assertEqual(status, 400, answer)

    def test_a_crossover_of_eighteen(self):
        self.new("crossover", pin=False)
        self.rehearse(18)
        said = self.call("study", "report", "data").stdout
        self.assertIn("condition: Human / LGA-HILL", said)
        results = json.loads((self.dir / "data/results.json").read_text())
        self.assertEqual((results["people"], results["used"], results["rehearsal"]), (18, 18, True))
        self.assertGreater(results["crossover"]["condition"]["difference"], 0)
        self.assertEqual(results["trials"]["clicks_disagree"], 0)
        self.assertEqual(results["tlx"]["raw"]["people"], 18)

    def test_disputed_pairs(self):
        self.new("disputed", pin=False)
        file = self.dir / "study/protocol.json"
        protocol = json.loads(file.read_text())
        protocol["exclusions"]["most_controls_failed"] = 6
        file.write_text(json.dumps(protocol))
        self.call("study", "check", "study", "--pin")
        pairs = [pair for item in protocol["sets"][0] for pair in item["pairs"]]
        disputed = [pair for pair in pairs if "settled" not in pair]
        said = self.call("study", "check", "study").stdout
        self.assertIn(f"{len(disputed)} disputed pairs and {len(pairs) - len(disputed)} controls", said)
        self.assertRegex(said, r"power: .* needs \d+ people")
        self.rehearse(20)
        report = self.call("study", "report", "data").stdout
        self.assertIn("rehearsal, not people", report)
        self.assertRegex(report, r"20 people settle \d+ of %d disputed pairs .*alpha" % len(disputed))
        found = json.loads((self.dir / "data/results.json").read_text())["agreement"]["pairs"]
        self.assertEqual(len(found), len(pairs))
        self.assertEqual({pair["yes"] + pair["no"] + pair["cannot_tell"] for pair in found}, {20})
        self.assertIn(disputed[0]["object_type"], (self.dir / "data/report.html").read_text())

        server = Server(self, "people")
        sheet = server.ask("GET", "/study.json")[2]["pictures"]["pairs"]
        self.assertEqual(set(sheet["names"]), {f"{p['object_type']}, {p['texture']}" for p in pairs} | {"heart, red", "star, red"})
        self.assertTrue(server.ask("GET", "/pairs.png")[2].startswith(b"\x89PNG"))
        person = Person(server).take_part()
        self.assertEqual(person.state["step"], "debriefing")
        self.assertEqual(self.participants("people"), [])
        server.kill()
        self.assertIn(f"p01 is left out: {len(pairs) - len(disputed)} controls failed, 6 allowed", self.call("study", "report", "people", expect=3).stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
