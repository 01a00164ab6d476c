"""Compares the Entity States that tshark reads in a capture with the rows of a paused world.

usage: dis_world.py CAPTURE PORT DUMP    DUMP: of jolon world dump --json; prints what was compared; exit 1 on a difference.

The mathematics is this program's own: the formulas of NIMA TR8350.2 and of IEEE 1278.1, with Python's library."""
import json
import math
import subprocess
import sys

FIELDS = ("dis.entity_id_site dis.entity_id_application dis.entity_id_entity dis.force_id dis.entity_marking dis.appearance "
          "dis.entity_location.x dis.entity_location.y dis.entity_location.z dis.entity_orientation.psi "
          "dis.entity_orientation.theta dis.entity_orientation.phi").split()
LATITUDE, LONGITUDE, UNDULATION, MIDDLE = math.radians(35.95), math.radians(-121.25), -33.7, 25000.0
FORCES = {"blue": 1, "red": 2, "neutral": 3}


def frame():
    flattening = 1 / 298.257223563
    e2 = flattening * (2 - flattening)
    sin_lat, cos_lat, sin_lon, cos_lon = (f(a) for a in (LATITUDE, LONGITUDE) for f in (math.sin, math.cos))
    radius = 6378137 / math.sqrt(1 - e2 * sin_lat ** 2)
    origin = ((radius + UNDULATION) * cos_lat * cos_lon, (radius + UNDULATION) * cos_lat * sin_lon,
              (radius * (1 - e2) + UNDULATION) * sin_lat)
    east = (-sin_lon, cos_lon, 0)
    north = (-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat)
    up = (cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    return origin, east, north, up


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turn(axis, angle):
    s, c = math.sin(angle), math.cos(angle)
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]


def turns(z, y, x):
    return product(turn("z", z), product(turn("y", y), turn("x", x)))


def between(a, b):
    """Returns the angle between two rotations."""
    distance = math.sqrt(sum((a[i][j] - b[i][j]) ** 2 for i in range(3) for j in range(3)))
    return 2 * math.asin(min(1, distance / math.sqrt(8)))


def last_states(capture, port):
    command = ["tshark", "-r", capture, "-d", f"udp.port=={port},dis", "-Y", "dis.pdu_type == 1", "-T", "fields", "-E", "occurrence=f"]
    for field in FIELDS:
        command += ["-e", field]
    states = {}
    for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        site, application, entity, force, marking, appearance, *numbers = line.split("\t")
        if int(site) != 1991:
            sys.exit(f"an entity of site {site}")
        ours = (int(application) - 1) * 65533 + int(entity)
        if ours in states and states[ours][1] != marking:
            sys.exit(f"entity {ours} was {states[ours][1]} and is {marking}")
        states[ours] = (int(force), marking, int(appearance, 0), [float(number) for number in numbers])
    return states


def main():
    capture, port, dump = sys.argv[1:]
    origin, east, north, up = frame()
    states, compared, worst_m, worst_rad = last_states(capture, port), 0, 0.0, 0.0
    with open(dump, encoding="utf-8") as lines:
        rows = [json.loads(line) for line in lines]
    for row in rows:
        if row["state"] == "flight" or row.get("behaviour") == "flight":
            continue
        if row["id"] not in states:
            sys.exit(f"{row['kind']} {row['id']} was not sent")
        force, marking, appearance, numbers = states[row["id"]]
        x, y, z = row["position"]
        right = [origin[i] + (x - MIDDLE) * east[i] - (z - MIDDLE) * north[i] + y * up[i] for i in range(3)]
        worst_m = max(worst_m, math.dist(right, numbers[:3]))
        local = [[north[i], east[i], -up[i]] for i in range(3)]
        attitude = turns(*(math.radians(row[name]) for name in ("heading_deg", "pitch_deg", "roll_deg")))
        worst_rad = max(worst_rad, between(product(local, attitude), turns(*numbers[3:])))
        if force != FORCES[row["force"]] or not appearance & 1 << 21:
            sys.exit(f"{row['kind']} {row['id']}: force {force}, appearance {appearance:#x}")
        if (appearance >> 3 & 3 == 3) != (row["state"] == "wreck" or row["damage"] == "destroyed"):
            sys.exit(f"{row['kind']} {row['id']}: {row['state']}, {row['damage']}, appearance {appearance:#x}")
        compared += 1
    print(f"{compared} vehicles, {worst_m * 1000:.3f} mm and {worst_rad:.2e} rad at most")
    if compared == 0 or worst_m > 1e-3 or worst_rad > 2e-5:
        sys.exit("not equal")


if __name__ == "__main__":
    main()
