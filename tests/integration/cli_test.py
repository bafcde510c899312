"""The command line itself: help, what is said of mistakes, --dry-run, --resume, colour, the cache, completion, man page."""
import json
import os
import pathlib
import pty
import re
import shutil
import subprocess
import unittest

from case import BUILD, Case, FIXTURES, PROGRAM, command_line, some_of

VERBS = ["list", "info", "select", "answers", "render", "demos", "run", "open", "report", "compare", "verify", "attribute", "merge", "cluster", "status",
         "leaderboard", "new-plugin", "check-plugin", "draw-commands", "study", "encoder", "cache", "help"]
FIRST = ["list", "run", "open", "compare", "new-plugin", "check-plugin"]
PLUGIN = ["--plugin-path", FIXTURES / "good"]
# Cells without training, for milliseconds.
RUN = ["run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", *PLUGIN, "--demos", "10,20", "--seeds", "0:2",
       "--episodes", "2", "--no-reference"]
PAGES = BUILD / "programs/lgabench/cli"


class Help(Case):
    def test_bare_and_asked_for(self):
        said = self.call().stdout
        self.assertEqual(said, self.call("--help").stdout)
        self.assertEqual(said, self.call("help").stdout)
        self.assertEqual(re.findall(r"^  ([a-z][a-z-]*)  ", said, re.M), FIRST)
        every = self.call("help", "all").stdout
        self.assertEqual(every, self.call("--help-all").stdout)
        verbs = re.findall(r"^  ([a-z][a-z-]*)  ", every, re.M)
        self.assertLessEqual(set(VERBS), set(verbs))
        self.assertIn(f"\n{len(verbs) - len(FIRST)} more commands: lgabench help all\n", said)
        self.assertNotIn("Other commands", every, "each command stands below a title of its own")
        for word in ("LGABENCH_PLUGIN_PATH", "NO_COLOR", "Exit status", "130"):
            self.assertIn(word, every)

    def test_help_of_a_command_is_its_own(self):
        for verb in ("run", "rescore", "help"):
            self.assertEqual(self.call("help", verb).stdout, self.call(verb, "--help").stdout)
        self.assertIn('unknown command "rnu" (did you mean "run"?)', self.call("help", "rnu", expect=2).stderr)

    def test_an_old_name_works_and_says_the_new_one(self):
        done = self.call("commands", "--seed", "7", "--n", "1", "--out", "drawn")
        self.assertIn("lgabench commands is accepted for one more release; write lgabench draw-commands\n", done.stderr)
        self.assertTrue((self.dir / "drawn/drawn_7.json").exists())

    def test_of_every_command_fits_and_names_what_is_taken(self):
        for verb in VERBS:
            with self.subTest(verb):
                said = self.call(verb, "--help").stdout
                self.assertRegex(said, rf"\nUsage: lgabench {verb} \[OPTIONS\].*\n\n(?s:.*)Example(?s:.*)\n  (-|[A-Z])")
                self.assertEqual([line for line in said.splitlines() if len(line) > 100], [])
                self.assertEqual(re.findall(r"\b(?:TEXT|U?INT|FLOAT|REQUIRED|Excludes)\b", said), [])
                self.assertIn("Example", said)
        said = self.call("run", "--help").stdout
        titles = re.findall(r"^(\w.*)\n  -", said, re.M)
        self.assertEqual(titles[:4], ["What is computed", "How cells are computed", "How much is computed", "Output"])
        self.assertLess(len(titles), 6)
        self.assertLess(len(said.splitlines()), 60)
        self.assertRegex(said.splitlines()[4], "^Examples")

    def test_what_is_rarely_needed_is_shown_when_asked_for(self):
        for verb, usual in (("run", "--methods"), ("cluster", "--elements")):
            said, more = (self.call(verb, which).stdout for which in ("--help", "--help-all"))
            options, every = (set(re.findall(r"^  (--[a-z-]+)", text, re.M)) for text in (said, more))
            self.assertIn(usual, options)
            self.assertLess(options, every)
            self.assertIn(f"\n{len(every - options)} more options: lgabench {verb} --help-all\n", said)
        self.assertNotIn("--methods", said, "cluster does not say again what run says")
        self.assertIn("--methods", more)

    def test_lines_go_on_below_their_second_column(self):
        said = self.call("help", "all").stdout
        statuses = said.split("\nExit status\n")[1].split("\n\n")[0].splitlines()
        self.assertEqual([line for line in statuses if not re.match(r"  \d+ +\S|       \S", line)], [])
        early = [line for line, rest in zip(statuses, statuses[1:]) if rest.startswith("      ")
                 and len(line) + 1 + len(rest.split()[0]) <= 100]
        self.assertEqual(early, [], "broken though the next word had room")
        examples = self.call("select", "--help").stdout.split("\nExamples\n")[1].split("\n\n")[0].splitlines()
        self.assertEqual([line for line in examples if not line.startswith("  lgabench select")], [])

    def test_version(self):
        self.assertRegex(self.call("--version").stdout,
                         r"^lgabench \d+\.\d+\.\d+(-dev)? \(commit ([0-9a-f]{12}(-dirty)?|unknown), \w+, \w+ \d+\.\d+\.\d+\)\n$")

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_man_page(self):
        done = subprocess.run(["groff", "-man", "-ww", "-Tascii", "-P-c", PAGES / "lgabench.1"], capture_output=True,
                              text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = re.sub(r".\x08", "", done.stdout)
        for verb in VERBS:
            self.assertIn(f"lgabench {verb}".lower(), text.lower())
        for word in ("--demos N,...", "Exit status", "LGABENCH_CACHE"):
            self.assertIn(word, text)


class Mistakes(Case):
    def test_say_what_was_meant(self):
        (self.dir / "empty").mkdir()
        for words, says in [
            (["lst"], r'^lgabench: unknown command "lst" \(did you mean "list"\?\); see lgabench --help$'),
            (["rnu", "q1"], r'unknown command "rnu" \(did you mean "run"\?\)'),
            (["version"], r'did you mean "--version"\?'),
            (["-v"], r"unknown option -v \(did you mean \"--version\"\?\)"),
            (["run", "q1", "--demo", "10"], r'unknown option --demo \(did you mean "--demos"\?\); see lgabench run --help$'),
            (["run", "--lmit=3"], r'unknown option --lmit \(did you mean "--limit"\?\)'),
            (["select", "heart", "--answer", "claude"], r'^lgabench: unknown option --answer \(did you mean "--answers"'),
            (["run"], r"^lgabench: SUITE is missing; usage: lgabench run \[OPTIONS\] SUITE$"),
            (["leaderboard"], r"^lgabench: ACTION is missing; usage: lgabench leaderboard \[OPTIONS\] ACTION \[WHAT\] \[LINE\]$"),
            (["run", "q1", "--set", "lga.network=plane", "--dry-run"], r'\(did you mean "plain"\?\), got "plane"'),
            (["merge"], r"OUT is missing; usage: lgabench merge \[OPTIONS\] OUT RUN\.\.\.$"),
            (["compare", "a"], r"compare: expected A B, or A with --rows or --difference$"),
            (["verify", "a", "b"], r'"b" is a word too many; usage: lgabench verify \[OPTIONS\] RUN$'),
            (["run", "q11"], r'no suite "q11" \(did you mean "q1"\?\)$'),
            (["run", "moon"], r'no suite "moon", expected one of: .*q1.*, or a \.json file$'),
            (["run", "q1", "--preset", "smokey"], r'q1.json: no preset "smokey" \(did you mean "smoke"\?\)'),
            (["run", "q1", "--scenarios", "hart"], r'^lgabench: --scenarios: no scenario "hart" \(did you mean "heart"\?\)$'),
            (["run", "q1", "--layout", "cell"], r'--layout: no layout "cell" \(did you mean "cells"\?\)$'),
            (["run", "--engines", "mujoco", "q1", "--preset"], r"^lgabench: --preset: expected PRESET after it$"),
            (["run", "q1", "--plugin-path", "nowhere"], r"^lgabench: --plugin-path: nowhere: no such file or directory$"),
            (["run", "q1", "--plugin-path", "nowhere.py:Mine"], r"^lgabench: --plugin-path: nowhere.py: no such file or directory$"),
            (["list", "--plugin-path", "empty:empty"], r"^lgabench: --plugin-path: empty:empty: no such file or directory; for several, repeat --plugin-path$"),
            (["check-plugin", "nofile.so"], r"^lgabench: nofile.so: no such file or directory$"),
            (["check-plugin", "nofile.py:Mine"], r"^lgabench: nofile.py: no such file or directory$"),
            (["run", "q1", "--jobs", "0"], r"^lgabench: --jobs: expected a number from 1 to 4096, got 0$"),
            (["study", "chek", "x"], r'^lgabench: study: no action "chek" \(did you mean "check"\?\)'),
            (["check-scenario", "none.json"], r"^lgabench: none.json: no such file$"),
            (["run", "q1", "--seeds", "3:0"], r"--seeds: expected FIRST:END, END not included, .*; 3:0 has 0$"),
            (["run", "q1", "--demos", "10-50"], r'--demos: expected whole numbers, such as 10,50, .* got "10-50"$'),
            (["run", "q1", "--demos", "ten"], r'--demos: expected whole numbers, such as 10,50, .* got "ten"$'),
            (["run", "q1", "--demos", "5,,10"], r"^lgabench: --demos: expected a value between commas, got 5,,10$"),
            (["run", "q1", "--methods=lga,"], r"^lgabench: --methods: expected a value between commas, got lga,$"),
            (["run", "q1", "--methods", "lga", "--methods", "lga"], r"^lgabench: --methods: expected each value once, got lga twice$"),
            (["leaderboard", "build", "--documents", "a,a"], r"^lgabench: --documents: expected each value once, got a twice$"),
            (["run", "q1", "--axes", "camera_turn:1++4"], r'--axes: expected AXIS or .*; got "camera_turn:1\+\+4"$'),
            (["run", "q1", "--preset", "a", "--preset", "b"], r"^lgabench: --preset: expected it once, got it 2 times$"),
            (["rescore", "x", "--within", "1"], r"^lgabench: --within: expected 2 values, got 1$"),
            (["draw-commands", "--n", "5"], r"^lgabench: --seed is missing; usage: lgabench draw-commands"),
            (["run", "q1", "--demos", "0"], r"^lgabench: demonstrations: expected 1 or more for lga, whose policy \(regression\) is "
                                            r"trained on them, got 0; policy=point needs none$"),
            (["run", "q1", "--methods", "keypoints", "--demos", "0"], r"expected 1 or more for keypoints, whose policy is trained on them, got 0$"),
            (["run", "q1", "--methods", "gcbc_dart", "--demos", "0"], r"whose policy \(regression\) is trained on them, got 0$"),
            (["run", "q1", "--methods", "lga+epochs=4294967297"], r"epochs: expected a whole number of at most 2147483647, got 4294967297"),
            (["new-scenario", "x", "--command", "x", "--types", "ring", "--relative-to", "heart"], r"--relative-to, --order: expected --which with them$"),
            (["new-scenario", "x", "--command", "x", "--types", "ring", "--other-textures", "red"], r"--other-textures: expected --other-types with it$"),
            (["new-scenario", "x", "--command", "x", "--types", "ring", "--careless", "ring"],
             r"/near_miss_sets/0: expected objects that scenes can show and that the command does not mean"),
            (["new-suite", "a" * 63, "--command", "x", "--types", "ring"], r'"a+_1": expected at most 63 '),
            (["new-suite", "x", "--scenarios", "heart", "--title", "two\nlines"], r"^lgabench: --title: expected one line of text in UTF-8"),
            (["new-plugin", "numpy", "--language", "python"], r"expected another id than numpy, which is a module's that plugins use$"),
            (["run", "q1", "--methods", "selected_by:lga", "--demos", "0,5"], r"expected 1 or more for selected_by:lga, whose policy \(heat_map\)"),
            (["run", "q1", "--episodes", "010"], r"^lgabench: --episodes: expected a whole number up to 2147483647, without leading zeros, got 010$"),
            (["run", "q1", "--quiet=maybe"], r"^lgabench: --quiet: expected no value, got maybe$"),
            (["run", "q1", "--jobs", "0x2"], r"^lgabench: --jobs: expected a whole number up to .*, got 0x2$"),
            (["run", "q1", "--timeout", "0x9"], r"^lgabench: --timeout: expected a number, got 0x9$"),
            (["run", "q1", "--scene-seed", "9223372036854775808"], r"^lgabench: --scene-seed: expected a whole number from .* to 9223372036854775807, got 9223372036854775808$"),
            (["run", "q1", "--scene-seed", "-1"], r"^lgabench: --scene-seed: expected a whole number from 0 to 9223372036854775807, got -1$"),
            *([[*words, "--seed", seed], rf"^lgabench: --seed: expected a whole number from 0 to 9223372036854775807, got {seed}$"]
              for words in (["draw-commands", "--out", "x"], ["demos", "heart", "--out", "x"], ["render", "heart"])
              for seed in ("-1", "9223372036854775808", "99999999999999999999999")),
            (["render", "nosuch"], r'no scenario "nosuch", expected one of \d+, such as: (\w+, ){7}\w+ \(lgabench list scenarios\); others are found with --scenario-path or '),
            (["new-suite", "mine", "--scenarios", "nosuch"], r'no scenario "nosuch", expected one of \d+, such as: '),
            (["select", "Bring me a fruit.", "--space", "kitchen"], r'^lgabench: --space: no feature space "kitchen", expected one of: '),
            (["run", "q1", "--truth", "realeased"], r'--truth: no truth "realeased" \(did you mean "released"\?\)'),
            (["info", "lag"], r'"lag" \(did you mean "lga"\?\); .*--plugin-path'),
            (["demos", "hart", "--out", "x"], r'no scenario "hart" \(did you mean "heart"\?\)'),
            (["report", "x", "--format", "yaml"], r'--format: no format "yaml", expected one of: text, md, latex, json, csv'),
            (["select", "Bring me the unicorn."], r"none for .*; --answers openai asks a model \(docs/language-models.md\)$"),
            (["leaderboard", "build", "--cells", "3"], r"^lgabench: leaderboard build: --cells is an option of verify$"),
            (["leaderboard", "add", "x", "--entry", "y"], r"results/leaderboard: no leaderboard is there; give --board DIR"),
            (["leaderboard", "add", "x", "--documents", "y"], r"leaderboard add: --documents is an option of build, check$"),
            (["leaderboard", "check", "x"], r'leaderboard check: "x" is a word too many$'),
            (["leaderboard", "verify", "--fresh", "--cells", "3"], r"excludes"),
            (["study", "report", "x", "--out", "y"], r"study report: --out is an option of serve$"),
            (["report", "nope"], r"^lgabench: nope: not the directory of a run \(no run.json\)$"),
        ]:
            with self.subTest(words):
                done = self.call(*words, expect=2)
                self.assertEqual(done.stdout, "")
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertLess(len(done.stderr), 800)
                self.assertRegex(done.stderr, re.compile(says, re.M))
        self.assertRegex(self.call("run", "q1", "--methods", "lag", expect=4).stderr,
                         r'no method "lag" \(did you mean "lga"\?\); other plugins are found with --plugin-path')
        (self.dir / "bad.py").write_text("class Bad:\n    pass\n\n\nclass Other(Bad):\n    pass\n")
        self.assertIn("bad.py: expected bad.py:CLASS; it has: Bad, Other",
                      self.call("run", "q1", "--methods", "bad.py", expect=4).stderr)
        self.assertRegex(self.call("run", "q1", "--methods", "mine", "--plugin-path", "empty", expect=4).stderr,
                         r'no method "mine".*empty was refused: no plugin \(\*\.so\) is in it')

    def test_a_plugin_path_may_be_the_plugin(self):
        plugin = FIXTURES / "good/fixture_constant.so"
        self.assertIn("fixture_constant", self.call("list", "--plugin-path", plugin).stdout)
        self.assertIn("fixture_constant", self.call("info", "--plugin-path", plugin, "fixture_constant").stdout)

    def test_runs_that_are_near_are_named(self):
        self.call(*RUN, "--out", "runs/mine")
        self.assertIn("; runs: runs/mine", self.call("report", "runs", expect=2).stderr)
        self.assertIn("; runs: runs/mine", self.call("verify", "q1", expect=2).stderr)


class Lists(Case):
    def test_short_ones_have_a_line_each(self):
        said = self.call("list", "--short").stdout
        ids = [name for kind in ("methods", "rows", "suites") for name in self.call("list", kind).stdout.split()]
        lines = [line for line in said.splitlines() if line.startswith("  ")]
        self.assertEqual([line for line in lines if len(line) > 100], [])
        self.assertLessEqual(set(ids), {line.split()[0] for line in lines})
        self.assertLess(len(lines), 100, "scenarios are counted")
        scenarios = self.call("list", "scenarios", "--short").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in scenarios[1:]], self.call("list", "scenarios").stdout.split())
        suites = self.call("list", "suites", "--short").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in suites[1:]], self.call("list", "suites").stdout.split())
        self.assertRegex(self.call("list").stdout, r"\nscenarios\n  \d+: `lgabench list scenarios --short` has their commands\n")
        (self.dir / "broken.json").write_text("{")
        self.assertEqual(self.call("list", "--scenario-path", ".").stderr, "", "none was read")
        self.assertIn("broken.json", self.call("list", "scenarios", "--short", "--scenario-path", ".", expect=2).stderr)
        self.assertIn("--short: expected no --of", self.call("list", "layouts", "--short", expect=2).stderr)


class Ends(Case):
    """What a run prints last."""

    def test_a_sentence_a_table_and_a_path(self):
        done = self.call(*RUN[:-1], "--out", "run")
        headline, caption, table, *notes, last = done.stdout.split("\n\n")
        head, *rows = table.split("\n")
        self.assertRegex(headline, "^Mean over 1 scenario, 20 demonstrations: fixture_constant succeeds in 0...")
        self.assertEqual(last, "report: run/report.html\n")
        self.assertLessEqual(len(notes), 1)
        self.assertEqual((caption, head.split()), ("Success, mean over 1 scenario [95 % interval]", ["demonstrations", "10", "20"]))
        self.assertEqual([row.split("  ")[1] for row in rows[:1]], ["fixture_constant"])
        self.assertTrue(any(row.startswith("  random visible object ") for row in rows))
        self.assertIn("cells computed", done.stderr)

        quiet = self.call(*RUN[:-1], "--quiet", "--fresh", "--out", "run")
        self.assertEqual(quiet.stdout, f"{caption}\n\n{table}\n")
        self.assertNotRegex(quiet.stderr, "computed|left|cells")
        tables = self.call(*RUN[:-1], "--tables", "--out", "run").stdout
        self.assertIn("  oracle ", tables)
        self.assertEqual(tables.split("\n\nreport: ")[0] + "\n", self.call("report", "run").stdout)
        self.assertIn("--json excludes --tables", self.call(*RUN, "--tables", "--json", "--out", "x", expect=2).stderr)

    def test_cells_that_failed(self):
        done = self.call(*RUN[:3], "heart,letter", "--methods", "fixture_constant,fixture_faulty+where=learn+how=throw", *PLUGIN,
                         "--plugin-path", FIXTURES / "faulty", "--demos", "2", "--seeds", "0", "--episodes", "2", "--out", "run", expect=3)
        self.assertRegex(done.stderr, r"\nfailed: fixture_faulty.* heart .*\(run/cells/\w+/log.txt\)\n")
        self.assertRegex(done.stdout, r"(?s)fixture_constant .*\n\nreport: run/report.html\n$")


class DryRuns(Case):
    def test_say_how_much_there_is_to_do_and_do_nothing(self):
        said = self.call("run", "q1", "--dry-run", "--methods", "lga,gcbc_dart,fixture_constant", *PLUGIN, "--jobs", "1").stdout
        self.assertEqual([p for p in self.dir.iterdir()], [])
        self.assertRegex(said, r"^runs/q1-\w{8}: 1001 cells, 0 already computed, 1001 to compute\n")
        self.assertRegex(said, r"\nlga +195 +0 +\d+ min  cells measured elsewhere\n")
        self.assertRegex(said, r"\nfixture_constant +195 +0 +at least \d+ (s|min)  nobody: what its own plugin takes is unknown\n")
        self.assertRegex(said, r"\nunknown, at least \d+ min with 1 worker\nthen at most as long again for cells of fixture_constant, to find the "
                               r"causes of failures\ndisk: \d+ MB in runs/q1-\w{8}, and at most \d+ MB")
        said = self.call("run", "q1", "--dry-run", "--methods", "lga,gcbc_dart").stdout
        self.assertNotIn("causes", said)
        self.assertRegex(said, r"\nabout \d+ ")
        self.assertIn("shard 2/2 of a run of 1001 cells",
                      self.call("run", "q1", "--dry-run", "--methods", "lga,gcbc_dart,fixture_constant", *PLUGIN,
                                "--shard", "2/2").stdout)

    def test_titles_change_no_cell(self):
        suite = json.loads((BUILD / "share/lgabench/suites/clutter.json").read_text())
        suite["id"], said = "mine", set()
        for title, arms in ("Clutter", suite["about"]["arm_titles"]), ("Crowds", {}):
            suite["about"] |= {"title": title, "arm_titles": arms}
            (self.dir / "mine.json").write_text(json.dumps(suite))
            said.add(self.call("run", "mine.json", "--dry-run").stdout)
        self.assertEqual(len(said), 1, "one directory, whose name holds the cells' keys")
        suite["about"]["arm_titles"] = {"near_4": 4}
        (self.dir / "mine.json").write_text(json.dumps(suite))
        self.assertIn("/about/arm_titles/near_4: expected a string", self.call("run", "mine.json", "--dry-run", expect=2).stderr)

    def test_count_what_is_there(self):
        said = self.call(*RUN, "--limit", "3", "--out", "out").stderr
        self.assertIn("3 cells to compute, 0 already computed: an unknown time with ", said)
        self.assertRegex(said, r"\n\[1/3\] fixture_constant heart .* \d+\.\d s; \d+:\d\d left\n")
        said = self.call(*RUN, "--limit", "3", "--out", "out", "--dry-run").stdout
        self.assertIn("out: 3 cells, 3 already computed, 0 to compute\n", said)
        shutil.rmtree(next((self.dir / "out/cells").iterdir()))
        before = sorted(self.dir.rglob("*"))
        said = self.call(*RUN, "--limit", "3", "--out", "out", "--dry-run").stdout
        self.assertRegex(said, r"out: 3 cells, 2 already computed, 1 to compute\n(.*\n)*fixture_constant +3 +2 +\d+ s  this run's cells\n")
        self.assertIn("3 to compute", self.call(*RUN, "--limit", "3", "--out", "out", "--dry-run", "--fresh").stdout)
        self.assertEqual(sorted(self.dir.rglob("*")), before)

    def test_a_long_run_says_so_first(self):
        process = self.start("run", "q1", "--methods", "gcbc_dart", "--jobs", "1", "--cache", "cache")
        first = process.stderr.readline()
        process.terminate()
        process.wait()
        self.assertRegex(first, r"^611 cells to compute, 0 already computed: about \d+ min with 1 worker; --dry-run shows it by row\n$")


class Resuming(Case):
    def test_finds_the_run_that_the_same_command_names(self):
        refused = self.call(*RUN, "--resume", expect=2).stderr
        self.assertIn("--resume: no run of this command is in runs; without --resume a new run of 4 cells begins", refused)
        self.assertFalse((self.dir / "runs").exists())

        self.call(*RUN)
        (run,) = (self.dir / "runs").iterdir()
        said = self.call(*RUN, "--resume").stderr
        self.assertIn(f"resuming the run in runs/{run.name}\n", said)
        self.assertIn("0 cells computed, 4 reused", said)

        # As another build leaves it: the same settings, another hash.
        other = run.rename(run.with_name(run.name[:-8] + "0" * 8))
        shutil.rmtree(next((other / "cells").iterdir()))
        said = self.call(*RUN, "--resume").stderr
        self.assertIn(f"resuming the run in runs/{other.name}\n", said)
        self.assertIn("1 cell to compute, 3 already computed: about ", said)
        self.assertEqual([p.name for p in (self.dir / "runs").iterdir()], [other.name])
        another = [word if word != "0:2" else "0:3" for word in RUN]
        self.assertIn("no run of this command", self.call(*another, "--resume", expect=2).stderr)


class Colour(Case):
    def on_a_terminal(self, *arguments, **environment):
        """What the program writes to a terminal, stdout and stderr together."""
        master, terminal = pty.openpty()
        process = subprocess.Popen(command_line(*arguments), stdin=terminal, stdout=terminal, stderr=terminal, cwd=self.dir,
                                   env={**self.environment, "TERM": "xterm", "NO_COLOR": "", **environment})
        os.close(terminal)
        written = b""
        while True:
            try:
                more = os.read(master, 65536)
            except OSError:  # the other end is closed
                break
            if not more:
                break
            written += more
        os.close(master)
        process.wait()
        return written.decode()

    def test_on_terminals_alone(self):
        self.assertTrue(self.on_a_terminal("lst").startswith("\x1b[31mlgabench:\x1b[0m unknown command"))
        for environment in {"NO_COLOR": "1"}, {"TERM": "dumb"}:
            self.assertNotIn("\x1b", self.on_a_terminal("lst", **environment))
        self.assertNotIn("\x1b", self.call("lst", expect=2).stderr)

    def test_of_marks_and_verdicts(self):
        self.call(*["10" if word == "2" else word for word in RUN if word != "--no-reference"], "--out", "out")
        table = self.call("report", "out").stdout
        self.assertIn("§", table)
        self.assertNotIn("\x1b", table)
        shown = self.on_a_terminal("report", "out")
        self.assertIn("\x1b[33m§\x1b[0m", shown)
        plain = re.sub(r"\x1b\[\d+m", "", shown).replace("\r\n", "\n")
        self.assertEqual(plain.split("\n")[:-2], table.split("\n")[:-1])
        self.assertIn("\x1b[32mgood\x1b[0m", self.on_a_terminal("check-plugin", FIXTURES / "good/fixture_constant.so"))


class CacheCommand(Case):
    def test_tells_the_size_and_clears_its_own_files(self):
        cache = self.dir / "cache"
        self.assertIn("cache: 0 files of demonstrations, 0 KB", self.call("cache").stdout)
        self.call(*RUN, "--out", "out")
        ours = list(cache.iterdir())
        size = sum(p.stat().st_size for p in ours)
        self.assertGreater(len(ours), 1)
        said = json.loads(self.call("cache", "--json").stdout)
        self.assertEqual(said, {"directory": str(cache), "files": len(ours), "bytes": size, "cleared": False})
        (cache / (ours[0].name + ".0123abcd.tmp")).write_text("cut off")
        (cache / "thesis.hdf5").write_text("kept")
        (cache / "notes.tmp").write_text("kept")
        (cache / ("0" * 32 + ".hdf5")).symlink_to(cache / "thesis.hdf5")
        done = self.call("cache", "clear")
        self.assertRegex(done.stdout, rf"cache: {len(ours) + 1} files of demonstrations, \d+ KB, removed\n")
        self.assertEqual(done.stderr, "3 other files in it: left alone\n")
        self.assertEqual(sorted(p.name for p in cache.iterdir()), ["0" * 32 + ".hdf5", "notes.tmp", "thesis.hdf5"])
        self.assertIn("no action \"claer\" (did you mean \"clear\"?)", self.call("cache", "claer", expect=2).stderr)
        self.assertIn("4 reused", self.call(*RUN, "--out", "out").stderr)

    def test_one_that_cannot_be_written_is_said_once(self):
        for words in (["--cache", "/proc/cache"], []):
            self.environment["LGABENCH_CACHE"] = "/proc/cache"
            said = self.call(*RUN, *words, "--fresh", "--out", "out").stderr
            self.assertEqual(said.count("/proc/cache: cannot be written: No such file or directory; each cell makes its "
                                        "demonstrations again\n"), 1, said)
        self.environment["LGABENCH_CACHE"] = str(self.dir / "cache")
        self.assertNotIn("cannot be written", self.call(*RUN, "--fresh", "--out", "out").stderr)

    def test_a_file_says_which_programs_made_it(self):
        """Another build of any of them makes its own."""
        self.call(*RUN, "--out", "out")
        seal = json.loads(next((self.dir / "cache").iterdir()).read_bytes().rsplit(b"\n", 2)[-2])
        build = json.loads(next((self.dir / "out/cells").glob("*/status.json")).read_text())["build"]
        programs = ("engine", "lgabench-worker", "liblgabench_core.so", "liblgabench_env_tabletop.so")
        self.assertEqual([name for name in build if "_env_" in name], ["liblgabench_env_tabletop.so"], "no other environment's")
        self.assertEqual(seal["made_from"]["builds"], {name: build[name] for name in programs})


class EncoderCommand(Case):
    def test_tells_whether_it_is_there(self):
        self.assertIn("all-MiniLM-L6-v2", self.call("encoder").stdout)
        self.environment["LGABENCH_ENCODER"] = str(self.dir / "none")
        self.assertIn("no model.safetensors; to fetch it: lgabench encoder fetch", self.call("encoder", expect=1).stdout)

    def test_fetches_what_is_missing_or_says_why_not(self):
        self.call("encoder", "fetch")  # at once: it is there
        self.environment.update(LGABENCH_ENCODER=str(self.dir / "none"), PIP_INDEX_URL="http://127.0.0.1:9/", PIP_RETRIES="0")
        said = self.call("encoder", "fetch", expect=3).stderr
        self.assertRegex(said, r"^fetching the sentence encoder, 90 MB, into .*\nthe sentence encoder could not be fetched: .*\n$")
        self.assertFalse((self.dir / "none").exists())


class Completion(Case):
    def completed(self, *words):
        """What bash offers for the last word."""
        line = "source $SCRIPT; compopt() { :; }; COMP_WORDS=(lgabench \"$@\"); COMP_CWORD=$#; _lgabench; printf '%s\\n' \"${COMPREPLY[@]}\""
        done = subprocess.run(["bash", "-uec", line, "bash", *words], capture_output=True, text=True, cwd=self.dir,
                              env={**self.environment, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}",
                                   "SCRIPT": str(PAGES / "lgabench.bash")})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()

    def test_of_commands_options_and_ids(self):
        self.assertEqual(self.completed("re"), ["render", "replay", "report", "rescore"])
        self.assertEqual(self.completed("run", "q1", "--dem"), ["--demos"])
        self.assertEqual(self.completed("run", "q1", "--scene"), ["--scene-seed"])
        self.assertEqual(self.completed("run", "fac"), ["factorial"])
        self.assertEqual(self.completed("run", "q1", "--methods", "lga,hu"), ["lga,human"])
        self.assertEqual(self.completed("run", "q1", "--scenarios", "red_"), ["red_heart"])
        self.assertEqual(self.completed("report", "out", "--format", ""), ["text", "md", "latex", "json", "csv"])
        self.assertIn("mujoco" if (BUILD / "lib/lgabench/plugins/mujoco.so").exists() else "kinematic",
                      self.completed("demos", "heart", "--engine", ""))
        self.assertEqual(self.completed("info", "human"), ["human"])
        self.assertEqual(self.completed("help", "a"), ["all", "answers", "attribute"])
        (self.dir / "runs").mkdir()
        self.assertEqual(self.completed("report", "ru"), ["runs"])
        for verb in VERBS:
            asked = "--help-all" if verb in ("run", "cluster") else "--help"
            listed = set(re.findall(r"(?:^|\s)(--[a-z-]+)", self.call(verb, asked).stdout.split("Usage")[1]))
            self.assertLessEqual(set(self.completed(verb, "--")) - {"--help"}, listed)

    def test_words_are_those_that_the_suite_takes(self):
        self.assertEqual(self.completed("run", "mobile", "--layout", ""), ["table"])
        self.assertEqual(self.completed("render", "bring_fruit", "--layout", ""), ["table"])
        self.assertNotIn("paper_text", self.completed("run", "mobile", "--preset", ""))
        self.assertNotIn("heart", self.completed("run", "mobile", "--scenarios", ""))
        for suite, option in (("mobile", "--layout"), ("mobile", "--preset"), ("q1", "--layout"), ("q1", "--preset"),
                              ("q1", "--answers"), ("mobile", "--scenarios"), ("q1", "--scenarios")):
            offered = self.completed("run", suite, option, "")
            self.assertTrue(offered, (suite, option))
            for word in some_of(offered):
                words = [option, word]
                if word == "openai":
                    words += ["--model", "m", "--cassette", self.dir / "cassette"]
                if option == "--scenarios":
                    words += ["--answers", "none"]  # an example was never asked about
                if option == "--answers" and word != "recorded":
                    words += ["--scenarios", "heart"]
                self.call("run", suite, *words, "--dry-run")
        self.assertEqual(self.completed("run", "q1", "--train-on", "sen"), ["sensor_noise"])
        self.assertEqual(self.completed("run", "perturbations", "--axes", "all,camera_t"), ["all,camera_turn"])
        self.assertEqual(self.completed("run", "clutter", "--arms", "near_4"), ["near_4"])
        self.assertEqual(self.completed("list", "lay"), ["layouts"])
        self.assertIn('no suite "q9"', self.call("list", "presets", "--of", "q9", expect=2).stderr)

    def test_scripts_are_well_formed(self):
        if shutil.which("shellcheck"):
            done = subprocess.run(["shellcheck", "-s", "bash", PAGES / "lgabench.bash"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (0, ""))
        fish = (PAGES / "lgabench.fish").read_text()
        for line in ("complete -c lgabench -n __fish_use_subcommand -xa open -d ", "complete -c lgabench -n 'test (_lgabench_word 2) = run' -l demos -d "):
            self.assertIn(f"\n{line}", fish)
        self.assertEqual([line for line in fish.splitlines() if re.sub(r"\\.", "", line).count("'") % 2 and not line.startswith((" ", "#", "_", "}"))], [])
        if shutil.which("fish"):
            done = subprocess.run(["fish", "--no-execute", PAGES / "lgabench.fish"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        if shutil.which("zsh"):
            done = subprocess.run(["zsh", "-n", PAGES / "_lgabench"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(verbosity=2)
