"""filterpy's update of a Kalman filter, loaded in a third of the time.

filterpy loads ``scipy.stats`` for its likelihoods and plots, of which the station uses none, and
that would be a fifth of a station's start.  Here it is loaded when one of them is first used.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

_STATISTICS = "scipy.stats"
_NAMES = ("norm", "multivariate_normal")  # that filterpy takes from it


class _Deferred:
    """A distribution of ``scipy.stats``, which is loaded when it is used."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._filterpy_loads = True

    def loaded(self) -> None:
        self._filterpy_loads = False

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        return self._distribution()(*arguments, **options)

    def __getattr__(self, attribute: str) -> Any:
        return getattr(self._distribution(), attribute)

    def logpdf(self, *arguments: Any, **options: Any) -> Any:
        """Filterpy asks at its loading whether it takes an option that SciPy has had since 2014."""
        if self._filterpy_loads:
            return 0.0
        return self._distribution().logpdf(*arguments, **options)

    def _distribution(self) -> Any:
        return getattr(import_module(_STATISTICS), self._name)


@contextmanager
def _deferred_statistics() -> Iterator[None]:
    """``scipy.stats`` is stood in for, unless it is loaded already."""
    if _STATISTICS in sys.modules:
        yield
        return
    deferred = {name: _Deferred(name) for name in _NAMES}
    stand_in = ModuleType(_STATISTICS)
    vars(stand_in).update(deferred)
    sys.modules[_STATISTICS] = stand_in
    try:
        yield
    finally:
        del sys.modules[_STATISTICS]
        for one in deferred.values():
            one.loaded()


with _deferred_statistics():
    from filterpy.kalman import update

__all__ = ["update"]
