#!/usr/bin/env bash
# jolon drive: a person on a terminal takes a tank, drives it, sees it move, fires, and gives it
# back. A client that dies loses its vehicle, a second driver is refused, the statistics are those
# of the table, and a key moves the vehicle soon.
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
lag=$bin/../tests/lag/lag

dump() { "$jolon" world dump --json -w "$name"; }
of() { # ID KEY: prints an entity's value in the table
    dump | python3 -c "import json,sys; print([e for e in map(json.loads, sys.stdin) if e['id'] == $1][0]['$2'])"
}
is() { [ "$(of "$1" "$2")" = "$3" ]; }
more() { python3 -c "import sys; sys.exit(not float('$1') > float('$2'))"; }

cat >field.cfg <<'C'
terrain = { source = "flat"; height_m = 5.0; };
vehicles = ( { kind = "tank"; name = "T1"; force = "blue"; behaviour = "idle"; at = [1000.0, 1000.0]; heading_deg = 90.0; },
             { kind = "truck"; name = "Far"; force = "red"; behaviour = "idle"; at = [2000.0, 1000.0]; },
             { kind = "tank"; name = "T3"; force = "blue"; behaviour = "idle"; at = [1000.0, 4000.0]; },
             { kind = "jeep"; name = "J4"; force = "neutral"; behaviour = "idle"; at = [4000.0, 4000.0]; } );
C
check "a set starts" "$jolon" start -w "$name" --without renderer --out out field.cfg

# --- a person on a terminal ---------------------------------------------------------------------
check "a tank is taken, driven, seen to move, fired and given back on a terminal" \
    python3 "$here/driver.py" "$jolon" "$name"
check "the tank returns to its behaviour" eventually is 1 behaviour idle
check "the shot is an event" bash -c "'$jolon' events --json -w $name | grep '\"type\":\"fire\"' | grep -q '\"id\":1,'"

# --- keys from a pipe ---------------------------------------------------------------------------
# Presses until the vehicle is seen to move: a program that starts late reads all earlier keys at once.
press() {
    for _ in {1..100}; do
        printf w
        sleep 0.15
        ! grep -q 'speed_mps=[1-9]' plain || break
    done
    printf q
}
: >plain
press | "$jolon" drive J4 --plain -w "$name" >plain 2>&1
check "keys from a pipe drive a vehicle" more "$(of 4 position | tr -d '[]' | cut -d, -f3)" -1
check "the driven vehicle moved" bash -c "grep -q 'speed_mps=[1-9]' plain"
check "the vehicle was released at the end" eventually is 4 behaviour idle
check "one line says that only keys are in use" [ "$(grep -c 'in use: keys' plain)" = 1 ]

# --- a vehicle that is lost -----------------------------------------------------------------------
mkfifo keys
exec {keys}<>keys
"$jolon" drive J4 --plain -w "$name" <keys >lost 2>&1 &
check "J4 is taken again" eventually is 4 behaviour driven
"$jolon" ctl remove J4 -w "$name" >/dev/null
told() { [ "$(grep -c 'is gone; n takes the next vehicle' lost)" = "$1" ]; }
check "a loss is told at once" eventually told 1
printf ' ' >&$keys
check "and again to who would fire" eventually told 2
printf q >&$keys
wait $!
exec {keys}>&-
check "and not more often" told 2

# --- a client that dies -------------------------------------------------------------------------
sleep 12 | "$bin/jolon-drive" T3 --plain -w "$name" >held 2>&1 &
holder=$!
check "T3 is taken" eventually is 3 behaviour driven
sleep 12 | "$jolon" drive 3 --plain -w "$name" >second 2>&1 &
second=$!
check "a second driver is refused with the next step" eventually grep -q 'T3 (tank 3): another client drives it; n takes the next' second
check "the first driver keeps the vehicle" is 3 behaviour driven
kill $second
{ kill -KILL $holder && wait $holder; } 2>/dev/null
check "the tank goes back to its agent when the lease is over" eventually is 3 behaviour idle
check "the change names the end of the lease as its reason" bash -c "'$jolon' events --json -w $name | grep -q '\"because\":\"lease over\"'"

# --- statistics (row 13) ------------------------------------------------------------------------
"$jolon" ctl drive 1 --throttle 0.5 --steer 0.2 -w "$name" >/dev/null
"$jolon" ctl fire 1 -w "$name" >/dev/null
sleep 1
"$jolon" ctl release 1 -w "$name" >/dev/null
"$jolon" ctl pause -w "$name" >/dev/null
(sleep 1; printf u; sleep 0.5; printf q) | "$bin/jolon-drive" T1 --plain --rate 5 -w "$name" >shown 2>&1
dump >table
check "the displayed statistics are those of the table" python3 "$here/seen.py" shown table 1
"$jolon" ctl resume -w "$name" >/dev/null

# --- refusals -----------------------------------------------------------------------------------
"$jolon" drive Nobody --plain -w "$name" </dev/null >told 2>err
check "an unknown vehicle is refused with 1" equal $? 1
check "the refusal names the next step" grep -q 'jolon world dump' err
"$jolon" drive --input gamepad --device /dev/null -w "$name" </dev/null >told 2>err
check "a file that is no device is refused with 1" equal $? 1
"$jolon" drive --input wheel -w "$name" </dev/null >told 2>err
check "wrong usage is refused with 2" equal $? 2

# --- the reporter is killed under a driver ------------------------------------------------------
(sleep 1.5; printf w; sleep 1.5; printf q) | "$jolon" drive T1 --plain -w "$name" >through 2>&1 &
check "T1 is taken" eventually is 1 behaviour driven
"$jolon" kill -w "$name" reporter >/dev/null
wait $!
check "the driver keeps driving when the reporter is killed" grep -Eq 'session=driving .* throttle=0\.[1-9]' through

# --- lag ----------------------------------------------------------------------------------------
"$lag" -w "$name" --presses 12 "$bin/jolon-drive" 1 >figures 2>&1
echo "# figures: $(cat figures)"
under_three() { [ "$(sed -E 's/.*frames median ([0-9]+) .*/\1/' figures)" -lt 3 ]; }
check "a key moves the vehicle within three frames at the median" under_three
"$lag" -w "$name" --input spacemouse --presses 12 "$bin/jolon-drive" 1 >figures 2>&1
echo "# figures: $(cat figures)"
check "a SpaceMouse moves the vehicle within three frames at the median" under_three
done_testing
