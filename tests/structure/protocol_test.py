"""The method protocol: what the Python host is sent and sends is as docs/formats/host_message.schema.json says, with no other
member; the words of the C++ sources are the schema's. Needs NumPy.

Usage: protocol_test.py SOURCE_DIR
"""
import json
import os
import pathlib
import re
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.path[:0] = [str(SOURCE / "tests"), str(SOURCE / "python")]
import json_schema

try:
    import numpy
    from lgabench_method import serve
except ImportError:
    numpy, debian = None, "/usr/bin/python3"
    if not os.path.samefile(sys.executable, debian):  # which has python3-numpy, where the interpreter of the build may not
        os.execv(debian, [debian, *sys.argv])

SCHEMA = json.loads((SOURCE / "docs/formats/host_message.schema.json").read_text())
MESSAGES = {name: one for name, one in SCHEMA["definitions"].items() if "x-kind" in one}
COMMAND, SPACE = {"utterance": "Bring me the heart.", "task": "pick_and_place"}, {"id": "tabletop", "object_types": ["heart"], "textures": ["red"]}
SET = {"object_types": ["heart"], "textures": ["red"]}
MEANING = {"sets": [SET], "which": {"rule": "left_of", "of": SET}}
TURNS = {"turns": [{"sets": [SET], "take": "all", "different": ["texture"]}, {"sets": [SET], "take": 2, "same": ["object_type"], "only_if_nothing": True}]}
SELECTION = {"target": SET, "provenance": "recorded", "source": "M", "asked_as": "words"}
INSTRUCTION, SEEN = {"utterance": COMMAND["utterance"], "selection": SELECTION}, {"id": 3, "object_type": "heart", "texture": "red", "pixels": 9}
NO_ARRAY = {"offset": 0, "type": "u1", "shape": [0, 2, 2]}  # of no demonstrations
SHARED = {"instructions": [], "trajectory_steps": [], "words": [],
          "arrays": dict.fromkeys(("rgb", "ids", "labels", "demonstration", "instances"), NO_ARRAY)}
ANSWERED = {"model": "M", "provenance": "recorded", "asked_as": "words",
            "cost": {"lm_queries": 1, "lm_tokens": 2, "lm_seconds": .5, "human_seconds": 0}}
OBSERVATION = {"rows": 2, "columns": 2, "channels": 3}
LIMITS = {"header_bytes": 1 << 20, "payload_bytes": 1 << 20}

METHOD = '''
from lgabench_method import Selection, Shown
import numpy

class Policy:
    seen_in_training = True

    def act(self, observation, instruction):
        return numpy.zeros(2)

    def shown(self):
        return Shown([("mask", numpy.ones((2, 2), bool))])

class Asks:
    version, summary = "1", "Asks everything"

    def select(self, command, space, services):
        services.lm.answer(command, space, [("target", "texture", "red")])
        services.lm.mean(command, space)
        services.lm.hypotheses(command, space)
        selection = services.human.edit(command, services.human.specify(command))
        services.human.accepts(command, "heart", "red")
        services.human.scene(command, 0)
        services.human.takes(command, 0, 3)
        services.human.which(command, 0)
        return selection

    def revise(self, command, selected, demonstrations, services):
        return selected

    def learn(self, demonstrations, services):
        services.log.epoch(1, 10, .5, validation=.2)
        return Policy()

class Reads:
    def read(self, seen, space):
        return seen

class Changes:
    def perceive(self, seen, level, stream):
        return seen
'''
ANSWERS = {"ask": {"type": "answers", "answers": [True], **ANSWERED}, "meaning": {"type": "meaning", "meaning": MEANING, **ANSWERED},
           "hypotheses": {"type": "hypotheses", "hypotheses": [{"text": "ripe", "meaning": TURNS, "weight": .5}], **ANSWERED},
           "specify": {"type": "person", "selection": SELECTION}, "edit": {"type": "person", "selection": SELECTION},
           "accept": {"type": "accepts", "accepts": True}, "scene": {"type": "scene", "objects": [{**SEEN, "row": 1.5, "column": .5}]},
           "takes": {"type": "takes", "takes": False}, "which": {"type": "which", "instance": None}}


class Channel:
    """In place of a socket: answers questions, and keeps whatever passes."""

    def __init__(self):
        self.sent, self.passed, self.question = [], [], None

    def send(self, header, payload=b""):
        header = json.loads(json.dumps(header))
        self.passed.append(header)
        self.sent.append(header)

    def receive(self):
        asked = self.sent[-1]
        self.passed.append(ANSWERS[asked.get("how", asked["type"])])
        return self.passed[-1], b"", None


@unittest.skipUnless(numpy, "NumPy is not installed")
class PythonHost(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "asks.py"
        self.file.write_text(METHOD)
        self.channel = Channel()

    def descriptor(self, size=0):
        file = tempfile.TemporaryFile()
        file.truncate(size)
        self.addCleanup(file.close)
        return os.dup(file.fileno())

    def play(self, host, hello, requests):
        def plugin(name):
            return {"file": str(self.file), "class": name, "sha256": serve.hashlib.sha256(METHOD.encode()).hexdigest(), "versions": {}}
        hello = {"type": "hello", "protocol": 1, "limits": LIMITS, "observation": OBSERVATION,
                 **{name: plugin(value) if name in ("method", "perturbation", "perceiver") else value for name, value in hello.items()}}
        playing = host(self.channel, hello, self.descriptor(2 * 2 * 4))
        for request, size in [(hello, None), *requests]:
            self.channel.passed.append(request)
            playing.answer((request, b"", None if size is None else self.descriptor(size)))
            self.assertNotIn("error", [one["type"] for one in self.channel.sent])

    def test_its_messages_are_the_schemas(self):
        action = {"numbers": [{"name": "x", "unit": "m", "low": 0, "high": 1}] * 2, "rotations": [], "places": [[0, 1]],
                  "stations": {"numbers": [1], "all": [{"seen": [0, 0], "values": [.5]}]}}
        self.play(serve.Host, {"method": "Asks", "options": {}, "seed": 0, "action": action}, [
            ({"type": "needs"}, None), ({"type": "select", "command": COMMAND, "space": SPACE}, None),
            ({"type": "revise", "command": COMMAND, "selection": SELECTION, "shows_truth": False, **SHARED}, 0),
            ({"type": "learn", **SHARED}, 0),
            ({"type": "act", "instruction": INSTRUCTION, "instances": [SEEN], "reset": True}, None), ({"type": "shown"}, None),
            ({"type": "save", "from": 0}, None), ({"type": "drop", "what": "policy"}, None), ({"type": "bye"}, None)])
        seen = {"type": "perceive", "instances": [SEEN]}
        self.play(serve.PerturbationHost, {"perturbation": "Changes"}, [({**seen, "level": 1, "stream": "0"}, None)])
        self.play(serve.PerturbationHost, {"perceiver": "Reads"}, [({**seen, "space": SPACE}, None), ({"type": "bye"}, None)])
        for message in self.channel.passed:
            self.assertEqual(json_schema.complaints(message, SCHEMA), [], message)
            self.assertNotEqual(json_schema.complaints({**message, "surprise": 1}, SCHEMA), [], message)
        kinds = {message["type"] for message in self.channel.passed}
        self.assertEqual({one["properties"]["type"]["const"] for one in MESSAGES.values()} - kinds,
                         {"restore", "restored", "state", "error", "refused", "ends"})


class Sources(unittest.TestCase):
    def test_types_are_those_of_the_sources(self):
        host = "".join(file.read_text() for file in (SOURCE / "framework/lgabench/host").glob("*.?pp")
                       if file.stem != "python_environment")  # its frames are no interface for others
        sent = set(re.findall(r'\{"type", "(\w+)"\}|\["type"\] = "(\w+)"', host))
        self.assertEqual({one or other for one, other in sent}, {one["properties"]["type"]["const"] for one in MESSAGES.values()})
        members = {name for one in MESSAGES.values() for name in one["properties"]} - {"versions", "perturbation", "stations"}
        self.assertEqual([name for name in members if f'"{name}"' not in host and name not in ("id", "cost")], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
