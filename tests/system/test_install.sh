#!/usr/bin/env bash
# make install puts everything into place: stripped programs that run from there, data, documents
# whose links hold, and examples that can be compiled from what is installed. make uninstall takes
# all of it away.
. "$(dirname "$0")/lib.sh"
root=$(dirname "$(dirname "$bin")")
[ -z "${JOLON_SANITIZER-}" ] || { skip "install" "the sanitized tree is not installed"; done_testing; }
to=$folder/root/opt/jolon share=$folder/root/opt/jolon/share

mkdir -p "$share/jolon/kinds" && touch "$share/jolon/kinds/of-an-older-version.cfg"
umask 077
check "install" make -s -C "$root" install DESTDIR="$folder/root" PREFIX=/opt/jolon
umask 022
for program in "$bin"/*; do
    check "${program##*/} is installed" [ -x "$to/bin/${program##*/}" ]
done
debug_info() { for program in "$to"/bin/jolon-*; do readelf -S "$program" | grep '\.debug_info\|\.symtab'; done; }
check "the programs are stripped" equal "$(debug_info)" ""
check "everybody may read all of it" equal "$(find "$to" ! -type l ! -perm -o=r | head -n 3)" ""
check "nothing of an older version stays" [ ! -e "$share/jolon/kinds/of-an-older-version.cfg" ]
check "the licence" cmp "$root/LICENSE" "$share/doc/jolon/LICENSE"
without_page() { for program in "$to"/bin/*; do [ -e "$share/man/man1/${program##*/}.1" ] || echo "$program"; done; }
check "every program has its manual page" equal "$(without_page)" ""
check "the installed programs find their data" \
    "$to/bin/jolon" run -w "$name" --frames 3 --pace max --without renderer --out out duel
check "the unit names the installed program" grep -q '^ExecStart=/opt/jolon/bin/jolon ' \
    root/opt/jolon/lib/systemd/system/jolon@.service

# Links of the documents to other documents, to pictures and to examples.
broken_links() {
    local document link
    find "$share/doc/jolon" -name '*.md' | while read -r document; do
        grep -oE '\]\([^)# ]+' "$document" | cut -c3- | grep -v '^[a-z]*://' | while read -r link; do
            [ -e "$(dirname "$document")/$link" ] || echo "${document#"$share"/}: $link"
        done
    done
}
check "the links of the installed documents hold" equal "$(broken_links)" ""

# The examples, with what is installed and nothing else.
# shellcheck disable=SC2046 # flags are words
compiled() (
    mkdir compiled && cd compiled && idlc -l c "$share/jolon/status.idl" &&
        cc -D_GNU_SOURCE -o escort "$share"/doc/jolon/docs/examples/escort.c status.c -I. \
            $(pkg-config --cflags --libs CycloneDDS) -lm
    ./escort
    [ $? = 2 ] # it takes three arguments
)
check "the example in C can be compiled" compiled
check "the example in Python runs" eval '"$share"/doc/jolon/docs/examples/sentry.py --help | grep -q "^usage: "'

check "uninstall" make -s -C "$root" uninstall DESTDIR="$folder/root" PREFIX=/opt/jolon
check "leaves no file" equal "$(find "$folder/root" ! -type d)" ""
check "and no folder of its own" equal "$(find "$to" -name '*jolon*' ! -path "$to")" ""
done_testing
