"""Parses RTPS datagrams, and finds where a world's reporter listens."""
import os
import re
import socket
import struct
import subprocess
import sys
import time

HEADER = 20  # bytes of a message's header: "RTPS", version, vendor, sender's prefix
INFO_TS, INFO_DST, DATA = 0x09, 0x0E, 0x15
DATAGRAM_MAX = 60000


def captured(path):
    with open(path, "rb") as file:
        data = file.read()
    at, datagrams = 0, []
    while at + 2 <= len(data):
        length = struct.unpack_from("<H", data, at)[0]
        datagrams.append(data[at + 2:at + 2 + length])
        at += 2 + length
    return [d for d in datagrams if d[:4] == b"RTPS" and len(d) > HEADER]


def submessages(datagram):
    """Splits a datagram into its header and its submessages."""
    parts, at = [datagram[:HEADER]], HEADER
    while at + 4 <= len(datagram):
        order = "<" if datagram[at + 1] & 1 else ">"
        length = struct.unpack_from(order + "H", datagram, at + 2)[0]
        end = at + 4 + length if length or datagram[at] in (0x01, INFO_TS) else len(datagram)
        parts.append(datagram[at:min(end, len(datagram))])
        at = end
    return parts


def own_socket():
    """Returns a loopback socket that can also send to the discovery group."""
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.bind(("127.0.0.1", 0))
    out.setblocking(False)
    out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
    return out


def heard_prefix(sock, prefix):
    """Reads all received datagrams. Returns the prefix of the last sender, or the given prefix."""
    try:
        while True:
            heard = sock.recv(65536)
            if heard[:4] == b"RTPS":
                prefix = heard[8:20]
    except OSError:
        return prefix


def own_of(datagrams):
    """Returns the sender's prefix."""
    return datagrams[0][8:20]


def target_of(datagrams):
    """Returns the receiver's prefix."""
    for datagram in datagrams:
        if datagram[HEADER] == INFO_DST and len(datagram) >= HEADER + 16:
            return datagram[HEADER + 4:HEADER + 16]
    sys.exit("the captured datagrams name no receiver")


def from_port(datagram, port):
    """Replaces the ports of the announced unicast addresses."""
    return re.sub(rb"([\x31\x32]\0\x18\0\x01\0\0\0)....", lambda found: found.group(1) + struct.pack("<I", port),
                  datagram, flags=re.DOTALL)


class Reporter:
    """A reporter's process, ports and prefix."""

    def __init__(self, bin_dir, world):
        self.command = [os.path.join(bin_dir, "jolon-world"), "pid", "--world", world, "reporter"]
        self.pid, self.restarts, self.ports, self.prefix = 0, -1, [], b"\0" * 12

    def alive(self):
        return self.pid and os.path.exists(f"/proc/{self.pid}")

    def find(self, limit_s):
        """Finds a new reporter process. Returns False when there is none within limit_s."""
        until = time.monotonic() + limit_s
        while time.monotonic() < until:
            told = subprocess.run(self.command, capture_output=True, text=True).stdout.strip()
            if told.isdigit() and int(told) and int(told) != self.pid:
                ports = self.open_ports(int(told))
                if len(ports) >= 3:
                    self.pid, self.ports, self.restarts = int(told), ports, self.restarts + 1
                    return True
            time.sleep(0.02)
        return False

    def dropped(self):
        """Returns the number of datagrams that its full sockets dropped."""
        with open("/proc/net/udp", encoding="ascii") as table:
            rows = [line.split() for line in table][1:]
        return sum(int(row[12]) for row in rows if int(row[1].split(":")[1], 16) in self.ports)

    @staticmethod
    def open_ports(pid):
        """Returns a process's ports that are open on all addresses. Its sending socket is bound to one."""
        inodes = set()
        try:
            for fd in os.listdir(f"/proc/{pid}/fd"):
                target = os.readlink(f"/proc/{pid}/fd/{fd}")
                inodes.update(re.findall(r"socket:\[(\d+)\]", target))
        except OSError:
            return []
        with open("/proc/net/udp", encoding="ascii") as table:
            rows = [line.split() for line in table][1:]
        return sorted(int(row[1].split(":")[1], 16) for row in rows
                      if row[9] in inodes and row[1].startswith("00000000:"))
