#!/usr/bin/env bash
# Quiet: it kills sixty times in ten seconds of a world that runs in real time.
# Random SIGKILLs of every role during a run: it ends with the digests of an undisturbed run.
# KILLS=n and SEED=n choose others.
. "$(dirname "$0")/lib.sh"
kills=${KILLS:-$([ -n "${JOLON_SANITIZER-}" ] && echo 10 || echo 60)}
RANDOM=${SEED:=$((RANDOM))}
echo "# SEED=$SEED KILLS=$kills"
frames=$((kills * 20 + 200)) # 60 Hz: three kills a second, or more

"$jolon" run -w "$name" --frames $frames --pace max --json --without renderer --without reporter \
    --out "$folder/out" >calm 2>err
"$jolon" run -w "$name" --frames $frames --json --out "$folder/out" --events "$folder/events" \
    --set renderer.width=320 --set renderer.height=180 >stormy 2>err &
run=$!
# Waits until the mover has moved a frame.
eventually "$bin/jolon-world" pid --world "$name" mover
# Starts a monitor again whenever it is killed.
(trap 'kill $! 2>/dev/null; exit' TERM; while :; do "$jolon" monitor -w "$name" >/dev/null 2>&1 & wait $!; done) 2>/dev/null &
monitors=$!
sent=0 watched=0
while [ $sent -lt "$kills" ] && kill -0 $run 2>/dev/null; do
    roles=(mover collider mover collider renderer reporter recorder monitor)
    role=${roles[RANDOM % ${#roles[@]}]}
    if [ $role = monitor ]; then
        pkill -KILL -f "jolon-monitor --world $name\$" && sent=$((sent + 1)) watched=$((watched + 1))
    else
        "$jolon" kill -w "$name" $role >/dev/null 2>&1 && sent=$((sent + 1))
    fi
    sleep "0.$((RANDOM % 20 + 5))"
done
wait $run
status=$?
kill $monitors 2>/dev/null
check "the run ends with 0 after $sent kills" equal $status 0
[ $status = 0 ] || sed 's/^/# /' err
check "all kills were sent" [ $sent -ge $((kills * 9 / 10)) ]
check "the kills were counted as restarts" [ "$(json restarts <stormy)" -ge $((sent - watched - 2)) ]
check "the digest is that of the undisturbed run" equal "$(json digest <stormy)" "$(json digest <calm)"
check "the event digest is that of the undisturbed run" equal "$(json event_digest <stormy)" "$(json event_digest <calm)"
check "the log holds every event once" python3 - "$folder/events" "$(json events <stormy)" <<'P'
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["sequence"] for line in lines] == list(range(int(sys.argv[2])))
P
check "nothing is left" nothing_left "$name"
done_testing
