"""Compares the statistics that a driver sees with the table of a paused world. usage: seen.py LINES TABLE ID"""
import json
import sys

lines, table, wanted = sys.argv[1:]
row = [e for e in map(json.loads, open(table)) if e["id"] == int(wanted)][0]
last = [line for line in open(lines) if line.startswith("frame=") and " speed_mps=" in line][-1]
shown = dict(word.split("=", 1) for word in last.split())
row["altitude_m"], row["fuel_l"], row["x_m"], row["z_m"] = row["position"][1], row["fuel"], row["position"][0], row["position"][2]
bad = []
for key in ("kind", "name", "force", "state", "damage", "gear"):
    if shown[key] != str(row[key]):
        bad.append(f"{key}: {shown[key]} is not {row[key]}")
for key in ("speed_mps", "heading_deg", "pitch_deg", "roll_deg", "altitude_m", "turret_deg", "gun_deg", "rounds", "fuel_l",
            "reload_s", "x_m", "z_m"):
    if abs(float(shown[key]) - float(row[key])) > 0.006:
        bad.append(f"{key}: {shown[key]} is not {row[key]}")
if float(shown["fuel_l"]) == 0 or int(shown["rounds"]) == 0:
    bad.append("fuel or rounds are zero")
sys.exit("\n".join(bad) or 0)
