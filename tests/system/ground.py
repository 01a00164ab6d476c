"""Compares a ground with the tile of heights that it was made from, for test_ground.sh. The tile is read and sampled here
by other code than Jolon's, and places are converted by PROJ.

usage: ground.py heights TILE.hgt GROUND.raw SIDE_M POSTS LAT LON      (GROUND.raw: rows of little-endian floats)
       ground.py convoy DUMP.jsonl ROADS.osm LAT LON SIDE_M MOST_M     (is every vehicle that near to a road, and moving?)
The first prints the root of the mean square and the largest difference [m]."""
import json
import math
import random
import re
import struct
import subprocess
import sys

TILE_SIDE = 1201


def places_of(points, latitude, longitude):
    """Converts points east and north of the middle to latitudes and longitudes."""
    projection = f"+proj=tmerc +lat_0={latitude} +lon_0={longitude} +k=1 +datum=WGS84 +units=m"
    text = "".join(f"{east:.9f} {north:.9f}\n" for east, north in points)
    done = subprocess.run(["gdaltransform", "-output_xy", "-s_srs", projection, "-t_srs", "EPSG:4326"], input=text,
                          capture_output=True, text=True, check=True)
    return [tuple(map(float, line.split()[1::-1])) for line in done.stdout.splitlines()]


def tile_height(tile, south, west, latitude, longitude):
    u, v = (longitude - west) * (TILE_SIDE - 1), (south + 1 - latitude) * (TILE_SIDE - 1)
    c, r = min(int(u), TILE_SIDE - 2), min(int(v), TILE_SIDE - 2)
    u, v = u - c, v - r
    at = r * TILE_SIDE + c
    north = tile[at] * (1 - u) + tile[at + 1] * u
    return north * (1 - v) + (tile[at + TILE_SIDE] * (1 - u) + tile[at + TILE_SIDE + 1] * u) * v


def ground_height(posts, count, spacing, x, z):
    """Returns the height on the two triangles of a cell, split from its north-west to its south-east post."""
    u, v = x / spacing, z / spacing
    c, r = min(int(u), count - 2), min(int(v), count - 2)
    u, v = u - c, v - r
    nw, ne, sw, se = (posts[(r + i) * count + c + k] for i in (0, 1) for k in (0, 1))
    return nw + (ne - nw) * u + (se - ne) * v if u >= v else nw + (se - sw) * u + (sw - nw) * v


def spread(differences):
    square = sum(d * d for d in differences) / len(differences)
    print(f"{math.sqrt(square):.4f} {max(map(abs, differences)):.4f}")


def heights(tile_path, raw_path, side, count, latitude, longitude):
    side, count = float(side), int(count)
    name = re.search(r"([NS])(\d\d)([EW])(\d\d\d)\.hgt$", tile_path)
    south = int(name[2]) * (1 if name[1] == "N" else -1)
    west = int(name[4]) * (1 if name[3] == "E" else -1)
    with open(tile_path, "rb") as file:
        tile = struct.unpack(f">{TILE_SIDE * TILE_SIDE}h", file.read())
    with open(raw_path, "rb") as file:
        posts = struct.unpack(f"<{count * count}f", file.read())
    spacing = side / (count - 1)
    draw = random.Random(17)
    points = [(draw.uniform(0, side), draw.uniform(0, side)) for _ in range(10000)]
    places = places_of([(x - side / 2, side / 2 - z) for x, z in points], latitude, longitude)
    spread([ground_height(posts, count, spacing, x, z) - tile_height(tile, south, west, *place)
            for (x, z), place in zip(points, places)])
    # At the posts themselves only the rounding to 1/64 m is left.
    posts_at = [(draw.randrange(count), draw.randrange(count)) for _ in range(10000)]
    places = places_of([(c * spacing - side / 2, side / 2 - r * spacing) for c, r in posts_at], latitude, longitude)
    spread([posts[r * count + c] - tile_height(tile, south, west, *place) for (c, r), place in zip(posts_at, places)])


def world_places(places, latitude, longitude, side):
    """Converts latitudes and longitudes to world coordinates."""
    projection = f"+proj=tmerc +lat_0={latitude} +lon_0={longitude} +k=1 +datum=WGS84 +units=m"
    text = "".join(f"{place[1]:.9f} {place[0]:.9f}\n" for place in places)
    done = subprocess.run(["gdaltransform", "-output_xy", "-s_srs", "EPSG:4326", "-t_srs", projection], input=text,
                          capture_output=True, text=True, check=True)
    rows = [list(map(float, line.split())) for line in done.stdout.splitlines()]
    return [(east + side / 2, side / 2 - north) for east, north in rows]


def distance(point, a, b):
    dx, dz = b[0] - a[0], b[1] - a[1]
    share = max(0.0, min(1.0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dz) / (dx * dx + dz * dz or 1.0)))
    return math.hypot(point[0] - a[0] - dx * share, point[1] - a[1] - dz * share)


def convoy(dump_path, osm_path, latitude, longitude, side, most):
    with open(osm_path, encoding="utf-8") as file:
        text = file.read()
    nodes = re.findall(r'<node id="(\d+)" lat="([-.\d]+)" lon="([-.\d]+)"', text)
    points = dict(zip([node[0] for node in nodes],
                      world_places([tuple(map(float, node[1:])) for node in nodes], latitude, longitude, float(side))))
    ways = [re.findall(r'ref="(\d+)"', way) for way in re.findall(r"<way.*?</way>", text)]
    segments = [(points[a], points[b]) for way in ways for a, b in zip(way, way[1:]) if a in points and b in points]
    with open(dump_path, encoding="utf-8") as file:
        vehicles = [json.loads(line) for line in file]
    off = [min(distance((v["position"][0], v["position"][2]), *segment) for segment in segments) for v in vehicles]
    moved = [v["speed_mps"] for v in vehicles]
    print("metres from a road:", [round(value, 1) for value in off], "speeds:", moved)
    raise SystemExit(not vehicles or max(off) > float(most) or min(moved) < 1.0)


if __name__ == "__main__":
    {"heights": heights, "convoy": convoy}[sys.argv[1]](*sys.argv[2:])
