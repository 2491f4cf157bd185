"""Long work in parts, as many at a time as this machine has processors."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import TypeVar

from rich.console import Console
from rich.progress import track as progress_bar

Part = TypeVar("Part")
Result = TypeVar("Result")


def side_by_side(
    work: Callable[[Part], Result], parts: Sequence[Part], title: str
) -> Iterator[Result]:
    """The results in the order of the parts, with a bar of that title.

    ``work``, parts and results go between processes: a function of a module, and data.  Raises
    what ``work`` raises.
    """
    at_once = min(os.cpu_count() or 1, len(parts))
    with ProcessPoolExecutor(at_once, get_context("spawn")) as pool:
        yield from progress_bar(
            pool.map(work, parts),
            title,
            total=len(parts),
            console=Console(stderr=True),
            transient=True,
        )
