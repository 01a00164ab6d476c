#!/usr/bin/env bash
# A run is reproducible: 600 frames of the Hunter-Liggett world give the same digest every time, on
# one thread and on two. The run leaves nothing behind.
. "$(dirname "$0")/lib.sh"

run() { "$jolon" run -w "$name" --pace max --frames 600 --json --out "$folder/out" "$@" 2>"$folder/err"; }

check "a run ends with 0" run --without renderer --events "$folder/events" && cp check first
run --without renderer --without reporter >second
run --without renderer --without reporter --threads 2 >third
run --without renderer --without reporter --seed 7 >other
digest=$(json digest <first)
check "the digest is 16 hex digits" grep -Eqx '[0-9a-f]{16}' <<<"$digest"
check "the same run has the same digest" equal "$(json digest <second)" "$digest"
check "the same run has the same events" equal "$(json event_digest <second)" "$(json event_digest <first)"
check "two threads give the same digest" equal "$(json digest <third)" "$digest"
run --without renderer --without reporter --set renderer.follow=250 >followed
check "the followed vehicle changes nothing: all collisions are found (row 40)" equal "$(json digest <followed)" "$digest"
check "another seed gives another run" [ "$(json digest <other)" != "$digest" ]
check "frame 600 is the last" equal "$(json frame <first)" 600
check "ten seconds were simulated" equal "$(json sim_time_s <first)" 10
check "the world has 500 vehicles (row 7)" equal "$(json vehicles <first)" 500
check "the world has 40,303 fixed objects (row 2)" equal "$(json fixed_objects <first)" 40303
check "nothing was restarted" equal "$(json restarts <first)" 0
for key in world munitions events collisions detonations craters destroyed late_frames \
    frame_ms.p50 mover_ms.p99 collider_ms.max wall_s; do
    check "the summary has $key" json $key <first
done
"$jolon" start -w "$name" --without renderer --out paced >started 2>&1
time_begins
sleep 5
check "detection and response do not make frames late (row 35)" in_time "frames / 10"
check "detection and response do not slow the simulation" at_pace 5
"$jolon" stop -w "$name" >stopped 2>&1
check "detection and response take a small part of a frame (row 35)" \
    python3 -c "import sys; sys.exit($(json collider_ms.p50 <first) > 1000 / 60 / 4)"
check "shots were fired" [ "$(json detonations <first)" -gt 0 ]
check "the log holds every event once, in order" python3 - "$folder/events" "$(json events <first)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert len(lines) == int(sys.argv[2]), (len(lines), sys.argv[2])
assert [line["sequence"] for line in lines] == list(range(len(lines)))
keys = [(line["frame"], line["index"]) for line in lines]
assert keys == sorted(set(keys))
P
check "the runs leave no shared memory" nothing_left "$name"
done_testing
