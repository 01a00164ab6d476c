#!/usr/bin/env bash
# The topics and commands with real processes: status, events, commands over the local socket and
# over DDS. The reporter or the intake is killed, a subscriber stops, or there is no network.
# SPAWNS=n sets the number of commands.
. "$(dirname "$0")/lib.sh"
spawns=${SPAWNS:-60}
monitor="$bin/jolon-monitor -w $name"
ctl="$bin/jolon-ctl -w $name"

check "a set starts" eval '"$jolon" start -w "$name" --without renderer --remote-commands --out "$folder/out" 2>"$folder/warned"'
check "the start warns of remote commands without security" grep -q "WARNING.*every host that reaches" "$folder/warned"
check "the log warns of remote commands" grep -q "WITHOUT DDS Security" "$folder/out/jolon.log"
check "jolon status warns of remote commands" eval '"$jolon" status -w "$name" | grep -q "^WARNING: .*--remote-commands"'
status() { $monitor --once --json; }
key() { status | json "$1"; }

# --- status -----------------------------------------------------------------------------------------
check "the status comes over DDS" eval 'status >once'
check "the status names the world" equal "$(json world <once)" "$name"
check "the status has every entity" [ "$(json entities <once)" -ge 500 ]
check "the status says that the mover is ready" equal "$(json roles.0.role <once) $(json roles.0.state <once)" "mover ready"
check "a monitor without a terminal prints lines" eval 'timeout 2 $monitor | grep -q "^running  frame "'
refuses_here() { # for a world that does not exist; refuses of lib.sh needs that this test has no world at all
    "$@" >stdout 2>stderr
    [ $? = 1 ] && [ "$(wc -l <stderr)" = 1 ] && [ ! -s stdout ]
}
check "a monitor of a world that does not exist is refused with one line" \
    refuses_here "$bin/jolon-monitor" -w "no-$name" --once --json
check "a command for a world that does not exist is refused with one line" refuses_here "$bin/jolon-ctl" -w "no-$name" --timeout 1 pause
check "an interface that does not exist is refused" refuses_here $ctl --remote --interface 203.0.113.9 pause
$ctl --domain 3 pause 2>stderr
check "an interface without --remote is refused with 2" equal "$? $(grep -c -- "add --remote" stderr)" "2 1"
check "CYCLONEDDS_URI of the environment changes nothing" \
    env CYCLONEDDS_URI=file:///nonexistent $ctl --remote scale 1

# --- commands ---------------------------------------------------------------------------------------
check "pause is answered with its frame" eval '$ctl pause | grep -Eq "^paused at frame [0-9]+$"'
check "the world is paused" eventually eval '[ "$(key state)" = paused ]'
# shellcheck disable=SC2034 # for eval
before=$(key commit)
check "step is accepted" $ctl step 5
check "the world computed the steps" eventually eval '[ "$(key commit)" -ge $((before + 5)) ]'
check "spawn prints the id" eval '$ctl spawn tank --at 25000,24000 --force blue >spawned'
check "resume is accepted" $ctl resume
id=$(awk '{ print $3 }' spawned)
check "the entity can be driven" $ctl drive "$id" --throttle 1
check "the entity can be removed" $ctl remove "$id"
check "a second removal is refused" eval '! $ctl remove "$id" 2>stderr && grep -q "no such entity" stderr'
check "an unknown kind is refused with the list of kinds" \
    eval '! $ctl spawn tnak --at 1,1 2>stderr && grep -q "no such kind.*tank" stderr'
"$bin/jolon-ctl" -w "$name" step 0 2>stderr
check "wrong usage is refused with 2" equal "$? $(wc -l <stderr)" "2 1"

# --- a storm of commands, every other one over DDS, while intake and reporter die again and again -----
# shellcheck disable=SC2034 # for eval
vehicles=$("$jolon" status -w "$name" --json | json vehicles) # the topics may be a tenth of a second old
storm() {
    for i in $(seq "$spawns"); do
        [ $((i % 2)) = 0 ] && echo "--remote $i" || echo "--json $i"
    done | xargs -P 8 -L 1 bash -c "$ctl --timeout 30 \$0 spawn tank --at 25000,\${1}0" >replies
}
storm &
storm_pid=$!
kills=0
while kill -0 $storm_pid 2>/dev/null; do
    sleep "0.$((RANDOM % 4 + 3))"
    for role in intake reporter; do
        "$jolon" kill -w "$name" $role >/dev/null 2>&1 && kills=$((kills + 1))
    done
done
wait $storm_pid
check "each of $spawns commands was answered ($kills kills)" equal "$?" 0
check "each command spawned a vehicle of its own" equal \
    "$(sed -E 's/.*"entity":([0-9]+).*/x x \1/' replies | awk '{ print $3 }' | sort -u | wc -l)" "$spawns"
$ctl --timeout 30 pause >/dev/null
echo "# vehicles before $vehicles, now $("$jolon" status -w "$name" --json | json vehicles), by the topics $(key vehicles)"
check "no command was lost or done twice" \
    eventually eval '[ "$(key vehicles)" = $((vehicles + spawns)) ]'

# --- events -----------------------------------------------------------------------------------------
timeout 4 $monitor --events >seen
"$bin/jolon-world" events --world "$name" --json | grep -v '"type":"\(command\|mission\)"' | tail -n 3000 |
    sed 's/"sequence":[0-9]*,//' >happened
sed 's/"sequence":[0-9]*,//' seen | tail -n 3000 >said
check "the events over DDS are those of the ring, each once and in order" cmp happened said
check "there were events" [ -s happened ]
$ctl resume >/dev/null

# --- subscribers that stop --------------------------------------------------------------------------
$monitor --events >/dev/null &
stopped=$!
sleep 1
kill -STOP $stopped
time_begins
sleep 3
check "a stopped subscriber makes no frames late" in_time 3
check "a stopped subscriber does not slow the simulation" at_pace 3
kill -CONT $stopped
kill $stopped

# --- the loopback interface alone -------------------------------------------------------------------
if unshare -n true 2>/dev/null; then
    check "topics work with the loopback interface alone" unshare -n bash -c "
        ip link set lo up || exit 1
        $bin/jolon-world create --world ${name}n >/dev/null || exit 1
        $bin/jolon-mover --world ${name}n & $bin/jolon-collider --world ${name}n &
        $bin/jolon-reporter --world ${name}n & $bin/jolon-intake --world ${name}n &
        $bin/jolon-monitor -w ${name}n --once --json && $bin/jolon-ctl -w ${name}n quit
        code=\$?
        kill %3 %4; wait
        $bin/jolon-world remove --world ${name}n
        exit \$code"
else
    skip "topics work with the loopback interface alone" "no right to make a network namespace"
fi

check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
