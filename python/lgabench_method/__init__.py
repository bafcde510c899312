"""Methods for lgabench in Python: what they are given, and what they return.

A method is a class in a file; `lgabench run q1 --methods my_method.py:MyMethod` runs it (docs/add-a-method-in-python.md):

    class MyMethod:
        version = "0.1"
        summary = "what it does, in a line"
        options = {"steps": {"default": 100, "help": "optimiser steps", "source": "chosen"}}

        def needs(self, options): ...                # optional: a Needs
        def select(self, command, space, services): ...    # a Selection
        def revise(self, command, selected, demonstrations, services): ...    # optional: another Selection
        def learn(self, demonstrations, services): ...
            # an object with act(observation, instruction), and maybe reset() and shown(), a Shown

Needs NumPy alone. One thread; the same seed must give the same bytes.
"""
from dataclasses import dataclass, field

import numpy

__all__ = ["Command", "Demonstration", "FeatureSet", "FeatureSpace", "Instance", "Instruction", "Needs", "Observation",
           "Refused", "SecondRole", "SecondSet", "Selection", "Services", "Shown", "Step", "goal_mask", "select_features"]


class Refused(RuntimeError):
    """A question was not answered: nobody has answered it, or the method may not ask it."""


@dataclass(frozen=True)
class SecondRole:
    """A task's second set of objects: `avoid` for sweep, and "the object to be avoided" in prompts."""
    id: str
    phrase: str


@dataclass(frozen=True)
class Command:
    """What a method is told of the task: the words, the task's id, and what they speak of beside the target, if anything."""
    utterance: str
    task: str
    second: SecondRole = None


@dataclass(frozen=True)
class FeatureSpace:
    """What a scene can be described with (paper, section 4.1): object types x textures."""
    id: str
    object_types: list
    textures: list


@dataclass
class FeatureSet:
    """Object types and textures; an object belongs if both of its features do."""
    object_types: list = field(default_factory=list)
    textures: list = field(default_factory=list)

    def contains(self, object_type, texture):
        return object_type in self.object_types and texture in self.textures


@dataclass
class SecondSet(FeatureSet):
    """The features of the second set; `role` is SecondRole.id."""
    role: str = ""


@dataclass
class Selection:
    """Which features matter (paper, section 3.1). `second` describes the task's second set; None where it has none.

    `provenance`, `source` and `asked_as` are lgabench's, by what was asked; what a method writes there is not read.
    """
    target: FeatureSet = field(default_factory=FeatureSet)
    second: SecondSet = None
    provenance: str = "none"
    source: str = ""
    asked_as: str = ""

    def keeps(self, object_type, texture):
        """The object is kept in the goal mask."""
        return (self.target.contains(object_type, texture)
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
    """The camera's picture: `rgb` is rows x columns x 3, `ids` rows x columns, both uint8; 0 in `ids` is no object."""
    rgb: numpy.ndarray
    ids: numpy.ndarray
    instances: list


@dataclass(frozen=True)
class Step:
    """An observation with the oracle's action for it: a double for each of layout["action"]["numbers"]."""
    observation: Observation
    label: numpy.ndarray


@dataclass(frozen=True)
class Demonstration:
    """The oracle's episode for one instruction; with Needs.noisy_per_clean the recovery steps follow the first."""
    instruction: Instruction
    steps: list


@dataclass
class Needs:
    """What a method asks of the data it learns from, as lgabench::Needs in core/method.hpp."""
    targets: str = "selected"  # or "truth"
    noisy_per_clean: int = 0
    noise_max: float = 0.0


@dataclass
class Shown:
    """What the policy's last act() read of the scene, for a report's page: no result depends on it.

    `pictures` are (name, array) or (name, array, how it is read). An array of rows x columns is a mask: above 0 is white,
    below red, 0 black. One of rows x columns x 3 has colours: bytes, or numbers from 0 to 1.
    """
    pictures: list = field(default_factory=list)
    texts: list = field(default_factory=list)   # read beside them, in words for a caption
    unread: list = field(default_factory=list)  # of the method's inputs, what this policy leaves out


@dataclass
class Services:
    """What lgabench lends to a method for the length of a call."""
    lm: object       # answer(command, space, questions) -> [bool]; a question is (about, group, candidate)
    human: object    # specify(command), edit(command, proposal): for methods that declare that they ask people
    options: dict    # every one
    seed: int        # governs all that is random
    log: object      # epoch(epochs, steps, loss), in learn() after each pass over the data
    files: str       # a directory for pictures and curves of the method's own; kept with the cell
    layout: dict     # "observation" and "action" of the protocol: rows, columns; numbers, rotations, places


def select_features(command, space, lm):
    """Asks of every object type and texture whether the target, and the task's second set, could have it."""
    abouts = ["target"] + ([command.second.id] if command.second else [])
    questions = [(about, group, name) for about in abouts
                 for group, names in (("object_type", space.object_types), ("texture", space.textures)) for name in names]
    selection = Selection(second=SecondSet(role=command.second.id) if command.second else None)
    for (about, group, name), yes in zip(questions, lm.answer(command, space, questions)):
        if yes:
            chosen = selection.target if about == "target" else selection.second
            (chosen.object_types if group == "object_type" else chosen.textures).append(name)
    return selection


def goal_mask(observation, selection):
    """rows x columns of 0 and 1: 1 on every object that the Selection keeps (paper, section 3.1)."""
    kept = [one.id for one in observation.instances if one.pixels > 0 and selection.keeps(one.object_type, one.texture)]
    return numpy.isin(observation.ids, kept).astype(numpy.uint8)
