#!/usr/bin/env bash
# The set in the background: start, status, kill and restart of each role, stop; one set a world; a
# supervisor that is killed takes its roles along, and the next start goes on with the world.
. "$(dirname "$0")/lib.sh"

start() { "$jolon" start -w "$name" --out "$folder/out" --set renderer.width=320 --set renderer.height=180 "$@"; }
status() { "$jolon" status -w "$name" --json; }
moves_on() { local at; at=$(frame) && eventually later "$at"; }
later() { [ "$(frame)" -gt "$1" ]; }
replaced() { local now; now=$(pid "$1") && [ -n "$now" ] && [ "$now" != "$2" ]; }
gone() { ! kill -0 "$1" 2>/dev/null; }

port=$((20000 + $$ % 20000))

check "start ends when the set is up" start --events "$folder/events"
check "status says running" equal "$(status | json state)" running
check "the world moves on" moves_on
for role in mover collider reporter renderer recorder; do
    before=$(pid $role)
    check "$role runs" [ -n "$before" ]
    check "kill $role" "$jolon" kill -w "$name" $role
    check "$role comes back" eventually replaced $role "$before"
    check "and the world moves on" moves_on
done
check "the reporter runs behind the frame loop" behind_loop "$(pid reporter)" 5
check "the renderer runs far behind it" behind_loop "$(pid renderer)" 12
for role in mover renderer; do
    check "restart $role" "$jolon" restart -w "$name" $role
done
check "a stopped mover is killed and replaced (hang)" bash -c "
    before=\$('$bin/jolon-world' pid --world $name mover) && kill -STOP \$before &&
    for i in \$(seq 100); do sleep 0.1; now=\$('$bin/jolon-world' pid --world $name mover 2>/dev/null)
        [ -n \"\$now\" ] && [ \"\$now\" != \"\$before\" ] && exit 0; done; exit 1"
check "the world moves on after a hang" moves_on

# Only the mover and the collider can end a set: another role that always dies comes back, after
# pauses that grow, and at once when the user asks for it.
crash() { local before; before=$(pid "$1") && kill -SEGV "$before" && eventually gone "$before"; }
restart_quickly() { # ROLE: sooner than the longest pause of 5 s
    local from
    from=$(date +%s%N)
    "$jolon" restart -w "$name" "$1" && [ $(($(date +%s%N) - from)) -lt 4000000000 ]
}
for i in $(seq 12); do
    before=$(pid reporter)
    check "reporter killed for the $i. time" crash reporter
    check "jolon restart brings it back before its pause is over" restart_quickly reporter
done
before=$(pid reporter)
check "it dies once more" crash reporter
check "and comes back by itself" eventually replaced reporter "$before"
"$jolon" restart -w "$name" nobody 2>second
check "restart of what is no role is refused" equal $? 2

standing_by() { # pid of the process that waits for a role, of a set whose keeper is $2
    local child
    for child in $(pgrep -P "$2" "jolon-$1"); do
        [ "$child" = "$(pid "$1")" ] || echo "$child"
    done
}
keeper=$(cat "$(path_of lock)")
stands_by() { [ "$(standing_by "$1" "$keeper" | wc -l)" = 1 ]; }
for role in mover collider; do
    check "somebody stands by for the $role" eventually stands_by $role
    holder=$(pid $role)
    kill -KILL "$holder"
    check "and takes over when it is killed" eventually replaced $role "$holder"
    check "somebody stands by again" eventually stands_by $role
    heir=$(standing_by $role "$keeper")
    kill -STOP "$heir"
    check "one that is stopped is replaced" eventually gone "$heir"
    check "and somebody stands by again" eventually stands_by $role
done

restarts() { status | json roles | grep -o "'restarts': [0-9]*" | awk '{ n += $2 } END { print n }'; }
before=$(restarts)
kill -STOP "$keeper"
sleep 3
kill -CONT "$keeper"
check "the set goes on after its keeper slept" moves_on
everybody=$(pgrep -P "$keeper" | tr '\n' ' ')
# shellcheck disable=SC2086 # several pids
kill -STOP "$keeper" $everybody
sleep 3
# shellcheck disable=SC2086
kill -CONT $everybody "$keeper"
check "and after everybody slept" moves_on
check "and nobody was killed for it" equal "$(restarts)" "$before"

"$jolon" start -w "$name" >second 2>&1
check "a second set is refused with 1" equal $? 1
check "and says why" grep -q "is run already by pid" second
check "worlds lists it" bash -c "'$jolon' worlds | grep -q '\"$name\" is running'"

supervisor=$(cat "$(path_of lock)")
mover=$(pid mover)
kill -KILL "$supervisor"
check "a killed supervisor takes its roles along" eventually gone "$mover"
at=$(frame)
check "the next start goes on" start
check "from the frame that was" later "$((at - 1))"
check "stop" "$jolon" stop -w "$name"
check "and nothing is left" nothing_left "$name"
check "no role leaks memory at a clean stop (built with SAN=address)" eval '! grep LeakSanitizer out/jolon.log'
"$jolon" stop -w "$name" 2>second
check "stopping nothing is refused" equal $? 1

# The reporter's network is the set's to keep; what the set was started without does not come back.
check "start with a network" start --domain 7 --without renderer
before=$(pid reporter)
check "kill the reporter" "$jolon" kill -w "$name" reporter
check "it comes back" eventually replaced reporter "$before"
check "to the same network" grep -qzx -- 7 "/proc/$(pid reporter)/cmdline"
"$jolon" restart -w "$name" renderer 2>second
check "what the set is without is not restarted" equal $? 1
check "and that is said" grep -q 'was started without the renderer' second
check "stop" "$jolon" stop -w "$name"
"$jolon" restart -w "$name" reporter 2>second
check "nor is anything without a set" grep -q 'no set runs world' second
# The console is a role of the set when it is asked for, and a page goes on working over its death.
"$jolon" start -w "$name" --without renderer --out out --console "$port" >told
check "start with a console" equal $? 0
address=$(grep -o 'http://127[^)]*' told)
# A page joins: who has the token may.
joins() { python3 - "${1%%#*}" "${1##*=}" <<'P'
import json, sys, urllib.request
request = urllib.request.Request(sys.argv[1] + "api/join", b'{"name": "Ann"}',
    {"Authorization": "Bearer " + sys.argv[2], "Content-Type": "application/json"})
assert json.load(urllib.request.urlopen(request, timeout=5))["key"]
P
}
check "the address that is printed is the console's" joins "$address"
check "its token is in no log" eval '! grep -rq "${address##*=}" out/jolon.log'
check "nor readable for others" equal "$(stat -c %a out/console.token)" 600
check "status knows it" eval 'status | grep -q "\"role\":\"console\",.*\"state\":\"ready\""'
before=$(pid console)
check "kill console" "$jolon" kill -w "$name" console
check "it comes back" eventually replaced console "$before"
check "and takes the same token" eventually joins "$address"
check "restart console" "$jolon" restart -w "$name" console
check "and the page goes on" eventually joins "$address"
before=$(pid console)
kill -STOP "$before"
check "one that hangs is replaced" eventually replaced console "$before"
"$jolon" console -w "$name" --port 0 >hand 2>&1 &
check "one more by hand beside it" eventually eval 'joins "$(head -n 1 hand)"'
kill %+ && wait %+
keeper=$(cat "$(path_of lock)")
kill -KILL "$keeper"
eventually gone "$keeper"
check "the keeper is killed and the world gone on with" "$jolon" start -w "$name" --without renderer --out out --console "$port"
check "the page goes on" eventually joins "$address"
check "stop" "$jolon" stop -w "$name"
"$jolon" start -w "$name" --without renderer --out out --console "$port" >/dev/null
check "another world has another token" eval '! joins "$address"'
check "stop" "$jolon" stop -w "$name"

# What a role refuses is tried again until the cause is gone, and said once.
python3 -c 'import socket, sys, time
s = socket.create_server(("127.0.0.1", int(sys.argv[1])))
time.sleep(60)' "$port" &
holder=$!
eventually eval 'exec 9<>"/dev/tcp/127.0.0.1/$port"'
check "start with a port that is in use" start --without renderer --console "$port"
sleep 1 # five tries and more
check "what the console refuses is in the log once" equal "$(grep -c '^jolon-console: .*in use' out/jolon.log)" 1
check "and told once" equal "$(grep -c 'goes on without the console and keeps trying: .*in use' out/jolon.log)" 1
kill "$holder" && wait "$holder" 2>/dev/null
check "when the port is free the console is there" eventually pid console
check "and what it says is in the log" eventually grep -q 'console info.* serves' out/jolon.log
check "stop" "$jolon" stop -w "$name"

mkdir elsewhere
check "it starts from any folder" bash -c "cd elsewhere && '$jolon' run -w $name --frames 5 --pace max --without renderer"
check "Ctrl-C stops it cleanly" bash -c "
    env --default-signal=INT '$jolon' run -w $name --without renderer --out out >told 2>&1 & run=\$!
    for i in \$(seq 100); do sleep 0.05; '$bin/jolon-world' pid --world $name mover >/dev/null 2>&1 && break; done
    sleep 0.3; kill -INT \$run; wait \$run && grep -q digest told"
check "and nothing is left" nothing_left "$name"
done_testing
