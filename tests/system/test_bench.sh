#!/usr/bin/env bash
# jolon-bench heap runs the same tanks in Jolon, Bullet and ODE, and prints one object or one table.
. "$(dirname "$0")/lib.sh"

"$bin/jolon-bench" heap --vehicles 6 --frames 300 --peers --json >object
cat >heap.py <<'PYTHON'
import json
run = json.load(open("object"))
assert (run["vehicles"], run["frames"]) == (6, 300), run
assert [engine["engine"] for engine in run["engines"]] == ["jolon", "bullet", "ode"], run
for engine in run["engines"]:
    assert 0.0 < engine["cpu_ms"] <= engine["cpu_p99_ms"] <= engine["cpu_worst_ms"], engine
    assert 0.0 <= engine["impact_mm"] < 500.0 and engine["pairs"] >= 3, engine
    assert engine["collisions"] >= engine["pairs"], engine
PYTHON
check "heap --peers --json measures three engines" python3 heap.py
"$bin/jolon-bench" heap --vehicles 6 --frames 300 >table
check "heap prints a table" eval '[ "$(wc -l <table)" = 3 ] && grep -q "^jolon  *1 " table'
done_testing
