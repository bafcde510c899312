"""Runs as data frames (pandas), demonstrations as a method gets them (h5py)."""
from __future__ import annotations

import hashlib
import json
import os
import pathlib
import re
import stat
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Sequence, Union

import numpy
import numpy.typing

from lgabench.scenes import ActionSpace
import lgabench_method
from lgabench_method import Demonstration, Instance, Instruction, Observation, Selection, Step
from lgabench_method.values import named, selection

if TYPE_CHECKING:
    import pandas

__all__ = ["Demonstrations", "Run", "goal_mask", "load_demonstrations", "load_run"]

Path = Union[str, os.PathLike[str]]


@dataclass(frozen=True)
class Run:
    """A run's results. Each frame has the index `cell`, a cell's key, and keeps columns that docs/formats does not list."""
    run: dict[str, Any]  # run.json
    cells: pandas.DataFrame  # a row per finished cell: its setting, and the quality of its Selections
    episodes: pandas.DataFrame  # the columns of episodes.csv, and `action`
    training: pandas.DataFrame  # a row per epoch
    timing: pandas.DataFrame
    failed: dict[str, str] = field(default_factory=dict)  # cell -> why it has no result


def _read(path: pathlib.Path) -> bytes:
    descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise ValueError(f"{path}: expected a regular file")
        return file.read()


def _lines(data: bytes) -> Iterator[dict[str, Any]]:
    return map(json.loads, data.splitlines())


def load_run(directory: Path, verify: bool = True) -> Run:
    """Reads a run's directory. With `verify`, each file's SHA-256 is compared with the cell's status.json. Warns where a cell has no
    result: means over the frames then lack it. ValueError names a file that is not as it was written, or the run that has one;
    OSError one that cannot be read. A symbolic link is refused."""
    try:
        return _run_at(pathlib.Path(directory), verify)
    except (AttributeError, IndexError, KeyError, RecursionError, TypeError, UnicodeDecodeError, json.JSONDecodeError) as e:
        raise ValueError(f"{os.fspath(directory)}: not a run as lgabench writes it: {type(e).__name__}: {e}") from e


def _run_at(root: pathlib.Path, verify: bool) -> Run:
    import pandas

    run = json.loads(_read(root / "run.json"))
    if run["version"].startswith(("0.1.", "0.2.")):
        raise ValueError(f"{root / 'run.json'}: written by lgabench {run['version']}, whose runs this version cannot read")
    cells: list[dict[str, Any]] = []
    episodes: list[dict[str, Any]] = []
    training: list[dict[str, Any]] = []
    timing: list[dict[str, Any]] = []
    failed: dict[str, str] = {}
    for key in run["cells"]:
        if not re.fullmatch("[0-9a-f]{16}", key):
            raise ValueError(f"{root / 'run.json'}: /cells: expected keys of 16 digits, got {key!r}")
        folder = root / "cells" / key
        if not (folder / "status.json").exists():
            failed[key] = "not played yet"
            continue
        if (root / "cells").is_symlink() or folder.is_symlink():
            raise ValueError(f"{folder}: a symbolic link, which a run may not hold")
        status = json.loads(_read(folder / "status.json"))
        if status["state"] != "ok":
            failed[key] = str(status.get("reason", status["state"]))
            continue
        files = {name: _read(folder / name)
                 for name in ("cell.json", "selection.json", "training.jsonl", "episodes.jsonl", "timing.json")}
        for name, data in files.items():
            if verify and hashlib.sha256(data).hexdigest() != status["files"].get(name):
                raise ValueError(f"{folder / name}: changed since it was written: its SHA-256 is not that in status.json")
        cell = json.loads(files["cell.json"])
        setting = _setting(key, cell)
        selected = json.loads(files["selection.json"])["commands"]
        cells.append({**setting, "options": cell["method"].get("options", {}),
                      "selection": [one["selection"] for one in selected], "quality": [one["quality"] for one in selected]})
        commands = [one["utterance"] for one in cell["scenario"]["commands"]]
        episodes += [{**setting, **one, "command": commands[one["command"]]} for one in _lines(files["episodes.jsonl"])]
        training += [{"cell": key, **one} for one in _lines(files["training.jsonl"])]
        timing.append({"cell": key, **json.loads(files["timing.json"])})

    if failed:
        warnings.warn(f"{root}: {len(failed)} of {len(run['cells'])} cells have no result (Run.failed says why)", stacklevel=2)

    def frame(rows: list[dict[str, Any]]) -> pandas.DataFrame:
        return pandas.DataFrame(rows, columns=None if rows else ["cell"]).set_index("cell")

    return Run(run, frame(cells), frame(episodes), frame(training), frame(timing), failed)


def _setting(key: str, cell: Mapping[str, Any]) -> dict[str, Any]:
    method = cell["method"]
    return {"cell": key, "scenario": cell["scenario"]["id"], "layout": cell["layout"], "engine": cell["engine"],
            "method": method["name"], "method_kind": method["kind"], "demonstrations": cell["demonstrations"],
            "training_seed": cell["training_seed"], "participant": cell.get("participant", "")}


class Demonstrations(list[Demonstration]):
    """A list of demonstrations, and where they come from as the file says: "" or None in files of versions before 0.3."""
    scenario: str = ""
    layout: str = ""
    split: str = ""
    seed: Union[int, None] = None
    action_space: Union[ActionSpace, None] = None

    @property
    def may_stop(self) -> bool:
        """Whether a step says that nothing is left to do."""
        return any(not len(step.label) for one in self for step in (*one.steps, *one.recovery))

    def actions(self, steps: Sequence[Step]) -> numpy.typing.NDArray[numpy.float32]:
        """Labels as the Gymnasium environment takes them, a row for each step: within [-1, 1], and with `may_stop` one number
        more, which is 1 where nothing is left to do and else -1. A file of versions before 0.3 has no action space: ValueError."""
        if self.action_space is None:
            raise ValueError("actions: the file names no action space: it is of a version before 0.3")
        own = len(self.action_space.names)
        rows = numpy.zeros((len(steps), own + self.may_stop), numpy.float32)
        for row, step in zip(rows, steps):
            if len(step.label):
                row[:own] = self.action_space.from_metres(step.label)
            row[own:] = -1 if len(step.label) else 1
        return rows


def load_demonstrations(file: Path) -> Demonstrations:
    """Reads a file of `lgabench demos`, recovery steps included. Instructions hold the true Selection, or that of
    `demos --selection`; in files of versions before 0.4 they hold no Selection."""
    import h5py

    all_of_them = Demonstrations()
    with h5py.File(file, "r") as opened:
        data = opened["data"]
        for name in ("scenario", "layout", "split"):
            setattr(all_of_them, name, _text(data.attrs.get(name, "")))
        if "action_names" in data.attrs:
            names = tuple(json.loads(_text(data.attrs["action_names"])))
            rotations = tuple(map(tuple, json.loads(_text(data.attrs["action_rotations"]))))
            all_of_them.action_space = ActionSpace(names, tuple(json.loads(_text(data.attrs["action_units"]))),
                                                   data.attrs["action_low"], data.attrs["action_high"], rotations)
            all_of_them.seed = int(data.attrs["seed"])
        for number in range(len(data)):
            one = data[f"demo_{number}"]
            tables = json.loads(one["instances"][()].tobytes())
            rgb, ids, actions = one["obs/rgb"][()], one["obs/ids"][()], one["actions"][()].astype(numpy.float64)
            state = one["obs/state"][()] if "obs/state" in one else numpy.zeros((len(tables), 0))
            stops = one["stops"][()] if "stops" in one else numpy.zeros(len(tables), bool)
            brought = json.loads(one["brought"][()].tobytes()) if "brought" in one else [[]] * len(tables)
            steps = [Step(Observation(rgb[t], ids[t], [Instance(row["id"], row["object_type"], row["texture"], row["pixels"])
                                                       for row in table], None, state[t], named(brought[t])),
                          numpy.zeros(0) if stops[t] else actions[t]) for t, table in enumerate(tables)]
            own = int(one.attrs.get("trajectory_steps", 1))
            meant = selection(json.loads(one["selection"][()].tobytes())) if "selection" in one else Selection()
            all_of_them.append(Demonstration(Instruction(_text(one.attrs["utterance"]), meant), steps[:own], steps[own:]))
    return all_of_them


def goal_mask(observation: Observation, selection: Selection) -> lgabench_method.Bytes:
    """The goal mask (paper, section 3.1), rows x columns of 0 and 1. Warns of an empty Selection, whose mask is all 0."""
    if selection.second is None and not any(one.object_types and one.textures for one in selection.meaning.sets):
        warnings.warn("goal_mask: the Selection is empty, so that the mask is 0 everywhere", stacklevel=2)
    return lgabench_method.goal_mask(observation, selection)


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
