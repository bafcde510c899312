"""report.html as a browser shows it: nothing that axe-core finds serious, nothing wider than the screen or the paper, few stops
of the tab key, and a dialog that leads from a number to an episode. Needs Chromium, its driver and Selenium."""
import pathlib
import shutil
import unittest

import axe
from case import BUILD, BesideOneRun
from study_browser_test import CONTRAST, MISSING, By, Keys, Service, webdriver
from visible_ids import visible_ids

A4 = 680  # pixels of CSS between its margins
SCROLLS = """return [...document.querySelectorAll(".frame")].filter((f) => f.scrollWidth > f.clientWidth + 1)
    .map((f) => f.getAttribute("aria-label")).concat(
    document.documentElement.scrollWidth > innerWidth ? [document.documentElement.scrollWidth] : [])"""


class InABrowser(BesideOneRun):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"):
            options.add_argument(argument)
        cls.browser = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
        cls.addClassCleanup(cls.browser.quit)

    def open(self, width=1280, scheme="light", media="", place="", folded=False):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": media, "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.browser.get("about:blank")
        self.browser.get(f"file://{self.first.dir}/run/report.html{place}")
        if not folded:
            self.script("for (const folded of document.querySelectorAll('details')) folded.open = true")
        self.script("return new Promise((then) => requestAnimationFrame(() => requestAnimationFrame(then)))")
        self.assertEqual([entry for entry in self.browser.get_log("browser")], [])

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def click(self, selector):
        self.script("document.querySelector(arguments[0]).click()", selector)

    def shown(self, selector):
        return self.script("return [...document.querySelectorAll(arguments[0])].map((e) => e.textContent)", selector)

    def press(self, key, of="document.activeElement"):
        self.script(f"{of}.dispatchEvent(new KeyboardEvent('keydown', {{key: arguments[0], bubbles: true, cancelable: true}}))", key)



@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class PageInABrowser(InABrowser):
    run_of_class = ("run", "q2", "--scenarios", "q2_heart,q2_letter", "--methods", "lga,lga_s,gcbc_dart", "--demos", "10",
                    "--seeds", "0,1", "--episodes", "5", "--set", "*.epochs=20")

    @axe.needed
    def test_axe_finds_nothing(self):
        for scheme in ("light", "dark"):
            for width in (1280, 390):
                self.open(width, scheme)
                with self.subTest(scheme, width=width, what="page"):
                    self.assertEqual(axe.findings(self.browser), [])
                self.click("button.rate")
                with self.subTest(scheme, width=width, what="episodes"):
                    self.assertEqual(axe.findings(self.browser), [])
                self.click("dialog .zoom")
                with self.subTest(scheme, width=width, what="an episode"):
                    self.assertEqual(axe.findings(self.browser), [])

    def test_nothing_is_wider_than_its_place(self):
        wide = """return [...document.querySelectorAll(".frame")].filter((f) => f.scrollWidth > f.clientWidth + 1)
                  .filter((f) => innerWidth < 900 || f.tabIndex !== 0 || !f.querySelector("tbody .pinned"))
                  .map((f) => f.getAttribute("aria-label"))"""
        page = "return document.documentElement.scrollWidth"
        for width in (1280, 768, 390):
            with self.subTest(width):
                self.open(width)
                self.assertEqual(self.script(wide), [])
                self.assertLessEqual(self.script(page), width)
        self.open(A4, media="print")
        self.script("dispatchEvent(new Event('beforeprint'))")
        self.assertEqual(self.script(wide), [])
        self.assertLessEqual(self.script(page), A4)
        self.assertEqual(self.script("return document.querySelectorAll('main details:not([open])').length"), 0)
        # An interval is one line below its number, and text is as dark as on the screen.
        numbers = "return [...document.querySelectorAll('.frame:not(.list) .rate')].map((e) => e.getBoundingClientRect().height)"
        self.assertLess(max(self.script(numbers), default=0), 65)
        self.assertEqual(self.script("return getComputedStyle(document.querySelector('h1')).color"), "rgb(27, 31, 36)")

    def test_a_table_and_a_chart_are_one_stop_each(self):
        self.open()
        stops = """return [...document.querySelectorAll("main *")].filter((e) => e.tabIndex >= 0).length"""
        boxes = len(self.script("return [...document.querySelectorAll('main table, main svg.chart')].map(() => 1)"))
        folded = len(self.shown("main summary, main p a, main .frame[tabindex]"))
        self.assertGreater(len(self.shown("main button")), 60)
        self.assertLessEqual(self.script(stops), boxes + folded)
        self.script("document.querySelector('tbody button.rate').focus()")
        begun = self.script("return document.activeElement.dataset.row")
        self.press("ArrowRight")
        beside = self.script("return document.activeElement.dataset.row")
        self.assertNotEqual(beside, begun)
        self.assertEqual(self.script("return document.activeElement.tabIndex"), 0)
        self.press("ArrowLeft")
        self.assertEqual(self.script("return document.activeElement.dataset.row"), begun)
        self.assertLessEqual(self.script(stops), boxes + folded)

    def test_a_name_in_a_legend_hides_its_curve(self):
        self.open()
        shown = """return [...document.querySelector("svg.chart:has(.entry)").querySelectorAll(":scope > .series")]
            .filter((curve) => curve.getClientRects().length).map((curve) => curve.dataset.series)"""
        pressed = "return document.querySelector('svg.chart .entry').getAttribute('aria-pressed')"
        before = self.script(shown)
        self.assertIn("LGA", before)
        entry = "document.querySelector('svg.chart .entry')"
        self.script(f"{entry}.dispatchEvent(new MouseEvent('click', {{bubbles: true}}))")
        self.assertEqual((self.script(shown), self.script(pressed)), ([name for name in before if name != "LGA"], "false"))
        self.assertTrue(self.script(f"return document.activeElement === {entry}"), "where the keyboard goes on")
        self.press("Enter")
        self.assertEqual((self.script(shown), self.script(pressed)), (before, "true"))

    def test_figures_and_tables_can_be_taken_away(self):
        self.open()
        self.script("""window.saved = [];
            URL.createObjectURL = (blob) => { blob.text().then((text) => saved.push(text)); return "#saved"; };
            HTMLAnchorElement.prototype.click = function () { saved.push(this.download); };""")
        names = self.shown("#take optgroup[label=CSV] option")
        self.assertEqual(len(names), len(self.shown("main .frame")))
        for ending, begun in ("SVG", "<svg xmlns=\"http://www.w3.org/2000/svg\""), ("CSV", "group,method,"):
            text = self.script("""saved.length = 0;
                const take = document.getElementById("take");
                take.value = take.querySelector(`optgroup[label=${arguments[0]}] option`).value;
                take.onchange();
                return new Promise((then) => setTimeout(() => then(saved), 100));""", ending)
            self.assertTrue(text[0].endswith(ending.lower()), text[0])
            self.assertTrue(text[1].startswith(begun), text[1][:100])
        self.script("[...document.querySelector('.frame tbody').rows[0].cells].forEach((cell, i) => {"
                    " cell.textContent = ['-0.25', '+1', '=SUM(A1)', '-0.2 [-1, 0]'][i % 4]; })")
        self.assertIn(",-0.25,+1,'=SUM(A1)", self.script("return csvOf(document.querySelector('.frame'))"))

    def test_a_column_is_sorted_by_its_numbers(self):
        self.open()
        texts = self.script("""const table = document.querySelector("table.sortable"), body = table.tBodies[0];
            const texts = ["0.5", "< 0.001", "–", "0.02", "-0.1"];
            [...body.rows].forEach((row, i) => { row.cells[1].textContent = texts[i] || "words"; });
            table.querySelector("thead th:nth-child(2) button").click();
            return [...body.rows].map((row) => row.cells[1].textContent);""")
        self.assertEqual(texts[:4], ["0.5", "0.02", "< 0.001", "-0.1"], "the largest first")

    def test_a_number_leads_to_its_episodes_and_these_to_one(self):
        self.open()
        self.click("tbody button.rate")
        address = self.browser.current_url
        self.assertRegex(address, r"#row=\d+$")
        pictured = len(self.shown("dialog .scenes figure"))
        self.assertGreater(pictured, 1)
        self.click("dialog .zoom")
        self.assertRegex(self.browser.current_url, r"&episode=[0-9a-f]{16}%2F\w+%2F\d+$")
        (before, *_) = self.script("return [...document.querySelectorAll('.large figure')].map((f) => f.innerHTML)")
        for colour, what in (("#fff", "the action"), ("#5dff8f", "the oracle's"), ("#ffe100", "the target")):
            self.assertIn(f'stroke="{colour}"', before, what)
        captions = self.shown(".large figcaption")
        self.assertTrue(any(caption.startswith("after the action") for caption in captions), captions)
        self.assertIn("what the policy saw: goal mask, 36 × 72", captions)
        one = self.browser.current_url
        self.press("ArrowRight", "document.getElementById('panel')")
        self.assertNotEqual(self.browser.current_url, one)
        self.press("ArrowLeft", "document.getElementById('panel')")
        self.assertEqual(self.browser.current_url, one)

        narrow = "return document.querySelector('.large figure').getBoundingClientRect().width"
        small = self.script(narrow)
        self.click(".large .zoom")
        self.assertGreater(self.script(narrow), 1.8 * small)

        self.open(place=one[one.index("#"):])  # a link to this episode
        self.assertEqual(len(self.shown(".large figure")) > 0, True)
        self.click("#all")
        self.assertEqual(self.browser.current_url, address)

        # A count of failures leads to these.
        self.click("#close")
        outcome = self.script("const count = document.querySelector('.count'); count.click(); return count.dataset.outcome")
        self.assertEqual(set(self.shown("dialog .scenes figcaption b")), {outcome})
        self.assertEqual(self.script("return document.getElementById('outcome').value"), outcome)


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class ClutterInABrowser(InABrowser):
    """Of a run with many arms, which a stranger reads."""
    run_of_class = ("run", "clutter", "--preset", "smoke", "--methods", "lga,gcbc_seg,factorial+scenes=truth+input=object_mask",
                    "--episodes", "4", "--set", "*.epochs=3")

    def test_every_column_is_in_view(self):
        for width in (1280, 1920):
            self.open(width)
            self.assertEqual(self.script(SCROLLS), [], width)
        self.open()
        self.assertEqual(self.script("""return [...document.querySelectorAll("main .frame *")]
            .filter((e) => e.getClientRects().length && e.textContent.trim() && parseFloat(getComputedStyle(e).fontSize) < 13)
            .map((e) => e.outerHTML.slice(0, 80))"""), [])
        heads = self.shown("#success .frame thead th")
        self.assertEqual([head for head in heads if "near" in head][:4],
                         ["1 near miss", "2 near misses", "4 near misses", "6 near misses"])

    def test_a_chart_alone_is_as_wide_as_the_page(self):
        for width in (1280, 390):
            self.open(width)
            (chart, page), *more = self.script("""return [...document.querySelectorAll("#success > .charts:first-of-type svg")]
                .filter((e) => e.getClientRects().length)
                .map((e) => [e.getBoundingClientRect().width, document.querySelector("main section").clientWidth])""")
            self.assertEqual(more, [], "once")
            self.assertGreater(chart, page - 20, width)
            size = self.script("""return [...document.querySelectorAll("#success svg text")].filter((e) => e.getClientRects().length)
                .map((e) => e.getBoundingClientRect().height)""")
            self.assertGreater(min(size), 8, "text that can be read")

    def test_the_first_chart_is_on_the_first_screen(self):
        """Below no list of links, and above the arms, which are its places."""
        for width in (1280, 390):
            self.open(width, folded=True)
            top, links, arms = self.script("""const chart = [...document.querySelectorAll("#success svg.chart")].find((e) => e.getClientRects().length);
                const above = (e) => e.compareDocumentPosition(chart) & Node.DOCUMENT_POSITION_FOLLOWING;
                return [chart.getBoundingClientRect().top,
                    [...document.querySelectorAll("body a:not(.skip)")].filter((e) => e.checkVisibility() && above(e)).map((e) => e.textContent),
                    [...document.querySelectorAll(".arms li")].map((e) => !above(e))]""")
            self.assertLess(top, 800, width)
            self.assertEqual(links, [])
            self.assertEqual(arms, [True] * 8)

    def test_a_point_tells_its_value(self):
        self.open()
        told = self.script("""const point = document.querySelector("#success .wide .point");
            point.dispatchEvent(new MouseEvent("mouseenter"));
            return [document.getElementById("tip").hidden, document.getElementById("tip").textContent]""")
        self.assertEqual(told[0], False)
        self.assertRegex(told[1], r" at 1 other: \d\.\d\d \[")

    def test_words_stand_in_place_of_ids(self):
        for width in (1280, 390):
            self.open(width)
            self.assertEqual(visible_ids(self.browser), [])
            self.click("tbody button.rate")
            self.assertEqual(visible_ids(self.browser), [], "episodes")
        self.open()
        text = self.script("return document.body.innerText")
        for words in ("Clutter and near misses", "plain colored vessel", "trained in true scenes", "with a heat map"):
            self.assertIn(words, text)
        self.assertIn("near_4", self.shown(".arms code"), "the id that files have")

    def test_symbols_are_explained_where_they_stand(self):
        self.open()
        below = """return [...document.querySelectorAll("main .frame")].flatMap((frame) => {
            const signs = [...frame.querySelectorAll("td [title]")].map((e) => e.textContent.trim());
            if (frame.querySelector("td small")) signs.push("[low, high]");
            const next = frame.nextElementSibling, said = next?.matches(".legend") ? next.textContent : "";
            return [...new Set(signs)].map((sign) => [sign, said.includes(sign)]);
          })"""
        told = self.script(below)
        self.assertIn(["[low, high]", True], told)
        self.assertTrue(any(sign in "†§=‡" for sign, _ in told), told)
        self.assertEqual([sign for sign, said in told if not said], [])
        self.assertIn("selected as mattering", self.script("return document.querySelector('#phi p').textContent"))

    def test_a_link_to_it_has_a_card_and_an_icon(self):
        self.open()
        card = self.script("return Object.fromEntries([...document.querySelectorAll('meta[property]')]"
                           ".map((e) => [e.getAttribute('property'), e.content]))")
        self.assertEqual(card["og:title"], self.script("return document.querySelector('h1').textContent"))
        self.assertEqual(card["og:description"], self.script("return document.querySelector('.headline').textContent"))
        self.assertTrue(self.script("return document.querySelector('link[rel=icon]').href").startswith("data:image/svg+xml,"))


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class StepsInABrowser(InABrowser):
    """Of episodes of several steps, in an environment whose actions are no places of the picture."""
    source = pathlib.Path(__file__).resolve().parents[2] / "examples/reach2d"
    run_of_class = ("run", source / "reach2d_suite.json", "--answers", "none", "--engines", "own", "--methods", "human", "--demos", "1",
                    "--seeds", "0", "--episodes", "4", "--set", "human.epochs=1")

    def setUp(self):
        super().setUp()
        self.environment.update(LGABENCH_PLUGIN_PATH=str(BUILD / "tests/plugins/examples"), LGABENCH_SCENARIO_PATH=str(self.source))

    def open_episode(self, *looks):
        """The slider of a row's first episode, and the pictures that it goes through."""
        self.open(*looks)
        self.click("button.rate")
        self.click("dialog .zoom")
        pictures = self.script("""const one = episodesOf(now.row).find((e) => episodeId(e) === now.episode);
            return [one.picture, ...one.end.map((end) => end || one.picture)]""")
        return self.browser.find_element(By.CSS_SELECTOR, ".stepwise input"), pictures

    def assert_step(self, number, pictures):
        caption, said, *shown = self.script("""const figure = document.querySelector(".stepwise");
            return [figure.querySelector("figcaption").textContent, figure.querySelector("input").getAttribute("aria-valuetext"),
                ...[...figure.querySelectorAll("svg")].filter((e) => e.checkVisibility()).map((e) => e.querySelector("image").getAttribute("href"))]""")
        self.assertEqual(shown, ["data:image/png;base64," + pictures[number]])
        last = len(pictures) - 1
        self.assertTrue(caption.startswith(f"after step {number} of {last}" if number else f"before step 1 of {last}"), caption)
        self.assertEqual(said, caption)

    def test_a_slider_goes_through_the_steps(self):
        slider, pictures = self.open_episode()
        self.assertGreater(len(pictures), 4)
        self.assertGreater(len(set(pictures)), 2, "something moves")
        self.assert_step(len(pictures) - 1, pictures)
        address = self.browser.current_url
        for keys, step in ((Keys.HOME, 0), (Keys.ARROW_RIGHT, 1), (Keys.ARROW_RIGHT, 2), (Keys.ARROW_LEFT, 1), (Keys.END, len(pictures) - 1)):
            slider.send_keys(keys)
            self.assert_step(step, pictures)
        self.assertEqual(self.browser.current_url, address, "its arrows lead to no other episode")
        webdriver.ActionChains(self.browser).move_to_element_with_offset(slider, 2 - slider.size["width"] // 2, 0).click().perform()
        self.assert_step(0, pictures)

    def test_what_is_enlarged_stays_so_while_it_slides(self):
        slider, _ = self.open_episode()
        width = "return document.querySelector('.stepwise').getBoundingClientRect().width"
        small = self.script(width)
        enlarge = "[...document.querySelectorAll('.stepwise .zoom')].find((e) => e.checkVisibility()).click()"
        self.script(enlarge)
        slider.send_keys(Keys.HOME)
        self.assertGreater(self.script(width), 1.8 * small)
        self.script(enlarge)
        self.assertEqual(self.script(width), small)

    def test_it_stands_beside_the_beginning_at_every_width(self):
        for width in (1280, 390):
            for scheme in ("light", "dark"):
                with self.subTest(width, scheme=scheme):
                    slider, _ = self.open_episode(width, scheme)
                    self.assertEqual(self.script("return document.querySelector('.large').children[1].className"), "stepwise")
                    self.assertLess(slider.rect["y"] + slider.rect["height"], 900, "on the first screen")
                    self.assertEqual(self.script("const panel = document.getElementById('panel'); return panel.scrollWidth - panel.clientWidth"), 0)
                    self.assertEqual(self.shown(".large figcaption")[0], "before: the target outlined", "no action is drawn")
                    self.assertGreaterEqual(self.script(CONTRAST)[0], 4.5, self.script(CONTRAST)[1])

    @axe.needed
    def test_axe_finds_nothing(self):
        self.open_episode()
        self.assertEqual(axe.findings(self.browser), [])


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class WholePageInABrowser(InABrowser):
    """Of a run as people make it: five methods, two numbers of demonstrations, three scenarios, two seeds."""
    run_of_class = ("run", "q1", "--scenarios", "heart,letter,something_to_drink_water_out_of", "--demos", "10,50", "--seeds", "0,1",
                    "--methods", "lga,human,lga_s,gcbc_seg,gcbc_dart", "--set", "*.epochs=5")

    def test_every_column_is_in_view_and_no_id(self):
        self.open()
        self.assertEqual(self.script(SCROLLS), [])
        self.assertEqual(visible_ids(self.browser), [])

    def test_it_is_short(self):
        self.open(folded=True)
        self.assertLess(self.script("return document.documentElement.scrollHeight"), 6500)  # no table hides rows in a box of its own

    def test_tables_are_tables_whose_heads_and_names_stay_in_view(self):
        stays = """return [...document.querySelectorAll("main .frame")].filter((frame) => {
            const head = frame.querySelector("thead th"), shown = getComputedStyle(head);
            frame.scrollTop = 1e6;
            const stuck = Math.abs(head.getBoundingClientRect().top - frame.getBoundingClientRect().top) < 2 || frame.scrollTop === 0;
            return shown.display !== "table-cell" || shown.position !== "sticky" || !stuck ||
              frame.querySelectorAll("tbody tr:not(.group)").length > 1 && !frame.querySelector("thead button");
          }).map((frame) => frame.getAttribute("aria-label"))"""
        for width in (900, 1280, 1920):
            self.open(width)
            self.assertEqual(self.script(stays), [], width)

    def test_no_heading_is_cut_on_paper(self):
        self.open(A4, media="print")
        split = """return [...document.querySelectorAll("main h2, main h3, main summary")].filter((heading) => {
            const looks = getComputedStyle(heading);
            return looks.breakInside !== "avoid" || looks.breakAfter !== "avoid";
          }).map((heading) => heading.textContent)"""
        self.assertEqual(self.script(split), [])


if __name__ == "__main__":
    unittest.main()
