#!/usr/bin/env bash
# 100,000 junk datagrams a second come to the gateway's ear: it lives, the frames go on, it sends as before, and its log has one line
# a second at most. SEED=n draws others.
# Quiet: it judges frames beside a sender that takes a processor
. "$(dirname "$0")/lib.sh"
seed=${SEED:-$RANDOM}
free_port() { python3 -I -S -c 'import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])'; }
port=$(free_port) in=$(free_port)
cat >flood.py <<'PYTHON'
"""usage: flood.py PORT SECONDS SEED    Sends junk at 100,000 datagrams a second; prints how many a second it was."""
import random
import socket
import struct
import sys
import time

port, seconds, rate = int(sys.argv[1]), float(sys.argv[2]), 100000
draw, out = random.Random(int(sys.argv[3])), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setblocking(False)
state = struct.pack(">BBBBIHBB6sBB8s8s12s24s12sIB15s12s12sB11sI", 7, 1, 1, 1, 0, 144, 0, 0, struct.pack(">3H", 7, 1, 5), 1, 0, bytes(8), bytes(8),
                    bytes(12), bytes(24), bytes(12), 0, 1, bytes(15), bytes(12), bytes(12), 1, b"junk", 0)
junk = [b"", b"\0" * 12, state[:100], state + state[:8], b"\7\2" + state[2:], b"\7\1\x1b" + state[3:], b"\7\1\1\5" + state[4:],
        state[:48] + struct.pack(">d", float("nan")) + state[56:], state[:8] + b"\0\0" + state[10:], state[:19] + b"\xff" + state[20:]]
junk += [draw.randbytes(draw.randrange(1, 1400)) for _ in range(200)]
junk += [bytes(octet if draw.random() > 0.02 else draw.randrange(256) for octet in state) for _ in range(200)]
draw.shuffle(junk)
out.connect(("127.0.0.1", port))
begun, sent = time.monotonic(), 0
while (now := time.monotonic() - begun) < seconds:
    while sent < now * rate:
        for datagram in junk[sent % 400:sent % 400 + 10]:
            try:
                out.send(datagram)
            except OSError:
                pass
        sent += 10
    time.sleep(0.0002)
print(round(sent / seconds))
PYTHON
processor_ms() { awk '{ sub(/.*\) /, ""); print ($12 + $13) * 10 }' "/proc/$1/stat"; }
"$jolon" start -w "$name" --without renderer --without reporter --out out --dis "127.0.0.1:$port" --set "gateway.listen=127.0.0.1:$in" >/dev/null
check "the gateway receives" eventually grep -q "receives at" out/jolon.log
sleep 2
gateway=$(pid gateway) from=$(frame) late=$("$bin/jolon-world" summary --json --world "$name" | json late_frames)
before=$(processor_ms "$gateway")
SECONDS=0
rate=$(python3 -I -S flood.py "$in" 10 "$seed")
took=$((SECONDS + 1)) frames=$(($(frame) - from)) used=$(($(processor_ms "$gateway") - before))
late=$(($("$bin/jolon-world" summary --json --world "$name" | json late_frames) - late))
check "the gateway lives" equal "$(pid gateway)" "$gateway"
check "frames go on" [ $frames -ge $((took * 30)) ]
"$jolon" dis dump --listen "127.0.0.1:$port" --seconds 2 --summary --json >sent 2>/dev/null
check "it sends as before" eval '[ "$(json types.1 <sent)" -ge 100 ]'
"$jolon" stop -w "$name" >/dev/null
lines=$(grep -c 'gateway warning' out/jolon.log)
check "its log has one line a second at most" [ "$lines" -le $((took + 1)) ]
check "what came is counted" grep -q 'received [0-9]* PDUs in [1-9][0-9]* datagrams; 0 datagrams of strangers, [1-9]' out/jolon.log
check "nothing was refused to it by its sandbox" eval '! grep -q "forbids system call" out/jolon.log'
echo "# figures: $rate datagrams a second for $took s: $frames frames, $late late; the gateway took $((used / took / 10)) % of a core and wrote $lines lines; SEED=$seed"
echo "# figures: $(grep -o 'received [0-9]* PDUs.*' out/jolon.log | tail -n 1)"
done_testing
