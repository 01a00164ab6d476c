#!/usr/bin/env bash
# Every verb of jolon and jolon-world, every benchmark and every program: --help and -h print the
# usage to standard output, exit with 0 and do nothing else. Wrong arguments are refused with a
# message and 2, and nothing is done. jolon clean removes the named world and no other.
. "$(dirname "$0")/lib.sh"

cat >one.cfg <<'C'
terrain = { source = "flat"; };
vehicles = ( { kind = "tank"; at = [100.0, 100.0]; } );
C
make_world() { "$bin/jolon-world" create --world "$1" one.cfg >/dev/null; }
worlds() { "$bin/jolon-world" list | grep "^$name" | sort | tr '\n' ' '; }

# Two worlds without a set, and one with a running set.
make_world "$name-a"
make_world "$name-b"
"$jolon" start -w "$name" --out out --without renderer --without reporter one.cfg >told
before=$("$bin/jolon-world" pid --world "$name" mover)
files=$(ls -A)

# --- help, and arguments that are refused -----------------------------------------------------------
helps() { # COMMAND...: with either word for help
    local word
    for word in --help -h; do
        timeout 10 "$@" $word >said 2>err </dev/null || { echo "$word: exit $?"; cat err; return 1; }
        grep -q '^usage: ' said && [ ! -s err ] || { echo "$word:"; cat said err; return 1; }
    done
}
refuses_option() { # COMMAND...: is refused with one line and exit code 2
    timeout 10 "$@" --frobnicate >said 2>err </dev/null
    [ $? = 2 ] && [ ! -s said ] && [ "$(wc -l <err)" = 1 ] && grep -Eq '[a-z]{3}' err || { cat said err; return 1; }
}
refuses_excess() { # COMMAND...: no verb takes the three further arguments
    timeout 10 "$@" one.cfg one.cfg one.cfg >said 2>err </dev/null
    [ $? = 2 ] && [ ! -s said ] && [ "$(wc -l <err)" = 1 ] || { cat said err; return 1; }
}
as_they_should() { # WHAT COMMAND...
    local what=$1
    shift
    check "$what --help prints the usage" helps "$@"
    check "$what refuses an unknown option" refuses_option "$@"
}

mapfile -t verbs < <("$jolon" help | sed -n 's/^  \([a-z][a-z]*\).*/\1/p')
check "jolon has verbs" [ ${#verbs[@]} -ge 21 ]
for verb in "${verbs[@]}"; do
    as_they_should "jolon $verb" "$jolon" "$verb"
    check "jolon $verb refuses excess arguments" refuses_excess "$jolon" "$verb"
done
mapfile -t verbs < <("$bin/jolon-world" help | awk '/^  [a-z]/ { print $1 }')
check "jolon world has verbs" [ ${#verbs[@]} -ge 17 ]
for verb in "${verbs[@]}"; do
    as_they_should "jolon world $verb" "$jolon" world "$verb"
    check "jolon-world $verb refuses excess arguments" refuses_excess "$bin/jolon-world" "$verb"
done
for verb in $("$bin/jolon-bench" help | awk '/^  [a-z]/ { print $1 }'); do
    as_they_should "jolon-bench $verb" "$bin/jolon-bench" "$verb"
done
for program in "$jolon" "$bin"/jolon-*; do
    as_they_should "${program##*/}" "$program"
done
check "an option of another verb is refused" refuses_option "$bin/jolon-world" list --frames 3
check "an unknown signal is refused" eval '! "$jolon" kill mover -w "$name" FROB 2>err && grep -q "no such signal" err'

check "no world was made, ended or removed" equal "$(worlds)" "$name $name-a $name-b "
check "the running set still runs" equal "$("$bin/jolon-world" pid --world "$name" mover)" "$before"
check "no file was made" equal "$(rm -f said err check; ls -A)" "$files"

# --- the forms of the option that names a world --------------------------------------------------------
meant() { "$jolon" "$@" 2>&1 | grep -q "\"$name-a\""; }
check "-w NAME names the world" meant status -w "$name-a"
check "-wNAME names the world" meant status "-w$name-a"
check "--world=NAME names the world" meant status "--world=$name-a"
check "-w NAME before the verb names the world" meant -w "$name-a" status
check "--world=NAME before the verb names the world" meant "--world=$name-a" status
check "-w NAME before a verb of jolon world names the world" eval '"$jolon" -w "$name-a" world info | grep -q "$name-a"'
check "-w NAME before a verb of jolon-world names the world" eval '"$bin/jolon-world" -w "$name-a" info | grep -q "$name-a"'
check "-w NAME without a verb is refused" eval '! "$jolon" -w "$name-a" 2>err && grep -q "needs a name, and a verb" err'
check "worlds -w NAME lists that world alone" eval '[ "$("$jolon" worlds -w "$name-a" | cut -d\" -f2)" = "$name-a" ]'

# --- clean --------------------------------------------------------------------------------------------
touch "$JOLON_RUNTIME_DIR/$name-c.lock"
kept() { "$jolon" clean >told 2>&1 && grep "kept world \"$name-$1\"" told | grep -q 'stopped at frame 0, .*scenario one.cfg'; }
check "clean keeps a world without a set and reports it" kept a
check "clean removes a lock file without a world" [ ! -e "$JOLON_RUNTIME_DIR/$name-c.lock" ]
check "clean removes nothing else" equal "$(worlds)" "$name $name-a $name-b "
check "clean -w removes that world" "$jolon" clean -w "$name-a"
check "clean -w removes no other world" equal "$(worlds)" "$name $name-b "
refused() { ! "$jolon" clean "${@:2}" >told 2>err && [ "$(wc -l <err)" = 1 ] && grep -Eq "$1" err; }
check "clean refuses a running world" refused 'runs; .jolon stop' -w "$name"
check "clean refuses a world that does not exist" refused 'there is no world' -w "$name-a"
check "clean refuses -w together with --all" refused 'give one of them' -w "$name-b" --all
check "the refusals changed nothing" equal "$(worlds)" "$name $name-b "
"$bin/jolon-world" remove --world "$name-b"
done_testing
