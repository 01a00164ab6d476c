#!/usr/bin/env bash
# jolon replay LOG --physics: two tanks on level ground, heaps, short scenes and four minutes of the default
# world are good; output, JSON and exit codes.
physics_hour=$(cd "$(dirname "$0")/.." && pwd)/physics-hour
scenes=$(cd "$(dirname "$0")/../../config/scenarios" && pwd)
. "$(dirname "$0")/lib.sh"

run() { # OUT SCENARIO FRAMES: records a run of so many frames
    "$jolon" run -w "$name" --out "$1" --pace max --frames "$3" --without renderer --without reporter "$2" >/dev/null 2>&1
}
replay() { "$jolon" replay "$@"; }

# --- a world that is good ---------------------------------------------------------------------------
run duel-run duel 600
check "600 frames of the duel are good" replay duel-run/commands.log --physics
replay duel-run/commands.log --physics >text
check "the table has a line for each measure" eval '[ "$(sed "1,/^measure/d" text | wc -l)" = 20 ]'
check "the first lines have the digest, the verdict and the frames" eval \
    'sed -n 1p text | grep -q "equal to the run" && sed -n 2p text | grep -q "^physics: good: looked at 600 frames, 1200 times"'
check "--frames N looks at N frames" eval \
    'replay duel-run/commands.log --physics --frames 60 | grep -q "looked at 60 frames, 120 times"'
check "without --physics there is no table" eval '! replay duel-run/commands.log | grep -q physics'

replay duel-run/commands.log --physics --json >json
shape() {
    python3 -I -S - json <<'P'
import json, sys
told = json.load(open(sys.argv[1]))
physics = told["physics"]
assert told["equal"] and physics["good"] is True
assert physics["frames"] == 600 and physics["bodies"] == 1200 and physics["bodies_at_once"] == 2
assert len(physics["measures"]) == 20
for name, measure in physics["measures"].items():
    assert set(measure) == {"unit", "meaning", "worst", "bound", "good", "taken", "beyond", "frame", "time_s", "bodies"}, name
    assert measure["good"] and measure["beyond"] == 0, name
    assert measure["bound"] is None or measure["worst"] is None or measure["worst"] <= measure["bound"], name
height = physics["measures"]["height"]
assert height["bound"] == 1e-6 and height["taken"] > 600
assert height["bodies"][0]["kind"] == "tank" and len(height["bodies"][0]["position"]) == 3
P
}
check "the JSON has the shape of docs/replay.md" shape

# --- a heap: vehicles that drive into each other ------------------------------------------------------
cat >heap.cfg <<'C'
world = { name = "heap"; seed = 2; capacity = 64; frames = 120; };
terrain = { source = "flat"; height_m = 100.0; };
vehicles = (
    { kind = "tank"; behaviour = "hold"; at = [25000.0, 25000.0]; heading_deg = 90.0; speed_mps = 10.0; },
    { kind = "tank"; behaviour = "hold"; at = [25012.0, 25003.0]; heading_deg = 250.0; speed_mps = 10.0; },
    { kind = "tank"; behaviour = "hold"; at = [25006.0, 24990.0]; heading_deg = 180.0; speed_mps = 10.0; },
    { kind = "truck"; behaviour = "hold"; at = [25004.0, 25012.0]; heading_deg = 0.0; speed_mps = 10.0; },
    { kind = "jeep"; behaviour = "hold"; at = [24990.0, 25008.0]; heading_deg = 120.0; speed_mps = 10.0; }
);
C
run heap heap.cfg 120
replay heap/commands.log --physics --json >heap.json
code=$?
agree() { # the exit code is the verdict
    local good
    good=$(json physics.good <heap.json)
    [ "$good $code" = "True 0" ] || [ "$good $code" = "False 1" ] || { echo "$good, exit $code"; return 1; }
}
check "in a heap the exit code is the verdict" agree
check "the heap is looked at whole" eval 'equal "$(json physics.bodies <heap.json)" 600'
check "the heap's tanks never leave the ground" eval 'equal "$(json physics.measures.height.good <heap.json)" True'
check "two replays say the same" eval 'replay heap/commands.log --physics --json --threads 2 | cmp - heap.json'

# --- heaps: rings that drive inwards, a pile at one point, a crowd among obstacles --------------------
# ring: 90 tanks; pile: 25 tanks that begin in each other; crowd: 60 of four kinds drive to one point
# among trees, bushes and houses.
heap_of() {
    python3 -I -S - "$1" <<'P'
import math, random, sys
draw = random.Random(13)
kinds, vehicles, objects = ("tank", "truck", "jeep", "carrier"), [], []
def put(kind, x, z, heading, speed):
    vehicles.append(f'{{ kind = "{kind}"; behaviour = "hold"; at = [{x:.2f}, {z:.2f}];'
                    f' heading_deg = {heading % 360:.2f}; speed_mps = {speed:.1f}; }}')
def inwards(kind, angle, distance, speed):
    put(kind, 25000 + distance * math.sin(angle), 25000 - distance * math.cos(angle), math.degrees(angle) + 180, speed)
if sys.argv[1] == "ring":
    for ring, number in ((45, 24), (54, 30), (63, 36)):
        for i in range(number):
            inwards("tank", 2 * math.pi * i / number, ring, 10)
elif sys.argv[1] == "pile":
    for i in range(25):
        put("tank", 25000 + draw.uniform(-4, 4), 25000 + draw.uniform(-4, 4), draw.uniform(0, 360), 0)
else:
    for i in range(60):
        inwards(kinds[i % 4], 2 * math.pi * i / 60, draw.uniform(60, 140), draw.uniform(5, 15))
    for kind in ("tree", "bush", "building"):
        for i in range(12):
            angle, distance = draw.uniform(0, 6.28), draw.uniform(12, 50)
            objects.append(f'{{ kind = "{kind}"; at = [{25000 + distance * math.sin(angle):.1f},'
                           f' {25000 + distance * math.cos(angle):.1f}]; }}')
print('world = { name = "heap"; seed = 13; capacity = 256; };\nterrain = { source = "flat"; height_m = 100.0; };')
print("objects = (", ",\n".join(objects), ");\nvehicles = (", ",\n".join(vehicles), ");")
P
}
for heap in ring pile crowd; do
    heap_of "$heap" >"$heap.cfg"
    run "$heap" "$heap.cfg" 900
done
check "15 s of 90 tanks in rings are within the bounds" replay ring/commands.log --physics
check "15 s of a crowd among obstacles are within the bounds" replay crowd/commands.log --physics
check "15 s of a pile that parts are within the bounds" replay pile/commands.log --physics

# --- scenes that end within seconds ------------------------------------------------------------------
for scene in "$scenes"/figure-a*.cfg "$scenes"/{tank,truck,jeep}*.cfg; do
    check "$(basename "$scene" .cfg) is within the bounds, also beyond its end" "$physics_hour" "$bin" "$scene" 600
done

# --- the default world --------------------------------------------------------------------------------
# Its first four minutes, with fire, craters, crashes and wrecks. `make judge` looks at an hour.
check "four minutes of the default world are within the bounds" "$physics_hour" "$bin" hunter-liggett 14400

# --- a bound that is passed: npsnet2 finds spheres in each other, and moves them apart by metres in a frame
python3 - >edge.cfg <<'P'
import math
print('world = { name = "edge"; seed = 2; capacity = 64; };')
print('terrain = { source = "flat"; height_m = 100.0; };')
print('collision = { shape = "sphere"; method = "npsnet2"; };')
vehicles = []
for i in range(40):
    angle, away = i * 2.4, 1.2 * math.sqrt(i)
    vehicles.append('{ kind = "%s"; behaviour = "hold"; at = [%.2f, %.2f]; heading_deg = %d.0; speed_mps = 5.0; }' % (
        ("tank", "jeep", "truck")[i % 3], 25000 + away * math.cos(angle), 25000 + away * math.sin(angle), i * 77 % 360))
print("vehicles = ( %s );" % ",\n".join(vehicles))
P
run edge edge.cfg 120
replay edge/commands.log --physics >text
check "a bound that is passed gives exit code 1" equal $? 1
check "the table says which, where and when" eval 'grep -q "^physics: BAD" text && grep -Eq "^jump .* BAD .* frame [0-9]+ .*; (tank|jeep|truck) [0-9]+ at \(250" text'
check "measures within their bounds are good" eval 'grep -q "^not_finite .* good" text && grep -q "^energy .* good" text'

# --- wrong usage -------------------------------------------------------------------------------------
refuses "--physics takes no value" 2 'physics' "$bin/jolon-world" replay --physics=yes duel-run/commands.log
refuses "--physics is no option of diff" 2 'physics' "$bin/jolon-world" diff --physics duel-run/commands.log duel-run/commands.log
done_testing
