"""cmake/setup on machines that it is not made for: it says so before it installs anything. What steps took is told, failed or not.

Usage: setup_test.py SOURCE_DIR
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])


class Setup(unittest.TestCase):
    def said(self, machine, *programs, release="VERSION_CODENAME=bookworm\n"):
        """On a machine that has these programs alone, and does nothing with them."""
        with tempfile.TemporaryDirectory() as directory:
            for program in programs:
                (pathlib.Path(directory) / program).symlink_to(shutil.which("true"))
            os.symlink(shutil.which("dirname"), f"{directory}/dirname")
            uname = pathlib.Path(directory) / "uname"
            uname.write_text(f"#!/bin/sh\necho {machine}\n")
            uname.chmod(0o755)
            system = pathlib.Path(directory) / "os-release"
            system.write_text(release)
            done = subprocess.run([shutil.which("bash"), SOURCE / "cmake/setup"], capture_output=True, text=True,
                                  env={"PATH": directory, "OS_RELEASE": str(system)})
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn("docker build --platform linux/amd64", done.stderr)
        return done.stderr

    def test_another_processor(self):
        self.assertIn("expected an x86-64 processor, for which MuJoCo's wheel is built, got aarch64", self.said("aarch64", "apt-get"))

    def test_another_system(self):
        for release, name in (('PRETTY_NAME="Debian GNU/Linux 11 (bullseye)"\nVERSION_CODENAME=bullseye\n', "Debian GNU/Linux 11 (bullseye)"),
                              ('PRETTY_NAME="Ubuntu 24.04 LTS"\nVERSION_CODENAME=noble\nID_LIKE=debian\n', "Ubuntu 24.04 LTS"),
                              ('PRETTY_NAME="Fedora Linux 41"\nID=fedora\n', "Fedora Linux 41")):
            self.assertIn(f"expected Debian 12 or 13, whose libraries it builds with, got {name}; on",
                          self.said("x86_64", "apt-get", release=release))

    def test_a_system_of_the_same_libraries(self):
        for release in ('PRETTY_NAME="LMDE 6 (faye)"\nVERSION_CODENAME=faye\nDEBIAN_CODENAME=bookworm\n',
                        'PRETTY_NAME="Debian GNU/Linux 13 (trixie)"\nVERSION_CODENAME=trixie\n'):
            self.assertIn("expected apt-get; on", self.said("x86_64", release=release))


class WithoutNetwork(unittest.TestCase):
    def test_what_is_skipped_is_said(self):
        for name, skipped in (("axe", "axe-core could not be fetched, so that pages are not checked for accessibility"),
                              ("actionlint", "actionlint could not be fetched, so that it does not check the workflows")):
            with self.subTest(name), tempfile.TemporaryDirectory() as directory:
                python = pathlib.Path(directory) / "python3"
                python.write_text("#!/bin/sh\necho 'Could not resolve host' >&2\nexit 1\n")
                python.chmod(0o755)
                done = subprocess.run([SOURCE / "cmake/fetch" / name, f"{directory}/{name}"], capture_output=True, text=True,
                                      env={**os.environ, "PATH": f"{directory}:{os.environ['PATH']}"})
                self.assertFalse(os.path.exists(f"{directory}/{name}"))
                self.assertEqual((done.returncode, done.stdout), (3, ""))
                self.assertEqual(done.stderr, f"{skipped}: Could not resolve host\n")

    def test_other_bytes_than_the_pinned_ones_are_refused(self):
        with tempfile.TemporaryDirectory() as directory:
            python = pathlib.Path(directory) / "python3"
            python.write_text("#!/bin/sh\nfor last; do :; done\necho another >\"$last\"\n")  # in the place of what is fetched
            python.chmod(0o755)
            done = subprocess.run([SOURCE / "cmake/fetch/actionlint", f"{directory}/actionlint"], capture_output=True, text=True,
                                  env={**os.environ, "PATH": f"{directory}:{os.environ['PATH']}"})
            self.assertFalse(os.path.exists(f"{directory}/actionlint"))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("did NOT match", done.stderr)


class MovedClones(unittest.TestCase):
    def test_a_build_tree_of_another_place(self):
        with tempfile.TemporaryDirectory() as directory:
            tree = pathlib.Path(directory) / "build/release"
            tree.mkdir(parents=True)
            (tree / "CMakeCache.txt").write_text("CMAKE_HOME_DIRECTORY:INTERNAL=/home/me/before\n")
            done = subprocess.run([shutil.which("bash"), SOURCE / "cmake/build", "release"], capture_output=True, text=True,
                                  cwd=directory)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertEqual(done.stderr, "build/release was made in /home/me/before: this clone was moved or copied. "
                                      "Build anew: rm -r build/release, then the same command\n")


class Quickstart(unittest.TestCase):
    """In the place of what it calls stand scripts that say what they were told."""

    def told(self, directory, *arguments):
        return subprocess.run([shutil.which("bash"), directory / "quickstart", *arguments], capture_output=True, text=True,
                              check=True).stdout.splitlines()

    def test_the_table_comes_before_the_rest_is_built_and_again_at_the_end(self):
        first, whole, run = "build release first_run -DLGABENCH_TESTS=OFF", "build release -DLGABENCH_TESTS=OFF", "run clutter --preset smoke"
        with tempfile.TemporaryDirectory() as folder:
            directory = pathlib.Path(folder)
            shutil.copy(SOURCE / "quickstart", directory)
            program = directory / "build/release/bin/lgabench"
            for script, lines in (("setup", ""), ("build", f'mkdir -p {program.parent}\nprintf \'#!/bin/sh\necho "$@"\' >{program}\n'
                                                           f'chmod +x {program}\necho build "$@"\n')):
                (directory / "cmake").mkdir(exist_ok=True)
                (directory / "cmake" / script).write_text("#!/bin/bash\n" + lines)
                (directory / "cmake" / script).chmod(0o755)
            fresh = self.told(directory)
            self.assertEqual([line for line in fresh if line and "now" not in line], [first, run, whole, run])
            self.assertEqual(self.told(directory), [whole, run])
            program.unlink()
            self.assertEqual(self.told(directory, "q1", "--engines", "bullet"), [whole, "run q1 --engines bullet"])


class Seconds(unittest.TestCase):
    def of(self, script):
        """Of a script in a copy of what the table is made by."""
        with tempfile.TemporaryDirectory() as directory:
            (pathlib.Path(directory) / "cmake").mkdir()
            for file in ("steps", "seconds.py"):
                shutil.copy(SOURCE / "cmake" / file, f"{directory}/cmake/{file}")
            environment = {name: value for name, value in os.environ.items() if name not in ("LGABENCH_STEPS", "LGABENCH_FULL")}
            return subprocess.run([shutil.which("bash"), "-c", "set -euo pipefail; source cmake/steps; steps_begin\n" + script],
                                  capture_output=True, text=True, cwd=directory, env=environment)

    def test_a_table_also_of_what_failed(self):
        done = self.of("step first true; step 'the second' sleep 1.1; step third false; echo never")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertNotIn("never", done.stdout)
        self.assertRegex(done.stdout, r"seconds by step, on \d+ cores, load [\d.]+ at the start\n"
                                      r" +0  first\n +[12]  the second\n +0  third\n")

    def test_who_is_called_adds_to_the_callers_table(self):
        done = self.of("bash -euc 'source cmake/steps; steps_begin; step inner true'; step outer true")
        self.assertEqual(done.stdout.count("seconds by step"), 1, done.stdout)
        self.assertRegex(done.stdout, r"0  inner\n +0  outer\n")

    def test_tests_by_program(self):
        done = self.of("""mkdir tree; cat >tree/CTestTestfile.cmake <<'END'
add_test(Slow.one sleep 1)
add_test(Slow.two sleep 0)
add_test(integration.Class python3 here/cli_test.py Class)
END
tests_of tree all || echo failed""")
        self.assertIn("failed", done.stdout)  # there is no cli_test.py
        self.assertRegex(done.stdout, r"\nall: seconds of a process by program, 1 in 3 tests; the longest test; what takes most stands last\n"
                                      r" +0  cli_test.py, 1 tests; 0 integration.Class\n +1  sleep, 2 tests; 1 Slow.one\n")

    def test_a_test_that_fails_beside_others_alone(self):
        tests = "add_test(Fails false)\n", "add_test(Once bash -c \"test -e ../once || ! touch ../once\")\n"
        for some, status in ((tests[1:], 0), (tests, 1)):
            done = self.of("mkdir tree; cat >tree/CTestTestfile.cmake <<'END'\n" + "".join(some) + "END\ntests_of tree all --parallel 2")
            self.assertEqual(done.returncode, status, done.stdout)
            self.assertEqual("failed beside other tests, passed alone: Once\n" in done.stdout, status == 0, done.stdout)
            self.assertRegex(done.stdout, r"  all: what failed, alone\n")


class LongRuns(unittest.TestCase):
    def test_what_passed_is_not_run_again(self):
        with tempfile.TemporaryDirectory() as directory:
            tree = pathlib.Path(directory) / "tree"
            tree.mkdir()
            (tree / "CTestTestfile.cmake").write_text("add_test(Passes true)\nadd_test(Fails false)\nadd_test(All/Passes.too/1 true)\n")

            def left(sources):
                done = subprocess.run([sys.executable, SOURCE / "cmake/remaining.py", tree, f"{directory}/full/{sources}",
                                       f"{directory}/full/left"], capture_output=True, text=True)
                self.assertEqual(done.stderr, "")
                return (pathlib.Path(directory) / "full/left").read_text(), done.returncode

            def run():
                return subprocess.run(["ctest", "--test-dir", tree, "-I", f"{directory}/full/left"], capture_output=True, text=True).stdout

            self.assertEqual(left("here"), ("0,0,0,1,2,3\n", 0))
            self.assertIn("out of 3", run())
            self.assertEqual(left("here"), ("0,0,0,2\n", 0))
            self.assertIn("out of 1", run())
            for _ in range(2):
                self.assertEqual(left("changed"), ("0,0,0,1,2,3\n", 0), "of other sources nothing has passed")
            self.assertEqual(left("here"), ("0,0,0,2\n", 0), "nor has here what passed of others")
            (tree / "CTestTestfile.cmake").write_text("add_test(Passes true)\nadd_test(All/Passes.too/1 true)\n")
            self.assertEqual(left("here"), ("0,0,0,\n", 1))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
