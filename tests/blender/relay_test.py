"""The server between browser and window answers only its own page, and hands over what was changed in it."""

import http.client
import http.server
import json
import threading
import unittest

from support import main, module

relay = module("relay")


class Program(http.server.BaseHTTPRequestHandler):
    """Answers as `gatelight view` does."""

    def do_GET(self):
        length = int(self.headers.get("Content-Length") or 0)
        self.server.asked.append((self.command, self.path, self.rfile.read(length).decode()))
        content = json.dumps({"flags": {"exposure": "1", "fov": "30"}}).encode()
        self.send_response(200)
        self.send_header("X-Picture", "seven")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    do_POST = do_GET

    def log_message(self, *_):
        pass


class Relays(unittest.TestCase):
    def setUp(self):
        self.relay = relay.Relay()
        self.addCleanup(self.relay.close)

    def program(self):
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Program)
        server.asked = []
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        return server, f"http://127.0.0.1:{server.server_port}/secret/"

    def ask(self, path, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.relay.port)
        self.addCleanup(connection.close)
        connection.request("GET", path, headers=headers)
        return connection.getresponse()

    def test_requests_and_answers_are_handed_on(self):
        server, address = self.program()
        self.relay.replace(address, True)
        answer = self.ask(self.relay.path + "api/scene?viewer=a")
        self.assertEqual((answer.status, answer.getheader("X-Picture"), len(json.load(answer))), (200, "seven", 1))
        self.assertEqual(server.asked, [("GET", "/secret/api/scene?viewer=a", "")])
        self.assertIn(relay.RELOAD, self.ask(self.relay.path + "view.js").read())

    def test_pages_elsewhere_get_nothing(self):
        server, address = self.program()
        self.relay.replace(address, True)
        for path, headers in (("/", {}), ("/" + "0" * 32 + "/", {}), (self.relay.path, {"Host": f"evil:{self.relay.port}"}),
                              (self.relay.path, {"Origin": "http://evil"})):
            self.assertEqual(self.ask(path, **headers).status, 404)
        self.assertEqual(server.asked, [])

    def test_the_next_program_gets_what_was_changed(self):
        for keep_view, expected in ((True, {"exposure": "1", "fov": "30"}), (False, {"exposure": "1"})):
            _, first = self.program()
            second, address = self.program()
            self.relay.replace(first, True)
            before = self.ask(self.relay.path + "replaced").read()
            self.relay.replace(address, keep_view)
            self.assertEqual(json.loads(second.asked[0][2]), {"flags": expected})
            self.assertNotEqual(self.ask(self.relay.path + "replaced").read(), before)

    def test_a_program_that_is_gone_is_an_error(self):
        self.relay.program = "http://127.0.0.1:1/"
        self.assertEqual(self.ask(self.relay.path + "api/status").status, 502)


if __name__ == "__main__":
    main()
