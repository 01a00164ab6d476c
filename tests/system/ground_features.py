"""Draws maps of a village and of broken features for test_ground_objects.sh, and judges what became of them. Places are
converted by PROJ's gdaltransform.

usage: ground_features.py maps LAT LON SIDE_M     (writes village, east, west, crossing, coast, torn, beach,
                                                  strait, turned, islet, gorge, over, under and broken.geojson, and
                                                  broken, closed, rings and notched.osm)
       ground_features.py corner EVENTS           (does the first collision of T1 lie at the corner, within 1 mm?)
       ground_features.py wall EVENTS             (does it lie on a wall beside that corner, within 1 mm?)
       ground_features.py craters CSV RAW         (has the raster the heights of the dump, and holes?)
       ground_features.py crossed DUMP            (has T3 passed the lake and the river?)
       ground_features.py convoy DUMP             (do six trucks drive in the valley south of Gorham?)
       ground_features.py picture RAW X Z STEP WORD...   (has the picture of 500 x 500 pixels the colours of these things?)
       ground_features.py shore DUMP LATER        (does T2 stand at the shore of the lake?)"""
import json
import math
import struct
import sys

sys.dont_write_bytecode = True
from ground import places_of  # noqa: E402

# The western corner of the first building, whose sides go to the north-east and south-east; and the western shore.
CORNER = (25003.217, 25000.431)
SHORE = 20300.0


class Map:
    def __init__(self, latitude, longitude, side):
        self.place = float(latitude), float(longitude)
        self.half = float(side) / 2
        self.features = []

    def add(self, shape, points, **tags):
        self.features.append((shape, points, tags))

    def write(self, *paths):
        """Writes each feature to the maps whose turn it is."""
        flat = [p for _, points, _ in self.features for p in points]
        places = iter(places_of([(x - self.half, self.half - z) for x, z in flat], *self.place))
        rows = []
        for shape, points, tags in self.features:
            ring = [[round(lon, 11), round(lat, 11)] for lat, lon in (next(places) for _ in points)]
            coordinates = ring[0] if shape == "Point" else [ring + ring[:1]] if shape == "Polygon" else ring
            rows.append({"type": "Feature", "properties": tags, "geometry": {"type": shape, "coordinates": coordinates}})
        for k, path in enumerate(paths):
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"type": "FeatureCollection", "features": rows[k::len(paths)]}, file)
        return rows


def box(x, z, length, width, angle=0.0):
    sine, cosine = math.sin(angle), math.cos(angle)
    return [(round(x + u * cosine - v * sine, 3), round(z + u * sine + v * cosine, 3))
            for u, v in ((-length / 2, -width / 2), (length / 2, -width / 2), (length / 2, width / 2), (-length / 2, width / 2))]


def village(there):
    x, z = CORNER
    there.add("Polygon", [(x, z), (x + 12.5, z - 12.5), (x + 25, z), (x + 12.5, z + 12.5)], building="yes", height="9")
    for i in range(120):
        there.add("Polygon", box(25150 + i % 12 * 30, 24750 + i // 12 * 42, 12 + i % 5, 9, 0.01 * i), building="house")
    for i in range(11):
        there.add("LineString", [(25130, 24729 + i * 42), (25310, 24730 + i * 42), (25510, 24729 + i * 42)], highway="residential")
    there.add("LineString", [(25130, 24600), (25130, 25400)], highway="secondary")
    there.add("Polygon", [(SHORE, 29000), (22000, 29000), (22000, 31000), (SHORE, 31000)], natural="water", name="x" * 65536)
    there.add("Polygon", [(26000, 24000), (27500, 24100), (27400, 25500), (26500, 24900)], landuse="forest")
    there.add("LineString", [(24000 + i * 150, 24500) for i in range(20)], power="line")
    there.add("Point", [(24300, 24500)], power="tower")
    there.add("Point", [(25700, 24700)], man_made="water_tower")
    there.add("LineString", [(23000, 20000), (23500, 25000), (23000, 30000)], waterway="river", width="40 m")


def crossing(there):
    """A road leads through a lake and over a river."""
    there.add("LineString", [(24200, 24300), (25800, 25650)], highway="secondary", bridge="yes")
    there.add("Polygon", [(24500, 24400), (24650, 24400), (24650, 24900), (24500, 24900)], natural="water")
    there.add("LineString", [(25100, 23500), (25000, 26500)], waterway="river", width="60")


def gorge(there):
    """A road leads through a lake between cliffs, aslant over the rows of posts."""
    there.add("LineString", [(24100, 25333), (25900, 24667)], highway="primary")
    there.add("Polygon", box(25000, 25000, 200, 2000), natural="water")


def coast(there, turned=False):
    """Land in the north-west, sea in the south-east with an island, and a bay in the land. turned: a second coastline of the other
    direction."""
    there.add("LineString", [(25100, 26500), (25300, 25500), (24900, 25000)], natural="coastline")
    there.add("LineString", [(24900, 25000), (25500, 24800), (26500, 24300)], natural="coastline")
    there.add("Polygon", [(25500, 25200), (25700, 25200), (25700, 25400), (25500, 25400)], natural="coastline")
    there.add("LineString", [(24300, 24300), (24500, 24300), (24500, 24500), (24300, 24500), (24300, 24300)], natural="coastline")
    if turned:
        there.add("LineString", [(24700, 24100), (24700, 25900)], natural="coastline")
        there.add("LineString", [(24800, 24100), (24800, 25900)], natural="coastline")


def small_coasts(*place):
    """A beach from east to west between two rows of posts, with land in the south, a strait, the same with its
    southern bank turned, and an island between posts."""
    beach, islet = Map(*place), Map(*place)
    beach.add("LineString", [(26100, 25004), (23900, 25006)], natural="coastline")
    beach.write("beach.geojson")
    for path, bank in ("strait.geojson", [(26100, 25304), (23900, 25306)]), ("turned.geojson", [(23900, 25314), (26100, 25316)]):
        two = Map(*place)
        two.add("LineString", [(23900, 24503), (26100, 24517)], natural="coastline")
        two.add("LineString", bank, natural="coastline")
        two.write(path)
    islet.add("Polygon", [(25002, 25002), (25008, 25002), (25005, 25008)], natural="coastline")
    islet.write("islet.geojson")


def broken(there):
    there.add("Polygon", box(25000, 25000, 12, 9), building="yes", name="y" * 65536)
    there.add("Polygon", [(25100, 25000), (25112, 25010), (25112, 25000), (25100, 25010)], building="yes")  # a bow: two triangles
    there.add("LineString", box(25200, 25000, 12, 9), building="yes")
    there.add("Point", [(25300, 25000)], building="yes")
    there.add("Polygon", box(49998, 25000, 12, 9), building="yes")
    there.add("Polygon", box(25400, 25000, 1, 1), building="yes")
    there.add("Polygon", [(25500, 25000), (25510, 25000), (25510, 25000.004), (25505, 25008)], building="yes", height="high")
    there.add("Polygon", box(25600, 25000, 12, 9), building="yes", height="1e308")
    for x, height in (25640, "-5"), (25680, "nan"):
        there.add("Polygon", box(x, 25000, 12, 9), building="yes", height=height)
    there.add("Polygon", [(26000, 26000), (26200, 26200), (26200, 26000), (26000, 26200)], natural="water")  # a bow
    there.add("LineString", [(26400, 26000), (26500, 26000), (26450, 26090)], natural="wood")
    there.add("Polygon", box(26600, 26000, 80, 60), natural="wood")  # its ring is opened below
    there.add("Polygon", box(80000, 25000, 12, 9), building="yes")  # elsewhere
    rows = there.write("broken.geojson")
    del rows[-2]["geometry"]["coordinates"][0][-1]
    rows[-1]["geometry"]["coordinates"][0][1] = [-71.5, 95.0]
    rows.append({"type": "Feature", "properties": {"natural": "water"}, "geometry": {"type": "Polygon", "coordinates": [[[-71.5, 44.5], [-71.5, 44.6]]]}})
    rows.append({"type": "Feature", "properties": {"building": "yes", "highway": "track"}, "geometry": None})
    for shape, empty in ("Polygon", [[]]), ("MultiPolygon", []):
        rows.append({"type": "Feature", "properties": {"natural": "water"}, "geometry": {"type": shape, "coordinates": empty}})
    with open("broken.geojson", "w", encoding="utf-8") as file:
        json.dump({"type": "FeatureCollection", "features": rows}, file)


def write_osm(path, nodes, ways, more=""):
    """ways: number, numbers of nodes, which begin at 1, key, value, key, value ..."""
    with open(path, "w", encoding="utf-8") as file:
        file.write('<osm version="0.6">\n')
        for i, (lon, lat) in enumerate(nodes):
            file.write(f'<node id="{i + 1}" lat="{lat:.9f}" lon="{lon:.9f}" version="1"/>\n')
        for number, refs, *tags in ways:
            file.write(f'<way id="{number}" version="1">' + "".join(f'<nd ref="{r}"/>' for r in refs))
            file.write("".join(f'<tag k="{k}" v="{v}"/>' for k, v in zip(tags[::2], tags[1::2])) + "</way>\n")
        file.write(more + "</osm>\n")


def corners_of_boxes(there, count):
    there.features = [("Polygon", box(25000 + 40 * i, 25000, 12, 9), {}) for i in range(count)]
    return [p for row in there.write("good.geojson") for p in row["geometry"]["coordinates"][0][:4]]


def broken_osm(there):
    building, track = ("building", "yes"), ("highway", "track")
    write_osm("broken.osm", corners_of_boxes(there, 2),
              [(1, [1, 2, 3, 4, 1], *building), (2, [5, 6, 999, 7, 8, 5], *building), (3, [997, 998, 999, 997], *building),
               # Without words, as outlines of relations are; as an area.
               (4, [1, 2, 3, 991, 1]), (5, [5, 6, 7, 992, 5], "natural", "water", "area", "yes"),
               # A node is missing, one node, none.
               (12, [1, 2, 3, 996, 5], *track), (13, [1], *track), (14, [995, 994], *track)],
              '<relation id="15" version="1"><member type="way" ref="1" role="outer"/><member type="way" ref="77" role="outer"/>'
              '<tag k="type" v="multipolygon"/><tag k="natural" v="water"/></relation>\n')


def closed_osm(there):
    """Ways that are closed: two buildings, a lake, a river's banks; a river, a yard, a road, a water tower, a power line of five towers."""
    rings = [[4 * i + k for k in (1, 2, 3, 4, 1)] for i in range(9)]
    words = [("building", "yes", "building:levels", "2"), ("building", "house", "area", "yes"), ("natural", "water"),
             ("natural", "water", "water", "river"), ("waterway", "river", "width", "wide"), ("highway", "service", "area", "yes"),
             ("highway", "service"), ("man_made", "water_tower"), ("power", "line")]
    write_osm("closed.osm", corners_of_boxes(there, 9), [(i + 1, ring, *words[i]) for i, ring in enumerate(rings)])


def ring_osm(there):
    """A lake and a building as the outer ways of relations without words of their own, as OpenStreetMap had them."""
    there.features = [("Polygon", box(25000, 25000, side, side), {}) for side in (400, 200)] + \
                     [("Polygon", box(25300, 25000, side, side), {}) for side in (40, 20)]
    nodes = [p for row in there.write("good.geojson") for p in row["geometry"]["coordinates"][0][:4]]
    rings = [[4 * i + k for k in (1, 2, 3, 4, 1)] for i in range(4)]
    members = "".join(f'<relation id="{i + 9}" version="1"><member type="way" ref="{2 * i + 1}" role="outer"/><member type="way" ref="{2 * i + 2}" '
                      'role="inner"/><tag k="type" v="multipolygon"/></relation>\n' for i in range(2))
    write_osm("rings.osm", nodes, [(1, rings[0], "natural", "water"), (2, rings[1]), (3, rings[2], "building", "yes"), (4, rings[3])], members)


def notched_osm(there):
    """A building and a lake with holes on their western sides, whose corners are no nodes of the outlines."""
    there.features = [("Polygon", box(*where), {}) for where in
                      ((25000, 25000, 40, 40), (24990, 25003, 20, 20), (25500, 25000, 400, 400), (25400, 25030, 200, 200))]
    nodes = [p for row in there.write("good.geojson") for p in row["geometry"]["coordinates"][0][:4]]
    ways = [(i + 1, [4 * i + k for k in (1, 2, 3, 4, 1)]) for i in range(4)]
    members = "".join(f'<relation id="{i + 9}" version="1"><member type="way" ref="{2 * i + 1}" role="outer"/><member type="way" ref="{2 * i + 2}" '
                      f'role="inner"/><tag k="type" v="multipolygon"/><tag k="{key}" v="{word}"/></relation>\n'
                      for i, (key, word) in enumerate((("building", "yes"), ("natural", "water"))))
    write_osm("notched.osm", nodes, ways, members)


def overlapping(*place):
    """A wood and a part of a lake; scrub and another part."""
    over, under = Map(*place), Map(*place)
    over.add("Polygon", box(25000, 25000, 800, 600), natural="wood")
    over.add("Polygon", box(27000, 25000, 800, 600), natural="water")
    under.add("Polygon", box(25300, 25100, 800, 600), natural="scrub")
    under.add("Polygon", box(27300, 25100, 800, 600), natural="water")
    over.write("over.geojson")
    under.write("under.geojson")


def maps(*place):
    there = Map(*place)
    village(there)
    there.write("village.geojson")
    there.write("east.geojson", "west.geojson")
    bridges = Map(*place)
    crossing(bridges)
    bridges.write("crossing.geojson")
    cliffs = Map(*place)
    gorge(cliffs)
    cliffs.write("gorge.geojson")
    for turned, path in (False, "coast.geojson"), (True, "torn.geojson"):
        sea = Map(*place)
        coast(sea, turned)
        sea.write(path)
    small_coasts(*place)
    overlapping(*place)
    broken(Map(*place))
    broken_osm(Map(*place))
    closed_osm(Map(*place))
    ring_osm(Map(*place))
    notched_osm(Map(*place))


def first_collision(path):
    with open(path, encoding="utf-8") as file:
        events = [json.loads(line) for line in file]
    first = next(e for e in events if e["type"] == "collision" and e["b"].get("fixed"))
    print(first)
    return first["b"]["kind"], first["point"][0] - CORNER[0], first["point"][2] - CORNER[1]


def corner(path):
    kind, x, z = first_collision(path)
    off = math.hypot(x, z)
    print(f"{off * 1000:.4f} mm off the corner")
    raise SystemExit(kind != "building" or off > 0.001)


def wall(path):
    kind, x, z = first_collision(path)
    off = abs(abs(z) - x) / math.sqrt(2.0)  # the walls go to the north-east and the south-east
    print(f"{off * 1000:.4f} mm off the wall")
    raise SystemExit(kind != "building" or off > 0.001 or not 0.0 < x < 2.0)


def shore(*paths):
    places = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            places.append(next(v["position"] for v in map(json.loads, file) if v.get("name") == "T2"))
    print(places)
    # It fords what is shallow, where the posts end the lake, and no more.
    raise SystemExit(not all(-20.0 < place[0] - SHORE < 45.0 for place in places) or abs(places[0][0] - places[1][0]) > 1.0)


def crossed(path):
    with open(path, encoding="utf-8") as file:
        x, _, z = next(v["position"] for v in map(json.loads, file) if v.get("name") == "T3")
    print(x, z)
    raise SystemExit(not 25200.0 < x < 25900.0)


def craters(csv_path, raw_path):
    with open(csv_path, encoding="utf-8") as file:
        heights = [float(line.split(",")[2]) for line in file if line[0] != "x"]
    with open(raw_path, "rb") as file:
        raw = struct.unpack(f"<{len(heights)}f", file.read())
    worst = max(abs(a - b) for a, b in zip(raw, heights))
    print(f"{worst:.5f} m off, from {min(raw):.2f} to {max(raw):.2f} m")
    raise SystemExit(worst > 1e-3 or min(raw) > 79.5)


def convoy(path):
    with open(path, encoding="utf-8") as file:
        trucks = [v for v in map(json.loads, file) if v["kind"] == "truck"]
    print(*((round(x), round(z), round(y)) for x, y, z in (v["position"] for v in trucks)))
    # Gorham is at [33300, 13220] and the road leads to the south. The last ones wait their turn in its first bends.
    raise SystemExit(len(trucks) != 6 or not all(v["damage"] == "none" for v in trucks) or
                     sum(v["speed_mps"] > 1.0 for v in trucks) < 3 or
                     not all(12900.0 < v["position"][2] < 15500.0 for v in trucks))


def picture(path, x0, z0, step, *things):
    with open(path, "rb") as file:
        raw = file.read()

    def at(x, z):
        i = 3 * (round((z - float(z0)) / float(step)) * 500 + round((x - float(x0)) / float(step)))
        return tuple(raw[i:i + 3])

    def is_red(pixel):
        return pixel[0] > 1.4 * pixel[1] and pixel[0] > 1.4 * pixel[2]

    there = {
        "lake": lambda: at(21000, 30000)[2] > at(21000, 30000)[0] + 20,
        "village": lambda: sum(is_red(at(25150 + 100 * i, 24750 + 100 * k)) for i in range(4) for k in range(5)) > 10,
        "road": lambda: min(at(25130, 24650)) > max(at(25600, 24650)) - 40,
        # The corner points to the west, with ground before it and the building behind it.
        "corner": lambda: is_red(at(CORNER[0] + 3, CORNER[1])) and not is_red(at(CORNER[0] - 3, CORNER[1])) and
        is_red(at(CORNER[0] + 22, CORNER[1])) and not is_red(at(CORNER[0] + 28, CORNER[1])),
    }
    missing = [thing for thing in things if not there[thing]()]
    print(*missing)
    raise SystemExit(len(missing))


if __name__ == "__main__":
    {"maps": maps, "picture": picture, "convoy": convoy, "corner": corner, "craters": craters, "wall": wall, "shore": shore,
     "crossed": crossed}[sys.argv[1]](*sys.argv[2:])
