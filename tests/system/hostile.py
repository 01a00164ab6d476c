"""Hostile clients of a console and of a live stream. usage: hostile.py CONSOLE_URL STREAM_URL VIEW. Prints "ok WHAT" or
"not ok WHAT" for each check. SEED=n chooses other hostile bytes, FUZZ=n how many requests are damaged on each port (500)."""
import http.client
import json
import os
import random
import resource
import selectors
import socket
import sys
import threading
import time

CROWD = 500  # slow connections on each port
SLOW_S = 4.0  # the shortest test; it lasts until each client was served ENOUGH times
ENOUGH = 5
BOUND_S = 15.0 if os.environ.get("JOLON_SANITIZER") else 5.0  # limit for four successive requests
PATIENCE_S = 60.0
page, token = sys.argv[1].split("#token=")
console = page.rstrip("/").split("//")[1].split(":")
stream = sys.argv[2].rstrip("/").split("//")[1].split(":")
view = sys.argv[3]
seed = int(os.environ.get("SEED", random.randrange(1 << 31)))
print(f"# SEED={seed}")


def check(what, good, why=""):
    print(("ok " if good else "not ok ") + what + ("" if good else f" # {why}"), flush=True)


def link_to(server, timeout=10):
    return http.client.HTTPConnection(server[0], int(server[1]), timeout=timeout)


def get(server, path, link=None):
    """Returns the body of a path that must be answered with 200."""
    fresh = link or link_to(server)
    fresh.request("GET", path)
    answer = fresh.getresponse()
    data = answer.read()
    if link is None:
        fresh.close()
    if answer.status != 200:
        raise OSError(f"{path}: {answer.status} {data[:80]}")
    return data


def given():
    """Returns how long this process has run and how long it has waited for a processor [s]."""
    ran = waited = 0
    for thread in os.listdir("/proc/self/task"):
        try:
            with open(f"/proc/self/task/{thread}/schedstat", encoding="ascii") as file:
                words = file.read().split()
            ran, waited = ran + int(words[0]), waited + int(words[1])
        except OSError:  # the thread has ended, or the kernel keeps no counts
            pass
    return ran / 1e9, waited / 1e9


class Bound:
    """BOUND_S, lengthened on a busy machine by the ratio in which waiting for a processor slows this process."""

    def __init__(self):
        self.begun = given()

    def seconds(self):
        ran, waited = (now - then for now, then in zip(given(), self.begun))
        return BOUND_S * (1 + waited / max(ran, 0.1))


class Client(threading.Thread):
    """Repeats an action. Counts it and its failures, and keeps its longest duration."""

    def __init__(self, what, do, pause):
        super().__init__()
        self.what, self.do, self.pause = what, do, pause
        self.done, self.failed, self.worst, self.ending = 0, [], 0.0, False
        self.start()

    def run(self):
        while not self.ending:
            begun = time.time()
            try:
                self.do()
                self.done += 1
            except (OSError, http.client.HTTPException) as error:
                self.failed.append(repr(error))
            self.worst = max(self.worst, time.time() - begun)
            time.sleep(self.pause)

    def going_on(self, times, bound_s):
        """Allows a few failures: on a loaded machine a new client may be slow enough to be taken for a hostile one."""
        return self.done >= times and len(self.failed) <= self.done // 20 and self.worst < bound_s

    def told(self):
        return f"{self.what}: {self.done} times, the slowest after {1e3 * self.worst:.0f} ms, {len(self.failed)} failed {self.failed[:2]}"


class Watcher:
    """Reads the live stream. Each call of picture() reads one picture."""

    def __init__(self):
        self.link = link_to(stream)
        self.link.request("GET", f"/{view}.mjpeg")
        self.answer = self.link.getresponse()
        if self.answer.status != 200:
            self.link.close()
            raise OSError(f"{self.answer.status}")

    def picture(self):
        fields = {}
        while (line := self.answer.readline().strip()) != b"--picture":
            if not line and self.answer.isclosed():
                raise OSError("the stream ended")
        while (line := self.answer.readline().strip()):
            key, value = line.decode().split(": ")
            fields[key] = value
        if self.answer.read(int(fields["Content-Length"]))[:2] != b"\xff\xd8":
            raise OSError("no picture")


class Crowd(threading.Thread):
    """Slow connections to a server: some send nothing, some send a byte a second, the others send requests and never
    read. Each connection that the server closes is opened again."""
    head = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + b"x" * 1000

    def __init__(self, server, large, endless):
        super().__init__()
        self.server = (server[0], int(server[1]))
        self.asks = [b"", b"", self.ask(large) * 20, self.ask(endless)]
        self.places = selectors.DefaultSelector()
        self.ending, self.came, self.full = False, 0, threading.Event()
        self.start()

    @staticmethod
    def ask(path):
        return f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode()

    def come(self, kind):
        link = socket.socket()
        link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        link.settimeout(5)
        try:
            link.connect(self.server)
            link.setblocking(False)
            link.send(self.asks[kind] or self.head[:1])
        except OSError:
            pass
        self.came += 1
        # The first two kinds are never answered, so anything to read from them is their end.
        self.places.register(link, selectors.EVENT_READ if kind < 2 else selectors.EVENT_WRITE, (kind, [1]))

    def run(self):
        for i in range(CROWD):
            self.come(i % 4)
        self.full.set()
        while not self.ending:
            time.sleep(0.25)
            for key in list(self.places.get_map().values()):
                kind, sent = key.data
                try:
                    if kind == 1 and time.time() % 1 < 0.25:
                        sent[0] += key.fileobj.send(self.head[sent[0]:sent[0] + 1])
                    if kind > 1 and key.fileobj.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 1)[0] == 1:
                        continue  # established: still not read
                    if kind > 1 or key.fileobj.recv(1, socket.MSG_PEEK) != b"x":
                        raise OSError
                except BlockingIOError:
                    continue
                except OSError:
                    self.places.unregister(key.fileobj)
                    key.fileobj.close()
                    self.come(kind)
        for key in list(self.places.get_map().values()):
            key.fileobj.close()


def new_watcher():
    """Returns how long a new client waits for its first picture, requests repeated if necessary [s]."""
    begun = time.time()
    while time.time() < begun + 20:
        try:
            watcher = Watcher()
            watcher.picture()
            watcher.link.close()
            break
        except OSError:
            time.sleep(0.1)
    return time.time() - begun


def fresh():
    get(console, "/")
    get(console, "/api/state?most=10")
    get(stream, "/")
    get(stream, f"/{view}.jpg")


def slow():
    watcher, link, bound = Watcher(), link_to(console), Bound()
    clients = [Client("an open stream's pictures", watcher.picture, 0),
               Client("an open page's state", lambda: get(console, "/api/state?most=10", link), 0.2),
               Client("a new client's pages and picture", fresh, 0.05)]
    crowds = [Crowd(console, "/api/state?most=20000", "/api/picture?view=chase&size=640x360"),
              Crowd(stream, f"/{view}.jpg", f"/{view}.mjpeg")]
    for crowd in crowds:
        crowd.full.wait(30)
    waited = new_watcher()
    time.sleep(SLOW_S)
    until = time.time() + PATIENCE_S
    while any(client.done < ENOUGH for client in clients) and time.time() < until:
        time.sleep(0.1)
    limit_s = bound.seconds()
    for crowd in crowds:
        crowd.ending = True
        crowd.join()
    begun = time.time()
    fresh()
    after = time.time() - begun
    for client in clients:
        client.ending = True
        client.join()
        check(f"{CROWD} slow connections on each port: {client.what} go on",
              client.going_on(ENOUGH, limit_s), client.told())
        print("# " + client.told())
    check("a new client sees the stream", waited < 2 * limit_s, waited)
    check("requests are fast again when the slow connections are gone", after < limit_s, after)
    print(f"# {sum(crowd.came for crowd in crowds)} slow connections came; a new client saw the stream after {waited:.1f} s")


# --- damaged requests --------------------------------------------------------------------------------
good = [(console, b"POST /api/command HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nAuthorization: Bearer " +
         token.encode() + b'\r\nContent-Length: 13\r\n\r\n{"do":"pausf"'),
        (console, b"POST /api/join HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
         b'e\r\n{"name":"Ann"}\r\n0\r\n\r\n'),
        (console, b"GET /api/state?area=1,2,3,4&most=9&me=7 HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Jolon-Player: 00\r\n\r\n"),
        (console, b"GET /api/list?search=a&kind=tank&sort=name&from=3 HTTP/1.1\r\nHost: [::1]:80\r\n\r\nGET / HTTP/1.0\r\n\r\n"),
        (stream, b"GET /picture.jpg?view=chase&vehicle=17&size=64x64&after=1&bar=0 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"),
        (stream, b"GET /map.jpg?x=25000&z=25000.5&metres=4000&size=64x64 HTTP/1.1\r\nHost: localhost:80\r\n\r\n"),
        (stream, b"HEAD /status.json HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"),
        (stream, b"GET /" + view.encode() + b".mjpeg HTTP/1.1\r\nHost: localhost\r\nRange: bytes=0-1\r\n\r\n")]
pieces = [b"\r\n", b"\r\n\r\n", b"\0", b"%00", b"%ff", b"%2e%2e/", b"&", b"=", b"?", b"HTTP/1.1", b"Content-Length: -1\r\n",
          b"Content-Length: 99999999999999999999\r\n", b"Transfer-Encoding: chunked\r\n", b"Expect: 100-continue\r\n",
          b"Host: evil.example\r\n", b"ffffffffffffffff\r\n", b"[" * 3000, b"-1e999", b"x" * 20000, "ü\u061c".encode()]
whole = [b"POST /api/command HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999\r\n\r\n" + b"z" * 100000,
         b"GET /" + b"y" * 100000 + b" HTTP/1.1\r\n\r\n", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + b"x" * 100000]


def damage(rng, data):
    data = bytearray(data)
    for _ in range(rng.randrange(1, 8)):
        at = rng.randrange(len(data) + 1)
        what = rng.randrange(4)
        if what == 0:
            data[at:at] = rng.choice(pieces)
        elif what == 1:
            del data[at:at + rng.randrange(1, 20)]
        elif what == 2:
            data[at:at + 1] = bytes([rng.randrange(256)])
        else:
            data[at:at] = data[rng.randrange(len(data) + 1):][:rng.randrange(1, 40)]
    return bytes(data)


def send(server, data):
    try:
        with socket.create_connection((server[0], int(server[1])), timeout=3) as link:
            link.sendall(data)
            link.settimeout(0.01)
            link.recv(4096)
    except OSError:
        pass


def damaged():
    rng = random.Random(seed)
    commands = json.loads(get(console, "/api/state?most=0"))["tally"]["commands"]
    client, bound = Client("a good client's pages and picture", fresh, 0.1), Bound()
    for data in whole:
        send(console, data)
        send(stream, data)
    for _ in range(2 * int(os.environ.get("FUZZ", 500))):
        server, data = rng.choice(good)
        send(server, damage(rng, data) if rng.random() < 0.9 else rng.randbytes(rng.randrange(1, 400)))
    limit_s = bound.seconds()
    client.ending = True
    client.join()
    check("damaged requests do not stop other clients from being served", client.going_on(2, limit_s), client.told())
    check("no damaged request is a command", json.loads(get(console, "/api/state?most=0"))["tally"]["commands"] == commands)
    print("# " + client.told())


hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, hard), hard))
slow()
damaged()
