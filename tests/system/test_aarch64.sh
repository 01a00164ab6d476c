#!/usr/bin/env bash
# aarch64 gives the same run to the bit: programs compiled for aarch64 replay runs of this machine.
# An emulator of user programs executes them. It also emulates kernels with pages of 16 and 64 KiB,
# where mover and collider run a world that this machine has made.
# Computes: it compiles the steps for another machine and emulates it.
. "$(dirname "$0")/lib.sh"
find_source_dir
export JOLON_DATA=$source_dir/config
export JOLON_HANG_MS=20000
tree=build/aarch64
libraries=$source_dir/$tree/libraries
arm=$source_dir/$tree/bin
lib=$libraries/root/usr/lib/aarch64-linux-gnu
second=$libraries/root/lib/aarch64-linux-gnu

leave_out() {
    skip "aarch64 gives the same digests" "$1"
    done_testing
}
[ -z "${JOLON_SANITIZER-}" ] || leave_out "the sanitized build is not for it"
for program in aarch64-linux-gnu-g++ aarch64-linux-gnu-objdump qemu-aarch64 apt-get; do
    command -v $program >/dev/null || leave_out "there is no $program"
done
"$source_dir/tests/aarch64-libraries" "$libraries" >fetch.log 2>&1 ||
    leave_out "its libraries cannot be fetched: $(tail -n 1 fetch.log)"

build() {
    env -u MAKEFLAGS -u MFLAGS PKG_CONFIG_LIBDIR="$lib/pkgconfig" PKG_CONFIG_SYSROOT_DIR="$libraries/root" \
        make -s -C "$source_dir" -j"$(nproc)" BUILD=$tree \
        CC="aarch64-linux-gnu-gcc -isystem $libraries/root/usr/include -L$lib -Wl,-rpath-link,$lib:$second" \
        $tree/bin/jolon-{world,mover,collider}
}
check "the programs build for aarch64" build
fused_there() { OBJDUMP=aarch64-linux-gnu-objdump "$source_dir/tests/fused" "$source_dir/$tree/obj"; }
check "the aarch64 build has no fused instruction" fused_there

# emulate [-p PAGE_BYTES] PROGRAM ...
emulate() { timeout 900 qemu-aarch64 -L /usr/aarch64-linux-gnu -E "LD_LIBRARY_PATH=$lib:$second" "$@"; }

# --- runs of this machine, replayed on aarch64 ----------------------------------------------------

# run AS FRAMES [options] SCENARIO: writes AS/commands.log
run() {
    local as=$1 frames=$2
    shift 2
    "$jolon" run -w "$name" --without renderer --without reporter --pace max --frames "$frames" --json --out "$as" \
        "$@" >"$as.json" 2>"$as.err" || sed 's/^/# /' "$as.err"
}
busy=$source_dir/tests/system/busy.cfg
run busy 300 --checkpoint half.image "$busy"
run figure8 300 --set collision.response=figure8 --set objects.source=none --set terrain.source=flat "$busy"
run image 450 --from half.image
run war 90 hunter-liggett
run script 600 rehearsal
run thesis 200 --set collision.method=npsnet2 --set collision.response=spring --set collision.shape=sphere tanks-glancing
check "the runs have many collisions and detonations" [ "$(($(json collisions <busy.json) + $(json detonations <busy.json)))" -gt 100 ]
logs=(busy figure8 image war script thesis)

replay() { emulate "$arm/jolon-world" replay "$folder/$1/commands.log" >"$1.told" 2>&1; echo $? >"$1.status"; }
for log in "${logs[@]}"; do
    while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n; done
    replay "$log" &
done
wait
equal_there() { cat "$1.told"; [ "$(cat "$1.status")" = 0 ] && grep -q 'equal to the run that was recorded' "$1.told"; }
for log in "${logs[@]}"; do check "run $log: the digests are the same on aarch64" equal_there "$log"; done

# --- larger pages ---------------------------------------------------------------------------------

# on_pages BYTES: prints the digest of a world that roles with pages of this size have run.
on_pages() {
    local role
    "$bin/jolon-world" create --world "$name" --set world.frames=60 --set world.pace=max duel >/dev/null || return 1
    for role in mover collider; do
        emulate -p "$1" "$arm/jolon-$role" --no-sandbox --world "$name" 2>"$role.log" &
    done
    wait
    "$bin/jolon-world" digest --json --world "$name" | json digest
    "$bin/jolon-world" remove --force --world "$name"
}
run pages 60 duel
for bytes in 4096 16384 65536; do
    check "pages of $bytes bytes: a world of this machine runs with the same digest" equal "$(on_pages $bytes)" "$(json digest <pages.json)"
done
check "the runs leave no shared memory" nothing_left "$name"
done_testing
