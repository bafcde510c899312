"""The Dockerfile: built and run where a container engine answers (with LGABENCH_FULL), its lines checked elsewhere.

Usage: docker_test.py SOURCE_DIR BUILD_DIR
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:])


def engine():
    for name in "docker", "podman":
        if shutil.which(name) and subprocess.run([name, "info"], capture_output=True).returncode == 0:
            return name
    return None


class Dockerfile(unittest.TestCase):
    lines = [line for line in (SOURCE / "Dockerfile").read_text().splitlines() if line and not line.startswith("#")]

    def test_lines(self):
        words = {line.split()[0] for line in self.lines}
        self.assertEqual([line for line in self.lines if line.startswith("FROM")], ["FROM debian:12 AS build", "FROM debian:12"])
        self.assertLessEqual(words, {"FROM", "ARG", "COPY", "RUN", "ENV", "WORKDIR", "USER", "ENTRYPOINT", "CMD"})
        self.assertIn("USER lgabench", self.lines)
        for line in self.lines:
            if line.startswith("RUN "):
                subprocess.run(["sh", "-n", "-c", line[4:]], check=True)
                for word in line.split()[1:]:
                    self.assertTrue(not word.startswith("./") or os.access(SOURCE / word, os.X_OK), word)
        for name in (SOURCE / ".dockerignore").read_text().split():
            self.assertFalse(any(f"{name}/" in line for line in self.lines if line.startswith("COPY")))

    def test_the_image_has_the_libraries_that_are_loaded(self):
        """Those that programs, libraries and plugins of the build name come from packages of its second stage, or of every system."""
        if "bookworm" not in pathlib.Path("/etc/os-release").read_text():
            self.skipTest("the image is of Debian 12, and this build is not")
        [install] = [line for line in self.lines if "apt-get install" in line]
        listed = set(install.split())
        self.assertIn("python3-numpy", listed)  # which methods in Python need
        found = {line.split()[0]: line.split("=> ")[1] for line in
                 subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout.splitlines() if "x86-64" in line}
        needed = set()
        not_installed = {"lgabench-benchmarks", "lgabench_tabletop_lessons"}
        programs = [file for file in BUILD.glob("bin/lgabench*") if file.name not in not_installed]
        for file in [*programs, *BUILD.glob("lib/*.so"), *BUILD.glob("lib/lgabench/plugins/*.so")]:
            said = subprocess.run(["readelf", "-d", file], capture_output=True, text=True).stdout
            needed.update(re.findall(r"NEEDED.*\[(.*)\]", said))
        self.assertIn("libfmt.so.9", needed)
        needed &= set(found)
        paths = {str(path): library for library in needed for file in [pathlib.Path(found[library])]
                 for path in (file, file.resolve(), pathlib.Path("/usr") / file.relative_to("/"))}
        said = subprocess.run(["dpkg", "-S", *paths], capture_output=True, text=True).stdout
        packages = {paths[path]: package.split(":")[0] for package, path in (line.split(": ") for line in said.splitlines())}
        self.assertEqual(set(packages), needed)
        self.assertLessEqual(set(packages.values()), listed | {"libc6", "libgcc-s1", "libstdc++6"})

    @unittest.skipUnless(os.environ.get("LGABENCH_FULL") and engine(), "no container engine, or not --full")
    def test_image(self):
        subprocess.run([engine(), "build", "--build-arg", "COMMIT=0123456789ab", "-t", "lgabench-test", SOURCE], check=True)
        said = subprocess.run([engine(), "run", "--rm", "lgabench-test", "--version"], check=True, capture_output=True, text=True)
        self.assertIn("0123456789ab", said.stdout)
        done = subprocess.run([engine(), "run", "--rm", "lgabench-test", "run", "q1", "--preset", "smoke"], check=True,
                              capture_output=True, text=True)
        self.assertIn("lga", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
