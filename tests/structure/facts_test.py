"""Each fact that a user can meet (a command, an option, a suite, an arm, an axis, a mark of a report, a file, a member of one) is
defined on one page, below a heading that can be linked to. site_test.py asks the site's search for each.

Usage: facts_test.py SOURCE_DIR
"""
import json
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
DOCS = SOURCE / "docs"
PAGES = sorted(DOCS.rglob("*.md"))
MEMBERS = sorted((DOCS / "formats").glob("*-members.md"))


def sections(page):
    """(heading, text below it) of a page, without blocks of code."""
    parts = re.split(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S), flags=re.M)
    return list(zip(parts[1::2], parts[2::2]))


def cells(text):
    """The first cells of the tables in a text."""
    return re.findall(r"^\| (.*?) \|", text, re.M)


def of_suites():
    return [json.loads(file.read_text()) for file in sorted(SOURCE.glob("envs/*/suites/*.json"))]


def facts():
    """[(kind, name, what a reader types into the search, page)]: as --help, suites, schemas and sources have them."""
    found = []
    for title, text in sections(DOCS / "options.md")[1:]:  # docs_test.py compares the page with --help
        if title.startswith("lgabench"):
            if title != "lgabench":  # which leads to the first page
                found.append(("command", title, title, "options"))
            found += [("option", name, f"option {name}", "options") for name in re.findall(r"^ {6}(?:-\w, )?--([a-z-]+)", text, re.M)]
    for suite in of_suites():
        found.append(("suite", suite["id"], suite["id"], "suites"))
        found += [("arm", f"{suite['id']} {arm}", f"{suite['id']} {arm}", "suites") for arm in suite["about"]["arms"]]
    axes = (DOCS / "protocol.md").read_text().split("<!-- program:axes -->")[1].split("<!-- /program -->")[0]  # likewise
    found += [("axis", name, f"perturbation {name}", "protocol") for name in re.findall(r"^\| `(\w+)` \|", axes, re.M)]
    marks = "".join((SOURCE / "framework/lgabench" / file).read_text() for file in ("record/reference_rows.cpp", "statistics/tables.cpp"))
    found += [("mark", f"{sign} {word}", f"{sign} {word}" if sign in "!?" else sign, "reading-a-report") for word, sign in re.findall(r'\{"(\w+)", "(.)"', marks)]
    for page in MEMBERS:  # docs_test.py compares them with the schemas
        for title, text in sections(page)[1:]:
            file = re.sub(r"^A |--", "", title)
            found.append(("file", title, file, f"formats/{page.stem}"))
            found += [("member", f"{title} {cell}", f"{file} {re.findall(r'[A-Za-z_]{2,}', cell)[-1]}", f"formats/{page.stem}")
                      for cell in cells(text) if re.search(r"`[^`]*[a-z]{2}", cell)]
    return list(dict.fromkeys(found))


class Facts(unittest.TestCase):
    def test_there_are_facts_of_every_kind(self):
        kinds = [kind for kind, *_ in facts()]
        for kind, least in {"command": 25, "option": 120, "suite": 18, "arm": 55, "axis": 16, "mark": 6, "file": 35, "member": 800}.items():
            self.assertGreaterEqual(kinds.count(kind), least, kind)

    def test_one_heading_defines_each_command_option_suite_and_file(self):
        head = {"command": r"{}", "option": r"Option {}", "suite": r"`{}`: .*", "file": r"{}"}
        headings = [(page.relative_to(DOCS).with_suffix("").as_posix(), heading, text) for page in PAGES for heading, text in sections(page)]
        wrong = {}
        for kind, name, _, page in facts():
            if kind in head:
                where = [of for of, heading, text in headings if re.fullmatch(head[kind].format(re.escape(name)), heading) and
                         f"({pathlib.Path(page).name}.md#" not in text]  # what says more about it, and links to the definition
                if where != [page]:
                    wrong[name] = where
        self.assertEqual(wrong, {})

    def test_one_row_of_a_table_defines_each_arm(self):
        of_suite = {title.split("`")[1]: cells(text) for title, text in sections(DOCS / "suites.md") if title.startswith("`")}
        for suite in of_suites():
            for arm in suite["about"]["arms"]:
                self.assertEqual(sum(cell.startswith(f"`{arm}`") for cell in of_suite[suite["id"]]), 1, f"{suite['id']} {arm}")

    def test_rows_of_one_page_define_each_axis_and_mark(self):
        rows = {page.stem: re.findall(r"^\| (\S+) \| (\S+)", page.read_text(), re.M)
                for page in PAGES if "results" not in page.relative_to(DOCS).as_posix()}  # whose rows are numbers
        wrong = {}
        for kind, name, _, page in facts():
            if kind == "axis":
                where = [stem for stem in rows if f"`{name}`" in dict(rows[stem]) and not stem.endswith("-members")]
            elif kind == "mark":
                sign, word = name.split()
                where = [stem for stem in rows if (sign, f"`{word}`") in rows[stem]]
            else:
                continue
            if where != [page]:
                wrong[name] = where
        self.assertEqual(wrong, {})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
