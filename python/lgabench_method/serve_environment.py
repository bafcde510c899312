"""An environment's process: answers a worker's frames with a class (docs/formats/method-protocol.md)."""
import json
import os

import numpy
from lgabench_environment import Environment, Observation, RandomStream, Request, Result, Scene, Thing

from lgabench_method import Observation as Seen, Instance, describe, values


def _number(value, what):
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what}: expected a number, got {value!r}") from None
    if not numpy.isfinite(number):
        raise ValueError(f"{what}: expected a finite number, got {number}")
    return number


def _numbers(value, count, what):
    array = numpy.asarray(value, dtype=numpy.float64)
    if array.shape != (count,):
        raise ValueError(f"{what}: expected {count} numbers, got an array of shape {array.shape}")
    return [_number(one, f"{what}[{i}]") for i, one in enumerate(array.tolist())]


def _thing_json(thing, number):
    if not isinstance(thing, Thing):
        raise TypeError(f"sample() returned {type(thing).__name__} among its things, expected a lgabench_environment.Thing")
    what = f"sample(): thing {number}"
    return {"object_type": str(thing.object_type), "texture": str(thing.texture), "role": str(thing.role),
            "position_m": _numbers(thing.place, 2, f"{what}: place"), "yaw_rad": _number(thing.yaw, f"{what}: yaw"),
            "instance_id": int(thing.instance_id)}


class EnvironmentHost:
    """One environment from loading to its end. What answers a frame returns the reply's header and payload."""
    FRAMES = ("hello", "sample", "reset", "step", "expert")
    PROTOCOL = 1

    def __init__(self, channel, hello, descriptor, load):
        self.channel = channel
        if hello["protocol"] != self.PROTOCOL:
            raise ImportError(f"protocol {hello['protocol']} (this package: {self.PROTOCOL})")
        if descriptor is not None:
            os.close(descriptor)  # pictures go the other way
        named = hello["environment"]
        installed = describe.packages(named["packages"])
        for name, version in sorted(installed.items()):
            if named["versions"].get(name) != version:
                raise ImportError(f"{name} is {version}, it was {named['versions'].get(name, 'not there')} when the run began")
        kind = load(named["file"], named["class"], named["sha256"], named["versions"])
        if not issubclass(kind, Environment):
            raise TypeError(f"class {named['class']}: expected one derived from lgabench_environment.Environment")
        observation = hello["observation"]
        self.shape = observation["rows"], observation["columns"], observation["channels"]
        self.state, self.actions = len(observation.get("state", [])), len(hello["action"]["numbers"])
        self.one = kind()
        self.things = []

    def hello(self, header):
        self.channel.send({"type": "hello", "protocol": self.PROTOCOL})

    def sample(self, header):
        request = header["request"]
        pairs = {name: [tuple(one) for one in request.pop(name)] for name in ("meant", "others")}
        given = self.one.sample(header["scenario"], Request(**request, **pairs), RandomStream(header["stream"]))
        things, own = given if isinstance(given, tuple) and len(given) == 2 else (given, None)
        try:
            json.dumps(own, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise ValueError(f"sample(): own: expected what JSON has: {error}") from None
        objects = [_thing_json(thing, number) for number, thing in enumerate(things)]
        if not any(one["instance_id"] for one in objects):
            for one, place in zip(objects, RandomStream(header["stream"] + "/ids").permutation(len(objects))):
                one["instance_id"] = place + 1
        objects.sort(key=lambda one: one["instance_id"])
        self.channel.send({"type": "scene", "objects": objects, "own": own})

    def reset(self, header):
        scene = dict(header["scene"])
        self.things = [Thing(one["object_type"], one["texture"], one["role"], tuple(one["position_m"]), one["yaw_rad"],
                             one["instance_id"]) for one in scene["objects"]]
        members = {name: scene[name] for name in ("scenario", "task", "layout", "split", "arm", "seed", "index", "command")}
        seen = self.one.reset(Scene(things=self.things, own=scene.get("own"), **members))
        self._send(seen, "reset", {"type": "seen"})

    def step(self, header):
        action = None if header["action"] is None else numpy.array(header["action"], numpy.float64)
        result = self.one.step(action)
        if not isinstance(result, Result):
            raise TypeError(f"step() returned {type(result).__name__}, expected a lgabench_environment.Result")
        over = bool(result.terminated or result.truncated)
        failure = str(result.failure) or ("none" if result.success else "goes_on" if not over else "")
        if not failure:
            raise ValueError("step() returned a Result that is over without success and has no failure")
        self._send(result.observation, "step", {
            "type": "stepped", "terminated": bool(result.terminated), "truncated": bool(result.truncated),
            "success": bool(result.success), "failure": failure, "taken": int(result.taken)})

    def expert(self, header):
        action = self.one.expert_action(header["instance"])
        if action is None:
            self.channel.send({"type": "action", "action": None})
            return
        self.channel.send({"type": "action", "action": _numbers(action, self.actions, "expert_action()")})

    def _send(self, seen, call, header):
        if not isinstance(seen, Observation):
            raise TypeError(f"{call}() returned {type(seen).__name__}, expected a lgabench_environment.Observation")
        instances = [Instance(thing.instance_id, thing.object_type, thing.texture, 0) for thing in self.things]
        ids, perceived = values.perceived_frames(Seen(seen.rgb, seen.ids, instances), self.shape, call)
        header = {**perceived[0], **header}
        if self.state or len(seen.state):
            header["state"] = _numbers(seen.state, self.state, f"{call}(): state")
        self.channel.send(*ids)
        self.channel.send(header, perceived[1])

    def answer(self, frame):
        getattr(self, frame[0]["type"])(frame[0])
