#!/usr/bin/env bash
# A hundred monitors at once, one of them stopped, and the simulation keeps its time: its late frames
# beside those of a run without any. MONITORS=n and FRAMES=n choose others.
# Runs alone: it measures time.
. "$(dirname "$0")/lib.sh"
monitors=${MONITORS:-100}
frames=${FRAMES:-480}

play() { # what happened in so many frames of real time, as JSON
    "$jolon" run -w "$name" --frames "$1" --without renderer --out "out$2" --json hunter-liggett 2>err || sed 's/^/# /' err
}
play "$frames" 1 >alone.json

"$jolon" start -w "$name" --without renderer --out out2 hunter-liggett >started 2>&1
pids=()
end_monitors() {
    [ ${#pids[@]} = 0 ] || kill -KILL "${pids[@]}" 2>/dev/null
    { wait "${pids[@]}"; } 2>/dev/null
    pids=()
}
trap 'end_monitors; at_end' EXIT
for i in $(seq "$monitors"); do
    "$bin/jolon-monitor" --world "$name" >"lines.$i" 2>"errors.$i" &
    pids+=($!)
done
attached() { # every one has said something of the world
    local i
    for i in $(seq "$monitors"); do [ -s "lines.$i" ] || return 1; done
}
all_attached() {
    for _ in $(seq 30); do
        attached && return 0
        sleep 1
    done
    cat errors.* | sort | uniq -c | head -n 5
    ls -S lines.* | while read -r file; do [ -s "$file" ] || echo "$file"; done | wc -l
    return 1
}
check "$monitors monitors are attached" all_attached
kill -STOP "${pids[0]}"
"$bin/jolon-world" summary --json --world "$name" >before
sleep $((frames / 60))
"$bin/jolon-world" summary --json --world "$name" >after
late=$(($(json late_frames <after) - $(json late_frames <before)))
echo "# late frames: $late of $(($(json frame <after) - $(json frame <before))) with $monitors monitors, $(json late_frames <alone.json) of $frames alone"
# shellcheck disable=SC2046 # a file each
awk '/^Pss:/ { pss += $2 } /^Private_/ { private += $2 } END { printf "# memory of a monitor: %.1f MB of its own, %.1f MB with its share\n", private / 1024 / n1, pss / 1024 / n1 }' \
    n1="$monitors" $(printf '/proc/%s/smaps_rollup ' "${pids[@]}") 2>/dev/null
ticks=$(for pid in "${pids[@]}"; do cut -d' ' -f14,15 "/proc/$pid/stat"; done 2>/dev/null | awk '{ s += $1 + $2 } END { print s }')
echo "# processor time of all: $ticks hundredths of a second"
check "the simulation keeps its time: no more late frames than 1 in 100" test "$late" -le $((frames / 100 + $(json late_frames <alone.json)))
end_monitors
check "the world goes on when all are killed" bash -c "a=\$('$bin/jolon-world' frame --world $name); sleep 0.5; [ \$('$bin/jolon-world' frame --world $name) -gt \$a ]"
done_testing
