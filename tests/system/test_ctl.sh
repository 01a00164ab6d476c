#!/usr/bin/env bash
# jolon ctl: every command is answered with its frame. Tests vehicles by id and by name, leases,
# fire missions, lines of standard input, and error messages.
. "$(dirname "$0")/lib.sh"
ctl="$bin/jolon-ctl -w $name --timeout 30"

check "a set starts" "$jolon" start -w "$name" --without renderer --without recorder \
    --out "$folder/out" --set world.frames=0 duel
says() { # PATTERN COMMAND...: it is done and says so in one line
    local pattern=$1
    shift
    $ctl "$@" >told && [ "$(wc -l <told)" = 1 ] && grep -Eq -- "$pattern" told || { cat told; return 1; }
}
denies() { # STATUS PATTERN COMMAND...: in one line of standard error
    local status=$1 pattern=$2
    shift 2
    $ctl "$@" >told 2>err
    [ $? = "$status" ] && [ ! -s told ] && [ "$(wc -l <err)" = 1 ] && grep -Eq -- "$pattern" err || { cat err; return 1; }
}

check "drive takes a name and all controls" says '^driving 1 from frame [0-9]+$' drive West \
    --throttle 0.5 --steer 0.1 --climb 0 --traverse 0.5 --elevate -0.5 --brake 0 --gear low
check "release is answered with its frame" says '^released 1 at frame [0-9]+$' release West
check "drive takes a lease" says '^driving 2 from frame [0-9]+ for 1200 frames$' drive East --lease 20 --brake 1
check "another driver is refused and told what to do" \
    denies 1 'East \(2\): somebody else drives it .frame.*release anyway' drive East --throttle 1
check "another driver cannot release the vehicle" denies 1 'somebody else drives it' release 2
check "release --anyway releases it" says '^released 2 at frame' release 2 --anyway
check "a lease ends by itself" eval '$ctl drive 2 --lease 0.2 >told && sleep 1 && $ctl drive 2 >told'
check "fire takes a target's name once the gun is aimed" eventually says '^1 fires at frame' \
    fire West --target East
check "a fire mission sends several commands" eval \
    '$ctl fire --munition shell --at 24000,24000 --rounds 4 --every 0.1 --radius 60 >told &&
    [ "$(grep -c "shell falls near 24000,24000 from frame" told)" = 4 ] &&
    [ "$(sed "s/.*frame \([0-9]*\) .*/\1/" told | sort -un | wc -l)" = 4 ]'
check "the JSON answer has the frame too" eval \
    '[ "$($ctl --json spawn jeep --at 100,100 | json frame)" -gt 0 ]'
stands_in_the_middle() { # of the world, the jeep that has just been made
    python3 -c 'import json, sys
place = next(v["position"] for v in map(json.loads, sys.stdin) if v["id"] == int(sys.argv[1]))
print(place)
raise SystemExit(max(abs(place[0] - 25000), abs(place[2] - 25000)) > float(sys.argv[2]))' "$1" "$2"
}
check "a place may be a latitude and a longitude" eval \
    'id=$($ctl --json spawn jeep --at 35.95N,121.25W | json entity) && "$bin/jolon-world" dump --json --world "$name" | stands_in_the_middle "$id" 0.01'
check "a place may be a reference of the MGRS" eval \
    'id=$($ctl --json spawn helicopter --altitude 500 --at 10SFE5783079818 | json entity) && "$bin/jolon-world" dump --json --world "$name" | stands_in_the_middle "$id" 1'

# --- errors -------------------------------------------------------------------------------------------
check "a ship on dry land" denies 1 'value out of range .*a ship needs water' spawn ship --at 24000,24000
check "a place on another continent" denies 1 'is [0-9]+ km from the middle of the world' spawn jeep --at 48.1N,11.5E
check "a latitude without a longitude" denies 2 'not a latitude of 0 to 90 degrees' spawn jeep --at 48.1N,11.5
check "a square that its zone has not" denies 2 'its zone has no square of these letters' spawn jeep --at 10SXX5783079818
check "an unknown name" denies 1 "no vehicle has that name; the nearest is West" drive Wset
check "an unknown verb" denies 2 "did you mean release" relase 1
check "a number out of range" denies 2 "--throttle '2': not a number from -1 to 1" drive 1 --throttle 2
check "an unknown gear" denies 2 'automatic, reverse, neutral, low' drive 1 --gear 5
check "an option of another verb" denies 2 'drive: does not take --target' drive 1 --target 2
check "an unknown id" denies 1 'no such entity .*jolon monitor' drive 4711
check "a step of a running world" denies 1 'pause first' step 1

# --- lines ---------------------------------------------------------------------------------------------
cat >lines <<'L'
# a comment, and an empty line

pause
drive West --lease 5 --steer 1
step 2
driev West
drive West --throttle 9
release West
resume
L
$ctl - <lines >told 2>err
check "lines are carried out in order and by one driver" equal "$? $(awk '{ print $1 }' told | tr '\n' ' ')" \
    "1 paused driving stepping released resumed "
check "each error names its line" eval \
    'grep -q "line 6: .*did you mean drive" err && grep -q "line 7: drive: --throttle" err && [ "$(wc -l <err)" = 2 ]'
[ "$(wc -l <err)" = 2 ] || sed 's/^/# /' err
check "the answers' frames ascend" eval 'sed "s/.*frame \([0-9]*\).*/\1/" told | sort -nc'
check "a line without an end is refused" eval \
    '! { head -c 100000 /dev/zero | tr "\0" x; echo; echo pause; } | $ctl --json - >told 2>err && [ "$(json line <told)" = 2 ]'
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"

# --- a world whose vehicles cruise is dumped as it is in its frame --------------------------------------
cat >cruise.cfg <<'C'
world = { cruise = true; };
terrain = { source = "flat"; };
objects = { source = "none"; };
vehicles = ( { kind = "jeep"; count = 12; behaviour = "patrol"; area = [20000.0, 20000.0, 30000.0, 30000.0]; } );
C
"$jolon" start -w "$name-c" --out out-c --without renderer --without reporter cruise.cfg >told
sleep 5
"$jolon" ctl -w "$name-c" pause >told
"$jolon" world dump --world "$name-c" --json >before
"$jolon" ctl -w "$name-c" step 6 >told
sleep 0.5
"$jolon" world dump --world "$name-c" --json >after
goes_on() {
    python3 -I -S -c '
import json, math, sys
before, after = ([json.loads(line) for line in open(name)] for name in sys.argv[1:])
ways = [(math.dist(a["position"], b["position"]), a["speed_mps"] * 6 / 60) for a, b in zip(before, after) if a["speed_mps"] > 3]
print(ways)
sys.exit(len(ways) < 6 or any(abs(way - wanted) > 0.3 * wanted for way, wanted in ways))' before after
}
check "each vehicle that cruises is dumped further on after six frames" goes_on
"$jolon" stop -w "$name-c" >told
"$bin/jolon-world" remove --world "$name-c"
done_testing
