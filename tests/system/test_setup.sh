#!/usr/bin/env bash
# Packages: missing packages are installed by root or through sudo. A user with neither gets one
# line with the command to type. A run needs neither jolon-bench nor the engines that it measures. A
# build uses all processors and numbers its steps.
. "$(dirname "$0")/lib.sh"
top=$(cd "$bin" && until [ -e Makefile ]; do cd ..; done && pwd)

# A machine of replacement programs: nothing is installed, and apt-get writes down its arguments.
mkdir machine
for tool in bash env sed flock mktemp rm cat; do ln -s "$(command -v $tool)" machine/$tool; done
stand_in() { printf '#!/bin/bash\n%s\n' "$2" >"machine/$1" && chmod +x "machine/$1"; }
printf 'first\n# words\nsecond # more words\nsed=third\nno-such-command=fourth\n' >list
install() { PATH=$folder/machine "$top/supervisor/install-packages" "$@" >told 2>err; status=$?; }

install list build/.stamp
check "without apt-get the packages are named" eval \
    '[ $status = 1 ] && [ "$(grep -c "^    \(first\|second\|fourth\)$" err)" = 3 ]'
check "the message says what to type afterwards" grep -q 'mkdir -p build && touch build/.stamp$' err

stand_in dpkg-query 'exit 1'
stand_in apt-get 'echo "$*" >>asked'
stand_in id 'echo 1000'
words='first second fourth'
line="type: su -c 'apt-get update && apt-get install -y --no-install-recommends $words'"
told_to_type() { [ $status = 1 ] && [ "$(wc -l <err)" = 1 ] && grep -qF "$line" err && [ ! -e asked ]; }
install list
check "without sudo one line says what to type" told_to_type
stand_in sudo '[ "$1" = -v ] && exit 1'
install list
check "when sudo refuses, one line says what to type" told_to_type
stand_in sudo '[ "$1" = -v ] || exec "$@"'
install list
check "sudo installs the missing packages" eval '[ $status = 0 ] && grep -q -- "^install .* $words -qq$" asked'
rm asked machine/sudo
stand_in id 'echo 0'
install list
check "root installs the missing packages" eval '[ $status = 0 ] && grep -q -- "^install .* $words -qq$" asked'
stand_in apt-get 'echo this is why; exit 100'
install list
check "the output of apt-get is shown when it fails" eval '[ $status = 1 ] && grep -q "this is why" err'
rm machine/apt-get
stand_in apt-get 'echo "$*" >>asked'
stand_in dpkg-query 'echo installed'
rm -f asked
install list
check "installed packages are not installed again" eval '[ $status = 0 ] && [ ! -e asked ]'

# In an empty build tree make prints everything that it would do.
build() { env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -C "$top" --no-print-directory BUILD="$folder/tree" "$@" 2>&1; }
build -n run >run.plan
build -n bench >bench.plan
check "make run builds the programs" grep -q 'bin/jolon-mover' run.plan
check "make run does not build the benchmarks" eval '! grep -q "jolon-bench\|peer_ode\|peer_bullet" run.plan'
build -n check >check.plan
check "make check does not build the engines" eval '! grep -q "peer_ode\|peer_bullet" check.plan'
check "make bench builds the benchmarks" grep -q 'bin/jolon-bench' bench.plan
check "no engine is in the list of packages" eval '! grep -q "libode\|libbullet" "$top/packages.txt"'

# --- the build -----------------------------------------------------------------------------------
# steps PART...: what a build of them prints of compilations. The name of a temporary folder may hold
# "CC" as well, and make names it in what it says of files that are up to date.
steps() { build "$@" | grep '\] CC '; }
mapfile -t sources < <(cd "$top" && find mover -name '*.c' | sort | head -n 3)
parts=("${sources[@]/#/$folder/tree/obj/}")
parts=("${parts[@]/%.c/.o}")
check "steps are numbered up to their count" equal "$(steps "${parts[@]}" | sed 's/ CC .*//' | sort | xargs)" \
    "[1/3] [2/3] [3/3]"
check "no step is printed when all is done" equal "$(steps "${parts[@]}")" ""
rm "${parts[0]}"
check "existing objects are no steps" equal "$(steps "${parts[@]}")" "[1/1] CC ${sources[0]}"
check "other flags make every object a step" equal "$(steps OPT='-O0 -g1' "${parts[@]}" | grep -c '/3\]')" 3
rm "${parts[@]}"
check "make -s prints nothing" equal "$(build -s "${parts[@]}")" ""
check "no compiler is asked before it is installed" equal "$(build CC=no-such-compiler help | grep 'not found')" ""
# jobs GOAL...: prints the number of jobs that make uses
jobs() { build -np "$@" | grep -a '^MAKEFLAGS = ' | grep -oE -- ' -j[0-9]+' | tail -n 1; }
check "a build uses all processors" equal "$(jobs all)" " -j$(nproc)"
check "-j sets the number of jobs" equal "$(jobs -j7 all)" " -j7"
check "several goals that do more than build run in their order" equal "$(jobs clean all)" ""
done_testing
