#!/usr/bin/env bash
# Hostile input: runs each harness of tests/fuzz on its corpus and on a fixed number of inputs from
# a fixed seed. `make fuzz SECONDS=n` runs longer.
# Computes: it compiles the harnesses.
. "$(dirname "$0")/lib.sh"
find_source_dir

if [ -n "${JOLON_SANITIZER-}" ]; then
    skip "hostile input" "the harnesses are sanitized in any build; the plain one runs them"
    done_testing
fi
"$source_dir/tests/fuzz/run" --runs 200 >told 2>err
status=$?
if [ $status = 3 ]; then
    skip "hostile input" "$(tail -n 1 err)"
    done_testing
fi
check "the harnesses can be built and run" [ -s told ]
for file in "$source_dir"/tests/fuzz/fuzz_*.c; do
    harness=${file##*/fuzz_} harness=${harness%.c}
    if grep -q "^$harness: [0-9]* inputs, " told; then
        ok "$harness: $(sed -n "s/^$harness: //p" told)"
    else
        not_ok "$harness"
        sed -n "/^$harness: /,/^[a-z_]*: /{/^$harness: /p;/^    /p}" told | sed 's/^/# /'
    fi
done
check "the harnesses found no fault" equal $status 0
check "the harnesses leave no shared memory" nothing_left fuzz
[ $status = 0 ] || sed 's/^/# /' err
done_testing
