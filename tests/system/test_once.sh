#!/usr/bin/env bash
# Exactly once: the reporter, the intake and a subscriber that stores its events are killed
# repeatedly. In the end the subscriber has every event of the run once, and each command sent
# meanwhile is done once. ROUNDS=n kills, SPAWNS=n commands and SEED=n choose others.
scenario=$(cd "$(dirname "$0")/../storm" && pwd)/crowd.cfg
. "$(dirname "$0")/lib.sh"
listener=$bin/../tests/once/listener
rounds=${ROUNDS:-16}
spawns=${SPAWNS:-24}
RANDOM=${SEED:=$((RANDOM))}
echo "# SEED=$SEED ROUNDS=$rounds SPAWNS=$spawns"
ctl="$bin/jolon-ctl -w $name --timeout 60"

check "a set starts" "$jolon" start -w "$name" --without renderer --out "$folder/out" \
    --events "$folder/events" "$scenario"
vehicles=$("$jolon" status -w "$name" --json | json vehicles)

# A process that is stopped from outside is replaced however often this happens. It is not given up
# like one that crashes.
replaced() { local now; now=$(pid "$1") && [ "$now" != "$before" ]; }
stop_often() {
    local _
    for _ in 1 2 3 4 5 6; do
        before=$(pid reporter)
        "$jolon" kill -w "$name" reporter STOP && eventually replaced reporter || return 1
    done
}
check "a reporter that is stopped six times in a row is replaced each time" stop_often

listen() { "$listener" --world "$name" --log "$folder/heard" 2>>"$folder/said" & listening=$!; }
deafen() { { kill -KILL $listening; wait $listening; } 2>/dev/null; }

listen
seq 22000 25 $((22000 + 25 * (spawns - 1))) | xargs -P 2 -I{} $ctl spawn jeep --at {},24000 >replies &
sender=$!
reporters=0 listeners=0 intakes=0
for _ in $(seq "$rounds"); do
    sleep "0.$((RANDOM % 9))$((RANDOM % 10))"
    case $((RANDOM % 4)) in
    0) deafen; listeners=$((listeners + 1)); listen ;;
    1) deafen; "$jolon" kill -w "$name" reporter && reporters=$((reporters + 1))
        listeners=$((listeners + 1)); listen ;;
    2) "$jolon" kill -w "$name" intake && intakes=$((intakes + 1)) ;;
    *) "$jolon" kill -w "$name" reporter && reporters=$((reporters + 1)) ;;
    esac >/dev/null 2>&1
done
echo "# killed: the reporter $reporters times, the intake $intakes, the subscriber $listeners times"
wait $sender
check "every command was answered" equal "$?" 0
check "each command spawned a vehicle of its own" equal "$(awk '{ print $3 }' replies | sort -u | wc -l)" "$spawns"
check "the world is paused" $ctl pause
check "no command was lost or done twice" \
    equal "$("$jolon" status -w "$name" --json | json vehicles)" "$((vehicles + spawns))"

# The log continues after its last line, also when that line is a command's, which has a number of
# its own.
log_again() {
    before=$(pid recorder)
    eventually eval 'tail -n 1 "$folder/events" | grep -q "\"command\":\"pause\""' &&
        "$jolon" kill -w "$name" recorder && eventually replaced recorder && $ctl resume && $ctl pause
}
check "the recorder is killed after a command's line" log_again
cat >"$folder/row" <<'P'
import json, sys
row = [json.loads(line)["sequence"] for line in open(sys.argv[1])]
assert row == list(range(len(row))), "lost or repeated in the log"
P
check "its log continues after that line" python3 "$folder/row" "$folder/events"

# Compares the received events by their keys with the log of events, which has every event
# (test_kill.sh).
cat >"$folder/compare" <<'P'
import json, sys
topics = ["collision", "fire", "detonation", "crater", "agent", "contact_end"]
happened = [(topics.index(e["type"]), e["frame"], e["index"])
            for e in map(json.loads, open(sys.argv[1])) if e["type"] in topics]
heard = [tuple(map(int, line.split())) for line in open(sys.argv[2])]
keys = [(topic, frame, index) for topic, run, sequence, frame, index in heard]
if sys.argv[3] == "once":
    twice = len(keys) - len(set(keys))
    assert not twice, f"{twice} heard twice"
    sys.exit()
lost, strange = set(happened) - set(keys), set(keys) - set(happened)
print(f"{len(happened)} happened, {len(keys)} heard")
assert len(happened) > 100 and not lost and not strange, \
    f"{len(lost)} lost, such as {sorted(lost)[:3]}; {len(strange)} that never happened"
P
compare() { python3 "$folder/compare" "$folder/events" "$folder/heard" "$1"; }
eventually compare all
check "the subscriber has every event" compare all
check "the subscriber has each event once" compare once
check "the subscriber missed no event on the way" eval '! grep -q follows "$folder/said"'
kill $listening
wait $listening 2>/dev/null
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
[ $failures = 0 ] || tail -n 5 "$folder/out/jolon.log" | sed 's/^/# /'
done_testing
