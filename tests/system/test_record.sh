#!/usr/bin/env bash
# A recording can be replayed: the log of commands gives the run's digests, although recorders are
# killed, disks are full, and worlds continue from a checkpoint. The first difference between two
# runs is named. KILLS=n and SEED=n choose others.
# Long: it kills recorders one after the other.
. "$(dirname "$0")/lib.sh"
kills=${KILLS:-15}
RANDOM=${SEED:=$((RANDOM))}
echo "# SEED=$SEED KILLS=$kills"
ctl() { "$jolon" ctl -w "$name" "$@"; }
replay() { "$bin/jolon-world" replay --json "$@"; }
compare() { "$bin/jolon-world" diff "$@"; }
start() { "$jolon" start -w "$name" --without renderer --out out "$@"; }
end_of() { tail -n 1 "$1" | json "$2"; }
at_frame() { [ "$(frame)" -ge "$1" ]; }

# --- a run with commands, its recorder killed again and again ------------------------------------------
check "a run starts" start --events events
(
    for n in $(seq $((kills * 2))); do
        ctl --timeout 30 spawn tank --at "25000,$((24000 + 12 * n)).125" >spawned || exit 1
        ctl --timeout 30 drive "$(awk '{ print $3 }' spawned)" --throttle 0.3 --steer -0.1 || exit 1
    done
) >/dev/null 2>&1 &
commands=$!
sent=0
while [ $sent -lt "$kills" ]; do
    eventually pid recorder
    "$jolon" kill -w "$name" recorder >/dev/null 2>&1 && sent=$((sent + 1))
    sleep "0.$((RANDOM % 20 + 5))"
done
wait $commands
check "the run's commands are answered" equal $? 0
check "an image of the run is saved" "$bin/jolon-world" save --world "$name" image
ctl pause >/dev/null
check "its log equals the running world" eventually compare out/commands.log "$name"
ctl resume >/dev/null
eventually at_frame $(($(frame) + 60))
check "the set stops" "$jolon" stop -w "$name"
check "the log has its end line" equal "$(end_of out/commands.log type)" end
check "after $sent kills every command is in the log" python3 - out/commands.log $((kills * 4 + 2)) <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
commands = [line["commands"] for line in lines if line["type"] == "command"]
assert commands == list(range(1, int(sys.argv[2]) + 1)), commands
assert not [line for line in lines if line["type"] == "gap"]
P
check "the log is replayed" eval 'replay out/commands.log --events again >played'
check "the replay has the run's digest" equal "$(json digest <played)" "$(end_of out/commands.log digest)"
check "the replay has the run's event digest" equal "$(json event_digest <played)" "$(end_of out/commands.log event_digest)"
check "the replay reports that it equals the run" equal "$(json equal <played)" True
check "a replay on two threads has the same digest" eval '[ "$(replay out/commands.log --threads 2 | json digest)" = "$(json digest <played)" ]'
check "the replay's log of events is the same to the byte" cmp events again
check "summary and log agree" grep -q "digest $(json digest <played), of events $(json event_digest <played)" out/jolon.log
check "the image is a frame of the log" eval 'compare image out/commands.log | grep -q "equal up to frame"'

# --- a recorder that is killed around the end of a run -----------------------------------------------
# The keeper is stopped while the recorder is killed and the run ends. When it continues, it learns of
# both at once. The recorder that it starts for the end of the log is then killed a few times more.
cat >small.cfg <<'X'
world = { capacity = 64; }; terrain = { source = "flat"; }; objects = { source = "none"; };
vehicles = ( { kind = "tank"; name = "T"; at = [1000.0, 1000.0]; } );
X
over() { [ "$(frame)" = 30 ]; }
killed_at_the_end() { # KILLS after the run's end
    local run keeper n
    "$jolon" run -w "$name" --frames 30 --without renderer --without reporter --out ends small.cfg >told 2>&1 &
    run=$!
    eventually pid recorder
    keeper=$(cat "$(path_of lock)")
    eventually at_frame 1
    kill -STOP "$keeper"
    kill -KILL "$(pid recorder)"
    eventually over
    kill -CONT "$keeper"
    for n in $(seq "$1"); do kill -KILL "$(pid recorder)" 2>/dev/null; done
    wait $run && [ "$(end_of ends/commands.log type) $(end_of ends/commands.log frame)" = "end 30" ]
}
for n in 0 0 1 2 5 10; do
    check "the log ends with the run when its recorder was killed, and $n times more" killed_at_the_end "$n"
done

# --- refusals -----------------------------------------------------------------------------------------
refused() { # PATTERN COMMAND...: exit 1, one line
    local pattern=$1
    shift
    "$@" >stdout 2>stderr
    [ $? = 1 ] && [ "$(wc -l <stderr)" = 1 ] && grep -Eq -- "$pattern" stderr
}
flip() { python3 -c '
import sys
data = bytearray(open(sys.argv[1], "rb").read())
data[len(data) // 2] ^= 4
open(sys.argv[2], "wb").write(data)' "$1" "$2"; }
flip out/commands.log flipped
check "a flipped bit is refused with its line" refused '^jolon-world: flipped:[0-9]+: ' replay flipped
sed 2d out/commands.log >shorter
check "a missing line is refused with its place" refused 'shorter:2: ' replay shorter
head -c -20 out/commands.log >torn
check "a torn end is left out and reported" eval 'replay torn >stdout 2>stderr && grep -q "torn" stderr'
check "a file that is no log of commands is refused" refused 'is no log of commands' replay events
cp "$(dirname "$bin")/../config/scenarios/duel.cfg" mine.cfg 2>/dev/null ||
    cp "$(dirname "$bin")/../../config/scenarios/duel.cfg" mine.cfg
"$jolon" run -w "$name" --frames 60 --pace max --out mine mine.cfg --without renderer --without reporter >/dev/null 2>&1
check "a run of a copied scenario is replayed" replay mine/commands.log
echo "# changed" >>mine.cfg
check "a scenario that has changed is refused" refused 'another scenario.*has changed since' replay mine/commands.log

# --- differences between runs ---------------------------------------------------------------------------
brief() { "$jolon" run -w "$name" --frames 120 --pace max --without renderer --without reporter --out "$@" >/dev/null 2>&1; }
brief one
brief same
brief other --seed 7
check "two equal runs are equal to their end" eval '[ "$(compare one/commands.log same/commands.log)" = "equal up to frame 120" ]'
compare one/commands.log other/commands.log >different
check "a run with another seed differs" equal $? 1
check "the first differing frame and field are named" grep -Eq '^frame 0: [a-z_]+ of entity [0-9]+.*: .+ \| .+' different
brief impulse --set collision.response=figure8
compare --json one/commands.log impulse/commands.log >different
check "a run with another collision response differs" equal $? 1
check "the difference is also available as JSON" eval '[ "$(json frame <different)" -gt 0 ] && [ -n "$(json field <different)" ]'

# --- from a checkpoint ----------------------------------------------------------------------------------
check "a world continues from the image" "$bin/jolon-world" create --from image --world "$name" --set world.pace=max --set world.frames=$(($(json frame <played) + 60))
cp events events.from
"$bin/jolon-recorder" --world "$name" --commands from.log --events events.from 2>from.err &
recorder=$!
check "the world's recorder is ready" eventually grep -q '"type":"begin"' from.log
"$bin/jolon-collider" --world "$name" 2>/dev/null & collider=$!
"$bin/jolon-mover" --world "$name" 2>/dev/null
"$bin/jolon-ctl" --help >/dev/null 2>&1
kill -TERM $collider 2>/dev/null
wait $collider
kill -TERM $recorder
wait $recorder
check "the continued run ends with 0" equal $? 0
check "the continued run is replayed from the image" replay from.log
check "the log of events continues with each event once" python3 - events.from <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(len(lines)))
P
check "events beyond the image are kept in another file" [ -s events.from.old ]
"$bin/jolon-world" remove --world "$name"

# --- a full disk ----------------------------------------------------------------------------------------
mkdir disk
if mount -t tmpfs -o size=64k,mode=700 tmpfs disk 2>/dev/null; then
    # The set starts first: a file system cannot be unmounted while it is written to.
    at_end_disk() {
        cd "$folder" && "$jolon" stop -w "$name" >/dev/null 2>&1
        umount disk 2>/dev/null
        at_end
    }
    trap at_end_disk EXIT
    start --events disk/events >/dev/null
    check "a full disk is reported" eventually grep -q 'disk/events: cannot write: No space left' out/jolon.log
    "$jolon" kill -w "$name" recorder >/dev/null
    eventually at_frame $(($(frame) + 120))
    check "the world goes on" at_frame 120
    mount -o remount,size=64m disk
    check "the log is written when there is room again" eventually grep -q 'disk/events: can be written again' out/jolon.log
    "$jolon" stop -w "$name" >/dev/null
    cp disk/events full
    check "the log has every event once" python3 - full "$(end_of out/commands.log events)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(int(sys.argv[2])))
P
    check "the run is replayed" replay out/commands.log
    umount disk

    # A swarm of jets comes near and parts two hundred times a frame, which fills the ring in 350 frames.
    cat >swarm.cfg <<'CFG'
world = { capacity = 1024; pace = "max"; };
terrain = { source = "flat"; };
collision = { method = "mps"; response = "none"; mps = { near_m = 100.0; }; };
vehicles = ( { kind = "jet"; count = 700; behaviour = "patrol"; area = [25000.0, 25000.0, 25900.0, 25900.0]; } );
CFG
    happened() { "$jolon" status -w "$name" --json | json events; }
    has_events() { [ "$(happened)" -gt "$1" ]; }
    end_swarm() {
        ctl --timeout 30 quit >/dev/null
        eventually eval '[ -z "$(path_of object)" ]'
    }

    mount -t tmpfs -o size=64k,mode=700 tmpfs disk
    start --events disk/events swarm.cfg >/dev/null
    eventually has_events 70000
    mount -o remount,size=640m disk
    check "events that the ring could not hold are a gap in the log" eventually grep -q '"type":"gap"' disk/events
    end_swarm
    check "the gap counts the lost events" python3 - disk/events "$(end_of out/commands.log events)" <<'P'
import json, sys
next, gaps = 0, 0
for line in open(sys.argv[1]):
    event = json.loads(line)
    assert event["sequence"] + 1 == next + event.get("lost", 1), line
    next, gaps = event["sequence"] + 1, gaps + event.get("lost", 0)
assert next == int(sys.argv[2]) and gaps > 0, (next, gaps)
P
    umount disk

    mount -t tmpfs -o size=64k,mode=700 tmpfs disk
    start --events disk/events --set recorder.when_full=pause swarm.cfg >/dev/null
    stands() { "$jolon" status -w "$name" | grep -q "is paused"; }
    check "a run that must not lose events is paused" eventually stands
    check "the pause is reported" grep -q 'pausing the world' out/jolon.log
    "$jolon" kill -w "$name" recorder >/dev/null # the next one knows that it holds the world
    stood=$(frame)
    mount -o remount,size=640m disk
    check "the run continues when all events are written" eventually at_frame $((stood + 10))
    end_swarm
    check "the logs have no gap" eval '! grep -q "\"type\":\"gap\"" disk/events out/commands.log'
    check "the log has every event once" python3 - disk/events "$(end_of out/commands.log events)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(int(sys.argv[2])))
P
    check "the run is replayed with its pause" replay out/commands.log
    check "the log has the pause as a command of the recorder" grep -q '"ring":"recorder".*"command":"pause"' out/commands.log
    umount disk
else
    skip "a full disk is reported" "no right to mount a file system"
    skip "events that the ring could not hold are a gap in the log" "no right to mount a file system"
    skip "a run that must not lose events is paused" "no right to mount a file system"
fi

check "nothing is left" nothing_left "$name"
done_testing
