#!/usr/bin/env bash
# A gateway sends to and hears broadcast, multicast and multicast of IPv6 over a network device: a world in one network namespace and
# `jolon dis` in another, joined by a veth pair. It is skipped where the kernel does not let the test make namespaces.
. "$(dirname "$0")/lib.sh"
holders=() net_a='' net_b=''
until_true() { for _ in {1..200}; do "$@" >/dev/null 2>&1 && return; sleep 0.05; done; return 1; }
leave() { [ ${#holders[@]} = 0 ] || kill "${holders[@]}" 2>/dev/null; at_end; }
trap leave EXIT

# --- the network ----------------------------------------------------------------------------------------
in_net() { local pid=net_$1; shift; nsenter --net="/proc/${!pid}/ns/net" -- "$@"; }
holder() { # Sets $1 to a process in a network namespace of its own
    unshare --net -- sleep 1000 2>/dev/null &
    until_true eval "[ \"\$(readlink /proc/$!/ns/net)\" != \"\$(readlink /proc/self/ns/net)\" ]" || return 1
    holders+=($!)
    printf -v "$1" %s $!
}
join() { # WHICH DEVICE ADDRESS: gives the device of a namespace its address
    in_net "$1" ip address add "$3/24" broadcast + dev "$2" && in_net "$1" ip link set "$2" up && in_net "$1" ip link set lo up
}
has_ipv6() { in_net "$1" ip -6 address show dev "$2" scope link -tentative | grep -q fe80; }
namespaces() {
    command -v ip >/dev/null && unshare --net true || return 1
    holder net_a && holder net_b || return 1
    ip link add "na$$" netns "$net_a" type veth peer name "nb$$" netns "$net_b" || return 1
    join a "na$$" 10.91.8.1 && join b "nb$$" 10.91.8.2
}
if ! namespaces 2>why; then
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
heard() { in_net b "$jolon" dis dump --listen "$1" --interface "nb$$" --seconds 7 --count 1 --type entity-state --json; }
passes() { # WHAT ADDRESS PEERS
    in_net a "$jolon" start -w "$name" --without renderer --without reporter --out "out-$1" --dis "$2" --set "gateway.listen=$2" \
        --set "gateway.interface=na$$" --set "gateway.peers=$3" few.cfg >/dev/null
    check "$1: the gateway receives" until_true grep -q "receives at" "out-$1/jolon.log"
    heard "$2" >"heard-$1" 2>&1
    check "$1: what it sends is heard in the other namespace" grep -q '"id":\[1991,1,1\]' "heard-$1"
    in_net b "$jolon" dis send --to "$2" --interface "nb$$" entity-state id=7:1:9 type=1.1.222.1.2.1.0 force=2 place=35.951,-121.25,266
    check "$1: and an entity from there takes part" until_true has_remote
    "$jolon" stop -w "$name" >/dev/null
    check "$1: nothing else came from strangers" grep -q '; 0 datagrams of strangers' "out-$1/jolon.log"
}
passes broadcast 10.91.8.255:3000 10.91.8.0/24
passes multicast 239.1.2.3:3000 10.91.8.0/24
if until_true has_ipv6 a "na$$" && until_true has_ipv6 b "nb$$"; then
    passes multicast-of-a-link-by-ipv6 '[ff02::77]:3000' fe80::/10
    passes multicast-of-a-site-by-ipv6 '[ff05::77]:3000' fe80::/10
else
    skip "multicast by IPv6" "the kernel gives devices no addresses of IPv6"
fi
done_testing
