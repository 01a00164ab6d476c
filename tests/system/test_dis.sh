#!/usr/bin/env bash
# jolon dis: PDUs that it sends are read by tshark and by open-dis as they were meant, a recording plays
# as it was recorded, and what is wrong is refused in one line. SEED=n draws other PDUs.
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"
mkdir "$JOLON_RUNTIME_DIR"
here=$top/tests/system
work=$top/build/tests/open-dis
seed=${SEED:-$RANDOM}

# A free port of this test: bind() of another process would need the same number.
port=$(python3 -I -S -c 'import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')

# --- other implementations ---------------------------------------------------------------------------
if command -v tshark >/dev/null; then
    mkdir tshark && check "tshark reads each field as it was sent" eval \
        "(cd tshark && python3 '$here/dis_fields.py' '$bin/jolon-dis' tshark $seed) >fields"
    sed 's/^/# figures: tshark: /' fields
else
    skip "tshark reads each field as it was sent" "there is no tshark here"
fi
have_open_dis() {
    [ -d "$work/node_modules/open-dis" ] && return
    "$top/supervisor/install-packages" "$top/tests/open-dis/packages.txt" && mkdir -p "$work" &&
        cp "$top/tests/open-dis/package.json" "$top/tests/open-dis/package-lock.json" "$work/" &&
        (cd "$work" && timeout 60 npm ci --ignore-scripts --no-audit --no-fund)
}
if have_open_dis >npm.log 2>&1; then
    mkdir open-dis && check "open-dis reads each field as it was sent, and encodes the same octets" eval \
        "(cd open-dis && python3 '$here/dis_fields.py' '$bin/jolon-dis' '$work' $seed) >fields"
    sed 's/^/# figures: open-dis: /' fields
else
    skip "open-dis reads each field as it was sent" "open-dis cannot be installed here"
fi

# --- send, record, dump, play -------------------------------------------------------------------------
wait_for() { # FILE PATTERN: waits until the pattern is in the file
    for _ in {1..100}; do
        grep -q "$2" "$1" 2>/dev/null && return
        sleep 0.05
    done
    return 1
}
bound() { grep -qi ":$(printf %04X "$port") " /proc/net/udp /proc/net/udp6; } # somebody receives at the port
wait_bound() { for _ in {1..100}; do bound && return; sleep 0.05; done; return 1; }
state=(entity-state id=1:2:3 force=1 type=1.1.225.1.1.2.0 "place=35.95,-121.25,300" "attitude=90,0,0" turret=45)

"$jolon" dis record --listen "127.0.0.1:$port" --count 5 five.pcap 2>recorded &
recorder=$!
wait_bound
"$jolon" dis send --to "127.0.0.1:$port" --count 4 --every 0.2 "${state[@]}" "marking=TANK 1"
"$jolon" dis send --to "127.0.0.1:$port" --version 6 fire firer=1:2:3 range=100
wait $recorder
check "record ends after its count" equal "$(cat recorded)" "5 datagrams in five.pcap"
"$jolon" dis dump --port "$port" five.pcap >text 2>summary
check "dump shows each PDU" equal "$(wc -l <text)" 5
check "dump shows the fields" grep -q 'entity-state version=7 .* id=1:2:3 force=1 .*"TANK 1".*place=35.95000000,-121.25000000,300.000' text
check "dump counts the types" grep -q '^ *4 entity-state$' summary
check "dump --type shows one type" equal "$("$jolon" dis dump --port "$port" --type fire five.pcap 2>/dev/null | wc -l)" 1
check "dump shows no datagrams to other ports" equal "$("$jolon" dis dump five.pcap 2>/dev/null | wc -l)" 0
check "dump --json is JSON" eval '"$jolon" dis dump --port "$port" --json --count 1 five.pcap 2>/dev/null | json location.2'

"$jolon" dis dump --listen "127.0.0.1:$port" --count 5 >live 2>/dev/null &
dumper=$!
wait_bound
began=$(date +%s%N)
"$jolon" dis play --to "127.0.0.1:$port" --port "$port" --speed 2 five.pcap 2>played
took_ms=$((($(date +%s%N) - began) / 1000000))
wait $dumper
check "play sends each datagram" grep -q '^5 datagrams sent' played
check "play at twice the speed takes half of the time" [ $took_ms -ge 300 ]
check "what was played is what was recorded" diff <(sed 's/^[^ ]* [^ ]* //' text) <(sed 's/^[^ ]* [^ ]* //' live)
began=$(date +%s%N)
"$jolon" dis play --to "127.0.0.1:$port" --port "$port" --speed max five.pcap 2>played
check "play does not mind that nobody receives" grep -q '^5 datagrams sent' played
check "play --speed max does not wait" [ $((($(date +%s%N) - began) / 1000000)) -lt 600 ]

"$jolon" dis dump --listen "127.0.0.1:$port" >live 2>summary &
dumper=$!
wait_bound
python3 -I -S -c 'import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for junk in (b"", b"x", b"\7\1\1\1" + bytes(8), b"\7\1\1\1" + bytes(4) + b"\0\x0c\0\0", b"\4\1\1\1" + bytes(4) + b"\0\x0c\0\0"):
    s.sendto(junk, ("127.0.0.1", int(sys.argv[1])))' "$port"
wait_for live 'version other than'
kill -INT $dumper
wait $dumper
check "junk is counted, and dump ends with 0 by Ctrl-C" equal $? 0
check "each kind of fault has its line" equal "$(grep -c 'dropped: ' summary)" 4

"$jolon" dis record --listen "239.255.78.13:$port" --interface 127.0.0.1 --count 1 --seconds 5 group.pcap 2>/dev/null &
recorder=$!
wait_bound
"$jolon" dis send --to "239.255.78.13:$port" --interface 127.0.0.1 "${state[@]}"
wait $recorder
check "multicast arrives" equal "$("$jolon" dis dump --port "$port" --summary group.pcap | grep -c entity-state)" 1

# --- refusals -----------------------------------------------------------------------------------------
echo "no capture" >text.pcap
refuses "a missing capture" 1 'missing.pcap: is no capture' "$jolon" dis play missing.pcap
refuses "a text as a capture" 1 'text.pcap: is no capture' "$jolon" dis play text.pcap
refuses "a capture that exists" 1 'five.pcap: cannot be made: File exists' "$jolon" dis record --listen "127.0.0.1:$port" five.pcap
refuses "an address of another machine" 1 '192.0.2.1:3000: cannot receive there' "$jolon" dis record --listen 192.0.2.1 new.pcap
refuses "a name as an address" 2 'localhost: must be an address in numbers' "$jolon" dis send --to localhost fire
refuses "to send to all addresses" 1 '0.0.0.0:3000: is no address to send to' "$jolon" dis send --to 0.0.0.0:3000 fire
refuses "to play to all addresses" 1 '\[::\]:3000: is no address to send to' "$jolon" dis play --to '[::]:3000' five.pcap
refuses "a grid that is missing" 1 'grid.gtx: cannot be read.*proj-data' "$jolon" dis undulation --grid grid.gtx 35.95 -121.25
refuses "a text as a grid" 1 'text.pcap: is shorter than the header of a GTX grid' "$jolon" dis undulation --grid text.pcap -35.95 121.25
refuses "one number for a place" 2 'needs a latitude from -90 to 90' "$jolon" dis undulation -121.25
refuses "a latitude of 91" 2 'needs a latitude from -90 to 90' "$jolon" dis undulation 91 0
if [ -r /usr/share/proj/egm96_15.gtx ]; then
    check "the sea is 33.7 m below the ellipsoid at Fort Hunter Liggett" equal "$("$jolon" dis undulation 35.95 -121.25)" gateway.undulation_m=-33.68
    check "and 22.5 m above it at Sydney" equal "$("$jolon" dis undulation -33.86 151.2)" gateway.undulation_m=22.47
else
    skip "the sea at Fort Hunter Liggett and at Sydney" "there is no grid of PROJ here"
fi
refuses "an unknown verb" 2 'there are dump, send, record, play, undulation' "$jolon" dis show
refuses "an unknown type" 2 'radio: is no type' "$jolon" dis send radio
refuses "an unknown field" 2 'colour: no such field' "$jolon" dis send fire colour=red
refuses "a value out of range" 2 'force=300: must be 0..255' "$jolon" dis send entity-state force=300
refuses "record without a file" 2 'needs a FILE' "$jolon" dis record
refuses "an unknown type to dump" 2 'is no type' "$jolon" dis dump --type radio five.pcap
refuses "a full disk" 1 'cannot be written' sh -c '"$0" dis dump --port "$1" five.pcap >/dev/full' "$jolon" "$port"
for verb in dump send record play undulation; do
    check "dis $verb --help" eval "'$jolon' dis $verb --help | grep -q '^usage: jolon-dis $verb'"
done
done_testing
