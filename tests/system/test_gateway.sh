#!/usr/bin/env bash
# The gateway: what tshark reads is what the world has, a gateway that is killed goes on with the same
# identifiers, and no run changes because of it.
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
free_port() { python3 -I -S -c 'import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])'; }
port=$(free_port)
record() { # FILE: records what is sent until `finish`
    "$jolon" dis record --listen "127.0.0.1:$port" "$1" 2>/dev/null &
    recorder=$!
    eventually grep -qi ":$(printf %04X "$port") " /proc/net/udp
}
finish() { sleep 0.3; kill -INT $recorder; wait $recorder; }
count() { "$jolon" dis dump --port "$port" --summary --json "$1" | json "types.$2"; } # FILE TYPE

# --- results do not change ------------------------------------------------------------------------------
quick=(--pace max --frames 300 --without renderer --without reporter --json)
plain=$("$jolon" run -w "$name" "${quick[@]}" --out out-plain 2>/dev/null | json digest)
with=$("$jolon" run -w "$name" "${quick[@]}" --out out-dis --dis "127.0.0.1:$port" 2>/dev/null | json digest)
check "a run has a digest" [ -n "$plain" ]
check "the digest with a gateway is that without" equal "$with" "$plain"
check "a set without the key has no gateway" eval '! grep -q gateway out-plain/jolon.log'

# --- what is sent ---------------------------------------------------------------------------------------
record run.pcap
"$jolon" start -w "$name" --without renderer --without reporter --out out --dis "127.0.0.1:$port" >/dev/null
check "status shows the gateway" eval '"$jolon" status -w "$name" | grep -q gateway'
sleep 3
check "a killed gateway is started again" eval 'before=$(pid gateway); "$jolon" kill -w "$name" gateway >/dev/null;
    eventually eval "[ -n \"\$(pid gateway)\" ] && [ \"\$(pid gateway)\" != $before ]"'
for signal in TERM INT HUP; do
    check "a gateway that somebody ends by SIG$signal is started again" eval 'before=$(pid gateway); "$jolon" kill -w "$name" gateway $signal >/dev/null;
        eventually eval "[ -n \"\$(pid gateway)\" ] && [ \"\$(pid gateway)\" != $before ]"'
    sleep 0.5
done
check "restart gateway" "$jolon" restart -w "$name" gateway
sleep 1
"$jolon" ctl -w "$name" pause >/dev/null
sleep 1
"$bin/jolon-world" dump --world "$name" --json >rows
finish
if command -v tshark >/dev/null; then
    check "tshark reads the places and attitudes of the paused world" \
        eval "python3 '$here/dis_world.py' run.pcap $port rows >compared"
    sed 's/^/# figures: /' compared
else
    skip "tshark reads the places and attitudes of the paused world" "there is no tshark here"
fi
"$jolon" dis dump --port "$port" --json run.pcap >pdus 2>/dev/null
check "no kill, no signal and no restart has told that the vehicles leave" python3 -I -S -c '
import json
last = sum(pdu["appearance"] >> 23 & 1 for pdu in map(json.loads, open("pdus")) if pdu["pdu"] == "entity-state")
print(last)
assert last < 100' # missiles that struck
check "no entity has two types" python3 -I -S -c '
import json, sys
types = {}
for line in open("pdus"):
    pdu = json.loads(line)
    if pdu["pdu"] == "entity-state" and types.setdefault(tuple(pdu["id"]), pdu["type"]) != pdu["type"]:
        sys.exit(f"{pdu}")
print(len(types))
assert len(types) >= 500'

# --- the end --------------------------------------------------------------------------------------------
"$jolon" ctl -w "$name" resume >/dev/null
record end.pcap
"$jolon" stop -w "$name" >/dev/null
finish
last=$("$jolon" dis dump --port "$port" --json --type entity-state end.pcap 2>/dev/null | python3 -I -S -c '
import json, sys
print(sum(json.loads(line)["appearance"] >> 23 & 1 for line in sys.stdin))')
check "each vehicle has a last state when the world stops" [ "${last:-0}" -ge 500 ]
check "the log says what was sent" grep -q 'gateway info .* sent [0-9]* PDUs of [0-9]* octets; 0 failed' out/jolon.log
check "nothing was refused to the gateway by its sandbox" eval '! grep -q "forbids system call" out/jolon.log'

# --- heights --------------------------------------------------------------------------------------------
grid() { "$jolon" run -w "$name" "${quick[@]}" --out "$1" --dis "127.0.0.1:$port" --set gateway.undulation_grid=true >/dev/null 2>&1; }
PROJ_DATA=/nowhere grid out-without
check "where PROJ's grid is missing, the log says so in one line" \
    grep -q 'gateway warning .*/nowhere/egm96_15.gtx: cannot be read.*all heights are by gateway.undulation_m = -33.70' out-without/jolon.log
if [ -r /usr/share/proj/egm96_15.gtx ]; then
    grid out-grid
    check "where it is, it is taken" grep -q 'takes the height of the sea at each place from /usr/share/proj/egm96_15.gtx' out-grid/jolon.log
else
    skip "where it is, it is taken" "there is no proj-data here"
fi

refused() { # WORDS COMMAND...: the command is refused in these words, beside a world that runs
    local words=$1
    shift
    "$@" >refused 2>&1
    [ $? = 1 ] && grep -q "$words" refused
}

# --- two receivers, and a broken table -------------------------------------------------------------------
in=$(free_port) data=$PWD/data
cp -r "${JOLON_DATA:-$here/../../config}" "$data"
JOLON_DATA=$data "$jolon" start -w "$name" --without renderer --without reporter --out out-in --dis "127.255.255.255:$port" \
    --set "gateway.listen=127.0.0.1:$in" >/dev/null
check "the gateway receives" eventually grep -q "receives at" out-in/jolon.log
check "and warns that it does not hear the broadcast to which it sends" \
    grep -q "gateway.listen = 127.0.0.1:$in does not hear what others send to 127.255.255.255:$port" out-in/jolon.log
check "a second receiver at its address is refused" refused "127.0.0.1:$in: cannot receive there: another program does" \
    "$jolon" dis dump --listen "127.0.0.1:$in" --seconds 1
sed -i 's/1\.1\.225\.1\.1\.2\.0/1.1.225.1.1.2/' "$data/dis/types.txt"
SECONDS=0
stalled
stalled_before=$stalled_us
check "a restart with a broken table of types is refused" refused 'gateway refused: .*types.txt:[0-9]*: .*seven numbers' "$jolon" restart -w "$name" gateway
check "another one as well" refused 'gateway refused: .*types.txt:[0-9]*: .*seven numbers' "$jolon" restart -w "$name" gateway
stalled
check "neither takes 20 s" [ $((SECONDS - (stalled_us - stalled_before) / 1000000)) -lt 18 ]
cp "$here/../../config/dis/types.txt" "$data/dis/types.txt"
check "and with a good one it runs" "$jolon" restart -w "$name" gateway
"$jolon" stop -w "$name" >/dev/null

# --- a rate that does not suffice ------------------------------------------------------------------------
record rate.pcap
"$jolon" start -w "$name" --without renderer --without reporter --out out-rate --dis "127.0.0.1:$port" --set "gateway.listen=127.0.0.1:$in" \
    --set gateway.rate=60 --set 'gateway.control=7:1' >/dev/null
check "it receives" eventually grep -q "receives at" out-rate/jolon.log
sleep 6
"$jolon" dis send --to "127.0.0.1:$in" stop-freeze originator=7:1:0 receiver=1991:1:0 request=5
sleep 3
"$jolon" dis send --to "127.0.0.1:$in" start-resume originator=7:1:0 receiver=1991:1:0 request=6
for k in 1 2 3 4 5; do "$jolon" ctl -w "$name" fire --munition artillery --at "$((20000 + k * 100)),20000" >/dev/null; done
sleep 8
finish
"$jolon" stop -w "$name" >/dev/null
check "a stop and a start are acknowledged at 60 PDUs a second" equal "$(count rate.pcap 15)" 2
check "and shots and detonations are sent among 500 vehicles" [ "$(count rate.pcap 3)" -ge 5 ]
check "the log says that the rate is low" grep -q 'gateway warning .*gateway.rate = 60 PDUs a second is less than the world needs: .* and 0 are lost' out-rate/jolon.log

# --- refusals -------------------------------------------------------------------------------------------
run=("$jolon" run -w "$name" --frames 1 --out out)
refuses "a name as an address" 2 'jolon: --dis localhost: must be an address in numbers' "${run[@]}" --dis localhost
refuses "a name by the key" 1 'gateway.address = "?localhost"?.*no address in numbers' "${run[@]}" --set gateway.address=localhost
refuses "more remote entities than rows" 1 'world.remotes_max = 65: world.capacity = 64 has no rows for so many; allowed: up to 64' \
    "${run[@]}" --set world.remotes_max=65 --set world.capacity=64
refuses "a zone" 1 'an address has no %zone here; name it by gateway.interface' "${run[@]}" --set 'gateway.listen=[ff02::1%lo]:3000'
refuses "port 0" 2 'a whole number from 1 to 65535' "${run[@]}" --dis 127.0.0.1:0
refuses "half a pair of brackets" 2 'must be an address in numbers' "${run[@]}" --dis '[::1'
refuses "no address" 2 'must be an address in numbers' "${run[@]}" --dis :3000
refuses "too many applications" 1 'gateway.applications.*up to 65532' "${run[@]}" --set gateway.application=2 --set gateway.applications=65533
refuses "another version" 1 'gateway.version.*5' "${run[@]}" --set gateway.version=5
# --- a world on a ground file ---------------------------------------------------------------------------------
# The middle of the town is 52.4 N, 9 E, its ground 60 m above the sea. By PROJ (proj -I +proj=tmerc +lat_0=52.4 +lon_0=9
# +ellps=WGS84) a place 23 km west and 22 km north of it is 52.597218812 N, 8.660567886 E.
cat >far.cfg <<'END'
world = { capacity = 64; };
terrain = { source = "file"; file = "town.ground"; };
objects = { source = "none"; };
vehicles = ({ kind = "tank"; behaviour = "idle"; at = [2000.0, 3000.0]; heading_deg = 0.0; });
END
port=$(free_port)
"$jolon" dis record --listen "127.0.0.1:$port" --seconds 20 far.pcap 2>/dev/null &
recorder=$!
"$jolon" run -w "$name" --without renderer --without reporter --frames 120 --out far --dis "127.0.0.1:$port" far.cfg >/dev/null 2>&1
kill -INT $recorder
wait $recorder
check "a world on a ground file is where its projection says, on the ground" eval \
    '"$jolon" dis dump --json --type entity-state --port "$port" far.pcap 2>/dev/null | python3 -I -S -c "
import json, math, sys
x, y, z = json.loads(sys.stdin.readline())[\"location\"]
a, f = 6378137.0, 1 / 298.257223563
e2, p, lat = f * (2 - f), math.hypot(x, y), math.atan2(z, math.hypot(x, y))
for _ in range(30):
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    h = p / math.cos(lat) - n
    lat = math.atan2(z, p * (1 - e2 * n / (n + h)))
assert abs(math.degrees(lat) - 52.597218812) < 2e-8, lat
assert abs(math.degrees(math.atan2(y, x)) - 8.660567886) < 2e-8
assert abs(h - 60.0) < 1e-3, h"'

done_testing
