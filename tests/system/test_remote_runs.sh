#!/usr/bin/env bash
# Long: the world runs in real time for half a minute, or with KILLS=1000 for four.
# Runs with entities of other simulators: their markings are shown, their guided missiles fly, their rounds and collisions strike ours,
# and the log gives the same digest on 1 and 4 threads, from a checkpoint, on branches, and after kills. SEED=n draws other kills, KILLS=n as many.
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
RANDOM=${SEED:=$RANDOM}
echo "# SEED=$SEED"
read -r in out_port <<<"$(python3 -I -S -c 'import socket
s = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in "ab"]
for i in s: i.bind(("127.0.0.1", 0))
print(*[i.getsockname()[1] for i in s])')"
rows() { "$bin/jolon-world" dump --world "$name" --json; }
cat >field.cfg <<'END'
world = { capacity = 2048; remotes_max = 400; };
terrain = { source = "flat"; height_m = 300.0; };
objects = { source = "none"; };
vehicles = ( { kind = "tank"; name = "Target"; force = "blue"; behaviour = "idle"; at = [25000.0, 25000.0]; heading_deg = 0.0; },
             { kind = "tank"; name = "Rammed"; force = "blue"; behaviour = "idle"; at = [25000.0, 25300.0]; heading_deg = 0.0; },
             { kind = "jeep"; count = 20; behaviour = "patrol"; area = [24000.0, 24000.0, 26000.0, 26000.0]; } );
END
send() { "$jolon" dis send --to "127.0.0.1:$in" "$@" >/dev/null; }
eastern() { # X Z: the place so far east and south of the middle, for jolon dis send
    python3 -I -S "$here/dis_place.py" "$1" "$2" 300; }
who() { rows | python3 -I -S -c 'import json, sys
print(*sorted((d["remote"], d["id"]) for d in map(json.loads, sys.stdin) if "remote" in d))'; }

"$jolon" start -w "$name" --without renderer --out out --checkpoint early.image --every 120 \
    --dis "127.0.0.1:$out_port" --set "gateway.listen=127.0.0.1:$in" --set gateway.site=10 --set gateway.timeout_s=600 field.cfg >/dev/null

# --- what is shown --------------------------------------------------------------------------------------
send entity-state id=9:1:7 type=1.1.222.1.2.1.0 force=2 place="$(eastern 500 0)" attitude=270,0,0 marking=ABRAMS-7
send entity-state id=9:1:8 type=2.2.225.1.3.1.0 force=2 place="$(eastern 300 -300)" attitude=270,0,0 marking=HELLFIRE
check "a marking is in the dump" eventually eval 'rows | grep -q "\"marking\": *\"ABRAMS-7\""'
check "a guided missile is in flight" eval 'rows | grep HELLFIRE | grep -q "\"behaviour\": *\"flight\""'
named() { timeout 5 "$jolon" monitor -w "$name" --once --json --filter abrams | grep -q '"name": *"ABRAMS-7"'; }
check "the monitor has the marking" eventually named
"$bin/jolon-console" -w "$name" --port 0 --token-file token >url 2>log &
console=$!
check "the page has the marking in its list and on its map" eventually python3 -I -S -c '
import json, urllib.request
base = open("url").read().split("#")[0].strip() + "api/"
ask = lambda path: json.load(urllib.request.urlopen(base + path, timeout=5))
assert [row["name"] for row in ask("list?search=abrams")["rows"]] == ["ABRAMS-7"]
assert sorted(ask("state")["markings"].values()) == ["ABRAMS-7", "HELLFIRE"]'
kill $console; wait $console 2>/dev/null

# --- what strikes ours ----------------------------------------------------------------------------------
target=$(rows | python3 -I -S -c 'import json, sys
print(*[d["id"] for d in map(json.loads, sys.stdin) if d.get("name") in ("Target", "Rammed")])')
read -r target rammed <<<"$target"
send fire firer=9:1:7 target="10:1:$target" event=9:1:1 munition_type=2.2.225.2.13.1.0 place="$(eastern 500 0)"
send detonation firer=9:1:7 target="10:1:$target" event=9:1:1 munition_type=2.2.225.2.13.1.0 place="$(eastern 0 0)" point=3,0,0 result=1
send collision issuer=9:1:7 other="10:1:$rammed" event=9:1:2 mass=50000 velocity="$(python3 -I -S "$here/dis_place.py" --direction 0 15 0)" point=3,0,0
strikes() { "$jolon" events -w "$name" --json 2>/dev/null | grep "\"$1\"" | grep -q '"remote": *true'; }
check "a detonation of another simulator strikes" eventually strikes detonation
check "so does a collision of which ours knows nothing" eventually strikes collision

# --- kills, checkpoints, branches -----------------------------------------------------------------------
# A vehicle that moves and of which its owner says nothing while the crowd goes round the ring of records, 4 s a time.
seldom() { send entity-state id=9:2:9 type=1.1.222.1.2.1.0 force=2 dead_reckoning=2 velocity="$(python3 -I -S "$here/dis_place.py" --direction 1 0 0)" "$@"; }
seldom place="$(eastern -500 500)" marking=FIRST
(exec python3 -I -S "$here/dis_crowd.py" "127.0.0.1:$in" 200 5 100000 moving >/dev/null) &
sender=$!
check "a crowd of 200 comes" eventually eval '[ "$(who | grep -o : | wc -l)" -ge 400 ]'
sleep 0.5
who >before
kills=${KILLS:-25} roles=(mover collider gateway recorder intake reporter)
for ((i = 0; i < kills; i++)); do
    "$jolon" kill -w "$name" "${roles[RANDOM % 6]}" >/dev/null 2>&1
    sleep 0.0$((RANDOM % 9))
done
sleep 4
"$jolon" kill -w "$name" gateway >/dev/null 2>&1
kills=$((kills + 1))
sleep 7
seldom place="$(eastern -490 500)" marking=SECOND # from another port
sleep 1
check "who had a vehicle first has it, also after a kill when the ring of records has gone round" eval '
    rows | grep 9:2:9 | grep -q "FIRST"'
who >after
check "after $kills kills each is there once, and has the id that it had" cmp before after
kill $sender
wait $sender 2>/dev/null
"$jolon" stop -w "$name" >/dev/null
replay() { "$jolon" replay "$@" out/commands.log; }
check "the log replays on one thread" eval 'replay --threads 1 | grep "equal to the run that was recorded"'
check "and its physics are good: what others move is not judged" eval '"$jolon" replay --physics out/commands.log | grep "^physics: good"'
check "and on four" eval 'replay --threads 4 | grep "equal to the run that was recorded"'
check "so it does up to frames before the end" eval '
    for frames in 300 450; do
        [ "$(replay --threads 1 --frames $frames --json | json digest)" = "$(replay --threads 4 --frames $frames --json | json digest)" ] || exit 1
    done'
branch() { # THREADS OPTION...: the digest 200 frames after the checkpoint, without the other simulators
    local threads=$1
    shift
    "$jolon" run -w "$name" --from early.image --frames $((at + 200)) --pace max --threads "$threads" --without renderer --without reporter \
        --out "out-$threads-$RANDOM" --set gateway.enabled=false --json "$@" 2>/dev/null | json digest
}
at=$(grep -ao 'checkpoint early.image: frame [0-9]*' out/jolon.log | tail -n 1 | grep -o '[0-9]*$')
echo "# the checkpoint is of frame $at"
check "a branch from a checkpoint is the same on 1 and 4 threads" eval 'one=$(branch 1); [ -n "$one" ] && equal "$one" "$(branch 4)"'
check "another seed is another branch" eval '[ "$(branch 1)" != "$(branch 1 --set world.seed=77)" ]'

# --- owners ---------------------------------------------------------------------------------------------
"$jolon" start -w "$name" --from early.image --without renderer --without reporter --out out-more >/dev/null
eventually grep -q "receives at" out-more/jolon.log
sleep 7
seldom place="$(eastern -490 500)" marking=SECOND
sleep 1
check "who had a vehicle first has it in a run that continues from a checkpoint, too" eval '
    rows | grep 9:2:9 | grep -q "FIRST"'
"$jolon" stop -w "$name" >/dev/null
done_testing
