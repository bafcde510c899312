"""A policy that another program serves, over a WebSocket with msgpack:

    lgabench run q1 --preset smoke --methods policy_server.py:Served --answers none --python v/bin/python

The interpreter has websockets and msgpack. The server gets {"image": bytes, "shape": [rows, columns, 3], "state": [...],
"prompt": words, "actions": [{"name", "unit", "low", "high"}, ...]} and replies {"actions": [[...]]}, the next action first. It
learns nothing here, and may have learned from what `lgabench demos` wrote. Its weights are no part of a cell's key: name them in
the option `policy`.
"""
import msgpack
from lgabench_method import Needs, Selection
from websockets.sync.client import connect


class Served:
    version = "0.1"
    summary = "a policy of a server, over a WebSocket"
    asks = "network"
    options = {
        "address": {"default": "ws://localhost:8000", "help": "the server's", "source": "chosen"},
        "policy": {"default": "", "help": "what it serves, for the record", "source": "chosen"},
    }

    def needs(self, options):
        return Needs(targets="truth")

    def select(self, command, space, services):
        return Selection()

    def learn(self, demonstrations, services):
        return Policy(services.options["address"], services.layout["action"]["numbers"])


class Policy:
    def __init__(self, address, actions):
        self.server = connect(address, max_size=None)
        self.actions = actions

    def act(self, observation, instruction):
        rgb = observation.rgb
        self.server.send(msgpack.packb({"image": rgb.tobytes(), "shape": list(rgb.shape), "prompt": instruction.utterance,
                                        "state": [float(one) for one in observation.state], "actions": self.actions}))
        return msgpack.unpackb(self.server.recv())["actions"][0]
