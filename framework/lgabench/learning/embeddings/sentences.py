#!/usr/bin/env python3
"""Prints the sentences whose embeddings are committed, one a line: every shipped command, and in words every Selection
that recorded answers give for one, and its truths; every object type and texture.

    sentences.py build/release/bin/lgabench > sentences.txt      (then make_embeddings.py)
"""
import json
import pathlib
import subprocess
import sys


def main():
    def ask(*arguments):
        return subprocess.run([sys.argv[1], *arguments, "--json"], capture_output=True, text=True).stdout

    sentences = set()
    for scenario in json.loads(ask("list"))["scenarios"]:
        for answers in ("recorded", "gpt4_released", "gpt4_study", "claude", "claude_clutter",
                        "claude_fetch", "claude_paraphrases", "claude_words", "claude_drawn", "claude_unheard"):
            for truth in ("released", "printed"):
                for line in ask("select", scenario["id"], "--answers", answers, "--truth", truth).splitlines():
                    selected = json.loads(line)
                    sentences |= {selected["utterance"], selected["text"], selected["true_text"]}
    for space in pathlib.Path(__file__).parents[4].glob("envs/*/spaces/*.json"):
        names = json.loads(space.read_text())
        sentences |= {*names["object_types"], *names["textures"]}
    print("\n".join(sorted(sentences)))


if __name__ == "__main__":
    main()
