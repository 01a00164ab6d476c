#!/usr/bin/env bash
# A frame whose computation always kills its process ends the set. The frame's inputs are kept and
# can be run again. The test uses the programs with crash points.
. "$(dirname "$0")/lib.sh"
crash=${bin%/bin}/crash/bin
if [ ! -x "$crash/jolon-keeper" ]; then
    skip "poison frames" "no programs with crash points: make crash"
    done_testing
fi

cat >duel.cfg <<'TEXT'
world = { name = "duel"; seed = 5; capacity = 64; };
terrain = { source = "flat"; height_m = 100.0; };
objects = { source = "none"; };
vehicles = ( { kind = "tank"; at = [25000.0, 25000.0]; heading_deg = 90.0; speed_mps = 15.0; behaviour = "hold"; },
             { kind = "jeep"; at = [25010.0, 25000.0]; heading_deg = 270.0; speed_mps = 15.0; behaviour = "hold"; } );
TEXT
options=(--without renderer --without reporter --pace max)
expected=$("$jolon" run -w "$name" "${options[@]}" --frames 1 --json duel.cfg | json digest)

# poison ROLE POINT SIGNAL: makes the first frame kill every process of the role.
poison() {
    JOLON_CRASH="$1:$2:1:$3" "$crash/jolon" run -w "$name" "${options[@]}" --out "$1-$3" --frames 9 \
        duel.cfg >told 2>&1
}

for case in "collider:first store to the back buffer:11" "mover:moved:11"; do
    IFS=: read -r role point signal <<<"$case"
    poison "$role" "$point" "$signal"
    check "$case: the set gives up with exit code 3" equal $? 3
    check "$case: the message names the role and the frame" grep -q "$role died 3 times on frame 1" told
    check "$case: the frame is kept" [ -s "$role-$signal/poison-frame-1.jolon" ]
    check "$case: the frame's inputs can be run again" equal \
        "$("$jolon" world replay-frame "$role-$signal/poison-frame-1.jolon" | grep -o "$expected")" \
        "$expected"
    check "$case: nothing is left" nothing_left "$name"
done
done_testing
