"""Demonstrations of `lgabench demos` as a dataset of LeRobot's, by its own writer, and scenes for LeRobot's own rollout (lerobot 0.4).

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_lerobot.py heart.hdf5 heart_lerobot

A frame holds the picture, an action scaled to [-1, 1] as the Gymnasium environment takes it, and the command as its task. LeRobot
expects a state of at least two numbers. A policy sees no state of a scene, so the state is 0. environments() makes what lerobot's
rollout() plays.
"""
import functools
import sys

import gymnasium
import numpy
from lerobot.datasets.lerobot_dataset import LeRobotDataset

import lgabench  # registers its ids
from lgabench.data import load_demonstrations

STATE = numpy.zeros(2, numpy.float32)


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
                               "observation.state": STATE,
                               "action": space.from_metres(step.label), "task": one.instruction.utterance})
        dataset.save_episode()
    dataset.finalize()
    return dataset


class ForLeRobot(gymnasium.ObservationWrapper):
    """Observations under LeRobot's names, and the attributes that it asks an environment for."""
    _max_episode_steps = 1

    def __init__(self, id, **settings):
        super().__init__(gymnasium.make(id, **settings))
        self.observation_space = gymnasium.spaces.Dict({"pixels": self.env.observation_space["rgb"],
                                                        "agent_pos": gymnasium.spaces.Box(0, 0, STATE.shape)})

    task = task_description = property(lambda self: self.unwrapped.task_description)

    def observation(self, seen):
        return {"pixels": seen["rgb"], "agent_pos": STATE}


def environments(id, count, **settings):
    """Makes environments for lerobot's rollout(), which counts a success only if one step ends an episode and begins the next.
    They go on by `count` scenes, so that none plays what another did; rollout() needs seeds for that."""
    return gymnasium.vector.SyncVectorEnv([functools.partial(ForLeRobot, id, stride=count, **settings)] * count,
                                          autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP)


if __name__ == "__main__":
    convert(*sys.argv[1:])
