#!/usr/bin/env bash
# A storm of a thousand kills and stops on a real set: nothing torn, lost, repeated or leaked, every
# command done once, and the digest of an undisturbed run. tests/storm/README.md has the account's
# meaning; KILLS=n and SEED=n choose others.
scenario=$(cd "$(dirname "$0")/../storm" && pwd)/crowd.cfg
. "$(dirname "$0")/lib.sh"
storm=$bin/../tests/storm/storm
kills=${KILLS:-$([ -n "${JOLON_SANITIZER-}" ] && echo 60 || echo 1000)}
seed=${SEED:-$RANDOM}

"$storm" --kills "$kills" --seed "$seed" --world "$name" --scenario "$scenario" --out "$folder/out" \
    >account 2>err
status=$?
sed 's/^/# /' account
check "a storm of $kills strikes, seed $seed" equal $status 0
[ $status = 0 ] || { sed 's/^/# /' err; tail -n 20 "$folder/out/jolon.log" | sed 's/^/# /'; }
check "it struck as often" grep -q "in all [0-9]* of $kills" account
for what in "torn reads" "lost events" "repeated events" "leaks"; do
    check "$what: none" grep -Eq "^$what +0\\b" account
done
check "the digest is equal" grep -q "^digest *equal" account
check "nothing is left" nothing_left "$name"
done_testing
