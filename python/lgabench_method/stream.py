"""Random numbers that are the same everywhere: lgabench::RandomStream of core/random.hpp, bit for bit."""
from __future__ import annotations

from typing import Any, Optional, Union, overload

import numpy
import numpy.typing

Numbers = numpy.typing.NDArray[numpy.float64]
_MASK = (1 << 64) - 1
_LOW = numpy.uint64(0xFFFFFFFF)
_HALF = numpy.uint64(32)


def _hash64(name: str) -> int:
    """FNV-1a over the bytes, finished with SplitMix64's mixer."""
    h = 0xcbf29ce484222325
    for byte in name.encode():
        h = ((h ^ byte) * 0x100000001b3) & _MASK
    h = ((h ^ (h >> 30)) * 0xbf58476d1ce4e5b9) & _MASK
    h = ((h ^ (h >> 27)) * 0x94d049bb133111eb) & _MASK
    return h ^ (h >> 31)


class RandomStream:
    """Philox4x32-10 (Salmon et al., SC 2011). A stream is named: two with different names never share numbers.

    With `size` (a number or a shape) a function returns the array that as many calls in a row would have returned.
    """

    def __init__(self, name: str) -> None:
        h = _hash64(name)
        self._key = h & 0xFFFFFFFF, h >> 32
        self._used = 0  # numbers that were drawn

    def _bits(self, count: int) -> numpy.typing.NDArray[numpy.uint64]:
        first, last = self._used // 4, (self._used + count + 3) // 4
        counter = numpy.arange(first, last, dtype=numpy.uint64)
        c = [counter & _LOW, counter >> _HALF, numpy.zeros_like(counter), numpy.zeros_like(counter)]
        k = list(self._key)
        for _ in range(10):
            p0, p1 = numpy.uint64(0xD2511F53) * c[0], numpy.uint64(0xCD9E8D57) * c[2]
            c = [(p1 >> _HALF) ^ c[1] ^ numpy.uint64(k[0]), p1 & _LOW, (p0 >> _HALF) ^ c[3] ^ numpy.uint64(k[1]), p0 & _LOW]
            k = [(k[0] + 0x9E3779B9) & 0xFFFFFFFF, (k[1] + 0xBB67AE85) & 0xFFFFFFFF]
        start = self._used - 4 * first
        self._used += count
        return numpy.stack(c, 1).reshape(-1)[start:start + count]

    @overload
    def next(self, size: None = ...) -> int: ...
    @overload
    def next(self, size: int) -> numpy.typing.NDArray[numpy.uint64]: ...

    def next(self, size: Optional[int] = None) -> Any:
        """32 uniform bits."""
        return int(self._bits(1)[0]) if size is None else self._bits(size)

    @overload
    def uniform(self, low: float = ..., high: float = ..., size: None = ...) -> float: ...
    @overload
    def uniform(self, low: float = ..., high: float = ..., *, size: Union[int, tuple[int, ...]]) -> Numbers: ...

    def uniform(self, low: float = 0.0, high: float = 1.0, size: Optional[Any] = None) -> Any:
        """Uniform in [low, high), 53 bits."""
        shape = () if size is None else size
        bits = self._bits(2 * int(numpy.prod(shape)))
        numbers = ((bits[::2] >> numpy.uint64(5) << numpy.uint64(26)) | (bits[1::2] >> numpy.uint64(6))) * 2.0 ** -53
        numbers = low + (high - low) * numbers
        return float(numbers[0]) if size is None else numbers.reshape(shape)

    def below(self, n: int) -> int:
        """Uniform in [0, n), without bias. n is at least 1."""
        if not 0 < n < 1 << 32:
            raise ValueError(f"below({n}): expected a number from 1 to 2**32 - 1")
        while True:
            product = self.next() * n
            low = product & 0xFFFFFFFF
            if low >= n or low >= ((1 << 32) - n) % n:
                return product >> 32

    def coin(self) -> bool:
        """True or False with equal odds."""
        return self.below(2) == 0

    @overload
    def gaussian(self, size: None = ...) -> float: ...
    @overload
    def gaussian(self, size: Union[int, tuple[int, ...]]) -> Numbers: ...

    def gaussian(self, size: Optional[Any] = None) -> Any:
        """Standard normal (Box-Muller); the last digit may be another than in C++, whose logarithm is."""
        shape = () if size is None else size
        pairs = self.uniform(size=2 * int(numpy.prod(shape)))
        numbers = numpy.sqrt(-2 * numpy.log(1 - pairs[::2])) * numpy.cos(6.283185307179586 * pairs[1::2])
        return float(numbers[0]) if size is None else numbers.reshape(shape)

    def permutation(self, n: int) -> list[int]:
        """Uniformly random order of 0..n-1 (Fisher-Yates)."""
        order = list(range(n))
        for i in range(n, 1, -1):
            j = self.below(i)
            order[i - 1], order[j] = order[j], order[i - 1]
        return order
