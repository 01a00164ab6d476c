# shellcheck shell=bash
# Two network namespaces, a and b, that a veth pair joins; they end with the test. Sourced after lib.sh.
holders=() net_a='' net_b=''
leave() { [ ${#holders[@]} = 0 ] || kill "${holders[@]}" 2>/dev/null; at_end; }
trap leave EXIT

# in_net a|b COMMAND...: runs a command in a namespace. With hold=exec a subshell becomes the command.
hold=
in_net() { local pid=net_$1; shift; $hold nsenter --net="/proc/${!pid}/ns/net" -- "$@"; }

holder() { # Sets $1 to a process in a network namespace of its own
    unshare --net -- sleep 1000 2>/dev/null &
    eventually eval "[ \"\$(readlink /proc/$!/ns/net)\" != \"\$(readlink /proc/self/ns/net)\" ]" || return 1
    holders+=($!)
    printf -v "$1" %s $!
}

join() { # WHICH DEVICE ADDRESS: gives the device of a namespace its address
    in_net "$1" ip address add "$3/24" broadcast + dev "$2" && in_net "$1" ip link set "$2" up && in_net "$1" ip link set lo up
}

# namespaces DEVICE NETWORK: makes both, with devices DEVICE-a and DEVICE-b and the addresses NETWORK.1 and NETWORK.2.
# Fails where the kernel does not let the test make them.
namespaces() {
    command -v ip >/dev/null && unshare --net true || return 1
    holder net_a && holder net_b || return 1
    ip link add "$1-a" netns "$net_a" type veth peer name "$1-b" netns "$net_b" || return 1
    join a "$1-a" "$2.1" && join b "$1-b" "$2.2"
}
