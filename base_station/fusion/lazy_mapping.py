"""Mapping that makes values on demand, as all at once would be too large."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from functools import lru_cache
from typing import TypeVar

Value = TypeVar("Value")


class LastValueMapping(Mapping[str, Value]):
    """Mapping that keeps only the value asked for last."""

    def __init__(self, keys: Collection[str], make: Callable[[str], Value]) -> None:
        """``make`` gives the same for the same key."""
        self._keys = dict.fromkeys(keys)
        self._make = lru_cache(maxsize=1)(make)

    def __getitem__(self, key: str) -> Value:
        if key not in self._keys:
            raise KeyError(key)
        return self._make(key)

    def __contains__(self, key: object) -> bool:
        return key in self._keys

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)
