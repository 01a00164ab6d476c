"""Receives Cursor on Target, and compares it with the rows of a world.

usage: cot_world.py receive PORT FILE      writes an object of JSON for each event into FILE, until SIGTERM; every datagram must be
                                           well-formed XML with what the schema of 2.0 requires, else exit 1
       cot_world.py compare FILE DUMP      DUMP: of jolon world dump --json of the paused world; prints what was compared

The parser is expat; the mathematics is that of NIMA TR8350.2, with Python's library."""
import json
import math
import re
import signal
import socket
import sys
import time
from datetime import datetime, timezone
from xml.etree import ElementTree  # expat

REQUIRED = "version uid type time start stale how".split()
POINT = "lat lon hae ce le".split()
AFFILIATIONS = {"blue": "f", "red": "h", "neutral": "n"}
A, F = 6378137.0, 1 / 298.257223563
E2 = F * (2 - F)


def when(text):
    if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", text):
        raise ValueError(f"{text} is no time")
    return datetime.strptime(text, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=timezone.utc).timestamp()


def read(data):
    """Returns what an event says."""
    root = ElementTree.fromstring(data)
    point, detail = root.find("point"), root.find("detail")
    if root.tag != "event" or list(root) != [point, detail]:
        raise ValueError("no event with a point and details")
    attributes = {name: root.attrib[name] for name in REQUIRED}
    if attributes["version"] != "2.0" or abs(when(attributes["time"]) - time.time()) > 2:
        raise ValueError(f"version or time is wrong: {attributes}")
    event = {"uid": attributes["uid"], "type": attributes["type"], "octets": len(data),
             "stale_s": when(attributes["stale"]) - when(attributes["time"])}
    event.update({name: float(point.attrib[name]) for name in POINT})
    if attributes["type"] == "t-x-d-d":
        link = detail.find("link")
        event["gone"] = link.attrib["uid"]
        if detail.find("__forcedelete") is None or not link.attrib["relation"] or not link.attrib["type"]:
            raise ValueError("a deletion without what ATAK needs")
    else:
        event["callsign"] = detail.find("contact").attrib["callsign"]
        event.update({name: float(detail.find("track").attrib[name]) for name in ("course", "speed")})
    return event


def receive(port, path):
    ear, stopping = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), []
    ear.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    ear.bind(("127.0.0.1", int(port)))
    ear.settimeout(0.05)
    signal.signal(signal.SIGTERM, lambda *_: stopping.append(True))
    with open(path, "w", encoding="utf-8") as to:
        while True:
            try:
                data = ear.recv(65536)
            except socket.timeout:
                if stopping:
                    return
                continue
            try:
                print(json.dumps(read(data)), file=to, flush=True)
            except (ElementTree.ParseError, ValueError, KeyError, AttributeError) as error:
                sys.exit(f"{error}: {data!r}")


def ecef(lat, lon, height):
    radius = A / math.sqrt(1 - E2 * math.sin(lat) ** 2)
    return ((radius + height) * math.cos(lat) * math.cos(lon), (radius + height) * math.cos(lat) * math.sin(lon),
            (radius * (1 - E2) + height) * math.sin(lat))


def compare(path, dump):
    lat0, lon0 = math.radians(35.95), math.radians(-121.25)
    origin = ecef(lat0, lon0, -33.7)
    east = (-math.sin(lon0), math.cos(lon0), 0)
    north = (-math.sin(lat0) * math.cos(lon0), -math.sin(lat0) * math.sin(lon0), math.cos(lat0))
    up = (math.cos(lat0) * math.cos(lon0), math.cos(lat0) * math.sin(lon0), math.sin(lat0))
    last, compared, worst = {}, 0, 0.0
    for line in open(path, encoding="utf-8"):
        event = json.loads(line)
        last[event.get("gone", event["uid"])] = event
    for line in open(dump, encoding="utf-8"):
        row = json.loads(line)
        if row["state"] == "flight" or row.get("behaviour") == "flight":
            continue
        event = last.get(f"jolon.1.1991.1.{row['id']}")
        dead = row["state"] == "wreck" or row["damage"] == "destroyed"
        if event is None or ("gone" in event) != dead:
            sys.exit(f"{row['kind']} {row['id']}, {row['state']}: {event}")
        if dead:
            continue
        x, y, z = row["position"]
        right = [origin[i] + (x - 25000) * east[i] - (z - 25000) * north[i] + y * up[i] for i in range(3)]
        worst = max(worst, math.dist(right, ecef(math.radians(event["lat"]), math.radians(event["lon"]), event["hae"])))
        if not event["type"].startswith(f"a-{AFFILIATIONS[row['force']]}-"):
            sys.exit(f"{row['kind']} {row['id']} of {row['force']}: {event}")
        compared += 1
    print(f"{compared} vehicles, {worst * 100:.1f} cm at most")
    if compared == 0 or worst > 0.02:
        sys.exit("not equal")


if __name__ == "__main__":
    {"receive": receive, "compare": compare}[sys.argv[1]](*sys.argv[2:])
