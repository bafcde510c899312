"""A perturbation axis (docs/extending.md): a drop on the lens hides what is behind it, from policy and segmentation alike."""
from dataclasses import replace

import numpy


class LensDrop:
    version = "0.1"
    summary = "a drop on the lens hides what is behind it"
    levels = ["a radius of 5 % of the rows", "10 %", "15 %", "20 %"]
    changes = ["rgb"]
    may_change = ["ids"]  # where it hides an object

    def perceive(self, seen, level, stream):
        rows, columns = seen.ids.shape
        row, column = stream.uniform(0, rows), stream.uniform(0, columns)  # the same place at every level
        down, across = numpy.ogrid[:rows, :columns]
        hidden = numpy.hypot(down + .5 - row, across + .5 - column) < .05 * level * rows
        rgb, ids = seen.rgb.copy(), seen.ids.copy()
        rgb[hidden] = 90
        ids[hidden] = 0
        return replace(seen, rgb=rgb, ids=ids)
