"""python -m lgabench ...: the command line, with this interpreter for methods in Python."""
import os
import pathlib
import shutil
import sys

from lgabench_method import installed

PROGRAM = pathlib.Path(__file__).with_name("_install") / "bin" / "lgabench"
TAKES_PYTHON = ("run", "check-plugin", "verify", "list", "info")


def typed() -> str:
    """What starts this package's program from a shell: commands that the program prints begin with it."""
    script = pathlib.Path(sys.executable).with_name("lgabench")
    found = shutil.which("lgabench")
    if found and script.exists() and os.path.samefile(found, script):
        return "lgabench"
    return str(script if script.exists() else PROGRAM)


def main() -> None:
    """Becomes the program; exits with its status."""
    words = sys.argv[1:]
    if words[:1] == ["answers"]:  # of a harness's log too
        from lgabench import evals
        sys.exit(evals.answers(words[1:]))
    if words and words[0] in TAKES_PYTHON and not any(word.split("=")[0] == "--python" for word in words):
        words = [*words, "--python", sys.executable]
        if folders := installed.folders():
            os.environ["LGABENCH_PLUGIN_PATH"] = ":".join(filter(None, [os.environ.get("LGABENCH_PLUGIN_PATH"), *folders]))
    os.execv(PROGRAM, [typed(), *words])


if __name__ == "__main__":
    main()
