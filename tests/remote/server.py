"""A server of files for tests: it counts what is asked, and fails on cue."""
import collections
import gzip
import http.server
import os
import re
import socket
import struct
import threading
import time
import urllib.parse

# open: how many requests for chunks were open when it came, itself among them.
Request = collections.namedtuple("Request", "method path range status headers open")


class Fault:
    """What happens to requests for paths that end so: to the first `times` of them, or to all."""

    def __init__(self, ending, kind, times=None, **more):
        self.ending, self.kind, self.times, self.more = ending, kind, times, more

    def takes(self, path):
        if not path.endswith(self.ending) or self.times == 0:
            return False
        if self.times is not None:
            self.times -= 1
        return True


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    # Head and body of an answer are sent one after the other: the second would wait 40 ms for the first one's receipt.
    disable_nagle_algorithm = True

    def log_message(self, *_):
        pass

    def do_HEAD(self):
        self.answer(False)

    def do_GET(self):
        self.answer(True)

    def answer(self, with_body):
        server, path = self.server.owner, self.path.split("?")[0]
        is_chunk = path[-1].isdigit()  # which no name of metadata ends with
        with server.lock:
            server.open += is_chunk
            now_open = server.open
            fault = next((f for f in server.faults if f.takes(path)), None)
        if server.pause:
            time.sleep(server.pause)
        try:
            status = self.fail(fault) if fault and fault.kind not in CHANGES else self.send(path, with_body, fault)
        except (BrokenPipeError, ConnectionResetError):
            status = 0
        with server.lock:
            server.open -= is_chunk
            server.requests.append(
                Request(self.command, self.path, self.headers.get("Range"), status, dict(self.headers), now_open))

    def fail(self, fault):
        if fault.kind == "stall":
            self.server.owner.stalled.set()
            self.server.owner.closing.wait(30)
            self.close_connection = True
            return 0
        if fault.kind == "reset":
            self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            self.connection.close()
            self.close_connection = True
            return 0
        if fault.kind == "throttle":
            # As long as it has asked for, from the first request on.
            fault.ends = getattr(fault, "ends", time.monotonic() + 0.9)
            if time.monotonic() > fault.ends:
                return self.send(self.path.split("?")[0], self.command == "GET", None)
            fault.more = {"status": 429, "headers": {"Retry-After": "1"}}
        self.plain(fault.more["status"], fault.more.get("headers", {}))
        return fault.more["status"]

    def plain(self, status, headers):
        self.send_response(status)
        for name, value in {"Content-Length": "0", **headers}.items():
            self.send_header(name, value)
        self.end_headers()

    def send(self, path, with_body, fault):
        kind = fault.kind if fault else ""
        file = self.server.owner.folder + urllib.parse.unquote(path)
        if not os.path.isfile(file):
            self.plain(404, {})
            return 404
        with open(file, "rb") as opened:
            data = opened.read()
        etag = f'"{os.stat(file).st_mtime_ns:x}-{len(data):x}"'
        wanted = re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers.get("Range") or "")
        status, headers = 200, {}
        if wanted and kind != "no_ranges":
            first, last = map(int, wanted.groups())
            headers["Content-Range"] = fault.more["says"] if kind == "wrong_range" else f"bytes {first}-{last}/{len(data)}"
            status, data = 206, data[first:last + 1]
        if kind == "etag":
            etag = f'"another-{time.monotonic_ns()}"'
        if kind == "packed":
            data, headers["Content-Encoding"] = gzip.compress(data), "gzip"
        if kind == "long":
            data += bytes(1 << 20)
        self.send_response(status)
        for name, value in {"Content-Length": str(len(data)), "ETag": etag, **headers}.items():
            self.send_header(name, value)
        self.end_headers()
        if with_body:
            self.wfile.write(data[:len(data) // 2] if kind == "cut" else data)
        if kind == "cut":
            self.close_connection = True
        return status


# Faults of answers that are sent: no ranges, a wrong one, another ETag each time, gzip, half of the body, too much of it.
CHANGES = {"no_ranges", "wrong_range", "etag", "packed", "cut", "long"}


class Server:
    """Serves a folder on a free port of this machine."""

    def __init__(self, folder):
        self.folder, self.faults, self.requests, self.lock = folder, [], [], threading.Lock()
        self.open, self.pause = 0, 0
        self.stalled, self.closing = threading.Event(), threading.Event()
        self.http = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.http.owner = self
        self.http.daemon_threads = True
        self.http.handle_error = lambda *_: None  # of clients that go away
        self.url = f"http://127.0.0.1:{self.http.server_address[1]}"
        # Each test has a server of its own, whose end waits for so many seconds.
        self.thread = threading.Thread(target=self.http.serve_forever, args=(0.01,), daemon=True)
        self.thread.start()

    def close(self):
        self.closing.set()
        self.http.shutdown()
        self.http.server_close()
        self.thread.join()

    def asked(self, pattern=".*", method="GET"):
        """The paths that were asked for and match, in order."""
        with self.lock:
            return [r.path for r in self.requests if r.method == method and re.search(pattern, r.path)]
