#!/usr/bin/env bash
# Datagrams from any sender against a sandboxed reporter: a datagram that Cyclone DDS complains
# about, mutated datagrams of captured discovery and data, and participants that come and go.
# PACKETS=n and SEED=n choose others, RATE=n sets how many are sent per second.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
peer=$bin/../tests/rtps/peer
rtps=$here/../rtps
packets=${PACKETS:-20000}
seed=${SEED:-$RANDOM}
rate=${RATE:-8000}
export PYTHONDONTWRITEBYTECODE=1
domain=$((100 + $$ % 100)) # of its own: nobody else's reporter is to hear what is multicast here
[ -e "$peer" ] || { skip "hostile datagrams" "make test builds what they are captured from"; done_testing; }

check "a set starts" "$jolon" start -w "$name" --remote-commands --domain $domain --without renderer --out out
answers() { timeout 20 "$bin/jolon-monitor" -w "$name" --domain $domain --once --json >told && [ "$(json world <told)" = "$name" ]; }
check "the reporter answers" answers
first=$(pid reporter)

# --- one datagram -------------------------------------------------------------------------------------
PYTHONPATH=$rtps python3 - "$bin" "$name" <<'P'
import socket, sys
from rtps import Reporter
reporter = Reporter(*sys.argv[1:])
assert reporter.find(10)
for port in reporter.ports:
    socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(
        b"RTPS\x02\x01\x01\x10" + b"A" * 12 + b"\x15\x05\x2c\x01" + b"\0" * 8, ("127.0.0.1", port))
P
check "the complaint about a malformed datagram is in the log" eventually grep -q 'reporter warning .*dds: malformed packet' out/jolon.log
check "the reporter survives the malformed datagram" equal "$(pid reporter)" "$first"

# --- type information ---------------------------------------------------------------------------------
check "a peer's datagrams are captured" "$peer" -w "$name" --domain $domain capture captured
"$peer" -w "no-$name" --domain $domain command >unfiltered 2>&1 &
victim=$!
python3 "$rtps/deadly.py" --capture captured --pid $victim
{ wait $victim; } 2>/dev/null
echo "# a participant that does not hide type information ends with $?"
python3 "$rtps/deadly.py" --capture captured --pid "$first"
check "type information that ends Cyclone DDS does not end the reporter" equal "$(pid reporter)" "$first"

# --- participants that have left ----------------------------------------------------------------------
python3 "$rtps/leave.py" --bin "$bin" --world "$name" --capture captured --participants 40 >left
check "forty participants join and are answered" equal "$(json heard <left)" 40
check "the reporter sends nothing to participants that have left" [ "$(json after <left)" -le 4 ]

# --- mutated datagrams --------------------------------------------------------------------------------
time_begins
echo "# SEED=$seed"
python3 "$rtps/fuzz.py" --bin "$bin" --world "$name" --capture captured --packets "$packets" --rate "$rate" \
    --seed "$seed" >fuzzed
check "the datagrams make no frame late" in_time "frames / 100 + 1"
restarts=$(json restarts <fuzzed)
check "all $packets mutated datagrams were sent" [ "$(json packets <fuzzed)" = "$packets" ]
echo "# figures: $packets mutated datagrams (SEED=$seed), $(json dropped <fuzzed) not taken, $restarts deaths of the reporter"
check "the reporter answers afterwards" answers
check "the reporter takes commands afterwards" equal "$("$peer" -w "$name" --domain $domain command)" answered
check "the reporter was not restarted" equal "$restarts" 0
check "the sandbox forbade nothing" bash -c "! grep 'the sandbox forbids' out/jolon.log"
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
