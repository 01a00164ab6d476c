#!/usr/bin/env bash
# Least privilege of a real set: what the kernel says of its processes, and that a set without its
# sandbox says so.
. "$(dirname "$0")/lib.sh"

# A field of every thread of a process: fields PID NAME prints its distinct values.
fields() { awk -v name="$2:" '$1 == name { print $2 }' /proc/"$1"/task/*/status | sort -u; }
# Descriptors of a process and what they are.
descriptors() { for fd in /proc/"$1"/fd/*; do echo "${fd##*/} $(readlink "$fd")"; done; }
is_up() { [ "$("$jolon" status -w "$name" --json | json state)" = running ]; }

# shellcheck disable=SC2120 # check passes some
start() {
    "$jolon" start -w "$name" --out out --events events --checkpoint checkpoint --every 60 \
        --set renderer.width=320 --set renderer.height=180 "$@"
}
roles=(mover collider recorder reporter renderer)

if [ -n "${JOLON_SANITIZER-}" ]; then
    skip "the sandbox of a real set" "sanitizers do without it"
    done_testing
fi

# Something left open, as a careless parent would.
exec 7</etc/hostname
start >started 2>&1
exec 7<&-
check "the set is up" is_up
for role in "${roles[@]}"; do
    of=$(pid $role)
    check "$role: every thread has its filter" equal "$(fields "$of" Seccomp)" 2
    check "$role: no new privileges" equal "$(fields "$of" NoNewPrivs)" 1
    for set in CapEff CapPrm CapInh CapAmb; do
        check "$role: no capabilities ($set)" equal "$(fields "$of" $set)" 0000000000000000
    done
    check "$role: nothing inherited is open" bash -c "! readlink /proc/$of/fd/* | grep -q hostname"
done
of=$(cat "$(path_of lock)")
check "keeper: it has its filter" equal "$(fields "$of" Seccomp)" 2
check "keeper: no new privileges" equal "$(fields "$of" NoNewPrivs)" 1
check "keeper: no capabilities" equal "$(fields "$of" CapEff)$(fields "$of" CapPrm)" 00000000000000000000000000000000
for role in mover collider; do
    check "$role holds its lock and nothing else" equal "$(descriptors "$(pid $role)" | grep -v '^[012] ')" \
        "3 $(path_of lock)"
done
if [ "$UID" = 0 ]; then
    check "nor could a program that it became get any back" equal "$(fields "$(pid mover)" CapBnd)" 0000000000000000
fi
# The first takes seconds: the driver compiles its shaders.
check "the pictures are their owner's alone" bash -c "
    for i in \$(seq 1200); do [ -e out/map.png ] && break; sleep 0.05; done
    [ \"\$(stat -c %a out/*.png | sort -u)\" = 600 ]"
check "checkpoints are written" eventually [ -e checkpoint ]
check "the set stops" "$jolon" stop -w "$name"
check "and forbade nothing on the way" bash -c "! grep 'the sandbox forbids' out/jolon.log"
check "nor went without" bash -c "! grep -i 'without its sandbox' out/jolon.log"

# Without: each says so, and the kernel confirms it; a container may have a filter of its own.
check "a set without sandbox starts" start --no-sandbox
for role in "${roles[@]}"; do
    check "$role: it has no filter" equal "$(fields "$(pid "$role")" Seccomp_filters)" "$(fields $$ Seccomp_filters)"
done
check "it stops" "$jolon" stop -w "$name"
for role in "${roles[@]}"; do
    check "the $role says loudly that it has none" grep -q " $role warning.* WITHOUT its sandbox" out/jolon.log
done
check "nothing is left" nothing_left "$name"
done_testing
