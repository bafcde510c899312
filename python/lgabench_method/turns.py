"""How objects are used in turn: what may be brought next, and when all is done. C++ has the same in core/turns.hpp, with its rules."""
from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lgabench_method import Meaning, Turn

PLACE = "pallet"  # the object type of the place that things are brought to: never what a rule or a turn means
Name = tuple[str, str]  # object type and texture
Names = tuple[Name, ...]
PARTS = {"object_type": 0, "texture": 1}


def wanted(meaning: Meaning, on_table: Sequence[Name], brought: Sequence[Name]) -> list[Name]:
    """The names of what may be brought next, each once, in the order of the table: those with which, once they are taken, the turns
    can still be fulfilled with what is on the table. A meaning without turns is one object of its sets; `which` is not looked at."""
    turns, table = _turns_of(meaning), _things(on_table)
    return [one for one in dict.fromkeys(table)
            if meaning.belongs(*one) and _fulfilled(turns, (*_names(brought), one), _without(table, (one,)), may_bring=True)]


def is_done(meaning: Meaning, on_table: Sequence[Name], brought: Sequence[Name]) -> bool:
    """Whether "nothing is left to do" is right: what was brought fulfils the turns, or nothing was brought and they never can be."""
    turns, table = _turns_of(meaning), _things(on_table)
    return _fulfilled(turns, _names(brought), table, may_bring=False) or (
        not brought and not _fulfilled(turns, (), table, may_bring=True))


def _turns_of(meaning: Meaning) -> list[Turn]:
    from lgabench_method import Turn
    return meaning.turns or [Turn(meaning.sets, 1)]


def _names(things: Sequence[Name]) -> Names:
    return tuple((one[0], one[1]) for one in things)


def _things(on_table: Sequence[Name]) -> Names:
    return tuple(one for one in _names(on_table) if one[0] != PLACE)


def _without(things: Names, some: Names) -> Names:
    left = list(things)
    for one in some:
        left.remove(one)
    return tuple(left)


def _fit(turn: Turn, things: Names) -> bool:
    """Whether the turn may take them together."""
    return all(any(one.contains(*thing) for one in turn.sets) for thing in things) and all(
        all(a[PARTS[part]] == b[PARTS[part]] for part in turn.same) and all(a[PARTS[part]] != b[PARTS[part]] for part in turn.different)
        for a, b in itertools.combinations(things, 2))


def _ways(turn: Turn, brought: Names, left: Names, may_bring: bool) -> Iterator[tuple[Names, Names, Names]]:
    """What the turn can take, what was brought after it, and what then stays on the table."""
    for n in range(len(brought) + 1):
        yield brought[:n], brought[n:], left
    for more in range(1, len(left) + 1) if may_bring else ():
        for some in set(itertools.combinations(left, more)):
            yield brought + some, (), _without(left, some)


def _fulfilled(turns: Sequence[Turn], brought: Names, left: Names, may_bring: bool) -> bool:
    """Whether what was brought and, where more may be brought, some of what is left fulfils the turns."""
    @functools.lru_cache(None)
    def from_turn(at: int, brought: Names, left: Names, found: bool) -> bool:
        if at == len(turns):
            return not brought
        turn, others = turns[at], brought + left
        if turn.only_if_nothing and found:
            return from_turn(at + 1, brought, left, True)
        for taken, after, rest in _ways(turn, brought, left, may_bring):
            is_over = len(taken) == turn.take if turn.take is not None else not any(_fit(turn, (*taken, one)) for one in after + rest)
            if is_over and _fit(turn, taken) and from_turn(at + 1, after, rest, bool(taken)):
                return True
        return (turn.take is not None and at + 1 < len(turns) and turns[at + 1].only_if_nothing
                and not any(_fit(turn, some) for some in itertools.combinations(others, turn.take))
                and from_turn(at + 1, brought, left, False))

    return from_turn(0, brought, tuple(sorted(left)), False)
