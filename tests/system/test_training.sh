#!/usr/bin/env bash
# The training world: its course is there, nobody fires, threads agree, and a person who does not say
# where begins there. The world ends with that person.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"

# --- the course -------------------------------------------------------------------------------------
summaries() { # runs the scenario on several threads and prints each digest
    local threads
    for threads in 1 2 4; do
        "$jolon" run -w "$name" --without renderer --without reporter --pace max --json --frames 1800 \
            --threads $threads --out "$folder/out" training >"summary-$threads" 2>err || sed 's/^/# /' err >&2
        json digest <"summary-$threads"
    done
}
check "one, two and four threads agree" equal "$(summaries | sort -u | wc -l)" 1
check "nobody fires, and nothing breaks" \
    equal "$(json detonations <summary-1) $(json collisions <summary-1) $(json destroyed <summary-1)" "0 0 0"

check "a set starts with the training scenario" "$jolon" start -w "$name" --without renderer --out out --set world.pace=max training
height() { "$jolon" world dump --terrain "$1,$2,$1,$2,1" -w "$name" | tail -n 1 | cut -d, -f3; }
check "the ramp is on the ground" equal "$(height 25000 24765 | cut -d. -f1)" 150
check "the deep ford is dug into it" equal "$(height 25116 24850 | cut -c1-6)" 148.55

# The jeep goes over the first jump: a sample shows it above the level ground. The world goes on in steps, so
# that no machine is too slow to see it.
"$jolon" ctl pause -w "$name" >/dev/null
"$jolon" ctl drive 1 --throttle 1 --lease 60 -w "$name" >/dev/null 2>&1
above() { "$jolon" ctl step 15 -w "$name" >/dev/null; "$jolon" world dump --json -w "$name" | python3 -c '
import json, sys
jeep = [e for e in map(json.loads, sys.stdin) if e["id"] == 1][0]
sys.exit(not jeep["position"][1] > 150.15)'; }
jumps() { "$jolon" ctl step 700 -w "$name"; for _ in $(seq 60); do ! above || return 0; done; return 1; }
check "the jeep drives up a ramp" jumps
check "the set stops" "$jolon" stop -w "$name"

# --- a person who does not say where ----------------------------------------------------------------
runs() { [ -n "$("$bin/jolon-world" list | grep -Fx "$1")" ]; }
gone() { ! runs training; }
(sleep 4; printf w; sleep 1; printf q) | "$jolon" drive --plain >shown 2>told
check "a drive without a world takes the jeep of the training world" grep -q 'you drive jeep (jeep 1)' shown
check "one line says so" [ "$(grep -c 'no world runs, so a quiet one begins' told)" = 1 ]
check "the world ends with the drive" gone
check "no other world was made" equal "$("$bin/jolon-world" list)" ""

check "another world runs" "$jolon" start -w "$name" --without renderer --out out3 training
(sleep 4; printf q) | "$jolon" drive --plain >shown 2>told
check "a drive still begins in the training world" grep -q 'you drive jeep (jeep 1)' shown
check "and names the other world" grep -q "(-w takes one of these: $name)" told
check "only the other world is left" equal "$("$bin/jolon-world" list)" "$name"
check "the other world stops" "$jolon" stop -w "$name"

mkfifo keys
exec {keys}<>keys # its end never comes
"$jolon" drive --plain <keys >shown 2>told &
drive=$!
check "another drive begins" eventually grep -q 'you drive jeep' shown
kill -TERM $drive
check "its world ends when it is ended by a signal" eventually gone
wait $drive
exec {keys}>&-

check "a running training world is used, and continues" "$jolon" start -w training --without renderer --out out2 training
(sleep 2; printf q) | "$jolon" drive --plain >shown 2>told
check "a drive takes its jeep" grep -q 'you drive jeep (jeep 1)' shown
check "the world still runs" runs training
check "it stops" "$jolon" stop -w training

told_once() { JOLON_RUNTIME_DIR=rel "$jolon" "$@" >told 2>&1; [ $? = 1 ] && equal "$(cat told)" "jolon: JOLON_RUNTIME_DIR=rel: must be an absolute path, as /run/jolon"; }
for verb in drive console stop; do check "a wrong runtime folder is told once: $verb" told_once $verb; done
refuses "a drive of a named vehicle without a world" 1 'there is no world "default"' "$jolon" drive tank --plain
refuses "a drive in a named world that does not exist" 1 "there is no world \"$name\"" "$jolon" drive -w "$name" --plain

"$jolon" console --port 0 >url 2>told &
console=$!
check "a console without a world begins in the training world" eventually grep -q 'token=' url
check "its world is the training world" eventually runs training
kill -TERM $console
wait $console
check "the world ends with the console" gone
done_testing
