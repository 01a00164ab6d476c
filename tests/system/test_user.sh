#!/usr/bin/env bash
# A set that root starts for another user: all its files belong to that user, and no process of it
# runs as root.
. "$(dirname "$0")/lib.sh"
unset JOLON_RUNTIME_DIR # each user has one of their own

if [ "$UID" != 0 ] || ! command -v useradd >/dev/null; then
    skip "a set of another user" "only root can run one"
    done_testing
fi

other=jolon-test-$$
tree=$(mktemp -d)
at_end_user() {
    "$theirs" stop --user "$other" -w "$name" >/dev/null 2>&1
    local uid
    uid=$(id -u "$other") && rm -rf "/run/user/$uid"
    userdel "$other"
    rm -rf "$tree"
    at_end
}
trap at_end_user EXIT
useradd --system --no-create-home --shell /usr/sbin/nologin "$other"
uid=$(id -u "$other")
copy_programs "$tree"
theirs=$tree/build/bin/jolon
cd "$tree" || exit 1

start() { "$theirs" start --user "$other" -w "$name" --without renderer --out "$tree/out" >told 2>&1; }
pid() { "$theirs" world pid --user "$other" -w "$name" "$1" 2>/dev/null; }
field() { awk -v name="$2:" '$1 == name { $1 = ""; print }' "/proc/$1/status"; }
owners() { find "$tree/out" -printf '%u\n' | sort -u; }
replaced() { local now; now=$(pid "$1") && [ "$now" != "$2" ]; }

check "a set starts for another user" start
keeper=$(sed -n 's/.*supervisor pid \([0-9]*\),.*/\1/p' told)
for process in "$keeper" $(pgrep -P "$keeper"); do
    what=$(cat "/proc/$process/comm")
    check "$what runs as that user, and no other" equal "$(field "$process" Uid)" " $uid $uid $uid $uid"
    check "$what is in no group but the user's own" equal "$(field "$process" Groups | tr -d ' ')" ""
    check "$what has none of root's capabilities" equal "$(field "$process" CapPrm)" " 0000000000000000"
done
check "the folder of --out and all in it are the user's" equal "$(owners)" "$other"
check "root sees the world with --user" eval '"$theirs" status --user "$other" -w "$name" | grep -q "is running"'
"$theirs" status -w "$name" >told 2>&1
check "root has no such world itself" equal $? 1
before=$(pid reporter)
check "jolon kill --user succeeds" "$theirs" kill --user "$other" -w "$name" reporter
check "the reporter is replaced" eventually replaced reporter "$before"
check "the new reporter runs as that user" equal "$(field "$(pid reporter)" Uid)" " $uid $uid $uid $uid"
check "jolon stop --user succeeds" "$theirs" stop --user "$other" -w "$name"
check "nothing is left" eval '! ls /dev/shm "/run/user/$uid/jolon" 2>/dev/null | grep -q "$name"'

refused() { # NAME STATUS PATTERN COMMAND...: one line
    local what=$1 status=$2 pattern=$3
    shift 3
    "$@" >told 2>&1
    check "$what" eval "[ $? = $status ] && [ \$(wc -l <told) = 1 ] && grep -q -- '$pattern' told"
}
refused "an unknown user is refused" 1 'there is no such user' "$theirs" start --user nobody-$$ -w "$name"
refused "--user without a name is refused" 2 '--user needs a name' "$theirs" start -w "$name" --user
refused "--user is refused for other users" 1 'only root can' setpriv --reuid "$uid" --regid "$uid" --clear-groups \
    "$theirs" status --user root -w "$name"
chmod 700 "$tree/build"
refused "programs that the user may not run are refused" 1 'install Jolon for all users' "$theirs" start --user "$other" -w "$name"
chmod 755 "$tree/build"
"$theirs" run -w "$name" --frames 5 --pace max --without renderer --out "$tree/roots" >told 2>&1
check "root without --user gets a warning" grep -q 'runs as root: .*--user NAME' told
done_testing
