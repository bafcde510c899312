"""Methods for lgabench in Python: what they are given, and what they return.

A method is a class in a file; `lgabench run q1 --methods my_method.py:MyMethod` runs it (docs/add-a-method.md):

    class MyMethod:
        version = "0.1"
        summary = "what it does, in a line"
        options = {"steps": {"default": 100, "help": "optimiser steps", "source": "chosen"}}

        def needs(self, options): ...                # optional: a Needs
        def select(self, command, space, services): ...    # a Selection
        def revise(self, command, selected, demonstrations, services): ...    # optional: another Selection
        def learn(self, demonstrations, services): ...
            # an object with act(observation, instruction), and maybe reset() and shown(), a Shown

A perturbation axis is a class with `levels` and perceive(seen, level, stream). A perceiver, which reads names from pictures, is a
class with read(seen, space) (docs/extending.md).

This package needs NumPy alone. lgabench calls a class from one thread; the same seed must give the same bytes.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Optional, Protocol, Union

import numpy
import numpy.typing

from lgabench_method.stream import RandomStream
from lgabench_method.turns import PLACE, is_done, wanted

__all__ = ["Command", "Demonstration", "FeatureSet", "FeatureSpace", "HumanAnswers", "Hypothesis", "Instance", "Instruction",
           "LanguageModel", "Meaning", "Method", "Needs", "Observation", "Perturbation", "Policy", "RandomStream", "Refused", "SecondRole", "SecondSet",
           "Selection", "Services", "Shown", "Step", "TrainingLog", "Turn", "Which", "goal_mask", "grounded", "is_done", "select_features",
           "select_meaning", "taken", "wanted"]

Bytes = numpy.typing.NDArray[numpy.uint8]
Numbers = numpy.typing.NDArray[numpy.float64]
Picture = Union[tuple[str, numpy.typing.ArrayLike], tuple[str, numpy.typing.ArrayLike, str]]
Question = tuple[str, str, str]  # about "target" or SecondRole.id, group "object_type" or "texture", candidate


class Refused(RuntimeError):
    """A question was not answered: nobody has answered it, or the method may not ask it."""


@dataclass(frozen=True)
class SecondRole:
    """A task's second set of objects: `avoid` for sweep, and "the object to be avoided" in prompts."""
    id: str
    phrase: str


@dataclass(frozen=True)
class Command:
    """What a method is told of the task: the words, the task's id, and the second set that the words speak of, if any."""
    utterance: str
    task: str
    second: Optional[SecondRole] = None
    may_stop: bool = False  # whether it may say how objects are used in turn


@dataclass(frozen=True)
class FeatureSpace:
    """What a scene can be described with (paper, section 4.1): object types x textures."""
    id: str
    object_types: list[str]
    textures: list[str]


@dataclass
class FeatureSet:
    """Object types and textures; an object belongs if both of its features do."""
    object_types: list[str] = field(default_factory=list)
    textures: list[str] = field(default_factory=list)

    def contains(self, object_type: str, texture: str) -> bool:
        """Whether both are among its features."""
        return object_type in self.object_types and texture in self.textures


@dataclass
class SecondSet(FeatureSet):
    """The features of the second set; `role` is SecondRole.id."""
    role: str = ""


@dataclass
class Which:
    """Which one of several visible objects that belong to a meaning is meant.

    `rule` is left_of, right_of, nearest_to, farthest_from (with `of`, the reference), leftmost, rightmost, or first_in (with
    `order`: object types, or textures).
    """
    rule: str
    of: Optional[FeatureSet] = None
    order: list[str] = field(default_factory=list)


@dataclass
class Turn:
    """One of the things that a command wants done, one after the other: `take` so many objects of the sets, or, where it is None, as
    long as another on the table could join. `same` and `different` are parts, "object_type" and "texture": in what all that the turn
    takes are alike, in what each two differ. `only_if_nothing`: left out if the turn before found something."""
    sets: list[FeatureSet]
    take: Optional[int] = None
    same: list[str] = field(default_factory=list)
    different: list[str] = field(default_factory=list)
    only_if_nothing: bool = False


@dataclass
class Meaning:
    """A union of products of object types and textures and, where the words say so, which of several objects is meant, or how they
    are used in turn: `sets` are then those of all turns, each once, as Meaning.in_turns() makes them."""
    sets: list[FeatureSet]
    which: Optional[Which] = None
    turns: list[Turn] = field(default_factory=list)

    @classmethod
    def in_turns(cls, turns: list[Turn]) -> Meaning:
        """The meaning of those turns."""
        sets: list[FeatureSet] = []
        for one in (one for turn in turns for one in turn.sets):
            if one not in sets:
                sets.append(one)
        return cls(sets, None, turns)

    def belongs(self, object_type: str, texture: str) -> bool:
        """Whether the object is in any of the sets."""
        return any(one.contains(object_type, texture) for one in self.sets)


@dataclass
class Hypothesis:
    """A preference that a person may have and did not say: in words, and what they then take."""
    text: str
    meaning: Meaning
    weight: float = 1.  # how likely it is beside the others


@dataclass(init=False)
class Selection:
    """Which features matter (paper, section 3.1). `second` describes the task's second set; None where it has none.

    `meaning` describes the whole target. `target` is its one product, and raises ValueError where there is more to it. lgabench
    fills in `provenance`, `source` and `asked_as` by what was asked, and ignores what a method writes there.
    """
    meaning: Meaning
    second: Optional[SecondSet]
    provenance: str
    source: str
    asked_as: str

    def __init__(self, target: Optional[FeatureSet] = None, second: Optional[SecondSet] = None, provenance: str = "none",
                 source: str = "", asked_as: str = "", *, meaning: Optional[Meaning] = None) -> None:
        if target is not None and meaning is not None:
            raise TypeError("Selection: expected target or meaning, not both")
        self.meaning = meaning or Meaning([target or FeatureSet()])
        self.second, self.provenance, self.source, self.asked_as = second, provenance, source, asked_as

    @property
    def target(self) -> FeatureSet:
        """The meaning's one product; ValueError where it is more."""
        if len(self.meaning.sets) != 1 or self.meaning.which or self.meaning.turns:
            raise ValueError("Selection.target: the meaning is more than one product; read Selection.meaning, or grounded()")
        return self.meaning.sets[0]

    @target.setter
    def target(self, product: FeatureSet) -> None:
        self.meaning = Meaning([product])

    def belongs(self, object_type: str, texture: str) -> bool:
        """Whether target or second set names the object's features; grounded() says which object is meant."""
        return (self.meaning.belongs(object_type, texture)
                or (self.second is not None and self.second.contains(object_type, texture)))


@dataclass(frozen=True)
class Instruction:
    """What a policy is conditioned on: the command's words and the Selection made for them."""
    utterance: str
    selection: Selection


@dataclass(frozen=True)
class Instance:
    """One textualized object; `id` is its value in Observation.ids, `pixels` how many are visible."""
    id: int
    object_type: str
    texture: str
    pixels: int


@dataclass(frozen=True)
class Observation:
    """The camera's picture. `rgb` is rows x columns x 3, `ids` rows x columns, both uint8; 0 in `ids` is no object.

    `shadows` is rows x columns, uint16, or None unless Needs asked for it. Bit k says that the object of instances[k] keeps
    light from what the pixel shows. repaint() takes shadows away by it. `state` has the numbers of layout["observation"]["state"],
    none where the task has no state. In episodes of several steps `brought` names what was taken so far: (object type, texture).
    """
    rgb: Bytes
    ids: Bytes
    instances: list[Instance]
    shadows: Optional[numpy.typing.NDArray[numpy.uint16]] = None
    state: Numbers = field(default_factory=lambda: numpy.zeros(0))
    brought: list[tuple[str, str]] = field(default_factory=list)


@dataclass(frozen=True)
class Step:
    """An observation with the oracle's action for it, a double for each of layout["action"]["numbers"]; without numbers where
    nothing is left to do (layout["may_stop"])."""
    observation: Observation
    label: Numbers


@dataclass(frozen=True)
class Demonstration:
    """The oracle's episode for one instruction: one step, but in tasks of several. With Needs.noisy_per_clean `recovery` has
    labelled states that noisy executions of the first step led to."""
    instruction: Instruction
    steps: list[Step]
    recovery: list[Step] = field(default_factory=list)


@dataclass
class Needs:
    """What a method asks of the data it learns from, as lgabench::Needs in core/method.hpp."""
    targets: Literal["selected", "truth"] = "selected"
    noisy_per_clean: int = 0
    noise_max: float = 0.0
    shadows: bool = False


@dataclass
class Shown:
    """What the policy's last act() read of the scene, for a report's page. No result depends on it.

    `pictures` are (name, array) or (name, array, how it is read). An array of rows x columns is a mask: a number above 0
    is white, one below 0 red, and 0 black. An array of rows x columns x 3 has colours: bytes, or numbers from 0 to 1.
    """
    pictures: Sequence[Picture] = field(default_factory=list)
    texts: Sequence[str] = field(default_factory=list)   # read beside them, in words for a caption
    unread: Sequence[str] = field(default_factory=list)  # of the method's inputs, what this policy leaves out


class LanguageModel(Protocol):
    """Answers which features matter, by recorded answers or a server's. lgabench counts the questions."""

    def answer(self, command: Command, space: FeatureSpace, questions: Sequence[Question]) -> list[bool]:
        """Returns True for yes, in the order of the questions. Raises Refused."""

    def mean(self, command: Command, space: FeatureSpace) -> Meaning:
        """What the command means, in one answer; empty where the model gave no meaning that can be read. Raises Refused."""


    def hypotheses(self, command: Command, space: FeatureSpace) -> list[Hypothesis]:
        """The unstated preferences that could explain why a person takes only some of the objects that the words mean; empty
        where there is no answer. Raises Refused."""


class HumanAnswers(Protocol):
    """A person's answers, for methods that declare that they ask people; for others every call raises Refused."""

    def specify(self, command: Command) -> Selection:
        """The Selection that the person makes for the command."""

    def edit(self, command: Command, proposal: Selection) -> Selection:
        """The proposal as the person leaves it."""

    def accepts(self, command: Command, object_type: str, texture: str) -> bool:
        """Whether the person, shown one object, would take it for that command."""

    def scene(self, command: Command, scene: int) -> list[dict[str, Any]]:
        """The objects of a scene that the person may be asked about, free of charge. Scenes count from 0: the command's demonstrated
        ones, then some that nobody demonstrated. An object has id, object_type, texture, pixels, and row and column of its middle."""

    def takes(self, command: Command, scene: int, instance: int) -> bool:
        """Whether the person would take that object in that scene. A call counts as one of the option `questions`, which() as three.
        Raises Refused when these are used up."""

    def which(self, command: Command, scene: int) -> Optional[int]:
        """Id of the object that the person would take in that scene, or None."""


class TrainingLog(Protocol):
    """Where a method reports its training, while learn() runs."""

    def epoch(self, epochs: int, steps: int, loss: float, **curves: float) -> None:
        """Call it after each pass over the data, with the passes and optimiser steps so far, the pass's mean loss, and other
        values of the pass by name, such as validation=0.2. A report draws a curve of each."""


@dataclass
class Services:
    """What lgabench lends to a method for the length of a call."""
    lm: LanguageModel
    human: HumanAnswers
    options: dict[str, Any]  # all, defaults filled in
    seed: int                # governs all that is random
    log: TrainingLog
    files: str               # a directory for pictures and curves of the method's own; kept with the cell
    layout: dict[str, Any]   # "observation", "action" and "may_stop" of the protocol: rows, columns, state; numbers, rotations, ...
    shows_truth: bool = False  # in revise(): the demonstrations' targets are drawn from the true distribution


class Policy(Protocol):
    """What was learned. A policy may also have reset(), called before each episode; shown() -> Shown; and an attribute
    seen_in_training, whether the last act() read, to the byte, an input of training. `run --keep-policy` pickles the policy."""

    def act(self, observation: Observation, instruction: Instruction) -> numpy.typing.ArrayLike:
        """Returns an action, the only one of an episode but in tasks of several steps: a number for each of
        layout["action"]["numbers"], or where layout["may_stop"] says so [] for: nothing is left to do."""


class Method(Protocol):
    """The functions of a method's class that lgabench calls, in this order. The class may also have needs(options) -> Needs, called
    first, and revise(command, selected, demonstrations, services) -> Selection, called before learn()."""
    version: str
    summary: str
    options: dict[str, dict[str, Any]]

    def select(self, command: Command, space: FeatureSpace, services: Services) -> Selection:
        """Which features could the command mean (paper, section 3.1)? Called for each command of the scenario."""

    def learn(self, demonstrations: list[Demonstration], services: Services) -> Policy:
        """Returns a policy learned from the demonstrations, the cell's number of them for each seen command."""


class Perturbation(Protocol):
    """The class of a perturbation axis. `levels` says what each level is, level 1 first. `changes` lists which of "rgb", "ids" and
    "instances" differ in nearly every episode; `may_change`, if there are any, those that differ in some. With `named = True`,
    levels have no order."""
    version: str
    summary: str
    levels: list[str]
    changes: list[str]

    def perceive(self, seen: Observation, level: int, stream: RandomStream) -> Observation:
        """Returns what is perceived at that level, 1 or more, in place of `seen`: arrays of the same shapes, ids of listed instances
        alone.

        `stream` is the scene's and the same at every level: draw the direction of a change from it, and let the level give the
        size. The same arguments must give the same bytes. You may change the arrays of `seen`; lgabench counts instances' pixels.
        """


class Perceiver(Protocol):
    """The class of a perceiver, which reads names from pictures (--names)."""
    version: str
    summary: str

    def read(self, seen: Observation, space: FeatureSpace) -> Observation:
        """Returns `seen`, which has no instances, with those that the class reads: names of the space, for ids that `ids` has.

        `ids` are the run's segments, and may be changed; lgabench ignores changed colours. The same picture must get the same
        names, whatever was asked before.
        """


def select_features(command: Command, space: FeatureSpace, lm: LanguageModel) -> Selection:
    """Asks of every object type and texture whether the target, and the task's second set, could have it."""
    abouts = ["target"] + ([command.second.id] if command.second else [])
    questions = [(about, group, name) for about in abouts
                 for group, names in (("object_type", space.object_types), ("texture", space.textures)) for name in names]
    selection = Selection(second=SecondSet(role=command.second.id) if command.second else None)
    for (about, group, name), yes in zip(questions, lm.answer(command, space, questions)):
        if yes:
            chosen = selection.second if selection.second and about != "target" else selection.target
            (chosen.object_types if group == "object_type" else chosen.textures).append(name)
    return selection


def select_meaning(command: Command, space: FeatureSpace, lm: LanguageModel) -> Selection:
    """Asks what the command means, in one question, and for the task's second set, where it has one, as select_features() does."""
    second = select_features(command, space, lm).second if command.second else None
    return Selection(second=second, meaning=lm.mean(command, space))


def grounded(meaning: Meaning, observation: Observation) -> list[int]:
    """Ids of the visible instances that are meant, as lgabench::grounded() of core/meaning.hpp finds them. With turns: that are
    wanted() now, by what is visible and what was brought, as they are named."""
    visible = [one for one in observation.instances if one.pixels > 0]
    if meaning.turns:
        names = [(one.object_type, one.texture) for one in visible]
        wants = wanted(meaning, names, observation.brought)
        return [one.id for one, name in zip(visible, names) if name in wants]
    which = meaning.which
    if which is None:
        return [one.id for one in visible if meaning.belongs(one.object_type, one.texture)]
    centres = {}
    for one in visible:
        rows, columns = numpy.nonzero(observation.ids == one.id)
        centres[one.id] = (rows.mean(), columns.mean())
    references = [one for one in visible if which.of is not None and which.of.contains(one.object_type, one.texture)]
    if which.rule in ("left_of", "right_of", "nearest_to", "farthest_from") and not references:
        return []
    by_texture = (sum(any(name in one.textures for one in meaning.sets) for name in which.order)
                  > sum(any(name in one.object_types for one in meaning.sets) for name in which.order))
    numbers = {}
    for one in visible:
        if not meaning.belongs(one.object_type, one.texture) or one in references or one.object_type == PLACE:
            continue
        row, column = centres[one.id]
        if which.rule in ("leftmost", "rightmost"):
            numbers[one.id] = column if which.rule == "leftmost" else -column
        elif which.rule == "first_in":
            name = one.texture if by_texture else one.object_type
            numbers[one.id] = which.order.index(name) if name in which.order else len(which.order)
        else:
            distance, reference_column = min((math.hypot(row - r, column - c), c) for r, c in (centres[it.id] for it in references))
            if (which.rule == "left_of" and column >= reference_column) or (which.rule == "right_of" and column <= reference_column):
                continue
            numbers[one.id] = -distance if which.rule == "farthest_from" else distance
    return [id for id, number in numbers.items() if number <= min(numbers.values()) + .5]


def goal_mask(observation: Observation, selection: Selection) -> Bytes:
    """The goal mask, rows x columns of 0 and 1: 1 on every object that is meant as target or second set (paper, section 3.1)."""
    kept = grounded(selection.meaning, observation)
    if selection.second is not None:
        kept += [one.id for one in observation.instances if selection.second.contains(one.object_type, one.texture)]
    return numpy.isin(observation.ids, kept).astype(numpy.uint8)


def taken(demonstration: Union[Demonstration, Step], layout: dict[str, Any]) -> Optional[int]:
    """Id of the instance that the step's label takes, or pushes, as lgabench::taken() of core/method.hpp finds it; of a
    demonstration that of the first step.

    `layout` is Services.layout. None where nothing that can be taken is in view, or where the label says that nothing is left
    to do.
    """
    step = demonstration.steps[0] if isinstance(demonstration, Demonstration) else demonstration
    numbers, places = layout["action"]["numbers"], layout["action"]["places"]
    ids = [one.id for one in step.observation.instances if one.object_type != PLACE]
    rows, columns = numpy.nonzero(numpy.isin(step.observation.ids, ids))
    if not len(rows) or not places or not len(step.label):
        return None

    def pixel(place: Sequence[int]) -> Numbers:
        shares = [(min(max(step.label[i], numbers[i]["low"]), numbers[i]["high"]) - numbers[i]["low"])
                  / (numbers[i]["high"] - numbers[i]["low"]) for i in place]
        return numpy.array(shares) * step.observation.ids.shape

    def nearest_to(point: Numbers) -> tuple[float, int]:
        distances = numpy.hypot(rows + .5 - point[0], columns + .5 - point[1])
        nearest = int(distances.argmin())
        return float(distances[nearest]), int(step.observation.ids[rows[nearest], columns[nearest]])

    start = pixel(places[0])
    distance, nearest = nearest_to(start)
    if distance <= 2 or len(places) < 2:
        return nearest
    way = pixel(places[1]) - start
    steps = math.ceil(math.hypot(*way))
    for i in range(1, steps + 1):
        distance, met = nearest_to(start + i / steps * way)
        if distance <= 1:
            return met
    return nearest
