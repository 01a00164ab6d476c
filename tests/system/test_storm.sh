#!/usr/bin/env bash
# A thousand kills and stops of the processes of a real set. Nothing may be torn, lost, repeated or
# leaked, every command must be done once, and the digest must be that of an undisturbed run.
# tests/storm/README.md explains the printed results. KILLS=n and SEED=n choose others.
scenario=$(cd "$(dirname "$0")/../storm" && pwd)/crowd.cfg
. "$(dirname "$0")/lib.sh"
storm=$bin/../tests/storm/storm
kills=${KILLS:-$([ -n "${JOLON_SANITIZER-}" ] && echo 60 || echo 1000)}
seed=${SEED:-$RANDOM}

"$storm" --kills "$kills" --seed "$seed" --world "$name" --scenario "$scenario" --out "$folder/out" \
    >account 2>err
status=$?
sed 's/^/# /' account
check "the storm of $kills strikes with seed $seed ends without a fault" equal $status 0
[ $status = 0 ] || { sed 's/^/# /' err; tail -n 20 "$folder/out/jolon.log" | sed 's/^/# /'; }
check "all strikes were made" grep -q "in all [0-9]* of $kills" account
for what in "torn reads" "lost events" "repeated events" "leaks"; do
    check "$what: none" grep -Eq "^$what +0\\b" account
done
check "the digest is that of the undisturbed run" grep -q "^digest *equal" account
check "nothing is left" nothing_left "$name"
done_testing
