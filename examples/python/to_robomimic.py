"""robomimic's behaviour cloning on demonstrations of `lgabench demos` (robomimic 0.3).

    lgabench demos heart --layout cells --n 50 --out heart.hdf5
    python to_robomimic.py heart.hdf5 heart_scaled.hdf5 trained

robomimic reads the file as it is, but for the actions: its network ends in tanh, so a copy has them scaled to [-1, 1]. An episode is
one action, hence sequences of 1; nothing is rolled out, as lgabench.evaluate() does that.
"""
import shutil
import sys

import h5py
import torch
from robomimic.config import config_factory
from robomimic.scripts.train import train

from lgabench.data import load_demonstrations


def scale(file, to):
    """A copy whose actions are within [-1, 1]."""
    space = load_demonstrations(file).action_space
    shutil.copyfile(file, to)
    with h5py.File(to, "r+") as copy:
        for name in copy["data"]:
            actions = copy[f"data/{name}/actions"]
            actions[...] = space.from_metres(actions[()])


def clone(file, folder, epochs=100):
    config = config_factory("bc")
    with config.values_unlocked():
        config.train.data, config.train.output_dir, config.train.num_epochs = file, folder, epochs
        config.train.seq_length = config.train.frame_stack = 1
        config.train.num_data_workers = 0
        config.experiment.name = "lgabench"
        config.experiment.rollout.enabled = False
        config.experiment.epoch_every_n_steps = None  # a pass over the data
        config.observation.modalities.obs.low_dim = []
        config.observation.modalities.obs.rgb = ["rgb"]
        config.observation.encoder.rgb.core_kwargs.backbone_class = "ShallowConv"  # ResNet18 wants a GPU
        config.observation.encoder.rgb.core_kwargs.pool_class = "SpatialSoftmax"
    config.lock()
    train(config, device=torch.device("cuda" if torch.cuda.is_available() else "cpu"))


if __name__ == "__main__":
    scale(*sys.argv[1:3])
    clone(*sys.argv[2:4])
