#!/usr/bin/env bash
# make install puts everything into place, it runs from there, and make uninstall takes it away.
. "$(dirname "$0")/lib.sh"
root=$(dirname "$(dirname "$bin")")
[ -z "${JOLON_SANITIZER-}" ] || { skip "install" "the sanitized tree is not installed"; done_testing; }

check "install" make -s -C "$root" install DESTDIR="$folder/root" PREFIX=/opt/jolon
check "the installed programs find their data" \
    "$folder/root/opt/jolon/bin/jolon" run -w "$name" --frames 3 --pace max --without renderer --out out duel
check "the unit names the installed program" grep -q '^ExecStart=/opt/jolon/bin/jolon ' \
    root/opt/jolon/lib/systemd/system/jolon@.service
check "uninstall" make -s -C "$root" uninstall DESTDIR="$folder/root" PREFIX=/opt/jolon
check "leaves no file" [ -z "$(find root -type f)" ]
done_testing
