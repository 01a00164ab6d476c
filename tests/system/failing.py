#!/usr/bin/env python3
"""Runs programs whose nth call fails, for test_failing.sh and in its folder. Prints TAP."""
import os
import random
import re
import shutil
import signal
import subprocess
import time

bin_dir, name = os.environ["BIN"], os.environ["NAME"]
samples = int(os.environ["SAMPLES"])
rng = random.Random(int(os.environ["SEED"]))
names = os.environ["JOLON_RUNTIME_DIR"]
os.makedirs(names, 0o700, exist_ok=True)
shm = f"/dev/shm/jolon.{os.getuid()}.{name}.{0:032x}"
number = 0

HANGS = 1000  # instead of an exit code

# A refusal begins with the program's name. A role that has started writes warnings in its log.
BEGINS = re.compile(r"jolon-|[0-9.]+ [a-z]+ warning frame [0-9]+: ")


def program(what, *args):
    return [f"{bin_dir}/jolon-{what}", *args]


world = lambda verb, *args: program("world", verb, "--world", name, *args)


def leftovers():
    """Returns the world's files: object, name, lock."""
    prefix = shm[: shm.rindex(".")]
    objects = (f"/dev/shm/{entry}" for entry in os.listdir("/dev/shm"))
    return sorted(path for path in objects if path.startswith(prefix)) + sorted(
        f"{names}/{entry}" for entry in os.listdir(names) if entry.split(".")[0] == name
    )


def said(stderr):
    """Returns a program's messages without the line in which a role says that it has started."""
    return [line for line in stderr.decode(errors="replace").splitlines() if " info frame " not in line]


def remove():
    for entry in leftovers():
        os.remove(entry)


def restore():
    """Restores the world as it was made."""
    remove()
    shutil.copyfile("pristine", shm)
    os.chmod(shm, 0o600)
    os.symlink(shm, f"{names}/{name}")
    open(f"{names}/{name}.lock", "a").close()
    os.chmod(f"{names}/{name}.lock", 0o600)


def finished(process):
    """Waits for the end of a process. Returns its output, or None and how it stands when it hangs: in 600 looks,
    a tenth of a second apart, it sleeps, or it has not ended after 6,000. Looks are counted instead of seconds
    because the machine can stop for a minute, or have no time for the process."""
    sleeps = 0
    for _ in range(6000):
        try:
            return process.communicate(timeout=0.1), ""
        except subprocess.TimeoutExpired:
            with open(f"/proc/{process.pid}/stat") as stat:
                fields = stat.read().rsplit(")", 1)[1].split()
            sleeps += fields[0] == "S"
            if sleeps >= 600:
                break
    process.kill()
    process.communicate()
    return None, f"state {fields[0]}, slept in {sleeps} looks, {fields[11]} and {fields[12]} ticks"


class Case:
    """A program to test: `before` prepares each run, `peer` runs beside it, `finish` waits and stops it."""

    def __init__(self, command, before=restore, peer=None, same_output=True, keeps_world=True, finish=None):
        self.command, self.before, self.peer = command, before, peer
        self.same_output, self.keeps_world, self.finish = same_output, keeps_world, finish

    def run(self, fail):
        self.before()
        if os.path.exists("mark"):
            os.remove("mark")
        environment = dict(os.environ, LD_PRELOAD=os.environ["FAILING"], FAIL_CALL=fail, FAIL_MARK="mark")
        peer = subprocess.Popen(self.peer, stderr=subprocess.DEVNULL) if self.peer else None
        child = subprocess.Popen(self.command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            if self.finish:
                self.finish(child)
            output, stands = finished(child)
        finally:
            for process in (child, peer):
                if process and process.poll() is None:
                    process.kill()
                    process.wait()
        if not output:
            return HANGS, b"", [stands]
        return child.returncode, output[0], said(output[1])


def judge(case, fail, right):
    """Runs once. Returns the fault, or None, and whether the failing call was reached."""
    code, out, lines = case.run(fail)
    with open("mark", "rb") as mark:
        where = mark.read().strip(b"\0").decode(errors="replace")
    reached = where != ""
    wrong = None
    if code == 0:
        if case.same_output and out != right:
            wrong = "ends with 0 but with other output"
    elif code != 1:
        wrong = "hangs" if code == HANGS else f"ends with {code}"
    elif len(lines) != 1:
        wrong = f"writes {len(lines)} lines"
    elif not BEGINS.match(lines[0]):
        wrong = "writes a line that does not begin with its name"
    if not wrong and code == 1 and not case.keeps_world and leftovers():
        wrong = f"leaves {leftovers()}"
    return (f"{fail} at {where or 'no call'}: {wrong}: {lines}" if wrong else None), reached


def count_calls(case, kind):
    """Estimates the number of calls of a class, to a factor of two."""
    high = 1
    while judge(case, f"{kind}:{high}", None)[1]:
        high *= 2
    return high


def last_call(case, kind):
    """Returns the number of the last call of a class."""
    low, high = 0, count_calls(case, kind)
    while low + 1 < high:
        middle = (low + high) // 2
        low, high = (middle, high) if judge(case, f"{kind}:{middle}", None)[1] else (low, middle)
    return low


def check(what, case, kinds, at_end=()):
    """Tries a sample of a class's calls. Of the classes in at_end it also tries the last 24 with all later ones:
    what a program made by then it must remove without the calls that fail."""
    global number
    if os.environ.get("ONLY", what) not in what:
        return
    problems, tries = [], 0
    code, right, lines = case.run("none:1")
    if code != 0:
        problems.append(f"without failing calls it ends with {code}: {lines}")
    for kind in kinds if not problems else []:
        end = count_calls(case, kind)
        if kind in at_end:
            last = last_call(case, kind)
            late = range(max(1, last - 23), last + 1)
            problems += filter(None, (judge(case, f"{kind}:{n}+", right)[0] for n in late))
            tries += len(late)
        numbers = list(range(1, min(end, samples) + 1))
        if end > samples:
            numbers += sorted(rng.randint(samples + 1, end) for _ in range(samples))
        for n in numbers:
            more = rng.choice(("", "+"))  # that call alone, or it and all later ones
            problem, reached = judge(case, f"{kind}:{n}{more}", right)
            tries += 1
            if problem:
                problems.append(problem)
            if not reached and n <= samples:
                break
    number += 1
    print(f"{'not ok' if problems else 'ok'} {number} - {what}: {tries} failing runs")
    for problem in problems[:6]:
        print(f"  {problem}"[:600])


def until_logged(child):
    """The recorder never ends by itself. Stops it when its log is complete, or after 5 s."""
    until = time.monotonic() + 5
    while child.poll() is None and log_lines() < logged and time.monotonic() < until:
        time.sleep(0.01)
    if child.poll() is None:
        child.send_signal(signal.SIGTERM)


def log_lines():
    return open("log", "rb").read().count(b"\n") if os.path.exists("log") else 0


def no_log():
    restore()
    for log in ("log", "commands"):
        if os.path.exists(log):
            os.remove(log)


everything = ["malloc", "mmap", "open", "read", "lock", "fallocate", "semaphore", "rename", "thread"]
attaching = ["malloc", "mmap", "open", "lock"]
stage = attaching + ["thread"]
create = world("create", "--set", "world.frames=12", "good.cfg")
check("create", Case(create, before=remove, keeps_world=False), everything, at_end=("open",))

remove()
subprocess.run(create, check=True, stdout=subprocess.DEVNULL)
shutil.copyfile(f"{names}/{name}", "pristine")
collider, mover = program("collider", "--world", name), program("mover", "--world", name)
threads = ["--threads", "3"]
check("mover", Case(mover + threads, peer=collider), stage)
check("collider", Case(collider + threads, peer=mover), stage)

restore()
peer = subprocess.Popen(collider, stderr=subprocess.DEVNULL)
subprocess.run(mover, check=True, stderr=subprocess.DEVNULL)
peer.wait()
shutil.copyfile(f"{names}/{name}", "pristine")
for verb in (["check"], ["repair"], ["info", "--json"], ["digest"], ["dump"], ["dump", "--json"],
             ["dump", "--fixed", "--json"], ["events"], ["events", "--json"]):
    check(" ".join(verb), Case(world(*verb)), attaching)
logged = len(subprocess.run(world("events", "--json"), capture_output=True).stdout.splitlines())
recorder = program("recorder", "--world", name, "--commands", "commands", "--events", "log")
check("recorder", Case(recorder, before=no_log, finish=until_logged), attaching + ["read"])
check("remove", Case(world("remove")), attaching)
remove()
