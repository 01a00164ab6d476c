"""Drives as a person at a terminal: jolon drive on a pty. usage: driver.py JOLON WORLD; exit code 1 with a message."""
import fcntl
import json
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time

jolon, world = sys.argv[1:]
shown = b""


def tank():
    lines = subprocess.run([jolon, "world", "dump", "--json", "-w", world], capture_output=True).stdout.splitlines()
    return [e for e in map(json.loads, lines) if e["id"] == 1][0]


def wait(what, condition, keys=b""):
    """Reads the screen and presses keys repeatedly until the condition holds."""
    global shown
    until = time.monotonic() + 15
    while time.monotonic() < until:
        if keys:
            os.write(terminal, keys)
        for _ in range(4):
            if select.select([terminal], [], [], 0.05)[0]:
                try:
                    shown += os.read(terminal, 65536)
                except OSError:  # the program has ended
                    time.sleep(0.01)
        if condition():
            return
    sys.exit(f"{what} was not reached; the screen: {shown[-2000:]!r}")


def start(*arguments):
    """Starts jolon drive on a new terminal."""
    global shown
    shown = b""
    child, terminal = pty.fork()
    if child == 0:
        os.environ["TERM"] = "xterm"
        os.execv(jolon, [jolon, "drive", *arguments, "-w", world])
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    return child, terminal


def end(child):
    """Waits for the program's end and checks that the terminal was restored. Returns the status."""
    global shown
    until = time.monotonic() + 10
    while time.monotonic() < until:
        if select.select([terminal], [], [], 0.05)[0]:
            try:
                shown += os.read(terminal, 65536)
            except OSError:  # no process has the terminal open any more
                pass
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            if b"\033[<u" not in shown or b"\033[?1049l" not in shown:
                sys.exit(f"the terminal was not restored: {shown[-300:]!r}")
            return status
    sys.exit("jolon drive does not end")


child, terminal = start("T1")
wait("the wheel", lambda: b"you drive T1 (tank 1)" in shown)
os.write(terminal, b"h")
wait("the help, without a broken word",
     lambda: b"map nearer, wider" in shown and (b"daemon" not in shown or b"answer" in shown))
os.write(terminal, b"h")
if termios.tcgetattr(terminal)[3] & termios.ECHO:
    sys.exit("the terminal echoes keys")
before = tank()
wait("speed", lambda: tank()["speed_mps"] > 2, b"w")
wait("a new place", lambda: abs(tank()["position"][0] - before["position"][0]) > 2)
wait("another heading", lambda: abs(tank()["heading_deg"] - before["heading_deg"]) > 3, b"d")
wait("a target", lambda: b"target: Far (truck 2)" in shown, b"t")
wait("a shot", lambda: tank()["rounds"] < before["rounds"], b" ")
wait("standing still", lambda: tank()["speed_mps"] < 0.5, b"b")
os.write(terminal, b"q")
if end(child) != 0:
    sys.exit("q does not end with 0")

child, terminal = start("T1")
wait("the wheel again", lambda: b"you drive T1 (tank 1)" in shown)
os.kill(child, signal.SIGABRT)
if os.WTERMSIG(end(child)) != signal.SIGABRT:
    sys.exit("the status hides a crash")

# A notice that is longer than the screen is wide takes two rows.
spawned = subprocess.run([jolon, "ctl", "--json", "spawn", "jeep", "--at", "3000,3000", "-w", world], capture_output=True)
jeep = str(json.loads(spawned.stdout)["entity"])
child, terminal = start(jeep)
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 60, 0, 0))
wait("the wheel on a narrow screen", lambda: b"you drive" in shown)
subprocess.run([jolon, "ctl", "remove", jeep, "-w", world], capture_output=True)
wait("every word about its loss", lambda: b"its force" in shown)
os.write(terminal, b"q")
end(child)
