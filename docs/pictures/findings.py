#!/usr/bin/env python3
"""Draws the small figures of docs/results.md's first table, README's curves of clutter,
and LGA's curves beside the paper's, from the tables of docs/results and from results/measured.

Usage: docs/pictures/findings.py [OUTPUT_DIR]
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
WIDTH, ROW, LABEL, BAR = 272, 18, 132, 100  # pixels: a column of a table
METHOD, REFERENCE = "#0b5cad", "#87919c"

# figure -> (label, page of docs/results, start of the heading of the table's section, row, column) of each bar; references are grey. A
# row is named by its first cells: on the board method and policy.
BOARD, MASK = "On the board: leaderboard", "Ablation, sees the mask of φ̂, scenes from the truth"
PICTURE, RANDOM = "Ablation, sees the picture, scenes from the truth", "Random visible object"
CURVE = "On the board: curve"
RIGHT, SEEN, NEW = "The right φ̂", "seen, 7 commands", "unseen, 7 commands"
AREAS, NETWORK, LIGHT = "Findings", "Perturbations with", "`light_intensity`"
FIGURES = {
    "clutter": [(label, "clutter", CURVE, row, "1") for label, row in (
        ("true mask", "True mask|heat map"), ("both", "LGA, then what was taken|heat map"), ("mask of φ̂, LGA", "LGA|heat map"),
        ("labels", "What was taken, by names|heat map"), ("GCBC-SEG", "GCBC-SEG|heat map"), ("random object", RANDOM))],
    "reproduction": [("LGA", "q1", "The paper's figure", "LGA", "50"), ("true mask", "q1", "The paper's figure", "True mask", "50"),
                     ("GCBC-SEG", "q1", "The paper's figure", "GCBC-SEG", "50"),
                     ("random object", "q1", "The paper's figure", "*random visible object*", "50")],
    "policy": [("mask, network", "factorial", BOARD, f"{MASK}|paper’s network", "50"),
               ("mask, heat_map", "factorial", BOARD, f"{MASK}|heat map", "50"),
               ("picture, network", "factorial", BOARD, f"{PICTURE}|paper’s network", "50"),
               ("picture, heat_map", "factorial", BOARD, f"{PICTURE}|heat map", "50")],
    "shift": [("LGA, control", "q2", "q2 with", "LGA", "control"), ("LGA, distractor", "q2", "q2 with", "LGA", "distractor"),
              ("SEG, control", "q2", "q2 with", "GCBC-SEG", "control"), ("SEG, distractor", "q2", "q2 with", "GCBC-SEG", "distractor")],
    "errors": [(f"{kind}, {words}", "clutter", "Errors in", f"{kind} 0.2", arm) for kind in ("missing", "added")
               for words, arm in (("one other", "1 other"), ("six near", "6 near misses"))],
    "commands": [(label, "many_commands", CURVE, row, arm) for label, row, arm in (
        ("LGA, heard", "LGA", SEEN), ("LGA, new", "LGA", NEW), ("SEG, heard", "GCBC-SEG", SEEN),
        ("SEG, new", "GCBC-SEG", NEW), ("random object", RANDOM, NEW))],
    "instruction": [(label, "perturbations", "Is the instruction", row, "use of language") for label, row in (
        ("mask of φ̂, LGA", "LGA"), ("GCBC-SEG", "GCBC-SEG"), ("any mask, words", "mask of any object, and words"),
        ("any mask, no words", "mask of any object"))],
    "knowledge": [(label, "knowledge", RIGHT, row, "`clutter`") for label, row in (
        ("mask (LGA)", "`lga`"), ("picture, in training", "`erase+when=both`"), ("data", "`texture_aug`"), ("loss", "`masked_bc`"),
        ("nowhere (dropout)", "`object_dropout`"), ("random object", "*random visible object*"))],
    "perturbations": [("mask, either", "perturbations", NETWORK, LIGHT, "LGA"), ("beside, heat_map", "perturbations", AREAS, LIGHT, "LGA-S"),
                      ("beside, network", "perturbations", NETWORK, LIGHT, "LGA-S"), ("SEG, heat_map", "perturbations", AREAS, LIGHT, "GCBC-SEG"),
                      ("SEG, network", "perturbations", NETWORK, LIGHT, "GCBC-SEG")],
    "pictures": [(label, "pictures", "Success", row, "`light_colour` 2, 4") for label, row in (
        ("given names", "the truth|the simulator"), ("read", "the truth|`read`"), ("read, balanced", "the truth|`read_balanced`"),
        ("GCBC-SEG", "GCBC-SEG"), ("random object", "random object in view"))],
    "words": [(label, "words", "What is selected", "**all**", asked) for label, asked in (
        ("a feature each", "asked of each feature (LGA)"), ("one meaning", "asked what is meant"), ("names alone", "the names in the command"))],
}


def cell(page, heading, row, column):
    """(rate, low, high) of a table's cell; the interval's ends are the rate where it has none. The control's very actions are 1."""
    sections = re.split(r"^#+ ", (HERE.parent / f"results/{page}.md").read_text(), flags=re.M)
    section = next(part for part in sections if part.startswith(heading))
    for table in re.findall(r"(?:^\|.*\n)+", section, re.M):
        head, _, *lines = ([part.strip() for part in line.split("|")[1:-1]] for line in table.splitlines())
        cells = [line for line in lines if column in head and f"{'|'.join(line)}|".startswith(f"{row}|")]
        if cells:
            found = re.match(r"([\d.]+)(?: \[([\d.]+), ([\d.]+)\])?", cells[0][head.index(column)].replace("=", "1"))
            rate, low, high = found.groups()
            return float(rate), float(low or rate), float(high or rate)
    raise SystemExit(f"{page}, {heading}: no table with {row} and {column}")


def figure(bars):
    """A chart of horizontal bars with their numbers and intervals."""
    height, parts = ROW * len(bars) + 6, []
    for i, (label, *place) in enumerate(bars):
        rate, low, high = cell(*place)
        y = ROW * i + 4
        x, left, right = (LABEL + BAR * value for value in (rate, low, high))
        color = REFERENCE if label.startswith("random") else METHOD
        parts += [f'<text x="{LABEL - 8}" y="{y + 11}" text-anchor="end" fill="#1b1f24">{label}</text>',
                  f'<rect x="{LABEL}" y="{y}" width="{x - LABEL:.1f}" height="{ROW - 5}" fill="{color}"/>',
                  f'<path d="M{left:.1f} {y + 7}H{right:.1f}" stroke="#1b1f24" stroke-width="1.5"/>',
                  f'<text x="{max(x, right) + 6:.1f}" y="{y + 11}" fill="#1b1f24">{rate:.2f}</text>']
    said = "; ".join(f"{label} {cell(*place)[0]:.2f}" for label, *place in bars)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" '
            f'aria-label="{said}" font-family="Helvetica,Arial,sans-serif" font-size="12"><rect width="100%" height="100%" fill="#ffffff"/>'
            + "".join(parts) + "</svg>\n")


# README's curves: what the policy sees, and the row that shows it, of one table; the numbers of demonstrations are its columns.
CURVES = [("true mask", "True mask|heat map", "#0b5cad"), ("mask of φ̂ (LGA)", "LGA|heat map", "#d1495b"),
          ("mask of φ̂, then labels (both)", "LGA, then what was taken|heat map", "#7a5195"),
          ("mask by labels alone", "What was taken, by names|heat map", "#b26a00"),
          ("picture, mask of all, words (GCBC-SEG)", "GCBC-SEG|heat map", "#2e7d4f")]
NUMBERS = ("1", "5", "20")


def curves(numbers, series, about):
    """Success against demonstrations: of each (label, [(rate, low, high) of each number], colour) a line with its intervals and, beside its
    end, what it is."""
    left, right, top, bottom, width = 44, 250, 14, 214, 520
    xs = [left + (right - left) * i / (len(numbers) - 1) for i in range(len(numbers))]
    y_of = lambda rate: bottom - (bottom - top) * rate
    parts = [f'<text x="{(left + right) / 2}" y="{bottom + 32}" text-anchor="middle">demonstrations</text>']
    for rate in (0, .25, .5, .75, 1):
        parts += [f'<path d="M{left} {y_of(rate):.1f}H{right}" stroke="#d7dce1"/>',
                  f'<text x="{left - 8}" y="{y_of(rate) + 4:.1f}" text-anchor="end">{rate:.2f}</text>']
    parts += [f'<text x="{x:.1f}" y="{bottom + 16}" text-anchor="middle">{number}</text>' for x, number in zip(xs, numbers)]
    ends = []
    for label, rates, color in series:
        path = "L".join(f"{x:.1f} {y_of(rate):.1f}" for x, (rate, _, _) in zip(xs, rates))
        parts += [f'<path d="M{path}" fill="none" stroke="{color}" stroke-width="2"/>']
        parts += [f'<path d="M{x:.1f} {y_of(low):.1f}V{y_of(high):.1f}" stroke="{color}" stroke-width="1.5"/>'
                  for x, (_, low, high) in zip(xs, rates) if low < high]
        ends.append((y_of(rates[-1][0]), f"{rates[-1][0]:.2f} {label}", color))
    at = 0
    for y, words, color in sorted(ends):
        at = max(y, at + 15)  # so that no two words stand on each other
        parts += [f'<text x="{right + 10}" y="{at + 4:.1f}" fill="{color}">{words}</text>']
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {bottom + 40}" width="{width}" height="{bottom + 40}" role="img" '
            f'aria-label="{about}: {"; ".join(words for _, words, _ in sorted(ends))}" '
            'font-family="Helvetica,Arial,sans-serif" font-size="12" fill="#1b1f24"><rect width="100%" height="100%" fill="#ffffff"/>'
            + "".join(parts) + "</svg>\n")


def inputs():
    """README's curves."""
    series = [(label, [cell("clutter", CURVE, row, number) for number in NUMBERS], color) for label, row, color in CURVES]
    return curves(NUMBERS, series, "Success against demonstrations, among four near misses")


# LGA's curve in the paper, and in runs of results/measured.
SETTINGS = [("paper_drawn", "preset paper", "#0b5cad"), ("text_drawn", "preset paper_text", "#d1495b"),
            ("text_shuffled", "paper_text, shuffled batches", "#b26a00")]


def fidelity():
    """LGA in the paper's figure 3a and in the settings that were tried."""
    results = HERE.parents[1] / "results"
    paper = json.loads((results / "paper/reference_results.json").read_text())["figure_3a_success_vs_demonstrations"]
    numbers = paper["demonstrations"]
    series = [("the paper", [(mean, mean - err, mean + err) for mean, err in zip(paper["LGA"]["mean"], paper["LGA"]["err"])], "#1b1f24")]
    for name, label, color in SETTINGS:
        rows = json.loads((results / f"measured/runs/fidelity_{name}.json").read_text())["rows"]
        of = {row["demonstrations"]: row for row in rows if row["method"] == "lga"}
        series.append((label, [tuple(of[n].get(end, of[n]["success"]) for end in ("success", "low", "high")) for n in numbers], color))
    return curves(numbers, series, "Success of LGA against demonstrations")


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE)
    for name, bars in FIGURES.items():
        (out / f"finding_{name}.svg").write_text(figure(bars))
    (out / "inputs.svg").write_text(inputs())
    (out / "fidelity.svg").write_text(fidelity())


if __name__ == "__main__":
    main()
