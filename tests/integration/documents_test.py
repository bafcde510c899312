"""Every command that README and docs show, by how long it takes: up to 3 s it is carried out with few episodes, up to 5 minutes
and whole with ./test --full, a longer run is planned with --dry-run.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 documents_test.py DocumentedCommands
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import textwrap
import unittest

from case import BUILD, FULL, Case, FIXTURES, with_options
from python_test import PYTHON, has

SOURCE = pathlib.Path(__file__).parents[2]
PAGES = sorted([SOURCE / "README.md", *(SOURCE / "docs").glob("*.md")])
# A reader's own things -> what stands for them here.
OWN = {"my_method": "fixture_constant", "my_engine": "kinematic", "runs/NAME": "run", "runs/BEFORE": "run",
       "runs/AFTER": "run", "RUN": "run", "runs/q1": "run", "runs/*": "run", "ID": "mobile", "SCENARIO": "bring_fruit",
       "SUITE": "mobile"}
WITH_A_SERVER = ("openai", "cassette:")  # answers_test plays the server
BUILT_BY_A_READER = ("mine.json", "own_network", "my_stack", "my_statistic", "my_axis", "my_asker", "my_world")
LONGEST = 300 if FULL else 3  # seconds, as --dry-run expects them
# bench_test, run_test, verify_test, consumer_test, study_test, leaderboard_test, cluster_test, python/evals_test
ELSEWHERE = {"bench", "install", "merge", "verify", "new-plugin", "check-plugin", "study", "leaderboard", "cluster", "status", "attribute", "answers"}


def commands(page):
    """The words after `lgabench` of each command in a block or a table; a continued line counts as one."""
    text = re.sub(r" *\\\n *", " ", page.read_text())
    for line in re.findall(r"^    (?:\S*/)?lgabench (.*)$|^\| `lgabench ([^`]*)` \|", text, re.M):
        yield shlex.split(re.sub(r" {2,}#.*", "", "".join(line)))


def expected_seconds(plan):
    """Of "about 1 h 25 min with 2 workers", or "unknown, at least 3 s ...": what nobody has measured is a reader's own small method."""
    unit = {"s": 1, "min": 60, "h": 3600}
    return sum(int(n) * unit[u] for n, u in re.findall(r"(\d+) (s|min|h)\b", re.search(r"^(?:about|unknown, at least|an unknown) (.*) with", plan, re.M)[1]))


class DocumentedCommands(Case):
    def setUp(self):
        super().setUp()
        for variable in "BROWSER", "DISPLAY", "WAYLAND_DISPLAY":
            self.environment.pop(variable, None)
        self.call("run", "q1", "--limit", "4", "--out", "run", "--set", "*.epochs=2")
        shutil.copy(SOURCE / "examples/python/lga_torch.py", self.dir)
        self.call("new-plugin", "my_method", "--kind", "python", "--directory", "python")
        shutil.copy(self.dir / "python/my_method.py", self.dir)

        q1 = json.loads((SOURCE / "envs/tabletop/suites/q1.json").read_text())
        q1.update(id="q1_4711", scene_seed=4711, scenarios=[s for s in q1["scenarios"] if s != "letter"])
        (self.dir / "q1_4711.json").write_text(json.dumps(q1))

    def here(self, words):
        """With what stands for a reader's own things."""
        words = [re.sub(r"\b(my_method|my_engine)\b(?!\.py)", lambda own: OWN[own[1]], OWN.get(word, word))
                 .replace("examples/python/", "") for word in words]
        while "--plugin-path" in words:
            at = words.index("--plugin-path")
            del words[at:at + 2]
        for i, word in enumerate(words):
            if word.startswith(WITH_A_SERVER):
                words[i] = "none"
        for option in "--model", "--cassette":
            if option in words:
                del words[words.index(option):words.index(option) + 2]
        return words

    def test_each_is_as_the_program_takes_it(self):
        ran, planned, carried_out = 0, 0, []  # words that several pages show are carried out once
        for page in PAGES:
            for shown in commands(page):
                verb = shown[0]
                asks_a_server = any(word.startswith(WITH_A_SERVER) for word in shown)
                own = any(name in word for word in shown for name in BUILT_BY_A_READER)
                if not verb.islower() or verb in ELSEWHERE or own or "--humans" in shown or verb == "select" and asks_a_server:
                    continue
                words = self.here(shown)
                with self.subTest(page=page.name, command=" ".join(shown)):
                    if verb == "run":
                        needs = {".py": "numpy", "torch": "torch"}
                        if not all(has(PYTHON, module) for part, module in needs.items() if part in " ".join(words)):
                            continue
                        words = [word for word in words if word not in ("--debug", "KEY", "--resume")]
                        own = ["--plugin-path", FIXTURES / "good", "--python", PYTHON]
                        plan = self.call(*(word for word in words if word != "--dry-run"), "--dry-run", *own).stdout
                        planned += 1
                        if "--dry-run" in words or asks_a_server or words in carried_out or expected_seconds(plan) > LONGEST:
                            continue
                        carried_out.append(words)
                        # The plan took the words whole; little is learned and played of them.
                        few = () if FULL else ("--demos", "2", "--episodes", "2", *(() if "--set" in words else ("--set", "*.epochs=2")))
                        self.call(*with_options(words, "--out", f"out{len(carried_out)}", *few), *own, timeout=1800)
                    elif words not in carried_out:
                        carried_out.append(list(words))
                        for pair in {"--difference", "--rows"}.intersection(words):
                            words[words.index(pair) + 1] = "lga,lga_s"
                        if verb == "replay":
                            words[2] = next(key for key, (cell, _) in self.cells("run").items()) + "/0"
                        if verb == "new-scenario":
                            (self.dir / f"{shown[1]}.json").unlink(missing_ok=True)
                        if verb == "new-suite":
                            shutil.rmtree(self.dir / shown[1], ignore_errors=True)
                        if verb == "draw-commands":
                            shutil.rmtree(self.dir / words[words.index("--out") + 1], ignore_errors=True)
                        self.call(*words)
                        ran += 1
        self.assertGreater(ran, 12)
        self.assertGreater(planned, 20)
        self.assertIn("run", {words[0] for words in carried_out})


# What begins a line that a reader types, or of the code that the tutorial adds.
TYPED = re.compile(r"(git|\./|~/|mkdir|v/bin|cmake|lgabench|build/|selection\.)\S*")


def printed_blocks(page):
    """Indented blocks that no reader types, with the places where they begin."""
    for block in re.finditer(r"(?:^ {4,}\S.*\n(?:\n(?= {4,}\S))?)+", page, re.M):
        if not TYPED.match(block[0].strip()):
            yield block.start(), block[0]


@unittest.skipUnless((BUILD / "lib/lgabench/plugins/mujoco.so").exists(), "the pages show what MuJoCo plays")
class PrintedBlocks(Case):
    """What README and the tutorial say that a command prints, whole but for the hash in a path. LGABENCH_WRITE_GOLDEN=1 writes it
    into the pages."""

    def without_hash(self, text):
        return re.sub(r"-[0-9a-f]{8}/report", "-HASH/report", text)

    def assert_printed(self, page, *command):
        page = SOURCE / page
        text = page.read_text()
        (at, shown), = printed_blocks(text)
        printed = self.call(*command, "--engines", "mujoco").stdout
        for name, *rates in re.findall(r"^  (\S.*?)  +([01]\.\d\d)\S*", printed, re.M):
            self.assertTrue(name not in ("True mask", "LGA") or float(rates[0]) >= .9, printed)
        self.assertNotRegex(printed, "[§†‡]")
        indent = re.match(" +", shown)[0]
        if os.environ.get("LGABENCH_WRITE_GOLDEN"):
            page.write_text(text[:at] + textwrap.indent(printed, indent) + text[at + len(shown):])
        self.assertEqual(self.without_hash(textwrap.dedent(shown)), self.without_hash(printed))

    def test_the_first_run(self):
        usual, = re.findall(r"arguments=\((\w.*)\)", (SOURCE / "quickstart").read_text())
        self.assert_printed("README.md", "run", *usual.split())

    def rates(self):
        run, = (self.dir / "runs").iterdir()
        rows = json.loads((run / "summary.json").read_text())["rows"]
        shutil.rmtree(run)
        return {row["scenario"]: row["success"] for row in rows if row["method"] == "my_method"}

    def test_the_tutorials_row_and_what_spoils_it(self):
        words = ["run", "q1", "--preset", "smoke", "--methods", "lga,my_method", "--plugin-path"]
        page = (SOURCE / "docs/tutorial.md").read_text()
        self.assertIn(" ".join(words), page)
        self.assert_printed("docs/tutorial.md", *words, BUILD / "tests/plugins/written")
        before = self.rates()
        self.call("run", *words[1:4], "--methods", "my_method", "--engines", "mujoco", "--plugin-path",
                  BUILD / "tests/plugins/changed")
        after = self.rates()
        self.assertEqual(len(before), 3)
        self.assertEqual([one for one in before if after[one] >= before[one]], [])
        self.assertIn(f"falls to {100 * after['(mean)']:.0f} %", page)


if __name__ == "__main__":
    unittest.main()
