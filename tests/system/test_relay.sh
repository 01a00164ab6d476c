#!/usr/bin/env bash
# tests/relay, the bad network that tests of the gateway use: losses, delays, order and copies are what it says, and the same for
# the same seed.
# Quiet: it judges delays
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
relay=$here/../relay/relay.py
cat >try.py <<'PYTHON'
"""usage: try.py RELAY SEED    Sends 2000 numbered datagrams through a relay; prints which came, in their order, and the delays."""
import json
import signal
import socket
import subprocess
import sys
import time

COUNT = 2000
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
ear = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
ear.bind(("127.0.0.1", 0))
ear.setblocking(False)
probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
probe.bind(("127.0.0.1", 0))
port = probe.getsockname()[1]
probe.close()
relay = subprocess.Popen([sys.executable, "-I", sys.argv[1], "--listen", str(port), "--to", str(ear.getsockname()[1]), "--seed", sys.argv[2]],
                         stdout=subprocess.PIPE, text=True)
while f":{port:04X}" not in open("/proc/net/udp").read():
    time.sleep(0.01)
sent, came, begun = {}, [], time.monotonic()


def receive():
    while True:
        try:
            number = int(ear.recv(100))
        except BlockingIOError:
            return
        came.append((number, time.monotonic() - sent[number]))


for number in range(COUNT):
    while time.monotonic() < begun + number * 0.001:
        receive()
    sent[number] = time.monotonic()
    sender.sendto(b"%d" % number, ("127.0.0.1", port))
end = time.monotonic() + 0.5
while time.monotonic() < end:
    receive()
    time.sleep(0.001)
relay.send_signal(signal.SIGTERM)
done = json.loads(relay.communicate(timeout=10)[0])
numbers = [number for number, _ in came]
delays = sorted(delay * 1000 for _, delay in came)
print(json.dumps({"came": sorted(numbers), "lost": COUNT - len(set(numbers)), "twice": len(numbers) - len(set(numbers)),
                  "late_order": sum(b < a for a, b in zip(numbers, numbers[1:])), "least_ms": delays[0],
                  "median_ms": delays[len(delays) // 2], "p95_ms": delays[len(delays) * 95 // 100], "done": done}))
PYTHON
for run in 1 2 3; do python3 -I -S try.py "$relay" $((run / 3 + 7)) >run$run; done # seeds 7, 7 and 8
value() { json "$1" <run1; }
between() { python3 -I -S -c 'import sys; a, low, high = map(float, sys.argv[1:]); print(a); sys.exit(not low <= a <= high)' "$@"; }
check "5 % are lost" between "$(value lost)" 60 140
check "1 % come twice" between "$(value twice)" 5 40
check "many are overtaken" between "$(value late_order)" 200 1950
check "none comes before 70 ms" between "$(value least_ms)" 69.9 80
check "half come within 100 ms" between "$(value median_ms)" 95 120
check "the relay counts the same" python3 -I -S -c '
import json
run = json.load(open("run1"))
assert run["done"]["lost"] == run["lost"] and run["done"]["twice"] == run["twice"] and run["done"]["sent"] == len(run["came"]), run["done"]'
check "the same seed loses and repeats the same" equal "$(json came <run1)" "$(json came <run2)"
check "another seed does not" eval '! equal "$(json came <run1)" "$(json came <run3)"'
done_testing
