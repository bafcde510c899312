"""Which tests a long run of CTest, killed or failed, has still to do.

Usage: remaining.py TREE PASSED LEFT: adds to the file PASSED, whose name stands for the sources, what the tree's log says has passed
since it was last called so, and writes to LEFT the numbers of all other tests, as `ctest -I LEFT` takes them. Whoever runs other
tests in between removes `log` beside these files. Exit status 1 where nothing is left.
"""
import json
import pathlib
import re
import subprocess
import sys


def passed_in(log):
    """Of CTest's own log, which is written test by test."""
    blocks = re.split(r"^\d+/\d+ Testing: ", log, flags=re.M)[1:]
    return {block.split("\n", 1)[0].strip() for block in blocks if re.search(r"^Test (Passed|Skipped)\.", block, re.M)}


def main():
    tree, passed, left = (pathlib.Path(word) for word in sys.argv[1:])
    log_is_of = passed.parent / "log"  # holds the name of the file to whose sources CTest's log belongs
    belongs = log_is_of.exists() and log_is_of.read_text() == passed.name
    done = set(passed.read_text().splitlines()) if passed.exists() else set()
    for log in (tree / "Testing/Temporary").glob("LastTest.log*"):  # .tmp where it was killed
        done |= passed_in(log.read_text(errors="replace")) if belongs else set()
        log.unlink()
    passed.parent.mkdir(parents=True, exist_ok=True)
    passed.write_text("".join(name + "\n" for name in sorted(done)))
    log_is_of.write_text(passed.name)
    listed = subprocess.run(["ctest", "--test-dir", tree, "--show-only=json-v1"], capture_output=True, text=True, check=True).stdout
    numbers = [number for number, test in enumerate(json.loads(listed)["tests"], 1) if test["name"] not in done]
    left.write_text("0,0,0," + ",".join(map(str, numbers)) + "\n")
    return 0 if numbers else 1


if __name__ == "__main__":
    sys.exit(main())
