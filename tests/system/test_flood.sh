#!/usr/bin/env bash
# A client that floods the intake harms no other client. While one connection tries to send 100,000
# commands a second, another's drive is answered within 3 frames (p99). Spawns at one place are
# limited in space and time, any number of connections leaves room for others, and the world goes
# on. SECONDS_EACH=n.
. "$(dirname "$0")/lib.sh"
flood="$bin/../tests/flood/flood --world $name --seconds ${SECONDS_EACH:-3} --vehicle 1"
frames=${FRAMES_MAX:-3}
[ -z "${JOLON_SANITIZER:-}" ] || frames=30

check "a set starts" "$jolon" start -w "$name" --without renderer --without reporter --out "$folder/out"
value() { json "$1" <told; }
frame() { "$jolon" status -w "$name" --json | json commit; }
# held WHAT OPTION...: checks a driver's answers during a flood. Other programs that want the processor can only
# make answers later, so one of three floods must be answered in time.
held() {
    local what=$1
    shift
    for _ in 1 2 3; do
        # shellcheck disable=SC2086 # words
        check "a flood of $what is sent" eval "$flood $* >told"
        echo "# figures: $what: $(cat told)"
        [ "$(value frames_p99)" -gt $frames ] || break
    done
    check "$what: the flood tries 100,000 commands a second" [ "$(value sent_per_s)" -ge "${SENT_MIN:-60000}" ]
    check "$what: another client's drive is answered within $frames frames (p99)" [ "$(value frames_p99)" -le $frames ]
    check "$what: every drive is answered" equal "$(value unanswered)" 0
}

held drives
before=$("$jolon" status -w "$name" --json | json vehicles)
held "spawns on one spot" --spawn
after=$("$jolon" status -w "$name" --json | json vehicles)
# A place holds eight. Those that overlap part, which leaves room for a few more.
check "few of the spawns stand at one place" [ $((after - before)) -ge 1 -a $((after - before)) -le 24 ]
"$bin/jolon-ctl" -w "$name" spawn tank --at 20000,30000 2>err
check "the next spawn is refused with the reason" eval "[ $? = 1 ] && grep -q 'too many vehicles stand' err"
check "one process with 300 connections leaves room for others" eval \
    "$flood --idle 300 >told; cat told; [ \$(json unanswered <told) = 0 ]"

# Sends bytes that are no commands, and commands with random fields. The intake must survive.
cat >"$folder/garbage" <<'P'
import os, random, socket, struct, sys
path, seed = sys.argv[1], int(sys.argv[2])
chance = random.Random(seed)
sent = 0
while sent < 6000:
    s = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    s.connect(path)
    s.settimeout(5)
    for _ in range(chance.randrange(1, 40)):
        header = struct.pack("<II", 0x444d434a, 1)
        size = chance.choice((0, 1, 7, 8, 64, 175, 176, 177, 200, 4096, 60000, int(sys.argv[3])))
        body = bytearray(chance.randbytes(max(size - 8, 0)))
        if size == int(sys.argv[3]) and chance.random() < 0.9:
            body[16:20] = struct.pack("<I", chance.choice((*range(10), 11, 12)))  # the type, but not QUIT
            if chance.random() < 0.5:                                  # numbers, most of them good ones
                for at in range(20, len(body) - 7, 8):
                    body[at:at + 8] = struct.pack("<d", chance.choice((0.0, 0.5, 1.0, -1.0, float("nan"), 1e308)))
        try:
            s.send((header if chance.random() < 0.95 else b"") + bytes(body))
        except OSError:
            break  # hung up on, as it should be
        sent += 1
    s.close()
P
seed=${SEED:=$((RANDOM))}
echo "# SEED=$seed"
size=$("$bin/../tests/flood/flood" --packet)
path=$(dirname "$("$bin/jolon-world" paths --world "$name" lock)")/$name.commands
intake=$("$bin/jolon-world" pid --world "$name" intake)
check "6,000 damaged packets are sent to the command socket" timeout 60 \
    python3 "$folder/garbage" "$path" "$seed" "$size"
check "the intake has survived them" equal "$("$bin/jolon-world" pid --world "$name" intake)" "$intake"
check "the intake takes commands" "$bin/jolon-ctl" -w "$name" resume

# Operators' commands are done during a flood.
$flood --spawn --seconds 4 >/dev/null &
sleep 0.5
for command in pause "step 2" resume; do
    # shellcheck disable=SC2086 # words
    check "$command is done during a flood" "$bin/jolon-ctl" -w "$name" --timeout 1 $command
done
wait
begun=$(frame)
check "the world goes on" eventually eval "[ \$(frame) -gt $begun ]"
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
