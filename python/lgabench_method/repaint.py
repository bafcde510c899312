"""Repainting takes objects out of a picture, or makes them look otherwise, beside what a goal mask keeps.

For the same streams it gives the same bytes as lgabench::repaint() of abstraction/repaint.hpp. Colours change, ids and instances
stay. To take shadows away, a method must ask for them: `Needs(shadows=True)`.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Union

import numpy
import numpy.typing

from lgabench_method import Bytes, Demonstration, Numbers, Observation, RandomStream, Selection, Step, goal_mask

__all__ = ["Background", "Colour", "Noise", "RandomTextures", "augmented", "most_frequent_colour", "repaint",
           "unselected", "usual_background"]

SHADOW = 141  # of a colour in the light, in 1/256, what it has in the shadow of an object


@dataclass(frozen=True)
class Background:
    """What pictures show where nothing stands: `rgb` is rows x columns x 3."""
    rgb: Bytes


@dataclass(frozen=True)
class Colour:
    """One colour everywhere, each part from 0 to 255."""
    red: int
    green: int
    blue: int


@dataclass(frozen=True)
class Noise:
    """Another random colour at each pixel."""
    stream: RandomStream


@dataclass(frozen=True)
class RandomTextures:
    """A random pattern for each id, plain, stripes, checks, dots or a gradient of two random colours, in the pixels' light."""
    stream: RandomStream


How = Union[Background, Colour, Noise, RandomTextures]
Mask = numpy.typing.NDArray[numpy.bool_]


def unselected(observation: Observation, selection: Selection) -> list[int]:
    """Ids of the instances that a goal mask leaves out, in the order of `instances`."""
    kept = set(numpy.unique(observation.ids[goal_mask(observation, selection) > 0]).tolist())
    return [one.id for one in observation.instances if one.id not in kept]


def _clear(observation: Observation) -> Mask:
    free: Mask = observation.ids == 0
    return free if observation.shadows is None else free & (observation.shadows == 0)


def _packed(rgb: Bytes) -> numpy.typing.NDArray[numpy.int64]:
    wide = rgb.astype(numpy.int64)
    return wide[..., 0] << 16 | wide[..., 1] << 8 | wide[..., 2]


def _unpacked(colours: numpy.typing.ArrayLike) -> Bytes:
    packed = numpy.asarray(colours, numpy.int64)
    return numpy.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], -1).astype(numpy.uint8)


def _most_frequent(colours: numpy.typing.NDArray[numpy.int64]) -> int:
    values, counts = numpy.unique(colours, return_counts=True)
    return int(values[counts.argmax()]) if len(values) else 0


def usual_background(demonstrations: Iterable[Demonstration]) -> Background:
    """The background of these demonstrations. Its colour at a pixel is that of more than half of the steps in which neither an
    object nor a shadow is there; where there is no such step, the most frequent colour of the other pixels."""
    seen = [step.observation for one in demonstrations for step in one.steps + one.recovery]
    candidates = numpy.zeros(seen[0].ids.shape, numpy.int64)
    lead, known = numpy.zeros_like(candidates), numpy.zeros(candidates.shape, bool)
    for one in seen:  # a majority vote in one pass (Boyer and Moore 1991)
        clear, colours = _clear(one), _packed(one.rgb)
        candidates = numpy.where(clear & (lead == 0), colours, candidates)
        lead += clear * numpy.where(colours == candidates, 1, -1)
        known |= clear
    return Background(_unpacked(numpy.where(known, candidates, _most_frequent(candidates[known]))))


def most_frequent_colour(background: Background) -> Colour:
    """The background's most frequent colour: the table's, if the picture shows little else."""
    return Colour(*_unpacked(_most_frequent(_packed(background.rgb))).tolist())


def _random_colour(stream: RandomStream) -> Bytes:
    return _unpacked(stream.next() >> 8)


def _pattern(stream: RandomStream, rows: Numbers, columns: Numbers) -> Bytes:
    """Colours of pixels; arithmetic as in C++, to the bit."""
    kind = stream.below(5)
    one, other = _random_colour(stream), _random_colour(stream)
    scale = stream.uniform(1 / 24, 1 / 4)
    down, across = scale * stream.uniform(-1, 1), scale * stream.uniform(-1, 1)
    first, second = stream.uniform(), stream.uniform()
    u, v = rows * down + columns * across + first, columns * down - rows * across + second
    u, v = u - numpy.floor(u), v - numpy.floor(v)
    if kind == 4:
        share = numpy.abs(2 * u - 1)[:, None]
        return numpy.floor(one + share * (other.astype(float) - one) + .5).astype(numpy.uint8)
    shows_one = [numpy.ones(len(u), bool), u < .5, (u < .5) == (v < .5), (u - .5) * (u - .5) + (v - .5) * (v - .5) < .09][kind]
    return numpy.where(shows_one[:, None], one, other)


def repaint(observation: Observation, which: Sequence[int], how: How) -> Observation:
    """Paints the pixels whose ids are in `which`; the id 0 stands for all that is no object.

    A background or a colour takes their shadows away too, if the observation tells shadows, except where another object
    throws one. Noise also covers the pixels in their shadows that show no object. Under textures, shadows stay.
    """
    covered: Mask = numpy.isin(observation.ids, list(which))
    rgb = observation.rgb.copy()
    bits = sum(1 << row for row, one in enumerate(observation.instances[:16]) if one.id in which)
    shadows = observation.shadows if observation.shadows is not None else numpy.zeros(observation.ids.shape, numpy.uint16)
    shaded: Mask = ~covered & ((shadows & bits) != 0)
    if isinstance(how, RandomTextures):
        for number in which:
            rows, columns = numpy.nonzero(observation.ids == number)
            rgb[rows, columns] = _pattern(how.stream, rows.astype(float), columns.astype(float))
        dark = covered & (shadows != 0)
        rgb[dark] = (rgb[dark].astype(int) * SHADOW + 128) >> 8
    elif isinstance(how, Noise):
        covered |= shaded & (observation.ids == 0)
        rgb[covered] = _unpacked(how.stream.next(int(covered.sum())) >> numpy.uint64(8))
    else:
        alone = shaded & ((shadows & ~numpy.uint16(bits)) == 0)
        rgb[alone] = numpy.minimum(255, (rgb[alone].astype(int) * 256 + SHADOW // 2) // SHADOW)
        rgb[covered] = how.rgb[covered] if isinstance(how, Background) else (how.red, how.green, how.blue)
        if observation.shadows is not None:
            return replace(observation, rgb=rgb, shadows=numpy.where(covered, 0, shadows & ~numpy.uint16(bits)).astype(numpy.uint16))
    return replace(observation, rgb=rgb)


Augment = Callable[[Step, Selection, int, RandomStream], Step]


def augmented(demonstrations: Sequence[Demonstration], copies: int, augment: Augment, seed: int) -> list[Demonstration]:
    """The demonstrations and, behind them, copy by copy, what augment(step, selection, copy, stream) makes of their steps.
    A step without numbers, which says that nothing is left to do, has no copy.

    Train for as many optimiser steps as on the demonstrations alone, or say that you do not: a row with copies learns longer.
    """
    def acting(steps):
        return [step for step in steps if len(step.label)]

    everything = list(demonstrations)
    for copy in range(copies):
        row = 0
        for one in demonstrations:
            steps, recovery = acting(one.steps), acting(one.recovery)
            changed = []
            for step in steps + recovery:
                changed.append(augment(step, one.instruction.selection, copy, RandomStream(f"learning/augment/{seed}/{row}/{copy}")))
                row += 1
            if steps:
                everything.append(Demonstration(one.instruction, changed[:len(steps)], changed[len(steps):]))
    return everything
