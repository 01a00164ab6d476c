#!/usr/bin/env python3
"""Sends Entity States of a crowd, or junk, to a gateway.

usage: dis_crowd.py HOST:PORT ENTITIES RATE_HZ SECONDS [moving|resting|junk]

ENTITIES vehicles of site 9, application 1 stand or drive on a grid around the middle of the square of
Fort Hunter Liggett, and each is sent RATE_HZ times a second. junk: ENTITIES * RATE_HZ datagrams a
second of random octets, of which some look like the beginning of a PDU."""
import math
import random
import socket
import struct
import sys
import time

A, F = 6378137.0, 1 / 298.257223563
E2 = F * (2 - F)
LAT, LON, UNDULATION = math.radians(35.95), math.radians(-121.25), -33.7
SIN, COS = math.sin(LAT), math.cos(LAT)
SINL, COSL = math.sin(LON), math.cos(LON)
EAST = (-SINL, COSL, 0.0)
NORTH = (-SIN * COSL, -SIN * SINL, COS)
UP = (COS * COSL, COS * SINL, SIN)


def ecef(x, y, z):
    """Of a place east, up and south of the middle [m]."""
    n = A / math.sqrt(1 - E2 * SIN * SIN)
    origin = ((n + UNDULATION) * COS * COSL, (n + UNDULATION) * COS * SINL, (n * (1 - E2) + UNDULATION) * SIN)
    return [o + x * e - z * n + y * u for o, e, n, u in zip(origin, EAST, NORTH, UP)]


def state(entity, place, velocity):
    """An Entity State of version 7, 144 octets: a tank."""
    moves = any(velocity)
    return struct.pack(
        ">BBBBIHBB HHH BB BBHBBBB BBHBBBB 3f 3d 3f I B15x 3f 3f B11s I",
        7, 1, 1, 1, 0, 144, 0, 0, 9, 1, entity, 2, 0, 1, 1, 222, 1, 2, 1, 0, 1, 1, 222, 1, 2, 1, 0,
        *velocity, *place, 1.025380936, -0.943350461, math.pi, 0, 2 if moves else 1,
        0, 0, 0, 0, 0, 0, 1, b"CROWD", 0)


def junk(rng):
    kind = rng.randrange(4)
    if kind == 0:
        return rng.randbytes(rng.randrange(200))
    good = bytearray(state(1 + rng.randrange(9), ecef(0, 300, 0), (0, 0, 0)))
    for _ in range(1 + rng.randrange(20)):
        good[rng.randrange(len(good))] = rng.randrange(256)
    good[1] = 1
    return bytes(good[: rng.randrange(len(good))] if kind == 1 else good)


def main():
    host, port = sys.argv[1].split(":")
    entities, hz, seconds = int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    how = sys.argv[5] if len(sys.argv) > 5 else "resting"
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.connect((host, int(port)))
    side = math.ceil(math.sqrt(entities))
    speed = 5.0 if how == "moving" else 0.0
    velocity = [speed * e for e in EAST]
    rng = random.Random(1)
    spare = [junk(rng) for _ in range(2000)] if how == "junk" else None
    begun = time.monotonic()
    sent, rate = 0, entities * hz
    while (now := time.monotonic() - begun) < seconds:
        due = int(now * rate)
        for n in range(sent, due):
            if spare:
                data = spare[n % len(spare)]
            else:
                i = n % entities
                x, z = 18.0 * (i % side - side / 2), 18.0 * (i // side - side / 2)
                data = state(i + 1, ecef(x + speed * now, 300.0, z), velocity)
            try:
                out.send(data)
            except ConnectionRefusedError:
                pass
        sent = due
        time.sleep(0.002)
    print(sent)


if __name__ == "__main__":
    main()
