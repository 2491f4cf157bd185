"""Clients of HTTP that speak to a station without TLS: certificates that they need not load."""

from __future__ import annotations

import ssl

# For ``verify``: without it each new client reads the certificates of all public authorities, which
# takes 30 ms of processor time.  It trusts nobody, so that none of them is missed by mistake.
NO_AUTHORITIES = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
