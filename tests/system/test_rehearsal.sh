#!/usr/bin/env bash
# A scenario as a rehearsed event (row 16): vehicles are at the scripted places at the scripted
# times. The run ends with the same digest every time, on any number of threads, and when the mover
# is killed during it.
. "$(dirname "$0")/lib.sh"

frames=7200
play() { # AS [options]
    local as=$1
    shift
    "$jolon" run -w "$name" --without renderer --without reporter --pace max --json --frames $frames --out "$folder/out" \
        --events "$folder/$as.events" "$@" rehearsal >"$folder/$as.json" 2>"$folder/err" || sed 's/^/# /' "$folder/err"
}
digest() { json digest <"$folder/$1.json"; }

play one --threads 1
play three --threads 3
play again --threads 1
check "a second run ends with the same digest" equal "$(digest one)" "$(digest again)"
check "one thread and three threads give the same digest" equal "$(digest one)" "$(digest three)"

# Runs ten seconds in real time, so that the mover can be killed during the run.
play short --frames 600
play killed --frames 600 --pace real &
run=$!
eventually eval '[ "$(frame 2>/dev/null || echo 0)" -gt 200 ]'
check "the mover is killed during the run" "$jolon" kill -w "$name" mover
wait $run
check "the mover was restarted once" equal "$(json restarts <killed.json)" 1
check "the run whose mover was killed ends with the same digest" equal "$(digest short)" "$(digest killed)"

# The first shots of the run with their shooters and targets: two at trucks, one at the road, two at
# the tanks, which may fire back.
check "tanks and helicopters fire the scripted shots" python3 - "$folder/one.events" <<'P'
import json, sys
shots = [(e["shooter"]["kind"], e["target"]["kind"]) for e in map(json.loads, open(sys.argv[1]))
         if e["type"] == "fire" and e["shooter"]["id"]]
print(shots)
sys.exit(shots[:5] != [("tank", "truck")] * 2 + [("tank", "none")] + [("helicopter", "tank")] * 2)
P

# Compares the arrivals of the convoy's leader with its file of waypoints, at 60 Hz.
check "the convoy is at each waypoint at its time" python3 - "$folder/one.events" "$bin/../../config/scenarios/rehearsal-convoy.csv" <<'P'
import json, sys
arrived = [e for e in map(json.loads, open(sys.argv[1]))
           if e["type"] == "agent" and e["id"] == 1 and e["because"] == "arrived"]
times = [float(line.split(",")[0]) for line in open(sys.argv[2]).readlines()[1:]]
times = [t for t in times if t * 60 <= 6900]
frames = [e["frame"] for e in arrived]
print(frames[:8], [t * 60 for t in times[:8]])
sys.exit(not (len(frames) >= len(times) - 1 and
              all(min(abs(f - max(t * 60, 1)) for f in frames) <= 2 for t in times)))
P
done_testing
