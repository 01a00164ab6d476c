#!/usr/bin/env bash
# The scenes of the thesis's figures A.2 to A.9 and the other cases of its text (row 32) end as the
# thesis says: with its own response of figure 8, and with impulses where they apply. The checks
# compare outcomes: the damage of each body, what is destroyed, and the response.
. "$(dirname "$0")/lib.sh"

# scene AS SCENARIO [options]: runs the scenario. AS.json is the summary, AS.events are the events.
scene() {
    local as=$1
    shift
    "$jolon" run -w "$name" --without renderer --without reporter --pace max --json --out "$folder/out" \
        --events "$folder/$as.events" "$@" >"$folder/$as.json" 2>"$folder/err" || sed 's/^/# /' "$folder/err"
}

# outcome WHAT AS EXPRESSION: checks a Python expression over the run.
outcome() { check "$1" python3 - "$2" "$3" <<'P'; }
import json, sys
name, expression = sys.argv[1:]
NONE, LOW, MED, HIGH, DESTROYED = range(5)
level = {"none": NONE, "low": LOW, "med": MED, "high": HIGH, "destroyed": DESTROYED}
events = [json.loads(line) for line in open(name + ".events")]
summary = json.load(open(name + ".json"))
hits = [e for e in events if e["type"] == "collision"]
destroyed = summary["destroyed"]
def with_kind(kind):
    return [h for h in hits if kind in (h["a"]["kind"], h["b"]["kind"])]
def ids(kind):
    return {h[side]["id"] for h in hits for side in "ab" if h[side]["kind"] == kind}
def damage(kind, id=None):
    return max([level[h["damage_" + side]] for h in hits for side in "ab"
                if h[side]["kind"] == kind and id in (None, h[side]["id"])], default=NONE)
def responses(kind):
    return {h["response"] for h in with_kind(kind)}
print("hits", [(h["frame"], h["a"]["kind"], h["b"]["kind"], h["response"], h["damage_a"], h["damage_b"])
               for h in hits], "destroyed", destroyed)
sys.exit(not eval(expression))
P

impulse="--set collision.response=impulse"

# --- two vehicles ---------------------------------------------------------------------------------
scene a2 figure-a2-imminent
outcome "figure A.2: the tanks have not met yet" a2 'not events and destroyed == 0'
scene a2_later figure-a2-imminent --frames 230
outcome "figure A.2: a second later the tanks have collided" a2_later 'len(hits) >= 1 and ids("tank") == {1, 2}'
scene a3 figure-a3-broadside
outcome "figure A.3: the collision is broadside" a3 'abs(abs(hits[0]["angle_deg"] - 180) - 90) < 5'
outcome "figure A.3: both tanks are destroyed" a3 \
    'hits[0]["response"] == "destroyed" and destroyed == 2 and all(damage("tank", i) == DESTROYED for i in (1, 2))'
scene a3i figure-a3-broadside $impulse
outcome "figure A.3 by impulses: one collision damages both tanks" a3i \
    'damage("tank", 1) >= LOW and damage("tank", 2) >= LOW and hits[0]["impulse_ns"] > 0'

# --- a tree ---------------------------------------------------------------------------------------
scene a4 figure-a4-tree-imminent
outcome "figure A.4: nothing has happened yet" a4 'not events'
scene a4_later figure-a4-tree-imminent --frames 250
outcome "figure A.4: a second later the tree is struck" a4_later 'len(with_kind("tree")) >= 1'
scene a5 figure-a5-tree-slow
outcome "figure A.5: a slow tank damages the tree, which stands" a5 'LOW <= damage("tree") <= MED'
outcome "figure A.5: the tank is slowed and hardly damaged" a5 \
    'responses("tree") == {"slow"} and damage("tank") <= LOW and destroyed == 0'
scene a5i figure-a5-tree-slow $impulse
outcome "figure A.5 by impulses: the tree is damaged and stands" a5i \
    'LOW <= damage("tree") <= MED and damage("tank") <= LOW and destroyed == 0'
scene a6 figure-a6-tree-fast
outcome "figure A.6: a tank at speed leaves a stump" a6 'damage("tree") == HIGH'
outcome "figure A.6: the tank continues more slowly" a6 \
    'responses("tree") == {"slow"} and damage("tank") <= LOW and destroyed == 0'
scene a6i figure-a6-tree-fast $impulse
outcome "figure A.6 by impulses: the tree is a stump and the tank continues" a6i \
    'damage("tree") == HIGH and damage("tank") <= LOW and destroyed == 0'

# --- a tower --------------------------------------------------------------------------------------
scene a7 figure-a7-tower-imminent
outcome "figure A.7: nothing has happened yet" a7 'not events'
scene a7_later figure-a7-tower-imminent --frames 180
outcome "figure A.7: a second later the tower is struck" a7_later 'len(with_kind("watertower")) >= 1'
scene a8 figure-a8-tower-slow
outcome "figure A.8: a slow tank damages the tower, which stands" a8 'LOW <= damage("watertower") <= MED'
outcome "figure A.8: the tank is slowed and not destroyed" a8 'responses("watertower") == {"slow"} and destroyed == 0'
scene a8i figure-a8-tower-slow $impulse
outcome "figure A.8 by impulses: the tower stands and the tank is not destroyed" a8i \
    'damage("watertower") <= MED and destroyed == 0'
scene a9 figure-a9-tower-fast
outcome "figure A.9: a fast tank is destroyed" a9 \
    'destroyed == 1 and damage("tank") == DESTROYED and responses("watertower") == {"destroyed"}'
outcome "figure A.9: the tower is destroyed" a9 'damage("watertower") == HIGH'
scene a9i figure-a9-tower-fast $impulse
outcome "figure A.9 by impulses: tower and tank are damaged" a9i \
    'damage("watertower") >= MED and damage("tank") >= LOW'

# --- the text's other cases -----------------------------------------------------------------------
for model in figure8 impulse; do
    with="--set collision.response=$model"
    scene glancing tanks-glancing $with
    outcome "page 14, $model: two tanks at an angle bounce off and both are damaged" glancing \
        'hits[0]["response"] == "bounce" and destroyed == 0 and all(LOW <= damage("tank", i) <= MED for i in (1, 2))'
    scene trees tank-over-trees $with
    outcome "row 32, $model: a tank at speed over trees leaves stumps" trees \
        'len(ids("pine")) >= 3 and all(damage("pine", i) == HIGH for i in ids("pine")) and destroyed == 0'
    outcome "row 32, $model: each tree slows the tank and none damages it much" trees \
        'damage("tank") <= LOW and all(b["closing_mps"] < a["closing_mps"]
            for a, b in zip(with_kind("pine"), with_kind("pine")[1:]))'
    scene bush jeep-over-bush $with
    outcome "row 32, $model: a jeep over a bush damages neither" bush \
        'len(with_kind("bush")) >= 1 and damage("jeep") == damage("bush") == NONE and destroyed == 0'
    scene house tank-into-house $with
    outcome "row 32, $model: a tank into a house damages both, the house more" house \
        'LOW <= damage("tank") < damage("building") and destroyed == 0'
    scene truck truck-against-house $with
    outcome "row 32, $model: building against vehicle, vehicle destroyed" truck \
        'damage("truck") == DESTROYED and destroyed == 1 and LOW <= damage("building") <= MED'
done
check "the runs leave no shared memory" nothing_left "$name"
done_testing
