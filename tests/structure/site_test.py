"""The web site that docs/site makes of the documents: whole, searchable, and nothing of it is fetched from elsewhere.

Usage: site_test.py SOURCE_DIR
"""
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from facts_test import facts

SOURCE = pathlib.Path(sys.argv[1])
SITE = SOURCE / "build/site"
LOADED = {("link", "href"), ("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("image", "href")}


class Assets(html.parser.HTMLParser):
    """What a browser fetches by itself for a page; not what a reader may click on."""

    def __init__(self, page):
        super().__init__()
        self.found = []
        self.feed(page.read_text())

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        if tag == "link" and named.get("rel") in ("canonical", "next", "prev"):
            return
        self.found += [value for name, value in attributes if (tag, name) in LOADED and value]


@unittest.skipUnless(os.environ.get("CI") or (SOURCE / ".deps/site/bin/mkdocs").exists(),
                     "MkDocs is not installed: docs/site installs it")
class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([SOURCE / "docs/site"], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr  # a link that leads nowhere is an error

    def test_every_page_is_there(self):
        for page in (SOURCE / "docs").rglob("*.md"):
            name = page.relative_to(SOURCE).with_suffix(".html")
            self.assertTrue((SITE / (name.with_name("index.html") if page.stem == "README" else name)).exists(), name)

    def test_nothing_is_fetched_from_elsewhere(self):
        elsewhere = re.compile(r"(?:https?:)?//")
        for page in SITE.rglob("*.html"):
            self.assertEqual([asset for asset in Assets(page).found if elsewhere.match(asset)], [], page)
        for style in SITE.rglob("*.css"):
            self.assertEqual(re.findall(r"(?:url\(|@import)\s*[\"']?(?:https?:)?//[^)\"']*", style.read_text()), [], style)

    def test_search_finds_words_of_the_glossary(self):
        index = "".join(file.read_text() for file in (SITE / "search").iterdir())
        self.assertIn("covariate shift", index)

    @unittest.skipUnless(shutil.which("node"), "Node.js is not installed: it runs the site's search")
    def test_search_leads_to_the_page_of_each_fact(self):
        """One of the first three."""
        known = facts()
        queries = dict.fromkeys(query for _, _, query, _ in known)
        done = subprocess.run(["node", pathlib.Path(__file__).with_name("search.js"), SITE], input="\n".join(queries),
                              capture_output=True, text=True, check=True)
        found = {query: pages for query, *pages in (line.split("\t") for line in done.stdout.splitlines())}
        self.assertEqual(set(found), set(queries))
        self.assertEqual([(kind, query, found[query]) for kind, _, query, page in known if f"docs/{page}.html" not in found[query]], [])

    def test_lists_and_tables_are_lists_and_tables(self):
        """What GitHub takes for a list or a table and MkDocs does not, such as a list right below a paragraph."""
        wrong = []
        for page in SITE.rglob("*.html"):
            text = re.sub(r"<(pre|code|script|style)\b.*?</\1>", "", page.read_text(), flags=re.S)
            wrong += [f"{page.name}: {line}" for line in re.findall(r"^(?:<p>)?(?:[-*]|\d+\.) .*|^\|.*", text, re.M)]
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
