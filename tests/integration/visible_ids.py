"""Ids that a page shows: words with "_", and lower-case ones with a digit inside, in visible text that is no code."""
import html.parser
import re

ID = re.compile(r"\b[A-Za-z0-9]+(?:_[A-Za-z0-9]+)+\b|\b[a-z]+\d\w*\b")
HIDDEN = {"script", "style", "code", "pre", "noscript"}
TEXTS = """const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), texts = [];
    while (walker.nextNode()) {
      const around = walker.currentNode.parentElement;
      if (around.closest("code, pre, script, style, noscript") || !around.getClientRects().length) continue;
      texts.push(walker.currentNode.textContent);
    }
    return texts"""


def visible_ids(driver, known=()):
    """The ids of the page as the browser shows it now, but those in `known`."""
    found = {word for text in driver.execute_script(TEXTS) for word in ID.findall(text)}
    return sorted(found - set(known))


class Text(html.parser.HTMLParser):
    def __init__(self, page):
        super().__init__()
        self.depth, self.parts = 0, []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.depth += tag in HIDDEN

    def handle_endtag(self, tag):
        self.depth -= tag in HIDDEN

    def handle_data(self, text):
        if not self.depth:
            self.parts.append(text)


def ids_of_file(page, known=()):
    """Likewise of the page as it is written, with what scripts would hide."""
    return sorted(set(ID.findall(" ".join(Text(page).parts))) - set(known))
