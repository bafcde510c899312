"""Each fact that a user can meet (a command, an option, a suite, an arm, an axis, a report's mark, a file's member) is defined on
one page, under a heading that can be linked to; the site's search leads there within its first three pages.

Usage: facts_test.py SOURCE_DIR
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
DOCS, SITE = SOURCE / "docs", SOURCE / "build/site"


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def sections(page):
    """(heading, text below it) of a page."""
    parts = re.split(r"^#+ (.*)$", (DOCS / page).read_text(), flags=re.M)
    return list(zip(parts[1::2], parts[2::2]))


def rows(text):
    """The first cells of a text's tables."""
    return [cell for cell in re.findall(r"^\| (.*?) \|", text, re.M) if set(cell) - set("-: ")]


def known():
    """(kind, name, what a user types into the search): as programs, suites and schemas have them."""
    facts = []
    for verb, text in sections("options.md")[1:]:  # written from --help, as docs_test.py holds
        facts.append(("command", verb, verb))
        facts += [("option", f"{verb} --{name}", name) for name in re.findall(r"^ {6}(?:-\w, )?--([a-z-]+)", text, re.M)]
    for file in sorted(SOURCE.glob("envs/*/suites/*.json")):
        suite = json.loads(file.read_text())
        facts.append(("suite", suite["id"], suite["id"]))
        facts += [("arm", f"{suite['id']} {arm}", f"{suite['id']} {arm}") for arm in suite["about"]["arms"]]
    facts += [("axis", name, name) for name in re.findall(
        r'axis\("(\w+)"', "".join(file.read_text() for file in (SOURCE / "framework/lgabench/perturbations").glob("*.cpp")))]
    marks = (SOURCE / "framework/lgabench/report/tables.hpp").read_text().split("table_marks{")[1].split("};")[0]
    facts += [("mark", f"{sign} {word}", word) for word, sign in re.findall(r'\{"(\w+)", "(.)"', marks)]
    for schema in sorted((DOCS / "formats").glob("*.schema.json")):
        head = json.loads(schema.read_text())["title"].partition(": ")[0]
        facts.append(("file", head, head))
    return facts


if __name__ == "__main__":
    for f in known(): print(*f, sep="\t")
