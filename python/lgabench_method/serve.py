"""The host's loop: answers a worker's frames with a class (docs/formats/method-protocol.md)."""
import hashlib
import importlib.machinery
import importlib.util
import mmap
import os
import pathlib
import pickle
import struct
import sys
import sysconfig
import time
import traceback

from lgabench_method import FeatureSpace, Needs, RandomStream, Refused, Services, Shown, installed, values
from lgabench_method.frames import MOST, Malformed

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

    def mean(self, command, space):
        reply = self.ask({"type": "ask", "how": "meaning", "command": values.command_json(command),
                          "space": values.space_json(space)}, "meaning")
        return values.meaning(reply["meaning"])

    def hypotheses(self, command, space):
        reply = self.ask({"type": "ask", "how": "hypotheses", "command": values.command_json(command),
                          "space": values.space_json(space)}, "hypotheses")
        return values.hypotheses(reply["hypotheses"])


class _Human(_Worker):
    def specify(self, command):
        return self._person({"type": "person", "how": "specify", "command": values.command_json(command)})

    def edit(self, command, proposal):
        return self._person({"type": "person", "how": "edit", "command": values.command_json(command),
                             "proposal": values.selection_json(proposal, "edit() was given")})

    def accepts(self, command, object_type, texture):
        return self.ask({"type": "person", "how": "accept", "command": values.command_json(command),
                         "object_type": str(object_type), "texture": str(texture)}, "accepts")["accepts"]

    def scene(self, command, scene):
        """The objects of a scene that may be asked about, as dicts with id, object_type, texture, pixels, row and column."""
        return self._in_scene("scene", command, scene)["objects"]

    def takes(self, command, scene, instance):
        return self._in_scene("takes", command, scene, int(instance))["takes"]

    def which(self, command, scene):
        """An id, or None."""
        return self._in_scene("which", command, scene)["instance"]

    def _in_scene(self, how, command, scene, instance=0):
        return self.ask({"type": "person", "how": how, "command": values.command_json(command), "scene": int(scene),
                         "instance": instance}, how)

    def _person(self, question):
        return values.selection(self.ask(question, "person")["selection"])


class _Log:
    """Sent twice a second, and before the reply: a frame for each epoch would wake the worker for nothing."""

    def __init__(self, channel):
        self.channel, self.waiting, self.sent = channel, [], time.monotonic()
        self.open = False  # whether learn() runs: only then the worker takes what is logged

    def epoch(self, epochs, steps, loss, **curves):
        """After each pass over the data: passes so far, optimiser steps so far, mean loss of the pass, and other values of it
        by name, as validation=.2: a report draws a curve of each. While learn() runs."""
        if not self.open:
            raise RuntimeError("services.log.epoch() was called outside of learn(): only training is logged")
        self.waiting.append((int(epochs), int(steps), float(loss), {name: float(value) for name, value in curves.items()}))
        if len(self.waiting) == 1000 or time.monotonic() - self.sent > .5:
            self.flush()

    def flush(self):
        if self.waiting:
            epochs, steps, losses, curves = zip(*self.waiting)
            self.waiting, self.sent = [], time.monotonic()
            values = [value for loss, named in zip(losses, curves) for value in (loss, *named.values())]
            header = {"type": "log", "epochs": epochs, "steps": steps}
            if any(curves):
                header["curves"] = [list(named) for named in curves]
            self.channel.send(header, struct.pack(f"<{len(values)}d", *values))


class _Source(importlib.machinery.SourceFileLoader):
    """Runs what a file says now: bytecode beside it may be of another source. `sha256`: what the run's record says of it."""

    def __init__(self, name, file, sha256):
        super().__init__(name, str(file))
        self.sha256 = sha256

    def get_code(self, fullname):
        source = self.get_data(self.path)
        if self.sha256 not in (None, hashlib.sha256(source).hexdigest()):
            raise ImportError(f"{self.path}: changed since the run began")
        return self.source_to_code(source, self.path)


class _Beside:
    """Finds modules in the method's folder, and in packages there, by their names: a folder that holds a run cannot be
    listed. `versions`: as describe() gives them, with the modules' hashes; `known`: it finds those alone."""

    def __init__(self, folder, versions, known=False):
        self.folder, self.versions, self.known, self.packages = folder, versions, known, set()

    def find_spec(self, name, path=None, target=None):
        for folder in [self.folder] if path is None else self.packages.intersection(map(pathlib.Path, path)):
            package = folder / name.rpartition(".")[2]
            for file, inside in ((package.with_suffix(".py"), None), (package / "__init__.py", [str(package)])):
                if not file.is_file():
                    continue
                sha256 = self.versions.get(file.relative_to(self.folder).as_posix())
                if self.known and sha256 is None:
                    continue
                if inside:
                    self.packages.add(package)
                loader = _Source(name, file, sha256)
                return importlib.util.spec_from_file_location(name, file, loader=loader, submodule_search_locations=inside)
        return None


def load(file, name, sha256, versions):
    """The class of that name; the file is run, whose folder is where it imports from first. One of an installed package is
    imported as that package's, from its source."""
    file = pathlib.Path(file)
    if folder := installed.site_of(file):
        if str(folder) not in sys.path:
            sys.path.append(str(folder))
        sys.meta_path.insert(sys.meta_path.index(importlib.machinery.PathFinder), _Beside(folder, versions, known=True))
        return getattr(importlib.import_module(installed.module_of(folder, file)), name)
    sys.path.insert(0, str(file.parent))
    sys.meta_path.insert(sys.meta_path.index(importlib.machinery.PathFinder), _Beside(file.parent, versions))
    spec = importlib.util.spec_from_file_location(file.stem, file, loader=_Source(file.stem, file, sha256))
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return getattr(module, name)


class Host:
    """One method from loading to its end. What answers a frame returns the reply's header and payload."""
    FRAMES = ("hello", "needs", "select", "revise", "learn", "save", "restore", "act", "shown", "drop", "bye")

    def __init__(self, channel, hello, descriptor):
        self.channel = channel
        if hello["protocol"] != PROTOCOL:
            raise ImportError(f"protocol {hello['protocol']} (this package: {PROTOCOL})")
        layout = {"observation": hello["observation"], "action": hello["action"], "may_stop": hello.get("may_stop", False)}
        self.observation = values.ObservationMemory(descriptor, hello["observation"])
        files = os.path.join(os.environ.get("HOME", "."), "files")
        self.log = _Log(channel)
        self.services = Services(_Model(channel), _Human(channel), hello["options"], hello["seed"], self.log, files, layout)
        method = hello["method"]
        self.kind = load(method["file"], method["class"], method["sha256"], method["versions"])
        self.method = self.kind()
        self.policy = None

    def hello(self, header, payload, descriptor):
        return {"type": "hello", "protocol": PROTOCOL}, b""

    def needs(self, header, payload, descriptor):
        if self.method is None:
            self.method = self.kind()
        needs = self.method.needs(self.services.options) if hasattr(self.method, "needs") else Needs()
        return {"type": "needs", **values.needs_json(needs), "revise": hasattr(self.method, "revise")}, b""

    def select(self, header, payload, descriptor):
        chosen = self.method.select(values.command(header["command"]), values.space(header["space"]), self.services)
        return {"type": "selection", "selection": values.selection_json(chosen, "select() returned")}, b""

    def revise(self, header, payload, descriptor):
        if not hasattr(self.method, "revise"):  # asked all the same, as one that selects alone was not asked what it needs
            return {"type": "revised", "selection": header["selection"]}, b""
        self.services.shows_truth = header["shows_truth"]
        revised = self.method.revise(values.command(header["command"]), values.selection(header["selection"]),
                                     values.demonstrations(header, descriptor), self.services)
        return {"type": "revised", "selection": values.selection_json(revised, "revise() returned")}, b""

    def learn(self, header, payload, descriptor):
        self.policy = self.method.learn(values.demonstrations(header, descriptor), self.services)
        if not hasattr(self.policy, "act"):
            raise TypeError(f"learn() returned {type(self.policy).__name__}, expected an object with act()")
        return {"type": "learned"}, b""

    def save(self, header, payload, descriptor):
        """A part of the pickled policy from a place on; without "bytes" it cannot be saved."""
        if header["from"] == 0:
            try:
                self.saved = pickle.dumps(self.policy)
            except Exception as error:  # what pickle cannot take raises whatever its author chose
                print(f"the policy cannot be pickled: {type(error).__name__}: {error}")
                return {"type": "saved"}, b""
        return {"type": "saved", "bytes": len(self.saved)}, self.saved[header["from"]:header["from"] + MOST]

    def restore(self, header, payload, descriptor):
        memory = mmap.mmap(descriptor, header["bytes"], prot=mmap.PROT_READ)
        os.close(descriptor)
        self.policy = pickle.loads(memory[:])  # in this confined process alone: a pickle runs code
        if not hasattr(self.policy, "act"):
            raise TypeError(f"saved policy: {type(self.policy).__name__}, expected an object with act()")
        return {"type": "restored"}, b""

    def act(self, header, payload, descriptor):
        if header["reset"] and hasattr(self.policy, "reset"):
            self.policy.reset()
        observation = self.observation.read(header["instances"], header.get("shadows", False), header.get("state", ()),
                                            header.get("brought", ()))
        layout = self.services.layout
        action = values.action_bytes(self.policy.act(observation, values.instruction(header["instruction"])),
                                     len(layout["action"]["numbers"]), layout["may_stop"])
        reply = {"type": "action"} if action else {"type": "action", "done": True}
        if getattr(self.policy, "seen_in_training", None) is not None:
            reply["seen_in_training"] = bool(self.policy.seen_in_training)
        return reply, action

    def shown(self, header, payload, descriptor):
        return values.shown_frame(self.policy.shown() if hasattr(self.policy, "shown") else Shown())

    def drop(self, header, payload, descriptor):
        setattr(self, "method" if header["what"] == "method" else "policy", None)
        return {"type": "dropped"}, b""

    def bye(self, header, payload, descriptor):
        self.policy = self.method = None
        sys.stdout.flush()  # the worker ends this process once it has the answer
        sys.stderr.flush()
        return {"type": "bye"}, b""

    def answer(self, frame):
        self.log.open = frame[0]["type"] == "learn"
        try:
            reply = getattr(self, frame[0]["type"])(*frame)
        finally:  # what was logged comes before the reply, and before what the method raises
            self.log.flush()
        self.channel.send(*reply)


class PerturbationHost:
    """Likewise, of a perturbation or a perceiver."""
    FRAMES = ("hello", "perceive", "drop", "bye")

    def __init__(self, channel, hello, descriptor):
        self.channel = channel
        if hello["protocol"] != PROTOCOL:
            raise ImportError(f"protocol {hello['protocol']} (this package: {PROTOCOL})")
        self.observation = values.ObservationMemory(descriptor, hello["observation"])
        named = hello.get("perturbation") or hello["perceiver"]
        self.kind = load(named["file"], named["class"], named["sha256"], named["versions"])
        self.perturbation = self.kind()

    def hello(self, header):
        self.channel.send({"type": "hello", "protocol": PROTOCOL})

    def perceive(self, header):
        if self.perturbation is None:
            self.perturbation = self.kind()
        seen = self.observation.read(header["instances"])
        if "space" in header:
            space = FeatureSpace(**header["space"])
            call, perceived = "read", self.perturbation.read(seen, space)
        else:
            call, perceived = "perceive", self.perturbation.perceive(seen, header["level"], RandomStream(header["stream"]))
        for frame in values.perceived_frames(perceived, self.observation.shape, call):
            self.channel.send(*frame)

    def drop(self, header):
        self.perturbation = None
        self.channel.send({"type": "dropped"})

    def bye(self, header):
        self.perturbation = None
        sys.stdout.flush()  # the worker ends this process once it has the answer
        sys.stderr.flush()
        self.channel.send({"type": "bye"})

    def answer(self, frame):
        getattr(self, frame[0]["type"])(frame[0])


def _place(error):
    """The line of the method's own file from which the error came, as " (mine.py:19)"; "" for one from elsewhere."""
    here = pathlib.Path(__file__).parent
    of_others = (str(here), str(here.parent / "lgabench_environment"), sysconfig.get_path("stdlib"), "<")
    own = [frame for frame in traceback.extract_tb(error.__traceback__)
           if not frame.filename.startswith(of_others) and "-packages/" not in frame.filename]
    return f" ({pathlib.Path(own[-1].filename).name}:{own[-1].lineno})" if own else ""


def _told(channel, kind, call, *arguments):
    """Calls; tells the worker what is thrown. The whole traceback goes to the log."""
    try:
        return call(*arguments)
    except SystemExit as error:
        channel.send({"type": "ends", "reason": f"ended its own process by sys.exit(){_place(error)}"})
        raise
    except MemoryError:
        channel.send({"type": "error", "kind": "memory", "reason": "out of memory"})
    except Exception as error:  # whatever a method raises costs its own call
        traceback.print_exc()
        sys.stderr.flush()
        reason = (str(error).splitlines() or [""])[0].encode(errors="replace").decode()  # a file's name may be no UTF-8
        channel.send({"type": "error", "kind": kind, "reason": f"{type(error).__name__}: {reason}"[:2000] + _place(error)})
    return None


def serve(channel):
    """Answers until bye, or until the worker is gone."""
    frame = channel.receive()
    if frame is None:
        return
    if "environment" in frame[0]:
        from lgabench_method.serve_environment import EnvironmentHost
        host = _told(channel, "plugin", EnvironmentHost, channel, frame[0], frame[2], load)
    else:
        of_kind = PerturbationHost if {"perturbation", "perceiver"} & set(frame[0]) else Host
        host = _told(channel, "plugin", of_kind, channel, frame[0], frame[2])
    if host is None:
        return
    while frame is not None:
        kind = frame[0]["type"]
        if kind not in host.FRAMES:
            raise Malformed(f"unexpected frame from the worker: \"{kind}\"")
        _told(channel, "method", host.answer, frame)
        if kind == "bye":
            return
        frame = channel.receive()
