"""Compares two worlds that run in one exercise: where each shows the vehicles of the other, and where those are.

usage: exercise_compare.py JOLON-WORLD WORLD:SITE WORLD:SITE SECONDS DELAY-MS

It waits until each world has the vehicles of the other, and then dumps both at the same time, again and again. An error is allowed
that is the threshold of 1 m, and what the vehicle drives in the delay: that of the network, of a pass of the gateway (50 ms), of two
frames, and half of the time that the dumps took. A vehicle that the other world does not have counts as an error. Prints the errors,
and exits with 1 if in one of the worlds more than 1 % of the places of all vehicles, or of those that move, are further off."""
import json
import math
import subprocess
import sys
import time

THRESHOLD_M, PASS_S, FRAME_S, SETTLE_S = 1.0, 0.05, 1 / 60, 8


def dump(program, worlds):
    """Returns the rows of all worlds, and the time that it took."""
    begun = time.monotonic()
    running = [subprocess.Popen([program, "dump", "--world", world, "--json"], stdout=subprocess.PIPE, text=True) for world in worlds]
    texts = [process.communicate()[0] for process in running]
    took_s = time.monotonic() - begun
    if any(process.returncode for process in running):
        sys.exit("a world cannot be dumped")
    return [[json.loads(line) for line in text.splitlines()] for text in texts], took_s


def own(rows, site):
    return {f"{site}:{1 + (row['id'] - 1) // 65533}:{1 + (row['id'] - 1) % 65533}": row for row in rows
            if "remote" not in row and row["behaviour"] != "flight"}


def shown(rows):
    return {row["remote"]: row for row in rows if "remote" in row and row["behaviour"] != "flight"}


def main():
    program, seconds, delay_s = sys.argv[1], float(sys.argv[4]), float(sys.argv[5]) / 1000
    worlds, sites = zip(*(word.rsplit(":", 1) for word in sys.argv[2:4]))
    limit = time.monotonic() + 30
    while True:
        rows, _ = dump(program, worlds)
        missing = sum(len(own(rows[i], sites[i]).keys() - shown(rows[1 - i]).keys()) for i in (0, 1))
        if missing == 0 or time.monotonic() > limit:
            break
        time.sleep(0.2)
    time.sleep(SETTLE_S)
    found, unknown, took = {i: [] for i in (0, 1)}, [0, 0], []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rows, took_s = dump(program, worlds)
        took.append(took_s)
        for i in (0, 1):
            there = shown(rows[1 - i])
            for name, row in own(rows[i], sites[i]).items():
                speed = math.hypot(*row["velocity"])
                allowed = THRESHOLD_M + speed * (delay_s + PASS_S + 2 * FRAME_S + took_s / 2)
                unknown[i] += name not in there
                error = math.dist(row["position"], there[name]["position"]) if name in there else math.inf
                found[i].append((error - allowed, error, allowed, speed, row["kind"], name))
        time.sleep(0.2)
    good = True
    for i in (0, 1):
        for what, of in (("all", found[i]), ("moving", [place for place in found[i] if place[3] > 0.1])):
            of.sort()
            late = sum(place[0] > 0 for place in of)
            p99 = sorted(place[1] for place in of)[len(of) * 99 // 100]
            print(f"vehicles of {worlds[i]}, {what}: {len(of)} places, {late / len(of):.2%} further off than allowed; "
                  f"p50 {sorted(place[1] for place in of)[len(of) // 2]:.2f} m, p99 {p99:.2f} m; by the most: {of[-1][1]:.1f} m of {of[-1][2]:.1f} "
                  f"({of[-1][4]} {of[-1][5]} at {of[-1][3]:.0f} m/s)")
            good = good and len(of) > 500 and late <= len(of) / 100
    print(f"{unknown[0]} and {unknown[1]} places unknown; the dumps took {1000 * sum(took) / len(took):.0f} ms")
    sys.exit(not good)


if __name__ == "__main__":
    main()
