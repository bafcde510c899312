"""What a command means that also says how objects are used: which may be brought next, and when all is done.

This is the reference by exhaustive definition; nothing in it is fast or clever. A thing is a pair (object type, texture). The order of
`brought` counts, that of what stands on the table does not.

    An object is wanted if, after it is taken, the turns can still be fulfilled with what is on the table.
    "Done" is right if the turns are fulfilled; also at once, where they can never be.

Turns are fulfilled one after the other, each by what was brought next:
- `take: N` takes N things of its sets; `take: "all"` takes until no other thing of its sets on the table could join.
- Things of a turn are alike in each part of `same` and differ from each other in each part of `different`.
- A turn found nothing if it took nothing: there was nothing of its sets, or fewer than N that fit together.
- A turn `only_if_nothing` is played only if the turn before found nothing. Without such a turn after it, `take: N` must take N.
A thing that appears later counts as if it had been there from the beginning.

Usage: python3 tests/measure/errands_meaning.py    # plays the examples below
"""
import collections
import functools
import itertools
import json

Turn = collections.namedtuple("Turn", "sets take same different only_if_nothing")
PARTS = {"object_type": 0, "texture": 1}


class Sets:
    """A union of products of names, as scenarios have them; which things are in it is kept once it was asked."""

    def __init__(self, given=(), known=()):
        self.given, self.known = given, {one: True for one in known}

    def __contains__(self, thing):
        if thing not in self.known:
            self.known[thing] = any(held(thing[0], one["object_types"]) and held(thing[1], one["textures"]) for one in self.given)
        return self.known[thing]


def held(name, given):
    return given == "ALL" or (name not in given["except"] if isinstance(given, dict) else name in given)


@functools.lru_cache(None)
def interned(text):
    return Sets(json.loads(text))


def sets_of(given):
    """The same object for the same sets."""
    return interned(json.dumps(given))


def read(target):
    """The turns of a scenario's `target`; a meaning without turns is one thing of its sets."""
    turns = target["turns"] if "turns" in target else [{"sets": target.get("sets", [target]), "take": 1}]
    parts = lambda one, key: tuple(PARTS[part] for part in one.get(key, ()))
    return tuple(Turn(sets_of(one["sets"]), one["take"], parts(one, "same"), parts(one, "different"), one.get("only_if_nothing", False))
                 for one in turns)


def belongs(turns, thing):
    return any(thing in turn.sets for turn in turns)


def fit(turn, things):
    """Whether the things may be taken in the turn together."""
    if not all(one in turn.sets for one in things):
        return False
    kinds = {part: len({one[part] for one in things}) for part in turn.same + turn.different}
    return all(kinds[part] <= 1 for part in turn.same) and all(kinds[part] == len(things) for part in turn.different)


def plays(turn, taken, left):
    """Whether the turn is played by taking these while those stay on the table."""
    ends = not any(fit(turn, taken + (one,)) for one in left) if turn.take == "all" else len(taken) == turn.take
    return ends and fit(turn, taken)


def fulfilled(turns, brought, left, found=False):
    """Whether what was brought, in its order, fulfils the turns while `left` stays on the table. `found`: by the turn before."""
    if not turns:
        return not brought
    turn, later = turns[0], turns[1:]
    if turn.only_if_nothing and found:
        return fulfilled(later, brought, left, found)
    for n in range(len(brought) + 1):
        if plays(turn, brought[:n], brought[n:] + left) and fulfilled(later, brought[n:], left, n > 0):
            return True
    has_other = bool(later) and later[0].only_if_nothing
    return has_other and turn.take != "all" and not any(fit(turn, some) for some in itertools.combinations(brought + left, turn.take)) \
        and fulfilled(later, brought, left, False)


@functools.lru_cache(None)
def can(turns, brought, left):
    """Whether the turns are fulfilled, or would be if some of `left` were brought in some order."""
    return begun(turns, brought) and (fulfilled(turns, brought, left) or any(
        can(turns, brought + (one,), without(left, one)) for one in sorted(set(left))))


def begun(turns, brought):
    """Whether what was brought can be shared out among the turns at all. It only spares can() a search that must fail."""
    return not brought or bool(turns) and any(fit(turns[0], brought[:n]) and begun(turns[1:], brought[n:])
                                              for n in range(len(brought) + 1))


def without(things, one):
    at = things.index(one)
    return things[:at] + things[at + 1:]


def wanted(turns, things, brought=()):
    """The names of what may be brought next."""
    left = that_belong(turns, things)
    return {one for one in set(left) if can(turns, (*brought, one), without(left, one))}


def done_is_right(turns, things, brought=()):
    left = that_belong(turns, things)
    return fulfilled(turns, tuple(brought), left) or not brought and not can(turns, (), left)


def that_belong(turns, things):
    """In one order; what is in no set changes nothing."""
    return tuple(sorted(one for one in things if belongs(turns, one)))


def thing(words):
    texture, object_type = words.rsplit(" ", 1)
    return object_type, texture


def examples():
    """(what it shows, turns, on the table, brought, wanted, whether done is right)"""
    a, b = ({"object_types": [one], "textures": "ALL"} for one in ("apple", "bowl"))
    fruit = {"object_types": ["apple", "pear", "lemon"], "textures": "ALL"}
    turn = lambda one, take="all", **more: {"sets": [one], "take": take, **more}
    alike, unlike = ([turn(fruit, 2, **{key: ["texture"]})] for key in ("same", "different"))
    each, every = [turn(fruit, different=["object_type"])], [turn(fruit)]
    then, orelse = [turn(a), turn(b)], [turn(a, 1), turn(b, 1, only_if_nothing=True)]
    both = [turn(fruit, 2, same=["object_type"], different=["texture"])]
    pairs_else = [turn(a, 2, same=["texture"]), turn(b, only_if_nothing=True)]
    return [
        ("all", every, "red apple, red pear, red bowl", "", "red apple, red pear", False),
        ("all: none is left", every, "red bowl", "red apple", "", True),
        ("all of nothing is done at once", every, "red bowl", "", "", True),
        ("one of each kind: a second apple is not wanted", each, "red apple, red pear", "blue apple", "red pear", False),
        ("one of each kind: either apple may be the one", each, "red apple, blue apple", "", "red apple, blue apple", False),
        ("two alike: the lone lemon is not wanted", alike, "red apple, red pear, blue lemon", "", "red apple, red pear", False),
        ("two alike: after the lone lemon nothing is wanted, and it is not done", alike, "red apple, red pear", "blue lemon", "", False),
        ("two alike: nothing is alike, so nothing is brought", alike, "red apple, blue pear", "", "", True),
        ("two alike: done after two, though a third is like them", alike, "red lemon", "red apple, red pear", "", True),
        ("two alike: the second decides, not the third", alike, "blue apple, red pear", "red apple", "red pear", False),
        ("two unlike: a thing without one unlike it is not wanted", unlike, "red apple, red pear", "", "", True),
        ("two unlike: all are wanted first, then the other colour", unlike, "red pear, blue lemon", "red apple", "blue lemon", False),
        ("two conditions", both, "red apple, blue apple, red pear, red pear", "", "red apple, blue apple", False),
        ("two conditions: two that look the same do not do", both, "red pear, red pear", "", "", True),
        ("two of more", [turn(fruit, 2)], "red pear, blue pear", "red apple", "red pear, blue pear", False),
        ("two of one: it cannot be done, so nothing is brought", [turn(fruit, 2)], "red pear", "", "", True),
        ("two of one: nor is one enough", [turn(fruit, 2)], "", "red pear", "", False),
        ("first apples: no bowl before the last apple", then, "red apple, red bowl", "blue apple", "red apple", False),
        ("first apples, then bowls", then, "red bowl", "red apple, blue apple", "red bowl", False),
        ("an apple after a bowl is an error, whatever comes", then, "red apple", "red bowl", "", False),
        ("no apple: bowls at once", then, "red bowl", "", "red bowl", False),
        ("an apple that appears before the first bowl comes before it", then, "red apple, red bowl", "red apple", "red apple", False),
        ("or else: an apple is there", orelse, "red apple, red bowl", "", "red apple", False),
        ("or else: after the apple no bowl, and no other apple", orelse, "red apple, red bowl", "red apple", "", True),
        ("or else: no apple is there", orelse, "red bowl, blue bowl", "", "red bowl, blue bowl", False),
        ("or else: neither is there", orelse, "red pear", "", "", True),
        ("or else: a bowl was brought though an apple is there", orelse, "red apple", "red bowl", "", False),
        ("or else: two alike are not found among apples that differ", pairs_else, "red apple, blue apple, red bowl", "", "red bowl", False),
    ]


def check():
    listed = lambda words: [thing(one) for one in words.split(", ") if one]
    for shows, turns, table, brought, want, done in examples():
        turns, given = read({"turns": turns}), (listed(table), listed(brought))
        assert wanted(turns, *given) == set(listed(want)), shows
        assert done_is_right(turns, *given) == done, shows
    flat = read({"object_types": ["heart"], "textures": ["red"]})
    assert wanted(flat, listed("red heart, blue heart")) == {("heart", "red")} and done_is_right(flat, listed("blue heart"))
    return len(examples()) + 1


if __name__ == "__main__":
    print(f"{check()} examples hold")
