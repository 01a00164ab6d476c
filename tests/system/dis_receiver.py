"""A receiver of DIS that nobody here wrote could look like this: it shows every entity where its dead reckoning has it, and compares
that with the world while it runs.

usage: dis_receiver.py PORT JOLON-WORLD WORLD SECONDS DELAY-MS

It receives at 127.0.0.1:PORT, leaves out PDUs that are not younger than what it has (by their time stamps), and extrapolates from their
arrival. Meanwhile it dumps the world again and again. An error is allowed that is the threshold of 1 m, and what the vehicle drives in
the delay, in a frame and in half of the time that the dump took. Prints the errors, and exits with 1 if more than 1 % of all, or of those of
vehicles that move, are larger.

The mathematics is this program's own: IEEE 1278.1-2012 annex E for the models 1 to 5, with Python's library."""
import json
import math
import socket
import struct
import subprocess
import sys
import threading
import time

SQUARE_M, FRAME_S, THRESHOLD_M = 50000.0, 1 / 60, 1.0
LATITUDE, LONGITUDE, UNDULATION = math.radians(35.95), math.radians(-121.25), -33.7
HALF_HOUR = 1 << 30  # in units of the upper 31 bits


class Frame:
    def __init__(self):
        e2 = (2 - 1 / 298.257223563) / 298.257223563
        sin_lat, cos_lat, sin_lon, cos_lon = (f(a) for a in (LATITUDE, LONGITUDE) for f in (math.sin, math.cos))
        radius = 6378137 / math.sqrt(1 - e2 * sin_lat ** 2)
        self.origin = ((radius + UNDULATION) * cos_lat * cos_lon, (radius + UNDULATION) * cos_lat * sin_lon,
                       (radius * (1 - e2) + UNDULATION) * sin_lat)
        self.east = (-sin_lon, cos_lon, 0)
        self.north = (-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat)
        self.up = (cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)

    def ecef(self, place):
        x, y, z = place[0] - SQUARE_M / 2, place[1], place[2] - SQUARE_M / 2
        return tuple(self.origin[i] + x * self.east[i] - z * self.north[i] + y * self.up[i] for i in range(3))


class Receiver(threading.Thread):
    """known: of each entity its time stamp, its arrival and what it said."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.ear = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.ear.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self.ear.bind(("127.0.0.1", port))
        self.known, self.came, self.older, self.lock = {}, 0, 0, threading.Lock()

    def run(self):
        while True:
            data = self.ear.recv(65536)
            now = time.monotonic()
            if len(data) < 144 or data[2] != 1:
                continue
            stamp, site, application, entity = *struct.unpack(">I", data[4:8]), *struct.unpack(">3H", data[12:18])
            state = {"stamp": stamp >> 1, "arrival": now, "velocity": struct.unpack(">3f", data[36:48]),
                     "place": struct.unpack(">3d", data[48:72]), "appearance": struct.unpack(">I", data[84:88])[0], "model": data[88],
                     "acceleration": struct.unpack(">3f", data[104:116])}
            identity = (application - 1) * 65533 + entity if site == 1991 else 0
            with self.lock:
                self.came += 1
                before = self.known.get(identity)
                if before and (before["stamp"] - state["stamp"]) % (2 * HALF_HOUR) < HALF_HOUR:
                    self.older += 1
                else:
                    self.known[identity] = state

    def place(self, identity, now):
        """Returns where an entity is shown, None when it is not known."""
        with self.lock:
            state = self.known.get(identity)
        if state is None or state["appearance"] >> 23 & 1:
            return None
        since = 0 if state["appearance"] >> 21 & 1 or state["model"] == 1 else max(0, now - state["arrival"])
        curved = since * since / 2 if state["model"] in (4, 5) else 0
        return [state["place"][i] + since * state["velocity"][i] + curved * state["acceleration"][i] for i in range(3)]


def main():
    port, program, world, seconds, delay_ms = sys.argv[1:]
    receiver, frame, errors, unknown, moving = Receiver(int(port)), Frame(), [], 0, []
    receiver.start()
    while subprocess.run([program, "frame", "--world", world], capture_output=True, check=False).returncode != 0:
        time.sleep(0.05)
    time.sleep(6)  # every entity is sent at the start, and lost ones at the heartbeat
    end = time.monotonic() + float(seconds)
    while time.monotonic() < end:
        begun = time.monotonic()
        dump = subprocess.run([program, "dump", "--world", world, "--json"], capture_output=True, text=True, check=True).stdout
        took = time.monotonic() - begun
        for row in map(json.loads, dump.splitlines()):
            if row["state"] == "flight" or row.get("behaviour") == "flight":
                continue
            shown = receiver.place(row["id"], begun + took / 2)
            if shown is None:
                unknown += 1
                continue
            speed = math.hypot(*row["velocity"])
            allowed = THRESHOLD_M + speed * (float(delay_ms) / 1000 + FRAME_S + took / 2)
            error = math.dist(shown, frame.ecef(row["position"]))
            errors.append((error - allowed, error, allowed))
            if speed > 0.1:
                moving.append((error - allowed, error, allowed))
        time.sleep(0.1)
    for name, of in (("all", errors), ("moving", moving)):
        p99 = sorted(of)[len(of) * 99 // 100]
        late = sum(excess > 0 for excess, _, _ in of)
        print(f"{name}: {len(of)} places, {late / len(of):.3%} beyond what is allowed; at p99 {p99[1]:.2f} m of {p99[2]:.2f}, "
              f"median {sorted(error for _, error, _ in of)[len(of) // 2]:.2f} m, most {max(error for _, error, _ in of):.1f} m")
    print(f"{receiver.came} PDUs, {receiver.older} copies or older than what was known, {unknown} places unknown")
    if any(not of or sorted(of)[len(of) * 99 // 100][0] > 0 for of in (errors, moving)):
        sys.exit("not within the threshold and the delay")


if __name__ == "__main__":
    main()
