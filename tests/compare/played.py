"""Runs of `jolon-world replay` in one process, from logs of commands that are written here, and their
pictures and videos by jolon-video."""
import json

from compare.build import line_of_log, read, scrub, write
from compare.cases import CODES


def record(build, command, number):
    kind = build.kinds.index(command.kind) if command.kind else 65535
    return {"frame": command.frame, "events": 0, "commands": number, "type": "command",
            "ring": command.ring, "source": "%016x" % command.source, "sequence": "%016x" % number,
            "command": command.name, "code": CODES[command.name], "entity": command.entity,
            "target": command.target, "amount": command.amount, "kind": kind,
            "force": command.force, "value": list(command.value), "result": "done"}


def write_log(build, case, path, first):
    """Writes a log of the case's commands without an end, so that a replay may run any number of frames."""
    commands = sorted(case.commands, key=lambda command: command.frame)
    lines = [line_of_log(record(build, one, number + 1)) for number, one in enumerate(commands)]
    write(path, first + "".join(lines))


def replay(build, path, frames, threads=1, *options):
    return json.loads(build.world("replay", "--json", "--frames", frames, "--threads", threads,
                                  *options, path))


def end_log(path, played, events):
    """Adds the end of the replayed run to the log: jolon-video reads its length and compares its digests."""
    end = {"frame": played["frame"], "events": events, "commands": played["commands"], "type": "end",
           "digest": played["digest"], "event_digest": played["event_digest"]}
    with open(path, "a", encoding="utf-8") as log:
        log.write(line_of_log(end))


def dumps(build, name, found):
    for kind in ("info", "digest", "dump"):
        found["state", kind] = build.world(kind, "--json", "--world", name)
    found["state", "check"] = build.world("check", "--world", name)
    found["state", "fixed objects"] = build.world("dump", "--json", "--fixed", "--world", name)
    found["state", "ground"] = build.world("dump", "--terrain", "0,0,50000,50000,401.7", "--world",
                                           name)


def draw(build, log, number, options, found):
    path = "%s-%d.png" % (log, number)
    build.run("jolon-video", "--backend", "soft", "--threads", 1 + number % 2, "--size", "480x270",
              *options.split(), log, path)
    found["pictures", options] = read(path)


def play_case(case):
    """Runs a case on a build. Returns its results by kind and name: {("digests", "frame 600"): ..., ...}."""
    def play(build):
        found, log = {}, "%s/%s.log" % (build.work, case.name)
        sets = [argument for one in case.sets for argument in ("--set", one)]
        made_of = [*sets, build.scenario(case.scenario)]
        first = build.begin(case.name, log, case.dump and (lambda: dumps(build, case.name, found)),
                            *made_of)
        begin = json.loads(first)
        build.layouts.add(begin["layout"])
        found["commands", "begin"] = build.mask(json.dumps(scrub(begin)))
        write_log(build, case, log, first)
        events = log + ".events"
        played = replay(build, log, case.frames, case.threads, "--events", events)
        found["events", "log"] = read(events)
        found["digests", "run"] = "frame %(frame)d, %(commands)d commands, digest %(digest)s, of " \
                                  "events %(event_digest)s" % played
        end_log(log, played, found["events", "log"].count(b"\n"))
        for number, options in enumerate(case.pictures):
            draw(build, log, number, options, found)
        return found
    return play


def first_other_frame(builds, case):
    """Returns the first frame whose digest differs, by bisection: the builds agree on all frames before
    it and on none after it."""
    def digests(frame):
        return [replay(build, build.work + "/halves.log", frame)["digest"] for build in builds]
    for build in builds:
        first = read("%s/%s.log" % (build.work, case.name)).decode().splitlines(True)[0]
        write_log(build, case, build.work + "/halves.log", first)
    low, high = 0, case.frames
    while low < high:
        middle = (low + high) // 2
        old, new = digests(middle) if middle else (0, 0)
        low, high = (middle + 1, high) if old == new else (low, middle)
    return low


def videos(log_of):
    """Makes a short video of each format from a replayed run."""
    def make(build):
        found, log = {}, "%s/%s.log" % (build.work, log_of)
        for ending, frames in (("mkv", 40), ("mp4", 40), ("webm", 8)):
            path = "%s/video.%s" % (build.work, ending)
            build.run("jolon-video", "--backend", "soft", "--size", "320x180", "--view", "chase",
                      "--frames", frames, log, path)
            found["videos", ending] = read(path)
        path = build.work + "/smooth.mkv"
        build.run("jolon-video", "--backend", "soft", "--size", "320x180", "--view", "inside",
                  "--from", 100, "--frames", 12, "--fps", 50, log, path)
        found["videos", "between frames"] = read(path)
        return found
    return make


def resumed(image, name, frames):
    """Continues a run from an image that the old build has saved."""
    def go_on(build):
        log = "%s/resumed-%s.log" % (build.work, name)
        made_of = ["--from", image, "--set", "world.frames=%d" % frames]
        try:
            first = build.begin("resumed-" + name, log, None, *made_of)
        except RuntimeError:
            refusal = build.world("create", "--world", "refused-" + name, *made_of, status=None)
            return {("images", "refusal"): refusal}
        write(log, first)
        played = replay(build, log, frames)
        return {("images", "run from the old image"): "frame %(frame)d, digest %(digest)s, of "
                "events %(event_digest)s" % played,
                ("images", "replay-frame"): build.mask(build.world("replay-frame", image))}
    return go_on
