#!/usr/bin/env bash
# The same run to the bit whoever compiled it: gcc and clang, with and without optimisation, on one
# thread, two and four. What moves, collides and makes worlds is built anew for each, below build/.
. "$(dirname "$0")/lib.sh"
source_dir=$(cd "$(dirname "$bin")/.." && pwd)
until [ -e "$source_dir/Makefile" ] || [ "$source_dir" = / ]; do source_dir=$(dirname "$source_dir"); done
export JOLON_DATA=$source_dir/config
export JOLON_HANG_MS=20000 # without optimisation, on a busy machine

if [ -n "${JOLON_SANITIZER-}" ]; then
    skip "every compiler gives the same digest" "the sanitized build is not one of them"
    done_testing
fi

# Whatever can happen, close together: shots, blasts, craters, rams, falling trees, wrecks that spin.
cat >busy.cfg <<'C'
world = { seed = 11; capacity = 2048; };
terrain = { source = "generated"; spacing_m = 125.0; };
objects = { source = "table1"; };
vehicles = (
    { kind = "tank"; count = 60; force = "blue"; fire_at_will = true; area = [28200.0, 19800.0, 28500.0, 20200.0]; },
    { kind = "tank"; count = 60; force = "red"; fire_at_will = true; area = [28300.0, 19800.0, 28600.0, 20200.0]; },
    { kind = "jeep"; count = 90; behaviour = "hold"; speed_mps = 12.0; area = [28300.0, 19800.0, 28550.0, 20100.0]; },
    { kind = "truck"; count = 60; force = "red"; area = [28250.0, 19850.0, 28550.0, 20150.0]; },
    { kind = "attack-tomato"; count = 30; force = "red"; fire_at_will = true; area = [28200.0, 19800.0, 28600.0, 20200.0]; },
    { kind = "helicopter"; count = 20; force = "blue"; fire_at_will = true; area = [28200.0, 19800.0, 28500.0, 20200.0]; },
    { kind = "wishbone"; count = 20; force = "red"; fire_at_will = true; area = [28200.0, 19800.0, 28500.0, 20200.0]; },
    { kind = "jet"; force = "blue"; behaviour = "hold"; at = [28000.0, 20000.0]; altitude_m = 90.0; heading_deg = 90.0; speed_mps = 200.0; },
    { kind = "jet"; force = "red"; behaviour = "hold"; at = [28600.0, 20003.0]; altitude_m = 90.0; heading_deg = 270.0; speed_mps = 180.0; },
    { kind = "tank"; behaviour = "hold"; at = [28200.0, 20000.0]; heading_deg = 35.0; speed_mps = 14.0; },
    { kind = "truck"; behaviour = "hold"; at = [28230.0, 19985.0]; heading_deg = 300.0; speed_mps = 20.0; }
);
fires = (
    { at_s = 0.2; munition = "artillery"; point = [28400.0, 20000.0]; },
    { at_s = 0.5; munition = "artillery"; point = [28405.0, 20005.0]; },
    { at_s = 1.0; munition = "bomb"; point = [28500.0, 20100.0]; }
);
C

# run AS BIN [options]: AS.json is the summary.
run() {
    local as=$1 with=$2
    shift 2
    "$with/jolon" run -w "$name" --without renderer --without reporter --pace max --frames 300 --json \
        --out "$folder/out" "$@" busy.cfg >"$as.json" 2>"$as.err" || sed 's/^/# /' "$as.err"
}

# The digests of what is in AS.json: of the world, and of everything that happened.
digests() { json digest <"$1.json" 2>/dev/null && json event_digest <"$1.json"; }

run first "$bin"
first=$(digests first)
check "the run is a busy one" [ "$(json collisions <first.json)" -gt 50 ]
check "with shots" [ "$(json detonations <first.json)" -gt 50 ]
run figure8 "$bin" --set collision.response=figure8
figure8=$(digests figure8)
for threads in 2 4; do
    run threads "$bin" --threads $threads
    check "$threads threads: the same" equal "$(digests threads)" "$first"
done

have() { command -v "$1" >/dev/null; }
echo clang-14 >list
have clang-14 || "$source_dir/supervisor/install-packages" list >install.log 2>&1 || sed 's/^/# /' install.log
for compiler in gcc clang-14; do
    for level in -O0 -O2; do
        what="$compiler $level"
        if ! have $compiler; then
            skip "$what: the same" "there is no $compiler, and it cannot be installed"
            continue
        fi
        tree=build/compilers/$compiler$level
        programs=()
        for program in jolon-world jolon-mover jolon-collider jolon-recorder jolon-keeper jolon; do programs+=("$tree/bin/$program"); done
        if ! env -u MAKEFLAGS -u MFLAGS make -s -C "$source_dir" -j"$(nproc)" BUILD=$tree CC=$compiler \
            OPT=$level "${programs[@]}" >make.log 2>&1; then
            not_ok "$what builds"
            tail -n 15 make.log | sed 's/^/# /'
            continue
        fi
        run variant "$source_dir/$tree/bin" --threads 2
        check "$what: the same" equal "$(digests variant)" "$first"
        run variant "$source_dir/$tree/bin" --set collision.response=figure8
        check "$what, figure 8: the same" equal "$(digests variant)" "$figure8"
    done
done
check "it leaves no shared memory" nothing_left "$name"
done_testing
