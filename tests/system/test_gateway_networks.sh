#!/usr/bin/env bash
# A gateway sends to and hears broadcast, multicast and multicast of IPv6 over a network device: a world in one network namespace and
# `jolon dis` in another, joined by a veth pair. It is skipped where the kernel does not let the test make namespaces.
here=$(cd "$(dirname "$0")" && pwd)
. "$(dirname "$0")/lib.sh"
. "$here/namespaces.sh" || exit

# --- the network ----------------------------------------------------------------------------------------
has_ipv6() { in_net "$1" ip -6 address show dev "$2" scope link -tentative | grep -q fe80; }
if ! namespaces "n$$" 10.91.8 2>why; then
    skip "broadcast and multicast over a network device" "no network namespaces may be made here"
    done_testing
    exit
fi

# --- each way -------------------------------------------------------------------------------------------
cat >few.cfg <<'END'
world = { capacity = 64; remotes_max = 8; };
terrain = { source = "flat"; height_m = 300.0; };
objects = { source = "none"; };
vehicles = ( { kind = "tank"; force = "blue"; behaviour = "idle"; at = [25000.0, 25000.0]; heading_deg = 0.0; } );
END
has_remote() { "$bin/jolon-world" dump --world "$name" --json | grep -q '"remote":"7:1:9"'; }
heard() { in_net b "$jolon" dis dump --listen "$1" --interface "n$$-b" --seconds 7 --count 1 --type entity-state --json; }
passes() { # WHAT ADDRESS PEERS
    in_net a "$jolon" start -w "$name" --without renderer --without reporter --out "out-$1" --dis "$2" --set "gateway.listen=$2" \
        --set "gateway.interface=n$$-a" --set "gateway.peers=$3" few.cfg >/dev/null
    check "$1: the gateway receives" eventually grep -q "receives at" "out-$1/jolon.log"
    heard "$2" >"heard-$1" 2>&1
    check "$1: what it sends is heard in the other namespace" grep -q '"id":\[1991,1,1\]' "heard-$1"
    in_net b "$jolon" dis send --to "$2" --interface "n$$-b" entity-state id=7:1:9 type=1.1.222.1.2.1.0 force=2 place=35.951,-121.25,266
    check "$1: and an entity from there takes part" eventually has_remote
    "$jolon" stop -w "$name" >/dev/null
    check "$1: nothing else came from strangers" grep -q '; 0 datagrams of strangers' "out-$1/jolon.log"
}
passes broadcast 10.91.8.255:3000 10.91.8.0/24
passes multicast 239.1.2.3:3000 10.91.8.0/24
if eventually has_ipv6 a "n$$-a" && eventually has_ipv6 b "n$$-b"; then
    passes multicast-of-a-link-by-ipv6 '[ff02::77]:3000' fe80::/10
    passes multicast-of-a-site-by-ipv6 '[ff05::77]:3000' fe80::/10
else
    skip "multicast by IPv6" "the kernel gives devices no addresses of IPv6"
fi
done_testing
