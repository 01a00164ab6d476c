#!/usr/bin/env bash
# Bad input: each is refused with one clear line and exit code 1 (2 for wrong usage), and nothing is
# left behind.
. "$(dirname "$0")/lib.sh"

run() { "$jolon" run -w "$name" --frames 2 --pace max --without renderer --without reporter --out out --json "$@"; }

cat >good.cfg <<'C'
terrain = { source = "flat"; };
vehicles = ( { kind = "tank"; at = [100.0, 100.0]; } );
C
check "a good scenario runs" run good.cfg
scenario() { printf '%s\n' "$1" >bad.cfg; }

scenario 'world = { sped = 3; };'
refuses "unknown key" 1 'bad\.cfg:1: world\.sped' run bad.cfg
scenario 'world = { hz = "fast"; };'
refuses "wrong type" 1 'bad\.cfg:1: world\.hz = "fast"' run bad.cfg
scenario 'world = { hz = 100000.0; };'
refuses "value out of range names the range" 1 'world\.hz = 100000.*1\.\.1000' run bad.cfg
scenario 'vehicles = ( { kind = "tonk"; at = [1.0, 1.0]; } );'
refuses "unknown kind" 1 'kind = "tonk"' run bad.cfg
scenario 'world = { '
refuses "not a scenario at all" 1 'bad\.cfg:[12]:' run bad.cfg
scenario 'world = { capacity = 16; }; terrain = { source = "flat"; }; vehicles = ( { kind = "tank"; count = 17; } );'
refuses "capacity too small" 1 'capacity' run bad.cfg
scenario 'terrain = { source = "flat"; }; vehicles = ( { kind = "ship"; count = 3; } );'
refuses "a ship on land" 1 'no place for ship' run bad.cfg
scenario 'terrain = { source = "flat"; }; fires = ( { at_s = 1.0; shooter = "Nobody"; point = [1.0, 1.0]; } );'
refuses "unknown shooter" 1 'Nobody' run bad.cfg
scenario 'vehicles = ( { kind = "tank"; at = [1500.0, 29000.0]; } );'
refuses "a tank in the sea" 1 'a tank would stand in the water; right would be: a place on land' run bad.cfg
refuses "missing file" 1 'no-such-file\.cfg' run ./no-such-file.cfg
refuses "a folder instead of a scenario" 1 'out' run ./out
refuses "unknown override" 1 'world\.sped' run --set world.sped=3 good.cfg
refuses "source not in this version" 1 'dem' run --set terrain.source=dem good.cfg
refuses "unknown option" 2 '--frobnicate' run --frobnicate
refuses "two scenarios" 2 'more than one' run good.cfg good.cfg
refuses "a bad world name" 2 'a-z' "$jolon" run -w 'no/good'
refuses "a run without the mover" 2 'no world runs without it' run --without mover
refuses "an output folder that cannot be made" 1 '/proc/x' run --out /proc/x good.cfg
refuses "status without a world" 1 'there is no world' "$jolon" status -w "$name"
refuses "digest without a world" 1 'there is no world' "$jolon" world digest -w "$name"
refuses "a role without a world" 1 'there is no world' "$bin/jolon-mover" --world "$name"

# Limits that the shell sets are reported in words.
small_stack() { (ulimit -s 64 && run good.cfg); }
refuses "a stack too small for the roles" 1 'stack is limited to 64 KB' small_stack
small_files() {
    (ulimit -f 10 && "$jolon" "$1" -w "$name" --frames 2 --out out good.cfg) >told 2>err
    [ $? = 1 ] && [ "$(wc -l <err)" = 1 ] && grep -qi 'file' err || { cat told err; return 1; }
}
check "jolon run reports a file limit of 10 KB" small_files run
check "jolon start reports a file limit of 10 KB" small_files start
no_memory() { (ulimit -v 45000 && "$bin/jolon-world" create --world "$name" good.cfg); }
refuses "no memory for the world" 1 'memory' no_memory
small_world() { (ulimit -f 10 && "$bin/jolon-world" create --world "$name" good.cfg); }
refuses "jolon-world with a file limit of 10 KB" 1 'needs [0-9.]+ MB, and no file .*ulimit -f' small_world

# A stop while the world is made leaves nothing. The programs with crash points halt there.
crash=${bin%/bin}/crash/bin
if [ -x "$crash/jolon-keeper" ]; then
    for point in "space" "parameters" "page of a new world"; do
        JOLON_CRASH="world:$point:1:15" "$crash/jolon-world" create --world "$name" good.cfg >told 2>&1
        check "jolon-world ends when stopped at \"$point\"" equal $? 143
        check "the stopped program leaves nothing" nothing_left "$name"
    done
    JOLON_CRASH="world:parameters:1:19" "$crash/jolon" run -w "$name" --out out good.cfg >told 2>err &
    run=$!
    halted() { grep -qs '^State:.T' "/proc/$(pgrep -P $run jolon-world)/status"; }
    check "jolon-world halts while it makes the world" eventually halted
    kill -TERM $run
    wait $run
    check "jolon run ends with 1 when stopped then" equal $? 1
    check "the run reports the stop in one line" eval 'grep -q "stopped before world .* ran" err && [ "$(wc -l <err)" = 1 ]'
    check "the stopped program leaves nothing" nothing_left "$name"
else
    skip "a stop while the world is made" "no programs with crash points: make crash"
fi
"$bin/jolon-world" remove --world "$name" >/dev/null 2>&1

# A run that cannot be recorded is refused, unless the user asked for it.
mkdir fifo && mkfifo fifo/commands.log
unrecorded() { # VERB ...
    timeout 30 "$jolon" "$1" -w "$name" --frames 200 --pace max --without renderer --without reporter "${@:2}" good.cfg >told 2>err
    [ $? = 1 ] && grep -q 'recorder refused: .*must be a plain file' err && nothing_left "$name" || { cat told err; return 1; }
}
check "a FIFO instead of the output folder is refused" unrecorded run --out fifo
check "jolon start refuses it too" unrecorded start --out fifo
mkfifo events.fifo
check "a FIFO for the events is refused" unrecorded run --out out --events events.fifo

# Two sets in one folder.
"$jolon" start -w "$name" --out one --without renderer --without reporter good.cfg >told
check "jolon start names its output folder" grep -q 'logs in one[, ]' told
second() { ! "$jolon" "$1" -w "$name-2" --frames 2 --out ./one good.cfg >told 2>err && grep -q 'another set writes there' err && [ "$(wc -l <err)" = 1 ]; }
check "another set's folder is refused" second run
check "jolon start refuses another set's folder too" second start
check "the second set leaves nothing" nothing_left "$name-2"
check "the first set still runs" "$jolon" stop -w "$name"
check "the first set is recorded to its end" eval 'tail -n 1 one/commands.log | grep -q end'
"$jolon" run -w "$name" --frames 2 --pace max --without renderer --without reporter good.cfg >told 2>err
check "without --out a world has a folder of its own" [ -s "jolon-out-$name/commands.log" ]

# Long work shows its progress on a terminal.
cat >many.cfg <<'C'
world = { capacity = 1048576; }; terrain = { source = "flat"; };
vehicles = ( { kind = "tank"; count = 1048576; area = [1000.0, 1000.0, 16000.0, 16000.0]; } );
C
placing() { timeout 60 script -qec "'$bin/jolon-world' check many.cfg" /dev/null </dev/null | grep -a -m 1 -q 'of 1048576 vehicles have a place'; }
if command -v script >/dev/null; then
    check "a long check shows its progress" placing
else
    skip "a long check shows its progress" "no script here"
fi

# A full /dev/shm: one of 8 MB in a mount namespace of this test.
if unshare -m true 2>/dev/null; then
    full() {
        unshare -m bash -c "mount -t tmpfs -o size=8m tmpfs /dev/shm && cd '$folder' &&
            '$jolon' run -w $name --frames 2 --without renderer --without reporter --out out good.cfg;
            status=\$?; [ -z \"\$(ls /dev/shm)\" ] || echo left >&2; exit \$status"
    }
    refuses "full shared memory is reported with the needed and the free size" 1 'needs [0-9.]+ MB .*free' full
else
    skip "full shared memory is reported with the needed and the free size" "needs the right to make a mount namespace"
fi

# Without OpenGL or a DDS interface the simulation runs and reports what is missing.
env __EGL_VENDOR_LIBRARY_DIRS=/nonexistent LIBGL_DRIVERS_PATH=/nonexistent \
    "$jolon" run -w "$name" --frames 30 --pace max --without reporter --set renderer.backend=gl --out out --json \
    good.cfg >told 2>err
check "a run without the requested OpenGL ends with 0" equal "$(json frame <told)" 30
check "one line says what is missing" grep -q 'goes on without the renderer and keeps trying: .*OpenGL' err
env __EGL_VENDOR_LIBRARY_DIRS=/nonexistent LIBGL_DRIVERS_PATH=/nonexistent \
    "$jolon" run -w "$name" --frames 30 --pace max --without reporter --out out good.cfg >told 2>&1
check "a run without any OpenGL still makes pictures" [ -s out/chase.png ]
check "nothing is left" nothing_left "$name"
"$bin/jolon-world" create --world "$name" good.cfg >/dev/null
refuses_interface() { "$bin/jolon-reporter" --world "$name" --interface 203.0.113.7; }
refuses_interface >told 2>err
check "a missing DDS interface is refused with 1" equal $? 1
check "the missing interface is named in one line" grep -q '203.0.113.7' err
"$bin/jolon-world" remove --world "$name"
check "nothing is left" nothing_left "$name"
done_testing
