"""Limits of how often passwords may be tried.  An attempt is counted before anything is done for
it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Annotated

from fastapi import Depends, Request

from base_station.api.attempt_limiter import AttemptLimiter
from base_station.api.problems import Problem
from base_station.security.networks import network_of
from shared.coded_text import coded

_MAX_PER_ACCOUNT_AND_NETWORK = 10  # a minute: one name from one place
_MAX_PER_NETWORK = 60  # any name from one place
_MAX_PER_ACCOUNT = 30  # one name from any place
_MINUTE_S = 60.0
_MAX_KNOWN = 1000


class LoginThrottle:
    """Limits of login attempts by network and by user name.  Thread-safe.

    Attempts that are refused here are not counted: many attempts with one name do not lock out the
    other users of the network, which may be all consoles behind one router.  A user who has logged
    in from a network before can do so again while others try that name from elsewhere: only the
    limits of the network hold.  ``LoginQueue`` limits the number of attempts in work.
    """

    def __init__(self, monotonic_s: Callable[[], float] = time.monotonic) -> None:
        self._lock = Lock()
        self._per_account_and_network = AttemptLimiter(
            _MAX_PER_ACCOUNT_AND_NETWORK, _MINUTE_S, monotonic_s
        )
        self._per_network = AttemptLimiter(_MAX_PER_NETWORK, _MINUTE_S, monotonic_s)
        self._per_account = AttemptLimiter(_MAX_PER_ACCOUNT, _MINUTE_S, monotonic_s)
        self._known: dict[tuple[str, str], None] = {}  # in the order of logins, the newest last

    def check(self, address: str, username: str) -> bool:
        """Count an attempt.  True if this user name has logged in from there before.  Problem 429
        if there were too many attempts.
        """
        network = network_of(address)
        one = network, username
        with self._lock:
            limits: list[tuple[AttemptLimiter, Hashable]] = [
                (self._per_network, network),
                (self._per_account_and_network, one),
            ]
            is_known = one in self._known
            if not is_known:
                limits.append((self._per_account, username))
            if not all(limit.allows(key) for limit, key in limits):
                raise too_many_attempts()
            for limit, key in limits:
                limit.record(key)
        return is_known

    def check_account(self, username: str) -> None:
        """Count an attempt of a logged-in user who has to enter the password again."""
        with self._lock:
            if not self._per_account_and_network.allows(("", username)):
                raise too_many_attempts()
            self._per_account_and_network.record(("", username))

    def check_network(self, address: str) -> None:
        """Problem 429 if there were too many attempts from a network; counts none."""
        if not self.allows(address):
            raise too_many_attempts()

    def allows(self, address: str) -> bool:
        """True if the network itself may make another attempt."""
        with self._lock:
            return self._per_network.allows(network_of(address))

    def has_logged_in(self, address: str) -> bool:
        """True if a user has logged in from the network."""
        network = network_of(address)
        with self._lock:
            return any(one == network for one, _ in self._known)

    def record_login(self, address: str, username: str) -> None:
        one = network_of(address), username
        with self._lock:
            self._known.pop(one, None)
            self._known[one] = None
            if len(self._known) > _MAX_KNOWN:
                del self._known[next(iter(self._known))]

    def record_refusal(self, address: str) -> None:
        """Count an invalid ticket.  Valid ones are not counted: they cannot be guessed, and all
        consoles of a network use theirs at once.
        """
        with self._lock:
            self._per_network.record(network_of(address))


def too_many_attempts() -> Problem:
    return Problem(
        429,
        coded("login-too-often", "Too many tries to log in; wait a minute."),
        {"Retry-After": "60"},
    )


def throttle_of(request: Request) -> LoginThrottle:
    throttle: LoginThrottle = request.app.state.login_throttle
    return throttle


Throttle = Annotated[LoginThrottle, Depends(throttle_of)]
