"""Prints a place east and south of the middle of Fort Hunter Liggett's square as `jolon dis send` takes it, or a direction in ECEF.

usage: dis_place.py X Z HEIGHT            latitude,longitude,height above the ellipsoid; HEIGHT [m] is above the sea
       dis_place.py --direction X Z UP    x,y,z"""
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import dis_crowd  # noqa: E402


def geodetic(place):
    x, y, z = place
    level, longitude = math.hypot(x, y), math.atan2(y, x)
    latitude = math.atan2(z, level * (1 - dis_crowd.E2))
    for _ in range(10):
        normal = dis_crowd.A / math.sqrt(1 - dis_crowd.E2 * math.sin(latitude) ** 2)
        latitude = math.atan2(z + dis_crowd.E2 * normal * math.sin(latitude), level)
    return math.degrees(latitude), math.degrees(longitude), level / math.cos(latitude) - normal


def main():
    if sys.argv[1] == "--direction":
        x, z, up = map(float, sys.argv[2:])
        print(",".join(f"{x * e - z * n + up * u:.6f}" for e, n, u in zip(dis_crowd.EAST, dis_crowd.NORTH, dis_crowd.UP)))
        return
    x, z, height = map(float, sys.argv[1:])
    print("{:.9f},{:.9f},{:.4f}".format(*geodetic(dis_crowd.ecef(x, height, z))))


if __name__ == "__main__":
    main()
