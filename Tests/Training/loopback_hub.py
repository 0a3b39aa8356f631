"""A hub on the loopback address that serves one data set's repository from a folder, with the real paths."""

from __future__ import annotations

import hashlib
import json
import threading
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

COMMIT = "0123456789abcdef0123456789abcdef01234567"


@contextmanager
def loopback_hub(name: str, root: Path, page_entries: int = 2) -> Iterator[tuple[str, list[str]]]:
    """Serves `root` as the data set `name`. Yields the address and the list of paths that were asked for, which grows.

    Listings are pages of `page_entries`, chained by the Link header.
    """
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            url = urllib.parse.urlsplit(self.path)
            path = urllib.parse.unquote(url.path)
            asked.append(path)
            if path.startswith(f"/api/datasets/{name}/revision/"):
                info = {"_id": "1", "id": name, "sha": COMMIT, "cardData": {"license": "cc-by-4.0"}}
                self._json({**info, "lastModified": "2026-01-01T00:00:00.000Z"})
            elif path.startswith(f"/api/datasets/{name}/tree/{COMMIT}"):
                folder = root / path.removeprefix(f"/api/datasets/{name}/tree/{COMMIT}").strip("/")
                self._listing(folder, int(dict(urllib.parse.parse_qsl(url.query)).get("cursor", 0)))
            elif path.startswith(f"/datasets/{name}/resolve/{COMMIT}/"):
                self._file(root / path.removeprefix(f"/datasets/{name}/resolve/{COMMIT}/"))
            else:
                self._answer(404, b"{}")

        def _listing(self, folder: Path, first: int) -> None:
            if not folder.is_dir():
                self._answer(404, b'{"error": "no such folder"}')
                return
            entries = [_entry(root, path) for path in sorted(folder.iterdir())]
            after = first + page_entries
            address = f"http://{self.headers['Host']}{self.path.split('?')[0]}?cursor={after}"
            self._json(entries[first:after], {"Link": f'<{address}>; rel="next"'} if after < len(entries) else {})

        def _file(self, path: Path) -> None:
            content = path.read_bytes()
            first = int(self.headers.get("Range", "bytes=0-").removeprefix("bytes=").split("-")[0])
            span = {"Content-Range": f"bytes {first}-{len(content) - 1}/{len(content)}", "ETag": f'"{_blob(content)}"'}
            self._answer(206, content[first:], span)

        def _json(self, value: object, headers: dict[str, str] | None = None) -> None:
            self._answer(200, json.dumps(value).encode(), {"Content-Type": "application/json", **(headers or {})})

        def _answer(self, status: int, content: bytes, headers: dict[str, str] | None = None) -> None:
            self.send_response(status)
            for key, value in {**(headers or {}), "Content-Length": str(len(content))}.items():
                self.send_header(key, value)
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}", asked
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def _entry(root: Path, path: Path) -> dict[str, object]:
    name = path.relative_to(root).as_posix()
    if path.is_dir():
        return {"type": "directory", "oid": "0" * 40, "size": 0, "path": name}
    content = path.read_bytes()
    return {"type": "file", "oid": _blob(content), "size": len(content), "path": name}


def _blob(content: bytes) -> str:
    """Git's name of a content."""
    return hashlib.sha1(b"blob %d\0" % len(content) + content).hexdigest()
