#!/usr/bin/env bash
# DDS Security in the real sandbox: a certificate with the permission allows reading or commanding a
# world. A client with another authority's certificate, or with none, is not heard and hears
# nothing.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
peer=$bin/../tests/rtps/peer
keys=$here/../../config/dds-security/make-keys
domain=$((100 + $$ % 100))
[ -e "$peer" ] || { skip "DDS Security" "make test builds who tries it"; done_testing; }

refuses_keys() { # pattern, arguments
    ! "$keys" "${@:2}" 2>err && grep -Eq "$1" err
}
check "jolon-keys makes certificates" "$keys" keys reporter:world operator:alice viewer:bob
check "certificates of another authority are made" "$keys" others operator:alice
check "only the owner can read the keys" equal "$(stat -c %a keys/*.key keys/world.xml | sort -u)" 600
check "an unknown kind of certificate is refused" refuses_keys 'reporter:NAME' keys king:carl
check "a name that would be a path is refused" refuses_keys 'a name is of' keys viewer:../x
sed 's/viewer/operator/; s/topic>WorldInfo</topic>Command</' keys/bob-permissions.p7s >forged.p7s
sed "s|bob-permissions.p7s|../forged.p7s|" keys/bob.xml >forged.xml

start() { # --remote-commands: where DDS does not carry commands without
    local more=()
    ! "$bin/jolon-reporter" --help | grep -q remote-commands || more=(--remote-commands)
    "$jolon" start -w "$name" --domain $domain --dds-config keys/world.xml "${more[@]}" --without renderer --out out
}
check "a set with DDS Security starts" start
try() { # what, with which configuration: one word, into WHAT.CONFIGURATION
    "$peer" -w "$name" --domain $domain ${2:+--dds-config "$2"} "$1" >"$1.$(basename "${2:-none}" .xml)$3" 2>&1
}
for verb in read command; do
    try $verb keys/alice.xml . &
    try $verb keys/bob.xml . &
    try $verb '' . &
    try $verb others/alice.xml .other &
done
try read forged.xml . &
wait
said() { equal "$(tail -n 1 "$1")" "$2"; }
# A try lasts three seconds, which a busy machine may need to start a client.
said_again() { said "$1.$2." "$3" || { try "$1" "keys/$2.xml" .; said "$1.$2." "$3"; }; } # VERB NAME WORD
check "an operator reads the status" eventually said_again read alice heard
check "an operator's command is answered" eventually said_again command alice answered
check "a viewer reads the status" eventually said_again read bob heard
check "a viewer may not command" grep -q 'Not Allowed By Security' command.bob.
check "a client without a certificate hears nothing" said read.none. unheard
check "the client's command is not answered" said command.none. unanswered
check "a client with another authority's certificate hears nothing" said read.alice.other unheard
check "the client's command is not answered" said command.alice.other unanswered
check "changed permissions are refused" grep -q 'DDS participant: ' read.forged.
check "jolon monitor accepts the configuration" "$bin/jolon-monitor" -w "$name" --domain $domain --dds-config keys/bob.xml --once
check "the sandbox forbade nothing" bash -c "! grep 'the sandbox forbids' out/jolon.log"
check "the reporter was not restarted" equal "$("$jolon" status -w "$name" --json | python3 -c '
import json, sys
print([role["restarts"] for role in json.load(sys.stdin)["roles"] if role["role"] == "reporter"])')" "[0]"
check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
done_testing
