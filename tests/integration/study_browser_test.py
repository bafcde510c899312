"""The user study in headless Chromium, as a person takes it; skipped by name where Chromium or Selenium is missing.

LGABENCH_STUDY_SHOTS names a directory that screenshots are put into, to be looked at.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

try:
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:  # Debian's packages are those of Debian's interpreter
    debian = "/usr/bin/python3"
    if sys.executable != debian and os.access(debian, os.X_OK) and not os.environ.get("LGABENCH_SECOND_PYTHON"):
        os.environ["LGABENCH_SECOND_PYTHON"] = "1"
        os.execv(debian, [debian, *sys.argv])
    webdriver = Service = By = Keys = None

import axe
from study_people import SMALL, Server, StudyCase, events

FULL = os.environ.get("LGABENCH_FULL") == "1"
SHOTS = os.environ.get("LGABENCH_STUDY_SHOTS")
MISSING = [name for name, there in (("python3-selenium", webdriver), ("chromium", shutil.which("chromium")),
                                    ("chromium-driver", shutil.which("chromedriver"))) if not there]
PATIENCE = 30  # seconds

# The lowest contrast of any text that is shown, against the nearest background that is not transparent (WCAG 2.1).
CONTRAST = """
const channel = c => (c /= 255) <= .03928 ? c / 12.92 : ((c + .055) / 1.055) ** 2.4;
const numbers = text => text.match(/[\\d.]+/g).map((n, i) => n * (text.startsWith('color(') && i < 3 ? 255 : 1));
const light = ([r, g, b]) => .2126 * channel(r) + .7152 * channel(g) + .0722 * channel(b);
let worst = [99, ''];
for (const element of document.querySelectorAll('body *')) {
  const own = [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim());
  const style = getComputedStyle(element);
  if (!own || !element.getClientRects().length || element.disabled || element.tagName === 'NOSCRIPT') continue;
  let behind = element;
  while (behind && (numbers(getComputedStyle(behind).backgroundColor)[3] ?? 1) === 0) behind = behind.parentElement;
  const a = light(numbers(element.ownerSVGElement ? style.fill : style.color));
  const b = light(behind ? numbers(getComputedStyle(behind).backgroundColor) : [255, 255, 255]);
  const contrast = (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
  if (contrast < worst[0]) worst = [contrast, element.tagName + ' ' + element.textContent.slice(0, 40)];
}
return worst;
"""
# Controls without a name that a screen reader could say.
NAMELESS = """
return [...document.querySelectorAll('button, input, textarea')].filter(
  e => e.getClientRects().length && !e.textContent.trim() && !e.getAttribute('aria-label') && !(e.labels && e.labels.length))
  .map(e => e.outerHTML);
"""


class Browser:
    def __init__(self, case, width=1280, height=900, dark=False):
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--incognito"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.case = case
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        case.addCleanup(self.driver.quit)
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})

    def open(self, address):
        self.driver.get(address)
        return self

    def text(self):
        return self.driver.execute_script("return document.body.innerText")

    def until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                found = condition()
            except WebDriverException:  # the page changed meanwhile
                found = None
            if found:
                return found
            time.sleep(.03)
        self.case.fail(f"{what}; the page says: {self.text()[:600]}")

    def see(self, words):
        self.until(lambda: words in self.text(), f"expected “{words}”")
        return self

    def head(self):
        return self.driver.execute_script("return document.querySelector('h1') ? document.querySelector('h1').innerText : ''")

    def button(self, name):
        return self.until(lambda: next((b for b in self.driver.find_elements(By.TAG_NAME, "button")
                                        if b.text == name and b.is_enabled()), None), f"expected a button {name}")

    def click(self, name):
        """By the mouse; waits until the button is gone."""
        button = self.button(name)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
        button.click()
        return self

    def boxes(self):
        return self.driver.find_elements(By.CSS_SELECTOR, "input[type=checkbox]")

    def choose(self, *names):
        for name in names:
            box = self.driver.find_element(By.CSS_SELECTOR, f"input[type=checkbox][value='{name}']")
            self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", box)
            if not box.is_selected():
                box.click()

    def agree(self, then="What the robot can see"):
        self.click("I agree and begin").see(then)

    def step(self, kept_as=None):
        """One page further, whatever it shows. False at the end."""
        self.until(self.head, "expected a page")
        head = self.head()
        if kept_as:
            self.shot(kept_as)
        if head == "Thank you":
            return False
        self.driver.execute_script("document.querySelector('h1').dataset.seen = 'yes'")  # the next page has a heading of its own
        if head in ("What the robot can see", "An example", "Which objects does a command mean?"):
            self.click("Continue")
        elif head.startswith(("Practice", "Command")):
            self.click("Start")
        elif head in ("Almost done", "The first part is done"):
            self.click("Send")
        elif head == "Could the command mean this object?":
            for answer in self.driver.find_elements(By.CSS_SELECTOR, "input[type=radio][value=yes]"):
                self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", answer)
                answer.click()
            self.click("Submit")
        elif head == "Which objects could this command mean?":
            for section in self.driver.find_elements(By.CSS_SELECTOR, "section"):
                if section.find_elements(By.CSS_SELECTOR, "input:checked") == []:
                    self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", section.find_element(By.TAG_NAME, "li"))
                    section.find_element(By.CSS_SELECTOR, "input[type=checkbox]").click()
            self.click("Submit")
        else:
            self.case.fail(f"an unknown page: {head}")
        self.until(lambda: not self.driver.execute_script("return document.querySelector('h1').dataset.seen"), f"after {head}")
        return True

    def take_part(self, name=None):
        n = 0
        while self.step(name and f"{name}-{n:02}"):
            n += 1
        return self

    def shot(self, name):
        if SHOTS:
            pathlib.Path(SHOTS).mkdir(exist_ok=True)
            self.driver.save_screenshot(str(pathlib.Path(SHOTS) / f"{name}.png"))

    def complaints(self):
        """What the console says: above all that the Content-Security-Policy was broken."""
        return [entry["message"] for entry in self.driver.get_log("browser")]


@unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
class InBrowser(StudyCase):
    def start(self, protocol="paper", *more, **changes):
        self.new(protocol, **(changes or SMALL))
        self.server = Server(self, "data", *more)
        return self.server

    def check_whole(self, people=1, trials=4, report=0):
        """Every person's events: no key twice, the session complete, clicks that add up."""
        self.assertEqual(len(self.server.people()), people)
        for file in self.server.people():
            all_events = events(file)
            keys = [event["key"] for event in all_events]
            self.assertEqual(len(keys), len(set(keys)))
            submitted = [event for event in all_events if event["kind"] == "submit"]
            self.assertGreaterEqual(len(submitted), trials)
        self.server.end(signal.SIGTERM)
        self.call("study", "report", "data", expect=report)
        results = json.loads((self.dir / "data/results.json").read_text())
        self.assertEqual(results["people"], people)
        self.assertEqual(results["trials"]["clicks_disagree"], 0)
        self.assertEqual(results["trials"]["clocks_apart"], 0)
        return results


class StudySmoke(InBrowser):
    """Under a minute, in both conditions, by mouse; reload, second tab, a broken connection."""

    def test_a_session(self):
        self.start()
        page = Browser(self).open(self.server.address)
        page.see("I agree").agree()
        self.assertRegex(page.driver.current_url, r"/p/[0-9a-f]{32}$")
        page.take_part("session")
        self.assertEqual(page.driver.get_cookies(), [])
        self.assertEqual(page.driver.execute_script("return localStorage.length + sessionStorage.length"), 0)
        self.assertEqual(page.complaints(), [])
        results = self.check_whole()
        self.assertEqual(results["trials"]["interrupted"], 0)
        self.assertEqual(results["used"], 1)
        self.assertEqual(self.participants(), ["p01.json"])
        answers = json.loads((self.dir / "data/participants/p01.json").read_text())["answers"]
        self.assertTrue(all("specified" in a and "edited" in a for a in answers))

    def test_disputed_pairs(self):
        self.start("disputed", seed=1)
        page = Browser(self).open(self.server.address)
        page.agree("Which objects does a command mean?")
        page.take_part("disputed")
        self.assertEqual(page.complaints(), [])
        self.check_whole(report=3)  # whose controls failed counts for nothing

    def test_chosen_only_shows_what_is_filled_in(self):
        self.start()
        page = Browser(self).open(self.server.address)
        page.agree()
        for _ in range(3):
            page.step()
        while "filled in" not in page.text():
            page.step()
        page.click("Start").see("Submit")
        tiles = lambda: len([box for box in page.boxes() if box.is_displayed()])
        self.assertGreater(tiles(), 100)
        chosen = len([box for box in page.boxes() if box.is_selected()])
        for button in page.driver.find_elements(By.XPATH, "//button[.='Chosen only']"):
            page.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
            button.click()
            self.assertEqual(button.get_attribute("aria-pressed"), "true")
        self.assertEqual(tiles(), chosen)
        self.assertEqual(len([box for box in page.boxes() if box.is_selected()]), chosen)

    def test_a_second_kind_and_a_rule(self):
        words = [{"scenario": "words_relation_cutlery_nearest_to_plate"}]
        self.start(**dict(SMALL, meanings=True, sets=[words]))
        page = Browser(self).open(self.server.address)
        page.agree()
        page.step()
        page.step()

        def pick(select, text):
            page.driver.find_element(By.XPATH, f"//select[@id='{select}']//option[.='{text}']").click()

        def chosen():
            return [box.get_attribute("value") for box in page.boxes() if box.is_selected()]

        def choose_first(at):
            lists = page.driver.find_elements(By.XPATH, "//section[@aria-label='Object types' or @aria-label='Colors']")
            for box in (one.find_element(By.CSS_SELECTOR, "input[type=checkbox]") for one in lists[at:at + 2]):
                page.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", box)
                box.click()

        seen = {}
        while not page.head().startswith("Almost"):
            page.click("Start").see("Submit")
            filled = bool(chosen())
            if not filled:
                choose_first(0)
                page.see("Chosen: 1 object type, 1 color").click("Add another kind of object")
                page.see("Kind 2").see("in each part")
                choose_first(2)
                pick("which", "the one that comes first in this order …")
                page.see("in each part")
                pick("next", page.boxes()[0].get_attribute("value"))
                page.see("After these")
                pick("which", "the one left of …")
                page.see("Of which object?").see("in each part")
                choose_first(4)
                page.see("or 1 object type, 1 color; the one left of (1 object type, 1 color)")
            page.shot(f"meaning-{'filled' if filled else 'empty'}-{len(seen)}")
            self.assertEqual(page.driver.execute_script(NAMELESS), [])
            seen[filled] = page.text()
            head = page.head()
            page.click("Submit")
            page.until(lambda: page.head() != head, "the next page")
            if page.head() == "The first part is done":
                page.click("Send").see("Start")
        self.assertIn("the one nearest to", seen[True])
        self.assertEqual(page.complaints(), [])
        page.take_part()
        self.check_whole(trials=2)
        answer, = json.loads((self.dir / "data/participants/p01.json").read_text())["answers"]
        target = answer["specified"]["selection"]["target"]
        self.assertEqual((len(target["sets"]), target["which"]["rule"]), (2, "left_of"))
        self.assertEqual(answer["edited"]["selection"], answer["edited"]["proposal"])

    def test_who_declines_leaves_nothing(self):
        self.start()
        page = Browser(self).open(self.server.address)
        page.click("I do not agree").see("Nothing was stored")
        self.assertEqual(self.server.people(), [])

    def test_an_invitation_is_in_the_link(self):
        self.start("paper", "--invitation", "abc")
        page = Browser(self).open(self.server.address)
        page.click("I agree and begin").see("this study is by invitation")
        self.assertEqual(self.server.people(), [])
        page.open(self.server.address + "?invitation=abc").see("I agree").agree()
        self.assertEqual(len(self.server.people()), 1)

    def test_reload_and_second_tab_break_a_trial_and_lose_nothing(self):
        self.start("crossover", seed=1)
        page = Browser(self).open(self.server.address)
        page.agree()
        for _ in range(6):
            page.step()
        page.see("Command 1 of 8").click("Start").see("Submit").choose("heart", "red")
        page.driver.refresh()
        page.see("The last command was interrupted. It does not count").see("Command 2 of 9")
        page.click("Start").see("Submit")
        first = page.driver.current_window_handle
        address = page.driver.current_url
        page.driver.switch_to.new_window("tab")
        page.open(address).see("was interrupted")
        page.driver.switch_to.window(first)
        page.choose("heart")
        page.see("This session is open in another window")
        page.driver.switch_to.window(page.driver.window_handles[-1])
        page.take_part()
        results = self.check_whole(trials=10)
        self.assertEqual(results["trials"]["interrupted"], 2)
        submitted = [e for e in events(self.server.people()[0]) if e["kind"] == "submit"]
        self.assertEqual(len(submitted), 2 + 8, "two spares took the places of the two")

    def test_a_lost_connection_is_said_and_breaks_the_trial(self):
        self.start("crossover", seed=1)
        page = Browser(self).open(self.server.address)
        page.agree()
        for _ in range(6):
            page.step()
        page.click("Start").see("Submit")
        page.driver.set_network_conditions(offline=True, latency=0, throughput=1 << 20)
        page.choose("heart", "red")
        page.see("The connection to the study is lost")
        page.driver.set_network_conditions(offline=False, latency=0, throughput=1 << 20)
        page.until(lambda: "connection" not in page.text(), "trouble is over")
        page.click("Submit").see("was interrupted").take_part()
        self.assertEqual(self.check_whole(trials=11)["trials"]["interrupted"], 1)


class StudyKeyboard(InBrowser):
    def press(self, *keys):
        ActionChains(self.page.driver).send_keys(*keys).perform()

    def tab_to(self, condition, what):
        for _ in range(40):
            active = self.page.driver.switch_to.active_element
            if condition(active):
                return active
            self.press(Keys.TAB)
        self.fail(f"no Tab leads to {what}")

    def press_button(self, name):
        self.page.button(name)
        self.tab_to(lambda e: e.tag_name == "button" and e.text == name, name)
        self.press(Keys.ENTER)

    def test_a_session_without_a_mouse(self):
        self.start()
        self.page = page = Browser(self).open(self.server.address)
        self.press_button("I agree and begin")
        page.see("What the robot can see")
        while page.head() != "Thank you":
            head = page.head()
            if head.startswith("Which"):
                for feature in range(2 * len(page.driver.find_elements(By.TAG_NAME, "fieldset"))):
                    searches = page.driver.find_elements(By.CSS_SELECTOR, "input[type=search]")
                    self.tab_to(lambda e: e == searches[feature], "a search field")
                    self.press("re")  # red..., three-sided rectangle
                    box = self.tab_to(lambda e: e.get_attribute("type") == "checkbox", "the list")
                    self.press(Keys.ARROW_RIGHT)
                    after = page.driver.switch_to.active_element
                    self.assertEqual(after.get_attribute("type"), "checkbox")
                    if not after.is_selected():
                        self.press(Keys.SPACE)
                self.press_button("Submit")
            else:
                self.press_button({"What the robot can see": "Continue", "An example": "Continue", "Almost done": "Send", "The first part is done": "Send"}.get(head, "Start"))
            page.until(lambda: page.head() != head, f"after {head}")
        self.assertEqual(self.check_whole()["used"], 1)


class StudyLooks(InBrowser):
    """Every page at the widths of a phone and of a desk, light and dark: no sideways scrolling, contrast, names."""

    def look(self, width, dark, name):
        page = Browser(self, width, 844 if width < 600 else 900, dark).open(self.server.address)
        page.see("I agree")
        n, going = 0, True
        page.shot(f"{name}-consent")
        self.check(page, name + " consent")
        page.agree()
        while going:
            page.until(page.head, "a page")
            self.check(page, f"{name} {page.head()}")
            going = page.step(f"{name}-{n:02}")
            n += 1
        page.open(self.server.address + "withdraw").see("withdrawal code")
        self.check(page, name + " withdraw")

    def check(self, page, where):
        wide = page.driver.execute_script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        self.assertLessEqual(wide, 0, where)
        contrast, text = page.driver.execute_script(CONTRAST)
        self.assertGreaterEqual(contrast, 4.5, f"{where}: {text}")
        self.assertEqual(page.driver.execute_script(NAMELESS), [], where)

    def test_every_page(self):
        self.start()
        cases = [(390, True), (1280, False)] + ([(390, False), (1280, True), (640, False)] if FULL else [])  # 640: 200 % zoom
        for width, dark in cases:
            with self.subTest(width=width, dark=dark):
                self.look(width, dark, f"{width}-{'dark' if dark else 'light'}")

    @axe.needed
    def test_axe_finds_nothing(self):
        self.check = lambda page, where: self.assertEqual(axe.findings(page.driver), [], where)
        self.start()
        for width, dark in (390, True), (1280, False):
            with self.subTest(width=width, dark=dark):
                self.look(width, dark, f"axe-{width}")


@unittest.skipUnless(FULL, "with ./test --full")
class StudyStress(InBrowser):
    def test_two_people_at_once(self):
        self.start()
        people = [Browser(self).open(self.server.address) for _ in range(2)]
        for page in people:
            page.agree()
        going = set(range(2))
        while going:
            going = {i for i in going if people[i].step()}
        self.assertEqual(self.check_whole(people=2)["used"], 2)

    def test_a_slow_connection(self):
        self.start()
        page = Browser(self)
        page.driver.set_network_conditions(offline=False, latency=1500, throughput=50 << 10)
        page.open(self.server.address).agree()
        page.take_part()
        self.server.end(signal.SIGTERM)
        self.call("study", "report", "data")
        results = json.loads((self.dir / "data/results.json").read_text())
        self.assertEqual((results["used"], results["trials"]["interrupted"]), (1, 0))

    def test_kill_9_at_every_event(self):
        self.start("crossover", seed=1)
        page = Browser(self).open(self.server.address)
        page.agree()
        killed, over = 0, threading.Event()

        def kill_whenever_something_was_said():
            nonlocal killed
            said = 0
            while not over.is_set():
                size = sum(path.stat().st_size for path in self.server.people())
                if size != said:
                    self.server.kill_and_start()
                    killed, said = killed + 1, size
                time.sleep(.01)

        killer = threading.Thread(target=kill_whenever_something_was_said)
        killer.start()
        try:
            page.take_part()
        finally:
            over.set()
            killer.join()
        self.assertGreater(killed, 30)
        self.server.kill_and_start()
        file, = self.server.people()
        all_events = events(file)
        self.assertEqual(len({e["key"] for e in all_events}), len(all_events))
        self.assertEqual(len([e for e in all_events if e["kind"] == "begin"]), 1)
        self.server.end(signal.SIGTERM)
        self.call("study", "report", "data")
        results = json.loads((self.dir / "data/results.json").read_text())
        self.assertEqual(results["trials"]["clicks_disagree"], 0)
        started = [e for e in all_events if e["kind"] == "start"]
        submitted = [e for e in all_events if e["kind"] == "submit"]
        self.assertEqual(len(started), len(submitted), "the page went on through all of it")
        self.assertGreaterEqual(len(submitted), 10)


if __name__ == "__main__":
    unittest.main(verbosity=2)
