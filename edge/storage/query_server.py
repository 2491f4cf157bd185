"""Server of the station's queries: answers under a branch of the unit's keys."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping

from shared.channels import ROOT
from shared.errors import StoreError

logger = logging.getLogger(__name__)

Parameters = dict[str, str]
AnswerFunction = Callable[[Parameters], Iterable[bytes]]


class QueryServer:
    """Server by the last part of the key below ``muster/v1/{unit}/{branch}/``.

    An answer raises KeyError, ValueError or OverflowError where the parameters make no sense,
    StoreError or OSError where what is asked for cannot be read.
    """

    def __init__(self, unit_id: str, branch: str, functions: Mapping[str, AnswerFunction]) -> None:
        self._prefix = f"{ROOT}/{unit_id}/{branch}/"
        self._functions = functions
        self._last_error = ""  # the last in the log, while it lasts

    @property
    def key_expression(self) -> str:
        return f"{self._prefix}**"

    def replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        """Answer a query; nothing, and a line in the log, where it makes no sense."""
        del payload
        function = self._functions.get(key.removeprefix(self._prefix))
        if function is None:
            logger.warning("asked for %s, of which this unit knows nothing", key)
            return
        try:
            yield from function(dict(pair.split("=", 1) for pair in parameters.split(";") if pair))
            self._last_error = ""
        except (KeyError, ValueError, OverflowError) as error:
            logger.warning("a question for %s makes no sense: %r (%r)", key, parameters, error)
        except (StoreError, OSError) as error:
            if str(error) != self._last_error:  # the station asks again every second
                logger.error("%s cannot be answered: %s", key, error)
            self._last_error = str(error)
