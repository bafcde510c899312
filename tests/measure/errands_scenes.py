"""Tables and demonstrations of the suites `errands` and `refusing`, as errands_pilot.py draws them: names, without pictures or physics.

A thing is a pair (object type, texture); what a command means is errands_meaning.py's. A scene of a pair is kept only if no sequence of
takes is right under both commands, and what is wanted at first is not right for both.
"""
import collections
import functools
import itertools
import json
import pathlib
import random

import errands_meaning as meaning
from errands_meaning import Sets, belongs, done_is_right, sets_of, wanted

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = json.loads((pathlib.Path(__file__).parent / "errands.json").read_text())
THINGS, TRAINING_SEEDS = 7, 3
TAUGHT = (1, 1, 1, 2, 2, 2, 3), 5  # in a demonstrated scene: how many belong, with equal odds, and how many things there are


def space_of(name):
    file = next(ROOT.glob(f"envs/*/spaces/{name}.json"))
    space = json.loads(file.read_text())
    return [one for one in space["object_types"] if one not in ("pallet", "tray", "box", "plate on a stand")], space["textures"]


class Pool:
    """Things to draw from: a type with equal odds, then a texture; of the given ones where there are any."""

    def __init__(self, things):
        self.things, self.textures = set(things), collections.defaultdict(list)
        for one, texture in sorted(self.things):
            self.textures[one].append(texture)

    def draw(self, draw, types=None, textures=None):
        fits = lambda one: one in (types or [one]) and any(of in (textures or [of]) for of in self.textures[one])
        one = draw.choice([one for one in self.textures if fits(one)] or list(self.textures))
        return one, draw.choice([of for of in self.textures[one] if of in (textures or [of])] or self.textures[one])


class Class:
    """The sets that commands of a scenario are about, and what else stands on their tables."""

    def __init__(self, space, sets, near, undecided):
        types, textures = space_of(space)
        may_be = [one for one in itertools.product(types, textures) if one not in undecided]
        self.sets, self.names = sets, (types, textures)
        self.members = [Pool(one for one in may_be if one in part) for part in sets]
        rest = [one for one in may_be if not any(one in part for part in sets)]
        self.near, self.rest = Pool(one for one in rest if one in near), rest
        self.decoys = [Pool(rest)]
        self.union = Sets(known=[one for pool in self.members for one in pool.things])

    def member(self, draw, before):
        """Half of them share the type or the texture of one before, so that some kind is there twice."""
        pool = draw.choice(self.members)
        alike = [one for one in before if one in pool.things]
        if not alike or draw.random() < .5:
            return pool.draw(draw)
        of = draw.choice(alike)
        return pool.draw(draw, **draw.choice(({"types": [of[0]]}, {"textures": [of[1]]})))

    def near_miss(self, draw, members):
        of = draw.choice(members) if members else (None, None)
        return self.near.draw(draw, **draw.choice(({"types": [of[0]]}, {"textures": [of[1]]})))

    def table(self, draw, members, things=THINGS):
        """Members one by one; a near miss and what another command means, by turns of a coin; others where there is no other command."""
        found = []
        for _ in range(members):
            found.append(self.member(draw, found))
        first = draw.randrange(2)
        for number in range(things - members):
            found.append(self.near_miss(draw, found[:members]) if number % 2 == first else draw.choice(self.decoys).draw(draw))
        draw.shuffle(found)
        return found


class Pair(Class):
    """A scenario: two commands that differ in how the same things are used, and two that are demonstrated."""

    def __init__(self, scenario):
        self.id, self.shown_words = scenario["id"].removeprefix("errands_"), scenario["shown"]
        of = lambda seen: [(one["utterance"], meaning.read(one["truth"]["target"])) for one in scenario["commands"] if one.get("seen", True) == seen]
        (self.words, self.turns), (self.heard_words, self.heard), self.group = zip(*of(False)), zip(*of(True)), scenario["group"]
        self.needed, self.belong = [tuple(one) for one in scenario["tests"][0]["needed"]], range(scenario["belong"][0], scenario["belong"][1] + 1)
        sets = tuple(dict.fromkeys(turn.sets for turn in self.turns[0]))
        super().__init__(scenario["feature_space"], sets, *(sets_of(scenario[key]) for key in ("near_miss_sets", "undecided")))
        self.taught = TAUGHT
        one, other = self.turns
        self.how = "A or else B" if one[-1].only_if_nothing else "A then B" if len(one) > 1 else \
            "two, all" if one[0].take != other[0].take else "alike, unlike" if one[0].take == 2 else "all, each"


class Refusing(Class):
    """A command of another suite, which asks for one thing; as a pair has them, so that the same rows play it."""

    def __init__(self, scenario):
        self.id = scenario["id"].removeprefix("refusing_")
        of = json.loads((ROOT / f"envs/{scenario['environment']}/scenarios/{scenario['of']}.json").read_text())
        self.words, self.turns = of["commands"][0]["utterance"], meaning.read(of["commands"][0]["truth"]["target"])
        super().__init__(of["feature_space"], (self.turns[0].sets,), *(sets_of(scenario[key]) for key in ("near_miss_sets", "undecided")))
        self.turns, self.heard, self.mates, self.taught = (self.turns,), (self.turns,), [self], ((1,), 2)


class Scene:
    """`things`: names by id; `later` appears after the first take."""

    def __init__(self, of, arm, number, things, later=None):
        self.of, self.arm, self.number, self.seed = of, arm, number, number % TRAINING_SEEDS
        self.things, self.later = dict(enumerate(things, 1)), {len(things) + 1: later} if later else {}
        self.all = {**self.things, **self.later}

    def table(self, taken):
        return {one: name for one, name in (self.all if taken else self.things).items() if one not in taken}

    def random(self, *what):
        """The same for both commands."""
        return random.Random("/".join(map(str, (self.of.seed, self.of.id, self.arm, self.number) + what)))


# Who plays is a function of what is seen (names by id), of the names that were brought, and of the step: an id, or None for "done".

def follow(order, turns):
    def choose(seen, brought, step):
        if done_is_right(turns, seen.values(), brought):
            return None
        want = wanted(turns, seen.values(), brought)
        return next((one for one in order if one in seen and seen[one] in want), None)
    return choose


def order_of(scene):
    order = list(scene.all)
    scene.random("order").shuffle(order)
    return order


def planned_ids(scene, turns):
    plan, choose = [], follow(order_of(scene), turns)
    while (one := choose({i: name for i, name in scene.things.items() if i not in plan}, [scene.things[i] for i in plan], 0)) is not None:
        plan.append(one)
    return plan


def right_sequences(scene, turns, taken=()):
    """Names of what is taken, in each order that is right; None where a wanted take leads nowhere."""
    table, brought = scene.table(taken), tuple(scene.all[one] for one in taken)
    if done_is_right(turns, table.values(), brought):
        return {brought}
    found, want = set(), wanted(turns, table.values(), brought)
    for name in want:
        more = right_sequences(scene, turns, taken + (next(one for one in table if table[one] == name),))
        if more is None:
            return None
        found |= more
    return found or None


def is_kept(scene, needed):
    if any(len(planned_ids(scene, turns)) != takes for turns, takes in zip(scene.of.turns, needed)):
        return False
    right = [right_sequences(scene, turns) for turns in scene.of.turns]
    if None in right:
        return False
    first = [tuple(sorted(name for name in scene.things.values() if name in wanted(turns, scene.things.values()))) for turns in scene.of.turns]
    return not right[0] & right[1] and not all(one in {tuple(sorted(some)) for some in of} for one, of in zip(first, right))


def test_scene(pair, arm, number):
    """Takes that are needed are drawn evenly of those that the pair can need; in `appears` somebody has to take something."""
    draw = random.Random(f"{pair.seed}/{pair.id}/{arm}/{number}")
    may_need = [one for one in pair.needed if arm != "appears" or 0 not in one]
    needed = may_need[number % len(may_need)]
    for _ in range(100000):
        if arm == "nothing":
            return Scene(pair, arm, number, pair.table(draw, 0))
        things = pair.table(draw, draw.choice(pair.belong))
        members = [one for one in things if belongs(pair.turns[0], one)]
        later = (pair.member if draw.random() < .5 else pair.near_miss)(draw, members) if arm == "appears" else None
        scene = Scene(pair, arm, number, things, later)
        if is_kept(scene, needed):
            return scene
    raise SystemExit(f"{pair.id}: no scene that needs {needed} in {arm}")


def pairs_of(seed):
    found = [Pair(one) for one in DATA["scenarios"]]
    for pair in found:
        pair.seed, pair.mates = seed, [one for one in found if one.group == pair.group]
        decoys = ([thing for thing in pair.rest if thing in one.union] for one in pair.mates if one is not pair)
        pair.decoys = [Pool(some) for some in decoys if some]
    return found


Demonstration = collections.namedtuple("Demonstration", "things steps")  # steps: (number of the set, name) in the order of their taking


def demonstrated(of, turns, draw):
    """Somebody who knows the turns plays a table, and takes each of what is wanted with equal odds."""
    members, things = of.taught
    while True:
        table, brought, steps = of.table(draw, draw.choice(members), things), [], []
        left = list(table)
        while not done_is_right(turns, left, brought) and (want := wanted(turns, left, brought)):
            brought.append(draw.choice([one for one in sorted(left) if one in want]))
            left.remove(brought[-1])
            steps.append((next(i for i, some in enumerate(of.sets) if brought[-1] in some), brought[-1]))
        if steps:
            return Demonstration(tuple(table), tuple(steps))


@functools.lru_cache(None)
def demonstrations(pair, turns, seed, number):
    draw = random.Random(f"{pair.seed}/{pair.id}/demonstrations/{seed}")
    return [demonstrated(pair, turns, draw) for _ in range(number)]
