"""Experiments with sets of processes that are started as a user starts them."""
import http.client
import json
import os
import re
import socket
import threading

from compare.build import line_of_log, read, scrub, scrub_lines, wait_for, write
from compare.played import replay

# Parts of a set's log that depend on the clock, on chance and on the order of the processes.
NUMBERS = re.compile(r"\b[0-9a-f]{16}\b|\d+(\.\d+)?")
VIEWS = ("/picture.jpg?view=chase&size=320x180", "/picture.jpg?view=orbit&vehicle=6&size=320x180",
         "/picture.jpg?view=inside&vehicle=5&size=320x180&bar=0",
         "/picture.jpg?view=overhead&vehicle=2&size=640x360",
         "/map.jpg?x=25000&z=25000&metres=3000&size=320x240",
         "/map.jpg?x=25000&z=25000&metres=200000&size=200x200",
         "/picture.jpg?view=sideways", "/picture.jpg?view=chase&vehicle=999", "/nothing", "/",
         "/map.jpg?x=1&z=2&metres=3")
PAGES = ("/", "/app.js", "/nothing", "/api/world", "/api/state?area=24000,24000,26000,26000&most=50",
         "/api/state?me=5", "/api/list?sort=speed&descending=1", "/api/list?search=t&force=blue",
         "/api/events", "/api/events?types=drive", "/api/list?sort=nothing", "/api/nothing",
         "/api/picture?view=overhead&vehicle=5&size=320x180",
         "/api/map?x=25000&z=25000&metres=4000&size=320x240")
ORDERS = ("spawn tank --at 25010,24950 --force blue --heading 90 --speed 5",
          "spawn helicopter --at 25050,24950 --force red --altitude 40 --behaviour patrol --json",
          "spawn ship --at 25050,24950", "spawn tree --at 25050,24950",
          "drive Tank --throttle 1 --steer 0.2 --gear low", "drive Jeep --throttle -0.5 --brake 0.1",
          "drive nobody --throttle 1", "drive 5 --throttle 3", "fire Tank --target Scout-1",
          "fire Carrier", "fire Nobody", "fire Tank --target Nobody",
          "fire --munition bomb --at 24950,25200 --json", "fire --munition tree --at 24950,25200",
          "fire --munition artillery --at 24960,25010 --radius 50 --seed 4",
          "release Jeep", "release Jeep", "remove Wishbone", "remove Wishbone --json", "scale 50",
          "scale 500", "step 0")
LINES = ({"id": 1, "do": "spawn", "kind": "jeep", "x": 25100, "z": 25200, "force": "red"},
         {"id": 2, "do": "drive", "vehicle": "Tank", "throttle": 2},
         {"id": 3, "do": "fire", "vehicle": "Tomato"}, {"id": "four", "do": "jump"}, {"do": "remove"},
         {"id": 5, "do": "mission", "munition": "shell", "x": 24990, "z": 25040, "seed": 9},
         {"id": 6, "do": "remove", "vehicle": 4711}, [1, 2], {"id": 7, "do": "step", "frames": 3},
         {"id": 8, "do": "step"}, {"id": 9, "want": {"entities": ["Nobody"]}})


def log_lines(build, path):
    """Returns the different kinds of lines in the log of a set."""
    lines = build.mask(read(path).decode(errors="replace")).splitlines()
    return "\n".join(sorted({NUMBERS.sub("N", line) for line in lines}))


def calm_set(name, scenario, frames, *options):
    """A set without commands at the highest pace, with every role and an image of its end."""
    def run(build):
        folder = "%s/%s" % (build.work, name)
        out = build.run("jolon", "run", "-w", name, "--json", "--pace", "max", "--frames", frames,
                        "--domain", build.domain, "--out", folder, "--events", folder + ".events",
                        "--checkpoint", folder + ".image", "--every", 100,
                        "--set", "renderer.backend=soft", "--set", "renderer.fps=0",
                        "--set", "renderer.width=480", "--set", "renderer.height=270",
                        *options, build.scenario(scenario))
        found = {("state", "summary"): json.dumps(scrub(json.loads(out))),
                 ("commands", "log"): build.masked_log(folder + "/commands.log"),
                 ("events", "log"): read(folder + ".events"),
                 ("lines of jolon.log", name): log_lines(build, folder + "/jolon.log")}
        # Fires and tracks depend on the frames that the renderer has read.
        found["state", "files"] = "\n".join(sorted(os.listdir(folder)))
        return found
    return run


class UnixConnection(http.client.HTTPConnection):
    def __init__(self, path):
        super().__init__("x", timeout=20)
        self.path = path

    def connect(self):
        self.sock = socket.socket(socket.AF_UNIX)
        self.sock.settimeout(20)
        self.sock.connect(self.path)


def ask(connection, path, posted=None, **headers):
    """Returns status, content type and body of an answer. Random values are removed from JSON."""
    connection.request("POST" if posted else "GET", path, body=posted and json.dumps(posted),
                       headers=headers)
    answer = connection.getresponse()
    body, kind = answer.read(), answer.getheader("Content-Type") or ""
    connection.close()
    if kind.startswith("application/json"):
        body = json.dumps(scrub(json.loads(body))).encode()
    return b"%d %s\n" % (answer.status, kind.encode()) + body


def ask_picture(connection, path):
    """A picture of a paused world. The first answer may lack details for want of time, and later ones
    have them. Two equal pictures in a row are therefore complete."""
    answers = [ask(connection, path) for _ in range(2)]
    while len(answers) < 20 and (len(answers) < 3 or answers[-1] != answers[-2]):
        answers.append(ask(connection, path))
    return answers[-1]


def harness(build, name):
    """Sends lines one after the other, each after the answer to the previous one. Returns the answers."""
    process = build.start("jolon-harness", "-w", name, "--domain", build.domain, stdin=-1, stdout=-1,
                          stderr=-1, text=True, bufsize=1)
    watchdog = threading.Timer(60, process.kill)
    watchdog.start()
    answers = [process.stdout.readline()]
    for line in LINES:
        process.stdin.write(json.dumps(line) + "\n")
        answers.append(process.stdout.readline())
    out, err = process.communicate()
    watchdog.cancel()
    build.started.remove(process)
    return scrub_lines("".join(answers) + out + err)


def monitor(build, name, status):
    """Returns what a monitor shows of a paused world. Topics are independent, so its first lines may
    hold entities of an earlier frame."""
    process = build.start("jolon-monitor", "-w", name, "--domain", build.domain, "--json", "--rate", 10,
                          "--filter", "blue tank", stdout=-1, text=True)
    watchdog = threading.Timer(60, process.kill)
    watchdog.start()
    lines = [""]
    for line in process.stdout:
        seen = scrub(json.loads(line))
        lines.append(json.dumps(seen))
        entities = status["vehicles"] + status["munitions"]
        if seen["commit"] == status["commit"] and seen.get("entities") == entities and \
                lines[-10:].count(lines[-1]) == 10:
            break
    watchdog.cancel()
    build.stop(process, "jolon-monitor")
    return lines[-1]


def console(build, name, found):
    """Returns the console's answers to queries and posts while the world is paused."""
    token = build.work + "/token"
    process = build.start("jolon-console", "-w", name, "--port", 0, "--token-file", token, stdout=-1,
                          stderr=-2, text=True)
    address = re.search(r"127\.0\.0\.1:(\d+)", process.stdout.readline())
    connection = http.client.HTTPConnection("127.0.0.1", int(address[1]), timeout=20)
    threading.Thread(target=process.stdout.read, daemon=True).start()
    ready = lambda: ask(connection, "/api/world").startswith(b"200")
    wait_for(ready, "the world in the console")
    for page in PAGES:
        get = ask_picture if "size=" in page else ask
        found["answers", "console " + page] = get(connection, page)
    secret = {"Authorization": "Bearer " + read(token).decode().strip(),
              "Content-Type": "application/json"}
    posts = (("/api/join", {"name": "Ann"}), ("/api/join", {"name": ""}),
             ("/api/command", {"do": "spawn", "kind": "truck", "x": 24900, "z": 25300}),
             ("/api/command", {"do": "spawn", "kind": "truck"}),
             ("/api/command", {"do": "fire", "vehicle": "Nobody"}), ("/api/command", {"do": "sing"}),
             ("/api/process", {"do": "restart", "role": "nobody"}), ("/api/command", {"do": "step"}))
    for number, (path, body) in enumerate(posts):
        found["answers", "console %s %d" % (path, number)] = ask(connection, path, body, **secret)
    found["answers", "console without token"] = ask(connection, "/api/command", {"do": "pause"},
                                                    **{"Content-Type": "application/json"})
    build.stop(process, "jolon-console")


def pause_first(build, name, made_of):
    """Makes a world and puts `pause` into its command ring before the roles start. Its first frame
    applies it, so each later command has a frame of its own."""
    build.world("create", "--world", name, *made_of)
    intake = build.start("jolon-intake", "--world", name)
    wait_for(lambda: build.world("pid", "--world", name, "intake", status=None).startswith("exit 0"),
             "an intake")
    build.run("jolon-ctl", "-w", name, "--timeout", 0.5, "pause", status=1)
    build.stop(intake, "jolon-intake")


def settled(build, name, least=0):
    """Waits until a paused world has stopped stepping, at that frame or later. Returns its frame. The
    frame of a command sent during a step would depend on timing."""
    seen = []

    def stands():
        seen.append(int(build.world("frame", "--world", name)))
        return seen[-1] >= least and seen[-20:].count(seen[-1]) == 20
    wait_for(stands, "frame %d and a world that stands still" % least, 60)
    return seen[-1]


def with_own_keys(log):
    """Copies a log of commands and replaces the senders' random keys by counters."""
    keys, lines = {}, []
    for line in read(log).decode().splitlines():
        record = json.loads(line)
        del record["check"]
        if "source" in record:
            record["source"] = "%016x" % keys.setdefault(record["source"], len(keys) + 1)
        if record["type"] in ("begin", "command"):
            lines.append(line_of_log(record))
    write(log + ".counted", "".join(lines))
    return log + ".counted"


def commanded_set(name, steps):
    """A set that is paused except for commands and steps, observed through every program. Its digests
    depend on the senders' keys, so the digests of its log with other keys are compared."""
    def run(build):
        folder, found = "%s/%s" % (build.work, name), {}
        made_of = ["--set", "renderer.backend=soft", "--set", "renderer.hold=false",
                   "--set", "renderer.width=480", "--set", "renderer.height=270",
                   build.scenario("proving-ground")]
        world = lambda *words: build.world(*words, "--world", name)
        pause_first(build, name, made_of)
        build.run("jolon", "start", "-w", name, "--domain", build.domain, "--out", folder,
                  "--events", folder + ".events", *made_of)
        wait_for(lambda: json.loads(world("status", "--json"))["commit"] == 1, "the first frame")
        runtime = world("paths", "name").strip()
        wait_for(lambda: os.path.exists(runtime + ".pictures"), "the socket of pictures")
        for view in VIEWS:
            found["pictures", view] = ask_picture(UnixConnection(runtime + ".pictures"), view)
        for options in ("chase,map", "inside,overhead", "orbit:3,free"):
            path = "%s-%s.png" % (folder, options.replace(",", "-").replace(":", "-"))
            build.run("jolon", "snap", "-w", name, "--size", "400x225", "--view", options, path)
            for picture in sorted(os.listdir(build.work)):
                if picture.startswith(os.path.basename(path)[:-4]):
                    found["pictures", "snap " + picture] = read(build.work + "/" + picture)
        for number, order in enumerate(ORDERS):
            found["answers", "ctl %d %s" % (number, order)] = build.run(
                "jolon", "ctl", "-w", name, *order.split(), status=None)
        settled(build, name)
        found["answers", "harness"] = harness(build, name)
        settled(build, name)
        console(build, name, found)
        last = settled(build, name) + steps
        build.run("jolon", "ctl", "-w", name, "step", steps)
        settled(build, name, last)
        for words in (["dump", "--json"], ["dump"], ["info"], ["events"], ["events", "--json"],
                      ["events", "--json", "--from", "30"], ["digest", "--json"]):
            out = world(*words)
            out = re.sub(r"\b[0-9a-f]{16}\b", "KEY", out) if words == ["events"] else out
            found["state", " ".join(words)] = scrub_lines(out, {"digest", "event_digest"})
        found["state", "status"] = json.dumps(scrub(json.loads(world("status", "--json"))))
        found["answers", "monitor"] = monitor(build, name, json.loads(world("status", "--json")))
        found["answers", "quit"] = build.run("jolon", "ctl", "-w", name, "quit", status=None)
        wait_for(lambda: name not in build.world("list", status=None), "the end of the set")
        log, digests = folder + "/commands.log", {"digest", "event_digest"}
        found["commands", "log"] = build.masked_log(log, digests)
        found["events", "log"] = scrub_lines(read(folder + ".events").decode())
        found["lines of jolon.log", name] = log_lines(build, folder + "/jolon.log")
        equal = json.loads(build.world("replay", "--json", log))["equal"]
        found["digests", "its log is played to the same end"] = str(equal)
        played = replay(build, with_own_keys(log), last)
        found["digests", "run"] = "frame %(frame)d, digest %(digest)s, of events %(event_digest)s" % \
            played
        return found
    return run
