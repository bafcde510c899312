"""A policy that a run kept (`lgabench run --keep-policy`), to act with."""
from __future__ import annotations

import json
import os
import pathlib
import signal
import subprocess
import sys
from types import TracebackType
from typing import Any, Optional, Sequence, Union

import numpy
import numpy.typing

from lgabench_method import Observation, Selection, installed
from lgabench_method import values as _values

Path = Union[str, os.PathLike[str]]
PROGRAM = pathlib.Path(__file__).with_name("_install") / "bin" / "lgabench-worker"


def ending(status: int) -> str:
    """How a process ended, of whose exit status subprocess says this."""
    return f"signal {-status} ({signal.strsignal(-status)})" if status < 0 else f"exit status {status}"


class Policy:
    """What a cell learned. The policy acts in a confined process of its own, which also opens its file. One thread. close() or
    `with` ends the process; if it ended by itself, a call raises RuntimeError."""

    def __init__(self, process: subprocess.Popen[bytes], instructions: dict[str, Selection], scenario: str) -> None:
        self.scenario = scenario
        self.selections = instructions  # utterance -> its Selection
        self._process: Optional[subprocess.Popen[bytes]] = process
        self._size: tuple[int, int] = (0, 0)

    def act(self, observation: Observation, utterance: Optional[str] = None,
            selection: Optional[Selection] = None, *, begins: bool = True) -> numpy.typing.NDArray[numpy.float64]:
        """The action for a command of the cell (the first if None), with its Selection or with `selection`. In tasks of several
        steps `begins` says whether an episode begins."""
        utterance = next(iter(self.selections)) if utterance is None else utterance
        chosen = self.selections.get(utterance) if selection is None else selection
        if chosen is None:
            raise ValueError(f"utterance {utterance!r}: expected a command of the cell, or a selection")
        if observation.ids.shape != self._size or observation.rgb.shape != (*self._size, 3):
            raise ValueError(f"observation: expected {self._size[0]} x {self._size[1]} pixels, got {observation.rgb.shape}")
        told = {**_values.selection_json(chosen, "selection:"), "provenance": chosen.provenance, "source": chosen.source,
                "asked_as": chosen.asked_as}
        request = {"instruction": {"utterance": utterance, "selection": told},
                   "instances": [vars(one) for one in observation.instances], "reset": begins}
        if len(observation.state):
            request["state"] = [float(one) for one in observation.state]
        if observation.brought:
            request["brought"] = [{"object_type": object_type, "texture": texture} for object_type, texture in observation.brought]
        pixels = [numpy.ascontiguousarray(array, numpy.uint8).tobytes() for array in (observation.rgb, observation.ids)]
        return numpy.array(self._ask(json.dumps(request).encode() + b"\n" + b"".join(pixels))["action"])

    def _ask(self, request: bytes) -> dict[str, Any]:
        if self._process is None:
            raise RuntimeError("policy: closed")
        assert self._process.stdin and self._process.stdout
        try:
            self._process.stdin.write(request)
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = b""
        answer: dict[str, Any] = json.loads(line) if line else {"fatal": ""}
        if "fatal" in answer:
            process = self._process
            self.close()
            raise RuntimeError(answer["fatal"] or f"the policy's process ended: {ending(process.returncode)}")
        if "error" in answer:
            raise ValueError(answer["error"])
        return answer

    def close(self) -> None:
        """Ends the process; every later act() raises RuntimeError."""
        if self._process is not None:
            self._process.communicate()
            self._process = None

    def __enter__(self) -> Policy:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()


def load_policy(cell: Path, method: str = "", *, plugin_path: Sequence[Path] = (), python: str = sys.executable) -> Policy:
    """The policy that is kept in a cell's directory, RUN/cells/KEY. `method` is FILE.py:Class of a method in Python, which
    `python` runs. RuntimeError with the file's name, in one line, if the file is missing or damaged."""
    folder = pathlib.Path(cell)
    recorded = json.loads((folder / "cell.json").read_text())
    commands = json.loads((folder / "selection.json").read_text())["commands"]
    paths = [*(os.fspath(one) for one in plugin_path), *(installed.folders() if python == sys.executable else [])]
    job = {"cell": str(folder), "method": method, "python": python, "plugin_path": paths}
    process = subprocess.Popen([PROGRAM, "act"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    selections = {one["utterance"]: _values.selection({name: value for name, value in one["selection"].items()
                                                       if name != "cost"}) for one in commands}
    policy = Policy(process, selections, recorded["scenario"]["id"])
    answer = policy._ask(json.dumps(job).encode() + b"\n")
    policy._size = answer["rows"], answer["columns"]
    return policy
