"""How often a command opens the files of the installation: the kernel counts, so that no other work on the machine does.

By hand: python3 data_test.py DataRead
"""
import collections
import ctypes
import os
import shutil
import struct
import subprocess
import unittest

from case import BUILD, Case, command_line

libc = ctypes.CDLL(None, use_errno=True)
IN_OPEN, IN_CLOSE_NOWRITE, IN_Q_OVERFLOW, IN_ISDIR = 0x20, 0x10, 0x4000, 0x40000000
EVENT = struct.Struct("iIII")


class Opened:
    """Counts how often the files of these directories are opened, while it is entered: `times`, by their paths."""
    def __init__(self, root):
        self.names, self.times = {}, collections.Counter()
        self.inotify = libc.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        for directory, _, _ in os.walk(root):
            # Two opens in a row would be one event, an open and a close are two.
            watch = libc.inotify_add_watch(self.inotify, os.fsencode(directory), IN_OPEN | IN_CLOSE_NOWRITE)
            if self.inotify < 0 or watch < 0:
                raise OSError(ctypes.get_errno(), "inotify")
            self.names[watch] = os.path.relpath(directory, root)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.inotify)

    def read(self):
        while True:
            try:
                events = os.read(self.inotify, 1 << 16)
            except BlockingIOError:
                return self.times
            at = 0
            while at < len(events):
                watch, mask, _, length = EVENT.unpack_from(events, at)
                if mask & IN_Q_OVERFLOW:
                    raise OSError("more events than the kernel keeps")
                name = events[at + EVENT.size:at + EVENT.size + length].rstrip(b"\0").decode()
                if mask & IN_OPEN and not mask & IN_ISDIR:
                    self.times[os.path.normpath(os.path.join(self.names[watch], name))] += 1
                at += EVENT.size + length


class DataRead(Case):
    def setUp(self):
        super().setUp()
        data = self.dir / "data"  # of its own: nobody else opens it
        shutil.copytree(BUILD / "share/lgabench", data, ignore=lambda directory, names: {"board", "site"} & {*names})
        self.environment["LGABENCH_DATA"] = str(data)

    def opened(self, *words):
        """How often each file was opened."""
        with Opened(self.environment["LGABENCH_DATA"]) as opened:
            done = subprocess.run(command_line(*words), capture_output=True, text=True, env=self.environment, cwd=self.dir, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)
            return opened.read()

    def test_a_command_reads_each_file_once(self):
        """Once for what it says, and once for its hash."""
        for words in (["list", "--json"], ["list", "arms"], ["list", "sources", "--of", "words"], ["run", "words", "--preset", "abstraction", "--dry-run"],
                      ["run", "q1", "--preset", "smoke", "--dry-run"], ["info", "heart"], ["info", "words"]):
            with self.subTest(words=words):
                times = self.opened(*words)
                self.assertGreater(len(times), 0)
                self.assertEqual({name: n for name, n in times.items() if n > 1 + (words[0] == "run")}, {})

    def test_opens_are_counted(self):
        with Opened(self.environment["LGABENCH_DATA"]) as opened:
            for _ in range(3):
                (self.dir / "data/spaces/household.json").read_bytes()
            self.assertEqual(opened.read()["spaces/household.json"], 3)


if __name__ == "__main__":
    unittest.main()
