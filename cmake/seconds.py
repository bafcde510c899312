"""Prints the seconds that `step` of cmake/steps noted, and those of the tests by program, from CTest's own reports.

Usage: seconds.py DIRECTORY, which holds `load`, `steps`, and for each run of CTest NAME.xml (--output-junit) and NAME.json
(--show-only=json-v1)
"""
import collections
import json
import os
import pathlib
import sys
import xml.etree.ElementTree


def program_of(command):
    """What a person would look for: the Python file, the program, and of programs that play any engine the engine."""
    for word in command[1:2]:
        if word.endswith(".py"):
            return pathlib.Path(word).name
    name = pathlib.Path(command[0]).name
    return f"{name} {command[1]}" if name == "lgabench-engine-conformance" and len(command) > 1 else name


def seconds_of_tests(report, listing):
    """Of each program its tests' seconds."""
    programs = {test["name"]: program_of(test["command"]) for test in json.loads(listing.read_text())["tests"] if "command" in test}
    seconds = collections.defaultdict(list)
    for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
        seconds[programs.get(case.get("name"), "?")].append((float(case.get("time", 0)), case.get("name")))
    return seconds


def main():
    directory = pathlib.Path(sys.argv[1])
    steps = [line.split("\t", 1) for line in (directory / "steps").read_text().splitlines()] if (directory / "steps").exists() else []
    print(f"\nseconds by step, on {len(os.sched_getaffinity(0))} cores, load {(directory / 'load').read_text().strip()} at the start")
    for seconds, name in steps:
        print(f"{int(seconds):7}  {name}")
    for report in sorted(directory.glob("*.xml")):
        by_program = seconds_of_tests(report, report.with_suffix(".json"))
        cases = [case for cases in by_program.values() for case in cases]
        print(f"\n{report.stem}: seconds of a process by program, {sum(time for time, _ in cases):.0f} in {len(cases)} tests; the longest test; what takes most stands last")
        for program, of_program in sorted(by_program.items(), key=lambda item: sum(time for time, _ in item[1])):
            longest, name = max(of_program)
            print(f"{sum(time for time, _ in of_program):7.0f}  {program}, {len(of_program)} tests; {longest:.0f} {name}")


if __name__ == "__main__":
    main()
