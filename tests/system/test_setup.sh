#!/usr/bin/env bash
# Packages: what is missing is installed by root, or by sudo; a user with neither gets one line with
# the command to type. A run needs neither jolon-bench nor the engines that it measures. A build uses
# all processors and numbers its steps.
. "$(dirname "$0")/lib.sh"
top=$(cd "$bin" && until [ -e Makefile ]; do cd ..; done && pwd)

# A machine of stand-ins: nothing is installed, and apt-get writes down what it is asked for.
mkdir machine
for tool in bash env sed flock mktemp rm cat; do ln -s "$(command -v $tool)" machine/$tool; done
stand_in() { printf '#!/bin/bash\n%s\n' "$2" >"machine/$1" && chmod +x "machine/$1"; }
printf 'first\n# words\nsecond # more words\nsed=third\nno-such-command=fourth\n' >list
install() { PATH=$folder/machine "$top/supervisor/install-packages" "$@" >told 2>err; status=$?; }

install list build/.stamp
check "without apt-get the packages are named" eval \
    '[ $status = 1 ] && [ "$(grep -c "^    \(first\|second\|fourth\)$" err)" = 3 ]'
check "and what to type afterwards" grep -q 'mkdir -p build && touch build/.stamp$' err

stand_in dpkg-query 'exit 1'
stand_in apt-get 'echo "$*" >>asked'
stand_in id 'echo 1000'
words='first second fourth'
line="type: su -c 'apt-get update && apt-get install -y --no-install-recommends $words'"
told_to_type() { [ $status = 1 ] && [ "$(wc -l <err)" = 1 ] && grep -qF "$line" err && [ ! -e asked ]; }
install list
check "without sudo it says what to type, on one line" told_to_type
stand_in sudo '[ "$1" = -v ] && exit 1'
install list
check "so does it where sudo refuses" told_to_type
stand_in sudo '[ "$1" = -v ] || exec "$@"'
install list
check "sudo installs what is missing" eval '[ $status = 0 ] && grep -q -- "^install .* $words -qq$" asked'
rm asked machine/sudo
stand_in id 'echo 0'
install list
check "and so does root" eval '[ $status = 0 ] && grep -q -- "^install .* $words -qq$" asked'
stand_in apt-get 'echo this is why; exit 100'
install list
check "what apt-get says is shown when it fails" eval '[ $status = 1 ] && grep -q "this is why" err'
rm machine/apt-get
stand_in apt-get 'echo "$*" >>asked'
stand_in dpkg-query 'echo installed'
rm -f asked
install list
check "what is there is not installed again" eval '[ $status = 0 ] && [ ! -e asked ]'

# In a build tree where nothing has been made, make says all that it would do.
build() { env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -C "$top" --no-print-directory BUILD="$folder/tree" "$@" 2>&1; }
build -n run >run.plan
build -n bench >bench.plan
check "make run builds the programs" grep -q 'bin/jolon-mover' run.plan
check "but not the benchmarks" eval '! grep -q "jolon-bench\|peer_ode\|peer_bullet" run.plan'
build -n check >check.plan
check "nor does make check build the engines" eval '! grep -q "peer_ode\|peer_bullet" check.plan'
check "make bench builds them" grep -q 'bin/jolon-bench' bench.plan
check "no engine is in the list of packages" eval '! grep -q "libode\|libbullet" "$top/packages.txt"'

# --- the build -----------------------------------------------------------------------------------
mapfile -t sources < <(cd "$top" && find mover -name '*.c' | sort | head -n 3)
parts=("${sources[@]/#/$folder/tree/obj/}")
parts=("${parts[@]/%.c/.o}")
check "steps are numbered up to their number" equal "$(build "${parts[@]}" | sed 's/ CC .*//' | sort | xargs)" \
    "[1/3] [2/3] [3/3]"
check "no step is printed when all is done" equal "$(build "${parts[@]}" | grep -c CC)" 0
rm "${parts[0]}"
check "what is there is no step" equal "$(build "${parts[@]}" | grep CC)" "[1/1] CC ${sources[0]}"
check "other flags are steps for all" equal "$(build OPT='-O0 -g1' "${parts[@]}" | grep -c '/3\] CC ')" 3
rm "${parts[@]}"
check "make -s says nothing" equal "$(build -s "${parts[@]}")" ""
check "no compiler is asked before it is installed" equal "$(build CC=no-such-compiler help | grep 'not found')" ""
# jobs GOAL...: what make counts as its own number of jobs
jobs() { build -np "$@" | grep -a '^MAKEFLAGS = ' | grep -oE -- ' -j[0-9]+' | tail -n 1; }
check "all processors build" equal "$(jobs all)" " -j$(nproc)"
check "but -j says how many" equal "$(jobs -j7 all)" " -j7"
check "several goals that do more than build run in their order" equal "$(jobs clean all)" ""
done_testing
