"""The archives of a release, as `cmake --build build/release --target package` makes them: unpacked elsewhere, the installed tree
runs the smoke preset without the machine's libraries. With ./test --full alone.

LGABENCH_BUILD and LGABENCH_SOURCE name the build tree and the sources. By hand: LGABENCH_FULL=1 release_test.py Release
"""
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

BUILD, SOURCE = (pathlib.Path(os.environ[name]) for name in ("LGABENCH_BUILD", "LGABENCH_SOURCE"))
sys.path.insert(0, str(SOURCE / "cmake"))
from wheel import is_elf, needed  # noqa: E402


@unittest.skipUnless(os.environ.get("LGABENCH_FULL") == "1", "only with ./test --full")
class Release(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-release-"))
        cls.addClassCleanup(shutil.rmtree, cls.dir, ignore_errors=True)
        made = subprocess.run(["cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.dir / "made"], capture_output=True, text=True)
        assert made.returncode == 0, made.stdout + made.stderr
        cls.archives = sorted((cls.dir / "made").glob("*.tar.gz"))
        cls.binary = next(file for file in cls.archives if file.name.endswith("-x86_64.tar.gz"))
        with tarfile.open(cls.binary) as archive:
            archive.extractall(cls.dir / "elsewhere", filter="tar")
        (cls.tree,) = (cls.dir / "elsewhere").iterdir()
        cls.tree = cls.tree.rename(cls.dir / "moved")

    def test_each_archive_has_its_checksum(self):
        for archive in self.archives:
            said = pathlib.Path(f"{archive}.sha256").read_text().split()
            self.assertEqual(said, [hashlib.sha256(archive.read_bytes()).hexdigest(), archive.name])

    def test_the_sources_are_those_of_the_commit(self):
        if not (SOURCE / ".git").exists():
            self.skipTest("not a clone")
        with tarfile.open(next(file for file in self.archives if file.name.endswith("-source.tar.gz"))) as archive:
            names = archive.getnames()
        top = names[0].split("/")[0]
        for name in ("quickstart", "CMakeLists.txt", "LICENSE", "cmake/setup"):
            self.assertIn(f"{top}/{name}", names)

    def test_it_runs_where_it_was_unpacked_with_its_own_libraries_alone(self):
        outside = {f"{name} => {file}" for path in self.tree.rglob("*") if is_elf(path)
                   for name, file in needed(path).items() if self.tree not in file.parents}
        self.assertEqual(outside, set())
        home = self.dir / "home"
        home.mkdir()
        ran = subprocess.run([self.tree / "bin/lgabench", "run", "clutter", "--preset", "smoke", "--out", home / "run"], text=True,
                             capture_output=True, cwd=home, env={"HOME": str(home), "PATH": "/usr/bin:/bin"}, timeout=900)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        self.assertRegex(ran.stderr, r"\n\d+ cells computed, 0 reused, 0 failed\n")
        self.assertTrue((home / "run/report.html").exists())

    def test_the_terms_of_all_that_is_bundled_are_inside(self):
        licences = self.tree / "share/doc/lgabench/licenses"
        self.assertTrue((licences / "LICENSE").exists())
        self.assertTrue(any((licences / "mujoco").iterdir()))
        bundled = [path for path in (self.tree / "lib").glob("*.so*") if "lgabench" not in path.name and "mujoco" not in path.name]
        self.assertGreater(len(bundled), 5)
        self.assertGreater(len(list(licences.glob("*/copyright"))), 5)
        for compiled_in in "libcli11-dev", "nlohmann-json3-dev", "libboost1.74-dev":
            self.assertTrue((licences / compiled_in / "copyright").exists())

    def test_it_lacks_libtorch_and_says_so(self):
        self.assertEqual([path.name for path in self.tree.rglob("*torch*.so*")], [])
        self.assertLess(self.binary.stat().st_size, 80e6)
        for words, status in ([], 1), (["fetch"], 2):
            said = subprocess.run([self.tree / "bin/lgabench", "encoder", *words], capture_output=True, text=True)
            self.assertIn("needs LibTorch, which this installation lacks", said.stdout + said.stderr)
            self.assertEqual(said.returncode, status)


if __name__ == "__main__":
    unittest.main()
