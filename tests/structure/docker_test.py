"""The Dockerfile: built and run where a container engine answers (with LGABENCH_FULL), its lines checked elsewhere.

Usage: docker_test.py SOURCE_DIR
"""
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1])


def engine():
    for name in "docker", "podman":
        if shutil.which(name) and subprocess.run([name, "info"], capture_output=True).returncode == 0:
            return name
    return None


class Dockerfile(unittest.TestCase):
    lines = [line for line in (SOURCE / "Dockerfile").read_text().splitlines() if line and not line.startswith("#")]

    def test_lines(self):
        words = {line.split()[0] for line in self.lines}
        self.assertEqual(self.lines[0], "FROM debian:12")
        self.assertLessEqual(words, {"FROM", "COPY", "RUN", "ENV", "WORKDIR", "ENTRYPOINT", "CMD"})
        for line in self.lines:
            if line.startswith("RUN "):
                subprocess.run(["sh", "-n", "-c", line[4:]], check=True)
                for word in line.split():
                    self.assertTrue(not word.startswith("./") or os.access(SOURCE / word, os.X_OK), word)
        for name in (SOURCE / ".dockerignore").read_text().split():
            self.assertFalse(any(f"{name}/" in line for line in self.lines if line.startswith("COPY")))

    @unittest.skipUnless(os.environ.get("LGABENCH_FULL") and engine(), "no container engine, or not --full")
    def test_image(self):
        subprocess.run([engine(), "build", "-t", "lgabench-test", SOURCE], check=True)
        done = subprocess.run([engine(), "run", "--rm", "lgabench-test", "run", "q1", "--preset", "smoke"], check=True,
                              capture_output=True, text=True)
        self.assertIn("lga", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
