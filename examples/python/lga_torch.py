"""LGA in PyTorch: selection, mask, network and training of the plugin lga with network=plain.

    lgabench run q1 --methods lga+network=plain+batches=shuffled,examples/python/lga_torch.py:Lga

PyTorch draws the initial weights and the order of samples: success equals the plugin's on average, not scene by scene.
"""
import numpy
import torch
from torch import nn

from lgabench_method import goal_mask, select_features

ROWS, COLUMNS = 36, 72  # of the mask that the network sees


class Lga:
    version = "0.1"
    questionnaire = True
    summary = "LGA in PyTorch: behaviour cloning on a goal mask that a language model selected"
    options = {
        "epochs": {"default": 750, "min": 1, "help": "passes over the training data", "source": "paper, appendix"},
        "batch_size": {"default": 10, "min": 1, "help": "samples per step", "source": "docs/protocol.md, section 5"},
        "learning_rate": {"default": 0.001, "min": 0, "help": "of Adam", "source": "docs/protocol.md, section 5"},
    }

    def select(self, command, space, services):
        return select_features(command, space, services.lm)

    def learn(self, demonstrations, services):
        torch.set_num_threads(1)
        torch.set_flush_denormal(True)  # Adam's moments decay to subnormal numbers, which are slow
        torch.manual_seed(services.seed)
        steps = [(step, demonstration.instruction) for demonstration in demonstrations for step in demonstration.steps]
        masks = numpy.stack([small_mask(step.observation, instruction) for step, instruction in steps])
        labels = numpy.stack([step.label for step, _ in steps])
        network = make_network(labels.shape[1])
        train(network, torch.from_numpy(masks), torch.from_numpy(labels).float(), services)
        return Policy(network, masks)


def small_mask(observation, instruction):
    """The goal mask as 1 x 36 x 72 of 0 and 1: a small pixel is 1 where any pixel that it touches is 1."""
    mask = goal_mask(observation, instruction.selection)
    for axis, small in ((0, ROWS), (1, COLUMNS)):
        native = mask.shape[axis]
        mask = numpy.stack([mask.take(range(native * i // small, -(-native * (i + 1) // small)), axis).max(axis)
                            for i in range(small)], axis)
    return mask[None].astype(numpy.float32)


def make_network(numbers):
    """Three convolutions with ReLU, and a linear layer to the numbers of an action; PyTorch's initial weights."""
    return nn.Sequential(nn.Conv2d(1, 32, 8, stride=4), nn.ReLU(), nn.Conv2d(32, 64, 4, stride=2), nn.ReLU(),
                         nn.Conv2d(64, 32, 3), nn.ReLU(), nn.Flatten(), nn.Linear(160, numbers))


def train(network, masks, labels, services):
    """Adam on the L2 norm of the error; each sample once per pass, without a last incomplete batch."""
    options = services.options
    rows = len(masks)
    batch = min(options["batch_size"], rows)
    adam = torch.optim.Adam(network.parameters(), lr=options["learning_rate"])
    for epoch in range(1, options["epochs"] + 1):
        losses = []
        for chosen in torch.randperm(rows)[:rows // batch * batch].split(batch):
            loss = (network(masks[chosen]) - labels[chosen]).norm(dim=1).mean()
            adam.zero_grad(set_to_none=True)
            loss.backward()
            adam.step()
            losses.append(loss.item())
        if epoch % 10 == 0 or epoch == options["epochs"]:
            services.log.epoch(epoch, epoch * len(losses), sum(losses) / len(losses))


class Policy:
    def __init__(self, network, masks):
        self.network = network
        self.learned_from = {mask.tobytes() for mask in masks}
        self.seen_in_training = None  # whether the last input was one of these

    @torch.no_grad()
    def act(self, observation, instruction):
        mask = small_mask(observation, instruction)
        self.seen_in_training = mask.tobytes() in self.learned_from
        return self.network(torch.from_numpy(mask[None]))[0].double().numpy()
