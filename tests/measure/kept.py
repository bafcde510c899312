#!/usr/bin/env python3
"""Keeps a run's means, which no entry of the board holds, under results/measured/runs for the tables of docs/results.

Usage: tests/measure/kept.py RUN NAME
RUN is a finished run directory without failed cells; the file is results/measured/runs/NAME.json, with the command that
makes the run again, the program's version, the mean over scenarios of each row and arm, each row's use of language, and its regret.
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MEMBERS = "method", "demonstrations", "arm", "success", "low", "high", "episodes"


def of_pairs(row):
    """Where scenes are pairs, or episodes have several steps: both right, and how they went."""
    paired = {name: value for name, value in row.get("paired", {}).items() if name != "by_commands"}
    return {**({"paired": paired} if paired else {}), **({"course": row["course"]} if "course" in row else {})}


def kept(run):
    """The file's value."""
    summary, about = (json.loads((run / f"{name}.json").read_text()) for name in ("summary", "run"))
    if summary["failed_cells"]:
        raise SystemExit(f"{run}: {len(summary['failed_cells'])} cells failed")
    command = re.sub(r" --(jobs|out|cache) \S+|^\S*/(?=lgabench )", "", about["command"])
    rows = [{**{name: row[name] for name in MEMBERS}, **of_pairs(row)} for row in summary["rows"] if row["scenario"] == "(mean)"]
    heard = [{"method": curve["method"], "demonstrations": curve["demonstrations"], "control": curve["control"]["took"],
              "levels": {level["name"]: {"took": level["took"], "success": level["success"],
                                         **({"use": level["use_of_language"]} if "use_of_language" in level else {})}
                         for level in curve["levels"]}}
             for curve in summary.get("perturbations", []) if curve["axis"] == "instruction"]
    return {"command": command, "program": about["program"], "date": about["started"][:10], "cells": len(about["cells"]),
            "rows": rows, **({"instruction": heard} if heard else {}),
            **({"regret": summary["regret"]} if "regret" in summary else {})}


def main():
    run, name = pathlib.Path(sys.argv[1]), sys.argv[2]
    value = kept(run)
    lists = {key: value.pop(key) for key in ("rows", "instruction", "regret") if key in value}
    body = [f" {json.dumps(key)}: {json.dumps(member)}" for key, member in value.items()]
    body += [f" {json.dumps(key)}: [\n" + ",\n".join(f"  {json.dumps(one)}" for one in members) + "\n ]" for key, members in lists.items()]
    (ROOT / f"results/measured/runs/{name}.json").write_text("{\n" + ",\n".join(body) + "\n}\n")


if __name__ == "__main__":
    main()
