#!/usr/bin/env python3
"""Writes what Bayes' rule says of hows in fifty scenes of `shown`: an independent computation, which a test compares with plugins/hows.cpp.

A way is played by errands_meaning.py, which tries out what may be brought, and demonstrations are errands_scenes.py's.

Usage: python3 tests/measure/errands_bayes.py > tests/unit/golden/hows.json
"""
import copy
import json
import random

from errands_meaning import done_is_right, wanted
from errands_pilot import hows, posterior
from errands_scenes import DATA, demonstrations, pairs_of, test_scene

SEED, SCENES = 40961, 50


def in_order_of(pair, turns):
    """The ways as hows.json lists them, where `first` and `second` are those of that command."""
    own = copy.copy(pair)
    own.sets = tuple(dict.fromkeys(turn.sets for turn in turns))
    return hows(own)


def scene(pairs, number):
    """Of one command of a pair, after one to five demonstrations: how probable each way is, and what may come next as somebody goes on."""
    pair, which, shown = pairs[number % len(pairs)], number // len(pairs) % 2, 1 + number % 5
    after = posterior(pair, which, number, shown)
    left, brought, states = list(test_scene(pair, "told", number).things.values()), [], []
    draw = random.Random(f"errands_bayes/{number}")
    while True:
        odds = lambda right: sum(p for turns, p in after.items() if right(turns))
        states.append({"on_table": list(left), "brought": list(brought), "done": odds(lambda turns: done_is_right(turns, left, brought)),
                       "wanted": [odds(lambda turns: name in wanted(turns, left, brought)) for name in left]})
        if done_is_right(pair.turns[which], left, brought):
            break
        brought.append(draw.choice([name for name in left if name in wanted(pair.turns[which], left, brought)]))
        left.remove(brought[-1])
    return {"scenario": f"errands_{pair.id}", "command": pair.words[which],
            "demonstrations": [{"things": one.things, "took": [name for _, name in one.steps]} for one in demonstrations(pair, pair.turns[which], number, shown)],
            "probabilities": [after.get(turns, 0) for turns in in_order_of(pair, pair.turns[which])], "states": states}


def main():
    pairs = pairs_of(SEED)
    lines = [json.dumps(scene(pairs, number)) for number in range(SCENES)]
    print("[\n " + ",\n ".join(lines) + "\n]")


if __name__ == "__main__":
    main()
