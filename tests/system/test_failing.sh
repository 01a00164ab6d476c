#!/usr/bin/env bash
# Failing calls: no memory, no descriptor, no room on the disk. Whatever call fails, a program ends
# with one clear line and exit code 1, or continues with the same result. tests/faults/failing.c
# makes the nth call of a class fail. Where there are many calls, a sample of them is tried. SEED=n
# chooses another sample, SAMPLES=n its size, ONLY=dump the programs.
# Computes: it runs each program hundreds of times.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"

[ -z "${JOLON_SANITIZER-}" ] || { skip "failing calls" "a sanitizer has its own malloc"; done_testing; }
failing=$bin/../tests/faults/failing.so
[ -e "$failing" ] || { skip "failing calls" "make test builds what makes them fail"; done_testing; }
SEED=${SEED:-$RANDOM}
echo "# SEED=$SEED"
cat >good.cfg <<'C'
world = { seed = 3; capacity = 64; pace = "max"; };
terrain = { source = "flat"; spacing_m = 125.0; };
collision = { shape = "sphere"; };
objects = ( { kind = "tree"; at = [25120.0, 25120.0]; } );
vehicles = ( { kind = "tank"; count = 3; force = "blue"; fire_at_will = true; area = [25000.0, 25000.0, 25150.0, 25150.0]; },
             { kind = "jeep"; count = 3; force = "red"; fire_at_will = true; area = [25100.0, 25100.0, 25300.0, 25300.0]; } );
fires = ( { at_s = 0.05; munition = "artillery"; point = [25100.0, 25100.0]; } );
C
FAILING=$failing NAME=$name BIN=$bin SEED=$SEED SAMPLES=${SAMPLES:-8} \
    python3 "$here/failing.py" >told 2>&1
sed '/^\(not \)\?ok/!s/^/# /' told
number=$(grep -cE '^(not )?ok' told)
failures=$(grep -c '^not ok' told)
check "programs were tried" [ "$number" -ge 1 ]
check "nothing is left" nothing_left "$name"
done_testing
