"""The texts of programs: help, usage, refusals, exit statuses, and strings in the binaries."""
import os
import re
import subprocess

# Scenario texts by name. Each must be refused with one line.
WRONG = {
    "no-syntax": "world = { seed = ; };", "no-key": "world = { sead = 1; };",
    "range": "world = { hz = 5000.0; };", "type": "world = { hz = \"fast\"; };",
    "choice": "collision = { method = \"guess\"; };", "include": "@include \"/etc/passwd\"",
    "kind": "vehicles = ( { kind = \"tonk\"; } );", "required": "vehicles = ( { count = 2; } );",
    "land-at-sea": "vehicles = ( { kind = \"tank\"; at = [1000.0, 30000.0]; } );",
    "ship-on-land": "vehicles = ( { kind = \"ship\"; at = [28000.0, 20000.0]; } );",
    "too-many": "world = { capacity = 16; }; vehicles = ( { kind = \"tank\"; count = 17; } );",
    "twice": "vehicles = ( { kind = \"tank\"; name = \"A\"; at = [28000.0, 20000.0]; }, "
             "{ kind = \"tank\"; name = \"A\"; at = [28050.0, 20000.0]; } );",
    "no-script": "vehicles = ( { kind = \"tank\"; script = \"none\"; } );",
    "no-shooter": "fires = ( { at_s = 1.0; shooter = \"Nobody\"; point = [1.0, 1.0]; } );",
    "no-road": "terrain = { source = \"flat\"; }; vehicles = ( { kind = \"tank\"; roads = true; "
               "route = ( [1.0, 1.0], [2.0, 2.0] ); } );",
    "too-fast": "scripts = ( { name = \"s\"; steps = ( { at_s = 1.0; arrive = [25000.0, 25000.0]; }, "
                "{ at_s = 2.0; arrive = [29000.0, 25000.0]; } ); } ); terrain = { source = \"flat\"; }; "
                "vehicles = ( { kind = \"tank\"; script = \"s\"; } );",
    "depth": "a = ( ( ( ( ( ( ( ( ( ( 1 ) ) ) ) ) ) ) ) ) );",
    "two-bases": "bases = ( { force = \"red\"; at = [1.0, 1.0]; }, { force = \"red\"; at = [2.0, 2.0]; } );",
    "figure8-order": "collision = { figure8 = { damage_low = 0.5; damage_med = 0.3; }; };",
    "renderer": "renderer = { view = \"sideways\"; };",
}
PATHS = re.compile(r"(?:[\w.-]+/)*[\w-]+\.(?:c|h|cpp|idl)\b(?::\d+)?")
# Programs that wait for a world that does not exist, or need none.
WAITING = {"jolon-console", "jolon-harness", "jolon-keeper", "jolon-monitor", "jolon-bench", "jolon"}
VERBS = ("run start stop status restart kill drive console harness monitor ctl snap events replay diff "
         "video world worlds clean help version").split()
WORLD_VERBS = ("create check repair info status summary digest dump events replay diff list paths remove "
               "sweep pid frame save replay-frame").split()


def programs(build):
    return sorted(os.listdir(build.bin))


def help_texts(build):
    found = {("help", "programs"): "\n".join(programs(build))}

    def say(*words):
        text = build.run(*words, status=None, timeout=20)
        found["help", " ".join(words)] = re.sub(r"\b[0-9a-f]{32}\b", "OBJECT", text)
    for program in programs(build):
        for option in ("--help", "-h", "--no-such-option"):
            say(program, option)
        if program not in WAITING:
            say(program, "--world", "no-such-world")
            say(program, "--world", "no/such/name")
    for verb in VERBS:
        say("jolon", "help", verb)
        say("jolon", verb, "--help")
        say("jolon", verb, "--no-such-option")
    for verb in WORLD_VERBS:
        say("jolon-world", verb, "--help")
        say("jolon-world", verb, "--world", "no-such-world")
    for words in ("jolon", "jolon stat", "jolon run --frames x", "jolon run --threads 99",
                  "jolon run --without mover", "jolon run no-such-scenario", "jolon start --seed x",
                  "jolon kill nobody", "jolon-bench help", "jolon-bench nothing", "jolon-world nothing",
                  "jolon-world digest --world no-such-world", "jolon-ctl drive", "jolon-ctl step x",
                  "jolon-ctl spwan tank", "jolon-ctl -w no-such-world pause",
                  "jolon-renderer --size 1x1", "jolon-renderer --view sideways --out x",
                  "jolon-renderer --snap x.png -w no-such-world", "jolon-renderer --list-devices",
                  "jolon-video no-such.log x.png", "jolon-video no-such.log x.gif",
                  "jolon-recorder --commands /dev/null -w no-such-world", "jolon-mover --threads 17",
                  "jolon-monitor --filter speed>", "jolon-reporter --domain 999",
                  "jolon-console --port 99999", "jolon-world create --set x=1 duel",
                  "jolon-world create --set world.hz=0 config/scenarios/duel.cfg",
                  "jolon-world create --from no-such.image", "jolon-world replay no-such.log",
                  "jolon-world diff no-such.log no-such.image"):
        say(*words.split())
    return found


def refusals(shared):
    """Returns an experiment: every wrong scenario is refused."""
    def refuse(build):
        found = {}
        for name, text in WRONG.items():
            path = "%s/wrong-%s.cfg" % (shared, name)
            if not os.path.exists(path):
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text + "\n")
            found["help", "scenario " + name] = build.world("check", path, status=None)
        return found
    return refuse


def strings(build, program):
    """Returns the strings of a program's data, with FILE instead of paths of source files. Code and
    debug data are left out."""
    path = "%s/%s" % (build.bin, program)
    if not open(path, "rb").read(4) == b"\x7fELF":
        return set(open(path, encoding="utf-8").read().splitlines())
    data = "%s/%s.data" % (build.work, program)
    subprocess.run(["objcopy", "-O", "binary", "--only-section=.rodata", path, data], check=True)
    text = subprocess.run(["strings", "-n", "6", data], check=True, capture_output=True).stdout
    os.unlink(data)
    lines = text.decode(errors="replace").splitlines()
    return {PATHS.sub("FILE", line) for line in lines if re.search(r"[A-Za-z]{3}", line)}


def strings_differ(old, new):
    """Returns lines with the strings that only one build has."""
    lines = []
    for program in programs(old):
        if program not in programs(new):
            lines.append("%s: the new build has none" % program)
            continue
        before, after = strings(old, program), strings(new, program)
        lines += ["%s - %s" % (program, one) for one in sorted(before - after)]
        lines += ["%s + %s" % (program, one) for one in sorted(after - before)]
    return lines
