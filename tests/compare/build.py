"""One built tree of Jolon: its programs, and their results in a comparable form."""
import ctypes
import ctypes.util
import json
import os
import re
import signal
import subprocess
import time

HERE = os.path.dirname(os.path.abspath(__file__))
# JSON members whose values come from the clock, from chance or from the system.
BY_CHANCE = {"made", "run", "source", "pid", "check", "restarts", "late_frames", "rate_hz", "wall_s",
             "token", "key", "roles", "layout", "gaps"}

xxhash = ctypes.CDLL(ctypes.util.find_library("xxhash"))
xxhash.XXH3_64bits.restype = ctypes.c_uint64
xxhash.XXH3_64bits.argtypes = [ctypes.c_char_p, ctypes.c_size_t]


def line_of_log(record):
    """Returns a record as a line of a log with its checksum (docs/events.md)."""
    text = json.dumps(record, separators=(",", ":"))[:-1]
    return '%s,"check":"%016x"}\n' % (text, xxhash.XXH3_64bits(text.encode(), len(text)))


def scrub(value, also=()):
    """Returns a JSON value without the values from chance and the clock."""
    if isinstance(value, dict):
        return {key: scrub(one, also) for key, one in value.items()
                if key not in BY_CHANCE and key not in also and not key.endswith("_ms")}
    return [scrub(one, also) for one in value] if isinstance(value, list) else value


def scrub_lines(text, also=()):
    """Scrubs JSON lines and leaves other lines unchanged."""
    lines = []
    for line in text.splitlines():
        try:
            lines.append(json.dumps(scrub(json.loads(line), also)))
        except ValueError:
            lines.append(line)
    return "\n".join(lines)


class Build:
    def __init__(self, label, tree, work, domain):
        self.label, self.tree, self.domain = label, os.path.realpath(tree), domain
        self.bin = self.tree + "/build/bin"
        self.work = work + "/" + label
        os.makedirs(self.work)
        self.runtime = self.work + "/run"
        os.mkdir(self.runtime, 0o700)
        self.environment = {"PATH": os.environ["PATH"], "HOME": self.work, "LC_ALL": "C",
                            "JOLON_RUNTIME_DIR": self.runtime, "JOLON_HANG_MS": "5000"}
        self.kinds = sorted(name[:-4] for name in os.listdir(self.tree + "/config/kinds"))
        self.started, self.layouts = [], set()
        self.scenarios = work + "/scenarios"

    def scenario(self, name):
        """Returns a path that is the same for both builds, because a world's hash includes it."""
        own = "%s/%s.cfg" % (HERE, name)
        return own if os.path.exists(own) else "%s/%s.cfg" % (self.scenarios, name)

    def data(self):
        """Returns the files of config/ that programs read, by kind and name."""
        found, root = {}, self.tree + "/config/"
        for folder, _, names in os.walk(root):
            for path in (folder + "/" + name for name in names if not name.endswith((".c", ".h"))):
                found["config", path[len(root):].lstrip("/")] = read(path)
        return found

    def mask(self, text):
        # The scenarios of this tool are in one of the two trees or in a third.
        return text.replace(self.work, "WORK").replace(HERE, "SCENARIOS").replace(self.tree, "TREE")

    def start(self, program, *arguments, **options):
        """Starts a process whose working folder is the tree. It dies with this process."""
        process = subprocess.Popen([self.bin + "/" + program, *map(str, arguments)], cwd=self.tree,
                                   env=self.environment, **options)
        self.started.append(process)
        return process

    def run(self, program, *arguments, timeout=120, given="", status=0):
        """Runs a program and returns its standard output. Another exit status is an error, unless
        status is None."""
        process = self.start(program, *arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True, errors="replace")
        try:
            out, err = process.communicate(given, timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            process.returncode = "killed after %d s" % timeout
        self.started.remove(process)
        if status is None:
            return self.mask("exit %s\n%s%s" % (process.returncode, out, err))
        if process.returncode != status:
            raise RuntimeError("%s: %s %s: exit %s: %s" % (
                self.label, program, " ".join(map(str, arguments)), process.returncode, err[-500:]))
        return out

    def world(self, *arguments, **options):
        return self.run("jolon-world", *arguments, **options)

    def stop(self, process, name):
        process.terminate()
        try:
            status = process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            status = process.wait()
        self.started.remove(process)
        if status not in (0, -signal.SIGTERM):
            raise RuntimeError("%s: %s ended with %s" % (self.label, name, status))

    def begin(self, name, path, seen, *made_of):
        """Makes a world and lets the recorder write the beginning of its log of commands to path.
        Calls seen, if given, while the world exists. Returns the first line."""
        self.world("create", "--world", name, *made_of)
        recorder = self.start("jolon-recorder", "--world", name, "--commands", path)
        wait_for(lambda: os.path.exists(path) and b"\n" in read(path), "a log of commands")
        if seen:
            seen()
        self.stop(recorder, "jolon-recorder")
        self.world("remove", "--world", name)
        return read(path).decode().splitlines(True)[0]

    def masked_log(self, path, also=()):
        """Returns a log of commands without the parts that differ between runs: checksums, the world's
        number, the senders' keys, the tree's path, and marks, whose times come from the clock."""
        lines = scrub_lines(self.mask(read(path).decode()), also).splitlines()
        return "\n".join(line for line in lines if '"type": "mark"' not in line)

    def clean(self):
        """Ends all processes that still run and removes all remaining worlds."""
        for process in self.started:
            process.kill()
            process.wait()
        self.started = []
        for name in self.world("list", "all", status=None).split("\n")[1:]:
            if re.fullmatch(r"[\w-]+", name):
                self.run("jolon", "stop", "-w", name, status=None)
                self.world("remove", "--force", "--world", name, status=None)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def wait_for(condition, what, seconds=30):
    until = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > until:
            raise RuntimeError("no sign of %s within %d s" % (what, seconds))
        time.sleep(0.005)
