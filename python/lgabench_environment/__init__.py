"""An environment of lgabench in Python: one class in one file (docs/simulators.md).

lgabench reads the attributes of the class without running it, so they are written out. The class runs in a process of its own.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional, Sequence, Union

import numpy
import numpy.typing
from lgabench_method.stream import RandomStream

__all__ = ["Environment", "Observation", "RandomStream", "Request", "Result", "Scene", "Thing", "arm_of", "near_misses"]
Numbers = numpy.typing.NDArray[numpy.float64]
Bytes = numpy.typing.NDArray[numpy.uint8]


@dataclass
class Thing:
    """What a scene holds: its names, and where it lies in metres, as the class means it. One at least has the role "target". Without
    ids lgabench gives them, in random order; else they are 1, 2, ... in an order that reveals no role."""
    object_type: str
    texture: str
    role: str = "distractor"
    place: tuple[float, float] = (0.0, 0.0)
    yaw: float = 0.0
    instance_id: int = 0


@dataclass(frozen=True)
class Request:
    """Which scene is asked for. `meant` are those of Environment.things that may be the target, `others` those that the command
    does not mean, (object type, texture) each."""
    task: str
    layout: str
    split: str
    arm: str
    seed: int
    index: int
    command: int
    meant: list[tuple[str, str]]
    others: list[tuple[str, str]]


@dataclass(frozen=True)
class Scene:
    """All that was sampled for an episode; `own` is what sample() gave beside the things."""
    scenario: str
    task: str
    layout: str
    split: str
    arm: str
    seed: int
    index: int
    command: int
    things: list[Thing]
    own: Any

    @property
    def target(self) -> Thing:
        return next(thing for thing in self.things if thing.role == "target")

    def find(self, instance: int) -> Thing:
        return next(thing for thing in self.things if thing.instance_id == instance)


@dataclass(frozen=True)
class Observation:
    """`rgb` is rows x columns x 3, `ids` rows x columns, both uint8: a thing's instance_id where it is seen, else 0. `state` has
    the numbers of Environment.state."""
    rgb: Bytes
    ids: Bytes
    state: Sequence[float] = ()


@dataclass(frozen=True)
class Result:
    """What an action led to. `failure` is one of Environment.failures where the episode is over without success; `taken` is the
    instance that was moved on purpose, 0 for none."""
    observation: Observation
    success: bool = False
    failure: str = ""
    terminated: bool = True
    truncated: bool = False
    taken: int = 0


def arm_of(scenario: dict[str, Any], request: Request) -> dict[str, Any]:
    """What the scenario's file says of the scenes that are asked for: its "train", or its test of that arm."""
    if request.arm == "train":
        return scenario.get("train", {})
    return next((test for test in scenario["tests"] if test["arm"] == request.arm), {})


def near_misses(target: tuple[str, str], others: Sequence[tuple[str, str]], near: Any = True) -> list[tuple[str, str]]:
    """The others, each (object type, texture), near misses first. Near are those that share the target's type or its texture, and
    those that `near` lists under "object_types" or "textures", as near_miss of a scenario does."""
    listed = near if isinstance(near, dict) else {}

    def is_near(one: tuple[str, str]) -> bool:
        return (one[0] == target[0] or one[1] == target[1] or one[0] in listed.get("object_types", ())
                or one[1] in listed.get("textures", ()))

    return sorted(others, key=lambda one: not is_near(one))


class Environment:
    """Derive from it. Attributes are literals; a task is {"id", "layouts", "example"} with "most_steps" (1), "failures" and
    "has_state" (True) where it needs them, a number of action or state (name, unit, low, high)."""
    id: Any  # its name: lower-case letters, digits, underscores
    tasks: Any  # a list of tasks
    failures: Any  # every word that Result.failure may be
    space: Any  # the feature space that names its things
    things: Any  # (object type, texture) of all that its scenes can show
    actions: Any  # numbers of an action
    places: Any = []                 # lists [index of the number that grows down in the picture, of the one that grows across]
    rotations: Any = []              # lists of indices of numbers that are a unit vector together
    state: Any = []
    picture: Any  # rows and columns
    most_instances: Any  # things of a scene
    packages: Any = []               # whose versions, with those that they need, are part of what a result depends on
    scenario_members: Any = []       # of a scenario's file, beside those that lgabench knows; sample() reads them
    scene_members: Any = []          # likewise, of its "train" and "tests"
    network: bool = False            # whether its process may open sockets of the internet
    memory_gib: float = 4            # of its process and all that it starts
    time_limit_s: float = 120        # of one call

    def sample(self, scenario: dict[str, Any], request: Request,
               random: RandomStream) -> Union[list[Thing], tuple[list[Thing], Any]]:
        """The things of a scene, and anything else that JSON has. Pure. `scenario` is the file, whole. This one draws a target from
        request.meant and others from request.others, and calls place(). The others are as many as "distractors" of the scenario's
        arm says, [fewest, most], else up to most_instances; near misses come first where its "near_miss" says so. Both have their
        effect if scene_members names them."""
        target = request.meant[random.below(len(request.meant))]
        arm = arm_of(scenario, request)
        fewest, most = arm.get("distractors", (self.most_instances - 1,) * 2)
        count = fewest + random.below(most - fewest + 1) if fewest < most else fewest
        others = [request.others[i] for i in random.permutation(len(request.others)) if request.others[i] != target]
        if arm.get("near_miss"):
            others = near_misses(target, others, arm["near_miss"])
        things = [Thing(*target, role="target"), *(Thing(*other) for other in others[:count])]
        things = [things[i] for i in random.permutation(len(things))]
        for number, thing in enumerate(things):
            thing.instance_id = number + 1
        return things, self.place(things, random)

    def place(self, things: list[Thing], random: RandomStream) -> Any:
        """Gives things their places; returns what becomes Scene.own."""
        raise NotImplementedError("place() or sample() is missing")

    def reset(self, scene: Scene) -> Observation:
        """Builds the scene anew: the same scene gives the same bytes, whatever was played before."""
        raise NotImplementedError

    def step(self, action: Optional[Numbers]) -> Result:
        """Carries out the action, whose numbers lie within their bounds; None says that nothing is left to do (may_stop)."""
        raise NotImplementedError

    def expert_action(self, instance: Optional[int] = None) -> Optional[Sequence[float]]:
        """What the oracle does now for the scene's target, or if that instance were it. None as in step()."""
        raise NotImplementedError
