"""Serves the built console; its hashed assets may be kept for ever, its page never."""

from __future__ import annotations

import mimetypes
from importlib.resources import as_file, files
from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import FileResponse, HTMLResponse, Response
from starlette.datastructures import Headers
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

# Encodings and endings of the compressed files, the smallest first.  Browsers take Brotli over TLS.
_COMPRESSED = (("br", ".br"), ("gzip", ".gz"))
_NOT_BUILT = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Muster</title>
<h1>The console has not been built</h1>
<p>In the checkout run <code>npm ci &amp;&amp; npm run build</code> in
<code>base_station/console</code>, or start with <code>./muster</code>, which does that.
The API is at <code>/api/v1</code>.</p></html>
"""


class _Assets(StaticFiles):
    """Files whose names change with their content, sent as the build compressed them."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        accepted = Headers(scope=scope).get("accept-encoding", "")
        encodings = {one.partition(";")[0].strip() for one in accepted.split(",")}
        for encoding, suffix in _COMPRESSED:
            if encoding in encodings and self.lookup_path(path + suffix)[1] is not None:
                response = await super().get_response(path + suffix, scope)
                response.headers["Content-Encoding"] = encoding
                response.headers["Content-Type"] = mimetypes.guess_type(path)[0] or "text/plain"
                break
        else:
            response = await super().get_response(path, scope)
        response.headers["Vary"] = "Accept-Encoding"
        if response.status_code == 200:
            response.headers["Cache-Control"] = "public, max-age=31536000, immutable"
        return response


def serve_console(app: FastAPI, name: str = "index.html") -> None:
    """Add ``/``, which is the page ``name``, and the files below it; to be called after all other
    routes were added.
    """
    with as_file(files("base_station") / "console" / "dist") as dist:
        page = Path(dist) / name
    if not page.is_file():

        @app.get("/", include_in_schema=False)
        def not_built() -> HTMLResponse:
            return HTMLResponse(_NOT_BUILT, 503)

        return
    serve_built(app, page)


def serve_built(app: FastAPI, page: Path) -> None:
    """Add a built page with the files beside it."""
    dist = page.parent

    @app.get("/", include_in_schema=False)
    def console() -> FileResponse:
        return FileResponse(page, headers={"Cache-Control": "no-cache"})

    if (dist / "assets").is_dir():
        app.mount("/assets", _Assets(directory=dist / "assets"), name="assets")
    app.mount("/", StaticFiles(directory=dist), name="console")
