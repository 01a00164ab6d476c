#!/usr/bin/env bash
# Cursor on Target: every event is well-formed XML, says what the world has, keeps its identifier when the gateway is killed, and
# the dead are taken off the map.
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
free_port() { python3 -I -S -c 'import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])'; }
port=$(free_port) dis_port=$(free_port)
receive() { # FILE: receives until `finish`
    python3 -I "$here/cot_world.py" receive "$port" "$1" 2>receiver &
    receiver=$!
    eventually grep -qi ":$(printf %04X "$port") " /proc/net/udp
}
finish() { sleep 0.3; kill -TERM $receiver; wait $receiver; }
events() { python3 -I -S -c '
import json, sys
events = [json.loads(line) for line in open(sys.argv[1])]
print(eval(sys.argv[2]))' "$@"; } # FILE EXPRESSION
cot=(--dis "127.0.0.1:$dis_port" --set "gateway.cot=127.0.0.1:$port")

# --- names that XML does not allow, and a death ---------------------------------------------------------
cat >names.cfg <<'EOF2'
terrain = { source = "flat"; height_m = 100.0; };
objects = { source = "none"; };
vehicles = (
    { name = "<R&D> \"1\" 'x'"; kind = "tank"; force = "blue"; behaviour = "hold"; at = [25000.0, 25000.0]; },
    { name = "goal"; kind = "truck"; force = "red"; behaviour = "hold"; at = [26000.0, 25000.0]; },
    { kind = "jet"; force = "neutral"; behaviour = "hold"; at = [20000.0, 25000.0]; altitude_m = 1000.0; heading_deg = 90.0; speed_mps = 200.0; }
);
EOF2
receive names
"$jolon" start -w "$name" --without renderer --without reporter --out out "${cot[@]}" names.cfg >/dev/null
check "all three are shown" eventually eval '[ "$(events names "len({event[\"uid\"] for event in events})")" = 3 ]'
check "a name comes as it was written" equal "$(events names 'events[0]["callsign"]')" "<R&D> \"1\" 'x'"
check "its type is that of a tank of friends" equal "$(events names 'events[0]["type"]')" a-f-G-E-V-A-T
check "the jet flies east at 200 m/s" equal "$(events names '[round(event["speed"] / 10) * 10 for event in events if abs(event["course"] - 90) < 0.2][0]')" 200
check "each is out of date after 12 s" equal "$(events names '{round(event["stale_s"], 3) for event in events}')" '{12.0}'
check "there is fire on the truck" "$jolon" ctl -w "$name" fire --munition bomb --at 26000,25000
check "the dead truck is taken off the map" eventually eval 'equal "$(events names "[event[\"gone\"] for event in events if \"gone\" in event]")" "['"'jolon.1.1991.1.2'"']"'
before=$(pid gateway)
another_gateway() { local now; now=$(pid gateway); [ -n "$now" ] && [ "$now" != "$before" ]; }
"$jolon" kill -w "$name" gateway >/dev/null
check "a killed gateway is started again" eventually another_gateway
sleep 0.5
"$jolon" stop -w "$name" >/dev/null
finish
check "the receiver found every event well-formed" eval '[ ! -s receiver ] || { cat receiver; false; }'
check "no identifier is new after the kill" equal "$(events names 'sorted({event["uid"] for event in events})')" \
    "['jolon.1.1991.1.1', 'jolon.1.1991.1.2', 'jolon.1.1991.1.3']"
check "the end takes the others off the map" equal "$(events names 'sorted({event["gone"] for event in events[-2:]})')" \
    "['jolon.1.1991.1.1', 'jolon.1.1991.1.3']"
check "the log says what was sent" grep -q 'gateway info .* sent [0-9]* events of Cursor on Target of [0-9]* octets; 0 failed' out/jolon.log
check "nothing was refused to the gateway by its sandbox" eval '! grep -q "forbids system call" out/jolon.log'

# --- the default world ----------------------------------------------------------------------------------
receive world
"$jolon" start -w "$name" --without renderer --without reporter --out out2 "${cot[@]}" >/dev/null
sleep 4
"$jolon" ctl -w "$name" pause >/dev/null
sleep 1
"$bin/jolon-world" dump --world "$name" --json >rows
"$jolon" stop -w "$name" >/dev/null &
stopper=$!
finish
wait $stopper
grep -v '"gone": "jolon.1.1991.1' world >places
check "the places of the paused world are those of its rows" eval "python3 -I '$here/cot_world.py' compare places rows >compared"
sed 's/^/# figures: /' compared
echo "# figures: an event has $(events world 'round(sum(event["octets"] for event in events) / len(events))') octets"

# --- refusals -------------------------------------------------------------------------------------------
refuses "a name as an address" 1 'gateway.cot = "?tak.example"?.*must be an address in numbers' \
    "$jolon" run -w "$name" --frames 1 --out out --set gateway.enabled=true --set gateway.cot=tak.example
done_testing
