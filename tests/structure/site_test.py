"""The web site that docs/site makes of the documents: whole, searchable, and nothing of it is fetched from elsewhere.

Usage: site_test.py SOURCE_DIR
"""
import html.parser
import os
import pathlib
import re
import subprocess
import sys
import unittest

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

    def test_lists_and_tables_are_lists_and_tables(self):
        """What GitHub takes for a list or a table and MkDocs does not, such as a list right below a paragraph."""
        wrong = []
        for page in SITE.rglob("*.html"):
            text = re.sub(r"<(pre|code|script|style)\b.*?</\1>", "", page.read_text(), flags=re.S)
            wrong += [f"{page.name}: {line}" for line in re.findall(r"^(?:<p>)?(?:[-*]|\d+\.) .*|^\|.*", text, re.M)]
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
