#!/usr/bin/env bash
# The console over real processes: what it tells, what can be ordered through it, what it refuses, and that
# hostile clients of it and of the live stream stop nobody. SEED=n and FUZZ=n choose other hostile bytes, and how many.
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
. "$here/lib.sh"

console() { # options...
    "$bin/jolon-console" -w "$name" --port 0 "$@" >"$folder/url" 2>"$folder/log" &
    console_pid=$!
    eventually test -s "$folder/url"
}
api() { python3 - "$(cut -d'#' -f1 "$folder/url")api/$1" <<'P'
import sys, urllib.error, urllib.request
try:
    print(urllib.request.urlopen(sys.argv[1], timeout=5).status)
except urllib.error.HTTPError as error:
    print(error.code)
P
}
checks() { # SCRIPT ARGUMENTS...: each line that it prints is a check
    while read -r line; do
        case $line in
        "ok "*) ok "${line#ok }" ;;
        "not ok "*) not_ok "${line#not ok }" ;;
        *) echo "$line" ;;
        esac
    done < <(python3 "$here/$1" "${@:2}" 2>&1 || echo "not ok $1 ended early")
}
is() { [ "$(api "${2:-state?most=0}")" = "$1" ]; }

# --- before there is a world ------------------------------------------------------------------------
check "it starts without a world" console --token-file "$folder/token"
check "and says that there is none" is 503
check "the token is the file's, which others cannot read" \
    equal "$(sed 's/.*token=//' url) $(stat -c %a token)" "$(cat token) 600"
refuses "a port in use is told in a line" 1 'it is in use; name another' \
    "$bin/jolon-console" -w "$name" --port "$(sed 's/.*:\([0-9]*\).*/\1/' url)"
refuses "and an address that is none" 1 'must be an address' "$bin/jolon-console" --port 0 --address nowhere
refuses "and wrong usage" 2 'port' "$bin/jolon-console" --port 65536

# --- with one ---------------------------------------------------------------------------------------
port=$(python3 -c '
import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
check "a set starts" "$jolon" start -w "$name" --out "$folder/out" --stream "$port"
check "the console finds it" eventually is 200
if [ -z "${JOLON_SANITIZER-}" ]; then
    check "every thread of it has its filter" equal "$(awk '$1 == "Seccomp:" { print $2 }' /proc/$console_pid/task/*/status | sort -u)" 2
    no_udp() { # the sockets that it has open, by inode, among those of UDP
        local inode
        for inode in $(readlink /proc/$console_pid/fd/* | sed -n 's/^socket:\[\(.*\)\]$/\1/p'); do
            ! awk '{ print $10 }' /proc/net/udp /proc/net/udp6 | grep -qx "$inode" || return 1
        done
    }
    check "no datagram reaches it: it has no UDP socket" no_udp
fi
checks console.py "$(cat url)" "$name"
renderer_before=$(pid renderer)
time_begins
checks hostile.py "$(cat url)" "http://127.0.0.1:$port/" chase
# Its clients load the machine too.
check "no frames are late because of them" in_time "frames / 50 + 3"
check "the renderer is the same process as before" equal "$(pid renderer)" "$renderer_before"
check "the sandbox forbade nothing" bash -c "! grep -h 'the sandbox forbids' log out/jolon.log"

# --- what dies, and comes back ----------------------------------------------------------------------
check "the console lives" kill -0 $console_pid
check "the world ends" "$jolon" stop -w "$name"
check "and the console waits" eventually is 503
check "another begins" "$jolon" start -w "$name" --without renderer --out "$folder/out2"
check "and it is found" eventually is 200
check "where nobody draws the answer says so" is 503 "picture?view=chase&size=320x180"
kill -INT $console_pid
wait $console_pid
check "Ctrl-C ends it cleanly" equal $? 0
check "with nothing wrong in its log" eval '! grep -E "warn|ERROR|failed" log'
"$jolon" stop -w "$name" >/dev/null
check "nothing is left" nothing_left "$name"
done_testing
