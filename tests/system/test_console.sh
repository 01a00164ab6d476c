#!/usr/bin/env bash
# The console with real processes: what it shows, the commands it takes, what it refuses. Hostile
# clients of the console and of the live stream must not affect other clients. SEED=n and FUZZ=n
# choose other hostile bytes and their number.
# Quiet: new clients have 10 s for a picture beside 500 slow connections.
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
check "the console starts without a world" console --token-file "$folder/token"
check "it answers that there is no world" is 503
check "the token comes from a file that others cannot read" \
    equal "$(sed 's/.*token=//' url) $(stat -c %a token)" "$(cat token) 600"
refuses "a port in use" 1 'it is in use; name another' \
    "$bin/jolon-console" -w "$name" --port "$(sed 's/.*:\([0-9]*\).*/\1/' url)"
refuses "an invalid address" 1 'must be an address' "$bin/jolon-console" --port 0 --address nowhere
refuses "a port out of range" 2 'port' "$bin/jolon-console" --port 65536

# --- with a world -----------------------------------------------------------------------------------
port=$(python3 -c '
import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
check "a set starts" "$jolon" start -w "$name" --out "$folder/out" --stream "$port"
check "the console finds the world" eventually is 200
if [ -z "${JOLON_SANITIZER-}" ]; then
    check "every thread of the console has its filter" equal "$(awk '$1 == "Seccomp:" { print $2 }' /proc/$console_pid/task/*/status | sort -u)" 2
    no_udp() { # the sockets that it has open, by inode, among those of UDP
        local inode
        for inode in $(readlink /proc/$console_pid/fd/* | sed -n 's/^socket:\[\(.*\)\]$/\1/p'); do
            ! awk '{ print $10 }' /proc/net/udp /proc/net/udp6 | grep -qx "$inode" || return 1
        done
    }
    check "the console has no UDP socket" no_udp
fi
checks console.py "$(cat url)" "$name"
renderer_before=$(pid renderer)
time_begins
checks hostile.py "$(cat url)" "http://127.0.0.1:$port/" chase
# The clients load the machine too.
check "the clients make no frames late" in_time "frames / 50 + 3"
check "the renderer was not replaced" equal "$(pid renderer)" "$renderer_before"
check "the sandbox forbade nothing" bash -c "! grep -h 'the sandbox forbids' log out/jolon.log"

# --- deaths and restarts ----------------------------------------------------------------------------
check "the console is alive" kill -0 $console_pid
check "the world ends" "$jolon" stop -w "$name"
check "the console waits for a world" eventually is 503
check "another world begins" "$jolon" start -w "$name" --without renderer --out "$folder/out2"
check "the console finds it" eventually is 200
check "a request for a picture without a renderer is answered with 503" is 503 "picture?view=chase&size=320x180"
kill -INT $console_pid
wait $console_pid
check "Ctrl-C ends the console with 0" equal $? 0
check "its log has no warnings" eval '! grep -E "warn|ERROR|failed" log'
"$jolon" stop -w "$name" >/dev/null
check "nothing is left" nothing_left "$name"
done_testing
