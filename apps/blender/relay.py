"""A web server between the browser and `gatelight view`, so that the page stays while the program behind it is replaced."""

import http.client
import http.server
import json
import secrets
import threading
import time
import urllib.parse

HOST = "127.0.0.1"
LARGEST = 1 << 16  # bytes of a request
CAMERA = ("camera", "eye", "target", "up", "fov", "lens", "projection", "view-height")  # flags of the page that belong to the view
# The page asks how often the program was replaced, and loads itself again after that.
RELOAD = b"""
(async () => {
  const count = () => fetch("replaced").then(answer => answer.text());
  for (const before = await count();;) {
    await new Promise(done => setTimeout(done, 300));
    if (await count().catch(() => before) !== before) location.reload();
  }
})();
"""


class _Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        relay, host = self.server.relay, self.headers.get("Host", "")
        own = host in (f"{HOST}:{relay.port}", f"localhost:{relay.port}")
        own = own and self.headers.get("Origin", f"http://{host}") == f"http://{host}"
        if not own or not self.path.startswith(relay.path):  # a page elsewhere, or another user of the machine
            self._send(404, [], b"")
            return
        relay.asked = time.monotonic()
        path = self.path[len(relay.path):]
        if path == "replaced":
            self._send(200, [("Cache-Control", "no-store")], str(relay.replaced).encode())
            return
        body = self.rfile.read(min(int(self.headers.get("Content-Length") or 0), LARGEST))
        try:
            status, headers, content = ask(relay.program, self.command, path, body)
        except (OSError, http.client.HTTPException):
            self._send(502, [], b"")
            return
        self._send(status, headers, content + RELOAD if path == "view.js" else content)

    do_POST = do_GET

    def _send(self, status, headers, content):
        self.send_response(status)
        for name, value in headers:
            if name.lower() not in ("content-length", "connection", "keep-alive"):
                self.send_header(name, value)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        """Says nothing."""


def ask(address, method, path, body=b""):
    """Status, headers and content of what a program answers."""
    there = urllib.parse.urlsplit(address)
    connection = http.client.HTTPConnection(there.hostname, there.port, timeout=30.0)
    try:
        connection.request(method, there.path + path, body or None)
        answer = connection.getresponse()
        return answer.status, answer.getheaders(), answer.read()
    finally:
        connection.close()


class Relay:
    """Serves one address until it is closed. As that of the program, it has a secret part, and answers only this machine."""

    def __init__(self):
        self.program = None  # the address of the program that answers now
        self.replaced = 0
        self.asked = time.monotonic()  # when a page asked last
        self.path = f"/{secrets.token_hex(16)}/"
        self._server = http.server.ThreadingHTTPServer((HOST, 0), _Handler)
        self._server.daemon_threads, self._server.relay = True, self
        self.port = self._server.server_port
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def address(self):
        return f"http://{HOST}:{self.port}{self.path}"

    def replace(self, program, keep_view):
        """Another program answers from now on. It gets what was changed in the page: without the view unless that is kept."""
        if self.program is not None:
            try:
                flags = json.loads(ask(self.program, "GET", "api/scene?viewer=shared")[2])["flags"]
                kept = {name: value for name, value in flags.items() if keep_view or name not in CAMERA}
                ask(program, "POST", "api/change?viewer=shared", json.dumps({"flags": kept}).encode())
            except (OSError, http.client.HTTPException, ValueError, KeyError):
                pass  # the page then begins anew
        self.program = program
        self.replaced += 1

    def close(self):
        self._server.shutdown()
        self._server.server_close()
