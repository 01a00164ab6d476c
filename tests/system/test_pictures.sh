#!/bin/bash
# Requested pictures from a real renderer's socket: any vehicle, view and size, several at once.
# Hostile and slow clients must not affect others, and none of the requests may affect the
# simulation.
. "$(dirname "$0")/lib.sh"
tool=$folder/asks.py
cat >"$tool" <<'EOF'
import os, socket, sys, threading, time

SOCKET = "%s/%s.pictures" % (os.environ["JOLON_RUNTIME_DIR"], sys.argv[1])


def connect():
    s = socket.socket(socket.AF_UNIX)
    s.settimeout(10)
    while True:
        try:
            s.connect(SOCKET)
            return s
        except BlockingIOError:  # the socket's queue is full
            time.sleep(0.01)


class Client:
    """A connection that is kept open."""

    def __init__(self):
        self.file = None

    def get(self, path, method="GET"):
        if self.file is None:
            self.socket = connect()
            self.file = self.socket.makefile("rb")
        self.socket.sendall(("%s %s HTTP/1.1\r\nHost: x\r\n\r\n" % (method, path)).encode())
        status = int(self.file.readline().split()[1])
        head = {}
        while line := self.file.readline().strip():
            key, value = line.split(b": ", 1)
            head[key.decode()] = value.decode()
        body = b"" if method == "HEAD" else self.file.read(int(head.get("Content-Length", 0)))
        if head.get("Connection") == "close":
            self.file = None
        if status == 503 and body in (b"no picture within a second; ask again\n", b"the map is not ready; ask again\n"):
            return self.get(path, method)  # a busy machine
        return status, head, body


def size_of(jpeg):
    """Width and height, of a whole JPEG."""
    assert jpeg[:2] == b"\xff\xd8" and jpeg[-2:] == b"\xff\xd9", "no whole JPEG"
    at = 2
    while jpeg[at + 1] not in (0xC0, 0xC2):
        at += 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
    return int.from_bytes(jpeg[at + 7 : at + 9], "big"), int.from_bytes(jpeg[at + 5 : at + 7], "big")


def watch(query, seconds, result):
    client, number, count, longest, end = Client(), 0, 0, 0.0, time.monotonic() + seconds
    try:
        while time.monotonic() < end:
            begun = time.monotonic()
            status, head, _ = client.get("/picture.jpg?%s&after=%d" % (query, number))
            longest = max(longest, time.monotonic() - begun)
            assert status == 200, status
            count += int(head["X-Picture"]) != number
            number = int(head["X-Picture"])
        result.append((count / seconds, longest))
    except Exception as error:  # a dead thread must fail the test
        result.append((0.0, repr(error)))


def watch_all(queries, seconds):
    results = [[] for _ in queries]
    threads = [threading.Thread(target=watch, args=(q, seconds, r)) for q, r in zip(queries, results)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [result[0] for result in results]


def another(client, query, number):
    """Returns the head of the first picture with another number. A busy machine may need more than the second that an answer waits."""
    for _ in range(60):
        head = client.get("/picture.jpg?%s&after=%d" % (query, number))[1]
        if int(head["X-Picture"]) != number:
            return head
    raise AssertionError("no other picture than %d" % number)


def stalled():
    """Returns how long programs of this machine have waited for a processor [s], 0 where the kernel keeps no count."""
    try:
        with open("/proc/pressure/cpu", encoding="ascii") as file:
            return int(file.readline().split("total=")[1]) / 1e6
    except OSError:
        return 0.0


def refused(path, status, words):
    got, _, body = Client().get(path)
    assert got == status and words in body.decode(), (path, got, body)
EOF
asks() { python3 -c "
import sys
sys.argv = ['', '$name']
exec(open('$tool').read())
$1"; }

"$jolon" run -w "$name" --out out --json hunter-liggett >watched.json 2>err &
run=$!
eventually test -f out/chase.png
has_begun() { [ "$(frame)" -gt 0 ]; }
eventually has_begun
time_begins

check "each view of several vehicles has the requested size" asks '
client = Client()
for vehicle, view, size in ((1, "chase", (640, 360)), (40, "inside", (320, 200)), (101, "orbit", (64, 64)),
                            (200, "overhead", (801, 603)), (300, "chase", (1920, 1080))):
    status, head, body = client.get("/picture.jpg?view=%s&vehicle=%d&size=%dx%d" % (view, vehicle, *size))
    assert status == 200 and size_of(body) == size, (vehicle, status, body[:99])
    assert int(head["X-Picture"]) > 0 and int(head["X-Frame"]) > 0'
check "pictures come with and without the statistics bar" asks '
client = Client()
bar = client.get("/picture.jpg?vehicle=1&size=640x360&bar=1")[2]
bare = client.get("/picture.jpg?vehicle=1&size=640x360&bar=0")[2]
assert size_of(bar) == size_of(bare) and len(bar) > len(bare) + 3000, (len(bar), len(bare))'
check "after=N gives another picture, of a later frame" asks '
client, last = Client(), (0, 0)
for i in range(5):
    head = another(client, "vehicle=2&size=160x120", last[0])
    now = int(head["X-Picture"]), int(head["X-Frame"])
    assert now[0] > last[0] and now[1] > last[1], (last, now)
    last = now'
check "a request without a vehicle shows the followed vehicle" asks '
assert Client().get("/picture.jpg")[0] == 200'
check "maps of the ground are kept" asks '
client = Client()
path = "/map.jpg?x=20000&z=30000&metres=5000&size=500x400"
status, _, first = client.get(path)
assert status == 200 and size_of(first) == (500, 400)
begun = time.monotonic()
assert client.get(path)[2] == first and time.monotonic() - begun < 0.5
assert client.get("/map.jpg?x=20500&z=30000&metres=5000&size=500x400")[2] != first
for where in ("x=-100000&z=100000&metres=100", "x=0&z=0&metres=200000&size=1920x1080", "x=1e5&z=-1e5&metres=137.77"):
    assert client.get("/map.jpg?" + where)[0] == 200, where'
check "wrong requests are refused with the reason" asks '
refused("/picture.jpg?vehicle=4000000000", 404, "there is no vehicle 4000000000, or no more")
refused("/picture.jpg?view=map", 400, "view=map: is chase, inside, orbit or overhead")
refused("/picture.jpg?size=10000x10000", 400, "from 64x64 to 1920x1080")
refused("/picture.jpg?vehicle=%2e%2e%2f%00%ff", 400, "vehicle=../: is a vehicle")
refused("/picture.jpg?" + "&".join("a%d=1" % i for i in range(50)), 400, "a0 is none of")
refused("/map.jpg?metres=nan", 400, "metres across the map, from 100 to 200000")
refused("/../../etc/passwd", 404, "there is /,")
assert Client().get("/picture.jpg?vehicle=1", "POST")[0] == 405'
check "a ninth different picture is refused, but only for a short time" asks '
time.sleep(2.1)
eight = threading.Thread(target=lambda: watched.extend(
    watch_all(["vehicle=%d&size=64x64" % i for i in range(60, 68)], 3)))
watched = []
eight.start()
time.sleep(1)
refused("/picture.jpg?vehicle=99", 503, "8 different pictures are drawn already")
assert Client().get("/picture.jpg?vehicle=60&size=64x64")[0] == 200
eight.join()
assert all(rate > 0 for rate, _ in watched), watched
time.sleep(2.1)
assert Client().get("/picture.jpg?vehicle=99")[0] == 200'
check "noise and clients that do not read stop no other client" asks '
import random
random.seed(1)
idle = []
for i in range(20):
    s = connect()
    s.sendall(bytes(random.randrange(256) for _ in range(300)) if i % 2 else b"GET /picture.jpg?size=1920x1080 HTTP/1.1\r\n")
    idle.append(s)
for i in range(6):
    s = connect()
    s.sendall(b"GET /chase.mjpeg HTTP/1.1\r\nHost: x\r\n\r\n" if i % 2 else b"GET /picture.jpg?size=1920x1080 HTTP/1.1\r\nHost: x\r\n\r\n")
    idle.append(s)
rate, longest = watch_all(["vehicle=3&size=320x200"], 1.5)[0]
assert rate > 0, (rate, longest)'
check "one client watches, then four" asks '
one = watch_all(["vehicle=5"], 1.5)
four = watch_all(["vehicle=5", "vehicle=90&view=inside", "vehicle=150&view=orbit", "vehicle=250&view=overhead"], 1.5)
print("pictures a second, longest wait [s]: one", one, "four", four)
assert all(rate > 0 for rate, _ in one + four), (one, four)'
grep pictures check | sed 's/^/# /'
check "the renderer gives pictures again after a kill" asks '
import subprocess
subprocess.run(["'"$jolon"'", "kill", "-w", "'"$name"'", "renderer"], check=True, stdout=subprocess.DEVNULL)
begun, stalled_before = time.monotonic(), stalled()
while True:
    try:
        if Client().get("/picture.jpg?vehicle=5")[0] == 200:
            break
    except (OSError, IndexError, ValueError):
        pass
    took = time.monotonic() - begun
    assert took < 60 and took - (stalled() - stalled_before) < 5
    time.sleep(0.01)
print("a picture %.2f s after the kill" % (time.monotonic() - begun))'
grep "after the kill" check | sed 's/^/# /'
check "clients make no frames late" in_time "frames / 20"
"$jolon" stop -w "$name" >stopped 2>&1
wait $run || sed 's/^/# /' err
frames=$(json frame <watched.json)
"$jolon" run -w "$name" --frames $frames --pace max --without renderer --out quiet --json hunter-liggett >quiet.json 2>err
check "clients do not change the digest" equal "$(json digest <watched.json)" "$(json digest <quiet.json)"
done_testing
