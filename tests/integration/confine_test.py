"""A method's process reaches nothing but what it is given: each part of docs/trust.md, tried from inside.

One CTest entry a class; a part that the kernel lacks is skipped by its name.
"""
import json
import os
import pathlib
import shutil
import socket
import unittest

from case import BUILD, Case, FIXTURES, with_options

RUN = ["run", "q1", "--scenarios", "heart", "--demos", "10", "--seeds", "0", "--episodes", "2", "--no-reference"]
IN_CI = os.environ.get("CI") == "true"


READS_A_KEY = """
import pathlib


class Probe:
    def select(self, command, space, services):
        (pathlib.Path(__file__).parent / ".ssh/id_rsa").read_text()
"""


class Confinement(Case):
    maxDiff = None

    def probes(self, words, *more, out="out", expect=3, fixture="fixture_probe",
               plugins=FIXTURES / "faulty"):
        """how, or how+path=... -> what came of it."""
        methods = ",".join(f"{fixture}+how={word}" for word in words)
        self.call(*RUN, "--plugin-path", plugins, "--methods", methods, "--out", out, *more, expect=expect)
        found = {}
        for _, (cell, status) in self.cells(out).items():
            options = cell["method"]["options"]
            found[options["how"], options["path"]] = status.get("reason", status["state"]).rpartition(": ")[2]
        self.parts = json.loads((self.dir / out / "run.json").read_text())["confinement"]
        return found

    def need(self, part):
        if part not in self.parts:
            (self.fail if IN_CI else self.skipTest)(f"this kernel has no {part}: {self.parts}")

    def test_files(self):
        share = BUILD / "share/lgabench"
        hidden = [share / "scenarios/heart.json", share / "answers/claude.json", share / "suites/q1.json",
                  self.dir / "out/run.json", pathlib.Path("/etc/passwd"), pathlib.Path("/root")]
        # Of itself not what it has in common with others: the network, and pages.
        hidden += [pathlib.Path("/proc/self", name) for name in ("net/unix", "net/sockstat", "smaps", "pagemap", "numa_maps")]
        hidden += [pathlib.Path("/proc/thread-self", name) for name in ("net/unix", "smaps")]
        readable = [share / "spaces/tabletop.json", FIXTURES / "faulty/fixture_probe.so"]
        readable += [pathlib.Path("/proc/self", name) for name in ("maps", "status", "stat", "cmdline", "fd", "task")]
        words = [f"read+path={path}" for path in hidden + readable] + [f"write+path={self.dir}/x", f"list+path={self.dir}"]
        found = self.probes(words)
        self.need("Landlock")
        for path in hidden:
            self.assertEqual(found["read", str(path)], "EACCES", path)
        for path in readable:
            self.assertEqual(found["read", str(path)], "reached", path)
        self.assertEqual((found["write", f"{self.dir}/x"], found["list", str(self.dir)]), ("EACCES", "EACCES"))

    def test_files_where_the_run_lies_beside_the_plugin(self):
        shutil.copytree(FIXTURES / "faulty", self.dir / "mine")
        found = self.probes([f"read+path={self.dir}/mine/out/run.json", f"read+path={self.dir}/mine/fixture_probe.so"],
                            out="mine/out", plugins="mine")
        self.need("Landlock")
        self.assertEqual(found["read", f"{self.dir}/mine/out/run.json"], "EACCES")
        self.assertEqual(found["read", f"{self.dir}/mine/fixture_probe.so"], "reached")

    def test_earlier_runs_and_caches_beside_the_plugin(self):
        shutil.copytree(FIXTURES / "faulty", self.dir / "mine")
        self.environment["LGABENCH_CACHE"] = str(self.dir / "mine/cache")
        self.probes(["own_files"], out="mine/runs/first", plugins="mine", expect=0)
        cell = next((self.dir / "mine/runs/first/cells").iterdir())
        hidden = [self.dir / "mine/runs/first/run.json", cell / "cell.json", cell / "episodes.jsonl",
                  next((self.dir / "mine/cache").glob("*.hdf5"))]
        (self.dir / "mine/runs/notes.txt").write_text("the author's")
        readable = [self.dir / "mine/runs/notes.txt", self.dir / "mine/fixture_probe.so"]
        self.environment["LGABENCH_CACHE"] = str(self.dir / "cache")
        found = self.probes([f"read+path={path}" for path in hidden + readable], out="mine/runs/second", plugins="mine")
        self.need("Landlock")
        self.assertEqual([found["read", str(path)] for path in hidden], ["EACCES"] * len(hidden))
        self.assertEqual([found["read", str(path)] for path in readable], ["reached"] * len(readable))

    def test_keys_that_lie_beside_the_plugin(self):
        """As in a home, where somebody keeps a stranger's plugin: names with a dot are hidden, and the user is warned."""
        shutil.copytree(FIXTURES / "faulty", self.dir / "mine")
        hidden = [self.dir / "mine" / name for name in (".ssh/id_rsa", ".netrc")]
        readable = [self.dir / "mine" / name for name in ("notes.txt", "lib/.libs/data")]
        for file in hidden + readable:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("k")
        self.environment["HOME"] = str(self.dir / "mine")
        found = self.probes([f"read+path={path}" for path in hidden + readable] + [f"list+path={self.dir}/mine"], plugins="mine")
        self.need("Landlock")
        self.assertEqual([found["read", str(path)] for path in hidden], ["EACCES"] * len(hidden))
        self.assertEqual([found["read", str(path)] for path in readable], ["reached"] * len(readable))
        self.assertEqual(found["list", f"{self.dir}/mine"], "reached")  # where Python looks for modules
        (self.dir / "mine/probe.py").write_text(READS_A_KEY)
        said = self.call("check-plugin", "mine/probe.py:Probe", "--python", "/usr/bin/python3", expect=1)
        self.assertIn("PermissionError", said.stdout)
        self.assertIn("your home directory is this folder", said.stderr)
        shutil.copytree(self.dir / "mine", self.dir / "above/mine/home")  # a home below the plugin's folder
        shutil.copytree(FIXTURES / "faulty", self.dir / "above/mine", dirs_exist_ok=True)
        self.environment["HOME"] = str(self.dir / "above/mine/home")
        key, notes = (f"{self.dir}/above/mine/home/{name}" for name in (".ssh/id_rsa", "notes.txt"))
        found = self.probes([f"read+path={key}", f"read+path={notes}"], plugins="above/mine", out="below")
        self.assertEqual((found["read", key], found["read", notes]), ("EACCES", "reached"))
        self.environment["HOME"] = str(self.dir)
        self.assertNotIn("home", self.call("check-plugin", "mine/probe.py:Probe", "--python", "/usr/bin/python3", expect=1).stderr)

    def test_files_where_the_data_lies_beside_the_plugin(self):
        """As in a virtual environment that holds lgabench: its interpreter must list the directories above the data."""
        shutil.copytree(FIXTURES / "faulty", self.dir / "mine")
        shutil.copytree(BUILD / "share/lgabench", self.dir / "mine/share/data", ignore=shutil.ignore_patterns("encoder"))
        self.environment["LGABENCH_DATA"] = str(self.dir / "mine/share/data")
        found = self.probes([f"read+path={self.dir}/mine/share/data/scenarios/heart.json", f"list+path={self.dir}/mine",
                             f"list+path={self.dir}/mine/share"], plugins="mine")
        self.need("Landlock")
        self.assertEqual(found["read", f"{self.dir}/mine/share/data/scenarios/heart.json"], "EACCES")
        for path in f"{self.dir}/mine", f"{self.dir}/mine/share":
            self.assertEqual(found["list", path], "reached")

    def test_system_calls(self):
        words = ["socket", "unix_socket", "ptrace", "kill", "kill_all", "prlimit", "memory_of_worker", "memfd",
                 "socketpair", "raise"]
        found = self.probes(words)
        self.need(", seccomp")
        for word in words[:-2]:
            self.assertEqual(found[word, ""], "EPERM", word)
        for word in words[-2:]:
            self.assertEqual(found[word, ""], "reached", word)

    # What each answers where it is not EPERM: newer than the list, or needed.
    OTHER = {"clone3": "ENOSYS", "unknown": "ENOSYS", "fchmodat2": "ENOSYS", "setxattrat": "ENOSYS",
             "sched_getaffinity": "ENOSYS",
             **dict.fromkeys(["thread", "thread_attributes", "asks_of_itself", "own_memory", "program"], "reached")}
    CALLS = ["setxattr", "getxattr", "fsetxattr", "utimensat", "utime", "chmod", "fchmod", "chown", "fchownat", "lock",
             "read_lock", "lease", "set_flags", "mincore", "page_out", "fadvise", "readahead", "preadv2", "inotify", "fanotify",
             "notify", "set_owner", "set_signal", "setpriority", "sched_setaffinity", "sched_setscheduler", "ioprio_set",
             "getpgid", "getsid", "setpgid", "getpriority", "users_priority", "ioprio_get", "groups_ioprio", "sched_getparam",
             "sched_getscheduler", "sched_getattr", "sched_rr_get_interval", "get_robust_list", "capget", "clock_gettime", "mbind",
             "datagrams", "named_socket", "pipe_size", "new_namespace", "device", "fspick", "quotactl", "acct",
             "setdomainname", "swapoff", "clock_adjtime", *OTHER]
    # The call's own name, where it is another.
    NAMES = {"lock": "flock", "page_out": "madvise", "fadvise": "fadvise64", "inotify": "inotify_init1", "device": "mknodat",
             "datagrams": "socketpair", "named_socket": "bind", "new_namespace": "clone", "set_flags": "ioctl",
             "users_priority": "getpriority", "groups_ioprio": "ioprio_get",
             "fanotify": "fanotify_init", **dict.fromkeys(["read_lock", "lease", "notify", "set_owner", "set_signal",
                                                           "pipe_size"], "fcntl")}

    def test_system_calls_are_those_of_a_list(self):
        shutil.copytree(FIXTURES / "faulty", self.dir / "mine")
        (self.dir / "mine/file").write_text("x" * 4096)
        found = self.probes([f"{word}+path={self.dir}/mine/file" for word in self.CALLS], plugins="mine", fixture="fixture_probe",
                            expect=3)
        self.need(", seccomp")
        self.assertEqual({word: said for (word, _), said in found.items()},
                         {word: self.OTHER.get(word, "EPERM") for word in self.CALLS})
        for key, (cell, _) in self.cells("out").items():
            how = cell["method"]["options"]["how"]
            log = (self.dir / "out/cells" / key / "log.txt").read_text()
            named = [line.rpartition(": ")[2] for line in log.splitlines() if line.startswith("system call refused: ")]
            self.assertEqual(named, [] if how in self.OTHER else [self.NAMES.get(how, how)], how)
        said = self.call("check-plugin", "mine/fixture_probe.so", "--set", "how=chmod", "--set", "path=mine/file", expect=1)
        self.assertIn("refused: chmod", said.stdout)
        self.assertIn("none refused", self.call("check-plugin", FIXTURES / "good/fixture_constant.so").stdout)

    def test_the_network_for_a_method_that_declares_it(self):
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        port = f":{server.getsockname()[1]}"
        refused = ["unix_socket", "packet_socket", "netlink_socket", "ptrace", "kill"]
        files = [path for path in ("/etc/resolv.conf", "/etc/hosts", "/etc/ssl/certs") if os.path.exists(path)]
        words = [f"connect+path={port}", "socket6", *refused, *(f"read+path={path}" for path in files)]
        declared = self.probes([*words, "read+path=/etc/passwd", "own_files"], out="declared", fixture="fixture_probe_network")
        self.need(", seccomp")
        self.assertEqual((declared["connect", port], declared["socket6", ""]), ("reached", "reached"))
        for word in refused:
            self.assertEqual(declared[word, ""], "EPERM", word)
        undeclared = self.probes(words, out="undeclared")
        for word in (("connect", port), ("socket6", "")):
            self.assertEqual(undeclared[word], "EPERM", word)
        if "Landlock" in self.parts:
            self.assertEqual(declared["read", "/etc/passwd"], "EACCES")
            for path in files:
                self.assertEqual((declared["read", path], undeclared["read", path]), ("reached", "EACCES"), path)

        table = self.call("report", "declared").stdout
        self.assertIn("]¶", table.replace("†", "").replace("§", ""))
        self.assertIn("¶ reached the network on its own", table)
        self.assertNotIn("¶", self.call("report", "undeclared", expect=3).stdout)  # all its cells failed
        record = json.loads((self.dir / "declared/run.json").read_text())
        self.assertEqual({p["id"]: p.get("asks") for p in record["plugins"]},
                         {"fixture_probe_network": "network", os.environ["LGABENCH_TEST_ENGINE"]: None})
        self.assert_matches_schemas("declared")

    def test_the_encoder_that_a_variable_names(self):
        (self.dir / "encoder").mkdir()
        (self.dir / "encoder/vocab.txt").write_text("heart")
        self.environment["LGABENCH_ENCODER"] = str(self.dir / "encoder")
        found = self.probes([f"read+path={self.dir}/encoder/vocab.txt", "environment"])
        self.assertEqual(found["read", f"{self.dir}/encoder/vocab.txt"], "reached")
        self.assertIn("LGABENCH_ENCODER", found["environment", ""])

    def test_what_it_inherits(self):
        os.environ["A_SECRET"] = "x"
        self.addCleanup(os.environ.pop, "A_SECRET")
        self.environment["A_SECRET"] = "x"
        found = self.probes(["descriptors", "environment", "stdin"])
        self.assertEqual(found["descriptors", ""].split(), ["0", "1", "2", "3"])
        self.assertNotIn("A_SECRET", found["environment", ""])
        self.assertIn("HOME", found["environment", ""])
        self.assertEqual(found["stdin", ""], "ENODATA")

    def test_who_may_be_asked(self):
        found = self.probes(["human", "truth"])
        for word in ("human", "truth"):
            self.assertNotIn("heart", found[word, ""].split(), word)

    def test_nothing_survives(self):
        self.probes(["daemon"], expect=0)
        mark = f"HOME={self.dir}/".encode()
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                self.assertNotIn(mark, (process / "environ").read_bytes(), process)
            except OSError:
                pass

    def test_shared_memory_counts(self):
        found = self.probes(["shared_memory", "page_tables"], "--memory", "1")
        for word in "shared_memory", "page_tables":
            self.assertIn("out of memory", found[word, ""], word)

    def test_files_and_pipes_are_bounded(self):
        found = self.probes(["disk", "deleted", "many_files", "pipes"], "--memory", ".5")
        self.assertIn("its files in its scratch directory took more than 0.5 GiB", found["disk", ""])
        self.assertIn("its files in its scratch directory took more than 0.5 GiB", found["deleted", ""])
        self.assertIn("it made more than 10000 files", found["many_files", ""])
        self.assertRegex(found["pipes", ""], "out of memory|no more descriptors")
        self.assertEqual([*self.dir.glob("lgabench-*")], [])

    def test_a_tree_that_is_left_is_removed(self):
        self.probes(["tree"], expect=0)
        self.assertEqual([*self.dir.glob("lgabench-*")], [])
        cell = next((self.dir / "out/cells").iterdir())
        self.assertEqual(len([*(cell / "files").iterdir()]), 100)

    def test_files_of_its_own_are_kept(self):
        self.probes(["own_files"], expect=0)
        cell = next((self.dir / "out/cells").iterdir())
        self.assertEqual((cell / "files/curve.txt").read_text(), "a curve")
        self.assertEqual([p.name for p in (cell / "files").iterdir()], ["curve.txt"])
        self.call("merge", "merged", "out")
        self.assertEqual((self.dir / "merged/cells" / cell.name / "files/curve.txt").read_text(), "a curve")

    def test_unconfined_is_said(self):
        found = self.probes([f"read+path={BUILD}/share/lgabench/scenarios/heart.json"], "--unconfined")
        self.assertEqual(list(found.values()), ["reached"])
        self.assertEqual(self.parts, "none, by --unconfined")

    def test_a_run_with_one_unconfined_cell_is_unconfined(self):
        def confinement(run):
            return json.loads((self.dir / run / "run.json").read_text())["confinement"]

        def play(out, *words):
            self.call(*with_options(RUN, "--seeds", "0:2"), "--plugin-path", FIXTURES / "good", "--methods", "fixture_constant",
                      "--out", out, *words)
        play("out")
        kept = confinement("out")
        self.assertNotRegex(kept, "^none")
        play("out", "--unconfined")  # computes nothing
        self.assertEqual(confinement("out"), kept)
        shutil.copytree(self.dir / "out", self.dir / "confined")
        shutil.rmtree(next((self.dir / "out/cells").iterdir()))
        play("out", "--unconfined")
        self.assertEqual(confinement("out"), "none, by --unconfined")
        # Taken up with another build: the cell stays, and what is said of it.
        run = json.loads((self.dir / "out/run.json").read_text())
        run["build"]["lgabench-worker"] = "0" * 64
        (self.dir / "out/run.json").write_text(json.dumps(run))
        play("out", "--resume")
        self.assertNotIn("0" * 64, (self.dir / "out/run.json").read_text())
        self.assertEqual(confinement("out"), "none, by --unconfined")
        self.call("merge", "merged", "confined")
        self.assertEqual(confinement("merged"), kept)
        for parts in (["confined", "out"], ["confined"]):  # into the earlier merge's directory, whose cells stay
            self.call("merge", "merged", *parts)
            self.assertEqual(confinement("merged"), "none, by --unconfined")
        play("out", "--fresh")
        self.assertEqual(confinement("out"), kept)


if __name__ == "__main__":
    unittest.main(verbosity=2)
