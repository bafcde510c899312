#!/usr/bin/env python3
"""Writes docs/options.md: what each command of a built lgabench says with --help, and which commands have an option.

Usage: docs/options.py PROGRAM [OUTPUT_FILE]
"""
import pathlib
import re
import subprocess
import sys


def help_of(program, *verb):
    for wanted in "--help-all", "--help":  # the former where a command has it
        done = subprocess.run([program, *verb, wanted], capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout.strip("\n")
    raise SystemExit(done.stderr)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    out = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).with_name("options.md"))
    whole = help_of(program)
    page = "# Every command and option\n\n`docs/options.py` writes this page from `--help`; `man lgabench` has the same. [Examples](commands.md) are on a page of their own.\n"
    commands = {}  # of each option
    for title, text in [("lgabench", whole)] + [(f"lgabench {verb}", help_of(program, verb)) for verb in re.findall(r"^  ([a-z][a-z-]*)  ", whole, re.M)]:
        page += f"\n## {title}\n" + "".join(f"    {line}\n" if line else "\n" for line in text.splitlines())
        for option in re.findall(r"^  (?:-\w, )?--([a-z-]+)", text, re.M):
            commands.setdefault(option, []).append(f"[{title}](#{title.replace(' ', '-')})")
    page += "\n## Options by name\n"
    for option, having in sorted(commands.items()):
        page += f"\n### Option {option}\n`--{option}` of " + ("every command\n" if option == "help" else ",\n".join(having) + "\n")
    out.write_text(page)


if __name__ == "__main__":
    main()
