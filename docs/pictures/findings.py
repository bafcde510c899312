#!/usr/bin/env python3
"""Draws the small figures of docs/results.md's first table, and README's curves of clutter, from the tables further down in it.

Usage: docs/pictures/findings.py [OUTPUT_DIR]
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
WIDTH, ROW, LABEL, BAR = 272, 18, 132, 100  # pixels: a column of a table
METHOD, REFERENCE = "#0b5cad", "#87919c"

# figure -> (label, start of the heading of the table's section, start of its row, column) of each bar; references are grey.
FIGURES = {
    "clutter": [("true mask", "clutter: ", "Human", 2), ("mask of φ̂, LGA", "clutter: ", "LGA", 2),
                ("GCBC-SEG", "clutter: ", "GCBC-SEG", 2), ("picture, words", "clutter: ", "GCBC without DART", 2),
                ("random object", "clutter: ", "*random", 2)],
    "reproduction": [("LGA", "q1: success", "LGA", 5), ("Human", "q1: success", "Human", 5),
                     ("GCBC-SEG", "q1: success", "GCBC-SEG", 5), ("random object", "q1: success", "*random", 5)],
    "policy": [("mask, network", "factorial on the", "the truth", 1),
               ("mask, heat_map", "factorial on the", "the truth, `policy=heat_map`", 1),
               ("picture, network", "factorial on the", "the truth", 4),
               ("picture, heat_map", "factorial on the", "the truth, `policy=heat_map`", 4)],
    "shift": [("LGA, control", "q2: other", "LGA", 1), ("LGA, distractor", "q2: other", "LGA", 3),
              ("SEG, control", "q2: other", "GCBC-SEG", 1),
              ("SEG, distractor", "q2: other", "GCBC-SEG", 3)],
    "errors": [("missing, one other", "What an error", "missing 0.2", 1), ("missing, six near", "What an error", "missing 0.2", 5),
               ("added, one other", "What an error", "added 0.2", 1), ("added, six near", "What an error", "added 0.2", 5)],
    "commands": [("LGA, heard", "many_commands: ", "LGA", 5), ("LGA, new", "many_commands: ", "LGA", 6),
                 ("SEG, heard", "many_commands: ", "GCBC-SEG", 5), ("SEG, new", "many_commands: ", "GCBC-SEG", 6),
                 ("random object", "many_commands: ", "*random", 6)],
    "knowledge": [("mask (LGA)", "knowledge: ", "`lga`", 3), ("picture, in training", "knowledge: ", "`erase+when=both`", 3),
                  ("data", "knowledge: ", "`texture_aug`", 3), ("loss", "knowledge: ", "`masked_bc`", 3),
                  ("nowhere (dropout)", "knowledge: ", "`object_dropout`", 3), ("random object", "knowledge: ", "*random", 3)],
    "perturbations": [("mask, either", "perturbations with", "`light_intensity`", 2),
                      ("beside, heat_map", "perturbations: ", "`light_intensity`", 3), ("beside, network", "perturbations with", "`light_intensity`", 3),
                      ("SEG, heat_map", "perturbations: ", "`light_intensity`", 6), ("SEG, network", "perturbations with", "`light_intensity`", 4)],
    "words": [("a feature each", "words: ", "**all**", 2), ("one meaning", "words: ", "**all**", 3),
              ("names alone", "words: ", "**all**", 4)],
}


def cell(page, heading, row, column):
    """(rate, low, high) of a table's cell; the interval's ends are the rate where it has none. The control's very actions are 1."""
    section = re.split(r"^#+ ", page, flags=re.M)
    section = next(part for part in section if part.startswith(heading))
    lines = [[part.strip() for part in line.split("|")[1:-1]] for line in section.splitlines() if line.startswith("| ")]
    cells = min((line for line in lines if line[0].startswith(row)), key=lambda line: line[0] != row)  # the very row, if there
    rate, low, high = re.match(r"([\d.]+)(?: \[([\d.]+), ([\d.]+)\])?", cells[column].replace("=", "1")).groups()
    return float(rate), float(low or rate), float(high or rate)


def figure(page, bars):
    """A chart of horizontal bars with their numbers and intervals."""
    height, parts = ROW * len(bars) + 6, []
    for i, (label, *place) in enumerate(bars):
        rate, low, high = cell(page, *place)
        y = ROW * i + 4
        x, left, right = (LABEL + BAR * value for value in (rate, low, high))
        color = REFERENCE if label.startswith("random") else METHOD
        parts += [f'<text x="{LABEL - 8}" y="{y + 11}" text-anchor="end" fill="#1b1f24">{label}</text>',
                  f'<rect x="{LABEL}" y="{y}" width="{x - LABEL:.1f}" height="{ROW - 5}" fill="{color}"/>',
                  f'<path d="M{left:.1f} {y + 7}H{right:.1f}" stroke="#1b1f24" stroke-width="1.5"/>',
                  f'<text x="{max(x, right) + 6:.1f}" y="{y + 11}" fill="#1b1f24">{rate:.2f}</text>']
    said = "; ".join(f"{label} {cell(page, *place)[0]:.2f}" for label, *place in bars)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" '
            f'aria-label="{said}" font-family="Helvetica,Arial,sans-serif" font-size="12"><rect width="100%" height="100%" fill="#ffffff"/>'
            + "".join(parts) + "</svg>\n")


# README's curves: what the policy sees, and the row that shows it, of one table; the numbers of demonstrations are its columns.
CURVES = [("true mask", "Human", "#0b5cad"), ("mask of φ̂ (LGA)", "LGA", "#d1495b"), ("mask of any object", "mask of any object", "#7a5195"),
          ("picture, mask of all, words (GCBC-SEG)", "GCBC-SEG", "#2e7d4f"), ("picture and words", "GCBC without DART", "#b26a00")]
CURVES_IN, NUMBERS = "clutter: ", ("1", "5", "20")


def curves(page):
    """Success against demonstrations, a line a row with its intervals, and what each shows beside its end."""
    left, right, top, bottom, width = 44, 250, 14, 214, 520
    xs = [left + (right - left) * i / (len(NUMBERS) - 1) for i in range(len(NUMBERS))]
    y_of = lambda rate: bottom - (bottom - top) * rate
    parts = [f'<text x="{(left + right) / 2}" y="{bottom + 32}" text-anchor="middle">demonstrations</text>']
    for rate in (0, .25, .5, .75, 1):
        parts += [f'<path d="M{left} {y_of(rate):.1f}H{right}" stroke="#d7dce1"/>',
                  f'<text x="{left - 8}" y="{y_of(rate) + 4:.1f}" text-anchor="end">{rate:.2f}</text>']
    parts += [f'<text x="{x:.1f}" y="{bottom + 16}" text-anchor="middle">{number}</text>' for x, number in zip(xs, NUMBERS)]
    ends = []
    for label, row, color in CURVES:
        rates = [cell(page, CURVES_IN, row, column + 1) for column in range(len(NUMBERS))]
        path = "L".join(f"{x:.1f} {y_of(rate):.1f}" for x, (rate, _, _) in zip(xs, rates))
        parts += [f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="2"/>']
        parts += [f'<path d="M{x:.1f} {y_of(low):.1f}V{y_of(high):.1f}" stroke="{color}" stroke-width="1.5"/>' for x, (_, low, high) in zip(xs, rates)]
        ends.append((y_of(rates[-1][0]), f"{rates[-1][0]:.2f} {label}", color))
    at = 0
    for y, words, color in sorted(ends):
        at = max(y, at + 15)  # so that no two words stand on each other
        parts += [f'<text x="{right + 10}" y="{at + 4:.1f}" fill="{color}">{words}</text>']
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {bottom + 40}" width="{width}" height="{bottom + 40}" role="img" '
            f'aria-label="Success against demonstrations, among four near misses: {"; ".join(words for _, words, _ in sorted(ends))}" '
            'font-family="Helvetica,Arial,sans-serif" font-size="12" fill="#1b1f24"><rect width="100%" height="100%" fill="#ffffff"/>'
            + "".join(parts) + "</svg>\n")


def main():
    page, out = (HERE.parent / "results.md").read_text(), pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE)
    for name, bars in FIGURES.items():
        (out / f"finding_{name}.svg").write_text(figure(page, bars))
    (out / "inputs.svg").write_text(curves(page))


if __name__ == "__main__":
    main()
