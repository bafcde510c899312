"""Measures the success of your own actor on the test scenes of a run."""
from __future__ import annotations

import collections
import math
from dataclasses import dataclass
from typing import Callable, Optional, Union

import numpy.typing

from lgabench.scenes import Environment, Scenario
from lgabench_method import Observation


@dataclass(frozen=True)
class Result:
    """Success of an actor outside of a run. It is no row of a table: a run confines methods and records what they did."""
    success: float
    low: float  # Wilson's 95 % interval
    high: float
    episodes: int
    failures: dict[str, int]


def wilson(successes: int, episodes: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a rate."""
    z = 1.959963984540054
    share, half = successes / episodes, z * z / (2 * episodes)
    spread = z * math.sqrt(share * (1 - share) / episodes + z * z / (4 * episodes**2))
    whole = 1 + 2 * half
    return max(0.0, (share + half - spread) / whole), min(1.0, (share + half + spread) / whole)


def evaluate(act: Callable[[Observation, str], numpy.typing.ArrayLike], scenario: Union[str, Scenario, Environment],
             episodes: int = 100, *, arm: Optional[str] = None, layout: Optional[str] = None, seed: int = 0,
             own_scenes: Optional[int] = None, engine: Optional[str] = None, strict: bool = False,
             reset: Optional[Callable[[], object]] = None) -> Result:
    """Plays the first `episodes` test scenes: act(observation, utterance) -> an action, in metres. It is called once an episode,
    in tasks of several steps until the episode is over; reset() before each episode.

    An action that is none (too few numbers, NaN, a rotation of norm 0) is a failure, `method_error`, as in a run; with `strict`
    its ValueError is raised. If all actions are none, the first ValueError is raised in any case: nothing was measured. What act()
    itself raises is always raised.
    """
    if episodes < 1:
        raise ValueError(f"episodes {episodes}: expected 1 or more")
    environment = scenario if isinstance(scenario, Environment) else Environment(scenario, engine, layout)
    failures: collections.Counter[str] = collections.Counter()
    first: Optional[ValueError] = None
    for index in range(episodes):
        seen = environment.reset("test", index, arm=arm, seed=seed, own_scenes=own_scenes)
        if reset is not None:
            reset()
        while True:
            action = act(seen, environment.utterance)
            try:
                result = environment.step(action)
            except ValueError as e:
                if strict:
                    raise
                first = first or e
                failures["method_error"] += 1
                break
            if result.terminated or result.truncated:
                failures[result.failure] += 1
                break
            seen = result.observation
    if first and failures["method_error"] == episodes:
        raise first
    won = failures.pop("none", 0)
    return Result(won / episodes, *wilson(won, episodes), episodes, dict(failures))
