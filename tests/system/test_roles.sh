#!/usr/bin/env bash
# The set in the background: start, status, kill and restart of each role, stop. Only one set runs a
# world. A killed supervisor's roles die with it, and the next start continues the world.
. "$(dirname "$0")/lib.sh"

start() { "$jolon" start -w "$name" --out "$folder/out" --set renderer.width=320 --set renderer.height=180 "$@"; }
status() { "$jolon" status -w "$name" --json; }
moves_on() { local at; at=$(frame) && eventually later "$at"; }
later() { [ "$(frame)" -gt "$1" ]; }
replaced() { local now; now=$(pid "$1") && [ -n "$now" ] && [ "$now" != "$2" ]; }
gone() { ! kill -0 "$1" 2>/dev/null; }

port=$((20000 + $$ % 20000))

check "jolon start ends when the set is ready" start --events "$folder/events"
check "the status says running" equal "$(status | json state)" running
check "the world goes on" moves_on
for role in mover collider reporter renderer recorder; do
    before=$(pid $role)
    check "$role runs" [ -n "$before" ]
    check "jolon kill $role succeeds" "$jolon" kill -w "$name" $role
    check "the $role is replaced" eventually replaced $role "$before"
    check "the world goes on without the killed $role" moves_on
done
check "the reporter runs behind the frame loop" behind_loop "$(pid reporter)" 5
check "the renderer runs far behind the frame loop" behind_loop "$(pid renderer)" 12
for role in mover renderer; do
    check "jolon restart $role succeeds" "$jolon" restart -w "$name" $role
done
check "a stopped mover is killed and replaced" bash -c "
    before=\$('$bin/jolon-world' pid --world $name mover) && kill -STOP \$before &&
    for i in \$(seq 100); do sleep 0.1; now=\$('$bin/jolon-world' pid --world $name mover 2>/dev/null)
        [ -n \"\$now\" ] && [ \"\$now\" != \"\$before\" ] && exit 0; done; exit 1"
check "the world goes on after a hang" moves_on

# Only the mover and the collider can end a set. Another role that always dies is restarted after
# growing pauses, and at once when the user asks for it.
crash() { local before; before=$(pid "$1") && kill -SEGV "$before" && eventually gone "$before"; }
restart_quickly() { # ROLE: sooner than the longest pause of 5 s
    local from
    from=$(date +%s%N)
    "$jolon" restart -w "$name" "$1" && [ $(($(date +%s%N) - from)) -lt 4000000000 ]
}
for i in $(seq 12); do
    before=$(pid reporter)
    check "reporter killed for the $i. time" crash reporter
    check "jolon restart starts the reporter before its pause is over" restart_quickly reporter
done
before=$(pid reporter)
check "the reporter is killed once more" crash reporter
check "the reporter is restarted without a request" eventually replaced reporter "$before"
"$jolon" restart -w "$name" nobody 2>second
check "a restart of an unknown role is refused with 2" equal $? 2

standing_by() { # pid of the process that waits for a role, of a set whose keeper is $2
    local child
    for child in $(pgrep -P "$2" "jolon-$1"); do
        [ "$child" = "$(pid "$1")" ] || echo "$child"
    done
}
keeper=$(cat "$(path_of lock)")
stands_by() { [ "$(standing_by "$1" "$keeper" | wc -l)" = 1 ]; }
for role in mover collider; do
    check "a stand-by waits for the role $role" eventually stands_by $role
    holder=$(pid $role)
    kill -KILL "$holder"
    check "the stand-by takes over when the $role is killed" eventually replaced $role "$holder"
    check "another stand-by waits for the role $role" eventually stands_by $role
    heir=$(standing_by $role "$keeper")
    kill -STOP "$heir"
    check "a stopped stand-by of the $role is killed" eventually gone "$heir"
    check "a stand-by of the $role replaces it" eventually stands_by $role
done

restarts() { status | json roles | grep -o "'restarts': [0-9]*" | awk '{ n += $2 } END { print n }'; }
before=$(restarts)
kill -STOP "$keeper"
sleep 3
kill -CONT "$keeper"
check "the set goes on after its keeper was stopped" moves_on
everybody=$(pgrep -P "$keeper" | tr '\n' ' ')
# shellcheck disable=SC2086 # several pids
kill -STOP "$keeper" $everybody
sleep 3
# shellcheck disable=SC2086
kill -CONT $everybody "$keeper"
check "the set goes on after all its processes were stopped" moves_on
check "no process was replaced for it" equal "$(restarts)" "$before"

"$jolon" start -w "$name" >second 2>&1
check "a second set is refused with 1" equal $? 1
check "the refusal names the running set" grep -q "runs already, by pid" second
check "jolon worlds lists the world" bash -c "'$jolon' worlds | grep -q '\"$name\" is running'"

supervisor=$(cat "$(path_of lock)")
mover=$(pid mover)
kill -KILL "$supervisor"
check "the roles die with a killed supervisor" eventually gone "$mover"
at=$(frame)
check "the next start succeeds" start
check "the world continues from its last frame" later "$((at - 1))"
check "jolon stop succeeds" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
check "no role leaks memory at a clean stop (built with SAN=address)" eval '! grep LeakSanitizer out/jolon.log'
"$jolon" stop -w "$name" 2>second
check "stop without a set is refused" equal $? 1

# A role that is stopped before it has reached its own code dies with a killed supervisor, too.
mkdir programs
ln -s "$bin"/* programs
rm programs/jolon programs/jolon-keeper programs/jolon-reporter
cp "$bin/jolon" "$bin/jolon-keeper" programs
printf '#!/bin/sh\necho halted $$\nkill -STOP $$\n' >programs/jolon-reporter
chmod +x programs/jolon-reporter
rm -f out/jolon.log
programs/jolon start -w "$name" --without renderer --out out >/dev/null 2>&1 &
halted='' late=$((SECONDS + 60))
until [ -n "$halted" ] || [ $SECONDS -ge $late ]; do # quick looks, because the supervisor replaces it soon
    sleep 0.005
    halted=$(sed -n 's/^halted //p' out/jolon.log 2>/dev/null | tail -n 1)
done
check "a role is stopped at its start" test -n "$halted"
kill -KILL "$(cat "$(path_of lock)")"
check "it dies with a killed supervisor" eventually gone "$halted"
kill -KILL "$halted" 2>/dev/null
wait $!
"$jolon" stop -w "$name" >/dev/null 2>&1
"$jolon" start -w "$name" --without renderer --out out >/dev/null && "$jolon" stop -w "$name" >/dev/null
check "nothing is left" nothing_left "$name"

# The set keeps the reporter's network for restarts. A role that the set was started without stays
# away.
check "a set with a DDS domain starts" start --domain 7 --without renderer
before=$(pid reporter)
check "jolon kill reporter succeeds" "$jolon" kill -w "$name" reporter
check "the role is replaced" eventually replaced reporter "$before"
check "the new reporter uses the same domain" grep -qzx -- 7 "/proc/$(pid reporter)/cmdline"
"$jolon" restart -w "$name" renderer 2>second
check "a role that the set runs without cannot be restarted" equal $? 1
check "the refusal gives the reason" grep -q 'was started without the renderer' second
check "jolon stop succeeds" "$jolon" stop -w "$name"
"$jolon" restart -w "$name" reporter 2>second
check "a restart without a set is refused" grep -q 'no set runs world' second
# The console is a role of the set if requested. A page continues to work after the console's death.
"$jolon" start -w "$name" --without renderer --out out --console "$port" >told
check "a set with a console starts" equal $? 0
address=$(grep -o 'http://127[^)]*' told)
# A page joins with the token.
joins() { python3 - "${1%%#*}" "${1##*=}" <<'P'
import json, sys, urllib.request
request = urllib.request.Request(sys.argv[1] + "api/join", b'{"name": "Ann"}',
    {"Authorization": "Bearer " + sys.argv[2], "Content-Type": "application/json"})
assert json.load(urllib.request.urlopen(request, timeout=5))["key"]
P
}
check "the printed address is the console's" joins "$address"
check "the token is in no log" eval '! grep -rq "${address##*=}" out/jolon.log'
check "the token's file is readable for its owner alone" equal "$(stat -c %a out/console.token)" 600
check "the status lists the console" eval 'status | grep -q "\"role\":\"console\",.*\"state\":\"ready\""'
before=$(pid console)
check "jolon kill console succeeds" "$jolon" kill -w "$name" console
check "the role is replaced" eventually replaced console "$before"
check "the new console accepts the same token" eventually joins "$address"
check "jolon restart console succeeds" "$jolon" restart -w "$name" console
check "the page works after a restart" eventually joins "$address"
before=$(pid console)
kill -STOP "$before"
check "a console that hangs is replaced" eventually replaced console "$before"
"$jolon" console -w "$name" --port 0 >hand 2>&1 &
check "a second console runs beside the first" eventually eval 'joins "$(head -n 1 hand)"'
kill %+ && wait %+
keeper=$(cat "$(path_of lock)")
kill -KILL "$keeper"
eventually gone "$keeper"
check "a start after a killed keeper continues the world" "$jolon" start -w "$name" --without renderer --out out --console "$port"
check "the page works with the continued world" eventually joins "$address"
check "jolon stop succeeds" "$jolon" stop -w "$name"
"$jolon" start -w "$name" --without renderer --out out --console "$port" >/dev/null
check "another world has another token" eval '! joins "$address"'
check "jolon stop succeeds" "$jolon" stop -w "$name"

# A role that refuses to start is tried again until the cause is gone. The refusal is reported once.
python3 -c 'import socket, sys, time
s = socket.create_server(("127.0.0.1", int(sys.argv[1])))
time.sleep(60)' "$port" &
holder=$!
eventually eval 'exec 9<>"/dev/tcp/127.0.0.1/$port"'
check "a set whose port is in use starts" start --without renderer --console "$port"
sleep 1 # five tries and more
check "the console's refusal is in the log once" equal "$(grep -c '^jolon-console: .*in use' out/jolon.log)" 1
check "the keeper reports the refusal once" equal "$(grep -c 'goes on without the console and keeps trying: .*in use' out/jolon.log)" 1
kill "$holder" && wait "$holder" 2>/dev/null
check "the console starts when the port is free" eventually pid console
check "the console's address is in the log" eventually grep -q 'console info.* serves' out/jolon.log
check "jolon stop succeeds" "$jolon" stop -w "$name"

# A keeper that does not answer is told of after 20 s.
start --without renderer >started
keeper=$(sed -n 's/.*supervisor pid \([0-9]*\),.*/\1/p' started)
kill -STOP "$keeper"
check "jolon stop says that a set has not stopped" eval '
    ! "$jolon" stop -w "$name" 2>refused && grep -q "(supervisor pid $keeper) has not stopped after 20 s" refused'
kill -CONT "$keeper"
check "and it stops when it can" eventually gone "$keeper"

mkdir elsewhere
check "a run starts from any folder" bash -c "cd elsewhere && '$jolon' run -w $name --frames 5 --pace max --without renderer"
check "Ctrl-C ends a run with its summary" bash -c "
    env --default-signal=INT '$jolon' run -w $name --without renderer --out out >told 2>&1 & run=\$!
    for i in \$(seq 100); do sleep 0.05; '$bin/jolon-world' pid --world $name mover >/dev/null 2>&1 && break; done
    sleep 0.3; kill -INT \$run; wait \$run && grep -q digest told"
check "nothing is left" nothing_left "$name"
done_testing
