#!/usr/bin/env python3
"""How often rules without a language model and without training pick the meant object, in every arm of the abstraction track.

They read what methods read: labels, pictures, the command, and what its demonstrations took; for a command that nobody
demonstrated, what all demonstrations took. A rule gives each candidate a score; among several with the highest the meant
one counts as its share. In `fetch` the receiver is scored likewise, by what was received, among the things that stand
where actions can lead; `object_alone` is the object's part. Scenes are of a seed that no preset publishes; the meant
object is the one that the oracle's action is for. Rates are by the number of demonstrations, "0" where a rule learns nothing.
A leak is a rule whose best rate is more than .05 above chance though it learns no labels of what the command's demonstrations took.

Usage, with the built package: PYTHONPATH=build/ci/python tests/measure/rivals.py [--scenes N] [--suites SUITE-PRESET,...] [--out FILE]
"""
import argparse
import collections
import datetime
import functools
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

import lgabench
import lgabench_method
from lgabench.evaluation import wilson

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE_SEED, TRAINING_SEEDS = 77191, 8  # scenes of an arm share the demonstrations of these seeds in turn
NUMBERS = 1, 5, 20  # of demonstrations of a command
BESIDE = {"many_commands-abstraction_unheard": ["seen_commands_7"]}  # arms that decide nothing, for comparison
CURVES = {"clutter-curve": "clutter-abstraction", "few_members-curve": "few_members-abstraction_matched",
          "many_commands-curve": "many_commands-abstraction_unheard"}  # with the scenarios of
LEAK = .05  # above chance
Thing = collections.namedtuple("Thing", "id type texture pixels place colour outline")
Record = collections.namedtuple("Record", "utterance things stationed taken received")  # a scene; ids of what is meant
Known = collections.namedtuple("Known", "own every other said")  # demonstrations of the command, of all, of another one; its words


def scenarios_of(suite, preset, folder):
    """[(scenario with the suite's members, layout, number of demonstrated commands)], from the cells of a smallest run of the preset."""
    subprocess.run([sys.executable, "-m", "lgabench", "run", suite, "--preset", preset, "--methods", "human+policy=centroid", "--demos", "1",
                    "--seeds", "0", "--episodes", "1", "--engines", "kinematic", "--no-reference", "--jobs", "1", "--quiet",
                    "--cache", folder / "cache", "--out", folder / "run"], check=True, stdout=subprocess.DEVNULL)
    found = []
    for key in json.loads((folder / "run/run.json").read_text())["cells"]:
        cell, file = json.loads((folder / f"run/cells/{key}/cell.json").read_text()), folder / f"{key}.json"
        file.write_text(json.dumps(cell["scenario"]))
        found.append((lgabench.Scenario(path=file), cell["layout"], sum(one.get("seen", True) for one in cell["scenario"]["commands"])))
    return found


def thing(seen, one):
    """What rules may know of an instance in view: also its mean colour, and its mask in a square of 16 x 16."""
    down, across = numpy.nonzero(seen.ids == one.id)
    side = max(numpy.ptp(down), numpy.ptp(across)) + 1
    outline = numpy.zeros((16, 16), bool)
    outline[(down - down.min()) * 16 // side, (across - across.min()) * 16 // side] = True
    place = tuple((axis.mean() + .5) / size for axis, size in zip((down, across), seen.ids.shape))
    return Thing(one.id, one.object_type, one.texture, one.pixels, place, seen.rgb[down, across].mean(0), outline)


def record(env, seen):
    """The scene that stands in `env`, in which the oracle's action says what is meant."""
    space, action = env.action_space, env.expert_action()
    visible = [one for one in seen.instances if one.pixels > 0 and one.object_type != lgabench_method.PLACE]
    things = [thing(seen, one) for one in visible]
    meant = next((one.id for one in things if numpy.array_equal(env.expert_action(one.id), action)), None)
    if not space.stations:
        return Record(env.utterance, things, [], meant, None)
    away = lambda one, station: math.dist(one.place, station.seen)
    near = [one for one in things if min(away(one, station) for station in space.stations) < .08]  # half of what parts two
    to = min(space.stations, key=lambda station: math.dist(station.values, action[list(space.station_numbers)]))
    rest = [one for one in things if one.id not in {of.id for of in near}]
    return Record(env.utterance, rest, near, meant, min(near, key=lambda one: away(one, to)).id)


def features(one):
    return ("type", one.type), ("texture", one.texture), (one.type, one.texture)


class Shown:
    """What demonstrations took, or received, and what stood beside it; `place`: the demonstrated one with the least distance to the others."""

    def __init__(self, records, part):
        pairs = [(one, of.taken if part == "things" else of.received) for of in records for one in getattr(of, part)]
        self.taken = [one for one, chosen in pairs if one.id == chosen]
        self.counts = collections.Counter(f for one in self.taken for f in features(one))
        self.left = collections.Counter(f for one, chosen in pairs if one.id != chosen for f in features(one))
        if self.taken:
            self.place = min((of.place for of in self.taken), key=lambda a: sum(math.dist(a, of.place) for of in self.taken))
            self.colours, self.outlines = (numpy.stack([getattr(one, name) for one in self.taken]) for name in ("colour", "outline"))


def demonstrated(one, shown):
    return math.prod(shown.counts[f] + .5 for f in features(one)[:2])


def left(one, shown):
    """How often its type and its texture stood in demonstrations and were not taken."""
    return math.prod(shown.left[f] + .5 for f in features(one)[:2])


def shared(one, other):
    """How many of type and texture two things share."""
    return sum(a == b for a, b in zip(features(one)[:2], features(other)[:2]))


def alike_in_name(one, shown):
    """demonstrated(), times the mean similarity of its type's name to those taken, times its texture's; below 0 is 0."""
    mean = lambda part: max(sum(vector(getattr(one, part)) @ vector(getattr(of, part)) for of in shown.taken) / len(shown.taken), 0)
    return demonstrated(one, shown) * mean("type") * mean("texture")


def bayes(one, shown):
    """Naive, taken against left: type, texture and their pair, each counted with 1/2 added; what all candidates share is left out."""
    return math.prod((shown.counts[f] + .5) / (shown.left[f] + .5) for f in features(one))


def words(text):
    """Without plurals; the article is not the letter A."""
    return {w if len(w) == 1 else w.lower().rstrip("s") for w in re.findall("[A-Za-z]+", text)}


def named(one, utterance):
    said = words(utterance)
    return sum(len(words(name) & said) / len(words(name)) for name in (one.type, one.texture))


@functools.cache
def vector(text):
    """A committed sentence embedding, of norm 1."""
    return numpy.array(embeddings()[text])


@functools.cache
def embeddings():
    file = pathlib.Path(lgabench._core.data_directory()) / "embeddings/all-MiniLM-L6-v2.json"
    return json.loads(file.read_text())["embeddings"]


def overlap(one, shown):
    """Of its outline with the likest of those taken: intersection over union."""
    return ((one.outline & shown.outlines).sum((1, 2)) / (one.outline | shown.outlines).sum((1, 2))).max()


# name -> the score of a candidate, given what is Known; the first learn nothing.
UNTAUGHT = {
    "random_object": lambda one, known: 0,
    "largest": lambda one, known: one.pixels,
    "first_listed": lambda one, known: -one.id,
    "names": lambda one, known: named(one, known.said),
    "word_vectors": lambda one, known: float(vector(known.said) @ (vector(one.type) + vector(one.texture)))}
TAUGHT = {
    "constant_place": lambda one, known: -math.dist(one.place, known.own.place),
    "nearest_colour": lambda one, known: -numpy.linalg.norm(one.colour - known.own.colours, axis=1).min(),
    "nearest_outline": lambda one, known: overlap(one, known.own),
    "nearest_size": lambda one, known: -min(abs(math.log(one.pixels / of.pixels)) for of in known.own.taken),
    "another_commands": lambda one, known: demonstrated(one, known.other),
    "least_demonstrated": lambda one, known: -demonstrated(one, known.every),
    "exclusion": lambda one, known: -left(one, known.own),
    "last_demonstrated": lambda one, known: shared(one, known.own.taken[-1]),
    "most_demonstrated": lambda one, known: demonstrated(one, known.own),
    "names_and_demonstrated": lambda one, known: (named(one, known.said) + .5) * demonstrated(one, known.own),
    "most_alike_names": lambda one, known: alike_in_name(one, known.own),
    "bayes": lambda one, known: bayes(one, known.own)}
# No leaks: what methods are compared with.
LABEL_LEARNERS = {"most_demonstrated", "names_and_demonstrated", "most_alike_names", "bayes", "exclusion", "last_demonstrated"}


def share(rule, candidates, meant, known):
    """The probability that the rule picks the meant one."""
    scores = [rule(one, known) for one in candidates]
    best = [one.id for one, score in zip(candidates, scores) if score >= max(scores) - 1e-9]
    return (meant in best) / len(best)


def picks(rule, test, *shown):
    """How likely a rule picks in a test scene (the object, it and the receiver): both the same where there is none. `shown`:
    dictionaries as of() has them, of the command, of all and of another command."""
    parts = [("things", test.taken)] + [("stationed", test.received)] * bool(test.stationed)
    shares = [share(rule, getattr(test, part), meant, Known(*(one[part] for one in shown), test.utterance)) for part, meant in parts]
    return shares[0], math.prod(shares)


class Demonstrations:
    """The first ones of a training seed, of each demonstrated command."""

    def __init__(self, env, seed, commands):
        self.by_command, index = collections.defaultdict(list), 0
        while len(self.by_command) < commands or min(map(len, self.by_command.values())) < max(NUMBERS):
            one = record(env, env.reset("train", index, seed=seed))
            self.by_command[one.utterance].append(one)
            index += 1
        self.commands, self._shown = list(self.by_command), {}

    def of(self, utterance, n):
        """What the first `n` of a command showed; those of all commands where it has none, or is None."""
        key = utterance if utterance in self.commands else None, n
        if key not in self._shown:
            records = [one for said in self.commands if key[0] in (None, said) for one in self.by_command[said][:n]]
            self._shown[key] = {part: Shown(records, part) for part in ("things", "stationed")}
        return self._shown[key]


def measure(scenarios, arm, scenes, scene_seed, known, plain=tuple(UNTAUGHT), learners=tuple(TAUGHT)):
    """The table of an arm over the scenarios that have it. `known`: demonstrations, kept between the arms of a suite. The last two: which rules."""
    playing = [one for one in scenarios if arm in one[0].arms]
    environments = [lgabench.Environment(scenario, "kinematic", layout) for scenario, layout, _ in playing]

    def shown(number, seed):
        scenario, _, commands = playing[number]
        if (scenario.id, seed) not in known:
            known[scenario.id, seed] = Demonstrations(environments[number], seed, commands)
        return known[scenario.id, seed]

    results, nothing = collections.defaultdict(list), {"things": None, "stationed": None}  # (rule, demonstrations) -> pairs of shares
    for number, env in enumerate(environments):
        for index in range(math.ceil(scenes / len(playing))):
            seed = index // len(env.scenario.commands) % TRAINING_SEEDS if len(env.scenario.commands) > 1 else index % TRAINING_SEEDS
            test = record(env, env.reset("test", index, arm=arm, seed=scene_seed, own_scenes=seed))
            taught, next_one = shown(number, seed), shown((number + 1) % len(playing), seed)
            others = [(taught, said) for said in taught.commands if said != test.utterance] or [(next_one, next_one.commands[0])]
            other, said = others[index % len(others)]
            for name in plain:
                results[name, 0].append(picks(UNTAUGHT[name], test, nothing, nothing, nothing))
            for n in NUMBERS:
                for name in learners:
                    results[name, n].append(picks(TAUGHT[name], test, taught.of(test.utterance, n), taught.of(None, n), other.of(said, n)))
    return table(results, two=bool(environments[0].action_space.stations))


def table(results, two):
    """Rates with Wilson's intervals over scenes; leaks, which are above chance without having learned labels."""
    rounded = lambda numbers: [round(float(one), 4) for one in numbers]

    def rates(part):
        found = collections.defaultdict(dict)
        for (name, n), pairs in results.items():
            won = sum(pair[part] for pair in pairs)
            found[name][str(n)] = dict(zip(("rate", "low", "high"), rounded((won / len(pairs), *wilson(won, len(pairs))))))
        return dict(found)

    chance = rounded(numpy.mean(results["random_object", 0], 0))
    out = {"scenes": len(results["random_object", 0]), "chance": chance[1], "rivals": rates(1)}
    out["leaks"] = sorted(name for name, by_n in out["rivals"].items() if name not in LABEL_LEARNERS
                          and max(one["rate"] for one in by_n.values()) > chance[1] + LEAK)
    return {**out, "object_alone": {"chance": chance[0], "rivals": rates(0)}} if two else out


def arms_of_the_track():
    """{suite-preset: arms}; a curve's scenes are of another preset's arms, and persons' are rivals themselves (tests/unit/persons_test.cpp)."""
    tracks = json.loads((ROOT / "results/leaderboard/tracks.json").read_text())
    return {name: arms + BESIDE.get(name, []) for name, arms in tracks["abstraction"].items()
            if name not in CURVES and name not in tracks.get("persons", [])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene-seed", type=int, default=SCENE_SEED)
    parser.add_argument("--scenes", type=int, default=300, help="test scenes of an arm, at least")
    parser.add_argument("--suites", help="of the track, SUITE-PRESET,...; all if not given")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "results/measured/rivals.json")
    given = parser.parse_args()
    tables = {}
    for name, arms in arms_of_the_track().items():
        if given.suites and name not in given.suites.split(","):
            continue
        with tempfile.TemporaryDirectory() as folder:
            scenarios, known = scenarios_of(*name.split("-"), pathlib.Path(folder)), {}
            for arm in arms:
                tables[f"{name}-{arm}"] = measure(scenarios, arm, given.scenes, given.scene_seed, known)
                print(name, arm, tables[f"{name}-{arm}"]["leaks"], file=sys.stderr, flush=True)
    command = f"tests/measure/rivals.py --scene-seed {given.scene_seed} --scenes {given.scenes}"
    text = json.dumps({"scene_seed": given.scene_seed, "scenes": given.scenes, "date": datetime.date.today().isoformat(),
                       "command": command, "training_seeds": TRAINING_SEEDS, "suites": tables}, indent=1)
    given.out.write_text(re.sub(r"[{[][^][{}]*[]}]", lambda inner: re.sub(r"\n\s*", " ", inner[0]), text) + "\n")  # a rate a line


if __name__ == "__main__":
    main()
