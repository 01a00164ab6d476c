#!/usr/bin/env bash
# Start/Resume and Stop/Freeze of other simulations: obeyed where the scenario allows it, acknowledged, recorded, replayed; and
# datagrams of strangers.
. "$(dirname "$0")/lib.sh"
free_port() { python3 -I -S -c 'import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])'; }
port=$(free_port) in=$(free_port)
state() { "$jolon" status -w "$name" --json | json "$1"; }
paused() { equal "$(state paused)" True; }
running() { equal "$(state paused)" False; }
send() { "$jolon" dis send --to "127.0.0.1:$in" "$@"; } # OPTION... TYPE FIELD=VALUE...
acknowledged() { # REQUEST: prints how often a request was acknowledged, and how: FLAG/RESPONSE
    "$jolon" dis dump --port "$port" --json --type acknowledge acks.pcap 2>/dev/null | python3 -I -S -c '
import json, sys
found = [pdu for pdu in map(json.loads, sys.stdin) if pdu["request"] == int(sys.argv[1])]
print(len(found), *sorted({"%d/%d" % (pdu["acknowledge"], pdu["response"]) for pdu in found}),
      *sorted({":".join(map(str, pdu["originator"] + pdu["receiver"])) for pdu in found}))' "$1"
}
clock() { python3 -I -S -c 'import sys, time
hours, past = divmod(time.time() + float(sys.argv[1]), 3600)
print(f"{int(hours)}:{int(past / 3600 * 2**31) << 1 | 1}")' "$1"; } # SECONDS from now, as a clock of DIS

"$jolon" dis record --listen "127.0.0.1:$port" acks.pcap 2>/dev/null &
recorder=$!
"$jolon" start -w "$name" --without renderer --without reporter --out out --dis "127.0.0.1:$port" --set "gateway.listen=127.0.0.1:$in" \
    --set 'gateway.control=7:1, 8:*' --set gateway.version=6 >/dev/null
check "the gateway receives" eventually grep -q "receives at 127.0.0.1:$in" out/jolon.log

# --- obeyed -----------------------------------------------------------------------------------------------
send stop-freeze originator=7:1:0 receiver=1991:1:0 reason=1 request=100
check "Stop/Freeze of 7:1 pauses the world" eventually paused
at=$(frame)
send --version 6 start-resume originator=8:44:0 receiver=65535:65535:65535 request=101
check "Start/Resume of 8:44 to all resumes it" eventually running
check "its frames go on" eventually eval '[ "$(frame)" -gt '"$at"' ]'
send stop-freeze originator=7:1:0 receiver=1991:1:0 request=102 real_time="$(clock 1.5)"
sleep 0.5
check "a stop for a later time waits for it" running
check "and is then obeyed" eventually paused
for _ in 1 2 3; do send start-resume originator=7:1:0 receiver=1991:1:0 request=103; done
check "a start that comes three times resumes once" eventually running
# The same octets with version 5, which jolon dis does not write: 7:1:0 to FFFF:FFFF:FFFF, request 105.
python3 -I -S -c 'import socket, sys
octets = "05010e05" + "57c962fd" + "00280000" + "000700010000" + "ffffffffffff" + "00" * 8 + "0100" + "0000" + "00000069"
socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(bytes.fromhex(octets), ("127.0.0.1", int(sys.argv[1])))' "$in"
check "a stop by version 5 is obeyed" eventually paused
send start-resume originator=7:1:0 receiver=1991:1:0 request=106
check "and a start after it" eventually running
sleep 0.3

# --- not obeyed -------------------------------------------------------------------------------------------
SECONDS=0
for i in $(seq 20); do send stop-freeze originator=9:1:0 receiver=1991:1:0 request=$((200 + i)); done
took=$((SECONDS + 1))
send stop-freeze originator=7:2:0 receiver=1991:1:0 request=300
send stop-freeze originator=7:1:0 receiver=1992:1:0 request=301
send --exercise 2 stop-freeze originator=7:1:0 receiver=1991:1:0 request=302
send stop-freeze originator=7:1:0 receiver=1991:1:17 request=303
send stop-freeze originator=7:1:0 receiver=1991:1:0 request=304 real_time="$(clock 4000)"
sleep 0.5
check "nobody else stops it" running
# Of all that come within a second the last is named.
check "who is not allowed is told of" eventually grep -q 'gateway warning .* stop-freeze of \(9:1\|7:2\):0 is ignored: gateway.control does not name it' out/jolon.log
check "once a second at most" [ "$(grep -c "gateway.control does not name it" out/jolon.log)" -le $((took + 2)) ]
check "a start an hour ahead is told of, with the reason" eventually grep -q "stop-freeze 30[34] of 7:1:0: .*" out/jolon.log

# --- kills ------------------------------------------------------------------------------------------------
before=$(pid intake)
another_intake() { local now; now=$(pid intake); [ -n "$now" ] && [ "$now" != "$before" ]; }
"$jolon" kill -w "$name" intake >/dev/null
send stop-freeze originator=7:1:0 receiver=1991:1:0 request=400
check "an intake that is killed meanwhile changes nothing" eventually paused
check "it was another" eventually another_intake
before=$(pid gateway)
another_gateway() { local now; now=$(pid gateway); [ -n "$now" ] && [ "$now" != "$before" ]; }
"$jolon" kill -w "$name" gateway >/dev/null
check "a killed gateway is started again" eventually another_gateway
check "and receives" eventually eval '[ "$(grep -c "receives at" out/jolon.log)" = 2 ]'
check "the world is still paused" paused
send start-resume originator=7:1:0 receiver=1991:1:0 request=401
check "the new gateway obeys" eventually running
send stop-freeze originator=7:1:0 receiver=1991:1:0 request=402 real_time="$(clock 3)"
sleep 0.5
before=$(pid gateway)
"$jolon" kill -w "$name" gateway >/dev/null
check "a gateway that is killed before the time of a stop is started again" eventually another_gateway
check "and its successor stops the world" eventually paused
check "which the log says" grep -q 'takes over requests that wait for their time: 1' out/jolon.log
send start-resume originator=7:1:0 receiver=1991:1:0 request=100
check "a start is obeyed whose number was that of a stop" eventually running
send stop-freeze originator=7:1:0 receiver=1991:1:0 request=100
check "and a stop by the same number again" eventually paused
send start-resume originator=7:1:0 receiver=1991:1:0 request=100
check "and a start" eventually running
sleep 0.3
kill -INT $recorder
wait $recorder

# --- acknowledged -----------------------------------------------------------------------------------------
check "stops and starts of one number are acknowledged once each" equal "$(acknowledged 100)" "4 3/1 4/1 1991:1:0:7:1:0"
check "the stop before whose time the gateway was killed as well" equal "$(acknowledged 402)" "1 4/1 1991:1:0:7:1:0"
check "the start to all as well" equal "$(acknowledged 101)" "1 3/1 1991:1:0:8:44:0"
check "the later stop when it came" equal "$(acknowledged 102)" "1 4/1 1991:1:0:7:1:0"
check "each of three starts" equal "$(acknowledged 103)" "3 3/1 1991:1:0:7:1:0"
check "and the stop by version 5" equal "$(acknowledged 105)" "1 4/1 1991:1:0:7:1:0"
check "the stop of one entity is answered: unable" equal "$(acknowledged 303)" "1 4/2 1991:1:0:7:1:0"
check "the stop in an hour as well" equal "$(acknowledged 304)" "1 4/2 1991:1:0:7:1:0"
check "the stop during the kill is acknowledged" equal "$(acknowledged 400)" "1 4/1 1991:1:0:7:1:0"
check "by version 6, as the scenario says" equal "$("$jolon" dis dump --port "$port" --json acks.pcap 2>/dev/null | python3 -I -S -c '
import json, sys
print(sorted({json.loads(line)["version"] for line in sys.stdin}))')" "[6]"
for request in 201 220 300 301 302; do check "request $request is not" equal "$(acknowledged $request)" 0; done

# --- recorded -----------------------------------------------------------------------------------------------
"$jolon" ctl -w "$name" pause >/dev/null
digest=$(summary digest) commands=$(summary commands)
"$jolon" stop -w "$name" >/dev/null
check "the world has seen a command for each request, and up to three for the one that came three times" [ $((commands - 13)) -ge 0 ]
check "and no more" [ "$commands" -le 16 ]
check "a replay of the log ends the same" equal "$("$jolon" replay out/commands.log --json 2>/dev/null | json digest)" "$digest"
check "nothing was refused to the gateway by its sandbox" eval '! grep -q "forbids system call" out/jolon.log'

# --- no gateway ---------------------------------------------------------------------------------------------
start_quiet() { { "$jolon" start -w "$name" --without renderer --without reporter --out out3 "$@" >/dev/null; } 2>&1; }
idle='jolon: WARNING: without a gateway these settings have no effect: gateway.peers, gateway.control; --dis ADDRESS or gateway.enabled = true gives the world one'
check "a set without a gateway names the settings of one" equal \
    "$(start_quiet --set 'gateway.control=7:1' --set 'gateway.peers=10.0.0.0/8')" "$idle"
check "also in its log" grep -qF "${idle#jolon: }" out3/jolon.log
without_effect() { "$jolon" status -w "$name" --json | python3 -I -S -c 'import json, sys; print(*json.load(sys.stdin)["without_effect"])'; }
check "and in its status as JSON" equal "$(without_effect)" "gateway.peers gateway.control"
"$jolon" stop -w "$name" >/dev/null
check "a set without such settings says nothing" equal "$(start_quiet)" ""
check "nor does its status as JSON" equal "$(without_effect)" ""
"$jolon" stop -w "$name" >/dev/null

# --- strangers ----------------------------------------------------------------------------------------------
"$jolon" start -w "$name" --without renderer --without reporter --out out2 --dis "127.0.0.1:$port" --set "gateway.listen=127.0.0.1:$in" \
    --set 'gateway.control=7:1' --set 'gateway.peers=10.0.0.0/8, 127.0.0.2' >/dev/null
eventually grep -q "receives at" out2/jolon.log
SECONDS=0
for i in $(seq 20); do send stop-freeze originator=7:1:0 receiver=1991:1:0 request="$i"; done
took=$((SECONDS + 1))
sleep 0.3
check "a stranger does not stop the world" running
check "he is told of" grep -q 'gateway warning .* datagrams of strangers were refused, the last from 127.0.0.1:[0-9]*: gateway.peers does not name it' out2/jolon.log
check "once a second at most" [ "$(grep -c "of strangers were refused" out2/jolon.log)" -le $((took + 1)) ]
"$jolon" stop -w "$name" >/dev/null
check "and counted" grep -q 'received 0 PDUs in 0 datagrams; 20 datagrams of strangers' out2/jolon.log
refuses "a control without an application" 1 'gateway.control = "?7"?.*SITE:APPLICATION' \
    "$jolon" run -w "$name" --frames 1 --out out --set gateway.control=7
refuses "a peer without a number" 1 'gateway.peers = "?all"?.*an address in numbers or a range' \
    "$jolon" run -w "$name" --frames 1 --out out --set gateway.peers=all
done_testing
