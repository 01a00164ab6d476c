#!/usr/bin/env bash
# Outside programs drive vehicles (row 16): in C over the topics (docs/examples/escort.c), and in
# any language through jolon harness (docs/examples/sentry.py), while the reporter and the mover are
# killed. Every line is answered exactly once, whatever it contains.
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/lib.sh"
harness="$bin/jolon-harness -w $name --timeout 60"
escort=$bin/../examples/escort

cat >field.cfg <<'C'
world = { name = "field"; seed = 3; capacity = 256; };
terrain = { source = "flat"; height_m = 100.0; };
vehicles = (
    { name = "Lead";   kind = "truck"; force = "blue"; behaviour = "hold"; at = [25000.0, 25000.0];
      heading_deg = 90.0; speed_mps = 4.0; },
    { name = "Guard";  kind = "tank"; force = "blue"; behaviour = "hold"; at = [24900.0, 25100.0]; },
    { name = "Sentry"; kind = "tank"; force = "blue"; behaviour = "hold"; at = [26000.0, 26000.0]; },
    { name = "Raider"; kind = "tank"; force = "red"; behaviour = "hold"; at = [25200.0, 25300.0]; },
    { name = "Probe";  kind = "jeep"; force = "red"; behaviour = "hold"; at = [26150.0, 25900.0]; }
);
C
check "a set starts" "$jolon" start -w "$name" --without renderer --without recorder --remote-commands \
    --out "$folder/out" "$folder/field.cfg"

# --- both programs drive while processes die ---------------------------------------------------------
CYCLONEDDS_URI=file://$top/config/cyclonedds.xml "$escort" "$name" 2 1 >escort.out 2>&1 &
escorting=$!
python3 "$top/docs/examples/sentry.py" --jolon "$jolon" -w "$name" --seconds 90 --corners 2 --side 25 Sentry >sentry.out 2>&1 &
watching=$!
sleep 1
for role in intake mover reporter; do
    "$jolon" kill -w "$name" "$role" >/dev/null
    sleep 0.7
done
$bin/jolon-ctl -w "$name" --timeout 30 drive Raider --brake 1 >/dev/null
check "the raider fires at the escorted vehicle" eventually \
    "$bin/jolon-ctl" -w "$name" --timeout 30 fire Raider --target Lead
check "the escort fires back (row 16)" eventually grep -q 'shot at 4 in frame' escort.out
# The middle of the world, around which they drive, is 10SFE5772179693.
check "the topics have the places of events on the earth" grep -Eq '^4 fires from 10SFE5[78][0-9]{3}(79|80)[0-9]{3}$' escort.out
check "the topics have the places of vehicles on the earth" grep -Eq 'in frame [0-9]+ from 35\.9[45][0-9]*, -121\.2[45]' escort.out
# The escort keeps 40 m behind its vehicle.
escorts() {
    "$bin/jolon-monitor" -w "$name" --once --json --vehicles >state && python3 -c '
import json, math, sys
at = {e["id"]: e["position"] for e in json.load(open("state"))["list"]}
sys.exit(not math.hypot(at[1][0] - at[2][0], at[1][2] - at[2][2]) < 60)'
}
check "the escort reaches its vehicle through the topics (row 16)" eventually escorts
wait $watching
check "the sentry ends with 0" equal $? 0
check "the sentry drives around corners through the harness (row 16)" grep -q '^corner 2 at' sentry.out
check "the sentry shoots at the intruder" grep -q '^fired in frame' sentry.out
check "the sentry keeps its vehicle through the kills" eval '! grep -q lost sentry.out'
agents() { "$jolon" events -w "$name" --json | grep '"type":"agent"' | grep "\"id\":$1,"; }
check "a client that ends gives its vehicle back" eventually eval \
    'agents 3 | tail -n 1 | grep -q "\"to\":\"hold\",\"because\":\"command\""'
{ kill -KILL $escorting; wait $escorting; } 2>/dev/null
check "a killed client's vehicle returns to its agent" eventually eval \
    'agents 2 | tail -n 1 | grep -q "\"because\":\"lease over\""'

# --- exactly once -------------------------------------------------------------------------------------
spawns=40
vehicles() { "$jolon" status -w "$name" --json | json vehicles; }
before=$(vehicles)
for i in $(seq $spawns); do
    echo "{\"id\":$i,\"do\":\"spawn\",\"kind\":\"jeep\",\"x\":$((20000 + 20 * i)),\"z\":20000}"
    sleep 0.05
done | $harness >spawned &
spawning=$!
for role in intake mover intake intake; do
    sleep 0.6
    "$jolon" kill -w "$name" "$role" >/dev/null
done
wait $spawning
check "every spawn is answered while intake and mover are killed" equal $? 0
cat >"$folder/once" <<'P'
import json, sys
lines = [json.loads(line) for line in open("spawned")]
answers = [line for line in lines if "answer" in line]
assert sorted(a["answer"] for a in answers) == list(range(1, 41)), "not each once"
assert all(a["result"] == "done" and a["frame"] > 0 for a in answers), answers
assert len({a["entity"] for a in answers}) == 40, "two made the same"
P
check "each spawn is answered once, with an id of its own" python3 "$folder/once"
check "no spawn was done twice" equal "$(vehicles)" "$((before + spawns))"

# --- lines ---------------------------------------------------------------------------------------------
cat >lines <<'L'
{"id":"a","do":"drive","vehicle":"Sentry","throttle":0.1}
{"id":"b","do":"fire","vehicle":"Sentry"}

garbage
{"id":"c"}
[1,2,3]
{"id":"d","do":"drvie","vehicle":1}
{"id":"e","do":"drive","vehicle":3,"throttle":7}
{"id":"f","do":"drive","vehicle":"Snetry"}
{"id":"g","want":{"entities":"some"}}
{"id":{"x":1},"do":"pause"}
{"do":"pause"}
{"id":"h","do":"step","frames":2}
{"id":"i","do":"resume"}
{"id":"j","do":"remove","vehicle":4711}
L
{ cat lines; printf '{"id":"k","do":"pause"\0}\n{"id":"\xff","do":"pause"}\n'; head -c 70000 /dev/zero | tr '\0' '['
    echo; printf '%s' '{"id":"l","do":"release","vehicle":3}'; } | $harness >told
check "the harness survives damaged lines" equal $? 0
cat >"$folder/answers" <<'P'
import json
lines = [json.loads(line) for line in open("told")]
answer = {str(line["answer"]): line for line in lines if "result" in line}
error = {line["line"]: line for line in lines if "error" in line}
assert lines[0]["names"]["Sentry"] == 3 and lines[0]["hz"] == 60, "the world comes first"
assert [answer[i]["result"] for i in ("a", "None", "h", "i", "l")] == ["done"] * 5, answer
assert answer["j"]["result"] == "no such entity" and "monitor" in answer["j"]["next"]
assert answer["None"]["frame"] < answer["h"]["frame"] < answer["i"]["frame"], "in their order"
assert set(error) == {4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18}, sorted(error)
assert "did you mean drive" in error[7]["error"] and error[7]["answer"] == "d"
assert "from -1 to 1" in error[8]["error"] and "nearest is Sentry" in error[9]["error"]
assert "longer than" in error[18]["error"] and "UTF-8" in error[17]["error"]
P
check "each line is answered, or refused with the error and the correct form" python3 "$folder/answers"

# --- places ---------------------------------------------------------------------------------------------
{ echo '{"id":0,"want":{"entities":"all","places":true,"rate_hz":10}}'
    echo '{"id":1,"do":"spawn","kind":"helicopter","at":"35.96N,121.25W","altitude_m":900}'
    echo '{"id":2,"do":"spawn","kind":"helicopter","at":"36.96N,121.25W"}'
    sleep 2; } | $harness >told
cat >"$folder/places" <<'P'
import json
lines = [json.loads(line) for line in open("told")]
assert lines[0]["latitude_deg"] == 35.95 and lines[0]["longitude_deg"] == -121.25, lines[0]
made = next(line["entity"] for line in lines if line.get("answer") == 1)
assert "from the middle of the world" in next(line["error"] for line in lines if line.get("answer") == 2)
first = next(e for line in lines if "entities" in line for e in line["entities"] if e["id"] == made)
print(first)
assert abs(first["latitude_deg"] - 35.96) < 0.002 and abs(first["longitude_deg"] + 121.25) < 0.002
assert first["mgrs"].startswith("10SFE57") and len(first["mgrs"]) == 15
P
check "commands take places on the earth, and vehicles have theirs" python3 "$folder/places"

# --- a slow reader -------------------------------------------------------------------------------------
{ echo '{"id":0,"want":{"entities":"all","rate_hz":10,"frames":true,"events":"all"}}'
    for i in $(seq 1000); do
        echo "{\"id\":$i,\"do\":\"drive\",\"vehicle\":3,\"steer\":0}"
        [ $((i % 100)) != 0 ] || sleep 0.1
    done; } | $harness | { sleep 2; cat >slow; }
check "a slow reader loses no answer" equal \
    "$(grep -c '^{"answer":[0-9]*,"result":"\(done\|replaced\)"' slow)" 1001

# --- refusals ------------------------------------------------------------------------------------------
"$bin/jolon-harness" -w "no-$name" --timeout 0.5 </dev/null >told 2>err
check "a world that does not exist is refused with one line" equal "$? $(wc -l <err) $(wc -c <told)" "1 1 0"
"$bin/jolon-harness" -w "$name" now </dev/null >told 2>err
check "wrong usage is refused with 2" equal "$? $(wc -l <err)" "2 1"
echo '{"do":"pause"}' | $harness | true
check "the harness ends when its reader has gone" [ "${PIPESTATUS[1]}" -le 1 ]

check "the set stops" "$jolon" stop -w "$name"
check "nothing is left" nothing_left "$name"
[ $failures = 0 ] || sed 's/^/# /' sentry.out escort.out "$folder/out/jolon.log" | tail -n 30
done_testing
