"""Parts of a content that a client asks for by byte ranges (RFC 9110, section 14)."""

from __future__ import annotations

import hashlib
import re

from fastapi import Request, Response

_RANGE = re.compile(r"bytes=(\d*)-(\d*)")


def ranged_response(content: bytes, media_type: str, request: Request) -> Response:
    """Return the requested range; the whole content without one, or with several."""
    etag = f'"{hashlib.sha256(content).hexdigest()[:32]}"'
    headers = {"Accept-Ranges": "bytes", "ETag": etag}
    asked = _RANGE.fullmatch(request.headers.get("Range", "").strip())
    if asked is None or request.headers.get("If-Range", etag) != etag:
        return Response(content, media_type=media_type, headers=headers)
    begin, end = _bounds(asked[1], asked[2], len(content))
    if begin >= end:
        return Response(
            status_code=416, headers={**headers, "Content-Range": f"bytes */{len(content)}"}
        )
    headers["Content-Range"] = f"bytes {begin}-{end - 1}/{len(content)}"
    return Response(content[begin:end], 206, media_type=media_type, headers=headers)


def begins_at_start(request: Request) -> bool:
    """True if a client asks for a content from its first byte."""
    asked = _RANGE.fullmatch(request.headers.get("Range", "").strip())
    return asked is None or asked[1] == "0"


def _bounds(first: str, last: str, length: int) -> tuple[int, int]:
    """First byte and the byte after the last one; empty if the content has no such range."""
    if first:
        return int(first), min(int(last) + 1, length) if last else length
    return (max(length - int(last), 0), length) if last else (length, length)
