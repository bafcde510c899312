"""What a method is given, without a run: for unit tests and notebooks. This module needs the package lgabench.

    from lgabench_method import testing

    services = testing.services(MyMethod, "heart", steps=10)
    policy = MyMethod().learn(testing.demonstrations("heart", 5), services)
    print(testing.try_out(MyMethod, "heart"))

The language model answers with the truth, training targets are drawn from the truth, and no process is confined: what this module
measures is no row of a table.
"""
from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Sequence
from typing import Any, Optional, Union

import lgabench
from lgabench.scenes import as_scenario
from lgabench_method import (Command, Demonstration, FeatureSpace, Hypothesis, Instruction, Meaning, Method, Needs, Observation, Question,
                             Refused, Selection, Services, Step)

Scenario = Union[str, lgabench.Scenario]


class TrueAnswers:
    """A language model that knows what the scenario's author means; `asked` counts its questions."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = as_scenario(scenario)
        self.asked = 0

    def answer(self, command: Command, space: FeatureSpace, questions: Sequence[Question]) -> list[bool]:
        """A yes or no for each question, from the truth."""
        truth = self.scenario.truth(self.scenario.commands.index(command.utterance))
        self.asked += len(questions)
        answers = []
        for about, group, candidate in questions:
            sets = truth.meaning.sets if about == "target" or truth.second is None else [truth.second]
            answers.append(any(candidate in (one.object_types if group == "object_type" else one.textures) for one in sets))
        return answers

    def mean(self, command: Command, space: FeatureSpace) -> Meaning:
        """The truth."""
        self.asked += 1
        return self.scenario.truth(self.scenario.commands.index(command.utterance)).meaning

    def hypotheses(self, command: Command, space: FeatureSpace) -> list[Hypothesis]:
        """None."""
        return []


class NoPeople:
    """Nobody is asked: every call raises Refused."""

    def specify(self, command: Command) -> Selection:
        """Raises Refused."""
        raise Refused("no person is asked in a test")

    def edit(self, command: Command, proposal: Selection) -> Selection:
        """Raises Refused."""
        raise Refused("no person is asked in a test")

    def accepts(self, command: Command, object_type: str, texture: str) -> bool:
        """Raises Refused."""
        raise Refused("no person is asked in a test")

    def scene(self, command: Command, scene: int) -> list[dict[str, Any]]:
        """Raises Refused."""
        raise Refused("no person is asked in a test")

    def takes(self, command: Command, scene: int, instance: int) -> bool:
        """Raises Refused."""
        raise Refused("no person is asked in a test")

    def which(self, command: Command, scene: int) -> Optional[int]:
        """Raises Refused."""
        raise Refused("no person is asked in a test")


class Curves:
    """Keeps what is logged: `epochs` has (epochs, steps, loss, curves), a tuple for each pass."""

    def __init__(self) -> None:
        self.epochs: list[tuple[int, int, float, dict[str, float]]] = []

    def epoch(self, epochs: int, steps: int, loss: float, **curves: float) -> None:
        """As the log of a cell takes it."""
        self.epochs.append((epochs, steps, loss, curves))


def _instruction(environment: lgabench.Environment) -> Instruction:
    scenario = environment.scenario
    command = scenario.commands.index(environment.utterance)
    return Instruction(environment.utterance, scenario.truth(command))


def demonstrations(scenario: Scenario = "heart", count: int = 5, *, engine: Optional[str] = None, seed: int = 0,
                   shadows: bool = False) -> list[Demonstration]:
    """The oracle's first `count` episodes of a training seed, with the true Selections. `shadows`: as Needs has it."""
    with lgabench.Environment(scenario, engine, shadows=shadows) as environment:
        all_of_them = []
        for index in range(count):
            steps = [Step(environment.reset("train", index, seed=seed), environment.expert_action())]
            while environment.scenario.most_steps > 1:
                result = environment.step(steps[-1].label)
                if result.terminated or result.truncated:
                    break
                steps.append(Step(result.observation, environment.expert_action()))
            all_of_them.append(Demonstration(_instruction(environment), steps))
        return all_of_them


def observations(scenario: Scenario = "heart", count: int = 5, *, engine: Optional[str] = None, seed: int = 0) -> list[Observation]:
    """The first `count` test scenes."""
    with lgabench.Environment(scenario, engine) as environment:
        return [environment.reset("test", index, seed=seed) for index in range(count)]


def services(kind: Callable[[], Method], scenario: Scenario = "heart", *, seed: int = 0, **options: Any) -> Services:
    """Services with the options' defaults, and `options` in place of some. `files` is a new directory below the temporary one."""
    declared: dict[str, dict[str, Any]] = getattr(kind, "options", {})
    if unknown := set(options) - set(declared):
        raise ValueError(f"options: unknown {', '.join(sorted(unknown))}, expected among: {', '.join(declared) or 'none'}")
    space = as_scenario(scenario)
    rows, columns = space.picture_size
    layout = {"observation": {"rows": rows, "columns": columns, "channels": 3}, "action": json.loads(space._core.action_space_json),
              "may_stop": space.may_stop}
    if space.state:
        layout["observation"]["state"] = json.loads(space._core.state_json)
    values = {name: one["default"] for name, one in declared.items()} | options
    return Services(TrueAnswers(space), NoPeople(), values, seed, Curves(), tempfile.mkdtemp(prefix="lgabench-files-"), layout)


def try_out(kind: Callable[[], Method], scenario: Scenario = "heart", count: int = 10, episodes: int = 20, *, engine: Optional[str] = None,
            seed: int = 0, **options: Any) -> lgabench.Result:
    """Calls a method as a cell does (select, revise, learn, act) on `count` demonstrations, and plays the first test scenes."""
    space, method = as_scenario(scenario), kind()
    lent = services(kind, space, seed=seed, **options)
    commands = {words: space.command(index) for index, words in enumerate(space.commands)}
    selections = {words: method.select(command, space.space, lent) for words, command in commands.items()}
    needs = method.needs(lent.options) if hasattr(method, "needs") else Needs()
    episodes_shown = demonstrations(space, count, engine=engine, seed=seed, shadows=needs.shadows)

    def shown() -> list[Demonstration]:
        return [Demonstration(Instruction(one.instruction.utterance, selections[one.instruction.utterance]), one.steps)
                for one in episodes_shown]

    if revise := getattr(method, "revise", None):
        lent.shows_truth = True
        selections = {words: revise(command, selections[words], shown(), lent) for words, command in commands.items()}
    policy = method.learn(shown(), lent)
    if not os.listdir(lent.files):
        os.rmdir(lent.files)
    with lgabench.Environment(space, engine, shadows=needs.shadows) as environment:
        return lgabench.evaluate(lambda seen, words: policy.act(seen, Instruction(words, selections[words])), environment, episodes,
                                 reset=getattr(policy, "reset", None))
