"""Demonstrations of `lgabench demos` as a dataset of LeRobot's, by its own writer (lerobot 0.4).

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_lerobot.py heart.hdf5 heart_lerobot

A frame holds the picture, an action scaled to [-1, 1] as the Gymnasium environment takes it, and the command as its task. LeRobot
expects a state, of two numbers at least; a scene has none that a policy sees, so it is 0.
"""
import sys

import numpy
from lerobot.datasets.lerobot_dataset import LeRobotDataset

from lgabench.data import load_demonstrations


def convert(file, folder):
    demonstrations = load_demonstrations(file)
    space = demonstrations.action_space
    rows, columns, _ = demonstrations[0].steps[0].observation.rgb.shape
    features = {
        "observation.images.rgb": {"dtype": "image", "shape": (rows, columns, 3), "names": ["height", "width", "channels"]},
        "observation.state": {"dtype": "float32", "shape": (2,), "names": None},
        "action": {"dtype": "float32", "shape": (len(space.names),), "names": list(space.names)},
    }
    dataset = LeRobotDataset.create("lgabench/" + demonstrations.scenario, fps=1, features=features, root=folder, use_videos=False)
    for one in demonstrations:
        for step in one.steps:
            dataset.add_frame({"observation.images.rgb": step.observation.rgb,
                               "observation.state": numpy.zeros(2, numpy.float32),
                               "action": space.from_metres(step.label), "task": one.instruction.utterance})
        dataset.save_episode()
    dataset.finalize()
    return dataset


if __name__ == "__main__":
    convert(*sys.argv[1:])
