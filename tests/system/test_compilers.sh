#!/usr/bin/env bash
# Every compiler gives the same run to the bit: gcc without optimisation, and gcc and clang with
# everything that this processor supports, compared with the tested build on one, two and four
# threads. Everything that moves, collides and makes worlds is built for each of them below build/.
# Computes: it compiles the steps three times.
. "$(dirname "$0")/lib.sh"
find_source_dir
export JOLON_DATA=$source_dir/config
export JOLON_HANG_MS=20000 # without optimisation, on a busy machine

if [ -n "${JOLON_SANITIZER-}" ]; then
    skip "every compiler gives the same digest" "the sanitized build is not one of them"
    done_testing
fi

busy=$source_dir/tests/system/busy.cfg # everything that can happen, close together

# run AS BIN [options]: AS.json is the summary. scenario, frames: another scenario than the busy one.
run() {
    local as=$1 with=$2
    shift 2
"$with/jolon" run -w "$name" --without renderer --without reporter --pace max --frames "${frames:-420}" --json \
        --out "$folder/$as" "$@" "${scenario:-$busy}" >"$as.json" 2>"$as.err" || sed 's/^/# /' "$as.err"
}

# Prints the digests in AS.json: of the world and of its events.
digests() { json digest <"$1.json" 2>/dev/null && json event_digest <"$1.json"; }

run first "$bin"
first=$(digests first)
check "the run has many collisions" [ "$(json collisions <first.json)" -gt 50 ]
check "the run has many detonations" [ "$(json detonations <first.json)" -gt 25 ]
run figure8 "$bin" --set collision.response=figure8
scenario=hunter-liggett frames=7200 run battle "$bin" # agents fight in its second minute
check "the battle has detonations of what agents fire" [ "$(json detonations <battle.json)" -gt 100 ]
for threads in 2 4; do
    run threads "$bin" --threads $threads
    check "$threads threads give the same digests" equal "$(digests threads)" "$first"
done

have() { command -v "$1" >/dev/null; }

# fused_seen COMPILER: tests/fused reports an instruction that rounds once instead of twice.
fused_seen() {
    local machine=''
    [ "$(uname -m)" = x86_64 ] && machine=-mfma
    mkdir -p fused/{world,mover,collider,config}
    echo 'double f(double a, double b, double c) { return a * b + c; }' >fused.c
    for part in world mover collider config; do
        "$1" -O2 $machine -ffp-contract=fast -c -o fused/$part/f.o fused.c || return 1
    done
    ! "$source_dir/tests/fused" fused
}
check "a fused instruction is found" fused_seen gcc
check "the build has no fused instruction" "$source_dir/tests/fused" "$bin/../obj"

echo clang-14 >list
have clang-14 || "$source_dir/supervisor/install-packages" list >install.log 2>&1 || sed 's/^/# /' install.log
# build TREE COMPILER OPT PROGRAM...: builds into TREE, below the sources.
build() {
    local tree=$1 compiler=$2 level=$3 programs=()
    shift 3
    for program; do programs+=("$tree/bin/$program"); done
    env -u MAKEFLAGS -u MFLAGS make -s -C "$source_dir" -j"$(nproc)" BUILD="$tree" CC="$compiler" OPT="$level" \
        "${programs[@]}" >make.log 2>&1 || { tail -n 15 make.log && return 1; }
}

for compiler in gcc clang-14; do
    if ! have $compiler; then
        skip "$compiler gives the same digests" "there is no $compiler, and it cannot be installed"
        continue
    fi
    # Builds the steps in one process: making the world, moving, colliding.
    levels=("-O3 -march=native")
    [ $compiler != gcc ] || levels+=(-O0)
    for level in "${levels[@]}"; do
        what="$compiler $level"
        tree=build/compilers/$compiler${level//[ =]/-}
        check "$what builds" build "$tree" $compiler "$level" jolon-world
        for log in first figure8 battle; do
            check "$what, $log: the digests are the same" "$source_dir/$tree/bin/jolon-world" replay --threads 2 "$folder/$log/commands.log"
        done
        check "$what: there is no fused instruction" "$source_dir/tests/fused" "$source_dir/$tree/obj"
    done
done
check "the runs leave no shared memory" nothing_left "$name"
done_testing
