# Shared by the system tests: each has a folder and a world name of its own, prints checks in TAP, and
# leaves nothing behind. Source it, call check NAME COMMAND... for each check, and end with done_testing.
set -u
bin=${JOLON_BIN:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/build/bin}
jolon=$bin/jolon
name=t$$
folder=$(mktemp -d)
cd "$folder" || exit 1
# This test has its own folder of names, locks and sockets.
export JOLON_RUNTIME_DIR=$folder/runtime
number=0
failures=0

ok() { number=$((number + 1)); echo "ok $number - $1"; }
not_ok() { number=$((number + 1)); failures=$((failures + 1)); echo "not ok $number - $1"; }
skip() { number=$((number + 1)); echo "ok $number - $1 # skip $2"; }

# check NAME COMMAND...: passes when the command succeeds.
check() {
    local what=$1
    shift
    if "$@" >"$folder/check" 2>&1; then ok "$what"; else
        not_ok "$what"
        echo "# $*"
        sed 's/^/# /' "$folder/check" | tail -n 15
    fi
}

equal() { [ "$1" = "$2" ] || { echo "\"$1\" is not \"$2\""; return 1; }; }

# refuses NAME STATUS PATTERN COMMAND...: passes when the command ends with STATUS, writes one line to
# standard error, which matches PATTERN, and leaves no shared memory of this world.
refuses() {
    local what=$1 status=$2 pattern=$3 got
    shift 3
    "$@" >"$folder/stdout" 2>"$folder/stderr" </dev/null
    got=$?
    if [ $got = "$status" ] && tail -n 1 "$folder/stderr" | grep -Eq -- "$pattern" &&
        [ "$(wc -l <"$folder/stderr")" = 1 ] && nothing_left "$name"; then
        ok "$what"
    else
        not_ok "$what"
        echo "# exit $got, wanted $status and $pattern; $(ls /dev/shm "$JOLON_RUNTIME_DIR" | tr '\n' ' ')"
        sed 's/^/# /' "$folder/stderr"
    fi
}

# json KEY[.KEY] < FILE: prints a value of a JSON object.
json() { python3 -I -S -c '
import json, sys
value = json.load(sys.stdin)
for key in sys.argv[1].split("."):
    value = value[int(key)] if isinstance(value, list) else value[key]
print(value)' "$1"; }

# nothing_left PREFIX: no file is left of a world whose name begins with PREFIX.
nothing_left() { ! ls /dev/shm "$JOLON_RUNTIME_DIR" | grep -q "^\(jolon\.$UID\.\)\?$1"; }

# path_of name|lock|object [WORLD]: prints the path of a world's name, lock or object.
path_of() { "$bin/jolon-world" paths --world "${2-$name}" "$1"; }

pid() { "$bin/jolon-world" pid --world "$name" "$1" 2>/dev/null; } # pid ROLE: the process that holds the role
frame() { "$bin/jolon-world" frame --world "$name"; }
summary() { "$bin/jolon-world" summary --json --world "$name" | json "$1"; } # summary MEMBER: prints a member of the summary

# Sets source_dir to the folder with the Makefile above the programs.
find_source_dir() {
    source_dir=$(cd "$(dirname "$bin")/.." && pwd)
    until [ -e "$source_dir/Makefile" ] || [ "$source_dir" = / ]; do source_dir=$(dirname "$source_dir"); done
}

# copy_programs FOLDER: copies the programs and their data for users who cannot read the build folder.
copy_programs() {
    local config
    mkdir -p "$1/build"
    cp -r "$bin" "$1/build/bin"
    for config in "$bin/../../config" "$bin/../../../config"; do
        [ ! -d "$config" ] || cp -r "$config" "$1/config"
    done
    chmod -R go+rX "$1"
}

# A busy machine makes frames late too: a process of the frame loop is ready to run, but another
# program has the processor. The kernel counts that time, and in_time allows for it.
# kept_waiting: prints how long mover and collider have waited for a processor since they started [ms].
kept_waiting() {
    local role file waited total=0
    for role in mover collider; do
        for file in /proc/"$(pid $role)"/task/*/schedstat; do
            [ ! -r "$file" ] || read -r _ waited _ <"$file" && total=$((total + ${waited:-0} / 1000000))
        done
    done 2>/dev/null
    echo $total
}
time_begins() { # late frames are counted from here
    late_before=$(summary late_frames) frame_before=$(summary frame) waited_before=$(kept_waiting)
}
waited() { echo $(($(kept_waiting) - waited_before)); } # since time_begins [ms]
# in_time LIMIT [SLACK_MS]: at most LIMIT frames were late since time_begins, and one more for every
# SLACK_MS that the loop waited for a processor (12, the spare time of a frame). LIMIT may contain the
# word "frames", the number of frames since then.
in_time() {
    local late waited frames
    waited=$(waited) late=$(($(summary late_frames) - late_before))
    frames=$(($(summary frame) - frame_before))
    echo "# $late of $frames frames late; the frame loop waited $waited ms for a processor"
    [ $frames -gt 0 ] && [ $late -le $(($1 + waited / ${2:-12})) ]
}

# at_pace SECONDS: the world ran at least 50 of its 60 frames a second in the SECONDS since
# time_begins. Time that the loop waited for a processor is left out.
at_pace() { [ $(($(summary frame) - frame_before)) -ge $(($1 * 50 - $(waited) * 60 / 1000)) ]; }
# behind_loop PID STEPS: the niceness of the process is this many steps above the mover's, or the
# highest. So it does not take the processor from the frame loop, which in_time would not notice.
behind_loop() {
    local niceness
    niceness=$(($(niceness "$(pid mover)") + $2))
    equal "$(niceness "$1")" $((niceness < 19 ? niceness : 19))
}
niceness() { cut -d' ' -f19 "/proc/$1/stat"; }

# stalled: sets stalled_us to how long programs of this machine have waited for a processor, 0 where the kernel keeps no count
stalled() {
    local line=total=0
    [ ! -r /proc/pressure/cpu ] || read -r line </proc/pressure/cpu
    stalled_us=${line##*total=}
}
# eventually COMMAND...: waits until the command succeeds, for 30 s in which no program waited for a processor,
# and at most for 90 s.
eventually() {
    local from=${EPOCHREALTIME/[.,]/} now stalled_us stalled_from
    stalled
    stalled_from=$stalled_us
    until "$@" >/dev/null 2>&1; do
        now=${EPOCHREALTIME/[.,]/}
        stalled
        [ $((now - from - (stalled_us - stalled_from))) -lt 30000000 ] && [ $((now - from)) -lt 90000000 ] || return 1
        sleep 0.05
    done
}

done_testing() { echo "1..$number"; [ $failures = 0 ]; exit; }

at_end() {
    "$jolon" stop -w "$name" >/dev/null 2>&1
    local world
    for world in "$name" $("$bin/jolon-world" list all 2>/dev/null); do
        [[ $world != "$name"* ]] || "$bin/jolon-world" remove --world "$world" >/dev/null 2>&1
    done
    cd / && rm -rf "$folder"
}
trap at_end EXIT
