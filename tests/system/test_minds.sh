#!/usr/bin/env bash
# Two companies meet (row 9): the right vehicles fight and flee, and every change of behaviour has a
# reason.
. "$(dirname "$0")/lib.sh"

cat >meeting.cfg <<'SCENARIO'
world = { seed = 3; };
terrain = { source = "flat"; };
vehicles = (
  { kind = "tank"; count = 10; force = "blue"; fire_at_will = true; area = [24000.0, 26500.0, 25000.0, 26900.0];
    route = ( [24500.0, 23000.0], [24500.0, 26500.0] ); },
  { kind = "jeep"; count = 6; force = "blue"; area = [24000.0, 26000.0, 25000.0, 26400.0];
    route = ( [24500.0, 23000.0], [24500.0, 26500.0] ); },
  { kind = "truck"; count = 6; force = "blue"; area = [24000.0, 25000.0, 25000.0, 25400.0];
    route = ( [24500.0, 24500.0], [24500.0, 27500.0] ); },
  { kind = "tank"; count = 14; force = "red"; fire_at_will = true; area = [24000.0, 22100.0, 25000.0, 22500.0];
    route = ( [24500.0, 26000.0], [24500.0, 22500.0] ); },
  { kind = "helicopter"; count = 2; force = "red"; fire_at_will = true; area = [24000.0, 21100.0, 25000.0, 21500.0];
    route = ( [24500.0, 26000.0], [24500.0, 21500.0] ); } );
SCENARIO

check "two companies meet" "$jolon" run -w "$name" --pace max --frames 7200 --json --without renderer \
    --without reporter --out "$folder/out" --events "$folder/events" meeting.cfg
cat >minds.py <<'P'
import json, sys
events = [json.loads(line) for line in open("events")]
minds = [e for e in events if e["type"] == "agent"]
what = sys.argv[1]
if what == "chain":  # nobody changes his behaviour without an event
    now = {}
    for e in minds:
        assert now.get(e["id"], "route") == e["from"], (e, now.get(e["id"]))
        assert e["from"] != e["to"] and e["because"], e
        now[e["id"]] = e["to"]
    assert len(now) > 20, len(now)
elif what == "shot":  # within half a second of a shot something changed: one that cruises reacts at the end of its stretch
    fires = [e for e in events if e["type"] == "fire"]
    assert fires, "nobody fired"
    first = min(e["frame"] for e in minds if e["because"] == "fired upon")
    assert any(first - 31 <= e["frame"] <= first for e in fires), first
else:
    kind, came, because = sys.argv[1:]
    assert any(e["kind"] in kind.split(",") and e["to"] == came and e["because"] == because for e in minds), minds[:20]
P
check "every change of behaviour follows the one before it" python3 minds.py chain
check "every change because of fire follows a shot at the vehicle" python3 minds.py shot
check "tanks attack enemies that they see" python3 minds.py tank attack "enemy seen"
check "helicopters attack enemies that they see" python3 minds.py helicopter attack "enemy seen"
check "trucks flee when fired upon" python3 minds.py truck flee "fired upon"
check "tanks continue their route when the target is gone" python3 minds.py tank route "target gone"
check "jeeps or trucks that fled continue their route afterwards" python3 minds.py jeep,truck route "time over"
done_testing
