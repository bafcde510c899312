"""lgabench bench: what it measures is the method's, and JSON is as Google Benchmark writes it.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 bench_test.py Bench
"""
import json
import statistics
import unittest

from case import Case, FIXTURES

PYTHON = "/usr/bin/python3"  # which has NumPy

# A method whose phases take, at least, what their name says; it holds 300 MB while it learns.
SLOW = """
import time

from lgabench_method import Needs, Selection


class Slow:
    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        time.sleep(.1)
        return Selection()

    def learn(self, demonstrations, services):
        held = bytearray(b"1" * 300_000_000)
        until = time.process_time() + .2
        while time.process_time() < until:
            pass
        action = demonstrations[0].steps[0].label
        return type("Still", (), {"act": lambda self, observation, instruction: time.sleep(.02) or action})()


class Hangs(Slow):
    def learn(self, demonstrations, services):
        time.sleep(3600)


class Large(Slow):
    def learn(self, demonstrations, services):
        self.held = bytearray(b"1" * 2_000_000_000)


class Nothing:
    def select(self, command, space, services):
        return Selection()
"""


LENS = """
class Lens:
    levels = ["1"]
    changes = ["rgb"]

    def perceive(self, seen, level, stream):
        return seen
"""


class Bench(Case):
    def setUp(self):
        super().setUp()
        (self.dir / "slow.py").write_text(SLOW)
        (self.dir / "lens.py").write_text(LENS)

    def bench(self, *words, **more):
        return self.call("bench", *words, "--python", PYTHON, **more)

    def medians(self, said):
        """Milliseconds by name, wall and processor time; each checked against its repetitions."""
        found, runs = {}, {}
        for one in said["benchmarks"]:
            if one["run_type"] == "iteration":
                runs.setdefault(one["run_name"], []).append(one)
            else:
                self.assertEqual((one["aggregate_name"], one["name"]), ("median", one["run_name"] + "_median"))
                found[one["run_name"]] = one
        self.assertEqual(found.keys(), runs.keys())
        for name, of in runs.items():
            self.assertEqual([one["repetition_index"] for one in of], list(range(len(of))))
            for time in "real_time", "cpu_time":
                self.assertAlmostEqual(found[name][time], statistics.median(one[time] for one in of))
        return {name: (one["real_time"], one["cpu_time"]) for name, one in found.items()}, runs

    def test_what_is_measured_is_the_methods(self):
        done = self.bench("slow.py:Slow", "--beside", "human", "--demos", "1", "--repetitions", "3", "--json")
        self.assertIn("the policy cannot be pickled", done.stderr, "what a method prints is no JSON")
        said = json.loads(done.stdout)
        self.assertEqual((said["context"]["scenario"], said["context"]["demonstrations"]), ("heart", 1))
        ms, runs = self.medians(said)
        self.assertEqual(set(ms), {f"{phase}/{who}" for phase in ("start", "select", "learn", "act", "save") for who in ("slow", "human")} - {"save/slow"})
        self.assertGreater(ms["select/slow"][0], 100)
        self.assertLess(ms["select/slow"][1], 100, "it sleeps")
        self.assertGreater(ms["learn/slow"][1], 200, "it computes")
        self.assertGreater(ms["act/slow"][0], 20)
        self.assertLess(ms["act/human"][0], ms["act/slow"][0])
        self.assertEqual({len(of) for of in runs.values()}, {3})
        for one in runs["learn/slow"]:
            self.assertGreater(one["max_bytes_used"], 300e6)
            self.assertEqual(one["saved_bytes"], 0)
        for one in runs["learn/human"]:
            self.assertTrue(0 < one["max_bytes_used"] < 300e6 and one["saved_bytes"] > 1000, one)

    def test_a_table_has_ratios(self):
        said = self.bench("human", "--beside", "human", "--set", "policy=point", "--demos", "1", "--repetitions", "2").stdout
        self.assertRegex(said, r"(?m)^heart, 1 demonstration of each command; medians of 2 uses each, in turns$")
        self.assertRegex(said, r"(?m)^ +human \(1\) +human \(2\)")
        learn = next(line for line in said.splitlines() if line.startswith("learn"))
        self.assertLess(float(learn.split("ms")[2].split(",")[0]), 1, "who points does not train")
        self.assertRegex(said, r"(?m)^memory +[\d.]+ MiB +[\d.]+ MiB  \d\.\d\d$")

    def test_a_use_has_limits(self):
        said = self.bench("slow.py:Hangs", "--beside", "human", "--demos", "1", "--timeout", "20", expect=3)
        self.assertRegex(said.stderr, r"^measuring slow and human, each 9 times\n(?s:.*)lgabench: slow: its use took longer than 20 s \(--timeout\)")
        self.assertEqual(said.stdout, "")
        said = self.bench("slow.py:Large", "--beside", "human", "--demos", "1", "--memory", "1", expect=3)
        self.assertRegex(said.stderr, "(?i)memory")
        self.assertEqual(said.stdout, "")

    def test_what_cannot_be_measured_says_why(self):
        for words, status, why in ((("slow.py:Nothing", "--demos", "1"), 2, "slow selects nothing in heart"),
                                   (("none/x.so",), 2, "none/x.so: no such file"),
                                   (("lens.py:Lens",), 2, "expected a method, got a plugin of kind perturbation"),
                                   (("human", "--beside", "none.py:None"), 2, "none.py: no such file"),
                                   (("nobody",), 4, 'no method "nobody"'),
                                   (("human", "--set", "policy"), 2, "--set policy: expected option=value"),
                                   (("human", "--set", "policy=none"), 2, "/policy: expected one of"),
                                   (("human", "--scenario", "none"), 2, 'no scenario "none"'),
                                   (("human", "--demos", "0"), 2, "--demos")):
            said = self.bench(*words, expect=status)
            self.assertIn(why, said.stderr)
            self.assertEqual(said.stdout, "")


if __name__ == "__main__":
    unittest.main()
