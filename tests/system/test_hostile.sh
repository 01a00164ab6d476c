#!/usr/bin/env bash
# A hostile peer writes samples on a world's topics that no reporter would write. Monitors print
# only well-formed lines meanwhile, and the true state afterwards. SEED=n chooses other samples.
# Quiet: it gives the monitors a few seconds to print the state after hostile samples.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
peer=$bin/../tests/rtps/peer
[ -e "$peer" ] || { skip "hostile samples" "make test builds who writes them"; done_testing; }
domain=$((100 + $$ % 100))
seed=${SEED:-$RANDOM}
echo "# SEED=$seed"
monitor=("$bin/jolon-monitor" -w "$name" --domain "$domain")

check "a set starts" "$jolon" start -w "$name" --domain $domain --without renderer --out out
check "a monitor receives the status" "${monitor[@]}" --once --json
"${monitor[@]}" --json --vehicles >json 2>json.err &
readers=($!)
"${monitor[@]}" --events >events 2>events.err &
readers+=($!)
"${monitor[@]}" --lines >lines 2>lines.err &
readers+=($!)
(export TERM=xterm; exec script -qec "stty rows 40 cols 120; exec ${monitor[*]}" /dev/null </dev/null >screen 2>&1) &
readers+=($!)
sleep 1
# Two hostile peers, one after the other: the later one finds what the earlier one left.
"$peer" -w "$name" --domain $domain hostile "$seed"
"$peer" -w "$name" --domain $domain hostile $((seed + 1))
sleep 3
"${monitor[@]}" --once --json >now
for reader in "${readers[@]}"; do
    check "a monitor survives" kill -0 "$reader"
done
kill "${readers[@]}"
{ wait "${readers[@]}"; } 2>/dev/null
well_formed() { # each line is JSON, and UTF-8
    python3 - "$1" <<'P'
import json, sys
count = 0
for line in open(sys.argv[1], "rb"):
    json.loads(line.decode("utf-8"), parse_constant=lambda word: sys.exit(f"{word} in {line}"))
    count += 1
assert count >= 3, count
P
}
plain() { # no byte but of printable text
    python3 - "$1" <<'P'
import sys
text = open(sys.argv[1], "rb").read().decode("utf-8")
bad = [c for c in text if c != "\n" and not c.isprintable()]
assert text and not bad, bad
P
}
check "the status was well-formed JSON all the time" well_formed json
check "the events were well-formed JSON all the time" well_formed events
check "the lines were plain text" plain lines
truth() { # what who listened through it all says, beside who begins to listen
    tail -n 1 json >last
    equal "$(json state <last) $(json vehicles <last)" "running 500" &&
        equal "$(python3 -c 'import json; print(sorted({e["kind"] for e in json.load(open("last"))["list"]}))')" \
            "$(python3 -c 'import json; print(sorted({e["kind"] for e in json.load(open("fresh"))["list"]}))')"
}
"${monitor[@]}" --once --json --vehicles >fresh
check "the true status is received again" truth
check "events are received again" python3 - <<'P'
import json
frames = [json.loads(line)["frame"] for line in open("events", encoding="utf-8")]
last = json.load(open("now"))["commit"]
assert any(last - 240 <= frame <= last for frame in frames[-20:]), (frames[-20:], last)
P
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
