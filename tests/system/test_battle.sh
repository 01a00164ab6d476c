#!/usr/bin/env bash
# Computes: half an hour of the default battle, as fast as it goes.
# The default battle lasts: it has shots in every three minutes, each side loses aircraft and keeps some, no
# tank's gun fires at a jet, nobody pushes for long, and it ends with a result.
. "$(dirname "$0")/lib.sh"
[ -z "${JOLON_SANITIZER-}" ] || { skip "the battle" "half an hour takes too long with a sanitizer"; done_testing; }

"$bin/jolon-bench" battle >report
status=$?
sed 's/^/# /' report
check "nothing of the battle is out of bounds" [ "$status" = 0 ]
check "the report has shots in ten periods" eval '[ "$(grep "^shots in" report | wc -w)" = 15 ]'
check "howitzers fire barrages" eval 'grep -q "^artillery  *ground  *any  *[1-9][0-9][0-9] " report'
check "objectives change hands, and somebody wins" eval 'grep -q " takes " report && grep -q " s  result: " report'
# Each shot is in one row of the table of hits; two missiles at one ship are the case of a late one.
shots=$(awk '/^shots in/ { for (n = 6; n <= NF; n++) sum += $n } END { print sum }' report)
rows='/^munition/ { table = 1; next } table && /^ / { exit } table'
check "the table of hits has each shot" [ "$(awk "$rows { sum += \$4 } END { print sum }" report)" = "$shots" ]
check "no round is both late and a hit" [ -z "$(awk "$rows && \$5 + \$6 > \$4" report)" ]
check "missiles whose ship was lost before are late" eval 'grep -q "^missile  *ship  *any  *[0-9][0-9]*  *[1-9]" report'
# A short run is not judged.
check "ten seconds are reported and not judged" "$bin/jolon-bench" battle --frames 600
done_testing
