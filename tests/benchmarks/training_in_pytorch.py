"""The training step in PyTorch from Python, as a reference for lgabench-benchmarks, which starts this as a child.

    training_in_pytorch.py "1 3" text

names the channels of each tower's picture and whether there is a text. Says "ready"; then, for every line N of standard
input, makes N steps on one thread and answers with the seconds of processor time that they took. Needs PyTorch (Debian:
python3-torch). What the numbers are makes no difference to the time: here they are random."""
import sys
import time

import torch
from torch import nn

ROWS = 10


class Network(nn.Module):
    def __init__(self, channels, text):
        super().__init__()
        self.towers = nn.ModuleList(
            nn.Sequential(nn.Conv2d(c, 32, 8, stride=4), nn.BatchNorm2d(32), nn.ReLU(),
                          nn.Conv2d(32, 64, 4, stride=2), nn.BatchNorm2d(64), nn.ReLU(),
                          nn.Conv2d(64, 32, 3), nn.BatchNorm2d(32), nn.ReLU(), nn.Flatten()) for c in channels)
        self.text = nn.Linear(384, 100) if text else None
        self.head = nn.Linear(160 * len(channels) + (100 if text else 0), 12)

    def forward(self, pictures, text):
        features = [tower(picture) for tower, picture in zip(self.towers, pictures)]
        if self.text:
            features.append(self.text(text))
        return self.head(torch.cat(features, 1))


def main():
    torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    channels = [int(c) for c in sys.argv[1].split()]
    network = Network(channels, "text" in sys.argv[2:])
    adam = torch.optim.Adam(network.parameters(), lr=1e-3)
    pictures = [torch.rand(ROWS, c, 36, 72) for c in channels]
    text, labels = torch.randn(ROWS, 384) / 20, torch.rand(ROWS, 12)
    print("ready", flush=True)
    for line in sys.stdin:
        begin = time.process_time()
        for _ in range(int(line)):
            loss = (network(pictures, text) - labels).norm(2, 1).mean()
            adam.zero_grad()
            loss.backward()
            adam.step()
            loss.item()
        print(time.process_time() - begin, flush=True)


main()
