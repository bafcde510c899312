"""The wheel, installed in a virtual environment of its own. LGABENCH_FULL: packing takes minutes."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from scenes_test import FULL

SOURCE = pathlib.Path(__file__).parents[2]
BUILD = pathlib.Path(os.environ["LGABENCH_BUILD"])
DEPENDENCIES = SOURCE / ".deps/python"
# python -m lgabench with the words behind the first, which is the system's root.
IN_A_SYSTEM_OF_ITS_OWN = """
test "$(id -u)" = 0 || user="--user --map-root-user"
exec unshare $user --mount --pid --fork sh -c '
  mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" &&
  root=$0 && exec env HOME=/tmp LGABENCH_CACHE=/tmp/cache /usr/sbin/chroot "$root" /v/bin/python -m lgabench "$@"' "$0" "$@"
"""
METHOD = '''
import lgabench, numpy
from lgabench_method import Needs, Selection

class First:
    version, summary, options = "0.1", "the first demonstration's action", {}

    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        return Selection()

    def learn(self, demonstrations, services):
        self.act = lambda observation, instruction: demonstrations[0].steps[0].label
        return self
'''


@unittest.skipUnless(FULL, "no LGABENCH_FULL")
class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp(prefix="lgabench-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.dir, ignore_errors=True)
        path = {"PYTHONPATH": str(DEPENDENCIES), "PATH": f"{DEPENDENCIES}/bin:{os.environ['PATH']}"}
        subprocess.run([sys.executable, SOURCE / "cmake/wheel.py", BUILD, cls.dir / "out"], check=True, env=os.environ | path)
        cls.wheel, = (cls.dir / "out").glob("*.whl")
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", cls.dir / "v"], check=True)
        cls.site, = (cls.dir / "v/lib").glob("python*/site-packages")
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", cls.site,
                        cls.wheel], check=True)
        for name in "numpy", "numpy.libs":
            shutil.copytree(DEPENDENCIES / name, cls.site / name)

    def python(self, *words, program=None):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.dir), "LGABENCH_CACHE": str(self.dir / "cache")}
        done = subprocess.run([*(program or [self.dir / "v/bin/python"]), *words], cwd=self.dir, capture_output=True,
                              text=True, timeout=1200, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        return done.stdout

    def results(self, run, of=None):
        return {f"{cell.name}/{name}": (cell / name).read_bytes() for cell in ((of or self.dir) / run / "cells").iterdir()
                for name in ("cell.json", "selection.json", "training.jsonl", "episodes.jsonl")}

    def test_smoke_has_the_bytes_of_the_build_tree(self):
        smoke = ["run", "q1", "--preset", "smoke", "--out"]
        self.python("-m", "lgabench", *smoke, "wheel")
        self.python(*smoke, "tree", program=[BUILD / "bin/lgabench"])
        self.assertEqual(self.results("wheel"), self.results("tree"))
        self.assertIn("Landlock", (self.dir / "wheel/run.json").read_text())
        with self.subTest("where only glibc, libstdc++ and Python are"):
            root = self.bare_system()
            self.assertEqual([file for file in root.rglob("libX11*") if root / "v" not in file.parents], [])
            self.python(root, *smoke, "/bare", program=["sh", "-c", IN_A_SYSTEM_OF_ITS_OWN])
            self.assertEqual(self.results("bare", root), self.results("tree"))
            self.assertIn("Landlock", (root / "bare/run.json").read_text())

    def bare_system(self):
        """A root directory with the virtual environment, this Python, and what Python itself loads."""
        root = self.dir / "root"
        for name in "proc", "dev", "tmp", "v":
            (root / name).mkdir(parents=True)
        version = f"python{sys.version_info.major}.{sys.version_info.minor}"
        standard = pathlib.Path(os.__file__).parent
        shutil.copytree(standard, root / f"usr/lib/{version}",
                        ignore=shutil.ignore_patterns("test", "dist-packages", "__pycache__", "_tkinter*"))
        program = pathlib.Path(sys.executable).resolve()
        (root / "usr/bin").mkdir()
        shutil.copy(program, root / f"usr/bin/{version}")
        shutil.copytree(self.site, root / f"v/lib/{version}/site-packages", symlinks=True)
        (root / "v/bin").mkdir()
        (root / "v/bin/python").symlink_to(f"/usr/bin/{version}")
        (root / "v/pyvenv.cfg").write_text("home = /usr/bin\ninclude-system-site-packages = false\n")
        glibc = [file for file in pathlib.Path("/lib/x86_64-linux-gnu").iterdir()
                 if re.fullmatch(r"lib(c|m|dl|rt|pthread|util|resolv|anl|nss_files)\.so\.\d", file.name)]
        cxx = subprocess.run(["g++", "-print-file-name=libstdc++.so.6"], capture_output=True, text=True, check=True).stdout.strip()
        loaded = {file for path in (program, cxx, *(root / f"usr/lib/{version}").glob("lib-dynload/*.so"))
                  for file in re.findall(r"(/\S+) \(", subprocess.run(["ldd", path], capture_output=True, text=True).stdout)}
        for file in loaded | {cxx, *map(str, glibc)}:
            to = root / file[1:]
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, to)
        return root

    def test_commands_that_are_printed_begin_as_a_shell_finds_the_program(self):
        script = self.dir / "v/bin/lgabench"
        words = ("-c", "from lgabench.__main__ import typed; print(typed(), end='')")
        self.assertRegex(self.python(*words), "/_install/bin/lgabench$")  # nothing else starts it
        script.touch(0o755)
        self.addCleanup(script.unlink)
        self.assertEqual(self.python(*words), str(script))

    def test_a_method_with_the_interpreter_that_holds_it(self):
        (self.dir / "first.py").write_text(METHOD)
        self.python("-m", "lgabench", "run", "q1", "--preset", "smoke", "--scenarios", "heart", "--methods", "first.py:First",
                    "--no-reference", "--out", "own")

    def test_what_it_loads_and_holds(self):
        for path in self.site.glob("lgabench/**/*"):
            if path.is_file() and path.read_bytes()[:4] == b"\x7fELF":
                said = subprocess.run(["ldd", path], capture_output=True, text=True).stdout
                self.assertNotIn("not found", said, path)
                outside = [file for file in re.findall(r"=> (/\S+)", said) if not file.startswith(str(self.dir))]
                system = r"/(libc|libm|libdl|librt|libpthread|libresolv|libanl|libstdc\+\+|libgcc_s)\.so"
                self.assertEqual([file for file in outside if not re.search(system, file)], [], path)
        for package in "lgabench", "lgabench_method":
            self.assertTrue((self.site / package / "py.typed").exists())
        self.assertTrue((self.site / "lgabench/_core.pyi").exists())
        licences = {path.name for path in self.site.glob("lgabench-*.dist-info/licenses/*")}
        self.assertLessEqual({"LICENSE", "mujoco", "nanobind", "libcli11-dev", "libembree3-3", "libx11-6", "libcurl4"}, licences)
        self.assertLess(self.wheel.stat().st_size, 55e6)
        self.assertIn("True", self.python("-c", "import lgabench; e = lgabench.Environment('heart'); e.reset('test');"
                                                "print(e.step(e.expert_action()).success)"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
