"""Demonstrations of `lgabench demos` as a dataset of LeRobot's, by its own writer, and scenes for LeRobot's own rollout (lerobot 0.4).

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_lerobot.py heart.hdf5 heart_lerobot

A frame holds the picture, an action as the Gymnasium environment takes it, the command as its task, and whether the episode ends
with it. An episode has all steps of a demonstration, without its recovery steps. LeRobot expects a state of at least two numbers:
it is the observation's where the task has one, and 0 beyond it. environments() makes what lerobot's rollout() plays.
"""
import functools
import sys

import gymnasium
import numpy
from lerobot.datasets.lerobot_dataset import LeRobotDataset

import lgabench  # registers its ids
from lgabench.data import load_demonstrations

LEAST = 2  # numbers of a state


def padded(state):
    return numpy.pad(numpy.asarray(state, numpy.float32), (0, max(0, LEAST - len(state))))


def convert(file, folder):
    demonstrations = load_demonstrations(file)
    first = demonstrations[0].steps[0].observation
    rows, columns, _ = first.rgb.shape
    names = [*demonstrations.action_space.names, *["done"] * demonstrations.may_stop]
    features = {
        "observation.images.rgb": {"dtype": "image", "shape": (rows, columns, 3), "names": ["height", "width", "channels"]},
        "observation.state": {"dtype": "float32", "shape": padded(first.state).shape, "names": None},
        "action": {"dtype": "float32", "shape": (len(names),), "names": names},
        "next.done": {"dtype": "bool", "shape": (1,), "names": None},
    }
    dataset = LeRobotDataset.create("lgabench/" + demonstrations.scenario, fps=1, features=features, root=folder, use_videos=False)
    for one in demonstrations:
        for step, action in zip(one.steps, demonstrations.actions(one.steps)):
            dataset.add_frame({"observation.images.rgb": step.observation.rgb,
                               "observation.state": padded(step.observation.state), "action": action,
                               "next.done": numpy.array([step is one.steps[-1]]), "task": one.instruction.utterance})
        dataset.save_episode()
    dataset.finalize()
    return dataset


class ForLeRobot(gymnasium.ObservationWrapper):
    """Observations under LeRobot's names, and the attributes that it asks an environment for."""

    def __init__(self, id, **settings):
        super().__init__(gymnasium.make(id, **settings))
        self._max_episode_steps = self.unwrapped._max_episode_steps
        numbers = padded(numpy.zeros(len(self.unwrapped.scenario.state))).shape
        self.observation_space = gymnasium.spaces.Dict({"pixels": self.env.observation_space["rgb"],
                                                        "agent_pos": gymnasium.spaces.Box(-numpy.inf, numpy.inf, numbers)})

    task = task_description = property(lambda self: self.unwrapped.task_description)

    def observation(self, seen):
        return {"pixels": seen["rgb"], "agent_pos": padded(seen.get("state", ()))}


def environments(id, count, **settings):
    """Makes environments for lerobot's rollout(), which learns of a success only where the step that ends an episode begins the
    next; what it plays behind an episode's end is not to be counted. They go on by `count` scenes, so that none plays what another
    did; rollout() needs seeds for that."""
    return gymnasium.vector.SyncVectorEnv([functools.partial(ForLeRobot, id, stride=count, **settings)] * count,
                                          autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP)


if __name__ == "__main__":
    convert(*sys.argv[1:])
