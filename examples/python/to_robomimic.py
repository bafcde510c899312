"""robomimic's behaviour cloning on demonstrations of `lgabench demos` (robomimic 0.3), and what it is worth on a run's test scenes.

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_robomimic.py heart.hdf5 trained            # from the picture
    python to_robomimic.py heart.hdf5 trained masked     # the same, with all painted out but what the command means

robomimic could read the file as it is. This script trains on a copy, whose actions are those of the Gymnasium environment, since
robomimic's network ends in tanh, and whose pictures are half as high and wide, to train on a CPU. The network acts on what it sees
at a step alone, hence sequences of 1; recovery steps, which lie behind an episode's end, are such sequences too.
"""
import pathlib
import shutil
import sys

import h5py
import numpy
import torch
from robomimic.config import config_factory
from robomimic.scripts.train import train
from robomimic.utils import file_utils, obs_utils

import lgabench
from lgabench.data import load_demonstrations
from lgabench_method import goal_mask

TABLE = 196, 194, 190


def shown(observation, selection):
    """The picture that the network sees; with a Selection, only what it keeps."""
    rgb = observation.rgb.copy()
    if selection is not None:
        rgb[goal_mask(observation, selection) == 0] = TABLE
    return rgb[::2, ::2]


def true_selections(scenario):
    return {words: scenario.truth(number) for number, words in enumerate(scenario.commands)}


def prepare(demonstrations, file, to, selections):
    """Writes a copy whose actions are those of the Gymnasium environment, and whose pictures are those that the network sees."""
    shutil.copyfile(file, to)
    with h5py.File(to, "r+") as copy:
        for number, one in enumerate(demonstrations):
            demo = copy[f"data/demo_{number}"]
            steps, selection = [*one.steps, *one.recovery], selections.get(one.instruction.utterance)
            del demo["actions"], demo["obs/rgb"], demo["next_obs/rgb"]  # cloning reads no next_obs, but the file must have it
            demo["actions"] = demonstrations.actions(steps)
            demo["obs/rgb"] = demo["next_obs/rgb"] = [shown(step.observation, selection) for step in steps]


def clone(file, folder, epochs=200):
    """Trains, from the state too where the file has one, and returns the checkpoint's file."""
    with h5py.File(file) as copy:
        has_state = "state" in copy["data/demo_0/obs"]
    folder = pathlib.Path(folder).resolve()  # a relative one would lie among robomimic's own files
    config = config_factory("bc")
    with config.values_unlocked():
        config.train.data, config.train.output_dir, config.train.num_epochs = file, str(folder), epochs
        config.train.seq_length = config.train.frame_stack = 1
        config.train.batch_size = 10  # a batch that the data do not fill is dropped
        config.train.num_data_workers = 0
        config.experiment.name = "lgabench"
        config.experiment.rollout.enabled = False
        config.experiment.save.every_n_epochs = epochs
        config.experiment.epoch_every_n_steps = None  # a pass over the data
        config.observation.modalities.obs.low_dim = ["state"] * has_state
        config.observation.modalities.obs.rgb = ["rgb"]
        config.observation.encoder.rgb.core_kwargs.backbone_class = "ShallowConv"  # ResNet18 wants a GPU
        config.observation.encoder.rgb.core_kwargs.pool_class = "SpatialSoftmax"
    config.lock()
    train(config, device=torch.device("cuda" if torch.cuda.is_available() else "cpu"))
    return str(next(folder.rglob(f"model_epoch_{epochs}.pth")))


def play(checkpoint, demonstrations, selections, episodes=100):
    """Measures success on test scenes of the demonstrations' scenario."""
    policy, _ = file_utils.policy_from_checkpoint(ckpt_path=checkpoint)

    def act(observation, utterance):
        picture = shown(observation, selections.get(utterance))
        seen = {"rgb": obs_utils.process_obs(picture, obs_modality="rgb")}
        if len(observation.state):
            seen["state"] = observation.state.astype(numpy.float32)
        action = policy(seen)
        if demonstrations.may_stop and action[-1] > 0:
            return []
        return demonstrations.action_space.to_metres(action[:len(demonstrations.action_space.names)])

    return lgabench.evaluate(act, demonstrations.scenario, episodes=episodes, layout=demonstrations.layout, reset=policy.start_episode)


def main(file, folder, inputs="picture", epochs=200):
    demonstrations = load_demonstrations(file)
    selections = true_selections(lgabench.Scenario(demonstrations.scenario)) if inputs == "masked" else {}
    seen = str(pathlib.Path(file).with_suffix(f".{inputs}.hdf5"))
    prepare(demonstrations, file, seen, selections)
    return play(clone(seen, folder, epochs), demonstrations, selections)


if __name__ == "__main__":
    print(main(*sys.argv[1:4]))
