"""The library without the programs: a tree without programs/ is configured, and with LGABENCH_FULL=1 built, installed and tested.

Usage: alone_test.py SOURCE_DIR
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
FULL = "LGABENCH_FULL" in os.environ


class Alone(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory(prefix="lgabench-alone-")
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)
        self.tree = self.place / "tree"
        self.tree.mkdir()
        for entry in SOURCE.iterdir():
            if entry.name not in ("programs", "build", ".git"):
                (self.tree / entry.name).symlink_to(entry)

    def said(self, *command):
        usual = {name: value for name, value in os.environ.items() if name != "LGABENCH_FULL"}  # long tests are played once, elsewhere
        done = subprocess.run(command, cwd=self.place, capture_output=True, text=True, env=usual)
        self.assertEqual(done.returncode, 0, (done.stdout + done.stderr)[-4000:])
        return done.stdout

    def test_it_stands_alone(self):
        self.said("cmake", "-S", self.tree, "-B", "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                  "-DCMAKE_UNITY_BUILD_BATCH_SIZE=32", "-DLGABENCH_TESTS=ON")
        targets = self.said("ninja", "-C", "build", "-t", "targets", "all")
        for there in "bin/lgabench-worker", "bin/lgabench-method", "bin/harness_test", "bin/fuzz_replay_test":
            self.assertIn(there, targets)
        self.assertNotIn("bin/lgabench:", targets)
        self.assertNotIn("programs/", targets)
        if not FULL:
            return
        self.said("cmake", "--build", "build")
        self.said("cmake", "--install", "build", "--prefix", "prefix")
        self.assertTrue((self.place / "prefix/bin/lgabench-worker").exists())
        self.assertTrue((self.place / "prefix/lib/cmake/lgabench/lgabenchConfig.cmake").exists())
        tested = self.said("ctest", "--test-dir", "build", "--parallel", str(os.cpu_count()))
        self.assertIn("100% tests passed", tested)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
