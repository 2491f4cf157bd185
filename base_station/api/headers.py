"""Security and cache headers of every response."""

from __future__ import annotations

import re
from collections.abc import Callable

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

# The console needs no inline script and nothing from elsewhere; photos are drawn from memory
# while they are chosen (blob:).
_CONTENT_POLICY = (
    "default-src 'self'; connect-src 'self'{other}; img-src 'self' blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
_ORIGIN = re.compile(r"https?://[A-Za-z0-9.:\[\]-]+")
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "geolocation=(), microphone=(), camera=()",
}


def content_policy(other_console: str) -> str:
    """Content security policy: the console loads from, and connects to, only this station and the
    other one.
    """
    known = _ORIGIN.fullmatch(other_console) is not None
    return _CONTENT_POLICY.format(other=f" {other_console}" if known else "")


class SecurityHeadersMiddleware:
    """ASGI middleware that adds the headers."""

    def __init__(
        self, app: ASGIApp, secure: bool, other_console: Callable[[], str] = lambda: ""
    ) -> None:
        """``other_console``: origin of the other station's console, which this one asks whether it
        leads.
        """
        self._app = app
        self._other_console = other_console
        self._headers = dict(_HEADERS)
        if secure:
            self._headers["Strict-Transport-Security"] = "max-age=31536000"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in self._headers.items():
                    headers[name] = value
                headers["Content-Security-Policy"] = content_policy(self._other_console())
                headers.setdefault("Cache-Control", "no-store")
            await send(message)

        await self._app(scope, receive, send_with_headers)
