#!/usr/bin/env bash
# Video and live stream of a real set: what a player and a browser receive when processes die and
# clients misbehave. The run itself is not affected.
. "$(dirname "$0")/lib.sh"
video_probe=$bin/../tests/video_probe/video_probe
fps=20
small=(--set renderer.view=map --set renderer.width=320 --set renderer.height=180)
port=$(python3 -c '
import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')

# of FILE KEY: prints what a player finds in a video. The first call decodes the file.
of() {
    [ -e "$1.json" ] || "$video_probe" "$1" >"$1.json"
    json "$2" <"$1.json"
}
between() { python3 -c "import sys; sys.exit(not $1 <= $2 <= $3)" || { echo "$2 is not from $1 to $3"; return 1; }; }

# --- a run with a video of each kind, and the same without ------------------------------------------
"$jolon" run -w "$name" --json --frames 150 --out one --fps $fps --video-fps $fps --video live.mkv \
    --stream "$port" "${small[@]}" duel >one.json 2>err || sed 's/^/# /' err
"$jolon" run -w "$name" --json --frames 150 --pace max --out none --without renderer --without reporter \
    "${small[@]}" duel >none.json 2>err || sed 's/^/# /' err
check "neither video nor stream changes the digest" equal "$(json digest <one.json)" "$(json digest <none.json)"
check "neither video nor stream changes the events" equal "$(json event_digest <one.json)" "$(json event_digest <none.json)"
check "the video can be played" "$video_probe" live.mkv
check "every picture of the video can be decoded" equal "$(of live.mkv damaged)" 0
check "the video has the size of the pictures" equal "$(of live.mkv width)x$(of live.mkv height)" 320x180
# The upper limit counts from the first picture. A loaded machine draws fewer pictures.
check "the video has the possible number of pictures" between 12 "$(of live.mkv pictures)" 51
check "a second of the video is a second of simulation" between 1.0 "$(of live.mkv last_s)" 2.501
check "the video is complete: its length is known" between "$(of live.mkv last_s)" "$(of live.mkv duration_s)" 2.56
check "the sandbox forbade nothing" bash -c "! grep 'the sandbox forbids' one/jolon.log"
check "only the owner can read the video" equal "$(stat -c %a live.mkv)" 600

# --- from a recording ---------------------------------------------------------------------------------
record() { "$jolon" video --view map --size 321x181 "$@"; }
check "a video is made of the log" record --frames 90 --from 30 --fps 30 one/commands.log some.mp4
check "the video has a picture for every second frame" equal "$(of some.mp4 pictures)" 45
check "the pictures are evenly spaced" between 0.0332 "$(of some.mp4 gap_s)" 0.0335
check "width and height are even" equal "$(of some.mp4 width)x$(of some.mp4 height)" 320x180
check "a video is made of the whole run" record one/commands.log all.mkv
check "that video has a picture for every frame" equal "$(of all.mkv pictures)" 151
check "a video is made for the web" record --frames 12 one/commands.log some.webm
check "that video is encoded as VP8" equal "$(of some.webm codec) $(of some.webm pictures)" "vp8 12"
check "a picture of the last frame is made" record one/commands.log last.png
check "the picture is of the last frame" grep -aq 'frame=150 ' last.png
check "the picture has the requested view" grep -aq 'view=map' last.png
record one/commands.log again.png >again 2>&1
check "the same log gives the same picture" cmp last.png again.png
check "nothing else is left" equal "$(ls ./*.tmp 2>/dev/null)" ""
refuses "an unknown file name extension" 1 'must end in .mkv, .mp4 or .webm' record one/commands.log all.avi
refuses "a frame beyond the end" 2 'known to frame 150' record --from 151 one/commands.log all.mkv
refuses "a log that does not exist" 1 'cannot open' record nothing.log all.mkv
refuses "a folder that does not exist" 1 'cannot make the file' record one/commands.log none/no/all.mkv

# --- kills and clients ----------------------------------------------------------------------------------
"$jolon" start -w "$name" --out two --fps $fps --video two.mkv --stream "$port" "${small[@]}" duel >started 2>&1
check "jolon start names the stream's address" grep -q "stream http://127.0.0.1:$port/" started
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

# One client never reads, and a crowd of clients sends nothing.
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
check "two clients watch while one never reads, and malformed requests are refused" python3 watch.py "$port" 12
refuses_port() {
    "$jolon" run -w "${name}b" --frames 10 --out other --stream "$port" "${small[@]}" duel >refused 2>&1
    grep "goes on without the renderer and keeps trying: renderer refused: --stream $port: cannot listen .* in use" refused
}
check "a port in use is refused with one line" refuses_port
refuses_view() {
    "$jolon" run -w "${name}b" --frames 10 --out other --video no.mkv --video-view chase "${small[@]}" duel >refused 2>&1
    grep "goes on without the renderer and keeps trying: renderer refused: --video-view chase: is not drawn; there is map" refused
}
check "a video of a view that is not drawn is refused with one line" refuses_view
sleep 1.5 # what comes later than a second before the kill may be lost
before=$(pid renderer)
"$jolon" kill -w "$name" renderer >/dev/null
cp two.mkv killed.mkv
check "the video of a killed renderer can be played" between 20 "$(of killed.mkv pictures)" 100000
check "that video has no damaged pictures" equal "$(of killed.mkv damaged)" 0
next_video() { [ -s two-2.mkv ] && [ "$(pid renderer)" != "$before" ]; }
check "the next renderer begins another file" eventually next_video
check "the next renderer streams at the same address" eventually python3 -c "
import urllib.request
urllib.request.urlopen('http://127.0.0.1:$port/map.jpg', timeout=10)"
check "the set stops" "$jolon" stop -w "$name"
check "the first file is unchanged" cmp killed.mkv two.mkv
check "the second file is complete" between 0 "$(of two-2.mkv duration_s)" 100000
check "the sandbox forbade nothing in that run" bash -c "! grep 'the sandbox forbids' two/jolon.log"
check "nothing is left" nothing_left "$name"
done_testing
