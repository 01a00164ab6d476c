#!/usr/bin/env bash
# make install installs everything: stripped programs that run from there, data, documents with
# valid links, and examples that compile with the installed files. make uninstall removes all of it.
. "$(dirname "$0")/lib.sh"
root=$(dirname "$(dirname "$bin")")
[ -z "${JOLON_SANITIZER-}" ] || { skip "make install succeeds" "the sanitized tree is not installed"; done_testing; }
to=$folder/root/opt/jolon share=$folder/root/opt/jolon/share

mkdir -p "$share/jolon/kinds" && touch "$share/jolon/kinds/of-an-older-version.cfg"
umask 077
check "make install succeeds" make -s -C "$root" install DESTDIR="$folder/root" PREFIX=/opt/jolon
umask 022
for program in "$bin"/*; do
    check "${program##*/} is installed" [ -x "$to/bin/${program##*/}" ]
done
debug_info() { for program in "$to"/bin/jolon-*; do readelf -S "$program" | grep '\.debug_info\|\.symtab'; done; }
check "the programs are stripped" equal "$(debug_info)" ""
check "all users may read all installed files" equal "$(find "$to" ! -type l ! -perm -o=r | head -n 3)" ""
check "files of an older version are removed" [ ! -e "$share/jolon/kinds/of-an-older-version.cfg" ]
check "the licence is installed" cmp "$root/LICENSE" "$share/doc/jolon/LICENSE"
without_page() { for program in "$to"/bin/*; do [ -e "$share/man/man1/${program##*/}.1" ] || echo "$program"; done; }
check "every program has its manual page" equal "$(without_page)" ""
check "the installed programs find their data" \
    "$to/bin/jolon" run -w "$name" --frames 3 --pace max --without renderer --out out duel
check "the unit names the installed program" grep -q '^ExecStart=/opt/jolon/bin/jolon ' \
    root/opt/jolon/lib/systemd/system/jolon@.service

# Checks links of the documents to other documents, pictures and examples.
broken_links() {
    local document link
    find "$share/doc/jolon" -name '*.md' | while read -r document; do
        grep -oE '\]\([^)# ]+' "$document" | cut -c3- | grep -v '^[a-z]*://' | while read -r link; do
            [ -e "$(dirname "$document")/$link" ] || echo "${document#"$share"/}: $link"
        done
    done
}
check "the links of the installed documents hold" equal "$(broken_links)" ""

# Compiles and runs the examples with the installed files alone.
# shellcheck disable=SC2046 # pkg-config gives words
compiled() (
    mkdir compiled && cd compiled && idlc -l c "$share/jolon/status.idl" &&
        cc -D_GNU_SOURCE -o escort "$share"/doc/jolon/docs/examples/escort.c status.c -I. \
            $(pkg-config --cflags --libs CycloneDDS) -lm
    ./escort
    [ $? = 2 ] # it takes three arguments
)
check "the example in C can be compiled" compiled
check "the example in Python runs" eval '"$share"/doc/jolon/docs/examples/sentry.py --help | grep -q "^usage: "'

check "make uninstall succeeds" make -s -C "$root" uninstall DESTDIR="$folder/root" PREFIX=/opt/jolon
check "make uninstall leaves no file" equal "$(find "$folder/root" ! -type d)" ""
check "make uninstall leaves no folder of Jolon" equal "$(find "$to" -name '*jolon*' ! -path "$to")" ""
done_testing
