#!/usr/bin/env python3
"""Sends a world's reporter mutated RTPS datagrams, as any local process could.

usage: fuzz.py --bin DIR --world NAME --capture FILE --packets N [--rate R] [--seed S] [--keep DIR]

FILE holds the datagrams that tests/rtps/peer sent while it discovered the world and communicated with
it. Each session acts as a new participant. It sends the captured datagrams in order to the open ports
of the reporter, under a new prefix of its own and with the reporter's current prefix. Most of them are
mutated. The seed alone determines the datagrams, except for the reporter's prefix and ports.

Prints one JSON object: packets, seconds, restarts (observed deaths of the reporter), dropped (datagrams
that the full sockets of the last reporter dropped). --keep writes the last datagrams before each death
into this folder, one file for each death, in the format of FILE.
"""
import argparse
import collections
import json
import os
import random
import struct
import sys
import time

from rtps import DATA, DATAGRAM_MAX, HEADER, INFO_DST, INFO_TS, Reporter, captured, from_port, heard_prefix, \
    own_of, own_socket, submessages, target_of

ACKNACK, HEARTBEAT, GAP, DATA_FRAG = 0x06, 0x07, 0x08, 0x16
KINDS = (0x01, ACKNACK, HEARTBEAT, GAP, INFO_TS, 0x0C, 0x0D, INFO_DST, 0x0F, 0x12, 0x13, DATA, DATA_FRAG,
         0x30, 0x31, 0x32, 0x33, 0x34, 0x80)
WORDS = (0, 1, 2, 3, 4, 7, 8, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFE, 0xFFFF, 0x10000, 0x7FFFFFFF,
         0x80000000, 0xFFFFFFFC, 0xFFFFFFFE, 0xFFFFFFFF)
MULTICAST = "239.255.0.1"
SESSION = 150  # datagrams from one participant


def fragments(data, rng):
    """Turns a DATA submessage into one DATA_FRAG, with numbers that may be wrong."""
    flags = data[1]
    if data[0] != DATA or not flags & 1 or len(data) < 28:
        return data
    size = rng.choice((1, 4, 16, 64, 1024, 0xFFFF, rng.randrange(0x10000)))
    number = rng.choice((0, 1, 1, 2, 3, rng.choice(WORDS)))
    count = rng.choice((0, 1, 1, 2, 0xFFFF))
    whole = rng.choice((0, 1, len(data) - 24, 100000, 0x7FFFFFFF, 0xFFFFFFFF))
    body = data[4:24] + struct.pack("<IHHI", number & 0xFFFFFFFF, count, size, whole) + data[24:]
    kept = flags & 0x03 | (0x04 if flags & 0x08 else 0)
    return bytes((DATA_FRAG, kept)) + struct.pack("<H", len(body) & 0xFFFF) + body


def of_bytes(datagram, rng):
    """Changes random bytes, often those of lengths and counts."""
    changed = bytearray(datagram)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        at = rng.randrange(min(4, len(changed) - 1), len(changed)) if rng.random() < 0.02 else \
            rng.randrange(HEADER, len(changed))
        way = rng.randrange(4)
        if way == 0:
            changed[at] ^= 1 << rng.randrange(8)
        elif way == 1:
            changed[at] = rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
        elif way == 2:
            at &= ~1
            changed[at:at + 2] = struct.pack(rng.choice("<<<>") + "H", rng.choice(WORDS) & 0xFFFF)
        else:
            at &= ~3
            changed[at:at + 4] = struct.pack(rng.choice("<<<>") + "I", rng.choice(WORDS))
    return bytes(changed)


def of_parts(datagram, other, rng):
    """Drops, repeats, exchanges or fragments submessages, or inserts one of another datagram."""
    parts, others = submessages(datagram), submessages(other)
    at = rng.randrange(1, len(parts)) if len(parts) > 1 else 1
    way = rng.randrange(7)
    if way == 0 and len(parts) > 2:
        del parts[at]
    elif way == 1:
        parts.insert(at, rng.choice(others[1:] or parts[1:] or [b""]))
    elif way == 2:
        parts[at:at] = [rng.choice(parts[1:] or [b""])] * rng.choice((1, 2, 40))
    elif way == 3 and len(parts) > 1:
        parts[at] = fragments(parts[at], rng)
    elif way == 4 and len(parts) > 1 and len(parts[at]) >= 4:
        parts[at] = bytes((rng.choice(KINDS), parts[at][1] ^ (1 << rng.randrange(8)))) + parts[at][2:]
    elif way == 5 and len(parts) > 1 and len(parts[at]) >= 4:
        # Its length field is wrong, and the next submessage is where the field says.
        parts[at] = parts[at][:2] + struct.pack("<H", rng.choice(WORDS) & 0xFFFF) + parts[at][4:]
    else:
        return datagram[:rng.randrange(HEADER, len(datagram))]
    return b"".join(parts)


class Session:
    """A participant that does not exist."""

    def __init__(self, datagrams, old_target, number, rng):
        self.datagrams, self.old_target, self.rng = datagrams, old_target, rng
        self.own = own_of(datagrams)
        self.prefix = struct.pack(">III", 0x01100000 | number & 0xFFFFF, rng.getrandbits(32), rng.getrandbits(32))

    def next(self, step, port, target):
        rng = self.rng
        datagram = self.datagrams[step % len(self.datagrams)]
        if rng.random() < 0.7 and step >= 4:
            other = rng.choice(self.datagrams)
            for _ in range(rng.choice((1, 1, 2))):
                datagram = of_bytes(datagram, rng) if rng.random() < 0.6 else of_parts(datagram, other, rng)
                if len(datagram) <= HEADER:
                    break
        datagram = datagram.replace(self.own, self.prefix).replace(self.old_target, target)
        return from_port(datagram, port)[:DATAGRAM_MAX]  # no other process receives it


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", required=True)
    parser.add_argument("--world", required=True)
    parser.add_argument("--capture", required=True)
    parser.add_argument("--packets", type=int, required=True)
    parser.add_argument("--rate", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    return parser.parse_args()


def keep_last(folder, number, last):
    with open(os.path.join(folder, f"death-{number}"), "wb") as file:
        for datagram in last:
            file.write(struct.pack("<H", len(datagram)) + datagram)


def main():
    options = parse_arguments()
    datagrams = captured(options.capture)
    old_target = target_of(datagrams)
    rng = random.Random(options.seed)
    out = own_socket()
    port = out.getsockname()[1]
    reporter = Reporter(options.bin, options.world)
    if not reporter.find(10):
        sys.exit("the world has no reporter")
    target, last, session = old_target, collections.deque(maxlen=400), None
    begun = time.monotonic()
    for sent in range(options.packets):
        if sent % SESSION == 0:
            session = Session(datagrams, old_target, sent // SESSION, rng)
        if sent % 50 == 0:
            target = heard_prefix(out, target)
            if not reporter.alive():
                if options.keep:
                    keep_last(options.keep, reporter.restarts + 1, last)
                if not reporter.find(30):
                    print(json.dumps({"packets": sent, "gone": True}))
                    sys.exit(1)
            ahead = sent / options.rate - (time.monotonic() - begun)
            if ahead > 0:
                time.sleep(ahead)
        datagram = session.next(sent % SESSION, port, target)
        last.append(datagram)
        to = rng.choice(reporter.ports)
        group = to < reporter.ports[0] + 2 and rng.random() < 0.5  # the first two sockets are the group's
        try:
            out.sendto(datagram, (MULTICAST if group else "127.0.0.1", to))
        except OSError:
            pass  # the reporter's socket is full or closed
    time.sleep(0.2)
    if not reporter.alive() and not reporter.find(30):
        print(json.dumps({"packets": options.packets, "gone": True}))
        sys.exit(1)
    print(json.dumps({"packets": options.packets, "seconds": round(time.monotonic() - begun, 1),
                      "restarts": reporter.restarts, "dropped": reporter.dropped()}))


main()
