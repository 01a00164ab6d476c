#!/usr/bin/env bash
# Monitors attach and detach at any time, commands are answered with the frame of their effect, and
# none of this makes the simulation late or leaves anything behind.
. "$(dirname "$0")/lib.sh"

ctl() { "$jolon" ctl -w "$name" "$@"; }
dump() { "$jolon" world dump --json -w "$name"; }
speed_of() { dump | python3 -c "import json,sys; print([e for e in map(json.loads, sys.stdin) if e['id'] == $1][0]['speed_mps'])"; }

cat >field.cfg <<'C'
terrain = { source = "flat"; height_m = 5.0; };
vehicles = ( { kind = "tank"; name = "T1"; force = "blue"; behaviour = "idle"; at = [1000.0, 1000.0]; heading_deg = 90.0; },
             { kind = "tank"; name = "T2"; force = "red"; behaviour = "idle"; at = [1400.0, 1000.0]; } );
C
check "a set starts" "$jolon" start -w "$name" --without renderer --out out field.cfg
time_begins
check "a monitor prints the status once" "$jolon" monitor -w "$name" --once --json
cp check once
check "the status names the world" equal "$(json world <once)" "$name"
check "the status says running" equal "$(json state <once)" running
check "the status counts the vehicles" equal "$(json vehicles <once)" 2
for key in commit moved sim_time_s hz paused events roles.0.role roles.0.pid roles.0.state \
    roles.0.beat_age_ms roles.0.restarts roles.0.stage_ms; do
    check "the status has $key" json $key <once
done
check "the status lists the vehicles of the filter" equal \
    "$("$jolon" monitor -w "$name" --once --json --filter 'red tank' | json list.0.id)" 2
refuses_usage() { "$jolon" monitor -w "$name" --filter red; [ $? = 2 ]; }
check "a filter without --json is refused with 2" refuses_usage
timeout 3 "$jolon" monitor -w "$name" >lines 2>&1
check "a monitor without a terminal writes lines" [ "$(wc -l <lines)" -ge 2 ]
screen() { TERM=xterm-256color timeout 3 script -qec "'$jolon' monitor -w $name" /dev/null </dev/null >screen 2>&1; grep -a -q "$name" screen; }
coloured() { grep -a -Eq $'\e\\[(3[0-9]|38;5;[0-9]+)m' screen; }
if command -v script >/dev/null; then
    check "a monitor on a terminal shows a screen in colours" eval 'screen && coloured'
    check "NO_COLOR turns the colours off" eval 'NO_COLOR=1 screen && ! coloured'
    check "an empty NO_COLOR leaves the colours on" eval 'NO_COLOR= screen && coloured'
else
    skip "colours on a terminal" "no script here"
fi
for _ in 1 2 3 4 5; do "$jolon" monitor -w "$name" >/dev/null 2>&1 & monitors+=($!); done
sleep 0.5
kill -KILL "${monitors[@]}"
{ wait "${monitors[@]}"; } 2>/dev/null
before=$(frame)
check "the world goes on when five monitors are killed" bash -c "sleep 0.3; [ \$('$bin/jolon-world' frame --world $name) -gt $before ]"

check "pause is answered with its frame" bash -c "'$jolon' ctl -w $name pause | grep -Eq 'frame [0-9]+'"
at=$(frame)
sleep 0.2
check "a paused world computes no frame" equal "$(frame)" "$at"
check "step is accepted" ctl step 5
sleep 0.3
check "step 5 computes five frames, besides the command's frame" [ "$(frame)" -ge $((at + 5)) ] && [ "$(frame)" -le $((at + 6)) ]
check "resume is accepted" ctl resume
check "scale is accepted" ctl scale 2
check "drive is accepted" ctl drive 1 --throttle 1
sleep 1
check "the driven tank moves (row 10)" python3 -c "import sys; sys.exit(not float('$(speed_of 1)') > 1)"
check "release is accepted" ctl release 1
check "spawn is accepted" ctl spawn jeep --at 2000,2000 --force blue
check "fire is accepted, as soon as the gun is laid" eventually ctl fire 1 --target 2
sleep 0.3
check "a vehicle that is fired upon reacts (row 9)" bash -c "'$jolon' events --json -w $name | grep '\"id\":2,' | grep -q '\"because\":\"fired upon\"'"
check "remove is accepted" ctl remove 3
ctl remove 4711 >told 2>err
check "an unknown vehicle is refused with 1" equal $? 1
check "the refusal gives the reason" grep -q 'no such entity' err
ctl scale banana >told 2>err
check "wrong usage is refused with 2" equal $? 2
check "commands are events" bash -c "'$jolon' events --json -w $name | grep -q '\"command\":\"drive\"'"
# At twice the rate a frame has less time to spare.
check "the frames were on time" in_time "frames / 10" 6
check "quit ends the run" ctl quit
check "nothing is left" eventually nothing_left "$name"
done_testing
