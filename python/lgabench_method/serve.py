"""The host's loop: answers a worker's frames with a class (docs/formats/method-protocol.md)."""
import hashlib
import importlib.machinery
import importlib.util
import os
import pathlib
import struct
import sys
import traceback

from lgabench_method import Needs, Refused, Services, values
from lgabench_method.frames import Malformed

PROTOCOL = 1


class _Worker:
    """Questions in the middle of a call."""

    def __init__(self, channel):
        self.channel = channel

    def ask(self, question, expected):
        self.channel.send(question)
        frame = self.channel.receive()
        if frame is None:
            os._exit(1)  # the worker is gone
        header = frame[0]
        if header["type"] == "refused":
            raise Refused(header["reason"])
        if header["type"] != expected:
            raise Malformed(f"\"{header['type']}\", expected \"{expected}\"")
        return header


class _Model(_Worker):
    def answer(self, command, space, questions):
        """[bool], in order; a question is (about, group, candidate)."""
        reply = self.ask({"type": "ask", "command": values.command_json(command), "space": values.space_json(space),
                          "questions": [dict(zip(("about", "group", "candidate"), one)) for one in questions]}, "answers")
        return reply["answers"]


class _Human(_Worker):
    def specify(self, command):
        return self._person({"type": "person", "how": "specify", "command": values.command_json(command)})

    def edit(self, command, proposal):
        return self._person({"type": "person", "how": "edit", "command": values.command_json(command),
                             "proposal": values.selection_json(proposal)})

    def _person(self, question):
        return values.selection(self.ask(question, "person")["selection"])


class _Log(_Worker):
    def epoch(self, epochs, steps, loss):
        """After each pass over the data: passes so far, optimiser steps so far, mean loss of the pass."""
        self.channel.send({"type": "epoch", "epochs": int(epochs), "steps": int(steps)}, struct.pack("<d", loss))


class _Beside:
    """Finds modules in the method's folder by their name: one that holds a run cannot be listed."""

    def __init__(self, folder):
        self.folder = folder

    def find_spec(self, name, path=None, target=None):
        package = self.folder / name
        for file, inside in ((package.with_suffix(".py"), None), (package / "__init__.py", [str(package)])):
            if path is None and file.is_file():
                return importlib.util.spec_from_file_location(name, file, submodule_search_locations=inside)
        return None


def load(file, name, sha256):
    """The class of that name; the file is run, whose folder is where it imports from first."""
    source = pathlib.Path(file).read_bytes()
    if hashlib.sha256(source).hexdigest() != sha256:
        raise ImportError(f"{file}: changed since the run began")
    folder = pathlib.Path(file).parent
    sys.path.insert(0, str(folder))
    sys.meta_path.insert(sys.meta_path.index(importlib.machinery.PathFinder), _Beside(folder))
    spec = importlib.util.spec_from_file_location(pathlib.Path(file).stem, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return getattr(module, name)


class Host:
    """One method from loading to its end."""

    def __init__(self, channel, hello, descriptor):
        self.channel = channel
        if hello["protocol"] != PROTOCOL:
            raise ImportError(f"protocol {hello['protocol']} (this package: {PROTOCOL})")
        layout = {"observation": hello["observation"], "action": hello["action"]}
        self.observation = values.ObservationMemory(descriptor, hello["observation"])
        files = os.path.join(os.environ.get("HOME", "."), "files")
        self.services = Services(_Model(channel), _Human(channel), hello["options"], hello["seed"], _Log(channel), files,
                                 layout)
        self.kind = load(hello["method"]["file"], hello["method"]["class"], hello["method"]["sha256"])
        self.method = self.kind()
        self.policy = None

    def hello(self, header, payload, descriptor):
        self.channel.send({"type": "hello", "protocol": PROTOCOL})

    def needs(self, header, payload, descriptor):
        if self.method is None:
            self.method = self.kind()
        needs = self.method.needs(self.services.options) if hasattr(self.method, "needs") else Needs()
        self.channel.send({"type": "needs", **values.needs_json(needs)})

    def select(self, header, payload, descriptor):
        chosen = self.method.select(values.command(header["command"]), values.space(header["space"]), self.services)
        self.channel.send({"type": "selection", "selection": values.selection_json(chosen)})

    def learn(self, header, payload, descriptor):
        self.policy = self.method.learn(values.demonstrations(header, descriptor), self.services)
        if not hasattr(self.policy, "act"):
            raise TypeError(f"learn() returned {type(self.policy).__name__}, expected an object with act()")
        self.channel.send({"type": "learned"})

    def act(self, header, payload, descriptor):
        if header["reset"] and hasattr(self.policy, "reset"):
            self.policy.reset()
        observation = self.observation.read(header["instances"])
        action = values.action_bytes(self.policy.act(observation, values.instruction(header["instruction"])))
        reply = {"type": "action"}
        if getattr(self.policy, "seen_in_training", None) is not None:
            reply["seen_in_training"] = bool(self.policy.seen_in_training)
        self.channel.send(reply, action)

    def drop(self, header, payload, descriptor):
        setattr(self, "method" if header["what"] == "method" else "policy", None)
        self.channel.send({"type": "dropped"})

    def bye(self, header, payload, descriptor):
        self.policy = self.method = None
        sys.stdout.flush()  # the worker ends this process once it has the answer
        sys.stderr.flush()
        self.channel.send({"type": "bye"})


def _told(channel, kind, call, *arguments):
    """Calls; tells the worker what is thrown. The whole traceback goes to the log."""
    try:
        return call(*arguments)
    except MemoryError:
        channel.send({"type": "error", "kind": "memory", "reason": "out of memory"})
    except Exception as error:  # whatever a method raises costs its own call
        traceback.print_exc()
        sys.stderr.flush()
        reason = (str(error).splitlines() or [""])[0]
        channel.send({"type": "error", "kind": kind, "reason": f"{type(error).__name__}: {reason}"[:2000]})
    return None


def serve(channel):
    """Answers until bye, or until the worker is gone."""
    frame = channel.receive()
    if frame is None:
        return
    host = _told(channel, "plugin", Host, channel, frame[0], frame[2])
    if host is None:
        return
    answers = {name: getattr(host, name) for name in ("hello", "needs", "select", "learn", "act", "drop", "bye")}
    while frame is not None:
        kind = frame[0]["type"]
        if kind not in answers:
            raise Malformed(f"no frame of a worker: \"{kind}\"")
        _told(channel, "method", answers[kind], *frame)
        if kind == "bye":
            return
        frame = channel.receive()
