"""`lgabench verify`: a run made again by the build that made it, and runs whose records were changed.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 verify_test.py Verify
"""
import hashlib
import json
import pathlib
import re
import shutil
import unittest

from case import BesideOneRun, BUILD, Case

# One cell that trains, for a second, and the reference rows.
RUN = ["run", "q1", "--scenarios", "heart", "--methods", "lga", "--demos", "10", "--seeds", "0", "--episodes", "4",
       "--set", "lga.epochs=20"]


def canonical(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False) + "\n"


def rewrite(cell, name, change):
    """Changes each line of a cell's file, and the checksum with it: nothing in the directory contradicts itself."""
    lines = [change(json.loads(line)) for line in (cell / name).read_text().splitlines()]
    (cell / name).write_text("".join(map(canonical, lines)))
    status = json.loads((cell / "status.json").read_text())
    status["files"][name] = hashlib.sha256((cell / name).read_bytes()).hexdigest()
    (cell / "status.json").write_text(canonical(status))


class Verify(BesideOneRun):
    run_of_class = RUN

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")
            self.run_directory = self.dir / "run"
            self.cell = next(path.parent for path in self.run_directory.glob("cells/*/cell.json")
                             if json.loads(path.read_text())["method"]["id"] == "lga")

    def verify(self, *arguments, expect):
        done = self.call("verify", "run", *arguments, expect=expect)
        self.assertEqual(list(self.dir.glob("lgabench-verify.*")), [], "scratch was left behind")
        return done

    def line_of_the_cell(self, output):
        return next(line for line in output.splitlines() if self.cell.name in line)

    def change(self, name, line, **members):
        lines = iter(range(len((self.cell / name).read_text().splitlines())))
        rewrite(self.cell, name, lambda value: {**value, **members} if next(lines) == line else value)

    def change_status(self, member, name, value):
        status = json.loads((self.cell / "status.json").read_text())
        status[member][name] = value
        (self.cell / "status.json").write_text(canonical(status))

    def test_a_run_of_this_build_is_bit_identical(self):
        before = {p: p.read_bytes() for p in self.run_directory.rglob("*") if p.is_file()}
        said = self.verify("--all", expect=0).stdout
        self.assertIn("5 of 5 finished cells computed again\nbuild, processor and data are those of the record", said)
        self.assertEqual(len(re.findall("^bit-identical ", said, re.M)), 5)
        self.assertNotIn("NOT", said)
        self.verify("--all", "--strict", expect=0)
        self.assertEqual({p: p.read_bytes() for p in self.run_directory.rglob("*") if p.is_file()}, before)

    def test_the_sample_is_the_seeds(self):
        one, again = (json.loads(self.verify("--sample", "2", "--seed", "5", "--json", expect=0).stdout) for _ in "ab")
        self.assertEqual(one, again)
        self.assert_as_schema("verify", one)
        self.assertEqual((len(one["cells"]), one["seed"], one["finished"]), (2, 5, 5))

    def test_a_changed_episode_is_found(self):
        episode = json.loads((self.cell / "episodes.jsonl").read_text().splitlines()[2])
        other = (dict(success=False, failure="missed_object") if episode["success"]
                 else dict(success=True, failure="none"))
        self.change("episodes.jsonl", 2, **other)
        said = self.line_of_the_cell(self.verify("--all", expect=1).stdout)
        self.assertRegex(said, r"^differs +\w+ lga.*: from episodes.jsonl line 3, though the same bytes are owed$")

    def test_a_changed_training_line_is_found(self):
        self.change("training.jsonl", 0, loss=.125)
        said = self.line_of_the_cell(self.verify("--all", expect=1).stdout)
        self.assertRegex(said, r"^differs .*: from training.jsonl line 1, though")

    def test_another_build_is_named_and_excuses_nothing(self):
        self.change("training.jsonl", 0, loss=.125)
        self.change_status("build", "liblgabench_learning.so", "0" * 64)
        said = self.verify("--all", expect=5).stdout
        self.assertRegex(said, r"not as recorded:\n  build: liblgabench_learning.so \(00000000 there, [0-9a-f]{8} here\)\n")
        self.assertRegex(self.line_of_the_cell(said), r"^same outcomes .*: from training.jsonl line 1$")
        self.assertIn("\n4 bit-identical, 1 same outcomes\nNOT bit-identical: 1 of 5 cells; 0 of 20 episodes that can be "
                      "compared ended differently\nFor 1 of them the record names another build, processor or data: its own word", said)
        self.assertEqual(said.splitlines()[-1], "verdict: agrees")
        self.assertIn("NOT bit-identical: 1 of 5 cells", self.verify("--all", "--strict", expect=1).stdout)

    def test_a_forger_cannot_choose_the_milder_rule(self):
        """One episode of 20 that is won in the record alone is more than 1 %, whatever build or processor the record names."""
        episodes = [json.loads(line) for line in (self.cell / "episodes.jsonl").read_text().splitlines()]
        lost = next(i for i, episode in enumerate(episodes) if not episode["success"])
        self.change("episodes.jsonl", lost, success=True, failure="none", attribution=None)
        self.assertNotIn("its own word", self.verify("--all", expect=1).stdout)  # though the build is that of the record
        run = json.loads((self.run_directory / "run.json").read_text())
        excuses = {"the worker's build": lambda: self.change_status("build", "lgabench-worker", "0" * 64),
                   "a build without the method": lambda: self.change_status("build", "method", None),
                   "the processor": lambda: (self.run_directory / "run.json").write_text(
                       canonical({**run, "machine": {"processor": "Z80"}}))}
        status = (self.cell / "status.json").read_bytes()
        for excuse, forge in excuses.items():
            with self.subTest(excuse):
                (self.cell / "status.json").write_bytes(status)
                forge()
                said = self.verify("--all", expect=1).stdout
                self.assertRegex(self.line_of_the_cell(said), r"^other outcomes .*succeeded in the record, ")
                self.assertIn("NOT bit-identical: 1 of 5 cells; 1 of 20 episodes", said)
                self.assertIn("its own word, which proves nothing", said)
                self.assertEqual(said.splitlines()[-1], "verdict: differs")
                self.assertEqual(json.loads(self.verify("--all", "--json", expect=1).stdout)["verdict"], "differs")

    def test_other_data_are_named(self):
        shutil.copytree(BUILD / "share" / "lgabench", self.run_directory / "data")
        with open(self.run_directory / "data" / "answers" / "claude.json", "a") as file:
            file.write("\n")  # the same answers, other bytes
        self.environment = {**self.environment, "LGABENCH_DATA": str(self.run_directory / "data")}
        said = self.verify("--all", expect=0).stdout
        self.assertRegex(said, r"not as recorded:\n  data: answers \([0-9a-f]{8} there, [0-9a-f]{8} here\)\n")
        self.assertIn("\n5 bit-identical\n", said)

    def change_machine(self, **machine):
        run = json.loads((self.run_directory / "run.json").read_text())
        (self.run_directory / "run.json").write_text(json.dumps({**run, "machine": machine}))

    def test_with_fma_the_same_bits_are_owed(self):
        """Of a shipped method: whatever the processor is called, and as wide as its vectors are."""
        machine = json.loads((self.run_directory / "run.json").read_text())["machine"]
        flags = pathlib.Path("/proc/cpuinfo").read_text().split("flags", 1)[-1].split("\n")[0].split()
        here = "AVX-512" if "avx512f" in flags else "AVX2" if {"avx2", "fma"} <= set(flags) else "without FMA"
        self.assertEqual(machine["instructions"], here)
        self.assertNotIn(here, machine["processor"])
        said = f"{machine['processor']} {'' if here == 'without FMA' else 'with '}{here}"
        if here == "without FMA":
            self.skipTest("no bits are promised here")
        self.change("training.jsonl", 0, loss=.125)
        for there, words in (({"processor": "Z80", "instructions": "AVX-512"}, "Z80 with AVX-512"), ({"processor": "Z80 with AVX2"}, "Z80 with AVX2")):
            self.change_machine(**there)
            out = self.verify("--all", expect=1).stdout
            self.assertIn(f"\nbuild and data are those of the record; the record: {words}; here: {said}: the same bytes are owed\n", out)
            self.assertRegex(self.line_of_the_cell(out), r"^differs .*: from training.jsonl line 1, though the same bytes are owed$")
            self.assertEqual(out.splitlines()[-2:], [f"the record: {words}; here: {said}", "verdict: differs"])

    def test_processors_that_owe_no_bits_are_named(self):
        self.change("training.jsonl", 0, loss=.125)
        for there, words in (({"processor": "Z80"}, "Z80, instructions not recorded"),
                             ({"processor": "Z80", "instructions": "without FMA"}, "Z80 without FMA")):
            self.change_machine(**there)
            out = self.verify("--all", expect=5).stdout
            self.assertIn(f"not as recorded:\n  processor: the record: {words}; here: ", out)
            self.assertRegex(self.line_of_the_cell(out), r"^same outcomes .*: from training.jsonl line 1$")
            self.assertRegex(out.splitlines()[-2], f"^the record: {words}; here: ")
            self.assertEqual(out.splitlines()[-1], "verdict: agrees")
        self.change_machine(processor="Z80", instructions="MMX")
        self.assertIn("/machine/instructions: expected AVX-512, AVX2 or without FMA", self.verify("--all", expect=2).stderr)

    def test_an_edited_cell_is_said_before_anything_runs(self):
        with open(self.cell / "episodes.jsonl", "a") as file:
            file.write("\n")
        done = self.verify("--all", expect=1)
        self.assertRegex(done.stderr.splitlines()[0],
                         rf"^edited: .*{self.cell.name}/episodes.jsonl changed since it was written")
        self.assertIn("4 of 4 finished cells", done.stdout)
        self.assertEqual(done.stdout.splitlines()[-1], "1 cells were edited: not verified")

    def test_a_cell_under_another_name_is_edited(self):
        self.change("cell.json", 0, training_seed=1)
        self.assertIn("cell.json changed since it was written", self.verify("--sample", "1", expect=1).stderr)

    def test_no_run(self):
        shutil.rmtree(self.run_directory / "cells")
        self.assertIn("no finished cell: nothing to verify", self.verify(expect=2).stderr)
        (self.run_directory / "run.json").unlink()
        self.assertIn("not the directory of a run (no run.json)", self.verify(expect=2).stderr)


class Compare(Case):
    """Exit statuses of compare and report --claims."""

    def setUp(self):
        super().setUp()
        self.run_small("a")

    def run_small(self, out, episodes="8"):
        self.call("run", "q1", "--scenarios", "heart", "--methods", "lga,gcbc_dart", "--demos", "10", "--seeds", "0",
                  "--set", "lga.epochs=5", "--set", "gcbc_dart.epochs=1", "--episodes", episodes, "--out", out)

    def make(self, run, method, success):
        """Lets every episode of a method end so, under the name of the method as shipped."""
        for path in (self.dir / run).glob("cells/*/cell.json"):
            if json.loads(path.read_text())["method"]["id"] == method:
                rewrite(path.parent, "episodes.jsonl", lambda episode: {
                    **episode, "success": success, "failure": "none" if success else "missed_object"})
                rewrite(path.parent, "cell.json", lambda cell: {**cell, "method": {**cell["method"], "name": method}})

    def test_compare(self):
        self.assertEqual(self.call("compare", "a", "a").stdout.count("same actions"), 6)
        compared = json.loads(self.call("compare", "a", "a", "--json").stdout)
        self.assert_as_schema("compare", compared)
        self.assertFalse(compared["regressed"])
        shutil.copytree(self.dir / "a", self.dir / "worse")
        self.make("a", "oracle", True)
        self.make("worse", "oracle", False)
        self.assertRegex(self.call("compare", "a", "worse", expect=1).stdout, r"oracle .* -1.00 \[.* worse\n")
        self.assertRegex(self.call("compare", "worse", "a").stdout, r"\AB is better: oracle .*\n\n[^$]*oracle .* better\n")
        rows = self.call("compare", "a", "--rows", "gcbc_dart,lga").stdout
        self.assertRegex(rows, r"\A.*LGA|No difference")
        self.assertEqual(self.call("compare", "a", expect=2).stderr.count("expected A B, or A with --rows or --difference"), 1)
        self.assertIn("did you mean \"lga\"", self.call("compare", "a", "--rows", "lg,gcbc_dart", expect=2).stderr)

    def test_a_page_over_several_runs(self):
        shutil.copytree(self.dir / "a", self.dir / "b")
        (self.dir / "notes.txt").write_text("no run")
        said = self.call("report", "a", "b", "notes.txt")
        self.assertIn("LGA", said.stdout)
        page = (self.dir / "index.html").read_text()
        self.assertIn('href="a/report.html"', page)
        self.assertIn('href="b/report.html"', page)
        self.assertNotIn("notes.txt", page)
        self.call("report", "a", "b", "--index", "all.html")
        self.assertEqual((self.dir / "all.html").read_text(), page)
        self.call("report", "a", "b", "--claims", expect=2)

    def test_compare_refuses_other_episodes(self):
        self.run_small("b", episodes="2")
        refused = self.call("compare", "a", "b", expect=2)
        self.assertEqual(refused.stdout, "")
        self.assertRegex(refused.stderr, r"^lgabench: the runs cannot be compared: .*8 episodes an arm in A, 2 in B\n$")

    def test_claims(self):
        self.assertIn("not tested: no row gcbc_seg", self.call("report", "a", "--claims").stdout)
        self.make("a", "lga", False)
        self.make("a", "gcbc_dart", True)
        said = self.call("report", "a", "--claims", expect=1).stdout
        self.assertRegex(said, r"test +10 +LGA − GCBC-DART +-1.00 \[.* reversed ")
        claims = json.loads(self.call("report", "a", "--claims", "--format", "json", expect=1).stdout)["claims"]
        self.assertEqual([claim["verdict"] for claim in claims], ["reversed"] + 4 * ["not tested"])
        self.call("report", "a")
        done = self.call("compare", "a", "--difference", "gcbc_dart,lga")
        said = done.stdout
        old = self.call("report", "a", "--difference", "gcbc_dart,lga")
        self.assertEqual(old.stdout, said)
        self.assertEqual(old.stderr, "lgabench: report --difference is accepted for one more release; write lgabench compare a "
                                     "--difference gcbc_dart,lga\n" + done.stderr)
        self.assertRegex(said, r"Two rows, paired\n(.*\n)+.*test +10 +GCBC-DART − LGA +\+1.00 \[.* held ")
        self.call("compare", "a", "--difference", "lga,gcbc_dart", expect=1)
        self.assertIn("expected one run", self.call("compare", "a", "b", "--difference", "lga,gcbc_dart", expect=2).stderr)
        self.assertIn("excludes", self.call("report", "a", "--claims", "--difference", "gcbc_dart,lga", expect=2).stderr)
        self.assertIn("no row nobody, the run has: gcbc_dart, lga",
                      self.call("compare", "a", "--difference", "lga,nobody", expect=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
