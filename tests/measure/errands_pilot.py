#!/usr/bin/env python3
"""What the suites `errands` and `refusing` would measure, played without pictures or physics, before they are built.

Commands and their meanings are errands.json; what is right is errands_meaning.py. Two commands of a pair share their scenes and all
random numbers (errands_scenes.py). A pair is won in a scene if both episodes end right. One grasp of a hundred fails.

Rows know the true sets unless they say otherwise. Rows of labels learn them from five demonstrations of each command that is demonstrated:
those of all scenarios of a group, which hold the class used in other ways, or ("nearest words") those of the scenario whose demonstrated
commands share the rarest words with the command. In `shown` the sets are known, and demonstrations of the command itself hold the how.

It prints, for each arm and row: first choices that are right where something is needed; pairs won, with half of an interval over scenarios
(t); episodes that end right; progress; episodes that end too early, that go on when all is done, and that take what is not wanted; and
pairs won by hows. Last, which targets hold. It takes minutes: --scenes says how many.

Usage: python3 tests/measure/errands_pilot.py [--scenes N] [--seed N]
"""
import argparse
import collections
import functools
import itertools
import json
import math
import random
import re

import errands_meaning as meaning
from errands_meaning import Sets, belongs, done_is_right, wanted
from errands_scenes import DATA, ROOT, THINGS, Refusing, Scene, demonstrations, follow, order_of, pairs_of, planned_ids, right_sequences, test_scene

SEED, MOST_STEPS, FAILS, MISREAD, DEMONSTRATIONS = 40961, 6, .01, .1, 5


# Rows: of a scene and the number of one of its commands, who plays it (errands_scenes.py).

def truth(scene, which):
    return follow(order_of(scene), scene.of.turns[which])


def kept(ids):
    return lambda seen, brought, step: next((one for one in ids if one in seen), None)


def first_moment(scene, which):
    want = wanted(scene.of.turns[which], scene.things.values())
    return kept([one for one in order_of(scene) if scene.things.get(one) in want])


def planned(scene, which):
    return kept(planned_ids(scene, scene.of.turns[which]))


def without_how(scene, which, most=MOST_STEPS):
    order, turns = order_of(scene), scene.of.turns[which]
    return lambda seen, brought, step: None if len(brought) >= most else next((one for one in order if one in seen and belongs(turns, seen[one])), None)


def key_words(scene, which, known=("each",)):
    """Takes one of each kind where the command says "each", else all; where it is known, two where it says "two"."""
    said = scene.of.words[which]
    part = meaning.PARTS["texture" if "colour" in said else "object_type"]
    each, two = (word in known and re.search(rf"\b{word}\b", said) for word in ("each", "two"))
    return follow(order_of(scene), (meaning.Turn(scene.of.union, 2 if two else "all", (), (part,) if each else (), False),))


def shared_words(scene, which):
    """Takes the names that share the most words with the command, as long as any does."""
    said, order = words(scene.of.words[which]), order_of(scene)
    score = lambda name: sum(len(words(one) & said) / len(words(one)) for one in name)
    return lambda seen, brought, step: max((one for one in order if one in seen and score(seen[one]) > 0), key=lambda one: score(seen[one]), default=None)


def at_random(scene, which, stops=lambda brought, draw: draw.random() < .3):
    def choose(seen, brought, step):
        draw = scene.random("random", step)
        return None if stops(brought, draw) else draw.choice(sorted(seen))
    return choose


def believed(scene, turns, member):
    """The turns with the sets that somebody believes in, of what is ever on the table: member(number of the set, name)."""
    numbers = [scene.of.sets.index(turn.sets) for turn in turns]
    return tuple(turn._replace(sets=Sets(known=[name for name in set(scene.all.values()) if member(number, name)])) for turn, number in zip(turns, numbers))


def wrong_class(scene, which, missing, added):
    """Each name of the type or texture that decides is lost, or comes in, with these odds, drawn for each scene."""
    def member(number, name):
        part = 0 if scene.of.sets[number].given[0]["textures"] == "ALL" else 1
        chance = scene.random("class", number, name[part]).random()
        return chance >= missing if name in scene.of.sets[number] else chance < added
    return follow(order_of(scene), believed(scene, scene.of.turns[which], member))


def misread(scene, one, step):
    """A thing's name as it is read at a step: its type or its texture is another."""
    draw, name = scene.random("reading", one, step), list(scene.all[one])
    if draw.random() < MISREAD:
        part = draw.randrange(2)
        name[part] = draw.choice([other for other in scene.of.names[part] if other != name[part]])
    return tuple(name)


def reader(scene, which, keeps):
    chooses, readings, brought_as, last = truth(scene, which), collections.defaultdict(list), {}, {}

    def choose(seen, brought, step):
        for one in seen:
            readings[one].append(misread(scene, one, step))
        for one in set(last) - set(seen):
            brought_as[one] = last[one]
        last.clear()
        last.update({one: keeps(readings[one]) for one in seen})
        return chooses(dict(last), list(brought_as.values()), step)
    return choose


def majority(readings):
    return max(readings, key=lambda one: (readings.count(one), -readings.index(one)))


@functools.lru_cache(None)
def vectors():
    return json.loads((ROOT / "framework/lgabench/learning/embeddings/all-MiniLM-L6-v2.json").read_text())["embeddings"]


@functools.lru_cache(None)
def likeness(one, other):
    return sum(a * b for a, b in zip(vectors()[one], vectors()[other]))


class Labels:
    """What is taken by what was demonstrated: how much names speak for a thing, and from where on it is taken."""

    def __init__(self, rule, shown):
        self.rule, self.taken = rule, [name for one in shown for _, name in one.steps]
        left = [name for one in shown for name in (collections.Counter(one.things) - collections.Counter(name for _, name in one.steps)).elements()]
        features = lambda name: (("type", name[0]), ("texture", name[1]), name)
        self.counts, self.left = (collections.Counter(f for name in some for f in features(name)) for some in (self.taken, left))
        self.part = min((0, 1), key=lambda part: len({name[part] for name in self.taken}))  # that which says more of what was taken
        scored = sorted([(self.score(name), True) for name in self.taken] + [(self.score(name), False) for name in left])
        right = [sum(not was for _, was in scored[:i]) / max(len(left), 1) + sum(was for _, was in scored[i:]) / len(self.taken) for i in range(len(scored))]
        self.least = scored[right.index(max(right))][0]

    @functools.lru_cache(None)
    def score(self, name):
        by_count = math.prod(self.counts[one] + .5 for one in (("type", name[0]), ("texture", name[1])))
        alike = lambda part: max(sum(likeness(name[part], one[part]) for one in self.taken) / len(self.taken), 0)
        return {"counts": lambda: by_count,
                "bayes": lambda: math.prod((self.counts[one] + .5) / (self.left[one] + .5) for one in (("type", name[0]), ("texture", name[1]), name)),
                "names": lambda: by_count * alike(0) * alike(1),
                "part": lambda: self.counts[("type", "texture")[self.part], name[self.part]]}[self.rule]()


RULES = "counts", "bayes", "names", "part"


@functools.lru_cache(None)
def learned(pairs, rule, seed):
    """Of what was demonstrated in these scenarios."""
    return Labels(rule, [one for pair in pairs for turns in pair.heard for one in demonstrations(pair, turns, seed, DEMONSTRATIONS)])


def words(text):
    return {one if len(one) == 1 else one.lower().rstrip("s") for one in re.findall("[A-Za-z]+", text)}


def nearest(scene, which):
    """The scenario of the group whose heard commands share the rarest words with this command."""
    heard = {pair: words(" ".join(pair.heard_words)) for pair in scene.of.mates}
    rare = lambda word: math.log(len(heard) / sum(word in some for some in heard.values()))
    return max(heard, key=lambda pair: sum(rare(word) for word in heard[pair] & words(scene.of.words[which])))


def labels_deaf(scene, which, rule):
    of = learned(tuple(scene.of.mates), rule, scene.seed)
    order = sorted(order_of(scene), key=lambda one: -of.score(scene.all[one]))
    return lambda seen, brought, step: next((one for one in order if one in seen and of.score(seen[one]) >= of.least), None)


def labels_told(scene, which, rule, reads=False):
    """It knows the how. What it takes for the things of each turn: what was demonstrated, or (`reads`) that for the commands nearest in words."""
    of = learned((nearest(scene, which),) if reads else tuple(scene.of.mates), rule, scene.seed)
    return follow(order_of(scene), believed(scene, scene.of.turns[which], lambda number, name: of.score(name) >= of.least))


def last_demonstrated(scene, which):
    pair = scene.of.mates[-1]
    last = demonstrations(pair, pair.heard[1], scene.seed, DEMONSTRATIONS)[-1].steps
    alike = lambda name: sum(a == b for a, b in zip(name, last[-1][1]))
    order = sorted(order_of(scene), key=lambda one: -alike(scene.all[one]))
    return lambda seen, brought, step: None if len(brought) >= len(last) else next((one for one in order if one in seen), None)


# How things are used, from demonstrations; the sets are known.

@functools.lru_cache(None)
def hows(pair):
    sets = {"either": pair.union, **dict(zip(("first", "second"), pair.sets))} if len(pair.sets) > 1 else {"either": pair.union}
    found = {}
    for one in json.loads((ROOT / "plugins/hows.json").read_text()):
        if all(turn.get("of", "either") in sets for turn in one["turns"]):
            turns = meaning.read({"turns": [{**turn, "sets": []} for turn in one["turns"]]})
            found[tuple(turn._replace(sets=sets[given.get("of", "either")]) for turn, given in zip(turns, one["turns"]))] = one["weight"]
    return found


def likelihood(turns, shown):
    """Of what was taken, step by step, with equal odds of what is wanted; and of the end."""
    left, brought, found = list(shown.things), [], 1
    for _, name in shown.steps:
        want = wanted(turns, left, brought)
        if name not in want or done_is_right(turns, left, brought):
            return 0
        found /= sum(one in want for one in left)
        left.remove(name)
        brought.append(name)
    return found * done_is_right(turns, left, brought)


@functools.lru_cache(None)
def posterior(pair, which, seed, number):
    shown = demonstrations(pair, pair.turns[which], seed, number)
    found = {turns: weight * math.prod(likelihood(turns, one) for one in shown) for turns, weight in hows(pair).items()}
    return {turns: weight / sum(found.values()) for turns, weight in found.items() if weight}


def bayes(scene, which, number):
    order, after = order_of(scene), posterior(scene.of, which, scene.seed, number)

    def choose(seen, brought, step):
        odds = collections.Counter({None: sum(p for turns, p in after.items() if done_is_right(turns, seen.values(), brought))})
        for turns, p in after.items():
            want = wanted(turns, seen.values(), brought)
            odds.update({one: p for one in seen if seen[one] in want})
        return max([None] + [one for one in order if one in seen], key=lambda one: odds[one])
    return choose


def habit(scene, which, number):
    """As many of what belongs as demonstrations took most often."""
    counts = collections.Counter(len(one.steps) for one in demonstrations(scene.of, scene.of.turns[which], scene.seed, number))
    return without_how(scene, which, counts.most_common(1)[0][0])


# Playing.

def play(scene, which, row):
    """(how it ended, whether the first choice was right, right takes)"""
    turns, choose, taken, first = scene.of.turns[which], row(scene, which), [], None
    for step in range(MOST_STEPS):
        table, brought = scene.table(taken), tuple(scene.all[one] for one in taken)
        choice, done = choose(dict(table), brought, step), done_is_right(turns, table.values(), brought)
        right = done if choice is None else table[choice] in wanted(turns, table.values(), brought)
        first = right if step == 0 else first
        if choice is None or not right:
            return "right" if right else "too early" if choice is None else "went on" if done else "wrong", first, len(taken)
        if scene.random("grasp", step).random() >= FAILS:
            taken.append(choice)
    return "steps", first, len(taken)


TOLD = {
    "truth": truth,
    "truth, its first moment": first_moment,
    "truth without a how": without_how,
    "truth without a how, two and stop": functools.partial(without_how, most=2),
    "planned at the start": planned,
    "key word: each": key_words,
    "key words: each, two": functools.partial(key_words, known=("each", "two")),
    "class 5 % missing, 2 % added": functools.partial(wrong_class, missing=.05, added=.02),
    "class 20 % missing, 5 % added": functools.partial(wrong_class, missing=.2, added=.05),
    **{f"labels told the how: {rule}": functools.partial(labels_told, rule=rule) for rule in RULES},
    **{f"labels of the nearest words: {rule}": functools.partial(labels_told, rule=rule, reads=True) for rule in RULES},
    **{f"labels, deaf: {rule}": functools.partial(labels_deaf, rule=rule) for rule in RULES},
    "last demonstrated": last_demonstrated,
    "random, stop at random": at_random,
    "stop at once": lambda scene, which: kept([]),
    "any two and stop": functools.partial(at_random, stops=lambda brought, draw: len(brought) >= 2),
    "nearest names": shared_words,
    "names 10 % wrong, first reading": functools.partial(reader, keeps=lambda readings: readings[0]),
    "names 10 % wrong, anew": functools.partial(reader, keeps=lambda readings: readings[-1]),
    "names 10 % wrong, majority": functools.partial(reader, keeps=majority)}
SHOWN = {**{f"bayes, {n} demonstrations": functools.partial(bayes, number=n) for n in (1, 2, 5, 10)},
         **{f"habit of a number, {n}": functools.partial(habit, number=n) for n in (1, 5)},
         "takes all": without_how, "takes two": functools.partial(without_how, most=2)}

ALONE = "truth", "class 5 % missing, 2 % added", "class 20 % missing, 5 % added", "names 10 % wrong, anew", "random, stop at random", "stop at once"
REFUSING = {**{name: TOLD[name] for name in (*ALONE, *(f"labels, deaf: {rule}" for rule in RULES))},
            "takes something": lambda scene, which: kept(order_of(scene))}

Result = collections.namedtuple("Result", "pair number won ends first takes needed")


def results(pairs, arm, rows, scenes):
    """{row: results of scenes}"""
    found = collections.defaultdict(list)
    for pair in pairs:
        for number in range(scenes):
            scene = test_scene(pair, arm, number)
            needed = [len(min(right_sequences(scene, turns), key=len)) for turns in pair.turns]
            for name, row in rows.items():
                ends, first, takes = zip(*(play(scene, which, row) for which in (0, 1)))
                found[name].append(Result(pair, number, ends == ("right", "right"), ends, first, takes, needed))
            meaning.can.cache_clear()
    return found


def mean(some):
    some = list(some)
    return sum(some) / len(some) if some else math.nan


def by_pairs(of):
    """Half of an interval of 95 % of the paired success, over scenarios (t)."""
    means = [mean(one.won for one in of if one.pair is pair) for pair in dict.fromkeys(one.pair for one in of)]
    return 2.16 * math.sqrt(sum((one - mean(means)) ** 2 for one in means) / (len(means) - 1) / len(means))


def line(name, of):
    """First choices where something is needed, both right, single episodes, progress, and errors at the end."""
    both = [(one, i) for one in of for i in (0, 1)]
    first = mean(one.first[i] for one, i in both if one.needed[i])
    progress = mean(1 if one.ends[i] == "right" else min(one.takes[i] / max(one.needed[i], 1), .99) for one, i in both)
    share = lambda word: mean(one.ends[i] == word for one, i in both)
    kinds = [mean(one.won for one in of if one.pair.how == how) for how in dict.fromkeys(one.pair.how for one in of)]
    numbers = (first, mean(one.won for one in of), by_pairs(of), share("right"), progress, share("too early"), share("went on"), share("wrong"))
    print(f"{name:36}" + "".join(f"{one:7.3f}" for one in numbers) + "  |" + "".join(f"{one:6.2f}" for one in kinds), flush=True)


def table(title, found):
    of = next(iter(found.values()))
    print(f"\n{title}: {len(of)} pairs of episodes\n{'':36}  first paired  +-    right  progr  early     on  wrong  | "
          + ", ".join(dict.fromkeys(one.pair.how for one in of)), flush=True)
    for name, some in found.items():
        line(name, some)


def refusing(seed, scenes):
    """{row: [(refused where nothing is meant, took what is meant in the same table with one thing exchanged for it)]}"""
    found = collections.defaultdict(list)
    for of, number in itertools.product(map(Refusing, DATA["refusing"]), range(scenes)):
        of.seed, draw = seed, random.Random(f"{seed}/{of.id}/{number}")
        things = of.table(draw, 0)
        with_one = list(things)
        with_one[draw.randrange(THINGS)] = of.member(draw, ())
        for name, row in REFUSING.items():
            absent, present = (row(scene, 0)(dict(scene.things), (), 0) for scene in (Scene(of, "absent", number, things), Scene(of, "present", number, with_one)))
            found[name].append((absent is None, present is not None and with_one[present - 1] in of.sets[0]))
    print(f"\nrefusing: {len(DATA['refusing']) * scenes} tables, and as many with one that is meant\n{'':36} refuses  takes")
    for name, of in found.items():
        print(f"{name:36}{mean(one for one, _ in of):8.3f}{mean(other for _, other in of):7.3f}")
    print()
    return found


def targets(told, shown, refused):
    """What has to hold on a seed on which nothing was tuned."""
    won = lambda of, name: mean(one.won for one in of[name])
    most = lambda of, start: max(won(of, name) for name in of if name.startswith(start))
    deaf = [name for name in TOLD if name.startswith(("truth without", "labels, deaf", "last", "random", "stop", "any two"))]
    of_n = [won(shown, f"bayes, {n} demonstrations") for n in (1, 5, 10)]
    for what, value, holds in [
            ("truth >= .95", won(told, "truth"), won(told, "truth") >= .95),
            ("deaf rows exactly 0", max(won(told, name) for name in deaf), not any(won(told, name) for name in deaf)),
            ("labels told the how <= .30", most(told, "labels told"), most(told, "labels told") <= .3),
            ("the same of the nearest words <= .30", most(told, "labels of"), most(told, "labels of") <= .3),
            ("key word <= .25", won(told, "key word: each"), won(told, "key word: each") <= .25),
            ("shown: Bayes at 5 in .55 to .85", of_n[1], .55 <= of_n[1] <= .85),
            ("shown: rising from 1 to 10", of_n[2], of_n[0] < of_n[1] < of_n[2]),
            ("shown: habits <= .30", most(shown, "habit"), most(shown, "habit") <= .3),
            ("refusing: truth >= .99", min(map(mean, zip(*refused["truth"]))), min(map(mean, zip(*refused["truth"]))) >= .99)]:
        print(f"{what:38}{value:6.3f}  {'holds' if holds else 'MISSED'}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=24, help="of each pair")
    parser.add_argument("--seed", type=int, default=SEED, help="of scenes and demonstrations")
    given = parser.parse_args()
    print(f"{meaning.check()} examples of meanings hold; seed {given.seed}")
    pairs, found = pairs_of(given.seed), {}
    for title, arm, rows in (("told", "told", TOLD), ("shown", "told", SHOWN), ("appears", "appears", TOLD), ("nothing", "nothing", TOLD)):
        found[title] = results(pairs, arm, rows, given.scenes)
        table(title, found[title])
    takes = collections.Counter(needed for one in found["told"]["truth"] for needed in one.needed)
    print("\ntakes that are needed, in told:", {number: round(takes[number] / takes.total(), 2) for number in sorted(takes)})
    targets(found["told"], found["shown"], refusing(given.seed, given.scenes))


if __name__ == "__main__":
    main()
