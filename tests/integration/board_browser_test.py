"""A leaderboard of 200 made-up entries in headless Chromium; skipped by name where Chromium or Selenium is missing.

LGABENCH_STUDY_SHOTS names a directory that screenshots are put into, to be looked at.
"""
import json
import os
import subprocess
import unittest

import axe
from case import BUILD, Case
from study_browser_test import CONTRAST, MISSING, NAMELESS, Browser

# What is wider than its place: a frame that can be scrolled neither by the keyboard nor beside its rows' names, or the page.
WIDER = """return [...document.querySelectorAll(".frame")].filter((f) => f.scrollWidth > f.clientWidth + 1)
    .filter((f) => innerWidth < 900 || f.tabIndex !== 0 || !f.querySelector("tbody .pinned"))
    .map((f) => f.getAttribute("aria-label")).concat(
    document.documentElement.scrollWidth > innerWidth ? [document.documentElement.scrollWidth] : [])"""
INNER = """return [...document.querySelectorAll("main .frame")].filter((f) => f.scrollHeight > f.clientHeight + 1).map((f) => f.getAttribute("aria-label"))"""
HEADLESS = """return [...document.querySelectorAll("main .frame")].filter((f) => f.querySelector("thead") &&
    getComputedStyle(f.querySelector("thead")).display === "none").map((f) => f.getAttribute("aria-label"))"""
ONE_SUITE = """return [...document.querySelectorAll("#overview-any-policy :is(thead, tbody) tr:not([hidden])")]
    .map((row) => [...row.cells].filter((cell) => cell.checkVisibility()).map((cell) => cell.textContent))"""
COLUMN = """return [...document.querySelectorAll("#table1 > .frame tbody tr:not([hidden])")].map((row) => row.cells[arguments[0]].textContent.trim())"""


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class BoardInABrowser(Case):
    @classmethod
    def setUpClass(cls):
        cls.made = cls()
        cls.made.setUp()
        cls.addClassCleanup(cls.made.doCleanups)
        cls.board = cls.made.dir / "board"
        subprocess.run([BUILD / "bin/leaderboard_test", "--gtest_filter=Board.TwoHundredEntries*"], check=True,
                       capture_output=True, env={**os.environ, "LGABENCH_KEEP_BOARD": str(cls.board)})

    def runTest(self):
        pass

    def open(self, page="q1.html", **looks):
        self.browser = Browser(self, **looks).open(f"file://{self.board}/{page}")
        self.browser.until(lambda: self.script("return document.readyState === 'complete'"), "expected a page")
        self.assertEqual(self.browser.complaints(), [])

    def script(self, text, *arguments):
        return self.browser.driver.execute_script(text, *arguments)

    def press(self, *keys):
        """By the keyboard, wherever the focus is."""
        self.browser.driver.switch_to.active_element.send_keys(*keys)

    def click(self, selector):
        self.script("document.querySelector(arguments[0]).click()", selector)

    def test_rows_are_sorted_and_filtered(self):
        self.open()
        names = self.script(COLUMN, 1)
        self.assertEqual((len(names), *names[:2], names[-1]), (200, "Oracle", "method of author 196", "Best constant action"))
        success = [float(text[:5]) for text in self.script(COLUMN, 2)]
        self.click("#table1 thead th:nth-child(3) button")
        self.assertEqual([float(text[:5]) for text in self.script(COLUMN, 2)], sorted(success, reverse=True))
        self.click("#table1 thead th:nth-child(3) button")
        self.assertEqual([float(text[:5]) for text in self.script(COLUMN, 2)], sorted(success))
        self.click("#table1 input[type=search]")
        self.script("document.querySelector('#table1 input[type=search]').focus()")
        self.press("AUTHOR_19")
        self.assertEqual(set(self.script(COLUMN, 1)), {"method of author 19"}, "an id finds its words")
        self.press("\b" * 9)
        self.assertEqual(len(self.script(COLUMN, 1)), 200)
        self.assertLess(max(self.script("return [...document.querySelectorAll('#table1 .frame:not(details *) tbody tr')].map((row) => row.offsetHeight)")),
                        48, "a row is two lines: a number, and its interval")

    def published(self, page, **looks):
        published = BUILD.parent.parent / "results/leaderboard" / page
        if not published.exists():
            self.skipTest("no sources beside the build tree")
        self.browser = Browser(self, **looks).open(f"file://{published}")
        self.assertEqual(self.browser.complaints(), [])

    def test_a_page_begins_with_the_best_rows_of_each_method(self):
        self.published("q1.html")
        best = self.script(COLUMN, 1)
        shown = list(zip(best, self.script(COLUMN, 3)))
        self.assertEqual(len(set(shown)), len(shown))
        self.assertLessEqual({("LGA", "centroid, untrained"), ("LGA", "heat map")}, set(shown), "the page's subject")
        ranks = "return [...document.querySelectorAll('#table1 > .frame tbody tr:not([hidden])')].map((row) => [row.cells[0].textContent, row.cells[0].dataset.hidden])"
        above = hidden = 0  # rows with a rank: those in view, and those that a row says are hidden
        for rank, said in self.script(ranks):
            if rank == "–":
                continue
            hidden += int(said.split()[1]) if said else 0
            self.assertLessEqual(int(rank), 1 + above + hidden, "each gap is explained where it stands")
            above += 1
        self.assertGreater(hidden, 0)
        self.click(".filter input[type=checkbox]")
        everything = self.script(COLUMN, 1)
        self.assertGreater(len(everything), len(best))
        self.assertEqual(self.script("return document.querySelectorAll('[data-hidden]').length"), 0, "nothing is hidden")
        self.assertGreater(everything.count("LGA"), 1)
        self.script("const box = document.querySelector('.filter input'); box.value = 'lga'; box.oninput()")
        self.assertEqual(set(self.script(COLUMN, 1)), {"LGA"}, "a whole word")

    def test_a_table_shows_one_ranking_and_tabs_lead_to_the_others(self):
        shown = "return [...document.querySelectorAll('main section:not([hidden]) > h2')].map((h) => h.textContent)"
        for page, tabs in ("q1.html", ["Any policy", "Paper's network"]), ("clutter.html", ["Answers only, curve", "Any policy", "Answers only, abstraction"]), \
                ("index.html", ["Any policy", "Paper's network", "Answers only"]):
            with self.subTest(page):
                self.published(page)
                self.assertEqual(self.script("return [...document.querySelectorAll('[role=tab]')].map((t) => t.textContent)"), tabs)
                self.assertEqual([title for title in self.script(shown) if title in tabs], tabs[:1])
                self.script("document.querySelector('[role=tab]').focus()")
                self.press("\ue014")  # arrow right
                self.assertEqual([title for title in self.script(shown) if title in tabs], tabs[1:2])
                self.assertEqual(self.script("return document.activeElement.getAttribute('aria-selected')"), "true")

    def test_the_first_page_has_methods_by_suites_with_filters(self):
        self.published("index.html")
        rows = "return [...document.querySelectorAll('#overview-any-policy tbody tr:not([hidden])')].map((row) => [...row.cells].map((c) => c.textContent))"
        heads = self.script("return [...document.querySelectorAll('#overview-any-policy thead th')].map((h) => h.textContent)")
        first = self.script(rows)
        self.assertGreaterEqual(min(sum(cell != "–" for cell in row[3:-1]) for row in first), (len(heads) - 4) / 2, "no rows of few suites")
        constant = [row[0] for row in first].index("Best constant action")
        self.assertLess(max([row[0] for row in first].index(name) for name in ("True mask", "LGA", "GCBC-SEG")), constant)
        self.click(".filter input[type=checkbox]")
        everything = self.script(rows)
        self.assertGreater(len(everything), len(first))
        self.assertEqual(heads[:3], ["method", "policy", "answers"])
        self.assertGreater(len(heads), 10)
        self.script("const one = document.querySelector('.filter select[aria-label=policy]'); one.value = 'heat map'; one.onchange()")
        chosen = self.script(rows)
        self.assertEqual({row[1] for row in chosen}, {"heat map"})
        self.assertLess(len(chosen), len(everything))
        self.script("const one = document.querySelector('.filter select[aria-label=policy]'); one.value = ''; one.onchange()")
        for suite in "Clutter and near misses", "":
            self.script("const one = document.querySelector('.filter select[aria-label=suite]'); one.value = arguments[0]; one.onchange()", suite)
            if suite:
                seen = self.script(ONE_SUITE)
                self.assertEqual({len(row) for row in seen}, {4}, "the other suites' columns are hidden")
                self.assertEqual(seen[0][3], suite)
                success = [float(row[3]) for row in seen[1:]]
                self.assertEqual(success, sorted(success, reverse=True))
                self.assertGreater(len(success), len(first), "rows of few suites too, all of which are in this one")
        self.assertEqual(self.script(rows), everything, "as they were")
        self.click("#overview-any-policy tbody tr:not([hidden]) td a")
        self.browser.until(lambda: self.script("return document.getElementById('panel')?.open"), "a number leads to its episodes")

    def test_a_number_shows_scenes_of_its_entry(self):
        """Of the scenario that the list says, which the command below has too."""
        self.published("q1.html")
        loaded = "return [...document.querySelectorAll('#panel .scenes img')].map((i) => i.complete && i.naturalWidth)"
        chosen = "return [document.querySelector('#outcome option:checked').textContent, document.querySelector('#panel .scenes small')?.textContent ?? '']"
        self.click("#table1 tbody tr:not(.reference) button.rate")
        self.browser.until(lambda: 516 in self.script(loaded), "a picture")
        self.assertIn("Where it does worst", self.browser.text())
        title, where = self.script(chosen)
        self.assertTrue(where.startswith(title + ","), where)
        other = self.script("return [...document.querySelectorAll('#panel [data-scenario]')].map((b) => b.textContent)")
        self.assertEqual(len(other), 1, "the best episode is of another scenario")
        self.click("#panel [data-scenario]")
        self.browser.until(lambda: 516 in self.script(loaded), "another picture")
        title, where = self.script(chosen)
        self.assertTrue(where.startswith(title + ",") and other == [f"Where it does best: {title}"], (title, where, other))
        command = self.script("return document.querySelector('#panel pre').textContent")
        self.assertIn("--scenarios " + self.script("return document.getElementById('outcome').value"), command)
        unseen = """const choice = document.getElementById("outcome"), seen = [...document.querySelectorAll("#panel [data-scenario]")];
            choice.value = [...choice.options].map((one) => one.value).find((id) => !data.entries.some((entry) => entry.scenes.some((scene) => scene.scenario === id)) ||
                !seen.some((button) => button.dataset.scenario === id) && id !== choice.value);
            choice.onchange();
            return document.querySelectorAll("#panel .scenes img").length"""
        self.assertEqual(self.script(unseen), 0)

    def test_a_number_leads_by_the_keyboard_to_the_episodes_of_its_entry(self):
        self.open()
        self.script("document.querySelector('#table1 tbody button').focus()")
        self.press("\ue015")  # arrow down
        self.press("\n")
        self.assertTrue(self.script("return document.getElementById('panel').open"))
        entry = self.script("return data.entries[1]")
        self.assertIn(entry["name"], self.browser.text())
        self.assertRegex(self.browser.driver.current_url, "#row=1000$")
        shown = self.script("return [...document.querySelectorAll('#panel tbody tr')].map((row) => row.cells[4].textContent)")
        lines = (self.board / entry["place"] / "cells.jsonl").read_text().splitlines()
        scenario = self.script("return document.getElementById('outcome').value")
        outcomes = [cell["outcomes"]["test"] for cell in map(json.loads, lines) if cell["scenario"] == scenario]
        self.assertEqual(shown, [f"{letters.count('.')} of {len(letters)}" for letters in outcomes])
        self.assertIn(f"--scenarios {scenario}", self.script("return document.querySelector('#panel pre').textContent"))
        self.press("\ue00c")  # escape
        self.assertFalse(self.script("return document.getElementById('panel').open"))
        self.assertEqual(self.script("return document.activeElement.dataset.row"), "1000")
        address = self.browser.driver.current_url
        self.browser.open("about:blank").open(f"{address}#row=1003")  # the second entry's third scenario
        self.assertEqual(self.script("return document.getElementById('outcome').selectedIndex"), 2)

    def test_looks(self):
        for width in 1280, 390:
            for dark in False, True:
                for page in "index.html", "q1.html":
                    with self.subTest(page, width=width, dark=dark):
                        self.open(page, width=width, dark=dark)
                        self.browser.shot(f"board-{page}-{width}-{dark}")
                        self.assertEqual(self.script(WIDER), [])
                        self.assertEqual(self.script(INNER), [], "a box that scrolls downwards in the page")
                        if width >= 900:
                            self.assertEqual(self.script(HEADLESS), [], "tables stay tables")
                        self.assertEqual(self.script(NAMELESS), [])
                        self.assertGreaterEqual(self.script(CONTRAST)[0], 4.5, self.script(CONTRAST)[1])
                        if page != "index.html":
                            self.click("#table1 button.rate")
                            self.browser.shot(f"board-dialog-{width}-{dark}")
                            panel = "const panel = document.getElementById('panel'); return panel.scrollWidth - panel.clientWidth"
                            self.assertEqual(self.script(panel), 0)
                            self.assertEqual(self.script(WIDER), [])

    @axe.needed
    def test_axe_finds_nothing(self):
        for width, dark in (1280, False), (390, True):
            for page in "index.html", "q1.html":
                with self.subTest(page, width=width, dark=dark):
                    self.open(page, width=width, dark=dark)
                    self.assertEqual(axe.findings(self.browser.driver), [])
                    if page != "index.html":
                        self.click("#table1 button.rate")
                        self.assertEqual(axe.findings(self.browser.driver), [], "episodes")

    def test_no_column_is_cut_on_a_desk(self):
        for page in "index.html", "q1.html", "clutter.html":
            with self.subTest(page):
                self.published(page, width=1280)
                wide = """return [...document.querySelectorAll("main section:not([hidden]) > .frame")]
                    .filter((f) => f.scrollWidth > f.clientWidth + 1).map((f) => f.getAttribute("aria-label"))"""
                self.assertEqual([name for name in self.script(wide) if "scenario" not in name], [])

    def test_a_suites_page_is_one_click_from_the_index(self):
        self.open("index.html")
        self.assertEqual(len(self.script("return [...document.querySelectorAll('tbody tr:not(.reference)')]")), 197)
        self.assertEqual(len(self.script("return [...document.querySelectorAll('tbody tr.reference')]")), 3)
        self.click("main a[href='q1.html']")
        self.browser.see("13 scenarios, 10, 20, 30, 40, 50 demonstrations")


if __name__ == "__main__":
    unittest.main(verbosity=2)
