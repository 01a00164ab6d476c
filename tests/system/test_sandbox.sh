#!/usr/bin/env bash
# Least privilege of a real set: the test reads what the kernel reports of its processes. A set
# without its sandbox must report that.
. "$(dirname "$0")/lib.sh"

# fields PID NAME: prints the distinct values of a field over all threads of a process.
fields() { awk -v name="$2:" '$1 == name { print $2 }' /proc/"$1"/task/*/status | sort -u; }
# Prints the descriptors of a process and what they refer to.
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

# A descriptor left open, as by a careless parent.
exec 7</etc/hostname
start >started 2>&1
exec 7<&-
check "the set is ready" is_up
for role in "${roles[@]}"; do
    of=$(pid $role)
    check "$role: every thread has its filter" equal "$(fields "$of" Seccomp)" 2
    check "$role: it can gain no privileges" equal "$(fields "$of" NoNewPrivs)" 1
    for set in CapEff CapPrm CapInh CapAmb; do
        check "$role: it has no capabilities ($set)" equal "$(fields "$of" $set)" 0000000000000000
    done
    check "$role: no inherited descriptor is open" bash -c "! readlink /proc/$of/fd/* | grep -q hostname"
done
of=$(cat "$(path_of lock)")
check "keeper: it has its filter" equal "$(fields "$of" Seccomp)" 2
check "keeper: it can gain no privileges" equal "$(fields "$of" NoNewPrivs)" 1
check "keeper: it has no capabilities" equal "$(fields "$of" CapEff)$(fields "$of" CapPrm)" 00000000000000000000000000000000
for role in mover collider; do
    check "$role holds its lock and nothing else" equal "$(descriptors "$(pid $role)" | grep -v '^[012] ')" \
        "3 $(path_of lock)"
done
if [ "$UID" = 0 ]; then
    check "the mover's bounding set of capabilities is empty" equal "$(fields "$(pid mover)" CapBnd)" 0000000000000000
fi
# The first takes seconds: the driver compiles its shaders.
check "only the owner can read the pictures" bash -c "
    for i in \$(seq 1200); do [ -e out/map.png ] && break; sleep 0.05; done
    [ \"\$(stat -c %a out/*.png | sort -u)\" = 600 ]"
check "checkpoints are written" eventually [ -e checkpoint ]
check "the set stops" "$jolon" stop -w "$name"
check "the sandbox forbade nothing" bash -c "! grep 'the sandbox forbids' out/jolon.log"
check "no role ran without its sandbox" bash -c "! grep -i 'without its sandbox' out/jolon.log"

# Without the sandbox each role says so and the kernel confirms it. A container may have a filter of
# its own.
check "a set without sandbox starts" start --no-sandbox
for role in "${roles[@]}"; do
    check "$role: it has no filter" equal "$(fields "$(pid "$role")" Seccomp_filters)" "$(fields $$ Seccomp_filters)"
done
check "the set stops" "$jolon" stop -w "$name"
for role in "${roles[@]}"; do
    check "the $role warns that it has no sandbox" grep -q " $role warning.* WITHOUT its sandbox" out/jolon.log
done
check "nothing is left" nothing_left "$name"
done_testing
