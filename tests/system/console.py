"""Tests a console as its client. usage: console.py URL WORLD. Prints "ok WHAT" or "not ok WHAT" for each check."""
import concurrent.futures
import http.client
import json
import math
import sys
import time

address, token = sys.argv[1].split("#token=")
host = address.rstrip("/").split("//")[1]
name, port = host.split(":")


def ask(path, body=None, key=None, method=None, **headers):
    """Sends a request. Returns the status and the body, decoded if it is JSON."""
    link = http.client.HTTPConnection(name, int(port), timeout=10)
    if body is not None:
        headers = {"Content-Type": "application/json", "Authorization": "Bearer " + token, **headers}
        body = body if isinstance(body, bytes) else json.dumps(body).encode()
    if key:
        headers["X-Jolon-Player"] = key
    headers = {name.replace("_", "-"): value for name, value in headers.items() if value is not None}
    link.request(method or ("GET" if body is None else "POST"), path, body, headers)
    answer = link.getresponse()
    data = answer.read()
    link.close()
    is_json = answer.getheader("Content-Type") == "application/json"
    return answer.status, json.loads(data) if is_json and data else data


def order(key=None, **body):
    return ask("/api/command", body, key)


def state(query="most=0", key=None):
    return ask("/api/state?" + query, key=key)[1]


def check(what, good, why=""):
    print(("ok " if good else "not ok ") + what + ("" if good else f" # {why}"), flush=True)


def eventually(condition, seconds=10):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False


def renderer():
    return next(role for role in ask("/api/processes")[1] if role["role"] == "renderer")


def reading():
    status, page = ask("/")
    check("the page is served", status == 200 and b"<html" in page)
    status, world = ask("/api/world")
    check("the world is described", status == 200 and world["world"] == sys.argv[2] and
          any(kind["name"] == "tank" and kind["turret"] for kind in world["kinds"]), world)
    check("the world has the objectives of its battle", {"name", "x0", "z0", "x1", "z1"} <= set(world["objectives"][0]) and
          {one["name"] for one in world["objectives"]} == set(state("most=1")["battle"]["objectives"]), world["objectives"])
    now = state("most=100")
    check("the state has entities and counts the others", 50 <= len(now["entities"]) <= 100 and
          now["left_out"] == now["vehicles"] + now["munitions"] - len(now["entities"]), now["left_out"])
    x, z = now["entities"][0][6:8]
    near = state(f"area={x - 50},{z - 50},{x + 50},{z + 50}")
    check("an area contains the entities inside it",
          0 < len(near["entities"]) and all(abs(e[6] - x) < 51 and abs(e[7] - z) < 51 for e in near["entities"]))
    rows = ask("/api/list?kind=tank&force=blue&sort=name&most=500")[1]
    names = [row["name"] for row in rows["rows"]]
    check("the list is filtered and sorted", rows["total"] == len(names) > 5 and
          names == sorted(names, key=lambda n: (n == "", n)) and all(row["force"] == "blue" for row in rows["rows"]))
    page = ask("/api/list?kind=tank&force=blue&sort=name&from=3&most=2")[1]["rows"]
    check("pages of the list are parts of it", [row["name"] for row in page] == names[3:5], page)
    found = ask("/api/list?search=" + names[2].upper())[1]["rows"]
    check("a name is found regardless of case", names[2] in [row["name"] for row in found], names[2])
    wrong = ["/api/state?most=x", "/api/state?area=1,2,3", "/api/state?me=-1", "/api/list?sort=colour",
             "/api/list?force=green", "/api/list?kind=tnak", "/api/list?from=10001", "/api/events?types=birth",
             "/api/events?after=-1", "/api/picture?view=a/b"]
    answers = [ask(path) for path in wrong]
    check("wrong queries are refused with the reason", all(status == 400 and text["error"] and text["next"]
                                                      for status, text in answers), answers)
    check("an unknown path is answered with 404", ask("/etc/passwd")[0] == 404 and ask("/../main.c")[0] == 404)


def reckoned(told, time_s):
    """Returns where an entity is at a time that was told with its motion (docs/console.md)."""
    x, z, heading = told[6:9]
    at_s, vx, vz, turn, gain, lasts = (told[13:] + [0] * 6)[:6]
    after = max(time_s - at_s, 0)
    turning = min(after, lasts)
    forward = vx * math.sin(heading) - vz * math.cos(heading)
    right = vx * math.cos(heading) + vz * math.sin(heading)
    for i in range(100):  # in small steps, unlike the page
        angle = heading + turn * turning * (i + 0.5) / 100
        along = forward + gain * turning * (i + 0.5) / 100
        x += (along * math.sin(angle) + right * math.cos(angle)) * turning / 100
        z += (right * math.sin(angle) - along * math.cos(angle)) * turning / 100
    heading, forward, after = heading + turn * turning, forward + gain * turning, after - turning
    return (x + (forward * math.sin(heading) + right * math.cos(heading)) * after,
            z + (right * math.sin(heading) - forward * math.cos(heading)) * after)


def motions():
    """Follows the motions of all entities, and compares them with where they are."""
    first = state("most=20000&since=0&stride=0")
    check("a first answer with motions is whole", first["whole"] and len(first["entities"]) >= 500 and
          "gone" not in first, len(first["entities"]))
    told = {one[12]: one for one in first["entities"]}
    frame, sizes, compared, off, wholes, unknown = first["frame"], [], 0, [], 0, 0
    for _ in range(40):
        time.sleep(0.12)
        now = state(f"most=20000&since={frame}&stride={first['stride']}")
        exact = state("most=20000")  # of the same copy of the world, unless that is 0.1 s old by now
        for row in now["gone"]:
            told.pop(row, None)
        told.update((one[12], one) for one in now["entities"])
        frame = now["frame"]
        sizes.append(len(now["entities"]))
        wholes += now["whole"]
        if exact["frame"] != frame:
            continue
        compared += 1
        unknown += len({one[0] for one in told.values()} ^ {one[0] for one in exact["entities"]})
        places = {one[0]: one[6:8] for one in exact["entities"]}
        off += [math.dist(reckoned(one, now["time_s"]), places[one[0]]) for one in told.values() if one[0] in places]
    check("answers with since are not whole", wholes == 0, wholes)
    check("all entities are known by their motions", unknown == 0, unknown)
    check("motions and places were compared", compared >= 5, compared)
    check("who follows the motions has each entity where it is", max(off) < 0.5, max(off))
    check("most entities go on as they were told", sum(sizes) < 0.4 * len(sizes) * len(told), sizes)
    check("another stride is answered whole", state(f"most=100&since={frame}&stride=1")["whole"])
    check("a frame that is to come is answered whole", state(f"most=20000&since={frame + 100000}&stride=1")["whole"])
    x, z = next(iter(told.values()))[6:8]
    area = f"area={x - 50},{z - 50},{x + 50},{z + 50}"
    near = state(f"most=20000&stride=1&since={state('most=0')['frame']}&{area}")
    check("a small area is told only its own motions", all(abs(one[6] - x) < 60 and abs(one[7] - z) < 60 for one in near["entities"]))
    check("a wrong frame is refused", ask("/api/state?since=-1")[0] == 400)


def playing():
    status, ann = ask("/api/join", {"name": "Ann"})
    check("a player joins", status == 200 and len(ann["key"]) == 32, ann)
    key, other = ann["key"], ask("/api/join", {"name": "Bob"})[1]["key"]
    tanks = [row["id"] for row in ask("/api/list?kind=tank&sort=damage&most=9")[1]["rows"]]
    tank = tanks[0]
    before = state(f"most=0&me={tank}")["me"]
    status, taken = order(key, do="drive", vehicle=tank, throttle=1, steer=0.2)
    check("a player takes a tank and receives the frame", status == 200 and taken["frame"] > 0, taken)
    check("the player drives the tank", eventually(lambda: abs((now := state(f"most=0&me={tank}", key)["me"])["x"] - before["x"]) +
                                  abs(now["z"] - before["z"]) > 2 and now["driver"] == "you"))
    status, said = order(other, do="drive", vehicle=tank)
    check("another player cannot drive it and is told who does", status == 409 and "Ann" in said["error"], said)
    check("another player cannot fire with it", order(other, do="fire", vehicle=tank)[0] == 409)
    check("other players see that the tank is driven", state(f"most=0&me={tank}", other)["me"]["driver"] == "another")
    ask("/api/state?most=0", key=key)
    place = ask("/api/events?most=1&types=fire")[1]["next"]
    fired = []

    def fire():  # refused while the gun loads: the agent may have fired just before
        fired[:] = order(key, do="fire")
        return fired[0] == 200

    eventually(fire, 15)
    fires = lambda: [e for e in ask(f"/api/events?after={place}&most=500&types=fire")[1]["events"] if tank in e["ids"]]
    check("the player fires, and the event is described in words",
          fired[0] == 200 and eventually(fires) and f"tank {tank} fired" in fires()[0]["text"], fired)
    ask("/api/state?most=0", key=key)
    status, said = order(key, do="drive", vehicle=tanks[1], throttle=1)
    check("the player changes the vehicle", status == 200 and
          eventually(lambda: state(f"most=0&me={tank}", key)["me"]["driver"] == ""), said)
    begun = time.time()
    gone = eventually(lambda: state(f"most=0&me={tanks[1]}")["me"]["driver"] == "", 5)
    check("a player who goes away loses the vehicle within two seconds", gone and time.time() - begun < 2.5, time.time() - begun)
    check("the player is told of the loss", "heard" in state(key=key)["you"]["lost"])
    check("a player without a vehicle cannot fire or release",
          order(key, do="fire")[0] == 409 and order(key, do="release")[0] == 409)
    order(key, do="drive", vehicle=tank)
    check("the player releases the vehicle", order(key, do="release")[0] == 200 and
          eventually(lambda: state(f"most=0&me={tank}")["me"]["driver"] == ""))
    begun = time.time()
    with concurrent.futures.ThreadPoolExecutor(24) as senders:
        answers = list(senders.map(lambda i: order(key, do="drive", vehicle=tanks[i % 2]), range(96)))
    check("drives of two vehicles at once are carried out or refused as too old, and none waits in vain",
          time.time() - begun < 3 and all(status == 200 or (status == 409 and "came before" in said["error"])
                                          for status, said in answers),
          [answer for answer in answers if answer[0] != 200][:3])
    order(key, do="release")
    named = next(row for row in ask("/api/list?kind=tank&force=blue&sort=damage&most=9")[1]["rows"] if row["name"])
    status, taken = order(key, do="drive", vehicle=named["name"])
    check("the player takes a vehicle by its name", status == 200 and taken["entity"] == named["id"], taken)
    order(key, do="release")
    status, said = order(key, do="drive", vehicle="Nobody")
    check("an unknown name is refused with the nearest name", status == 409 and "the nearest is" in said["error"], said)


def ruling():
    status, paused = order(do="pause")
    check("the console pauses the world", status == 200 and eventually(lambda: state()["paused"]))
    frame = state()["frame"]
    order(do="step", frames=5)
    check("the console steps the world", eventually(lambda: state()["frame"] >= frame + 5))
    check("the console resumes the world", order(do="resume")[0] == 200 and order(do="step")[0] == 409)
    check("the console scales time", order(do="scale", scale=2)[0] == 200 and
          eventually(lambda: state()["scale"] == 2) and order(do="scale", scale=1)[0] == 200)
    status, made = order(do="spawn", kind="tank", force="red", x=25000, z=24000)
    check("the console spawns a vehicle", status == 200 and state(f"most=0&me={made['entity']}")["frame"] and
          eventually(lambda: "me" in state(f"most=0&me={made['entity']}")), made)
    status, placed = order(do="spawn", kind="helicopter", force="red", at="10SFE5783079818", altitude_m=500)
    check("the console spawns at a place of the MGRS", status == 200, placed)
    order(do="remove", vehicle=placed.get("entity", 0))
    status, said = order(do="spawn", kind="tank", at="48.1N,11.5E")
    check("a place outside of the world is refused", status == 400 and "from the middle of the world" in said["error"], said)
    status, place = ask("/api/place?at=35.95N,121.25W")
    check("the console gives a place in all its forms", status == 200 and abs(place["x"] - 25000) < 0.02 and
          abs(place["z"] - 25000) < 0.02 and place["mgrs"] == "10SFE5783079818" and place["degrees"] == "35.950000N,121.250000W", place)
    status, said = ask("/api/place?at=here")
    check("what is no place is refused", status == 400 and "not a place" in said["error"], said)
    check("a vehicle's state has its place", "N," in state(f"most=0&me={made['entity']}")["me"]["degrees"])
    check("the console removes a vehicle once", order(do="remove", vehicle=made["entity"])[0] == 200 and
          order(do="remove", vehicle=made["entity"])[0] == 409)
    status, said = order(do="spawn", kind="tnak", x=1, z=1)
    check("an unknown kind is refused with the list of kinds", status == 409 and "tank" in said["next"], said)
    place = ask("/api/events?most=1&types=fire")[1]["next"]
    status, mission = order(do="mission", munition="artillery", x=1000, z=1000, rounds=3, every_s=0.1, radius_m=50, seed=7)
    sky = lambda: [e for e in ask(f"/api/events?after={place}&most=500&types=fire")[1]["events"] if "the sky" in e["text"]]
    check("the rounds of a fire mission are fired", status == 200 and mission["mission"] and mission["seed"] == 7 and eventually(lambda: len(sky()) >= 3), sky())
    mission = order(do="mission", munition="artillery", x=1000, z=1000, rounds=900, every_s=1)[1]["mission"]
    check("a fire mission is cancelled", order(do="cancel", mission=mission)[0] == 200 and
          eventually(lambda: not state()["missions"]) and
          order(do="cancel", mission=mission)[0] == 409)


def killing():
    pid = renderer()["pid"]
    status, said = ask("/api/process", {"do": "kill", "role": "renderer"})
    check("the console kills the renderer", status == 200 and said["pid"] == pid, said)
    check("the console shows the renderer's replacement", eventually(lambda: renderer()["pid"] not in (0, pid), 20), renderer())
    status, said = ask("/api/process", {"do": "restart", "role": "mover"})
    frame = state()["frame"]
    check("the console restarts the mover, and the world goes on", status == 200 and eventually(lambda: state()["frame"] > frame + 10))
    status, said = ask("/api/process", {"do": "kill", "role": "init"})
    check("an unknown role cannot be killed, and the roles are listed",
          status == 400 and "mover, collider," in str(said) and "renderer-4, console" in str(said), said)


def pictures():
    picture = lambda: ask("/api/picture?view=chase&size=320x180")
    if not eventually(lambda: picture()[0] == 200, 15):
        check("the console forwards pictures", False, picture())
        return
    status, data = picture()
    check("the console forwards pictures", data[:2] == b"\xff\xd8")
    pid = renderer()["pid"]
    ask("/api/process", {"do": "kill", "role": "renderer"})
    end = time.time() + 1
    seen = set()
    while time.time() < end:  # the next renderer may already listen
        seen.add(picture()[0])
        time.sleep(0.003)
    check("without a renderer a request is answered with 503 or waits for the next renderer", seen <= {200, 503}, seen)
    check("the next renderer's pictures are forwarded", eventually(lambda: picture()[0] == 200, 20) and
          renderer()["pid"] != pid)
    check("the console forwards a map", ask("/api/map?x=25000&z=25000&metres=4000&size=256x256")[0] == 200)


def refusals():
    before = state()["tally"]["commands"]
    good = {"do": "pause"}
    wrong = {
        "no token": (401, ask("/api/command", good, Authorization=None)),
        "another token": (401, ask("/api/command", good, Authorization="Bearer " + "0" * 32)),
        "a longer token": (401, ask("/api/command", good, Authorization="Bearer " + token + "0")),
        "no Bearer": (401, ask("/api/command", good, Authorization=token)),
        "another key": (401, ask("/api/command", good, key="0" * 32)),
        "another Host": (403, ask("/api/command", good, Host="evil.example")),
        "another Host of a query": (403, ask("/api/state", Host="evil.example:80")),
        "another Origin": (403, ask("/api/command", good, Origin="http://evil.example")),
        "the Origin null": (403, ask("/api/command", good, Origin="null")),
        "another port's Origin": (403, ask("/api/command", good, Origin="http://127.0.0.1:1")),
        "a cross-site page": (403, ask("/api/command", good, Sec_Fetch_Site="cross-site")),
        "a form": (415, ask("/api/command", good, Content_Type="text/plain")),
        "a large body": (413, ask("/api/command", b'{"do":"pause"' + b" " * 5000 + b"}")),
        "no JSON": (400, ask("/api/command", b"do=pause")),
        "an unknown command": (400, ask("/api/command", {"do": "quit"})),
        "a wrong value": (400, ask("/api/command", {"do": "scale", "scale": 1e9})),
        "a drive without a player": (403, ask("/api/command", {"do": "drive", "vehicle": 1})),
        "a query by POST": (405, ask("/api/state", {})),
        "a command by GET": (405, ask("/api/command")),
        "another method": (405, ask("/api/command", good, method="PUT")),
    }
    for what, (status, answer) in wrong.items():
        check(f"refused: {what}", answer[0] == status and answer[1]["error"] and answer[1]["next"], answer)
    check("joining requires the token", ask("/api/join", {"name": "Eve"}, Authorization=None)[0] == 401)
    check("killing requires the token", ask("/api/process", {"do": "kill", "role": "mover"}, Authorization=None)[0] == 401)
    answers = [ask("/api/command", {"do": "cancel", "mission": 9})[0] for _ in range(120)]
    check("a flood of commands is refused", 429 in answers, set(answers))
    check("no refused command reached the world", state()["tally"]["commands"] == before)


for part in (reading, motions, playing, ruling, killing, pictures, refusals):
    part()
