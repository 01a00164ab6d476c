#!/usr/bin/env bash
# A client that floods hurts only itself: while one connection tries to send 100,000 commands a second,
# another's drive is answered within 3 frames, at the 99th of a hundred; spawns on one spot are bounded
# in time and place; connections without end keep nobody out; the world goes on. SECONDS_EACH=n.
. "$(dirname "$0")/lib.sh"
flood="$bin/../tests/flood/flood --world $name --seconds ${SECONDS_EACH:-3} --vehicle 1"
frames=${FRAMES_MAX:-3}
[ -z "${JOLON_SANITIZER:-}" ] || frames=30

check "a set starts" "$jolon" start -w "$name" --without renderer --without reporter --out "$folder/out"
value() { json "$1" <told; }
frame() { "$jolon" status -w "$name" --json | json commit; }
# held WHAT OPTION...: the driver's answers under a flood.
held() {
    local what=$1
    shift
    # shellcheck disable=SC2086 # words
    check "a flood of $what is sent" eval "$flood $* >told"
    echo "# figures: $what: $(cat told)"
    check "$what: 100,000 a second were tried" [ "$(value sent_per_s)" -ge "${SENT_MIN:-60000}" ]
    check "$what: another's drive is answered within $frames frames (p99)" [ "$(value frames_p99)" -le $frames ]
    check "$what: every drive is answered" equal "$(value unanswered)" 0
}

held drives
before=$("$jolon" status -w "$name" --json | json vehicles)
held "spawns on one spot" --spawn
after=$("$jolon" status -w "$name" --json | json vehicles)
check "of the spawns 8 stand on the spot" [ $((after - before)) -ge 1 -a $((after - before)) -le 8 ]
"$bin/jolon-ctl" -w "$name" spawn tank --at 20000,30000 2>err
check "the next one is told why" eval "[ $? = 1 ] && grep -q 'too many vehicles stand' err"
check "one process with 300 connections keeps nobody out" eval \
    "$flood --idle 300 >told && [ \$(json unanswered <told) = 0 ]"

# Operators' commands find their place while a flood goes on.
$flood --spawn --seconds 4 >/dev/null &
sleep 0.5
for command in pause "step 2" resume; do
    # shellcheck disable=SC2086 # words
    check "$command is done meanwhile" "$bin/jolon-ctl" -w "$name" --timeout 1 $command
done
wait
begun=$(frame)
check "the world goes on" eventually eval "[ \$(frame) -gt $begun ]"
check "it stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
