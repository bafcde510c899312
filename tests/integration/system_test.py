"""A system that refuses: locks, threads, directories, descriptors, signals. Each is named with its cause and a way on, or costs
nothing.

LGABENCH_BUILD names the build tree. One CTest entry a class; by hand: python3 system_test.py Refusing
"""
import errno
import os
import resource
import signal
import subprocess
import time
import unittest

from case import BUILD, BesideOneRun, FIXTURES, command_line, with_options

RUN = ["run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--demos", "10", "--seeds", "0:4", "--episodes", "2",
       "--no-reference", "--plugin-path", FIXTURES / "good"]
NO_LOCKS = r"cannot be locked: this file system has no locks \(No locks available\); take another directory, or set LGABENCH_NO_LOCKS=1"


class Refusing(BesideOneRun):
    run_of_class = RUN

    def refuse(self, calls, number):
        self.environment.update(LD_PRELOAD=str(BUILD / "tests/refusing.so"), REFUSED=calls, REFUSED_WITH=str(number))

    def test_a_file_system_without_locks_is_no_other_run(self):
        self.copy_first("done")
        self.refuse("flock", errno.ENOLCK)
        self.assertRegex(self.call(*RUN, "--out", "out", expect=2).stderr, "out: " + NO_LOCKS)
        self.assertRegex(self.call("merge", "whole", "done", expect=2).stderr, NO_LOCKS)
        self.assertRegex(self.call("select", "Bring me the heart.", "--answers", "openai", "--model", "m", "--cassette", "c.jsonl",
                                   expect=2).stderr, NO_LOCKS)
        (self.dir / "board").mkdir()
        self.assertRegex(self.call("leaderboard", "build", "--board", "board", expect=2).stderr, "board/entries: " + NO_LOCKS)
        self.environment["LGABENCH_NO_LOCKS"] = "1"
        self.call("leaderboard", "build", "--board", "board")
        self.call(*RUN, "--out", "out")
        self.assert_same_results(self.first.dir / "run", "out")

    def test_a_directory_for_temporary_files_that_is_not_there(self):
        self.environment["TMPDIR"] = "/not/on/this/node"
        said = self.call("check-plugin", FIXTURES / "good/fixture_constant.so", expect=2).stderr
        self.assertEqual(said, "lgabench: TMPDIR=/not/on/this/node: No such file or directory; set TMPDIR to a directory for temporary files\n")

    def test_a_variable_that_names_no_directory(self):
        for variable, words in (("LGABENCH_DATA", ("list", "suites")), ("LGABENCH_SCENARIO_PATH", ("list", "scenarios")),
                                ("LGABENCH_SCENARIO_PATH", ("run", "q1", "--dry-run"))):
            with self.subTest(variable=variable, words=words):
                self.environment[variable] = "/not/on/this/node"
                said = self.call(*words, expect=2).stderr
                self.assertRegex(said, rf"^lgabench: {variable}=/not/on/this/node: No such file or directory\n$")
                del self.environment[variable]

    def test_cores_are_those_of_the_job(self):
        one = {min(os.sched_getaffinity(0))}
        done = self.call(*RUN, "--dry-run", preexec_fn=lambda: os.sched_setaffinity(0, one))
        self.assertRegex(done.stdout + done.stderr, r" with 1 worker\b")
        self.environment.update(SLURM_JOB_ID="1", SLURM_CPUS_ON_NODE="1")
        done = self.call(*RUN, "--dry-run")
        self.assertRegex(done.stdout + done.stderr, r" with 1 worker\b")

    def test_without_threads_the_report_is_the_same(self):
        """A worker has none itself, but those of the library that draws."""
        self.copy_first("out")
        self.refuse("pthread_create", errno.EAGAIN)
        self.call("report", "out")
        self.assert_same_results(self.first.dir / "run", "out")
        self.assertRegex(self.call("open", ".", expect=2).stderr,
                         "thread.* cannot? be started.*: Resource temporarily unavailable; raise the limit of processes and threads")

    def test_a_link_to_nowhere(self):
        (self.dir / "link").symlink_to("nowhere")
        for words in ([*RUN, "--out", "link"], ["demos", "heart", "--out", "link/demos.hdf5"],
                      ["study", "new", "link/study"]):
            with self.subTest(words=words[0]):
                self.assertIn("link is a symbolic link to nowhere, which is not there", self.call(*words, expect=2).stderr)
        self.environment["LGABENCH_CACHE"] = str(self.dir / "link")
        self.assertIn("link is a symbolic link to nowhere, which is not there; each cell makes its", self.call(*RUN, "--out", "out").stderr)

    def test_a_directory_that_is_gone(self):
        gone = self.dir / "gone"
        gone.mkdir()
        done = subprocess.run(["sh", "-c", 'rmdir "$PWD"; exec "$@"', "sh", *map(str, command_line(*RUN))], cwd=gone, capture_output=True,
                              text=True, env=self.environment)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, "^lgabench: runs/.*: cannot be made: the current directory is gone\n$")

    def test_few_descriptors_are_fewer_cells_at_once(self):
        few = 15
        said = self.call(*with_options(RUN, "--seeds", "0:10"), "--jobs", "10", "--out", "out",
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (few, few))).stderr
        self.assertIn("10 cells computed, 0 reused, 0 failed", said)

    def test_a_file_over_the_limit_is_an_error(self):
        done = self.call(*RUN, "--out", "out", expect=2,
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512)))
        self.assertRegex(done.stderr, "cannot be written.*: File too large")

    def test_signals_that_are_ignored_stay_so(self):
        for ignored in (signal.SIGHUP, signal.SIGCHLD):
            with self.subTest(ignored):
                run = subprocess.Popen(command_line(*RUN, "--fresh", "--jobs", "1", "--out", "out"), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.PIPE, text=True, env=self.environment, cwd=self.dir,
                                       preexec_fn=lambda: signal.signal(ignored, signal.SIG_IGN))
                while not list(self.dir.glob("out/cells/.*")) and run.poll() is None:
                    time.sleep(.001)
                run.send_signal(ignored)
                said = run.communicate(timeout=120)[1]
                self.assertEqual(run.returncode, 0, said)

    def test_a_directory_that_cannot_be_synced(self):
        self.refuse("fsync", errno.EINVAL)
        self.call(*RUN, "--out", "out")
        self.refuse("fsync", errno.EIO)
        self.assertIn("cannot be synced: Input/output error", self.call(*RUN, "--fresh", "--out", "out", expect=3).stderr)

    def test_a_system_without_files_in_memory(self):
        self.refuse("memfd_create", errno.ENOSYS)
        self.assertIn("memfd_create: Function not implemented", self.call(*RUN, "--out", "out", expect=3).stderr)


if __name__ == "__main__":
    unittest.main()
