#!/usr/bin/env python3
"""Participants join a world's reporter and leave. Counts what the reporter sends them afterwards.

usage: leave.py --bin DIR --world NAME --capture FILE --participants N

FILE holds the datagrams of tests/rtps/peer (see fuzz.py). Prints one JSON object: heard, the number of
participants that received an answer while they were present; after, the datagrams received in the three
seconds that begin one second after the last of them left.
"""
import argparse
import json
import struct
import time

from rtps import DATA, Reporter, captured, from_port, own_of, own_socket, submessages

ANNOUNCER = bytes((0, 1, 0, 0xC2))


def announcements(datagrams):
    """Returns the first datagram that announces a participant and the last, with which it leaves."""
    found = [d for d in datagrams
             if any(p[0] == DATA and p[12:16] == ANNOUNCER for p in submessages(d)[1:] if len(p) >= 16)]
    return found[0], found[-1]


def drain(people):
    """Returns how many datagrams each participant received."""
    counts = []
    for sock, _ in people:
        count = 0
        try:
            while sock.recv(65536):
                count += 1
        except OSError:
            pass
        counts.append(count)
    return counts


def main():
    parser = argparse.ArgumentParser()
    for option in ("--bin", "--world", "--capture"):
        parser.add_argument(option, required=True)
    parser.add_argument("--participants", type=int, required=True)
    options = parser.parse_args()
    datagrams = captured(options.capture)
    come, go = announcements(datagrams)
    own = own_of(datagrams)
    reporter = Reporter(options.bin, options.world)
    if not reporter.find(10):
        raise SystemExit("the world has no reporter")
    people = []
    for number in range(options.participants):
        prefix = struct.pack(">IIQ", 0x01100000 | number, 0x1EAF, time.monotonic_ns())[:12]
        people.append((own_socket(), prefix))

    def tell(datagram):
        for sock, prefix in people:
            for port in reporter.ports:
                sock.sendto(from_port(datagram.replace(own, prefix), sock.getsockname()[1]), ("127.0.0.1", port))
            time.sleep(0.01)

    tell(come)
    time.sleep(1.2)
    heard = sum(1 for count in drain(people) if count)
    tell(go)
    time.sleep(1)
    drain(people)
    time.sleep(3)
    print(json.dumps({"heard": heard, "after": sum(drain(people))}))


main()
