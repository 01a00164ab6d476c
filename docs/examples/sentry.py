#!/usr/bin/env python3
"""Drives a vehicle around a square and fires at enemies that come near, by `jolon harness`.

usage: sentry.py [-w WORLD] [--jolon PATH] [--seconds N] [--corners N] [--side METRES] VEHICLE
VEHICLE is an id or a name. Needs only Python's standard library. See docs/examples/README.md.
"""
import argparse
import json
import math
import subprocess
import sys
import threading
import time


class Harness:
    """A world behind a pipe: send() writes a line, lines() yields the lines that come back."""

    def __init__(self, jolon, world):
        self.process = subprocess.Popen([jolon, "harness", "-w", world], text=True, bufsize=1,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.count = 0

    def send(self, **line):
        self.count += 1
        self.process.stdin.write(json.dumps({"id": self.count, **line}) + "\n")
        return self.count

    def lines(self):
        for line in self.process.stdout:
            yield json.loads(line)

    def close(self):
        """Ends the commands. The harness answers all of them, releases the vehicle and ends."""
        self.process.stdin.close()


def towards(entity, x, z):
    """Returns steering and distance to a place. Headings are clockwise from north; z is south."""
    dx, dz = x - entity["position"][0], z - entity["position"][2]
    turn = math.degrees(math.atan2(dx, -dz)) - entity["heading_deg"]
    turn = (turn + 180) % 360 - 180
    return max(-1.0, min(1.0, turn / 45)), math.hypot(dx, dz)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-w", "--world", default="default")
    parser.add_argument("--jolon", default="jolon")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--corners", type=int, default=0, help="end sooner, after so many corners")
    parser.add_argument("--side", type=float, default=60, help="of the square [m]")
    parser.add_argument("vehicle")
    options = parser.parse_args()
    vehicle = int(options.vehicle) if options.vehicle.isdigit() else options.vehicle

    harness = Harness(options.jolon, options.world)
    harness.send(want={"entities": {"near": vehicle, "within_m": 400}, "rate_hz": 10,
                       "events": ["detonation"]})
    timer = threading.Timer(options.seconds, harness.close)
    timer.daemon = True
    timer.start()
    corners, at, passed, fire, reloaded, munitions = None, 0, 0, None, 0.0, set()
    for line in harness.lines():
        if "kinds" in line:
            munitions = {kind["name"] for kind in line["kinds"] if kind["domain"] == "munition"}
        elif "error" in line:
            print("error:", line["error"], file=sys.stderr)
        elif "lost" in line:
            print(f"lost {line['lost']}: {line['because']}", flush=True)
        elif line.get("answer") == fire and fire is not None:
            if line.get("result") == "done":
                print(f"fired in frame {line['frame']}", flush=True)
                reloaded = time.monotonic() + 6
            fire = None
        elif "entities" in line and not harness.process.stdin.closed:
            own = [e for e in line["entities"] if vehicle in (e["id"], e.get("name"))]
            if not own or own[0]["state"] != "active":
                continue
            own = own[0]
            x, _, z = own["position"]
            side = options.side
            corners = corners or [(x, z - side), (x + side, z - side), (x + side, z), (x, z)]
            steer, away = towards(own, *corners[at])
            if away < 15:
                at = (at + 1) % 4
                print(f"corner {at} at {x:.0f},{z:.0f}", flush=True)
                passed += 1
                if passed == options.corners:
                    harness.close()
                    continue
            harness.send(do="drive", vehicle=own["id"], throttle=0.3 if abs(steer) > 0.5 else 0.6,
                         steer=steer)
            foes = [e for e in line["entities"] if e["state"] == "active" and
                    e["force"] not in (own["force"], "neutral") and e["kind"] not in munitions]
            if foes and fire is None and time.monotonic() > reloaded:
                fire = harness.send(do="fire", vehicle=own["id"], target=foes[0]["id"])
    sys.exit(harness.process.wait())


if __name__ == "__main__":
    try:
        main()
    except (BrokenPipeError, ValueError):
        pass  # the pipe was closed between two lines, because the time is over
