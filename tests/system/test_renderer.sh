#!/usr/bin/env bash
# A renderer may die any number of times: the next picture follows within a second, and the run ends
# with the digest of a run without a renderer. The memory of a living renderer does not grow.
# KILLS=n sets the number of kills, and SECONDS_FLAT=s how long the memory is observed (600 for a
# release).
# Quiet: the next picture after a kill has a second, and the memory has seconds to become steady.
. "$(dirname "$0")/lib.sh"
kills=${KILLS:-$([ -n "${JOLON_SANITIZER-}" ] && echo 5 || echo 100)}
flat_s=${SECONDS_FLAT:-12}
small="--set renderer.width=320 --set renderer.height=180 --set renderer.fps=30 --set renderer.view=chase"

# Starts a run in the background and waits for its first picture. Ends it and prints its summary.
begin() {
    rm -rf "$folder/out"
    # shellcheck disable=SC2086 # words
    "$jolon" run -w "$name" --json --out "$folder/out" $small >summary 2>err &
    run=$!
    eventually [ -f "$folder/out/chase.png" ]
}
end() {
    kill -TERM $run
    wait $run || sed 's/^/# /' err
}

# --- killed again and again -----------------------------------------------------------------------
begin
python3 - "$jolon" "$name" "$folder/out/chase.png" "$kills" >waits 2>err <<'P'
import os, subprocess, sys, time
jolon, name, picture, kills = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
waits = []
for _ in range(kills):
    subprocess.run([jolon, "kill", "-w", name, "renderer"], check=True, stdout=subprocess.DEVNULL)
    killed = time.time_ns()
    while os.stat(picture).st_mtime_ns <= killed:
        if time.time_ns() - killed > 10e9:
            sys.exit("no picture within 10 s of kill %d" % len(waits))
        time.sleep(0.005)
    waits.append((time.time_ns() - killed) / 1e9)
waits.sort()
print("%.3f %.3f %.3f" % (waits[len(waits) // 2], waits[len(waits) * 9 // 10], waits[-1]))
P
status=$?
read -r median p90 worst <waits
check "a picture follows after each of $kills kills" equal $status 0
[ $status = 0 ] || sed 's/^/# /' err
echo "# figures: next picture after a kill [s]: median $median, 9 of 10 within $p90, worst $worst"
check "nine of ten pictures follow within a second" python3 -c "import sys; sys.exit(not (float('$p90') < ${JOLON_SANITIZER:+10}1.0))"
end
frames=$(json frame <summary)
"$jolon" run -w "$name" --frames "$frames" --pace max --json --without renderer --without reporter \
    --out "$folder/calm-out" >calm 2>err || sed "s/^/# /" err
check "the digest at frame $frames is that of a run without a renderer" \
    equal "$(json digest <summary)" "$(json digest <calm)"

# --- the memory of a living renderer ---------------------------------------------------------------------------
# In a short test the camera stands still, where the ground is soon painted. In a long test it moves,
# so that ground is loaded and freed.
stand="--view free --eye 27000,21000,30 --look 90,0"
[ "$flat_s" -lt 120 ] || stand="--view chase"
begin
# shellcheck disable=SC2086 # words
"$bin/jolon-renderer" -w "$name" --role renderer-2 --out second --fps 60 --size 320x180 --stills 2 $stand 2>second.err &
second=$!
check "the renderer's memory does not grow within $flat_s s" python3 - "$second" "$flat_s" <<'P'
import sys, time
pid, seconds = int(sys.argv[1]), float(sys.argv[2])
def resident():
    with open("/proc/%d/statm" % pid) as statm:
        return int(statm.read().split()[1]) * 4096
# Caches fill first, which takes longer on a busy machine: a short test waits until they are full.
warm = min(300.0, seconds / 2)
for attempt in range(6 if seconds < 120 else 1):
    time.sleep(warm)
    before, peak, end = resident(), 0, time.time() + seconds - warm
    while time.time() < end:
        time.sleep(1)
        peak = max(peak, resident())
    if peak - before <= 8e6:
        break
print("%.1f MB, later %.1f MB" % (before / 1e6, peak / 1e6))
sys.exit(peak - before > 8e6)
P
kill -TERM $second
wait $second || sed 's/^/# /' second.err
end
done_testing
