#!/usr/bin/env bash
# The heaviest scenarios for the collider, with the sandbox on: each run ends as the same run
# without a sandbox.
. "$(dirname "$0")/lib.sh"

# run_both NAME FRAMES: runs the scenario of NAME.cfg with the sandbox and without.
run_both() {
    local way options
    for way in on off; do
        options=(--without renderer --without reporter --out "out-$way" --frames "$2" --json)
        [ $way = on ] || options+=(--no-sandbox)
        "$jolon" run -w "$name" "${options[@]}" "$1.cfg" >"$way.json" 2>"$way.err"
        check "$1: the run ends with 0, sandbox $way" equal $? 0
    done
    check "$1: the digest is the same" equal "$(json digest <on.json)" "$(json digest <off.json)"
    check "$1: the events are the same" equal "$(json event_digest <on.json)" "$(json event_digest <off.json)"
    check "$1: no role was restarted" equal "$(json restarts <on.json)" 0
    check "$1: the sandbox forbade nothing" bash -c "! grep -h 'sandbox forbids' on.err out-on/jolon.log"
}

world() {
    echo 'world = { name = "heavy"; seed = 7; capacity = 512; pace = "max"; };'
    echo 'terrain = { source = "flat"; height_m = 100.0; };'
}

# grid KIND STEP SIDE: prints objects on a square, STEP metres apart.
grid() {
    awk -v kind="$1" -v step="$2" -v side="$3" 'BEGIN {
        print "objects = ("
        for (i = 0; i < side * side; i++)
            printf "%s{ kind = \"%s\"; at = [%.1f, %.1f]; }\n", i ? "," : "", kind,
                   25000 + step * (i % side), 25000 + step * int(i / side)
        print ");" }'
}

{ world; grid tree 5 31; echo 'fires = ( { at_s = 0.2; munition = "bomb"; point = [25075.0, 25075.0]; } );'; } >forest.cfg
run_both forest 90
check "forest: the bomb went off" equal "$(json detonations <on.json)" 1

{ world; grid bush 2.5 41; cat <<'TEXT'; } >bushes.cfg
vehicles = ( { kind = "tank"; at = [25050.0, 25110.0]; heading_deg = 0.0; speed_mps = 15.0; behaviour = "hold"; } );
fires = ( { at_s = 0.2; munition = "bomb"; point = [25050.0, 25050.0]; } );
TEXT
run_both bushes 90
check "bushes: the bomb went off" equal "$(json detonations <on.json)" 1

# Every tank turns and drives off, and all overlap.
{ world; awk 'BEGIN {
    print "vehicles = ("
    for (i = 0; i < 100; i++)
        printf "%s{ kind = \"tank\"; at = [25000.0, 25000.0]; heading_deg = %.1f; speed_mps = 10.0; behaviour = \"hold\"; }\n",
               i ? "," : "", i * 3.6
    print ");" }'; } >spot.cfg
run_both spot 30
check "spot: the tanks collide" test "$(json collisions <on.json)" -gt 1000

# Overlapping tanks are all pushed apart at once, in a frame that takes many times as long as those
# before. The watchdog must not kill the collider that computes it.
{ world; awk 'BEGIN {
    print "vehicles = ( { kind = \"jeep\"; at = [24990.0, 25000.0]; heading_deg = 90.0; speed_mps = 20.0; behaviour = \"hold\"; }"
    for (i = 0; i < 480; i++) printf ", { kind = \"tank\"; at = [25000.0, 25000.0]; heading_deg = %.1f; }\n", i * 0.75
    print ");" }'; } >pushed.cfg
"$jolon" run -w "$name" --without renderer --without reporter --out long --frames 20 --json pushed.cfg >long.json 2>long.err
check "a long frame does not end the run" equal $? 0
check "a long frame restarts no role" equal "$(json restarts <long.json)" 0
check "the frame takes longer than the hang limit" test "$(json collider_ms.max <long.json | cut -d. -f1)" -gt 300
# 4,000 jeeps stand side by side and move 28 m a frame. Each box overlaps a hundred others, so the
# frame has more pairs than the arrays hold at first (collider/motion/pair_filter.h). The arrays
# grow within the step, under the sandbox.
{ echo 'world = { name = "abreast"; seed = 7; capacity = 4096; pace = "max"; hz = 1.0; };'
    echo 'terrain = { source = "flat"; height_m = 100.0; };'
    echo 'collision = { shape = "sphere"; };'
    awk 'BEGIN {
    print "vehicles = ("
    for (i = 0; i < 4000; i++)
        printf "%s{ kind = \"jeep\"; at = [%.1f, %.1f]; heading_deg = 45.0; speed_mps = 28.0; behaviour = \"hold\"; }\n",
               i ? "," : "", 25000 + 3.5 * (i % 64), 25000 + 3.5 * int(i / 64)
    print ");" }'; } >abreast.cfg
run_both abreast 3
check "abreast: the arrays grew" grep -q 'had to grow' out-on/jolon.log

# A limit of address space does not prevent the default world.
(ulimit -v 8000000 && "$jolon" run -w "$name" --out limited --frames 60 --json >limited.json 2>limited.err)
check "8 GB of address space for each process suffice for the default world" equal $? 0
check "the limited run reaches its end" equal "$(json frame <limited.json)" 60
check "the limited run restarts no role" equal "$(json restarts <limited.json)" 0
check "nothing is left" nothing_left "$name"
done_testing
