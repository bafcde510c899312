"""python -m lgabench ...: the command line, with this interpreter for methods in Python."""
import os
import pathlib
import sys

PROGRAM = pathlib.Path(__file__).with_name("_install") / "bin" / "lgabench"
PLAYS = ("run", "check-plugin", "verify")


def main() -> None:
    words = sys.argv[1:]
    if words and words[0] in PLAYS and not any(word.split("=")[0] == "--python" for word in words):
        words = [*words, "--python", sys.executable]
    os.execv(PROGRAM, [str(PROGRAM), *words])


if __name__ == "__main__":
    main()
