#!/usr/bin/env bash
# Two worlds of one name at once, in two runtime folders, as two users of a machine have them: drive,
# monitor, harness and ctl of a folder see and command the world of that folder, whoever began first.
. "$(dirname "$0")/lib.sh"
here=$JOLON_RUNTIME_DIR
there=$folder/there
elsewhere=$folder/elsewhere # has no world
at() { JOLON_RUNTIME_DIR=$1 "${@:2}"; }
stop_all() {
    for world in "$here" "$there"; do at "$world" "$jolon" stop -w "$name"; done >/dev/null 2>&1
    at_end
}
trap stop_all EXIT

# --- two persons who do not say where ---------------------------------------------------------------
mkfifo keys-here keys-there
exec {keys_here}<>keys-here {keys_there}<>keys-there
at "$here" "$jolon" drive --plain <keys-here >shown-here 2>told-here &
drives=($!)
check "one person drives" eventually grep -q 'you drive jeep (jeep 1)' shown-here
at "$there" "$jolon" drive --plain <keys-there >shown-there 2>told-there &
drives+=($!)
check "another person drives a jeep, too" eventually grep -q 'you drive jeep (jeep 1)' shown-there
printf w >keys-here
# speeds FILE: prints the speeds that were shown, in m/s, without fractions
speeds() { grep -o 'speed_mps=[0-9]*' "$1" | cut -d= -f2; }
moves() { speeds shown-here | grep -q '[1-9]'; }
check "the first jeep drives" eventually moves
sleep 2
check "the other jeep stands" eval '! speeds shown-there | grep -q "[1-9]"'
check "nobody loses a world" eval '! grep -h "another world" shown-here shown-there'
for pipe in here there; do printf q >keys-$pipe; done
wait "${drives[@]}"
exec {keys_here}>&- {keys_there}>&-

# --- two worlds of a name that the users chose ---------------------------------------------------------
begin() { at "$1" "$jolon" start -w "$name" --without renderer --remote-commands --out "$folder/out-$2" "${@:3}"; }
check "a world begins in the first folder" begin "$here" here duel
check "a world of the same name begins in the other" begin "$there" there training
entities() { at "$1" "$bin/jolon-monitor" -w "$name" --once --json "${@:2}" | json entities; }
is_duel() { equal "$(entities "$@")" 2; }
is_training() { [ "$(entities "$@")" -gt 2 ]; }
check "a monitor sees the world of its folder" eventually is_duel "$here"
check "so does the other" eventually is_training "$there"
harness_kinds() { at "$1" "$bin/jolon-harness" -w "$name" </dev/null | head -n 1; }
check "so does a harness" eval 'harness_kinds "$here" >world-here && harness_kinds "$there" >world-there && ! cmp -s world-here world-there'

check "a command over DDS reaches one world" at "$there" "$bin/jolon-ctl" -w "$name" --remote pause
paused() { at "$1" "$jolon" status -w "$name" --json | json paused; }
check "which is that of the folder" equal "$(paused "$here") $(paused "$there")" "False True"
check "the worlds have partitions of their own" eval \
    '! equal "$(at "$here" "$bin/jolon-world" paths -w "$name" partition)" "$(at "$there" "$bin/jolon-world" paths -w "$name" partition)"'

# --- those who know no more than the name --------------------------------------------------------------
no_world() { ! at "$elsewhere" "$bin/jolon-monitor" -w "$name" --once --json; }
check "a monitor of a folder without that world sees none" no_world
partition() { at "$1" "$jolon" world paths -w "$name" partition; }
names_both() { grep -q "$(partition "$here")" "$1" && grep -q "$(partition "$there")" "$1" && grep -q -- --partition "$1"; }
refused() { ! at "$elsewhere" "$@" 2>told; }
for reader in "monitor --once" "harness" "drive --plain --remote" "ctl --remote pause"; do
    # shellcheck disable=SC2086
    check "with an interface, ${reader%% *} is told of both worlds and takes none" \
        eval 'refused "$bin/jolon-${reader%% *}" -w "$name" ${reader#"${reader%% *}"} --interface lo </dev/null >/dev/null && names_both told'
done
check "neither was paused" equal "$(paused "$here") $(paused "$there")" "False True"
check "a monitor that is told which sees the one" is_duel "$elsewhere" --interface lo --partition "$(partition "$here")"
check "and the other" is_training "$elsewhere" --interface lo --partition "$(partition "$there")"
check "a command to the one reaches that alone" at "$elsewhere" "$bin/jolon-ctl" -w "$name" --remote --interface lo \
    --partition "$(partition "$there")" resume
check "the other still runs, too" equal "$(paused "$here") $(paused "$there")" "False False"
check "a partition of another name is refused" eval \
    'refused "$bin/jolon-monitor" -w "$name" --once --interface lo --partition "x@0123456789abcdef" && grep -q "is none of world" told'
check "a driver of another folder's world is told to command it over DDS" eval \
    'refused "$bin/jolon-drive" -w "$name" --plain --interface lo --partition "$(partition "$there")" </dev/null >/dev/null && grep -q -- "--remote as well" told'
check "the first world stops" at "$here" "$jolon" stop -w "$name"
check "a monitor with an interface sees the other user's world by its name" is_training "$elsewhere" --interface lo
JOLON_RUNTIME_DIR=$elsewhere "$bin/jolon-monitor" -w "$name" --json --interface lo >seen-one 2>told-one &
readers=($!) # of the monitor itself, so that it can be ended
check "so does one that goes on" eventually test -s seen-one
check "a world of that name begins again" begin "$here" again duel
sees_training() { [ "$(tail -n 1 seen-one | json entities)" -gt 2 ]; }
sleep 2
check "who reads one world stays with it" sees_training
for world in "$here" "$there"; do check "a world stops" at "$world" "$jolon" stop -w "$name"; done

# --- a reader that was there first ------------------------------------------------------------------------
JOLON_RUNTIME_DIR=$elsewhere "$bin/jolon-monitor" -w "$name" --lines --interface lo >lines 2>told-first &
readers+=($!)
check "a monitor waits for a world" eventually test -s lines
check "two worlds begin" eval 'begin "$here" first duel && begin "$there" second training'
check "it says that there are two" eventually grep -q 'takes none of them' told-first
check "and names them" names_both told-first
kill "${readers[@]}"
wait "${readers[@]}"
check "the one stops" at "$here" "$jolon" stop -w "$name"
check "the other stops" at "$there" "$jolon" stop -w "$name"
done_testing
