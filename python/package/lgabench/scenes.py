"""Scenarios and their scenes, stepped as a run steps them. This module needs NumPy alone."""
from __future__ import annotations

import json
import os
import pathlib
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple, NoReturn, Optional, Sequence, Union

import numpy
import numpy.typing

from lgabench import _core
from lgabench_method import Command, FeatureSpace, Instance, Observation, SecondRole, Selection
from lgabench_method.values import selection as _selection

Numbers = numpy.typing.NDArray[numpy.float64]
SPLITS = ("train", "dev", "test")
INDICES, SEEDS = 2**31, 2**64  # scenes of a split, and seeds of its scenes: from 0 on, as many as there are


@dataclass(frozen=True)
class Station:
    """A place that an action can lead to. `seen` is where a picture shows it, down and across, in the unit of the action's
    first place. `values` are the values of ActionSpace.station_numbers there."""
    seen: tuple[float, float]
    values: tuple[float, ...]


@dataclass(frozen=True)
class ActionSpace:
    """What the numbers of an action mean. `rotations` are indices of numbers that are a unit vector together: these are
    normalised, and all others clipped to their bounds, when an action is carried out. If an action leads to one of a few
    `stations`, `station_numbers` are the indices of numbers that are constants of a station; else both are empty."""
    names: tuple[str, ...]
    units: tuple[str, ...]
    low: Numbers
    high: Numbers
    rotations: tuple[tuple[int, ...], ...]
    station_numbers: tuple[int, ...] = ()
    stations: tuple[Station, ...] = ()

    def to_metres(self, scaled: numpy.typing.ArrayLike) -> Numbers:
        """Scales numbers within [-1, 1] to an action; one action, or a row each. A rotation of length 0 becomes no turn."""
        given = numpy.asarray(scaled, numpy.float64)
        if given.shape[-1:] != self.low.shape or not numpy.isfinite(given).all():
            raise ValueError(f"action: expected {len(self.low)} finite numbers, got {scaled!r}")
        metres = self.low + (given + 1) / 2 * (self.high - self.low)
        for rotation in map(list, self.rotations):
            no_turn = numpy.eye(len(rotation))[3 if len(rotation) == 4 else 0]
            null = numpy.linalg.norm(metres[..., rotation], axis=-1, keepdims=True) < 1e-6
            metres[..., rotation] = numpy.where(null, no_turn, metres[..., rotation])
        return metres

    def from_metres(self, action: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float32]:
        """Scales an action to [-1, 1], the inverse of to_metres(): the label for a learner of such numbers."""
        scaled = 2 * (numpy.asarray(action, numpy.float64) - self.low) / (self.high - self.low) - 1
        return numpy.clip(scaled, -1, 1).astype(numpy.float32)


class StateNumber(NamedTuple):
    """What a number of Observation.state is; its value lies within the bounds."""
    name: str
    unit: str
    low: float
    high: float


class Scenario:
    """A task with its commands, layouts and test arms, by the id of a shipped scenario or by a file of your own (`path`)."""

    def __init__(self, id: Optional[str] = None, *, path: Union[str, os.PathLike[str], None] = None) -> None:
        self._made_from = (id, None if path is None else os.path.abspath(path))
        self._core = _core.scenario(*self._made_from)
        self.id: str = self._core.id
        self.task: str = self._core.task
        self.environment: str = self._core.environment
        self.usual_engine = "mujoco" if self._core.has_engine else "own"  # "own": the environment has no engine plugin
        self.commands: list[str] = self._core.commands
        self.layouts: list[str] = self._core.layouts
        self.arms: list[str] = self._core.arms
        self.space = FeatureSpace(self._core.space_id, self._core.object_types, self._core.textures)
        self.picture_size: tuple[int, int] = self._core.picture_size
        self.most_instances: int = self._core.most_instances
        self.most_steps: int = self._core.most_steps  # actions of an episode
        self.may_stop: bool = self._core.may_stop     # whether an action without numbers ends it: nothing is left to do
        self.state = tuple(StateNumber(**one) for one in json.loads(self._core.state_json))
        space = json.loads(self._core.action_space_json)
        numbers, stations = space["numbers"], space.get("stations", {"numbers": [], "all": []})
        self.action_space = ActionSpace(tuple(one["name"] for one in numbers), tuple(one["unit"] for one in numbers),
                                        numpy.array([one["low"] for one in numbers], numpy.float64),
                                        numpy.array([one["high"] for one in numbers], numpy.float64),
                                        tuple(map(tuple, space["rotations"])), tuple(stations["numbers"]),
                                        tuple(Station(tuple(one["seen"]), tuple(one["values"])) for one in stations["all"]))

    def command(self, index: int) -> Command:
        """Command `index`, as Method.select() gets it."""
        second = self._core.second
        return Command(self.commands[index], self.task, SecondRole(*second) if second else None)

    def truth(self, index: int) -> Selection:
        """What the scenario's author means by command `index`; no observation holds it."""
        number = range(len(self.commands))[index]
        return _selection({**json.loads(self._core.truth_json(number)), "provenance": "truth"})

    @property
    def usual_layout(self) -> str:
        """The layout of the first shipped suite that has the scenario; the scenario's own first layout if none has it."""
        for file in sorted((pathlib.Path(_core.data_directory()) / "suites").glob("*.json")):
            suite = json.loads(file.read_text())
            if self.id in suite.get("scenarios", []) and suite["layouts"][0] in self.layouts:
                return str(suite["layouts"][0])
        return self.layouts[0]

    def __repr__(self) -> str:
        return f"lgabench.Scenario({self.id!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _scenario, self._made_from  # read again where it is unpickled


def _scenario(id: Optional[str], path: Optional[str]) -> Scenario:
    return Scenario(id, path=path)


class StepResult(NamedTuple):
    """What an action led to. `failure` is "none" or a word of docs/protocol.md. If `came_to_rest` is False, the episode was cut
    off. Episodes of several steps go on until `terminated` or `truncated`. `distance` has how far each part of success is from being right, 0 where it is right; all are 0 in a success. A part's
    name ends with its unit, _m, _deg or _px (docs/python.md lists the parts); a part without a unit is 0 or 1."""
    observation: Observation
    success: bool
    failure: str
    came_to_rest: bool
    distance: dict[str, float]
    terminated: bool = True
    truncated: bool = False


def _expect(name: str, value: int, count: int) -> None:
    if not 0 <= value < count:
        raise ValueError(f"{name} {value}: expected 0 to {count - 1}")


def refuse_copies() -> NoReturn:
    """What copying or pickling an environment does."""
    raise TypeError("a scene's physics cannot be copied or pickled; make the environment again where it is used")


def as_scenario(scenario: Union[str, Scenario]) -> Scenario:
    """The scenario, given itself or its id."""
    return scenario if isinstance(scenario, Scenario) else Scenario(scenario)


def layout_of(scenario: Scenario, layout: Optional[str]) -> str:
    """A layout of the scenario, by default the usual one; ValueError for another."""
    if layout is not None and layout not in scenario.layouts:
        raise ValueError(f"layout {layout!r}: expected one of {', '.join(scenario.layouts)}")
    return layout or scenario.usual_layout


def _observation(seen: Any) -> Observation:
    return Observation(seen[0], seen[1], [Instance(*row) for row in seen[2]], *seen[3:])


class Environment:
    """Scenes of one scenario on one engine, seen as a run's methods see them. Arrays are never reused. One thread at a
    time: a second thread's call meanwhile raises RuntimeError, as does a call out of order. With `shadows`, observations
    say whose shadow is where, as for a method that needs it."""

    def __init__(self, scenario: Union[str, Scenario], engine: Optional[str] = None, layout: Optional[str] = None, *,
                 shadows: bool = False) -> None:
        self.scenario = as_scenario(scenario)
        self.engine, self.layout = engine or self.scenario.usual_engine, layout_of(self.scenario, layout)
        self._one: Optional[_core.Environment] = _core.Environment(self.scenario._core, self.engine, self.layout, shadows)
        self._rows: numpy.typing.NDArray[numpy.int16]

    @property
    def action_space(self) -> ActionSpace:
        """Names, units and bounds of the numbers of the scenario's actions."""
        return self.scenario.action_space

    def reset(self, split: str = "train", index: int = 0, *, arm: Optional[str] = None, seed: int = 0,
              own_scenes: Optional[int] = None) -> Observation:
        """Begins scene `index` and returns what is seen. Test scenes are of an arm (the first if None), with its errors of
        perception. `seed` is the training seed for split train, the scene seed for test. `own_scenes` is a training seed with
        test scenes of its own, as in the suite mobile. An index from 2^31 on, or a seed from 2^64 on, raises ValueError."""
        if split not in SPLITS:
            raise ValueError(f"split {split!r}: expected train, dev or test")
        _expect("index", index, INDICES)
        _expect("seed", seed, SEEDS)
        if own_scenes is not None:
            _expect("own_scenes", own_scenes, SEEDS)
        *seen, self._rows = self._open().reset(split, arm or self.scenario.arms[0], seed, index, own_scenes)
        return _observation(seen)

    def step(self, action: numpy.typing.ArrayLike) -> StepResult:
        """Carries out an action, in metres and unit vectors. A second action starts from the state reached; in tasks of several
        steps there is none when the episode is over. An action without numbers says that nothing is left to do (may_stop)."""
        (*seen, self._rows), *led_to = self._open().step(numpy.ascontiguousarray(action, numpy.float64))
        return StepResult(_observation(seen), *led_to)

    def expert_action(self, instance: Optional[int] = None) -> Numbers:
        """The oracle's action in the present state; with an instance's id, as if that were the target."""
        action: Numbers = self._open().expert_action(instance)
        return action

    @property
    def utterance(self) -> str:
        """The present scene's command."""
        return str(self._open().utterance)

    @property
    def instance_rows(self) -> numpy.typing.NDArray[numpy.int16]:
        """The last observation's instances, a row each: id, index into object types and into textures, visible pixels; unused
        rows are -1."""
        self._open().scene_hash
        return self._rows

    @property
    def scene_hash(self) -> str:
        """The hash, 16 digits, by which episodes.jsonl names the present scene."""
        return str(self._open().scene_hash)

    def close(self) -> None:
        """Frees the engine's world; every later call raises RuntimeError."""
        self._one = None

    def _open(self) -> _core.Environment:
        if self._one is None:
            raise RuntimeError("environment: closed")
        return self._one

    def __reduce__(self) -> NoReturn:
        refuse_copies()

    def __enter__(self) -> Environment:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()


class Batch(NamedTuple):
    """Observations of several environments, a row each; `instances` as Environment.instance_rows; `state` has no columns where
    the task has none."""
    rgb: numpy.typing.NDArray[numpy.uint8]
    ids: numpy.typing.NDArray[numpy.uint8]
    instances: numpy.typing.NDArray[numpy.int16]
    state: Numbers = numpy.zeros((0, 0))


class Pool:
    """`count` environments of one scenario, advanced together on `threads` threads (as many as the job has cores if None). Each batch
    is a new array. After a fork, the child's calls raise RuntimeError. After step(), `terminated` and `truncated` say for each row
    whether the episode is over."""
    terminated: numpy.typing.NDArray[numpy.bool_]
    truncated: numpy.typing.NDArray[numpy.bool_]

    def __init__(self, scenario: Union[str, Scenario], count: int, threads: Optional[int] = None, engine: Optional[str] = None,
                 layout: Optional[str] = None) -> None:
        self.scenario = as_scenario(scenario)
        self.engine, self.layout = engine or self.scenario.usual_engine, layout_of(self.scenario, layout)
        self._pool = _core.Pool(self.scenario._core, self.engine, self.layout, count, threads or _core.usable_cores())

    def __reduce__(self) -> NoReturn:
        refuse_copies()

    def __len__(self) -> int:
        return len(self._pool)

    def reset(self, split: str, indices: Sequence[int], *, arms: Optional[Sequence[str]] = None,
              seeds: Optional[Sequence[int]] = None, at: Optional[Sequence[int]] = None) -> Batch:
        """Begins scene indices[i] in environment at[i]; without `at`, in all environments in order. Indices and seeds are those
        of Environment.reset()."""
        at = range(len(self)) if at is None else at
        for index in indices:
            _expect("index", index, INDICES)
        for seed in seeds or ():
            _expect("seed", seed, SEEDS)
        return Batch(*self._pool.reset(list(at), split, list(arms or [self.scenario.arms[0]] * len(at)),
                                       list(seeds or [0] * len(at)), list(indices)))

    def step(self, actions: numpy.typing.ArrayLike, at: Optional[Sequence[int]] = None, *,
             done: Optional[Sequence[bool]] = None
             ) -> tuple[Batch, numpy.typing.NDArray[numpy.bool_], list[str], list[dict[str, float]]]:
        """Carries out a row of `actions` in each environment; where `done` says so, that nothing is left to do. Returns
        observations, successes, failures, distances (StepResult)."""
        at = range(len(self)) if at is None else at
        seen, success, failures, _, distances, terminated, truncated = self._pool.step(
            list(at), numpy.ascontiguousarray(actions, numpy.float64), [bool(one) for one in done or []])
        self.terminated, self.truncated = terminated.view(numpy.bool_), truncated.view(numpy.bool_)
        return Batch(*seen), success.view(numpy.bool_), failures, distances

    def expert_actions(self) -> Numbers:
        """The oracle's actions, a row for each environment; NaN where it says that nothing is left to do."""
        actions: Numbers = self._pool.expert_actions(list(range(len(self))))
        return actions

    @property
    def utterances(self) -> list[str]:
        """The present scenes' commands."""
        utterances: list[str] = self._pool.utterances
        return utterances

    @property
    def scene_hashes(self) -> list[str]:
        """The Environment.scene_hash of each environment."""
        hashes: list[str] = self._pool.scene_hashes
        return hashes
