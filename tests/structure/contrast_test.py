"""Every line, mark and bar of report.html has 3:1 against what lies behind it, every text 4.5:1, light and dark (WCAG 2.2,
1.4.11 and 1.4.3): computed from the page's style sheet, the methods' colours and the spare ones."""
import json
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop())
CSS = (SOURCE / "programs/lgabench/document/page/page.css").read_text()


def rgb(colour):
    digits = colour.lstrip("#")
    digits = "".join(2 * d for d in digits) if len(digits) == 3 else digits
    return [int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4)]


def luminance(colour):
    linear = [c / 12.92 if c <= .04045 else ((c + .055) / 1.055) ** 2.4 for c in colour]
    return sum(w * c for w, c in zip((.2126, .7152, .0722), linear))


def contrast(a, b):
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + .05) / (low + .05)


def schemes():
    """The style sheet's variables: of light, and of dark, which it says twice."""
    blocks = [dict(re.findall(r"--([a-z]+): ([^;]+);", block)) for block in
              re.findall(r":root[^{]*\{\s*(--paper[^}]*)\}", CSS)]
    assert len(blocks) == 3, blocks
    assert blocks[1] == blocks[2], "dark by the system's wish and by the button differ"
    return {"light": blocks[0], "dark": blocks[1]}


def drawn_colours():
    """Of lines, marks and bars: name -> colour before it is lifted in the dark. Black is drawn in ink instead."""
    methods = json.loads((SOURCE / "results/paper/methods.json").read_text())["methods"]
    colours = {m["id"]: m["colour"] for m in methods if m["colour"] != "#000000"}
    names = (SOURCE / "framework/lgabench/statistics/names.cpp").read_text()
    spare = re.search(r"spare\{([^}]*)\}", names)[1]
    colours |= {f"spare {c}": c for c in re.findall(r'"(#\w+)"', spare)}
    colours |= dict(re.findall(r"\.(f\d+|abstraction|policy|perception) \{ --c: (#\w+); \}", CSS))
    return colours


class Contrast(unittest.TestCase):
    def test_lines_marks_and_bars(self):
        colours = drawn_colours()
        self.assertGreaterEqual(len(colours), 6 + 4 + 14 + 3)
        for name, scheme in schemes().items():
            lift = int(scheme["lift"].rstrip("%")) / 100
            lifted = {what: [c + (1 - c) * lift for c in rgb(colour)] for what, colour in colours.items()}
            lifted |= {what: rgb(scheme[what]) for what in ("ink", "soft", "accent")}  # GCBC-SEG, reference rows, rates
            for what, colour in lifted.items():
                for behind in ("paper", "sheet"):
                    with self.subTest(scheme=name, what=what, behind=behind):
                        self.assertGreaterEqual(contrast(colour, rgb(scheme[behind])), 3)

    def test_texts(self):
        for name, scheme in schemes().items():
            for what in ("ink", "soft", "accent", "bad", "good"):
                for behind in ("paper", "sheet"):
                    with self.subTest(scheme=name, what=what, behind=behind):
                        self.assertGreaterEqual(contrast(rgb(scheme[what]), rgb(scheme[behind])), 4.5)
            self.assertGreaterEqual(contrast(rgb(scheme["ink"]), rgb(scheme["note"])), 4.5)

    def test_failures_have_colours_of_their_own(self):
        failures = [c for name, c in drawn_colours().items() if re.fullmatch(r"f\d+", name)]
        self.assertEqual(len(set(failures)), 16)


if __name__ == "__main__":
    unittest.main()
