"""The cases of tests/compare-builds: scenarios, settings, commands, pictures. They are fixed, so both
builds run the same. Together they use every kind, method, response, behaviour and command."""
import random
from dataclasses import dataclass, field

# The numbers of command types in a log of commands (docs/replay.md).
CODES = {"pause": 1, "resume": 2, "step": 3, "scale": 4, "drive": 5, "release": 6, "fire": 7,
         "spawn": 8, "remove": 9, "quit": 10, "unheard-of": 77}


@dataclass
class Command:
    """One command and the frame that applies it. A kind is given by name; the log holds its number."""
    frame: int
    name: str
    entity: int = 0
    target: int = 0
    amount: int = 0
    kind: str = ""
    force: int = 0
    value: tuple = (0, 0, 0, 0, 0, 0)
    source: int = 1
    ring: str = "clients"


@dataclass
class Case:
    name: str
    scenario: str  # NAME.cfg beside this file, otherwise in config/scenarios
    frames: int
    sets: tuple = ()
    threads: int = 1
    commands: list = field(default_factory=list)
    pictures: tuple = ()  # options of jolon-video, one string for each picture
    dump: bool = False  # compares ground, fixed objects and vehicles of frame 0 too



# --- commands -------------------------------------------------------------------------------------


def driving():
    """Returns every command at least once, accepted and refused, for the vehicles of proving-ground."""
    drive = [Command(10 + 20 * n, "drive", entity=5 + n % 9, amount=(0, 90, 30)[n % 3], force=n % 4,
                     source=1 + n % 2, value=(1 - 0.2 * n, 0.15 * n - 0.5, 0.3, 0.5, -0.4, n // 7))
             for n in range(9)]
    return drive + [
        Command(12, "fire", entity=5, target=15), Command(40, "fire", entity=5, target=15),
        Command(55, "fire", entity=8), Command(57, "fire", entity=8, source=9),
        Command(60, "fire", kind="bomb", value=(24930, 25010, 0, 0, 0, 0)),
        Command(61, "fire", kind="tree", value=(24930, 25010, 0, 0, 0, 0)),
        Command(62, "fire", kind="shell", value=(-1, 25010, 0, 0, 0, 0)),
        Command(63, "fire", entity=4000), Command(63, "fire", entity=5, target=5),
        Command(70, "spawn", kind="tank", force=1, amount=2, value=(25010, 24950, 0, 1, 5, 0)),
        Command(70, "spawn", kind="jet", force=2, amount=1, value=(25000, 25500, 200, 3, 120, 0)),
        Command(70, "spawn", kind="helicopter", force=2, amount=2, value=(25050, 25400, 0, 0, 0, 0)),
        Command(71, "spawn", kind="ship", value=(25000, 25500, 0, 0, 0, 0)),
        Command(71, "spawn", kind="bomb", value=(25000, 25500, 0, 0, 0, 0)),
        *[Command(72, "spawn", kind="jeep", value=(24850 + n, 25000, 0, 0, 0, 0)) for n in range(12)],
        Command(80, "release", entity=6, source=9), Command(81, "release", entity=6, amount=1, source=9),
        Command(82, "release", entity=6), Command(90, "remove", entity=9), Command(91, "remove", entity=9),
        Command(92, "step", amount=5), Command(93, "scale", value=(2.5, 0, 0, 0, 0, 0)),
        Command(94, "scale", value=(0, 0, 0, 0, 0, 0)), Command(95, "unheard-of"),
        Command(96, "drive", entity=5, value=(7, 0, 0, 0, 0, 0)),
        Command(100, "pause"), Command(101, "step", amount=20), Command(121, "resume"),
        Command(130, "pause", ring="recorder"), Command(131, "resume", ring="recorder"),
        Command(300, "quit")]


def storm(seed, frames, entities, middle, kinds=("tank", "jeep", "truck", "helicopter")):
    """Returns random commands at a place, some of them invalid."""
    chance = random.Random(seed)
    given = []
    for frame in range(2, frames):
        for _ in range(chance.choice((0, 0, 0, 1, 2))):
            name = chance.choice(("drive", "drive", "drive", "fire", "fire", "fire", "spawn",
                                  "release", "remove"))
            x, z = (middle[i] + chance.uniform(-400, 400) for i in range(2))
            command = Command(frame, name, entity=chance.randrange(1, entities),
                              source=chance.randrange(1, 5))
            if name == "drive":
                command.value = tuple(round(chance.uniform(-1, 1), 3) for _ in range(5)) + (0,)
                command.force, command.amount = chance.randrange(4), chance.choice((0, 60, 200))
            elif name == "fire" and chance.random() < 0.3:
                command.entity, command.kind = 0, chance.choice(("bomb", "artillery", "shell"))
                command.value = (x, z, 0, 0, 0, 0)
            elif name == "fire" and chance.random() < 0.5:
                command.target = chance.randrange(1, entities)
            elif name == "spawn":
                command.kind, command.force = chance.choice(kinds), chance.randrange(3)
                command.amount = chance.randrange(3)
                command.value = (x, z, 50, chance.uniform(-3, 3), chance.uniform(0, 20), 0)
            elif name == "release":
                command.amount = chance.randrange(2)
            given.append(command)
    return given


# --- cases ----------------------------------------------------------------------------------------

CHASE, INSIDE, ORBIT = "--view chase", "--view inside", "--view orbit"
OVERHEAD, MAP = "--view overhead", "--view map"
COAST = "--view free --eye 6300,28500,80 --look 332,-6"
BRUSH = "--view free --eye 9000,12000,14 --look 298,-3"

FIGURES = ("figure-a2-imminent", "figure-a3-broadside", "figure-a4-tree-imminent",
           "figure-a5-tree-slow", "figure-a6-tree-fast", "figure-a7-tower-imminent",
           "figure-a8-tower-slow", "figure-a9-tower-fast", "jeep-over-bush", "tank-into-house",
           "tank-over-trees", "tanks-glancing", "truck-against-house")


def response(name):
    return "collision.response=" + name


def method(name):
    return "collision.method=" + name


SPHERE = "collision.shape=sphere"

CASES = [
    # The shipped scenarios.
    Case("default", "hunter-liggett", 1200, dump=True,
         pictures=(CHASE, INSIDE, OVERHEAD, MAP, COAST, BRUSH)),
    Case("default-2-threads", "hunter-liggett", 600, ("world.seed=7",), threads=2, dump=True,
         pictures=(CHASE, ORBIT)),
    Case("default-largest-seed", "hunter-liggett", 300, ("world.seed=9007199254740991",), dump=True),
    Case("default-20-hz", "hunter-liggett", 400, ("world.hz=20",)),
    Case("default-figure8", "hunter-liggett", 600, (method("npsnet2"), response("figure8"), SPHERE)),
    Case("crowd", "crowd", 12, threads=2),
    Case("duel", "duel", 900, pictures=(CHASE, INSIDE)),
    Case("effects", "effects", 1100, pictures=(CHASE, ORBIT + " --vehicle 11")),
    Case("parade", "parade", 120, dump=True,
         pictures=("--view free --eye 24998,25030,8 --look 3,-9 --size 960x540", MAP)),
    Case("rehearsal", "rehearsal", 9000, pictures=(CHASE, MAP)),
    Case("proving-ground", "proving-ground", 1200, pictures=(CHASE,)),
    *[Case(name, name, 260, pictures=(CHASE,)) for name in FIGURES],
    # Methods, responses, shapes.
    *[Case("method-" + name, "close", 180, (method(name),)) for name in
      ("swept", "npsnet2", "mps", "occupancy", "hopcroft")],
    Case("method-brute", "close", 60, (method("brute"),)),
    Case("method-npsnet2-or", "close", 180,
         (method("npsnet2"), "collision.npsnet2.nearness=or", SPHERE)),
    *[Case("response-" + name, "close", 240, (response(name),)) for name in
      ("figure8", "spring", "mps", "none")],
    Case("response-240-hz", "close", 400, (response("spring"), "world.hz=240"), threads=2),
    Case("close", "close", 900, pictures=(CHASE, OVERHEAD)),
    Case("close-sphere", "close", 240, (SPHERE,), threads=2),
    Case("flat-spring", "flat", 400, (response("spring"), SPHERE)),
    Case("flat-mps", "flat", 300, (method("mps"), response("mps"), "collision.mps.near_m=25")),
    Case("ram", "ram", 300, pictures=(OVERHEAD,)),
    Case("ram-spring", "ram", 300, (response("spring"),)),
    Case("ram-figure8", "ram", 300, (response("figure8"), "terrain.height_m=0")),
    Case("ram-mass", "ram", 300, (response("figure8"), "collision.figure8.measure=mass")),
    # Agents at war, formations, scripts.
    Case("war", "war", 2400, threads=2, dump=True, pictures=(CHASE, MAP)),
    Case("war-other-seed", "war", 1200, ("world.seed=99", response("figure8"))),
    Case("columns", "columns", 2400, dump=True, pictures=(CHASE + " --vehicle raid-1",)),
    Case("spread", "spread", 60, threads=2),
    Case("spread-occupancy", "spread", 20, (method("occupancy"),)),
    Case("empty", "empty", 10, dump=True, pictures=(BRUSH,)),
    # Commands.
    Case("driving", "proving-ground", 400, commands=driving(), pictures=(CHASE,)),
    Case("storm-close", "close", 600, commands=storm(1, 580, 380, (28400, 20000))),
    Case("storm-flat", "flat", 900, commands=storm(2, 880, 300, (25000, 25000)), threads=2),
    Case("storm-default", "hunter-liggett", 600, commands=storm(3, 580, 520, (28500, 20300))),
    Case("storm-full-table", "ram", 400, ("world.capacity=24",),
         commands=storm(4, 380, 40, (25000, 25000))),
]
