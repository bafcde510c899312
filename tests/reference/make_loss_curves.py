"""Writes loss_curves.json: 50 training steps of every network in PyTorch, which tests hold ours against.

Needs PyTorch (Debian: python3-torch). Weights, inputs and labels come from one formula, so that a test makes the same
numbers without a file: number i of a list named by `key` is ((i + 1) * 2654435761 + key * 40503) mod 2^32 / 2^32.
    python3 make_loss_curves.py > loss_curves.json
"""
import json

import torch
from torch import nn

SAMPLES, BATCH, STEPS = 40, 10, 50


def numbers(key, count):
    i = torch.arange(1, count + 1, dtype=torch.int64)
    # Products modulo 2^32, then scrambled once more: neighbours must not be alike.
    x = (i * 2654435761 + key * 40503) % 2**32
    x = ((x ^ (x >> 15)) * 2246822519) % 2**32
    return ((x ^ (x >> 13)).double() / 2**32).float()


class Policy(nn.Module):
    """The network of the paper's text, of the released code ("released"), or without batch normalisation ("plain")."""

    def __init__(self, channels, text, network):
        super().__init__()

        def block(from_, to, kernel, stride, last=False):
            after = {"text": [nn.BatchNorm2d(to), nn.ReLU()], "plain": [nn.ReLU()],
                     "released": [nn.LeakyReLU() if last else nn.ReLU(), nn.BatchNorm2d(to)]}
            return [nn.Conv2d(from_, to, kernel, stride), *after[network]]

        self.towers = nn.ModuleList(
            nn.Sequential(*block(c, 32, 8, 4), *block(32, 64, 4, 2), *block(64, 32, 3, 1, last=True), nn.Flatten())
            for c in channels)
        deep = network == "released" and text
        self.own = nn.ModuleList(nn.Linear(160, 100) for _ in channels) if deep else None
        self.text = nn.Linear(384, 100) if text and not deep else None
        self.joined = nn.Linear(100 * len(channels) + 384, 100) if deep else nn.Linear(
            160 * len(channels) + 100 * text, 12)
        self.last = nn.Linear(100, 12) if deep else None

    def forward(self, pictures, text):
        features = [tower(picture) for tower, picture in zip(self.towers, pictures)]
        if self.last:
            features = [own(f) for own, f in zip(self.own, features)] + [text]
            return self.last(torch.relu(self.joined(torch.cat(features, 1))))
        if self.text:
            features.append(self.text(text))
        return self.joined(torch.cat(features, 1))


def curve(channels, text, network, squared):
    policy = Policy(channels, text, network)
    parameters = list(policy.parameters())
    first = numbers(3, sum(p.numel() for p in parameters)) - .5
    with torch.no_grad():
        begin = 0
        for p in parameters:
            # Weights as PyTorch begins with them; all else within .05, and batch normalisation's scale at 1.
            p.copy_(first[begin:begin + p.numel()].view_as(p) * (2 / p[0].numel() ** .5 if p.dim() > 1 else .1))
            begin += p.numel()
        for module in policy.modules():
            if isinstance(module, nn.BatchNorm2d):
                module.weight.fill_(1)
    # Channels last in the formula, as in our samples.
    pictures = [numbers(10 + t, SAMPLES * 36 * 72 * c).view(SAMPLES, 36, 72, c).permute(0, 3, 1, 2).contiguous()
                for t, c in enumerate(channels)]
    texts = (numbers(20, SAMPLES * 384).view(SAMPLES, 384) - .5) / 5
    labels = numbers(30, SAMPLES * 12).view(SAMPLES, 12)
    # Rounding grows too fast at 1e-3 in the released code's order: single and double precision part ways.
    optimiser = torch.optim.Adam(parameters, lr=1e-4 if network == "released" and channels else 1e-3)
    losses = []
    for step in range(STEPS):
        rows = [(step * BATCH + i) % SAMPLES for i in range(BATCH)]
        error = policy([p[rows] for p in pictures], texts[rows]) - labels[rows]
        loss = (error ** 2).sum(1).mean() if squared else error.norm(dim=1).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(round(loss.item(), 7))
    return losses


def main():
    torch.set_num_threads(1)
    inputs = {"mask": ([1], False), "rgb": ([3], False), "mask_and_rgb": ([1, 3], False), "text": ([], True),
              "rgb_and_text": ([3], True), "rgb_segmentation_and_text": ([3, 1], True)}
    losses = {"plain": False, "text": True, "released": False}  # squared: one network learns by the paper's
    curves = [{"input": name, "channels": channels, "text": text, "network": network, "squared": squared,
               "losses": curve(channels, text, network, squared)}
              for name, (channels, text) in inputs.items() for network, squared in losses.items()]
    print(json.dumps({"torch": torch.__version__, "curves": curves}, indent=None, separators=(",", ":")).replace(
        '{"input"', '\n{"input"'))


main()
