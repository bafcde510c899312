"""Demonstrations of `lgabench demos` as a dataset of Minari's, by its own writer (minari 0.5). MINARI_DATASETS_PATH says where.

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_minari.py heart.hdf5 lgabench/heart/oracle-v0

An episode has all steps of a demonstration, without its recovery steps, and what was seen after the last one; rewards are 1 for a
success. Observations and actions are those of the Gymnasium environment, which the dataset recovers, but for the table of objects.
"""
import json
import sys

import gymnasium
import h5py
import minari
import numpy
from minari.data_collector import EpisodeBuffer

import lgabench  # registers its ids
from lgabench.data import load_demonstrations


def convert(file, name):
    demonstrations = load_demonstrations(file)
    with h5py.File(file) as opened:
        played = json.loads(opened["data"].attrs["env_args"])
        episodes = [episode(one, opened[f"data/demo_{number}"], demonstrations) for number, one in enumerate(demonstrations)]
    env = gymnasium.make(played["env_name"], **played["env_kwargs"])
    space = gymnasium.spaces.Dict({part: env.observation_space[part] for part in env.observation_space if part != "instances"})
    return minari.create_dataset_from_buffers(name, episodes, env, observation_space=space, algorithm_name="oracle",
                                              jpeg_encoding=False)


def episode(one, demo, demonstrations):
    steps = len(one.steps)
    seen = {part: numpy.concatenate([demo[f"obs/{part}"][:steps], demo[f"next_obs/{part}"][steps - 1:steps]])
            for part in demo["obs"] if part in ("rgb", "ids", "state")}
    return EpisodeBuffer(observations={**seen, "instruction": [one.instruction.utterance] * (steps + 1)},
                         actions=demonstrations.actions(one.steps), rewards=demo["rewards"][:steps],
                         terminations=demo["dones"][:steps].astype(bool), truncations=numpy.zeros(steps, bool))


if __name__ == "__main__":
    convert(*sys.argv[1:])
