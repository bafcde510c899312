#!/usr/bin/env python3
"""How often a run of the suite persons tells two rows apart whose areas differ by .05: simulated from its own persons.

Usage: tests/measure/person_power.py RUN...
RUN is a finished run directory; of several, rows are put together. A person's area is the mean over numbers of demonstrations of the share of scenes that succeed. For
each two rows with as many questions, the differences of areas are moved to a mean of .05, so many persons are drawn from them again,
and the two count as told apart where their mean is more than 1.96 standard errors from 0.
"""
import collections
import itertools
import json
import pathlib
import random
import statistics
import sys

APART, DRAWS = .05, 1000


def areas(run):
    """(row, questions) -> {person: area}"""
    shares = collections.defaultdict(lambda: collections.defaultdict(list))
    for directory in sorted((run / "cells").iterdir()):
        cell = json.loads((directory / "cell.json").read_text())
        row = cell["method"]["name"], cell["method"]["options"].get("questions", 0)
        of_person = collections.defaultdict(list)
        for line in (directory / "episodes.jsonl").read_text().splitlines():
            one = json.loads(line)
            of_person[cell["scenario"]["id"], one["command"]].append(one["success"])
        for person, won in of_person.items():
            shares[row][person].append(statistics.mean(won))
    return {row: {person: statistics.mean(each) for person, each in persons.items()} for row, persons in shares.items()}


def told_apart(differences, stream):
    """The share of draws, and how many persons would make it .80."""
    mean, spread = statistics.mean(differences), statistics.stdev(differences)
    moved, found = [one - mean + APART for one in differences], 0
    for _ in range(DRAWS):
        drawn = stream.choices(moved, k=len(moved))
        found += abs(statistics.mean(drawn)) > 1.96 * statistics.stdev(drawn) / len(drawn) ** .5
    return found / DRAWS, ((1.96 + .8416) * spread / APART) ** 2


def main():
    found, stream = [], random.Random(0)
    all_rows = {}
    for run in sys.argv[1:]:
        all_rows.update(areas(pathlib.Path(run)))
    for (one, other) in itertools.combinations(sorted(all_rows), 2):
        if one[1] != other[1]:
            continue
        differences = [all_rows[one][person] - all_rows[other][person] for person in all_rows[one] if person in all_rows[other]]
        if any(differences):  # else they are one row
            found.append((*told_apart(differences, stream), one[0], other[0], len(differences)))
    for power, needed, one, other, persons in sorted(found):
        print(f"{power:.2f}, {needed:.0f} persons for .80: {one} and {other}")
    if not found:
        raise SystemExit("expected two rows with as many questions")
    powers = [one[0] for one in found]
    print(f"{len(found)} pairs of rows, {found[0][4]} persons: {min(powers):.2f} to {max(powers):.2f}, median {statistics.median(powers):.2f}; "
          f"{sum(power >= .8 for power in powers)} of them .80 or more")


if __name__ == "__main__":
    main()
