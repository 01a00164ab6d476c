#!/usr/bin/env bash
# What is recorded can be played again: the log of commands gives the run's digests, over recorders
# that are killed, disks that are full, worlds that go on from a checkpoint; and what differs between
# two runs is named. KILLS=n and SEED=n choose others.
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
check "its commands are answered" equal $? 0
check "an image of it is saved" "$bin/jolon-world" save --world "$name" image
ctl pause >/dev/null
check "its log is equal to the world that runs" eventually compare out/commands.log "$name"
ctl resume >/dev/null
eventually at_frame $(($(frame) + 60))
check "it stops" "$jolon" stop -w "$name"
check "the log ends" equal "$(end_of out/commands.log type)" end
check "after $sent kills every command is in it" python3 - out/commands.log $((kills * 4 + 2)) <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
commands = [line["commands"] for line in lines if line["type"] == "command"]
assert commands == list(range(1, int(sys.argv[2]) + 1)), commands
assert not [line for line in lines if line["type"] == "gap"]
P
check "it is played again" eval 'replay out/commands.log --events again >played'
check "with the run's digest" equal "$(json digest <played)" "$(end_of out/commands.log digest)"
check "and that of the events" equal "$(json event_digest <played)" "$(end_of out/commands.log event_digest)"
check "which says so itself" equal "$(json equal <played)" True
check "on two threads too" eval '[ "$(replay out/commands.log --threads 2 | json digest)" = "$(json digest <played)" ]'
check "the log of events is the same to the byte" cmp events again
check "summary and log agree" grep -q "digest $(json digest <played), of events $(json event_digest <played)" out/jolon.log
check "the image is a frame of it" eval 'compare image out/commands.log | grep -q "equal up to frame"'

# --- a recorder that is killed around the end of a run -----------------------------------------------
# The keeper sleeps while the recorder is killed and the run ends; awake, it learns of both at once,
# and what it starts to write the log's end is killed a few times more.
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

# --- what is refused ----------------------------------------------------------------------------------
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
check "a line that is missing too" refused 'shorter:2: ' replay shorter
head -c -20 out/commands.log >torn
check "a torn end is left out and said" eval 'replay torn >stdout 2>stderr && grep -q "torn" stderr'
check "no log is none" refused 'is no log of commands' replay events
cp "$(dirname "$bin")/../config/scenarios/duel.cfg" mine.cfg 2>/dev/null ||
    cp "$(dirname "$bin")/../../config/scenarios/duel.cfg" mine.cfg
"$jolon" run -w "$name" --frames 60 --pace max --out mine mine.cfg --without renderer --without reporter >/dev/null 2>&1
check "another scenario's run is played" replay mine/commands.log
echo "# changed" >>mine.cfg
check "a scenario that has changed is refused" refused 'another scenario.*has changed since' replay mine/commands.log

# --- what differs ---------------------------------------------------------------------------------------
brief() { "$jolon" run -w "$name" --frames 120 --pace max --without renderer --without reporter --out "$@" >/dev/null 2>&1; }
brief one
brief same
brief other --seed 7
check "equal runs are equal to their end" eval '[ "$(compare one/commands.log same/commands.log)" = "equal up to frame 120" ]'
compare one/commands.log other/commands.log >different
check "a run with another seed is not" equal $? 1
check "its first frame and field are named" grep -Eq '^frame 0: [a-z_]+ of entity [0-9]+.*: .+ \| .+' different
brief impulse --set collision.response=figure8
compare --json one/commands.log impulse/commands.log >different
check "so are those of another collision's answer" equal $? 1
check "as JSON" eval '[ "$(json frame <different)" -gt 0 ] && [ -n "$(json field <different)" ]'

# --- from a checkpoint ----------------------------------------------------------------------------------
check "a world goes on from the image" "$bin/jolon-world" create --from image --world "$name" --set world.pace=max --set world.frames=$(($(json frame <played) + 60))
cp events events.from
"$bin/jolon-recorder" --world "$name" --commands from.log --events events.from 2>from.err &
recorder=$!
check "its recorder is ready" eventually grep -q '"type":"begin"' from.log
"$bin/jolon-collider" --world "$name" 2>/dev/null & collider=$!
"$bin/jolon-mover" --world "$name" 2>/dev/null
"$bin/jolon-ctl" --help >/dev/null 2>&1
kill -TERM $collider 2>/dev/null
wait $collider
kill -TERM $recorder
wait $recorder
check "it is recorded" equal $? 0
check "and played again from the image" replay from.log
check "the log of events goes on, each once" python3 - events.from <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(len(lines)))
P
check "what it held beyond the image is kept" [ -s events.from.old ]
"$bin/jolon-world" remove --world "$name"

# --- a disk without room --------------------------------------------------------------------------------
mkdir disk
if mount -t tmpfs -o size=64k,mode=700 tmpfs disk 2>/dev/null; then
    # The set first: a file system that is written to stays.
    at_end_disk() {
        cd "$folder" && "$jolon" stop -w "$name" >/dev/null 2>&1
        umount disk 2>/dev/null
        at_end
    }
    trap at_end_disk EXIT
    start --events disk/events >/dev/null
    check "a full disk is said" eventually grep -q 'disk/events: cannot write: No space left' out/jolon.log
    "$jolon" kill -w "$name" recorder >/dev/null
    eventually at_frame $(($(frame) + 120))
    check "the world goes on" at_frame 120
    mount -o remount,size=64m disk
    check "and it is written when there is room" eventually grep -q 'disk/events: can be written again' out/jolon.log
    "$jolon" stop -w "$name" >/dev/null
    cp disk/events full
    check "every event once" python3 - full "$(end_of out/commands.log events)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(int(sys.argv[2])))
P
    check "and the run is played again" replay out/commands.log
    umount disk

    # Jets that swarm: two hundred events a frame, a ring of them in six seconds.
    cat >swarm.cfg <<'CFG'
world = { capacity = 64; };
terrain = { source = "flat"; };
collision = { method = "mps"; response = "none"; mps = { near_m = 1000.0; }; };
vehicles = ( { kind = "jet"; count = 20; behaviour = "patrol"; area = [25000.0, 25000.0, 25900.0, 25900.0]; } );
CFG
    happened() { "$jolon" status -w "$name" --json | json events; }
    has_events() { [ "$(happened)" -gt "$1" ]; }
    end_swarm() {
        ctl --timeout 30 quit >/dev/null
        eventually eval '[ -z "$(path_of object)" ]'
    }

    mount -t tmpfs -o size=64k,mode=700 tmpfs disk
    start --events disk/events swarm.cfg >/dev/null
    eventually has_events 70000 || eventually has_events 70000 || eventually has_events 70000
    mount -o remount,size=640m disk
    check "what a ring could not hold is a gap" eventually grep -q '"type":"gap"' disk/events
    end_swarm
    check "which counts what is lost" python3 - disk/events "$(end_of out/commands.log events)" <<'P'
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
    check "a run that must not lose events is paused" eval 'eventually stands || eventually stands || eventually stands'
    check "which is said" grep -q 'pausing the world' out/jolon.log
    "$jolon" kill -w "$name" recorder >/dev/null # the next one knows that it holds the world
    stood=$(frame)
    mount -o remount,size=640m disk
    check "and goes on when all is written" eventually at_frame $((stood + 10))
    end_swarm
    check "without a gap" eval '! grep -q "\"type\":\"gap\"" disk/events out/commands.log'
    check "every event is in the log, once" python3 - disk/events "$(end_of out/commands.log events)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(int(sys.argv[2])))
P
    check "the pause is played again with the run" replay out/commands.log
    check "as a command of the recorder's" grep -q '"ring":"recorder".*"command":"pause"' out/commands.log
    umount disk
else
    skip "a full disk is waited for" "no right to mount a file system"
    skip "what a ring could not hold is a gap" "no right to mount a file system"
    skip "a run that must not lose events is paused" "no right to mount a file system"
fi

check "nothing is left" nothing_left "$name"
done_testing
