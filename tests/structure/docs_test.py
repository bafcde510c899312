"""The documents: code in them is code that is built, links lead somewhere, tables render, commands and messages exist;
and Doxygen has nothing to complain of.

Usage: docs_test.py SOURCE_DIR DOXYFILE [CLASS...]
"""
import functools
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import json_schema

SOURCE, DOXYFILE = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
LGABENCH = DOXYFILE.parent / "bin/lgabench"
PAGES = sorted([*SOURCE.glob("*.md"), *(SOURCE / "docs").rglob("*.md"), *(SOURCE / "examples").rglob("*.md")])


def split_code(text):
    """(prose with code removed, line by line; the code: lines of blocks, and spans)."""
    prose, code, fenced = [], [], False
    for line in text.splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
            prose.append("")
        elif fenced or line.startswith("    "):
            code.append(line.strip())
            prose.append("")
        else:
            code += re.findall(r"`([^`]+)`", line)
            prose.append(re.sub(r"`[^`]*`", "``", line))
    return prose, code


@functools.lru_cache(None)
def anchors(page):
    """The headings' names in links, as GitHub and mkdocs make them."""
    return {re.sub(r"[^\w\- ]", "", head.strip().lower()).replace(" ", "-")
            for head in re.findall(r"^#+ (.*)$", page.read_text(), re.M)}


def q1_table():
    """Row -> success rates at 10 to 50 demonstrations, as docs/results/q1.md prints those of the paper preset."""
    table = (SOURCE / "docs/results/q1.md").read_text().split("### The paper's figure")[1].split("\n### ")[0]
    return {name: [float(number) for number in re.findall(r"\| ([01]\.\d\d)\b", row)]
            for name, row in re.findall(r"^\| \*?([\w -]+?)\*?(?: \([^)]*\))? (\| [01]\.\d.*)$", table, re.M)}


class Pages(unittest.TestCase):
    page, extending = ((SOURCE / "docs" / name).read_text() for name in ("add-a-method.md", "extending.md"))
    readme = " ".join((SOURCE / "README.md").read_text().split())

    def test_the_figure_and_the_text_beside_it_are_the_table(self):
        figure, table = (SOURCE / "docs/pictures/success.svg").read_text(), q1_table()
        rows = ["LGA", "LGA-HILL", "True mask", "LGA-S", "LGA-L", "GCBC-SEG", "GCBC-DART"]
        point = r"[ML][\d.]+ ([\d.]+)"
        lines = re.findall(rf'<path d="({point * 5})" class="s-series f-none" fill="none" stroke="currentColor" stroke-width="2"/>', figure)
        self.assertEqual(len(lines), len(rows))
        bottom, top = (float(re.search(rf'y="([\d.]+)">{rate}</text>', figure)[1]) for rate in ("0.0", "1.0"))
        for row, (_, *heights) in zip(rows, lines):
            for shown, height in zip(table[row], heights):  # the axis' words stand 4 below its lines
                self.assertAlmostEqual(shown, (bottom - 4 - float(height)) / (bottom - top), delta=.0055, msg=row)
        for row, words in {"LGA": "LGA succeeds in 57 %", "GCBC-SEG": "GCBC-SEG in 16 %", "random visible object": "a random object in 43 %"}.items():
            self.assertIn(words, self.readme)
            self.assertIn(f"{100 * table[row][-1]:.0f} %", words)

    def test_readme_says_what_the_tables_say(self):
        results = (SOURCE / "docs/results.md").read_text().split("<!-- board:steps -->")[1].split("<!-- /board -->")[0]
        heads, _, *lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in results.splitlines() if line.startswith("| ")]
        columns = [heads.index(head) for head in ("pixels", "labels", "command read", "both", "true mask")]
        steps = {(line[0].split("]")[0][1:], line[heads.index("n")]): [
            "–" if line[column] == "–" else f"{100 * float(line[column]):.0f}" for column in columns] for line in lines}
        unheard = steps[json.loads((SOURCE / "envs/tabletop/suites/many_commands.json").read_text())["about"]["title"], "5"]
        shown = [re.findall(r"(\d+|–)(?: %)? \|", row)
                 for row in re.findall(r"^\| (?:the whole|a mask|both|the true mask).*$", (SOURCE / "README.md").read_text(), re.M)]
        self.assertEqual(shown, [list(row) for row in zip(*(steps["Clutter and near misses", n] for n in "15"), unheard)])
        board = (SOURCE / "docs/results/q1.md").read_text().split("Success in test, by demonstrations:")[1].split("<!-- /board -->")[0]
        q1 = {method: [f"{100 * float(rate):.0f}" for rate in re.findall(r"(\d\.\d\d) \[", row)]
              for method, row in re.findall(r"^\| ([\w -]+) \| heat map \|(.*)$", board, re.M)}
        lga, seg = q1["LGA"], q1["GCBC-SEG"]
        self.assertIn(f"with 10 it has {lga[0]} %, GCBC-SEG {seg[0]} %; with 50, {lga[-1]} and {seg[-1]} %.", self.readme)
        random = []
        for suite, number in (("clutter", 0), ("many_commands", 1)):  # of 1 and of 5 demonstrations
            curve = (SOURCE / f"docs/results/{suite}.md").read_text().split(f"<!-- board:{suite}-curve -->")[1].split("<!-- /board -->")[0]
            random.append(100 * float(re.findall(r"([\d.]+) \[", re.search(r"^\| Random visible object .*$", curve, re.M)[0])[number]))
        self.assertIn("A random object is right in {:.0f} % (last column: {:.0f} %).".format(*random), self.readme)

    def test_tables_of_kept_runs_are_what_was_measured(self):
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, SOURCE / "docs/results/measured.py", made], check=True)
            written = {page.name: page.read_text() for page in pathlib.Path(made).iterdir()}
        self.assertEqual(sum("| Bayes over types" in page for page in written.values()), 6, "a suite of the abstraction track each")
        for name, text in written.items():
            page = SOURCE / "docs" / name if name in ("results.md", "performance.md", "relatives.md") else SOURCE / "docs/results" / name
            self.assertEqual(page.read_text(), text, "docs/results/measured.py writes it")
        kept = {file.stem for file in (SOURCE / "results/measured/runs").glob("*.json")}
        shown = "".join(written.values())
        for run in kept:
            self.assertIn(json.loads((SOURCE / f"results/measured/runs/{run}.json").read_text())["command"], shown, f"{run} stands on no page")
        for name in json.loads((SOURCE / "results/measured/tables.json").read_text()):
            self.assertEqual(shown.count(f"<!-- measured:{name} -->"), 1, f"{name} of tables.json stands on one page")

    def test_an_oracle_that_always_succeeds_has_no_row(self):
        blocks = [block for page in (SOURCE / "docs/results").glob("*.md") for block in re.findall(r"<!-- board:.*?<!-- /board -->", page.read_text(), re.S)]
        rows = [row for block in blocks for row in block.splitlines() if row.startswith("| Oracle |")]
        self.assertGreater(len(blocks), 10)
        self.assertEqual([row for row in rows if set(re.findall(r"(?<=\| )\d\.\d\d", row)) == {"1.00"}], [])

    def test_the_figures_of_the_findings_are_their_tables(self):
        page, pictures = (SOURCE / "docs/results.md").read_text(), SOURCE / "docs/pictures"
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, pictures / "findings.py", made], check=True)
            for curves in (pathlib.Path(made) / name for name in ("inputs.svg", "fidelity.svg")):
                self.assertEqual((pictures / curves.name).read_text(), curves.read_text(), "docs/pictures/findings.py draws it")
                curves.unlink()
            figures = sorted(file.name for file in pathlib.Path(made).iterdir())
            self.assertEqual(figures, sorted(file.name for file in pictures.glob("finding_*.svg")))
            for name in figures:
                self.assertEqual((pictures / name).read_text(), (pathlib.Path(made) / name).read_text(), "docs/pictures/findings.py draws it")
                finding = re.search(rf"^\| !\[.*\(pictures/{name}\) \| (.*) \|$", page, re.M)[1]
                drawn = re.findall(r">(\d\.\d\d)<", (pictures / name).read_text())
                self.assertTrue(set(drawn) & set(re.findall(r"\d\.\d\d", finding)), finding)

    def test_the_tables_of_suites_claims_and_tracks_and_the_shown_code_are_their_files(self):
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, SOURCE / "docs/tables.py", made], check=True)
            for name in "suites.md", "protocol.md", "leaderboard.md", "add-a-method.md", "extending.md":
                self.assertEqual((SOURCE / "docs" / name).read_text(), (pathlib.Path(made) / name).read_text(), "docs/tables.py writes them")
            self.assertIn("| C1 | ", (pathlib.Path(made) / "protocol.md").read_text())
            self.assertIn("| open | ", (pathlib.Path(made) / "leaderboard.md").read_text())

    def test_every_suite_and_arm_has_its_line_and_a_small_picture(self):
        page, wrong = (SOURCE / "docs/suites.md").read_text(), []
        for file in sorted(SOURCE.glob("envs/*/suites/*.json")):
            suite = json.loads(file.read_text())
            section = re.search(rf"^## `{suite['id']}`:.*?(?=^## )", page, re.M | re.S)
            arms = [arm["arm"] for arm in suite.get("arms", [])]
            for scenario in [] if suite.get("only_arms") else suite["scenarios"]:
                found, = SOURCE.glob(f"envs/*/scenarios/{scenario}.json")
                arms += [arm["arm"] for arm in json.loads(found.read_text())["tests"]]
            wrong += [f"{suite['id']}, {arm}" for arm in set(arms)
                      if not section or not re.search(rf"^\| .*`{arm}`.* \|.*\| !\[.*\) \|$", section[0], re.M)]
        self.assertEqual(wrong, [], "docs/suites.md has no line with a picture for them")
        pictures = list((SOURCE / "docs/pictures/suites").iterdir())
        self.assertEqual([file.name for file in pictures if file.stat().st_size > 40000], [])
        self.assertEqual({file.name for file in pictures}, set(re.findall(r"\(pictures/suites/(.*?)\)", page)))

    def test_the_documents_have_no_more_words_than_they_may(self):
        counted = subprocess.run([SOURCE / "docs/count"], capture_output=True, text=True)
        self.assertEqual(counted.returncode, 0, counted.stdout + counted.stderr)

    def test_maintainers_read_one_short_page(self):
        page = (SOURCE / "docs/maintaining.md").read_text()
        self.assertLessEqual(len(page.split()), 650)
        for subject in "Hosting", "A release", "A stale number", "A hole in the confinement", "An entry":
            self.assertIn(f"\n## {subject}\n", page)

    def test_the_first_page_is_short_and_its_first_screen_has_the_paper_the_numbers_and_the_commands(self):
        page = (SOURCE / "README.md").read_text()
        counted = subprocess.run([SOURCE / "docs/count", "--pages"], capture_output=True, text=True).stdout
        self.assertLessEqual(int(re.search(r"^ *(\d+)  README.md$", counted, re.M)[1]), 600)
        screen = "\n".join(page.splitlines()[:40])
        for said in "An episode is ", "arXiv 2402.18759", "heart.gif", "git clone", ".tar.gz", "pip install", "./quickstart ", "./test ", "demonstration | 5 |":
            self.assertIn(said, screen)
        released = re.search(r"^## (\d\S*) - ", (SOURCE / "CHANGELOG.md").read_text(), re.M)[1]  # while main may be at a later -dev
        self.assertEqual(set(re.findall(r"(?:lgabench-|/v|==)(\d+\.\d+\.\d+)", page)), {released})

    def test_the_time_of_a_first_build_is_the_processors_and_one_number(self):
        pages = "".join((SOURCE / name).read_text() for name in ("README.md", "docs/README.md", "docs/tutorial.md"))
        first, = re.findall(r"\./quickstart .* after (\d+) processor minutes", pages)
        whole = re.findall(r"all built after (\d+);", pages) + re.findall(r"\./install .*# (\d+) processor minutes", pages) \
            + re.findall(r" and (\d+) processor minutes: ", pages)
        self.assertEqual((len(whole), len(set(whole))), (3, 1), whole)
        self.assertLess(int(first), int(whole[0]))
        self.assertNotRegex(pages, r"\./(install|quickstart).*\d minutes")

    def test_the_smallest_method_is_shown_whole(self):
        example = SOURCE / "examples/select_only"
        for language, file in ("cpp", "select_only.cpp"), ("cmake", "CMakeLists.txt"):
            shown = re.search(rf"```{language}\n(.*?)```", self.page, re.S)[1]
            self.assertEqual(shown, (example / file).read_text())
        for name, lines in ("select_only", 25), ("noisy_copies", 40), ("own_network", 35):
            self.assertLessEqual(len((SOURCE / "examples" / name / f"{name}.cpp").read_text().splitlines()), lines)

    def test_shown_code_is_that_of_examples(self):
        """Each other block of C++ stands so, line by line, in an example or in the task that the page follows."""
        code = [file.read_text() for file in [*(SOURCE / "examples").glob("*/*.cpp"), SOURCE / "envs/tabletop/tasks/stack.cpp"]]
        for page, blocks in (self.page, 2), (self.extending, 3):
            shown = re.findall(r"^```cpp\n(.*?)^```", page, re.S | re.M)
            self.assertEqual(len(shown), blocks)
            for block in shown:
                self.assertTrue(any(block in one for one in code), block)

    def test_headers_that_authors_pages_name_are_installed(self):
        """As cmake/LgabenchHelpers.cmake lists them; where a page links a header, it is one of the sources."""
        listed = re.search(r"set\(lgabench_public_headers\n([^)]+)\)", (SOURCE / "cmake/LgabenchHelpers.cmake").read_text())
        for page, least in (self.page, 11), (self.extending, 3):
            named = set(re.findall(r"[`<](?:lgabench/)?((?:core|plugin|abstraction|learning)/\w+\.hpp)[`>]", page))
            self.assertGreaterEqual(len(named), least)
            self.assertEqual(named - set(listed[1].split()), set())

    @unittest.skipUnless(shutil.which("git"), "needs git")
    def test_the_patch_of_a_statistic_applies(self):
        self.assertIn("git apply examples/statistic/seed_range.patch", self.extending)
        patch = (SOURCE / "examples/statistic/seed_range.patch").read_text()
        self.assertEqual(patch.count("\n+++ "), 6, "a column: one file; a number: four, and a test")
        tried = subprocess.run(["git", "apply", "--check", "-"], cwd=SOURCE, input=patch, capture_output=True, text=True)
        self.assertEqual(tried.stderr, "")

    def test_every_example_is_listed(self):
        for example in (SOURCE / "examples").glob("*/*.cpp"):
            code = example.read_text()
            if "LGABENCH_METHOD(" in code:
                self.assertIn(f"`{example.stem}`", self.page)
            else:
                self.assertIn(f"`examples/{example.stem}`", self.extending)
        scripts = (SOURCE / "docs/python.md").read_text()
        for example in (SOURCE / "examples/python").glob("*.py"):
            code = example.read_text()
            page = self.page if "def select(" in code else self.extending if "def perceive(" in code else scripts
            self.assertIn(f"`examples/python/{example.name}`", page)

    def test_the_page_of_methods_lists_what_authors_may_write(self):
        """All macros of options, all members of an option, and all functions that a method or its policy may have."""
        headers = {name: (SOURCE / f"framework/lgabench/{name}.hpp").read_text()
                   for name in ("core/method", "learning/cloning_method", "plugin/plugin")}
        macros = re.findall(r"#define (LGABENCH_\w+_OPTIONS?)\b", headers["learning/cloning_method"] + headers["plugin/plugin"])
        functions = re.findall(r"^  virtual [^~(]*?\b(\w+)\(", headers["core/method"].split("/// What was learned.")[1]
                               + headers["learning/cloning_method"], re.M)
        self.assertGreater(len(macros), 5)
        self.assertGreater(len(functions), 12)
        self.assertEqual([name for name in macros if f"`{name}`" not in self.page], [])
        self.assertEqual([name for name in functions if not re.search(rf"`(?:\w+::)?{name}\(", self.page)], [])
        for member in "values", "min", "max", "words", "needs", "framework":
            self.assertRegex(self.page, rf"(?m)^\|[^|]*`{member}`[^|]*\|")


class Formats(unittest.TestCase):
    folder = SOURCE / "docs/formats"

    def test_tables_of_members_are_the_schemas(self):
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, SOURCE / "docs/members.py", made], check=True)
            pages = sorted(pathlib.Path(made).iterdir())
            names = sorted([*(page.name for page in self.folder.glob("*-members.md")), "method-protocol.md"])
            self.assertEqual([page.name for page in pages], names)
            for page in pages:
                self.assertTrue((self.folder / page.name).read_text() == page.read_text(), f"docs/members.py writes {page.name} anew")
        written = "".join((self.folder / page.name).read_text() for page in pages)
        self.assertEqual([schema.name for schema in self.folder.glob("*.json") if f"({schema.name})" not in written], [])
        self.assertEqual([cell for line in written.splitlines() for cell in re.split(r"(?<!\\)\|", line) if len(cell.split()) > 50], [])

    def test_files_of_the_sources_are_as_their_schemas_say(self):
        files = [(name, SOURCE / f"results/leaderboard/{name}.json") for name in ("labels", "tracks", "vouched", "vouched_entries", "instructions", "scenes")]
        files += [("recorded_answers", file) for file in (SOURCE / "framework/lgabench/abstraction/answers").rglob("*.json")]
        self.assertGreater(len(files), 10)
        for name, file in files:
            schema, document = json.loads((self.folder / f"{name}.schema.json").read_text()), json.loads(file.read_text())
            self.assertEqual(json_schema.complaints(document, schema), [], file)
            self.assertNotEqual(json_schema.complaints({**document, "surprise": 1}, schema), [], name)


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        wrong = []
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", "\n".join(split_code(page.read_text())[0])):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (page.parent / path).resolve() if path else page
                there = file.exists() and file.is_relative_to(SOURCE.resolve())
                if not there or (anchor and anchor not in anchors(file)):
                    wrong.append(f"{page.relative_to(SOURCE)}: {target}")
        self.assertEqual(wrong, [])

    def test_every_page_is_in_the_index_and_in_the_site(self):
        index, site = "".join((SOURCE / "docs" / page).read_text() for page in ("README.md", "results.md")), (SOURCE / "mkdocs.yml").read_text()
        pages = [str(page.relative_to(SOURCE / "docs")) for page in PAGES if page.is_relative_to(SOURCE / "docs")]
        self.assertEqual([page for page in pages if page != "README.md" and f"({page})" not in index], [])
        self.assertEqual([page for page in pages if page != "decisions.md" and f": docs/{page}\n" not in site], [])  # not for users

    def test_the_site_has_seven_entries_at_the_top(self):
        top = re.findall(r"^  - (.*?):", (SOURCE / "mkdocs.yml").read_text().split("\nnav:\n")[1], re.M)
        self.assertEqual(top, ["Home", "Get started", "Guides", "Benchmark", "Board", "Results", "Reference"])

    def test_a_word_of_the_report_has_one_definition(self):
        words = {}
        for page in "glossary", "reading-a-report":
            for cell in re.findall(r"^\| (.+?) \| .*\|$", (SOURCE / f"docs/{page}.md").read_text(), re.M):
                if set(cell) - set("-: ") and cell not in ("word", "mark", "column", "verdict", "attributed to"):
                    for word in re.sub(r"[*`]|[(].*", "", cell).strip().split(", ") if "[" not in cell else []:
                        words.setdefault(word.strip(), []).append(page)
        self.assertGreater(len(words), 80)
        self.assertEqual({word: pages for word, pages in words.items() if len(pages) > 1 and word}, {})

    def test_decisions_are_few_and_numbered(self):
        numbers = [int(n) for n in re.findall(r"^(\d+)\. ", (SOURCE / "docs/decisions.md").read_text(), re.M)]
        self.assertEqual(numbers, list(range(1, len(numbers) + 1)))
        self.assertLessEqual(len(numbers), 30, "one that would be undone otherwise takes another's place")

    def test_no_page_has_two_headings_of_one_name(self):
        wrong = []
        for page in PAGES:
            heads = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.S | re.M), re.M)
            wrong += [f"{page.relative_to(SOURCE)}: {head}" for head in set(heads) if heads.count(head) > 1 and page.name != "CHANGELOG.md"]
        self.assertEqual(wrong, [])

    def test_cells_of_fidelity_can_be_read_at_a_glance(self):
        """Thirty words at most; more stands below the table."""
        cells = [cell for line in (SOURCE / "docs/fidelity.md").read_text().splitlines() if line.startswith("| ")
                 for cell in re.split(r"(?<!\\)\|", line)]
        self.assertEqual([cell for cell in cells if len(cell.split()) > 30], [])

    def test_tables_render(self):
        """GitHub takes no table whose head and rule differ in cells, and drops what a row has too many."""
        wrong = []
        for page in PAGES:
            lines = page.read_text().splitlines()
            cells = [len(re.findall(r"(?<!\\)\|", line)) - 1 if line.startswith("|") else 0 for line in lines]
            for i, line in enumerate(lines):
                if i and cells[i] and cells[i - 1] and cells[i] != cells[i - 1]:
                    wrong.append(f"{page.relative_to(SOURCE)}:{i + 1}: {cells[i]} cells below {cells[i - 1]}")
                rule = re.compile(r"[|: -]*-[|: -]*")
                if rule.fullmatch(line) and cells[i] and not cells[i - 1]:
                    wrong.append(f"{page.relative_to(SOURCE)}:{i + 1}: a table without a head")
                if cells[i] and not cells[i - 1] and not rule.fullmatch("".join(lines[i + 1:i + 2])):
                    wrong.append(f"{page.relative_to(SOURCE)}:{i + 1}: a table without a rule below its head")
        self.assertEqual(wrong, [])

    def test_numbers_are_written_as_the_programs_print_them(self):
        """0.57, not .57."""
        wrong = []
        for page in PAGES:
            for line in split_code(page.read_text())[0]:
                wrong += [f"{page.relative_to(SOURCE)}: {found}" for found in re.findall(r"(?<![\w.])\.\d+", line)]
        self.assertEqual(wrong, [])

    def test_documents_that_sources_name_are_there(self):
        """And sections of docs/protocol.md; no other document, by a name in capitals."""
        sections = re.findall(r"^## (\d)\. ", (SOURCE / "docs/protocol.md").read_text(), re.M)
        wrong = []
        for folder in "framework", "programs", "envs", "plugins", "baselines", "examples", "python", "tests", "cmake":
            for file in (SOURCE / folder).rglob("*"):
                if file.suffix not in (".cpp", ".hpp", ".py", ".in", ".cmake", ".txt") or file.samefile(__file__):
                    continue
                text = re.sub(r"\s*\n\s*(?://+|#)?\s*", " ", file.read_text())  # comments go on in the next line
                names = re.findall(r"\b(?:PROTOCOL|DESIGN)(?:,? section|'s)", text)
                names += [name for name in re.findall(r"\bdocs/[\w/-]+\.md", text) if not (SOURCE / name).exists()]
                names += [n for n in re.findall(r"docs/protocol\.md, sections? (\d)", text) if n not in sections]
                wrong += [f"{file.relative_to(SOURCE)}: {name}" for name in names]
        self.assertEqual(wrong, [])

    named = r"`((?:integration|consumer)\.\w+|test_\w+|[A-Z]\w+\.(?!md`|txt`)[A-Za-z]\w+)`"

    def test_each_line_of_trust_names_a_test(self):
        page = (SOURCE / "docs/trust.md").read_text()
        lines = page.split("## What remains possible")[0].split("\n|")[3:]
        self.assertEqual([line[:40] for line in lines if not re.search(self.named, line.rsplit(" | ", 1)[-1])], [])

    def test_tests_that_pages_name_are_there(self):
        classes = {f"integration.{name}": SOURCE / "tests/integration" / file for file, names in re.findall(
            r"^integration_tests\((\w+\.py) ([\w ]+)\)", (SOURCE / "tests/integration/CMakeLists.txt").read_text(), re.M)
            for name in names.split()}
        classes.update({f"consumer.{name}": SOURCE / "tests/consumer/consumer_test.py" for name in ("Package", "NewPlugin", "Examples")})
        native = {".".join(names) for names in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)", "".join(
            file.read_text() for file in sorted((SOURCE / "tests/unit").rglob("*.cpp"))), re.M)}
        for page, at_least in ("trust", 60), ("leaderboard", 35), ("maintaining", 8):
            names, wrong, body = re.findall(self.named, (SOURCE / f"docs/{page}.md").read_text()), [], ""
            self.assertGreater(len(names), at_least)
            for name in names:
                if name in classes:
                    found = re.search(rf"^class {name.split('.')[1]}\(.*?(?=^\S|\Z)", classes[name].read_text(), re.M | re.S)
                    body = found[0] if found else ""
                    there = bool(body)
                else:
                    there = f"    def {name}(" in body if name.startswith("test_") else name in native
                if not there:
                    wrong.append(name)
            self.assertEqual(wrong, [], page)

    def test_files_that_documents_name_are_there(self):
        wrong = []
        for page in PAGES:
            for name in re.findall(r"`((?:framework|programs|envs|plugins|baselines|examples|tests|cmake|results|python)/[^`\s]*)`", page.read_text()):
                general = re.sub(r"\b[A-Z]+\b", "*", re.sub(r"#.*", "", name))  # envs/ID/suites: any of them
                if page.name not in ("CHANGELOG.md", "decisions.md") and not any(SOURCE.glob(general)):
                    wrong.append(f"{page.relative_to(SOURCE)}: {name}")
        self.assertEqual(wrong, [])

    def test_files_that_contributors_change_are_there(self):
        rows = re.findall(r"^\| (?!-|I change)(.*?) \| (.*) \| (.*) \|$", (SOURCE / "docs/contributing.md").read_text()
                          .split("## What I change, where")[1].split("\n## ")[0], re.M)
        self.assertGreater(len(rows), 7)
        wrong = []
        for what, files, tests in rows:
            folder = SOURCE
            for name in re.findall(r"`([^`]+)`", f"{files} {tests}"):
                if name in ("run", "cluster"):
                    continue
                there = list(SOURCE.glob(name)) if "/" in name else [folder / name]  # a bare name lies in the folder named before
                wrong += [f"{what}: {name}"] * (not there or not there[0].exists())
                folder = there[0] if there and there[0].is_dir() else folder
            self.assertRegex(f"{files} {tests}", r"`tests/", what)
        self.assertEqual(wrong, [])

    def test_cited_as_it_is(self):
        said = re.search(r"^version: (.*)$", (SOURCE / "CITATION.cff").read_text(), re.M)[1]
        self.assertIn(f"version = {{{said}}}", (SOURCE / "docs/citing.md").read_text())
        header = (SOURCE / "framework/lgabench/core/version.hpp").read_text()
        self.assertIn(f'LGABENCH_VERSION "{said}"', header)
        self.assertIn(f"VERSION {said.split('-')[0]} ", (SOURCE / "CMakeLists.txt").read_text())

    def test_quoted_messages_are_the_programs(self):
        """First column of the tables of troubles, "…" for what fills a message in: its other parts stand in a source."""
        sources = [file.read_text() for folder in ("framework", "programs", "cmake") for file in (SOURCE / folder).rglob("*")
                   if file.suffix in (".cpp", ".hpp", "") and file.is_file()]
        said = re.sub(r'"\s*\n\s*"', "", "\n".join(sources)).replace('\\"', '"')  # literals that go on in the next line
        said = re.sub(r"\{[^{}\n]*\}", "…", said) + "No space left on device, Too many open files; Could not resolve host"  # libc's, libcurl's
        missing = []
        for page in "troubleshooting.md", "language-models.md":
            cells = re.findall(r"^\| ((?:`[^`]+`(?:, )?)+) \|", (SOURCE / "docs" / page).read_text(), re.M)
            for message in re.findall(r"`([^`]+)`", " ".join(cells)):
                general = re.sub(r"\d+|(?<=no )method", "…", message)
                missing += [f"{page}: {part}" for part in general.split("…") if part.strip(" :") not in said]
        self.assertEqual(missing, [])


@unittest.skipUnless(LGABENCH.exists(), "lgabench is not built")
class Commands(unittest.TestCase):
    @functools.lru_cache(None)
    def help_of(self, *verb):
        wanted = "--help-all" if verb in ((), ("run",), ("cluster",)) else "--help"
        return subprocess.run([LGABENCH, *verb, wanted], capture_output=True, text=True).stdout

    def test_the_table_of_axes_is_the_programs(self):
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, SOURCE / "docs/tables.py", "--program", LGABENCH, made], check=True)
            filled = (pathlib.Path(made) / "protocol.md").read_text()
            self.assertIn("`sensor_noise`", filled.split("<!-- program:axes -->")[1].split("<!-- /program -->")[0])
            self.assertEqual((SOURCE / "docs/protocol.md").read_text(), filled, "docs/tables.py --program LGABENCH writes it")

    def test_commands_and_options_exist(self):
        verbs = set(re.findall(r"^  ([a-z][a-z-]*)  ", self.help_of(), re.M))
        wrong = []
        for page in PAGES:
            for line in split_code(page.read_text())[1]:
                command = re.match(r"(?:exec )?(?:\S*/)?lgabench ([a-z][a-z-]*)(.*)", re.sub(" #.*", "", line))
                if not command:
                    continue
                verb, rest = command.groups()
                known = verb in verbs and self.help_of(verb)
                if not known or any(option not in known for option in re.findall(r"(?<=\s)--[a-z-]+", rest)):
                    wrong.append(f"{page.relative_to(SOURCE)}: {line}")
        self.assertEqual(wrong, [])

    def printed(self, command):
        done = subprocess.run([LGABENCH, *command.split()], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, f"lgabench {command}: {done.stderr}")
        return done.stdout

    def test_what_relatives_say_of_lgabench_is_what_it_prints(self):
        """The number before a command is that of its lines, the words in italics are its words; an axis has its numbers at both ends."""
        page = (SOURCE / "docs/relatives.md").read_text().split("## Benchmarks of 2026")[1].split("\n## ")[0]
        commands = 0
        for paragraph in page.replace(" |\n", " |\n\n").split("\n\n"):
            shown = re.split(r"`lgabench ([^`]+)`", " ".join(paragraph.split()))
            for before, command in zip(shown[::2], shown[1::2]):
                said, commands = self.printed(command), commands + 1
                if number := re.search(r"(\d+)(?: \w+)?: $", before):
                    self.assertEqual(int(number[1]), len(said.splitlines()), command)
                words = re.findall(r"\*([^*]+)\*", before)
                self.assertTrue(number or words, f"{command} shows nothing")
                self.assertEqual([word for word in words if word not in " ".join(said.split())], [], command)
        self.assertGreater(commands, 5)
        axes = [axis for cell in re.findall(r"^\| (`\w+`[^|]*) \|", page, re.M) for axis in re.findall(r"`(\w+)`([^`]*)", cell)]
        self.assertEqual(sorted(name for name, _ in axes), self.printed("list perturbations").split())
        for name, ends in axes:
            levels = re.findall(r"^  level \d +(.*)$", self.printed(f"info {name}"), re.M)
            numbers = [[float(number) for number in re.findall(r"\d*\.?\d+", text)] for text in (ends, f"{levels[0]} {levels[-1]}")]
            self.assertIn(numbers[0], ([], numbers[1]), name)

    def test_the_page_of_options_is_what_help_says(self):
        with tempfile.TemporaryDirectory() as made:
            page = pathlib.Path(made) / "options.md"
            subprocess.run([sys.executable, SOURCE / "docs/options.py", LGABENCH, page], check=True)
            self.assertTrue((SOURCE / "docs/options.md").read_text() == page.read_text(), "docs/options.py writes it anew")


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class Doxygen(unittest.TestCase):
    def complaints(self, more=""):
        done = subprocess.run(["doxygen", "-"], input=DOXYFILE.read_text() + more, capture_output=True, text=True)
        return [line for line in done.stderr.splitlines() if re.search(r"(warning|error):", line)]

    def test_no_warnings(self):
        self.assertEqual(self.complaints(), [])

    def test_every_public_class_and_function_is_documented(self):
        missing = [line for line in self.complaints("\nWARN_IF_UNDOCUMENTED = YES\nGENERATE_HTML = NO\nGENERATE_XML = YES\n")
                   if "(variable)" not in line]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
