"""What of a page a person reads: its text without scripts, styles, code and attributes."""
import html.parser
import re

HIDDEN = {"script", "style", "code", "pre", "noscript"}
ID = re.compile(r"\w*[A-Za-z]_\w+|\b[A-Za-z]+\d\w*")


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


def ids(page, known=()):
    """Words with an underscore, or of letters and digits, that a person would meet; but for `known` ones."""
    return sorted(set(ID.findall(" ".join(Text(page).parts))) - set(known))
