"""Types a document's commands into a terminal, as a reader would. usage: typist.py DOCUMENT TRANSCRIPT

Each line of the document's ```sh blocks is typed into an interactive bash, in order, in the current
folder, and must end with status 0. The comment after a command names exceptions:
"q leaves" and "Ctrl-C ends it" are typed after three seconds, and a command that "is refused" must end with
status 1. A block after the words "Save this as `FILE`:" is saved as FILE.
Prints a TAP line for each command, without a number: "ok COMMAND" or "not ok COMMAND".
TRANSCRIPT receives everything that the terminal showed.
"""
import os
import pty
import re
import select
import signal
import sys
import time

PROMPT = re.compile(rb"<status (\d+)>$")
CONTROL = re.compile(rb"\x1b[\[(][0-9;?]*[A-Za-z]|[\x00-\x09\x0b-\x1f]")
LONGEST_S = 240  # for one command
NOT_ENDED = "the command did not end, so the next one could not be typed"


class Terminal:
    def __init__(self, transcript):
        self.pid, self.descriptor = pty.fork()
        if self.pid == 0:
            os.environ.update(PS1="<status $?>", PS2="", TERM="xterm", HISTFILE="/dev/null")
            os.environ.pop("PROMPT_COMMAND", None)
            os.execvp("bash", ["bash", "--norc", "--noprofile", "--noediting", "-i"])
        self.said = b""
        self.transcript = open(transcript, "wb")

    def read(self, seconds):
        """Reads the output of that time. Returns False when the shell has ended."""
        if select.select([self.descriptor], [], [], seconds)[0]:
            try:
                came = os.read(self.descriptor, 65536)
            except OSError:
                return False
            self.said += came
            self.transcript.write(came)
        return True

    def status(self, seconds):
        """Waits for the next prompt. Returns the status of the typed command, or None if none came in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = PROMPT.search(self.said)
            if found:
                return int(found.group(1))
            if not self.read(0.1):
                return None
        return None

    def type(self, text):
        self.said = b""
        os.write(self.descriptor, text.encode())

    def close(self):
        os.kill(self.pid, signal.SIGHUP)
        os.close(self.descriptor)
        os.waitpid(self.pid, 0)
        self.transcript.close()


def blocks(document):
    """Yields (language, text before it, lines) for every fenced block."""
    with open(document, encoding="utf-8") as file:
        parts = re.split(r"^```(.*)$", file.read(), flags=re.MULTILINE)
    for before, language, inside in zip(parts[0::4], parts[1::4], parts[2::4]):
        yield language.strip(), before, inside.strip("\n").splitlines()


def follow(terminal, command):
    """Types a command and the keys that its comment names. Returns what is wrong, or None."""
    comment = command.partition(" # ")[2]
    terminal.type(command + "\n")
    keys = {"q leaves": "q", "Ctrl-C ends it": "\x03"}
    pressed = [keys[words] for words in keys if words in comment]
    if pressed:
        if terminal.status(3) is not None:
            return "the command ended before a key was pressed"
        terminal.said = b""
        os.write(terminal.descriptor, pressed[0].encode())
    status = terminal.status(LONGEST_S)
    if status is None:
        return NOT_ENDED
    wanted = [1] if "is refused" in comment else [0]
    if "\x03" in pressed:
        wanted += [128 + signal.SIGINT]
    return None if status in wanted else f"status {status}"


def main():
    terminal = Terminal(sys.argv[2])
    terminal.status(10)
    good = True
    for language, before, lines in blocks(sys.argv[1]):
        saved = re.search(r"Save this as `([\w.]+)`:\s*$", before)
        if saved:
            with open(saved.group(1), "w", encoding="utf-8") as file:
                file.write("\n".join(lines) + "\n")
        for command in lines if language == "sh" else []:
            wrong = follow(terminal, command)
            print(f"{'not ok' if wrong else 'ok'} {command}", flush=True)
            if wrong:
                print(f"# {wrong}")
                for line in CONTROL.sub(b"", terminal.said).decode(errors="replace").splitlines()[-15:]:
                    print("#", line[:160])
            if wrong == NOT_ENDED:
                terminal.close()
                return
    terminal.close()


main()
