"""Sentence embeddings of what is shipped: object types, textures and commands, computed once with all-MiniLM-L6-v2.

They are what a method in C++ gets of lgabench::SentenceEmbeddings without the encoder.
"""
from __future__ import annotations

import functools
import json
import os
import pathlib

import numpy

from lgabench_method import Numbers

__all__ = ["embedding"]


@functools.lru_cache(maxsize=1)
def _committed() -> dict[str, list[float]]:
    data = os.environ.get("LGABENCH_DATA")  # where lgabench starts a method
    if data is None:
        import lgabench
        data = lgabench._core.data_directory()
    folder = pathlib.Path(data) / "embeddings"
    found: dict[str, list[float]] = {}
    for file in sorted(folder.glob("*.json")):
        found.update(json.loads(file.read_text())["embeddings"])
    return found


@functools.lru_cache(maxsize=None)
def embedding(sentence: str) -> Numbers:
    """384 numbers of norm 1, read-only. Raises ValueError for a sentence that is not shipped."""
    numbers = _committed().get(sentence)
    if numbers is None:
        raise ValueError(f'"{sentence}": expected a name or a command that lgabench ships, which has a committed embedding')
    vector = numpy.array(numbers)
    vector.setflags(write=False)
    return vector
