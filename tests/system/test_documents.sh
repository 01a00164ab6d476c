#!/usr/bin/env bash
# The commands in README.md and docs/hello.md work as written: every line of their shell blocks is
# typed into a terminal, in a copy of the sources in which everything is built. Only the time is
# shortened: make run simulates ten seconds instead of a minute.
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../.." && pwd)
. "$(dirname "$0")/lib.sh"
[ -z "${JOLON_SANITIZER-}" ] || { skip "documents" "readers build without sanitizers"; done_testing; }

# Files keep their times, so that make does not build them again.
mkdir -p copy/build
tar -C "$top" --exclude=./build --exclude=./.git --exclude=./out --exclude='./jolon-out*' -cf - . | tar -C copy -xf -
cp -a "$(dirname "$bin")"/{bin,lib,obj,idl,flags} "$top/build/.packages" copy/build
stop_all() { (cd "$folder/copy" && build/bin/jolon stop; build/bin/jolon clean --all) >"$folder/stopped" 2>&1; }
trap 'stop_all; at_end' EXIT

# Every program of the machine receives DDS, also worlds of other tests, so a network namespace is
# used where possible.
alone=()
! unshare -n true 2>/dev/null || alone=(unshare -n bash -c 'ip link set lo up && exec "$@"' alone)
read_to_the_end() { # DOCUMENT
    local line
    (cd copy && "${alone[@]}" env -u MFLAGS -u MAKELEVEL -u JOLON_BIN MAKEFLAGS='SECONDS=10 --no-print-directory' \
        python3 "$here/typist.py" "$1" "$folder/transcript") >typed
    while read -r line; do
        case $line in
        "ok "*) ok "$1: ${line#ok }" ;;
        "not ok "*) not_ok "$1: ${line#not ok }" ;;
        *) echo "$line" ;;
        esac
    done <typed
    stop_all
}
number_of_blocks() { grep -c '^```sh$' "$top/$1"; }
for document in README.md docs/hello.md; do
    check "$document has shell blocks" [ "$(number_of_blocks $document)" -ge 2 ]
    read_to_the_end $document
done
mapfile -t digests < <(grep -ao '^ *digest [0-9a-f]*' transcript)
check "the same scenario gives the same digest" equal "${digests[1]-}" "${digests[2]-none}"
check "another seed gives another digest" [ "${digests[2]-}" != "${digests[3]-}" ]
done_testing
