#!/usr/bin/env bash
# Video and live stream of a real set: what a player and a browser get, when things die and clients
# misbehave; and the run knows nothing of it.
. "$(dirname "$0")/lib.sh"
film=$bin/../tests/film/film
fps=20
small=(--set renderer.view=map --set renderer.width=320 --set renderer.height=180)
port=$(python3 -c '
import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')

# What a player finds in a file: of FILE KEY. The first look decodes it.
of() {
    [ -e "$1.json" ] || "$film" "$1" >"$1.json"
    json "$2" <"$1.json"
}
between() { python3 -c "import sys; sys.exit(not $1 <= $2 <= $3)" || { echo "$2 is not from $1 to $3"; return 1; }; }

# --- a run with a video of each kind, and the same without ------------------------------------------
"$jolon" run -w "$name" --json --frames 150 --out one --fps $fps --video-fps $fps --video live.mkv \
    --stream "$port" "${small[@]}" duel >one.json 2>err || sed 's/^/# /' err
"$jolon" run -w "$name" --json --frames 150 --pace max --out none --without renderer --without reporter \
    "${small[@]}" duel >none.json 2>err || sed 's/^/# /' err
check "neither video nor stream changes the digest" equal "$(json digest <one.json)" "$(json digest <none.json)"
check "nor the events" equal "$(json event_digest <one.json)" "$(json event_digest <none.json)"
check "the video can be played" "$film" live.mkv
check "all of it" equal "$(of live.mkv damaged)" 0
check "it has the size of the pictures" equal "$(of live.mkv width)x$(of live.mkv height)" 320x180
# From its first picture on, at most so many; a loaded machine draws fewer.
check "and as many pictures as there is time for" between 12 "$(of live.mkv pictures)" 51
check "a second of it is one of simulation" between 1.0 "$(of live.mkv last_s)" 2.501
check "it is complete: its length is known" between "$(of live.mkv last_s)" "$(of live.mkv duration_s)" 2.56
check "the sandbox forbade nothing" bash -c "! grep 'the sandbox forbids' one/jolon.log"
check "it is its owner's alone" equal "$(stat -c %a live.mkv)" 600

# --- from a recording ---------------------------------------------------------------------------------
record() { "$jolon" video --view map --size 321x181 "$@"; }
check "a video is made of the log" record --frames 90 --from 30 --fps 30 one/commands.log some.mp4
check "with a picture for every second frame" equal "$(of some.mp4 pictures)" 45
check "evenly" between 0.0332 "$(of some.mp4 gap_s)" 0.0335
check "of even sides" equal "$(of some.mp4 width)x$(of some.mp4 height)" 320x180
check "of all of the run" record one/commands.log all.mkv
check "with a picture for every frame" equal "$(of all.mkv pictures)" 151
check "and for the web" record --frames 12 one/commands.log some.webm
check "as VP8" equal "$(of some.webm codec) $(of some.webm pictures)" "vp8 12"
check "its last picture alone" record one/commands.log last.png
check "is of the last frame" grep -aq 'frame=150 ' last.png
check "in the view asked for" grep -aq 'view=map' last.png
record one/commands.log again.png >again 2>&1
check "and the same from the same log" cmp last.png again.png
check "nothing else is left" equal "$(ls ./*.tmp 2>/dev/null)" ""
refuses "another ending" 1 'must end in .mkv, .mp4 or .webm' record one/commands.log all.avi
refuses "a frame that is not there" 2 'known to frame 150' record --from 151 one/commands.log all.mkv
refuses "no log" 1 'cannot open' record nothing.log all.mkv
refuses "a folder that is not there" 1 'cannot make the file' record one/commands.log none/no/all.mkv

# --- killed, and watched --------------------------------------------------------------------------------
"$jolon" start -w "$name" --out two --fps $fps --video two.mkv --stream "$port" "${small[@]}" duel >started 2>&1
check "where the stream is, is said" grep -q "stream http://127.0.0.1:$port/" started
eventually test -s two/map.png
cat >watch.py <<'P'
import http.client, json, socket, struct, sys, threading, time
port, wanted = int(sys.argv[1]), int(sys.argv[2])

def get(path, method="GET", headers={}):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.request(method, path, headers=headers)
    answer = connection.getresponse()
    return answer, answer.read()

def raw(text):
    with socket.create_connection(("127.0.0.1", port), timeout=10) as s:
        s.sendall(text)
        return s.recv(4096)

def size(jpeg):
    assert jpeg[:2] == b"\xff\xd8" and jpeg[-2:] == b"\xff\xd9", jpeg[:20]
    at = 2
    while jpeg[at + 1] not in (0xc0, 0xc2):
        at += 2 + struct.unpack(">H", jpeg[at + 2:at + 4])[0]
    height, width = struct.unpack(">HH", jpeg[at + 5:at + 9])
    return width, height

class Watcher(threading.Thread):
    frames, error = (), None
    def run(self):
        try:
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
            connection.request("GET", "/map.mjpeg")
            answer = connection.getresponse()
            assert answer.status == 200 and "multipart/x-mixed-replace" in answer.getheader("Content-Type")
            for _ in range(wanted):
                while answer.readline().strip() != b"--picture":
                    pass
                fields = {}
                while (line := answer.readline().strip()):
                    key, value = line.decode().split(": ")
                    fields[key] = value
                assert size(answer.read(int(fields["Content-Length"]))) == (320, 180)
                self.frames += (int(fields["X-Frame"]),)
        except Exception as error:
            self.error = error

# One that never reads, and a crowd that says nothing.
sleeper = socket.create_connection(("127.0.0.1", port))
sleeper.sendall(b"GET /map.mjpeg HTTP/1.1\r\nHost: localhost\r\n\r\n")
watchers = [Watcher(), Watcher()]
for watcher in watchers:
    watcher.start()
for garbage in (b"GET /\r\n\r\n", b"GET  HTTP/1.1\r\n\r\n", b"GET / HTTP/9\r\n\r\n", b"GET / HTTP/1.1\r\nbad\r\n\r\n",
                b"GET / HTTP/1.1\r\nContent-Length: x\r\nHost: localhost\r\n\r\n"):
    assert raw(garbage).startswith(b"HTTP/1.1 400"), (garbage, raw(garbage))
for garbage in (b"garbage\r\n\r\n", b"GET\r\n\r\n"):
    assert raw(garbage) == b"", garbage # not even a request: hung up on
for garbage in (bytes(range(256)) * 8, b"\0" * 100000, b"GET /" + b"a" * 100000):
    try:
        raw(garbage + b"\r\n\r\n")
    except OSError:
        pass  # closed at once
for method in ("POST", "PUT", "DELETE", "OPTIONS", "BREW"):
    answer, _ = get("/", method)
    assert answer.status == 405 and answer.getheader("Allow") == "GET, HEAD", (method, answer.status)
for path in ("/no.mjpeg", "/../../etc/passwd", "/.jpg", "/map", "/" + "x" * 500):
    assert get(path)[0].status == 404, path
assert get("/", headers={"Host": "evil.example"})[0].status == 403
assert get("/", headers={"Host": "localhost.evil.example"})[0].status == 403
assert get("/", headers={"Host": "localhost:%d" % port})[0].status == 200
page = get("/")[1].decode()
assert 'src="/map.mjpeg"' in page and "http" not in page.replace("http-equiv", ""), page
answer, jpeg = get("/map.jpg")
assert answer.status == 200 and answer.getheader("Content-Type") == "image/jpeg" and size(jpeg) == (320, 180)
assert get("/map.jpg", "HEAD")[1] == b""
for watcher in watchers:
    watcher.join(30)
    assert watcher.error is None, watcher.error
    assert len(watcher.frames) == wanted, "%d pictures of %d" % (len(watcher.frames), wanted)
    assert list(watcher.frames) == sorted(watcher.frames)
status = json.loads(get("/status.json")[1])
view = status["views"][0]
assert view["view"] == "map" and (view["width"], view["height"]) == (320, 180), view
assert 0 < view["encoded"] <= view["drawn"], view
crowd = []
for _ in range(60):
    try:
        crowd.append(socket.create_connection(("127.0.0.1", port), timeout=1))
    except OSError:
        break
for client in crowd:
    client.close()
for _ in range(100):
    try:
        assert get("/status.json")[0].status == 200
        break
    except OSError:
        time.sleep(0.05)
else:
    sys.exit("it does not answer after a crowd")
P
check "two watch while one never reads, and what is malformed is refused" python3 watch.py "$port" 12
refuses_port() {
    "$jolon" run -w "${name}b" --frames 10 --out other --stream "$port" "${small[@]}" duel >refused 2>&1
    grep "goes on without the renderer and keeps trying: renderer refused: --stream $port: cannot listen .* in use" refused
}
check "a port that is in use is refused in a clear line" refuses_port
refuses_view() {
    "$jolon" run -w "${name}b" --frames 10 --out other --video no.mkv --video-view chase "${small[@]}" duel >refused 2>&1
    grep "goes on without the renderer and keeps trying: renderer refused: --video-view chase: is not drawn; there is map" refused
}
check "so is a video of a view that is not drawn" refuses_view
sleep 1.5 # what comes later than a second before the kill may be lost
before=$(pid renderer)
"$jolon" kill -w "$name" renderer >/dev/null
cp two.mkv killed.mkv
check "killed -9, what there is can be played" between 20 "$(of killed.mkv pictures)" 100000
check "without damage" equal "$(of killed.mkv damaged)" 0
next_film() { [ -s two-2.mkv ] && [ "$(pid renderer)" != "$before" ]; }
check "the next renderer begins another file" eventually next_film
check "and streams at the same place" eventually python3 -c "
import urllib.request
urllib.request.urlopen('http://127.0.0.1:$port/map.jpg', timeout=10)"
check "the set stops" "$jolon" stop -w "$name"
check "the first file is as it was" cmp killed.mkv two.mkv
check "the other is complete" between 0 "$(of two-2.mkv duration_s)" 100000
check "the sandbox forbade nothing there either" bash -c "! grep 'the sandbox forbids' two/jolon.log"
check "nothing is left" nothing_left "$name"
done_testing
