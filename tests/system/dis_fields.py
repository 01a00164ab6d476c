"""Sends PDUs of random fields by jolon dis send and compares what another program reads from them, field by field.

usage: dis_fields.py JOLON-DIS tshark|FOLDER-OF-OPEN-DIS SEED    prints how many fields are equal; exit 1 on any other"""
import json
import math
import os
import random
import struct
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

TYPES = ("entity-state fire detonation collision collision-elastic create-entity remove-entity start-resume stop-freeze "
         "acknowledge").split()
ROUNDS = 3


def f32(value):
    return struct.unpack(">f", struct.pack(">f", value))[0]


def draw(form, name, rng):
    """Returns the words of a value of a form, and the numbers that a reader shows for it."""
    if form == "0..255":
        number = rng.randrange(256) if name != "character_set" else 1
        return str(number), [number]
    if form.startswith("0..65535"):
        number = rng.randrange(65536)
        return str(number), [number]
    if form.startswith("0..4294967295"):
        number = rng.randrange(1 << 32)
        return hex(number), [number]
    if form.startswith("SITE"):
        numbers = [rng.randrange(1, 65534) for _ in range(3)]
        return ":".join(map(str, numbers)), numbers
    if form.startswith("KIND"):
        numbers = [rng.randrange(65536) if i == 2 else rng.randrange(256) for i in range(7)]
        numbers[0] |= 16  # of kinds that it knows, such as life forms, tshark shows the bits of the appearance, too
        return ".".join(map(str, numbers)), numbers
    if form == "HOURS:UNITS":
        numbers = [rng.randrange(600000), rng.randrange(1 << 32)]  # tshark has 32 bits for seconds
        return ":".join(map(str, numbers)), numbers
    if form.startswith("at most 11"):
        text = "".join(rng.choice("ABCdef 0123-_<&") for _ in range(rng.randrange(1, 11))).strip() or "A"
        return text, [text]
    count = {"NUMBER": 1, "X,Y,Z": 3}.get(form, 6)
    if name == "location":
        numbers = [rng.uniform(-6.4e6, 6.4e6) for _ in range(count)]
    elif name == "orientation":
        numbers = [f32(rng.uniform(-math.pi, math.pi)) for _ in range(count)]
    else:
        numbers = [f32(rng.uniform(-1e3, 1e3)) for _ in range(count)]
    return ",".join(repr(number) for number in numbers), numbers


def make(tool, kind, version, rng, path):
    """Writes a capture with one PDU. Returns [name, numbers] of each field, in the order of the wire."""
    told = subprocess.run([tool, "send", "--fields", kind], capture_output=True, text=True, check=True).stdout
    fields, words = [], []
    for line in told.splitlines():
        name, form = line.split("=", 1)
        if name in ("place", "attitude", "turret", "gun"):
            continue
        text, numbers = draw(form, name, rng)
        words.append(f"{name}={text}")
        fields.append([name, numbers])
    if os.path.exists(path):
        os.remove(path)
    subprocess.run([tool, "send", "--file", path, "--version", str(version), "--exercise", "9", "--timestamp", "1234.5",
                    kind, *words], check=True)
    return fields


def close(is_, right):
    if isinstance(right, str):
        return is_ == right
    if isinstance(right, int):
        return int(is_) % (1 << 32) == right  # open-dis has signed numbers of 32 bits
    # tshark shows six digits of single floats and fifteen of double ones.
    # tshark cuts times to milliseconds: those of the clock, which are above 1e7 s here, and those of simulations.
    return abs(float(is_) - right) <= (2e-3 if abs(right) > 1e7 else 1e-3 if abs(right) > 1e5 else 1e-5 * max(1.0, abs(right)))


def compare(what, got, fields):
    right = [(name, number) for name, numbers in fields for number in numbers]
    if len(got) != len(right):
        sys.exit(f"{what}: {len(got)} fields instead of {len(right)}: {got}")
    for (name, number), is_ in zip(right, got):
        if not close(is_, number):
            sys.exit(f"{what}: {name} is {is_} instead of {number}")
    return len(right)


def leaves_of_tshark(paths):
    """Reads all captures by one run of tshark. Returns the fields of each."""
    parts = []
    for path in paths:
        with open(path, "rb") as capture:
            parts.append(capture.read())
    with open("all.pcap", "wb") as merged:
        merged.write(parts[0][:24] + b"".join(part[24:] for part in parts))
    done = subprocess.run(["tshark", "-r", "all.pcap", "-d", "udp.port==3000,dis", "-T", "pdml"], capture_output=True,
                          check=True)
    if b"_ws.malformed" in done.stdout:
        sys.exit("a PDU is malformed for tshark")
    for protocol in ElementTree.fromstring(done.stdout).iterfind(".//proto[@name='dis']"):
        leaves = []
        for field in protocol.iter("field"):
            name = field.get("name")
            if name.startswith("dis.") and not name.startswith("dis.pdustatus") and \
                    name not in ("dis.padding", "dis.pdu_status", "dis.num_articulation_params"):
                leaves.append((name, field))
        yield leaves


def number_of(name, field):
    """Returns what tshark shows; integers from the octets, because some are shown as names."""
    if name in ("dis.entity_marking",):
        return field.get("show")
    show = field.get("show")
    try:
        return float(show) if "." in show or "e" in show else int(show, 0)
    except ValueError:
        return int(field.get("value"), 16)


def by_tshark(leaves, kind, version, fields):
    header = {name: number_of(name, field) for name, field in leaves[:6]}
    wanted = {"dis.proto_ver": version, "dis.exer_id": 9, "dis.timestamp": 1234.5}
    for name, right in wanted.items():
        if abs(header[name] - right) > 1e-5:
            sys.exit(f"{kind}: {name} is {header[name]} instead of {right}")
    if kind == "collision-elastic":  # tshark 4.0 shows the header of this type only
        return 3
    got = [number_of(name, field) for name, field in leaves[6:] if "other" not in name]
    units = [[name, [numbers[0] * 3600 + numbers[1] * 3600 / 2 ** 32]] if name.endswith("_time") else [name, numbers]
             for name, numbers in fields]
    return 3 + compare(f"tshark: {kind}, version {version}", got, units)


NODE = """
const dis = require(process.argv[2]), fs = require('fs');
const classes = {1: 'EntityState', 2: 'Fire', 3: 'Detonation', 4: 'Collision', 11: 'CreateEntity', 12: 'RemoveEntity',
                 13: 'StartResume', 14: 'StopFreeze', 15: 'Acknowledge', 66: 'CollisionElastic'};
for (const path of process.argv.slice(3)) {
    const octets = fs.readFileSync(path).subarray(24 + 16 + 42);
    const copy = octets.buffer.slice(octets.byteOffset, octets.byteOffset + octets.length);
    const pdu = new dis[classes[octets[2]] + 'Pdu'](), out = new dis.OutputStream(new ArrayBuffer(8192));
    pdu.initFromBinary(new dis.InputStream(copy));
    pdu.encodeToBinary(out);
    const again = Buffer.from(out.binaryData).subarray(0, octets.length);
    console.log(JSON.stringify({pdu, octets: octets.toString('hex'), again: again.toString('hex')}));
}
"""


def leaves_of(value, name=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves_of(inner, key)
    elif name == "characters":
        yield name, bytes(value).split(b"\0")[0].decode()
    elif isinstance(value, list):
        pass
    else:
        yield name, value


def by_open_dis(folder, made):
    script = "open_dis.js"
    with open(script, "w", encoding="utf-8") as source:
        source.write(NODE)
    done = subprocess.run(["node", script, os.path.join(folder, "node_modules", "open-dis"), *(path for path, *_ in made)],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"open-dis: {done.stderr}")
    total = 0
    for line, (path, kind, version, fields) in zip(done.stdout.splitlines(), made):
        answer = json.loads(line)
        if answer["octets"] != answer["again"]:
            sys.exit(f"open-dis: {kind} encoded again differs:\n{answer['octets']}\n{answer['again']}")
        skipped = {"pad", "padding", "pad1", "pad2", "padding1", "numberOfArticulationParameters"}
        leaves = [value for name, value in list(leaves_of(answer["pdu"]))[7:] if name not in skipped]
        total += compare(f"open-dis: {kind}, version {version}", leaves, fields)
    return total


def main():
    tool, peer, seed = sys.argv[1:]
    rng = random.Random(int(seed))
    made = []
    for turn in range(ROUNDS):
        for kind in TYPES:
            for version in (6, 7):
                path = os.path.abspath(f"{kind}-{version}-{turn}.pcap")
                fields = make(tool, kind, version, rng, path)
                made.append((path, kind, version, fields))
    if peer == "tshark":
        total = sum(by_tshark(leaves, *each[1:]) for leaves, each in zip(leaves_of_tshark(each[0] for each in made), made))
    else:
        total = by_open_dis(peer, made)
    print(f"{total} fields of {len(made)} PDUs are equal; SEED={seed}")


if __name__ == "__main__":
    main()
