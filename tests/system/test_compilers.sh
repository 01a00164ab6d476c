#!/usr/bin/env bash
# The same run to the bit whoever compiled it: gcc without optimisation, gcc and clang with all that
# this processor can do, beside the build that is tested; on one thread, two and four. What moves,
# collides and makes worlds is built anew for each, below build/.
# Long: it compiles the steps three times.
. "$(dirname "$0")/lib.sh"
find_source_dir
export JOLON_DATA=$source_dir/config
export JOLON_HANG_MS=20000 # without optimisation, on a busy machine

if [ -n "${JOLON_SANITIZER-}" ]; then
    skip "every compiler gives the same digest" "the sanitized build is not one of them"
    done_testing
fi

busy=$source_dir/tests/system/busy.cfg # everything that can happen, close together

# run AS BIN [options]: AS.json is the summary.
run() {
    local as=$1 with=$2
    shift 2
    "$with/jolon" run -w "$name" --without renderer --without reporter --pace max --frames 300 --json \
        --out "$folder/$as" "$@" "$busy" >"$as.json" 2>"$as.err" || sed 's/^/# /' "$as.err"
}

# The digests of what is in AS.json: of the world, and of everything that happened.
digests() { json digest <"$1.json" 2>/dev/null && json event_digest <"$1.json"; }

run first "$bin"
first=$(digests first)
check "the run is a busy one" [ "$(json collisions <first.json)" -gt 50 ]
check "with shots" [ "$(json detonations <first.json)" -gt 50 ]
run figure8 "$bin" --set collision.response=figure8
for threads in 2 4; do
    run threads "$bin" --threads $threads
    check "$threads threads: the same" equal "$(digests threads)" "$first"
done

have() { command -v "$1" >/dev/null; }

# fused_seen COMPILER: tests/fused names an instruction that rounds once in place of twice.
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
check "an instruction that rounds once is seen" fused_seen gcc
check "the build has none" "$source_dir/tests/fused" "$bin/../obj"

echo clang-14 >list
have clang-14 || "$source_dir/supervisor/install-packages" list >install.log 2>&1 || sed 's/^/# /' install.log
# build TREE COMPILER OPT PROGRAM...: into TREE, below the sources.
build() {
    local tree=$1 compiler=$2 level=$3 programs=()
    shift 3
    for program; do programs+=("$tree/bin/$program"); done
    env -u MAKEFLAGS -u MFLAGS make -s -C "$source_dir" -j"$(nproc)" BUILD="$tree" CC="$compiler" OPT="$level" \
        "${programs[@]}" >make.log 2>&1 || { tail -n 15 make.log && return 1; }
}

for compiler in gcc clang-14; do
    if ! have $compiler; then
        skip "$compiler: the same" "there is no $compiler, and it cannot be installed"
        continue
    fi
    # A build for each, of the steps in one process: making the world, moving, colliding.
    levels=("-O3 -march=native")
    [ $compiler != gcc ] || levels+=(-O0)
    for level in "${levels[@]}"; do
        what="$compiler $level"
        tree=build/compilers/$compiler${level//[ =]/-}
        check "$what builds" build "$tree" $compiler "$level" jolon-world
        for log in first figure8; do
            check "$what, $log: the same" "$source_dir/$tree/bin/jolon-world" replay --threads 2 "$folder/$log/commands.log"
        done
        check "$what: nothing rounds once" "$source_dir/tests/fused" "$source_dir/$tree/obj"
    done
done
check "it leaves no shared memory" nothing_left "$name"
done_testing
