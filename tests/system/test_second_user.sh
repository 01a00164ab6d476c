#!/usr/bin/env bash
# A second user of the machine tries every name, object, lock, socket and folder of the first user's
# world, before the world is made and while it runs. Nothing may change, and the first user must be
# denied nothing.
. "$(dirname "$0")/lib.sh"
unset JOLON_RUNTIME_DIR # each user has one of their own

if [ "$UID" != 0 ] || ! command -v useradd >/dev/null; then
    skip "a second user" "only root can add one"
    done_testing
fi

first=jolon-first-$$ second=jolon-second-$$
tree=$(mktemp -d) # of programs: neither may read where they were built
at_end_users() {
    as "$first" "$theirs" stop -w "$name" >/dev/null 2>&1
    as "$first" "$world" remove --force --world "$name" >/dev/null 2>&1
    rm -f "/dev/shm/jolon.$first_uid.$name" "/dev/shm/jolon.$first_uid.$name.lock"
    pkill -u "$second_uid"
    userdel "$first"
    userdel "$second"
    rm -rf "$tree"
    at_end
}
copy_programs "$tree"
theirs=$tree/build/bin/jolon world=$tree/build/bin/jolon-world
for user in "$first" "$second"; do
    useradd --system --create-home --home-dir "$tree/$user" --shell /usr/sbin/nologin "$user" 2>/dev/null
    chmod 700 "$tree/$user"
done
first_uid=$(id -u "$first") second_uid=$(id -u "$second")
cd "$tree" || exit 1

# as USER COMMAND...: runs the command in the user's home, without this environment.
as() {
    local user=$1
    shift
    (cd "$tree/$user" && exec setpriv --reuid "$user" --regid "$user" --clear-groups --inh-caps=-all \
        env -i PATH="$PATH" HOME="$tree/$user" ${variables[@]+"${variables[@]}"} "$@")
}
variables=()
trap at_end_users EXIT

# --- before the world is made: the second user takes its names --------------------------------------
# These are the names that an earlier version gave the world, its lock file and the renderer's socket.
as "$second" touch "/dev/shm/jolon.$first_uid.$name" "/dev/shm/jolon.$first_uid.$name.lock"
as "$second" python3 - "$first_uid" "$name" <<'P' &
import socket, sys, time
holders = []
for suffix in ("pictures", "commands"):
    holders.append(socket.socket(socket.AF_UNIX))
    holders[-1].bind(f"\0jolon.{sys.argv[1]}.{sys.argv[2]}.{suffix}")
    holders[-1].listen()
time.sleep(120)
P
start() { as "$first" "$theirs" start -w "$name" --set world.frames=0 --set renderer.width=160 --set renderer.height=90 --out out duel; }
check "the first user's world still starts" start
runs() { as "$first" "$theirs" status -w "$name" | grep -q 'is running'; }
check "the world runs" eventually runs
runtime=$(dirname "$(as "$first" "$world" paths --world "$name" name)")
object=$(as "$first" "$world" paths --world "$name" object)
check "all users can list the object's name in /dev/shm" eval 'as "$second" ls /dev/shm | grep -q "${object##*/}"'

# Fetches a picture through the renderer's socket, as its user.
picture() {
    as "$first" timeout 20 python3 - "$runtime/$name.pictures" <<'P'
import socket, sys, time
for _ in range(100):
    try:
        with socket.socket(socket.AF_UNIX) as s:
            s.connect(sys.argv[1])
            s.sendall(b"GET /picture.jpg?size=64x64 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            if s.recv(64).startswith(b"HTTP/1.1 200"):
                sys.exit(0)
    except OSError:
        pass
    time.sleep(0.1)
sys.exit(1)
P
}
check "the renderer gives pictures" picture

# --- names, folders, objects ------------------------------------------------------------------------
pids=$(pgrep -u "$first_uid" | sort | tr '\n' ' ')
state() { # what the second user could change
    as "$first" ls -la "$runtime"
    stat -c '%n %u %a %s' "$object" "$runtime"
    as "$first" "$theirs" status -w "$name" --json | python3 -c '
import json, sys
status = json.load(sys.stdin)
print(status["state"], [(role["role"], role["pid"], role["restarts"]) for role in status["roles"]])'
}
state >before

# tries WHAT COMMAND...: checks that the second user's command fails.
tries() {
    local what=$1
    shift
    if as "$second" "$@" >tried 2>&1; then
        not_ok "$what"
        tail -n 3 tried | sed 's/^/# /'
    else
        ok "$what"
    fi
}
in_python() { tries "$1" python3 -c "import os, socket, sys
$2" "${@:3}"; }

tries "the second user cannot list the runtime folder" ls "$runtime"
tries "the second user cannot make a name in it" ln -s /etc/passwd "$runtime/another"
tries "the second user cannot remove a name" rm -f "$runtime/$name"
tries "the second user cannot take a lock" flock -n "$runtime/$name.lock" true
tries "the second user cannot move the folder" mv "$runtime" "$runtime.moved"
for suffix in pictures commands; do
    in_python "nor connect to its socket $suffix" "socket.socket(socket.AF_UNIX).connect(sys.argv[1])" "$runtime/$name.$suffix"
done
for mode in O_RDONLY O_WRONLY O_RDWR O_RDWR\|os.O_TRUNC; do
    in_python "cannot open the object ($mode)" "os.open(sys.argv[1], os.$mode)" "$object"
done
tries "the second user cannot truncate the object" truncate -s 0 "$object"
tries "the second user cannot remove the object" rm -f "$object"
tries "the second user cannot rename the object" mv -f "$object" "/dev/shm/jolon.$second_uid.mine"
tries "the second user cannot replace the object" cp /etc/hostname "$object"
tries "the second user cannot change the object's mode" chmod 666 "$object"
tries "the second user cannot link to the object" ln "$object" "/dev/shm/jolon.$second_uid.linked"
for pid in $pids; do
    tries "the second user cannot signal $(cat "/proc/$pid/comm")" kill -STOP "$pid"
    tries "the second user cannot read its memory" head -c 1 "/proc/$pid/mem"
    tries "the second user cannot see its descriptors" ls "/proc/$pid/fd/"
done

# --- every verb, with the second user's own folder and with the first one's --------------------------
own=$(as "$second" "$world" paths --world "$name" name)
check "the second user's names are in another folder" [ "${own%/*}" != "$runtime" ]
as "$second" ln -s "$object" "$own"
verbs=(status stop "kill mover" "restart reporter" "snap x.png" "events" "clean" "world info" "world check" "world repair"
    "world digest" "world dump" "world save x.image" "world remove --force" "world summary" "world frame" "world pid mover")
for verb in "${verbs[@]}"; do
    # shellcheck disable=SC2086 # several words
    tries "a name of the second user that leads to the first user's object fails: $verb" "$theirs" $verb -w "$name"
done
as "$second" rm "$own"
verbs=("${verbs[@]/#world remove*/world repair}") # to remove what is not there is no mistake
for verb in "${verbs[@]}"; do
    # shellcheck disable=SC2086 # several words
    tries "the second user finds no such world: $verb" "$theirs" $verb -w "$name"
done
variables=("JOLON_RUNTIME_DIR=$runtime")
for verb in "world remove --force" "${verbs[@]}"; do
    # shellcheck disable=SC2086 # several words
    tries "the second user cannot use the first user's folder: $verb" "$theirs" $verb -w "$name"
done
check "the refusal names the runtime folder" grep -q 'cannot be the runtime folder: .*JOLON_RUNTIME_DIR' tried
variables=("XDG_RUNTIME_DIR=${runtime%/*}" "HOME=$tree/$first")
check "a session folder of another user is not used" equal "$(as "$second" "$world" paths --world "$name" name)" "$own"
variables=()
check "clean --all affects no files of another user" as "$second" "$theirs" clean --all
check "a world of the same name is the second user's own" as "$second" "$theirs" run -w "$name" --frames 5 --pace max \
    --without renderer --out out duel
pkill -u "$second_uid"
wait 2>/dev/null

# --- commands, and the topics -------------------------------------------------------------------------
for command in pause resume "step 1" "scale 2" "drive 1" "release 1 --anyway" "fire 1" "remove 1" quit \
    "spawn tank --at 25000,25000" "fire --munition shell --at 25000,25000"; do
    # shellcheck disable=SC2086 # several words
    tries "the second user cannot command the world: $command" "$theirs" ctl -w "$name" --timeout 1 $command
done
for command in pause "spawn tank --at 25000,25000" quit; do
    # shellcheck disable=SC2086 # several words
    tries "the second user cannot command the world over DDS: $command" "$theirs" ctl -w "$name" --remote --timeout 2 $command
done
check "the first user can command the world" eval 'as "$first" "$theirs" ctl -w "$name" pause && as "$first" "$theirs" ctl -w "$name" resume'

# --- nothing has changed ------------------------------------------------------------------------------
state >after
check "all files of the first user are unchanged" cmp before after
check "the world still runs" runs
check "the renderer still gives pictures" picture
check "the first user's world stops" as "$first" "$theirs" stop -w "$name"
check "nothing is left" eval '! ls "$runtime" | grep -q . && ! ls "$object"'
done_testing
