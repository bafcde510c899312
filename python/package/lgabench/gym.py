"""Scenes as Gymnasium environments, made by gymnasium.make("lgabench/heart-v1"). Most episodes are one action."""
from __future__ import annotations

import os
from typing import Any, Callable, Mapping, NoReturn, Optional, Sequence, SupportsFloat, Union

import gymnasium
import numpy
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, read_from_shared_memory

from lgabench.scenes import INDICES, Batch, Environment, Pool, Scenario, SPLITS, refuse_copies

__all__ = ["SceneEnv", "SceneVectorEnv", "dense_reward"]

HALF_AT = {"m": .1, "deg": 15., "px": 50.}  # the distance from right, of one part of success, that halves a dense reward
PRINTABLE = "".join(map(chr, range(32, 127)))
Path = Union[str, os.PathLike[str]]


def dense_reward(success: bool, distance: Mapping[str, float]) -> float:
    """The dense reward: 1 for a success, else within [0, 0.9] and the less the further any part is from right. It is 0.9
    times the product of 1 / (1 + d / h) over the parts d of `distance` (scenes.StepResult), where h is 0.1 m, 15 degrees, 50
    pixels, or 1 for a part without a unit. The form is lgabench's own, and no run uses it."""
    reward = .9
    for part, value in distance.items():
        reward /= 1 + value / HALF_AT.get(part.rpartition("_")[2], 1.)
    return 1. if success else reward


class _Reward:
    """A step's reward: `sparse`, 1 for a success and else 0, or `dense`, dense_reward()."""

    def __init__(self, mode: str, scenario: Scenario) -> None:
        if mode not in ("sparse", "dense"):
            raise ValueError(f"reward_mode {mode!r}: expected sparse or dense")
        if mode == "dense" and (scenario.most_steps > 1 or scenario.may_stop):
            several = "has several steps" if scenario.most_steps > 1 else "may have no step"
            raise ValueError(f"reward_mode 'dense': an episode of {scenario.id} {several}; expected sparse")
        self.is_dense = mode == "dense"

    def __call__(self, success: bool, distance: Mapping[str, float]) -> float:
        return dense_reward(success, distance) if self.is_dense else float(success)


class Instruction(spaces.Text):
    """The command's words. Gymnasium's Text is read from an AsyncVectorEnv's shared memory once, before there are any words."""


_read_text: Callable[..., Any] = read_from_shared_memory.dispatch(spaces.Text)


class _Words:
    """What lies in the memory at the moment, as a tuple has it; the copy that AsyncVectorEnv hands out is that tuple."""

    def __init__(self, space: Instruction, memory: Any, n: int) -> None:
        self._arguments = space, memory, n

    def __deepcopy__(self, memo: Any) -> tuple[str, ...]:
        return tuple(_read_text(*self._arguments))

    def __getitem__(self, at: Any) -> Any:
        return _read_text(*self._arguments)[at]

    def __len__(self) -> int:
        return self._arguments[2]


@read_from_shared_memory.register(Instruction)
def _read_words(space: Instruction, memory: Any, n: int = 1) -> Any:
    return _Words(space, memory, n)


def observation_space(scenario: Scenario) -> spaces.Dict:
    rows, columns = scenario.picture_size
    state = {"state": spaces.Box(numpy.array([one.low for one in scenario.state]), numpy.array([one.high for one in scenario.state]),
                                 dtype=numpy.float64)} if scenario.state else {}
    return spaces.Dict({
        **state,
        "rgb": spaces.Box(0, 255, (rows, columns, 3), numpy.uint8),
        "ids": spaces.Box(0, 255, (rows, columns), numpy.uint8),
        "instances": spaces.Box(-1, 32767, (scenario.most_instances, 4), numpy.int16),
        "instruction": Instruction(256, charset=PRINTABLE + "".join(sorted(set("".join(scenario.commands)) - set(PRINTABLE)))),
    })


def action_space(scenario: Scenario) -> spaces.Box:
    """Where the scenario may_stop there is one number more: above 0 it says that nothing is left to do."""
    return spaces.Box(-1, 1, (len(scenario.action_space.low) + scenario.may_stop,), numpy.float32)


def split_done(scenario: Scenario, actions: Any) -> tuple[Any, Any]:
    """An action's own numbers, and whether nothing is left to do."""
    if not scenario.may_stop:
        return actions, numpy.zeros(numpy.shape(actions)[:-1], bool)
    actions = numpy.asarray(actions)
    return actions[..., :-1], actions[..., -1] > 0


class _Choice:
    """Which scene a reset begins: that of its options, else split train draws one, and dev and test play `seed`, and without one
    go on by `stride`, from `first` (None: from a seed alone). What options name does not move where they go on."""

    def __init__(self, scenario: Scenario, split: str, arm: Optional[str], scene_seed: int, first: Optional[int], stride: int
                 ) -> None:
        if stride < 1:
            raise ValueError(f"stride {stride}: expected 1 or more")
        if split not in SPLITS:
            raise ValueError(f"split {split!r}: expected train, dev or test")
        if arm is not None and arm not in scenario.arms:
            raise ValueError(f"arm {arm!r}: expected one of {', '.join(scenario.arms)}")
        self.usual = {"split": split, "arm": arm or scenario.arms[0], "scene_seed": scene_seed}
        self.next, self.stride, self._arms = first, stride, scenario.arms

    def __call__(self, seed: Optional[int], options: Optional[dict[str, Any]], random: numpy.random.Generator
                 ) -> tuple[str, str, int, int]:
        chosen = {**self.usual, **(options or {})}
        if unknown := set(chosen) - {*self.usual, "index"}:
            raise ValueError(f"options {sorted(unknown)}: expected split, arm, index, scene_seed")
        if chosen["split"] not in SPLITS or chosen["arm"] not in self._arms:
            raise ValueError(f"options: expected a split of {', '.join(SPLITS)} and an arm of {', '.join(self._arms)}, got "
                             f"{chosen['split']!r}, {chosen['arm']!r}")
        index = chosen.get("index")
        for name in "index", "scene_seed":
            if chosen.get(name) is not None and not isinstance(chosen[name], (int, numpy.integer)):
                raise ValueError(f"options: {name}: expected a whole number, got {chosen[name]!r}")
        if index is None and chosen["split"] == "train":
            index = random.integers(INDICES - 1)
        elif index is None:
            index = self.next if seed is None else seed
            if index is None:
                raise ValueError(f"reset: expected a seed: with stride {self.stride} environment i of several begins at seed + i")
            if index >= INDICES:
                raise ValueError(f"seed {index}: expected 0 to {INDICES - 1}, as split {chosen['split']} has a scene for each")
            self.next = int(index) + self.stride
        return chosen["split"], chosen["arm"], int(chosen["scene_seed"]), int(index)


def _ended(scenario: Scenario, terminated: Any, truncated: Any) -> tuple[Any, Any]:
    """One action ends an episode, whatever became of it; several are cut off where a limit was reached."""
    return (terminated | True, truncated & False) if scenario.most_steps == 1 else (terminated, truncated)


def _with_done(scenario: Scenario, actions: Any) -> numpy.typing.NDArray[numpy.float32]:
    """The oracle's rows of numbers as an action_space() has them; a row without numbers says that nothing is left to do."""
    if not scenario.may_stop:
        return scenario.action_space.from_metres(actions)
    done = numpy.isnan(actions).any(-1) if actions.shape[-1] else numpy.ones(len(actions), bool)
    rows = numpy.zeros((len(actions), len(scenario.action_space.low) + 1), numpy.float32)
    rows[:, -1] = numpy.where(done, 1, -1)
    if not done.all():
        rows[~done, :-1] = scenario.action_space.from_metres(actions[~done])
    return rows


class SceneEnv(gymnasium.Env[dict[str, Any], numpy.typing.NDArray[numpy.float32]]):
    """One scenario, by its id or a file of your own (`path`). Actions are within [-1, 1]; `to_metres` says what they mean.
    Without a seed, reset() goes on by `stride` test scenes: n environments side by side play each once with a stride of n."""
    metadata = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(self, scenario: Union[str, Scenario, None] = None, *, path: Optional[Path] = None, split: str = "train",
                 engine: Optional[str] = None, layout: Optional[str] = None, arm: Optional[str] = None, scene_seed: int = 0,
                 reward_mode: str = "sparse", render_mode: Optional[str] = None, stride: int = 1) -> None:
        self.scenario = scenario if isinstance(scenario, Scenario) else Scenario(scenario, path=path)
        self._reward = _Reward(reward_mode, self.scenario)
        self.environment = Environment(self.scenario, engine, layout)
        self.render_mode = render_mode
        self.object_types, self.textures = self.scenario.space.object_types, self.scenario.space.textures
        self.to_metres, self.from_metres = self.scenario.action_space.to_metres, self.scenario.action_space.from_metres
        self.observation_space = observation_space(self.scenario)
        self.action_space = action_space(self.scenario)
        self.task = self.task_description = self.scenario.commands[0]
        self._max_episode_steps = self.scenario.most_steps
        self._choice = _Choice(self.scenario, split, arm, scene_seed, 0 if stride == 1 else None, stride)
        self._picture: Optional[numpy.typing.NDArray[numpy.uint8]] = None
        self._ready = False

    def reset(self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
              ) -> tuple[dict[str, Any], dict[str, Any]]:
        super().reset(seed=seed)
        self._ready = False
        split, arm, scene_seed, index = self._choice(seed, options, self.np_random)
        seen = self.environment.reset(split, index, arm=arm, seed=scene_seed)
        self._ready = True
        self.task = self.task_description = self.environment.utterance
        return self._seen(seen), {"scene": self.environment.scene_hash}

    def step(self, action: numpy.typing.NDArray[numpy.float32]
             ) -> tuple[dict[str, Any], SupportsFloat, bool, bool, dict[str, Any]]:
        if not self._ready:
            why = "an episode is one action" if self.scenario.most_steps == 1 else "the episode is over"
            raise RuntimeError(f"step: expected a reset() before it; {why}")
        own, done = split_done(self.scenario, action)
        metres = self.to_metres(own)
        self._ready = False
        result = self.environment.step([] if done else metres)
        terminated, truncated = _ended(self.scenario, result.terminated, result.truncated)
        self._ready = not terminated and not truncated
        return (self._seen(result.observation), self._reward(result.success, result.distance), bool(terminated), bool(truncated),
                {"is_success": result.success, "failure": result.failure, "distance": result.distance})

    def expert_action(self) -> numpy.typing.NDArray[numpy.float32]:
        """The oracle's action, within [-1, 1]."""
        first: numpy.typing.NDArray[numpy.float32] = _with_done(self.scenario, self.environment.expert_action()[None])[0]
        return first

    def render(self) -> Any:
        return None if self.render_mode is None or self._picture is None else self._picture.copy()

    def close(self) -> None:
        self.environment.close()

    def _seen(self, seen: Any) -> dict[str, Any]:
        self._picture = seen.rgb
        state = {"state": seen.state} if self.scenario.state else {}
        return {**state, "rgb": seen.rgb, "ids": seen.ids, "instances": self.environment.instance_rows, "instruction": self.task}

    def __reduce__(self) -> NoReturn:
        refuse_copies()


class SceneVectorEnv(VectorEnv[dict[str, Any], Any, Any]):
    """`num_envs` of a scenario on C++ threads: gymnasium.make_vec("lgabench/heart-v1", 8, threads=2). Environment i equals a
    SceneEnv with seed + i and a stride of num_envs. Where an episode is one action, each step() ends all, and SAME_STEP begins
    the next ones at once. Episodes of several steps end at other times; NEXT_STEP begins the next one in the step after."""
    metadata = {"render_modes": ["rgb_array"], "render_fps": 1, "autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, scenario: Union[str, Scenario, None] = None, num_envs: int = 1, *, path: Optional[Path] = None,
                 split: str = "train", engine: Optional[str] = None, layout: Optional[str] = None, arm: Optional[str] = None,
                 scene_seed: int = 0, threads: Optional[int] = None,
                 autoreset_mode: Union[AutoresetMode, str] = AutoresetMode.SAME_STEP, reward_mode: str = "sparse",
                 render_mode: Optional[str] = None) -> None:
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.scenario = scenario if isinstance(scenario, Scenario) else Scenario(scenario, path=path)
        self._reward = _Reward(reward_mode, self.scenario)
        if self.autoreset_mode == AutoresetMode.NEXT_STEP and self.scenario.most_steps == 1:
            raise ValueError("autoreset_mode NextStep: an episode is one action, so every second step() would play nothing; "
                             "expected SameStep or Disabled")
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
        self.num_envs, self.render_mode = num_envs, render_mode
        self.pool = Pool(self.scenario, num_envs, threads, engine, layout)
        self.to_metres, self.from_metres = self.scenario.action_space.to_metres, self.scenario.action_space.from_metres
        self.single_observation_space = observation_space(self.scenario)
        self.single_action_space = action_space(self.scenario)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._choices = [_Choice(self.scenario, split, arm, scene_seed, i, num_envs) for i in range(num_envs)]
        self._randoms: dict[int, numpy.random.Generator] = {}
        self._ready = numpy.zeros(num_envs, bool)
        self._batch: Optional[Batch] = None
        self._utterances: list[str] = []

    def reset(self, *, seed: Union[int, Sequence[Optional[int]], None] = None, options: Optional[dict[str, Any]] = None
              ) -> tuple[dict[str, Any], dict[str, Any]]:
        seeds = ([None] * self.num_envs if seed is None else
                 [int(seed) + i for i in range(self.num_envs)] if isinstance(seed, (int, numpy.integer)) else list(seed))
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: expected {self.num_envs}, got {len(seeds)}")
        options = dict(options or {})
        mask = numpy.asarray(options.pop("reset_mask", numpy.ones(self.num_envs, bool)))
        if mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise ValueError(f"reset_mask: expected {self.num_envs} truth values, one or more of them true")
        if not mask.all() and self._batch is None:
            raise RuntimeError("reset_mask: expected a reset() of all environments before it")
        infos = self._begin([int(i) for i in numpy.flatnonzero(mask)], seeds, self._of_each(options))
        return self._observations(), infos

    def step(self, actions: Any) -> tuple[dict[str, Any], Any, Any, Any, dict[str, Any]]:
        begins = ~self._ready & (self.autoreset_mode == AutoresetMode.NEXT_STEP and self._batch is not None)
        if not (self._ready | begins).all():
            late = numpy.flatnonzero(~self._ready).tolist()
            raise RuntimeError(f"step: expected a reset() of environments {late} before it")
        plays = [int(i) for i in numpy.flatnonzero(~begins)]
        own, done = split_done(self.scenario, actions)
        metres = self.to_metres(own)
        self._ready[plays] = False
        utterances = self._utterances
        rewards = numpy.zeros(self.num_envs)
        terminated, truncated = numpy.zeros(self.num_envs, bool), numpy.zeros(self.num_envs, bool)
        finals: dict[int, dict[str, Any]] = {}
        if plays:
            batch, success, failures, distances = self.pool.step(metres[plays], plays, done=[bool(done[i]) for i in plays])
            terminated[plays], truncated[plays] = _ended(self.scenario, self.pool.terminated, self.pool.truncated)
            self._put(batch, plays)
            for row, i in enumerate(plays):
                rewards[i] = self._reward(bool(success[row]), distances[row])
                finals[i] = {"is_success": bool(success[row]), "failure": failures[row], "distance": distances[row]}
        over = terminated | truncated
        self._ready[plays] = ~over[plays]
        infos: dict[str, Any] = {}
        same_step = self.autoreset_mode == AutoresetMode.SAME_STEP
        for i, final in finals.items():
            if same_step and over[i]:
                last = {name: array[i] for name, array in self._arrays().items()}
                last["instruction"] = utterances[i]
                infos = self._add_info(infos, {"final_obs": last, "final_info": final}, i)
            elif not same_step:
                infos = self._add_info(infos, final, i)
        if again := [int(i) for i in numpy.flatnonzero(over if same_step else begins)]:
            infos.update(self._begin(again, [None] * self.num_envs, [{}] * self.num_envs))
        return self._observations(), rewards, terminated, truncated, infos

    def expert_actions(self) -> numpy.typing.NDArray[numpy.float32]:
        """The oracle's actions, a row for each environment."""
        return _with_done(self.scenario, self.pool.expert_actions())

    def render(self) -> Any:
        return None if self.render_mode is None or self._batch is None else tuple(self._batch.rgb.copy())

    def __reduce__(self) -> NoReturn:
        refuse_copies()

    def close_extras(self, **kwargs: Any) -> None:
        self.__dict__.pop("pool", None)  # there is none where the constructor failed

    def _of_each(self, options: dict[str, Any]) -> list[dict[str, Any]]:
        """The options of each environment: a list has a value for each of them."""
        each: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for name, value in options.items():
            is_list = isinstance(value, (list, tuple, numpy.ndarray))
            if is_list and name == "split":
                raise ValueError("options split: expected one for all environments")
            if is_list and len(value) != self.num_envs:
                raise ValueError(f"options {name}: expected one value, or {self.num_envs}, one for each environment, got "
                                 f"{len(value)}")
            for i, one in enumerate(each):
                one[name] = value[i] if is_list else value
        return each

    def _begin(self, at: list[int], seeds: Sequence[Optional[int]], options: list[dict[str, Any]]) -> dict[str, Any]:
        for i in at:
            if seeds[i] is not None or i not in self._randoms:
                self._randoms[i] = seeding.np_random(seeds[i])[0]
        self._ready[at] = False
        chosen = [self._choices[i](seeds[i], options[i], self._randoms[i]) for i in at]
        batch = self.pool.reset(chosen[0][0], [one[3] for one in chosen], arms=[one[1] for one in chosen],
                                seeds=[one[2] for one in chosen], at=at)
        self._put(batch, at)
        self._ready[at] = True
        self._utterances, hashes = self.pool.utterances, self.pool.scene_hashes
        infos: dict[str, Any] = {}
        for i in at:
            infos = self._add_info(infos, {"scene": hashes[i]}, i)
        return infos

    def _put(self, batch: Batch, at: list[int]) -> None:
        """Makes these the rows `at` of what is seen; arrays that were handed out stay as they are."""
        if len(at) < self.num_envs and self._batch is not None:
            kept = {name: array.copy() for name, array in self._batch._asdict().items()}
            for name, rows in batch._asdict().items():
                kept[name][at] = rows
            batch = Batch(**kept)
        self._batch = batch

    def _arrays(self) -> dict[str, Any]:
        assert self._batch is not None
        arrays = self._batch._asdict()
        return arrays if self.scenario.state else {name: array for name, array in arrays.items() if name != "state"}

    def _observations(self) -> dict[str, Any]:
        return {**self._arrays(), "instruction": tuple(self._utterances)}
