#!/usr/bin/env bash
# Views, their switches, and pictures of a running world: none of them changes the world, a picture
# shows the frame that it names, and wrong requests are refused with a helpful message.
# Quiet: it waits for pictures of a world that runs in real time.
. "$(dirname "$0")/lib.sh"

renderer=$bin/jolon-renderer
small="--set renderer.width=160 --set renderer.height=90"

# run NAME [options]: runs a short scenario to its end. NAME.json is the summary.
run() {
    local as=$1
    shift
    # shellcheck disable=SC2086 # words
    "$jolon" run -w "$name" --json --pace max --frames 600 --without reporter --out "$folder/$as" $small "$@" \
        duel >"$as.json" 2>"$as.err" || sed 's/^/# /' "$as.err"
}
digest() { json digest <"$1.json"; }

# Print width and height of a PNG file, and its comment.
size() { python3 -c 'import struct, sys; print("%dx%d" % struct.unpack(">II", open(sys.argv[1], "rb").read(24)[16:]))' "$1"; }
comment() { python3 - "$1" <<'P'; }
import struct, sys
data = open(sys.argv[1], "rb").read()
at = 8
while at < len(data):
    length, kind = struct.unpack(">I4s", data[at:at + 8])
    if kind == b"tEXt":
        print(data[at + 8:at + 8 + length].split(b"\0", 1)[1].decode("latin-1"))
    at += 12 + length
P
field() { comment "$1" | tr ' ' '\n' | sed -n "s/^$2=//p"; }

# --- no view changes the world --------------------------------------------------------------------
run none --without renderer
run views --set renderer.view=chase,map,inside,orbit,free,overhead
check "six views at once change nothing" equal "$(digest views)" "$(digest none)"
for view in chase map inside orbit free overhead; do
    check "$view has a file of the last frame" cmp views/$view.png views/$view-000600.png
    check "the file of $view names its frame and view" equal "$(field views/$view.png frame) $(field views/$view.png view)" "600 $view"
done
run plain --set renderer.view=chase --set renderer.backend=soft --set renderer.fps=120 --set renderer.hold=false
check "back end, rate and quality change nothing" equal "$(digest plain)" "$(digest none)"
for switch in fog haze texture; do
    run $switch --set renderer.view=chase --set renderer.backend=soft --set renderer.$switch=false
    check "the switch $switch off changes nothing" equal "$(digest $switch)" "$(digest none)"
done
for switch in fog haze texture; do
    check "the switch $switch off changes the picture" bash -c "[ -s $switch/chase.png ] && ! cmp -s $switch/chase.png plain/chase.png"
done
if "$renderer" --list-devices | grep -q OpenGL; then
    run gl --set renderer.view=chase --set renderer.backend=gl
    check "OpenGL changes nothing" equal "$(digest gl)" "$(digest none)"
    check "one line reports the use of OpenGL" equal "$(grep -c 'renderer info .*draws with .*OpenGL' gl/jolon.log)" 1
else
    skip "OpenGL changes nothing" "there is no OpenGL here"
fi
check "one line reports the software rasteriser and the reason" \
    equal "$(grep -cE 'draws with the own rasteriser, [0-9]+ threads?, [A-Z0-9]+: asked for' plain/jolon.log)" 1

# --- pictures of a running world ------------------------------------------------------------------
snap() { "$jolon" snap -w "$name" --backend soft "$@"; }
# shellcheck disable=SC2086 # words
"$jolon" start -w "$name" --out running --without renderer --without reporter --set world.frames=0 $small duel >/dev/null
check "a picture of the running world is taken" snap shot.png
check "the picture has the scenario's size" equal "$(size shot.png)" 160x90
check "a picture of another size is taken" snap --view inside --vehicle 2 --size 320x200 inside.png
check "the picture has the requested size" equal "$(size inside.png)" 320x200
check "the picture shows the requested vehicle" equal "$(field inside.png id)" 2
check "the picture has the requested view" equal "$(field inside.png view)" inside
if "$renderer" --list-devices | grep -q '^[0-9].*llvmpipe'; then
    check "part of a device's name selects the device" bash -c "'$jolon' snap -w $name --device llvmpipe gl.png 2>&1 | grep -q 'draws with llvmpipe.*asked for'"
else
    skip "part of a device's name selects the device" "there is no llvmpipe here"
fi
check "an unknown device is refused" bash -c "'$jolon' snap -w $name --device voodoo gl.png 2>&1 |
    grep -q -e 'device voodoo: .*--list-devices' -e 'no OpenGL'"
check "a vehicle is selected by its name" snap --vehicle East east.png
check "the picture shows the named vehicle" equal "$(field east.png name)" East
check "an unknown vehicle name is refused" bash -c "'$jolon' snap -w $name --vehicle Nobody x.png 2>&1 |
    grep -q 'vehicle \"Nobody\": world .* has none of that name'"
check "a picture is taken from a place" snap --eye 24950,25000,5 --look 90,-10 place.png
check "its view is free" equal "$(field place.png view)" free
check "several views are taken at once" snap --view chase:1,overhead:2,map three.png
check "each view has a file of its name" [ -s three.png -a -s three-overhead.2.png -a -s three-map.png ]
check "each file shows its vehicle" equal "$(field three.png id) $(field three-overhead.2.png id)" "1 2"
check "only the owner can read a picture" equal "$(stat -c %a shot.png)" 600
check "no process took the renderer's role" bash -c "! '$jolon' status -w $name | grep -q renderer"
"$jolon" stop -w "$name" >/dev/null
# A world without a set can be pictured and compared with its table.
"$bin/jolon-world" create --world "$name" --set renderer.width=160 --set renderer.height=90 duel >/dev/null
"$bin/jolon-world" dump -w "$name" --json >dump.json
check "a picture of a paused world is taken" snap --view chase --vehicle 1 still.png
check "the picture's statistics agree with the table (row 13)" python3 - "$(comment still.png)" <<'P'
import json, sys
words = dict(word.split("=", 1) for word in sys.argv[1].split(" "))
row = next(r for r in map(json.loads, open("dump.json")) if r["id"] == 1)
assert words["state"] == row["state"] and words["damage"] == row["damage"], (words, row)
assert int(words["rounds"]) == row["rounds"], (words, row)
for key, mine, scale in (("speed_mps", "speed_kmh", 3.6), ("heading_deg", "heading_deg", 1.0),
                         ("pitch_deg", "pitch_deg", 1.0), ("roll_deg", "roll_deg", 1.0)):
    assert abs(row[key] * scale - float(words[mine])) < 0.0051, (key, words, row)
assert abs(row["position"][1] - float(words["altitude_m"])) < 0.0051, (words, row)
P
snap --view chase --vehicle 1 once.png && snap --view chase --vehicle 1 twice.png
check "the same picture taken twice is equal to the byte" cmp once.png twice.png
check "the picture is taken on two threads" snap --view chase --vehicle 1 --threads 2 threads.png
check "that picture is equal to the byte" cmp once.png threads.png
"$bin/jolon-world" remove -w "$name"

# --- refusals -------------------------------------------------------------------------------------
refuses "snap without a file" 2 'snap needs a FILE' snap
refuses "snap without a world" 1 "there is no world \"$name\"; jolon worlds" snap x.png
refuses "snap with an unknown option" 2 'snap --fps: no such option; there are --view' snap --fps 3 x.png
refuses "an unknown view" 2 'bird is not one of chase, map, inside' "$renderer" --snap x.png --view chase,bird
refuses "a view twice" 2 'chase is there twice' "$renderer" --snap x.png --view both,chase
refuses "a view whose id is no number" 2 "after the colon comes a vehicle's id" "$renderer" --snap x.png --view chase:x
refuses "an invalid size" 2 'not WxH with each from' "$renderer" --snap x.png --size 10
refuses "a direction without a place" 2 'give --eye X,Z too' "$renderer" --snap x.png --look 0,0
refuses "a place without its view" 2 'give --view free too' "$renderer" --snap x.png --eye 1,1 --view chase
refuses "a place outside of any map" 2 'X is from 0 to 500000' "$renderer" --snap x.png --eye 600000,1
refuses "an unknown back end" 2 'not one of auto, gl, soft' "$renderer" --snap x.png --backend d3d
refuses "a device for the software rasteriser" 2 'needs none' "$renderer" --snap x.png --backend soft --device 0
refuses "an unknown quality" 2 'not one of fixed, hold' "$renderer" --snap x.png --quality best
refuses "a rate too high" 2 'fps' "$renderer" --out o --fps 121
refuses "an unknown view in a scenario" 1 'renderer.view = bird: unknown; allowed: chase, map' \
    "$jolon" run -w "$name" --set renderer.view=bird duel
done_testing
