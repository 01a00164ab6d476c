#!/usr/bin/env python3
"""A bad network for datagrams of UDP: loses, delays, reorders and repeats them, by a seed.

usage: relay.py --listen [ADDRESS:]PORT --to [ADDRESS:]PORT [--loss PERCENT] [--delay MS] [--jitter MS]
                [--twice PERCENT] [--seed N]

What comes to --listen goes to --to. Each datagram is lost with the probability --loss (default 5 %); what is left arrives after
--delay +- --jitter (default 100 +- 30 ms, evenly spread), so that datagrams overtake each other; --twice of them (default 1 %)
arrive a second time, after a delay of their own. What happens to datagram n is a function of the seed and of n alone.
SIGINT and SIGTERM end it; it delivers what is on its way and prints what it did as one object of JSON.

netem of Linux does the same, but not every kernel has it, and none of it has a seed."""
import argparse
import heapq
import json
import random
import select
import signal
import socket
import time

BYTES_MAX = 65536
BUFFER = 4 * 1024 * 1024


def address(text):
    host, _, port = text.rpartition(":")
    return host or "127.0.0.1", int(port)


def fate(number, options):
    """Returns the delays [s] of the copies of datagram `number` that arrive."""
    chance = random.Random(options.seed * 1000003 + number)
    lost, twice = chance.random() * 100 < options.loss, chance.random() * 100 < options.twice
    delays = [(options.delay + chance.uniform(-1, 1) * options.jitter) / 1000 for _ in range(2)]
    return [] if lost else delays if twice else delays[:1]


class Relay:
    def __init__(self, options):
        self.options = options
        self.ear = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.ear.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.ear.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        self.ear.bind(address(options.listen))
        self.ear.setblocking(False)
        self.mouth = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.target = address(options.to)
        self.waiting = []  # a heap: time of arrival, number, bytes
        self.done = {"came": 0, "lost": 0, "twice": 0, "sent": 0, "overtook": 0, "refused": 0}
        self.last = -1  # the highest number that was sent

    def take(self):
        """Takes every datagram that has come."""
        while True:
            try:
                data = self.ear.recv(BYTES_MAX)
            except BlockingIOError:
                return
            number, now = self.done["came"], time.monotonic()
            delays = fate(number, self.options)
            self.done["came"] += 1
            self.done["lost"] += not delays
            self.done["twice"] += len(delays) == 2
            for copy, delay in enumerate(delays):
                heapq.heappush(self.waiting, (now + delay, number, copy, data))

    def deliver(self):
        """Sends what is due. Returns the time until the next [s], None when nothing waits."""
        while self.waiting:
            left = self.waiting[0][0] - time.monotonic()
            if left > 0:
                return left
            _, number, _, data = heapq.heappop(self.waiting)
            try:
                self.mouth.sendto(data, self.target)
                self.done["sent"] += 1
            except OSError:  # nobody receives
                self.done["refused"] += 1
            self.done["overtook"] += number < self.last
            self.last = max(self.last, number)
        return None

    def run(self, stopping):
        while not stopping or self.waiting:
            left = self.deliver()
            if stopping:
                time.sleep(left or 0)
            elif select.select([self.ear], [], [], 0.05 if left is None else min(left, 0.05))[0]:
                self.take()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--listen", required=True)
    parser.add_argument("--to", required=True)
    parser.add_argument("--loss", type=float, default=5)
    parser.add_argument("--delay", type=float, default=100)
    parser.add_argument("--jitter", type=float, default=30)
    parser.add_argument("--twice", type=float, default=1)
    parser.add_argument("--seed", type=int, default=1991)
    relay, stopping = Relay(parser.parse_args()), []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopping.append(True))
    relay.run(stopping)
    print(json.dumps(relay.done))


if __name__ == "__main__":
    main()
