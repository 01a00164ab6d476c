#!/usr/bin/env bash
# The manual: every program has a page that mandoc accepts, with exactly the options of the
# program's own help. jolon help explains each verb, and completion offers what exists.
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"
pages=$top/docs/man

sound() { # mandoc does not look for other pages here
    ! mandoc -Tlint "$1" | grep -v 'referenced manual not found' | grep .
}
options() { grep -oE -- '--[a-z][a-z-]*' | sort -u; }
of_page() { mandoc -Tascii -Owidth=400 "$@" | sed 's/.\x08//g' | options; }
same() { # PAGE COMMAND...: the same options in both
    local page=$1
    shift
    diff <("$@" 2>&1 | options) <(of_page "$page")
}
for page in "$pages"/*; do
    check "mandoc accepts $(basename "$page")" sound "$page"
done
for program in "$bin"/jolon-*; do
    of=$(basename "$program")
    case $of in
    jolon-keeper) check "$of has a page" [ -e "$pages/$of.1" ] ;;
    jolon-world | jolon-bench) check "$of: page and help name the same options" same "$pages/$of.1" "$program" help ;;
    *) check "$of: page and help name the same options" same "$pages/$of.1" "$program" --help ;;
    esac
done
check "jolon run: page and help name the same options" same "$pages/jolon-run.1" "$jolon" help run
check "jolon: page and help name the same options" same "$pages/jolon.1" "$jolon" help

# --- help -----------------------------------------------------------------------------------------------
mapfile -t verbs < <("$jolon" help | sed -n 's/^  \([a-z][a-z]*\).*/\1/p')
check "jolon help lists the verbs" [ ${#verbs[@]} -ge 21 ]
more() { "$jolon" help "$1" >told && grep -Eq "^(usage:|  $1)" told; }
for verb in "${verbs[@]}"; do
    check "jolon help $verb explains the verb" more "$verb"
    check "$verb is in the page of jolon" eval "mandoc -Tascii '$pages/jolon.1' | sed 's/.\x08//g' | grep -Eq '^ +$verb( |\$)'"
done
said() { ! "$jolon" "$@" >told 2>err && [ "$(wc -l <err)" = 1 ]; }
check "a misspelt verb is answered with the nearest verb" eval 'said strat && grep -q "did you mean start?" err'
check "an unknown word is answered without a suggestion" eval 'said frobnicate && ! grep -q mean err'
check "help for a misspelt verb offers the nearest verb" eval 'said help moniter && grep -q "did you mean monitor?" err'
if command -v man >/dev/null && command -v script >/dev/null; then
    check "help on a terminal shows the manual page" eval \
        'MANPAGER=cat PAGER=cat script -qec "$jolon help ctl" /dev/null </dev/null | grep -q "EXIT STATUS\|E.*X.*I.*T.*S.*T.*A.*T.*U.*S"'
else
    skip "help on a terminal shows the manual page" "no man or no script here"
fi

# --- completion -------------------------------------------------------------------------------------------
. "$top/supervisor/jolon.completion"
PATH=$bin:$PATH
offers() { # WANTED WORD...: of the words, the last is begun; is WANTED offered?
    local wanted=$1
    shift
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _jolon jolon
    printf '%s\n' ${COMPREPLY[@]+"${COMPREPLY[@]}"} | grep -Fqx -- "$wanted" || { echo "offered: ${COMPREPLY[*]}"; return 1; }
}
check "completion: verbs" offers harness jolon har
check "completion: a verb's options" offers --checkpoint jolon run --che
check "completion: a program's options" offers --lease jolon ctl drive 1 --le
check "completion: commands of ctl" offers release jolon ctl rel
check "completion: roles" offers collider jolon kill co
check "completion: roles that may be left out" offers reporter jolon run --without rep
check "completion: scenarios" offers duel jolon start du
check "completion: kinds" offers helicopter jolon ctl spawn heli
check "completion: values of an option" offers reverse jolon ctl drive 1 --gear r
"$bin/jolon-world" create --world "$name" duel >/dev/null
check "completion: worlds" offers "$name" jolon stop -w "${name:0:3}"
check "completion: verbs of world" offers repair jolon world rep
done_testing
