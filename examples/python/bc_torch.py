"""Behaviour cloning in PyTorch with a spatial softmax, on the goal mask or on the picture, as a method of the table.

    lgabench run q1 --preset smoke --methods lga,bc_torch.py:Bc,bc_torch.py:Bc+input=rgb

The spatial softmax (Levine et al., End-to-end training of deep visuomotor policies, 2016) turns each feature map into the place
where it is strongest, so that the layer after it computes with places instead of pixels.
"""
import numpy
import torch
from torch import nn

from lgabench_method import Needs, Selection, goal_mask, select_features

SHRINK = 2  # rows and columns of a block of pixels that becomes its mean


class Bc:
    version = "0.1"
    summary = "behaviour cloning in PyTorch with a spatial softmax"
    options = {
        "input": {"default": "mask", "values": ["mask", "rgb"], "help": "goal mask, or the picture alone", "source": "chosen"},
        "epochs": {"default": 150, "min": 1, "help": "passes over the training data", "source": "chosen"},
        "learning_rate": {"default": 0.003, "min": 0, "help": "of Adam", "source": "chosen"},
    }

    def needs(self, options):
        return Needs(targets="selected" if options["input"] == "mask" else "truth")

    def select(self, command, space, services):
        return select_features(command, space, services.lm) if services.options["input"] == "mask" else Selection()

    def learn(self, demonstrations, services):
        torch.set_num_threads(1)
        torch.manual_seed(services.seed)
        see = mask if services.options["input"] == "mask" else picture
        steps = [(step, one.instruction) for one in demonstrations for step in one.steps]
        inputs = torch.from_numpy(numpy.stack([see(step.observation, instruction) for step, instruction in steps]))
        labels = torch.from_numpy(numpy.stack([step.label for step, _ in steps])).float()
        centre, spread = labels.mean(0), labels.std(0, unbiased=False).clamp(min=1e-3)
        network = Network(inputs.shape[1], labels.shape[1])
        train(network, inputs, (labels - centre) / spread, services)
        return Policy(network, see, centre, spread)


def shrunk(channels):
    count, rows, columns = channels.shape
    return channels.reshape(count, rows // SHRINK, SHRINK, columns // SHRINK, SHRINK).mean((2, 4), numpy.float32)


def mask(observation, instruction):
    return shrunk(goal_mask(observation, instruction.selection)[None])


def picture(observation, instruction):
    return shrunk(observation.rgb.transpose(2, 0, 1)) / numpy.float32(255)


class Network(nn.Module):
    """Three convolutions, the expected row and column of each map under its softmax, and two linear layers."""

    def __init__(self, channels, numbers, maps=16):
        super().__init__()
        self.convolutions = nn.Sequential(nn.Conv2d(channels, 16, 5, 2), nn.ReLU(), nn.Conv2d(16, 32, 5, 1), nn.ReLU(),
                                          nn.Conv2d(32, maps, 5, 1))
        self.linear = nn.Sequential(nn.Linear(2 * maps, 64), nn.ReLU(), nn.Linear(64, numbers))

    def forward(self, inputs):
        maps = self.convolutions(inputs)
        rows, columns = maps.shape[2:]
        share = maps.flatten(2).softmax(2).reshape(maps.shape)
        down = (share.sum(3) * torch.linspace(-1, 1, rows)).sum(2)
        across = (share.sum(2) * torch.linspace(-1, 1, columns)).sum(2)
        return self.linear(torch.cat([down, across], 1))


def train(network, inputs, labels, services, batch=10):
    adam = torch.optim.Adam(network.parameters(), lr=services.options["learning_rate"])
    for epoch in range(1, services.options["epochs"] + 1):
        losses = []
        for chosen in torch.randperm(len(inputs)).split(batch):
            loss = (network(inputs[chosen]) - labels[chosen]).square().mean()
            adam.zero_grad()
            loss.backward()
            adam.step()
            losses.append(loss.item())
        services.log.epoch(epoch, epoch * len(losses), sum(losses) / len(losses))


class Policy:
    def __init__(self, network, see, centre, spread):
        self.network, self.see, self.centre, self.spread = network, see, centre, spread

    @torch.no_grad()
    def act(self, observation, instruction):
        inputs = torch.from_numpy(self.see(observation, instruction)[None])
        return (self.network(inputs)[0] * self.spread + self.centre).double().numpy()
