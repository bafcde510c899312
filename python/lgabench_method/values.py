"""What frames and shared memory hold, as Python values and back."""
import mmap
import os
from collections.abc import Mapping
from typing import Any

import numpy

from lgabench_method import (Command, Demonstration, FeatureSet, FeatureSpace, Hypothesis, Instance, Instruction, Meaning, Needs,
                             Observation, SecondRole, SecondSet, Selection, Shown, Step, Turn, Which)


def command(json):
    second = json.get("second")
    return Command(json["utterance"], json["task"], SecondRole(second["id"], second["phrase"]) if second else None,
                   json.get("may_stop", False))


def command_json(value):
    json = {"utterance": value.utterance, "task": value.task}
    if value.second is not None:
        json["second"] = {"id": value.second.id, "phrase": value.second.phrase}
    return json


def space(json):
    return FeatureSpace(json["id"], json["object_types"], json["textures"])


def space_json(value):
    return {"id": value.id, "object_types": list(value.object_types), "textures": list(value.textures)}


def _set(json):
    return FeatureSet(list(json["object_types"]), list(json["textures"]))


def _set_json(value: FeatureSet) -> dict[str, list[str]]:
    return {"object_types": [str(name) for name in value.object_types], "textures": [str(name) for name in value.textures]}


def _turn(json):
    return Turn([_set(one) for one in json["sets"]], None if json["take"] == "all" else json["take"], list(json.get("same", [])),
                list(json.get("different", [])), json.get("only_if_nothing", False))


def _turn_json(value):
    json = {"sets": [_set_json(one) for one in value.sets], "take": "all" if value.take is None else int(value.take)}
    for name in ("same", "different"):
        if getattr(value, name):
            json[name] = [str(part) for part in getattr(value, name)]
    if value.only_if_nothing:
        json["only_if_nothing"] = True
    return json


def meaning(json):
    if "turns" in json:
        return Meaning.in_turns([_turn(one) for one in json["turns"]])
    if "sets" not in json:
        return Meaning([_set(json)])
    which = json.get("which")
    return Meaning([_set(one) for one in json["sets"]],
                   which and Which(which["rule"], _set(which["of"]) if "of" in which else None, list(which.get("order", []))))


def hypotheses(json):
    return [Hypothesis(one["text"], meaning(one["meaning"]), one.get("weight", 1)) for one in json]


def _meaning_json(value):
    if value.turns:
        return {"turns": [_turn_json(one) for one in value.turns]}
    if len(value.sets) == 1 and value.which is None:
        return _set_json(value.sets[0])
    json = {"sets": [_set_json(one) for one in value.sets]}
    if value.which is not None:
        json["which"] = {"rule": value.which.rule}
        if value.which.of is not None:
            json["which"]["of"] = _set_json(value.which.of)
        if value.which.order:
            json["which"]["order"] = [str(name) for name in value.which.order]
    return json


SELECTION = ("target", "provenance", "source", "asked_as")  # its members beside the second set, which is named by its role


def selection(json: Mapping[str, Any]) -> Selection:
    roles = [name for name in json if name not in SELECTION]
    second = json[roles[0]] if roles else None
    return Selection(None,
                     SecondSet(list(second["object_types"]), list(second["textures"]), roles[0]) if roles else None,
                     json.get("provenance", "none"), json.get("source", ""), json.get("asked_as", ""), meaning=meaning(json["target"]))


def selection_json(value: Selection, what: str) -> dict[str, Any]:
    if not isinstance(value, Selection):
        raise TypeError(f"{what} {type(value).__name__}, expected a lgabench_method.Selection")
    json: dict[str, Any] = {"target": _meaning_json(value.meaning)}
    if value.second is not None:
        if value.second.role in ("", *SELECTION):
            raise ValueError(f"the second set has the role \"{value.second.role}\", expected the id of command.second")
        json[value.second.role] = _set_json(value.second)
    return json


def instruction(json):
    return Instruction(json["utterance"], selection(json["selection"]))


def needs_json(value):
    if not isinstance(value, Needs):
        raise TypeError(f"needs() returned {type(value).__name__}, expected a lgabench_method.Needs")
    return {"targets": value.targets, "noisy_per_clean": int(value.noisy_per_clean), "noise_max": float(value.noise_max),
            "shadows": bool(value.shadows)}


MASK_COLOURS = numpy.array([[205, 60, 50], [32, 32, 32], [245, 245, 245]], numpy.uint8)  # of -1, 0 and 1


def _colours(name, array):
    array = numpy.asarray(array)
    if array.ndim == 2 and array.dtype.kind in "biuf":
        return MASK_COLOURS[numpy.sign(array.astype(float)).astype(int) + 1]
    if array.ndim == 3 and array.shape[2] == 3 and array.dtype.kind in "uif":
        return array if array.dtype == numpy.uint8 else numpy.rint(255 * numpy.clip(array, 0, 1)).astype(numpy.uint8)
    raise ValueError(f"shown(): {name}: an array of shape {array.shape} and type {array.dtype}, expected rows x columns, "
                     "or rows x columns x 3")


def shown_frame(value):
    """The reply's header and its payload."""
    if not isinstance(value, Shown):
        raise TypeError(f"shown() returned {type(value).__name__}, expected a lgabench_method.Shown")
    header = {"type": "shown", "pictures": [], "texts": list(map(str, value.texts)), "unread": list(map(str, value.unread))}
    payload = b""
    for name, array, *note in value.pictures:
        colours = _colours(name, array)
        rows, columns, _ = colours.shape
        header["pictures"].append({"name": str(name), "note": str(note[0]) if note else "", "rows": rows, "columns": columns})
        payload += colours.tobytes()
    lines = [text for one in header["pictures"] for text in (one["name"], one["note"])] + header["texts"] + header["unread"]
    if any(len(text.encode()) > 200 or not text.isprintable() for text in lines):
        raise ValueError("shown(): expected captions and texts of one line, at most 200 bytes")
    if max(len(header[member]) for member in ("pictures", "texts", "unread")) > 8 or len(payload) > 1 << 20:
        raise ValueError("shown(): expected at most 8 pictures, 8 texts and 1 MiB of pictures, 3 bytes a pixel")
    if any(not 1 <= one[side] <= 1024 for one in header["pictures"] for side in ("rows", "columns")):
        raise ValueError("shown(): expected pictures of 1 to 1024 rows and columns")
    return header, payload


def action_bytes(value, count, may_stop=False):
    """b"" where nothing is left to do."""
    numbers = numpy.asarray(value, dtype="<f8")
    if numbers.shape != (count,) and not (may_stop and numbers.shape == (0,)):
        nothing = "; none say that nothing is left to do, where layout[\"may_stop\"] is true" if numbers.shape == (0,) else ""
        raise ValueError(f"act() returned an array of shape {numbers.shape}, expected {count} numbers{nothing}")
    return numbers.tobytes()


def named(things: Any) -> list[tuple[str, str]]:
    return [(one["object_type"], one["texture"]) for one in things]


class ObservationMemory:
    """The shared memory that holds the observation of the act that came last."""

    def __init__(self, descriptor, layout):
        self.shape = layout["rows"], layout["columns"], layout["channels"]
        rows, columns, channels = self.shape
        self.memory = mmap.mmap(descriptor, rows * columns * (channels + 1), prot=mmap.PROT_READ)
        os.close(descriptor)

    def read(self, instances, shadows=False, state=(), brought=()):
        """A copy: the memory holds the next one soon."""
        rows, columns, channels = self.shape
        rgb = numpy.frombuffer(self.memory, numpy.uint8, rows * columns * channels).reshape(self.shape).copy()
        ids = numpy.frombuffer(self.memory, numpy.uint8, rows * columns, rows * columns * channels)
        bits = numpy.frombuffer(self.memory, "<u2", rows * columns, rows * columns * (channels + 1)) if shadows else None
        return Observation(rgb, ids.reshape(rows, columns).copy(),
                           [Instance(one["id"], one["object_type"], one["texture"], one["pixels"]) for one in instances],
                           None if bits is None else bits.reshape(rows, columns).copy(), numpy.array(state, numpy.float64),
                           named(brought))


def perceived_frames(value, shape, call):
    """(header, payload) of the frames that say what `call` made of an observation of this shape: "ids" and "perceived"."""
    if not isinstance(value, Observation):
        raise TypeError(f"{call}() returned {type(value).__name__}, expected a lgabench_method.Observation")
    for name, array, expected in (("rgb", value.rgb, shape), ("ids", value.ids, shape[:2])):
        if not isinstance(array, numpy.ndarray) or array.dtype != numpy.uint8 or array.shape != expected:
            got = f"{array.dtype} of shape {array.shape}" if isinstance(array, numpy.ndarray) else type(array).__name__
            raise ValueError(f"{call}() returned {name} as {got}, expected uint8 of shape {expected}")
    instances = []
    for one in value.instances:
        if not 0 < int(one.id) < 256:
            raise ValueError(f"{call}() returned an instance of id {one.id}, expected 1 to 255")
        instances.append({"id": int(one.id), "object_type": str(one.object_type), "texture": str(one.texture)})
    return (({"type": "ids"}, value.ids.tobytes()),
            ({"type": "perceived", "instances": instances}, value.rgb.tobytes()))


def demonstrations(header, descriptor):
    """Pictures are views of the sealed file: they cannot be written to, and last as long as they are used."""
    memory = mmap.mmap(descriptor, 0, prot=mmap.PROT_READ) if os.fstat(descriptor).st_size else b""  # of no demonstrations
    os.close(descriptor)
    if not memory:
        return []
    arrays = {name: numpy.frombuffer(memory, "<" + one["type"], int(numpy.prod(one["shape"])), one["offset"])
              .reshape(one["shape"]) for name, one in header["arrays"].items()}
    words = header["words"]
    instances = [[] for _ in arrays["demonstration"]]
    for step, number, object_type, texture, pixels in arrays["instances"].tolist():
        instances[step].append(Instance(number, words[object_type], words[texture], pixels))
    all_of_them = [Demonstration(instruction(json), []) for json in header["instructions"]]
    for step, owner in enumerate(arrays["demonstration"].tolist()):
        seen = Observation(arrays["rgb"][step], arrays["ids"][step], instances[step],
                           arrays["shadows"][step] if "shadows" in arrays else None,
                           arrays["state"][step] if "state" in arrays else numpy.zeros(0),
                           named(header["brought"][step]) if "brought" in header else [])
        stops = "stops" in arrays and arrays["stops"][step]
        one = all_of_them[owner]
        steps = one.steps if len(one.steps) < header["trajectory_steps"][owner] else one.recovery
        steps.append(Step(seen, numpy.zeros(0) if stops else arrays["labels"][step]))
    return all_of_them
