"""The fault campaign: whatever happens to a run, no finished result is lost or changed, the fault is named, and taking
the run up again gives the bytes of an undisturbed one.

LGABENCH_FULL=1 makes it longer. One CTest entry a class; by hand: python3 fault_test.py Killed
"""
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import time
import unittest

from case import BUILD, BesideOneRun, FIXTURES, NO_CLOCK, command_line, with_options

FULL = os.environ.get("LGABENCH_FULL") == "1"
# Tiny but real: one method that trains, one that does not, the reference rows.
RUN = ["run", "q1", "--scenarios", "heart", "--methods", "lga,fixture_constant", "--demos", "10", "--seeds", "0:2",
       "--episodes", "3", "--set", "lga.epochs=10", "--plugin-path", FIXTURES / "good"]
CELLS = 2 * 4 + 2
# Tinier: a cell takes a tenth of a second.
NO_TRAINING = ["run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--demos", "10", "--seeds", "0",
               "--episodes", "2", "--no-reference", "--plugin-path", FIXTURES / "good"]


class Faults(BesideOneRun):
    run_of_class = RUN

    def assert_as_undisturbed(self, run="out"):
        self.assert_same_results(self.first.dir / "run", run)
        left = [p.name for p in (self.dir / run).rglob("*") if p.name[0] == "." or p.suffix == ".tmp"]
        self.assertEqual(left, [])

    def finished(self, run="out"):
        """All bytes of the cells that are there and went well."""
        cells = self.dir / run / "cells"
        if not cells.exists():
            return {}
        good = [key for key, (_, status) in self.cells(run).items() if status["state"] == "ok"]
        return {f"{key}/{name}": (cells / key / name).read_bytes() for key in good for name in NO_CLOCK}

    @staticmethod
    def workers(parent):
        try:
            return [int(p) for p in pathlib.Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]
        except OSError:
            return []

    def first_worker(self, run):
        while not self.workers(run.pid):
            self.assertIsNone(run.poll())
            time.sleep(.001)
        return self.workers(run.pid)[0]

    def left_behind(self):
        """Processes of this test: their environment names its cache, or a method's its scratch directory."""
        marks, found = [f"LGABENCH_CACHE={self.dir}/cache".encode(), f"HOME={self.dir}/".encode()], []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (process / "environ").read_bytes()
                if any(mark in environment for mark in marks):
                    found.append(process.name)
            except OSError:
                pass
        return found

    def assert_nothing_left_behind(self):
        deadline = time.monotonic() + 10
        while self.left_behind():
            self.assertLess(time.monotonic(), deadline, "a process outlived its run")
            time.sleep(.01)


class FaultyPlugins(Faults):
    run_of_class = NO_TRAINING
    # (where, how) -> the reason that is given; None where the cell goes well, "" where its first episode fails.
    FAULTS = {
        ("act", "not"): None, ("act", "print"): None, ("act", "fork"): None,
        ("act", "fork_and_spin"): None, ("act", "thread"): None,
        # On the socket; and without it.
        ("act", "messages"): r"sent a malformed frame \(does it write to descriptor 3, where lgabench talks with it\?\): its first "
                             r"bytes are not those of a frame in phase evaluate",
        **{(where, how): rf"plugin fixture_faulty: closed descriptor 3, or put another file there: lgabench talks with it there, in phase {phase}"
           for where, how, phase in (("act", "close", "evaluate"), ("learn", "close", "learn"), ("act", "close_socket", "evaluate"),
                                     ("select", "replace_socket", "select"))},
        # What changes the process around lgabench's part of it changes no result.
        ("act", "chdir"): None, ("learn", "locale"): None, ("act", "locale"): None, ("act", "handlers"): None,
        ("act", "throw"): "", ("act", "throw_int"): "", ("act", "nan"): "",
        ("act", "abort"): r"signal 6 .*in phase evaluate", ("act", "segfault"): r"signal 11 .*in phase evaluate",
        ("act", "exit"): r"fixture_faulty: ended its own process by exit\(\): exited with 0 in phase evaluate",
        ("act", "quick_exit"): r"fixture_faulty: its process ended in the middle of a call: exited with 0 in phase evaluate",
        ("learn", "at_quick_exit"): r"ended its own process by quick_exit\(\): exited with 3 in phase learn",
        ("act", "noexcept"): r'"inside noexcept" was thrown where nothing may be \(.*\): signal 6 \(Aborted\) in phase evaluate',
        ("learn", "recursion"): r"its stack overflowed \(.*\): signal 11 \(Segmentation fault\) in phase learn",
        ("act", "kill"): r"fixture_faulty: signal 9 \(Killed\) in phase evaluate",
        ("act", "spin"): r"stopped after 8 s in phase evaluate: plugin fixture_faulty \(method\) did not answer$",
        ("act", "allocate"): r"plugin fixture_faulty \(method\): out of memory",
        ("learn", "throw"): r"plugin fixture_faulty: the fixture's own failure",
        ("learn", "throw_int"): r"plugin fixture_faulty: threw int", ("learn", "allocate"): r"out of memory",
        ("learn", "fork"): None, ("select", "fork"): None,
        ("learn", "quick_exit"): r"exited with 0 in phase learn",
        ("select", "throw_int"): r"plugin fixture_faulty: threw int",
        ("select", "segfault"): r"signal 11 .*in phase select",
        # What leaves a destructor ends the process, after all is done: the cell fails all the same.
        ("destroy", "throw"): r"signal 6 .*in phase evaluate", ("destroy", "not"): None,
    }

    def test_each_costs_its_own_cell_alone(self):
        methods = [f"fixture_faulty+where={where}+how={how}" for where, how in self.FAULTS]
        done = self.call(*NO_TRAINING, "--methods", ",".join(methods), "--plugin-path", FIXTURES / "faulty",
                         "--timeout", "8", "--memory", ".5", "--out", "out", expect=3)
        self.assert_nothing_left_behind()
        self.assert_matches_schemas("out")
        report = (self.dir / "out/report.md").read_text()
        summary = json.loads((self.dir / "out/summary.json").read_text())
        reported = {cell["cell"]: cell["reason"] for cell in summary["failed_cells"]}
        ended = {(cell["method"]["options"].get("where"), cell["method"]["options"].get("how")): (key, status)
                 for key, (cell, status) in self.cells("out").items()}
        good = (self.dir / "out/cells" / ended["act", "not"][0] / "episodes.jsonl").read_bytes()
        for fault, expected in self.FAULTS.items():
            key, status = ended[fault]
            files = {p.name for p in (self.dir / "out/cells" / key).iterdir()}
            with self.subTest(fault, status=status):
                if not expected:
                    self.assertEqual(status["state"], "ok")
                    self.assertEqual(files, {*NO_CLOCK, "timing.json", "status.json", "log.txt"})
                    episodes = (self.dir / "out/cells" / key / "episodes.jsonl").read_bytes()
                    first, rest = episodes.split(b"\n", 1)
                    self.assertEqual(rest, good.split(b"\n", 1)[1])
                    self.assertEqual(b"method_error" in first if expected == "" else episodes == good, True, episodes)
                else:
                    self.assertEqual((status["state"], status["fault"]), ("failed", "plugin"))
                    self.assertEqual(files, {"cell.json", "status.json", "log.txt"})
                    self.assertRegex(status["reason"], expected)
                    self.assertEqual(reported.pop(key), status["reason"])
                    self.assertIn(f"{status['reason']} (out/cells/{key}/log.txt)", done.stderr)
                    self.assertIn(status["reason"], report)
        self.assertEqual(reported, {})
        self.assertIn("the fixture prints", (self.dir / "out/cells" / ended["act", "print"][0] / "log.txt").read_text())
        # The neighbour among them is as it is alone.
        alone = self.finished(self.first.dir / "run")
        self.assertEqual({name: self.finished()[name] for name in alone}, alone)

        # The command that is printed computes what failed again, and nothing else.
        command = done.stderr.splitlines()[-1].strip()
        again = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=self.environment,
                               cwd=self.dir)
        self.assertEqual(again.returncode, 3, again.stderr)
        failed = sum(1 for expected in self.FAULTS.values() if expected)
        self.assertIn(f"0 cells computed, {1 + len(methods) - failed} reused, {failed} failed", again.stderr)


class Killed(Faults):
    def test_at_random_moments(self):
        moments, kills, runs = random.Random(5), {"parent": 0, "worker": 0, "method": 0}, 0
        while sum(kills.values()) < (200 if FULL else 6) or min(kills.values()) < (3 if FULL else 2):
            runs += 1
            self.assertLess(runs, 400 if FULL else 100, kills)
            out = f"out{runs}"
            self.environment["LGABENCH_CACHE"] = str(self.dir / f"cache/{runs}")
            for disturbances in range(moments.randint(3, 8)):
                before = self.finished(out)
                run = self.start(*RUN, "--jobs", "2", "--out", out)
                time.sleep(moments.choice([moments.uniform(0, .1), moments.uniform(.1, 1)]))
                victims = self.workers(run.pid)
                whom = moments.choice(["parent", "worker", "method"])
                if whom == "method":
                    victims = [child for worker in victims for child in self.workers(worker)]
                if run.poll() is None and (whom == "parent" or victims):
                    with contextlib.suppress(ProcessLookupError):  # it was done just then
                        os.kill(run.pid if whom == "parent" else moments.choice(victims), signal.SIGKILL)
                    kills[whom] += 1
                    if whom == "parent":
                        run.wait()
                        self.assert_nothing_left_behind()
                said = run.communicate(timeout=300)[1]
                self.assertIn(run.returncode, (0, 3, -9), said)
                after = self.finished(out)
                self.assertEqual({name: after.get(name) for name in before}, before, "a finished result is lost")
                if whom != "parent" and run.returncode == 3:
                    failed = [s for _, s in self.cells(out).values() if s["state"] == "failed"]
                    fault = "host" if whom == "worker" else "plugin"
                    self.assertEqual({(s["signal"], s["fault"]) for s in failed}, {(9, fault)})
                    self.assertIn("signal 9 (Killed)", (self.dir / out / "report.md").read_text())
                if run.returncode == 0:
                    break
            self.call(*RUN, "--out", out)
            self.assert_as_undisturbed(out)

    def test_while_causes_are_found(self):
        """All cells are scored by then: the run is a finished one, and goes on to the same bytes."""
        words = with_options(NO_TRAINING, "--methods", "fixture_keeper", "--plugin-path", FIXTURES / "faulty", "--seeds", "0:3",
                             "--jobs", "1", "--out")
        began = time.monotonic()
        self.call(*words, "whole")
        moments, lasts = random.Random(6), time.monotonic() - began
        for number in [signal.SIGINT, signal.SIGTERM] + (40 if FULL else 5) * [signal.SIGKILL]:
            shutil.rmtree(self.dir / "out", ignore_errors=True)
            run = self.start(*words, "out")
            for line in run.stderr:
                if line.startswith("finding the causes of failures of fixture_keeper: 3 cells, about "):
                    break
            self.first_worker(run)
            if number == signal.SIGKILL:
                time.sleep(moments.uniform(0, lasts))
            run.send_signal(number)
            said = run.communicate(timeout=60)[1]
            self.assertIn(run.returncode, (0, -9) if number == signal.SIGKILL else (130,), said)
            self.assert_nothing_left_behind()
            self.call("status", "out")
            self.call("report", "out")
            self.assert_matches_schemas("out")
            resume = [*command_line(*words, "out"), "--resume"]
            if number != signal.SIGKILL:
                self.assertIn("interrupted; all cells are scored, some causes of failures are not found. To find them:\n", said)
                resume = said.splitlines()[-1].split()
            done = subprocess.run(resume, capture_output=True, text=True, env=self.environment, cwd=self.dir, timeout=60)
            self.assertIn("0 cells computed, 3 reused, 0 failed", done.stderr)
            self.assert_same_results("whole", "out")
            self.assertEqual([path.name for path in (self.dir / "out").rglob(".*")], [])

    def interrupted(self, number, impatiently=False):
        run = self.start(*RUN, "--jobs", "2")
        self.first_worker(run)
        run.send_signal(number)
        while impatiently and run.poll() is None:
            run.send_signal(number)
        said = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, 130, said)
        self.assert_nothing_left_behind()
        command = said.splitlines()[-1].split()
        self.assertEqual(command[-1], "--resume")
        return command

    def test_interrupted_prints_the_command_that_resumes(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            command = self.interrupted(number)
        command = self.interrupted(signal.SIGINT, impatiently=True)
        subprocess.run(command, check=True, env=self.environment, cwd=self.dir, capture_output=True, timeout=300)
        shutil.move(self.dir / command[-2], self.dir / "out")
        self.assert_as_undisturbed()

    def test_two_runs_cannot_write_into_one_directory(self):
        run = self.start(*RUN, "--out", "out")
        self.first_worker(run)
        self.assertIn("another run is writing into it", self.call(*RUN, "--out", "out", expect=2).stderr)
        self.assertIn("a run is writing into it", self.call("merge", "other", "out", expect=2).stderr)
        run.kill()
        run.wait()

    def test_before_its_first_file_is_whole(self):
        for left in ("run.json.1.tmp", "run.json.0000002a.tmp"):
            (self.dir / "out").mkdir(exist_ok=True)
            (self.dir / "out" / left).write_text('{"suite": ')
        self.call(*RUN, "--out", "out")
        self.assert_as_undisturbed()


class Stopped(Faults):
    run_of_class = [*NO_TRAINING, "--seeds", "1,2"]

    def test_a_worker_meets_its_time_limit(self):
        run = self.start(*self.run_of_class, "--jobs", "2", "--timeout", "6", "--out", "out")
        os.kill(self.first_worker(run), signal.SIGSTOP)
        said = run.communicate(timeout=120)[1]
        self.assertEqual(run.returncode, 3, said)
        failed = [status["reason"] for _, status in self.cells("out").values() if status["state"] == "failed"]
        self.assertEqual(len(failed), 1)
        self.assertRegex(failed[0], r"stopped after 6 s")
        self.call(*self.run_of_class, "--out", "out")
        self.assert_as_undisturbed()

    def test_a_methods_process_that_is_stopped_fails_its_own_cell(self):
        moments = random.Random(7)
        for attempt in range(3):
            out = f"stopped{attempt}"
            failed = []
            while not failed:  # the moment may lie between two cells
                shutil.rmtree(self.dir / out, ignore_errors=True)
                run = self.start(*self.run_of_class, "--jobs", "1", "--timeout", "4", "--out", out)
                time.sleep(moments.uniform(.05, .6))
                for host in [child for worker in self.workers(run.pid) for child in self.workers(worker)]:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(host, signal.SIGSTOP)
                said = run.communicate(timeout=120)[1]
                self.assertIn(run.returncode, (0, 3), said)
                failed = [status for _, status in self.cells(out).values() if status["state"] == "failed"]
            self.assertEqual([status["fault"] for status in failed], ["plugin"])
            self.assertRegex(failed[0]["reason"], r"stopped after 4 s")
            self.assert_nothing_left_behind()
            self.call(*self.run_of_class, "--out", out)
            self.assert_as_undisturbed(out)

    def test_the_whole_run_loses_nothing(self):
        # As a batch system suspends it, for longer than the time limit.
        run = self.start(*self.run_of_class, "--jobs", "2", "--timeout", "6", "--out", "out")
        self.first_worker(run)
        stopped = [run.pid, *self.workers(run.pid)]
        for number, pause in ((signal.SIGSTOP, 7), (signal.SIGCONT, 0)):
            for pid in stopped:
                os.kill(pid, number)
            time.sleep(pause)
        said = run.communicate(timeout=120)[1]
        self.assertEqual(run.returncode, 0, said)
        self.assert_as_undisturbed()


class FullDisk(Faults):
    run_of_class = NO_TRAINING

    def with_full_disk_at(self, number, stays):
        count = self.dir / "count"
        count.write_bytes(struct.pack("i", 0))
        more = {"LD_PRELOAD": str(BUILD / "tests/full_disk.so"), "FULL_DISK_UNDER": str(self.dir / "disk"),
                "FULL_DISK_COUNT": str(count), "FULL_DISK_AT": str(number)}
        if stays:
            more["FULL_DISK_STAYS"] = "1"
        done = subprocess.run(command_line(*NO_TRAINING, "--cache", "disk/cache", "--out", "disk/out"),
                              timeout=60, capture_output=True, text=True, cwd=self.dir,
                              env={**self.environment, **more})
        return done, struct.unpack("i", count.read_bytes())[0]

    def test_too_little_space_is_said_before_the_first_cell(self):
        self.environment.update(LD_PRELOAD=str(BUILD / "tests/full_disk.so"), FULL_DISK_FREE=str(1 << 40))
        self.assertNotIn("of disk", self.call(*NO_TRAINING, "--fresh", "--out", "out").stderr)
        self.environment["FULL_DISK_FREE"] = "10000"
        said = self.call(*NO_TRAINING, "--fresh", "--out", "out").stderr
        self.assertRegex(said, r"(?s)out: the cells need about [\d.]+ KB of disk, and 8 KB are free\n.*1 cells computed")

    def test_at_every_write(self):
        done, writes = self.with_full_disk_at(0, False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(writes, 20)
        self.assert_as_undisturbed("disk/out")
        for number in range(1, writes + 1, 1 if FULL else 2):
            for stays in ((False, True) if FULL else (number % 4 == 1,)):
                with self.subTest(number, stays=stays):
                    shutil.rmtree(self.dir / "disk")
                    done, _ = self.with_full_disk_at(number, stays)
                    self.assertIn(done.returncode, (0, 2, 3), done.stderr)
                    logs = "".join(p.read_text() for p in (self.dir / "disk/out").glob("cells/*/log.txt"))
                    said = logs if done.returncode == 0 else done.stderr  # a cache that is full costs no cell
                    self.assertRegex(said, r"disk/\S+: cannot be (written( to disk)?|synced): No space left")
                    self.assertEqual([p for p in (self.dir / "disk/cache").rglob("*.tmp")], [])
                    before = self.finished("disk/out")
                    said = self.call(*NO_TRAINING, "--cache", "disk/cache", "--out", "disk/out").stderr
                    self.assertEqual({**self.finished("disk/out"), **before}, self.finished("disk/out"))
                    if before:
                        self.assertIn("0 cells computed, 1 reused", said)
                    self.assert_as_undisturbed("disk/out")


class TornFiles(Faults):
    run_of_class = NO_TRAINING

    def test_every_kind_is_computed_again(self):
        self.copy_first("out")
        cell = next((self.dir / "out/cells").iterdir())
        for file in sorted(cell.iterdir()):
            if file.name == "log.txt":  # no result: anyone may add to it
                continue
            whole = file.read_bytes()
            middle = len(whole) // 2
            for damage, torn in {"truncated": whole[:middle], "empty": b"", "edited": whole.replace(b":", b";", 1),
                                 "longer": whole + b"{}\n", "zeros": bytes(len(whole)), "missing": None}.items():
                with self.subTest(file=file.name, damage=damage):
                    file.unlink() if torn is None else file.write_bytes(torn)
                    said = self.call(*NO_TRAINING, "--out", "out").stderr
                    self.assertRegex(said, rf"{file.name}.*; computed again")
                    self.assertIn("1 cells computed, 0 reused", said)
                    self.assert_as_undisturbed()

    def test_a_status_that_says_less(self):
        for change in ({"files": {}}, {"files": 3}, {"files": {"a": 1}}, {"state": 1}, {"state": "failed"},
                       {"build": 5}):
            with self.subTest(change):
                self.copy_first("out")
                file = next((self.dir / "out/cells").glob("*/status.json"))
                file.write_text(json.dumps({**json.loads(file.read_text()), **change}))
                said = self.call(*NO_TRAINING, "--out", "out", "--resume").stderr
                self.assertRegex(said, r"status.json: .*computed again|(?:computed by another build|failed: ).*computed again")
                self.assert_as_undisturbed()

    def test_a_run_without_its_record(self):
        """The cells are there: the command that computed them takes them up again, and no other does."""
        self.copy_first("out")
        record = self.dir / "out/run.json"
        before = json.loads(record.read_text())
        record.unlink()
        for words in (NO_TRAINING, [*NO_TRAINING, "--fresh"], [*with_options(NO_TRAINING, "--episodes", "3"), "--resume"]):
            self.assertRegex(self.call(*words, "--out", "out", expect=2).stderr, "out: cells without their run.json; repeat the "
                             "command that computed them, with --resume, to write it\n$")
            self.assertFalse(record.exists())
        said = self.call(*NO_TRAINING, "--out", "out", "--resume").stderr
        self.assertIn("0 cells computed, 1 reused, 0 failed", said)
        self.assert_as_undisturbed()
        again = json.loads(record.read_text())
        self.assertEqual(again["confinement"], "none, by --unconfined")  # nothing says what it was
        own = ("command", "started", "confinement")
        self.assertEqual(*({name: value for name, value in run.items() if name not in own} for run in (before, again)))

    def test_a_cell_in_anothers_place(self):
        seeds = [*NO_TRAINING, "--seeds", "1", "--out", "out"]
        self.call(*seeds)
        before = self.results("out")
        one, other = sorted((self.dir / "out/cells").iterdir())
        shutil.rmtree(one)
        shutil.copytree(other, one)
        self.assertRegex(self.call(*seeds).stderr, rf"{one.name}/cell.json changed since it was written.*computed again")
        self.assertEqual(self.results("out"), before)


class NoReport(Faults):
    run_of_class = NO_TRAINING

    def test_the_counts_are_told_all_the_same(self):
        """The worker draws pictures that no report can be made with."""
        (self.dir / "bin").mkdir()
        for part in "lib", "share", "bin/lgabench-method":
            (self.dir / part).symlink_to(BUILD / part)
        shutil.copy(BUILD / "bin/lgabench", self.dir / "bin")
        worker = self.dir / "bin/lgabench-worker"
        worker.write_text("#!/bin/sh\n[ $1 != pictures ] || exec echo '{\"picture\": 0}'\n"
                          f'exec "{BUILD}/bin/lgabench-worker" "$@"\n')
        worker.chmod(0o755)
        words = [self.dir / "bin/lgabench", *command_line(*NO_TRAINING, "--out", "out")[1:]]
        done = subprocess.run(words, capture_output=True, text=True, env=self.environment, cwd=self.dir, timeout=60)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, r"(?s)\n1 cells computed, 0 reused, 0 failed\n.*\nno report: ")
        done = subprocess.run([words[0], "merge", "merged", "out"], capture_output=True, text=True, env=self.environment,
                              cwd=self.dir, timeout=60)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("1 cells finished, 0 failed, 0 left out, 0 in none of the runs\n", done.stderr)


class SharedCache(Faults):
    def test_two_runs_fill_it_at_once(self):
        runs = [self.start(*RUN, "--jobs", "2", "--out", out) for out in ("a", "b")]
        for run in runs:
            said = run.communicate(timeout=300)[1]
            self.assertEqual(run.returncode, 0, said)
            self.assertNotIn("made again", said)
        for out in ("a", "b"):
            self.assert_as_undisturbed(out)
        filled, wanted = ({p.name: p.read_bytes() for p in (case.dir / "cache").iterdir()}
                          for case in (self, self.first))
        self.assertEqual(filled, wanted)


if __name__ == "__main__":
    unittest.main(verbosity=2)
