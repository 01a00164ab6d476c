#!/usr/bin/env bash
# A hundred monitors at once, one of them stopped. They make no frame late, run behind the frame
# loop and take little processor time. MONITORS=n and FRAMES=n choose others.
. "$(dirname "$0")/lib.sh"
monitors=${MONITORS:-100}
frames=${FRAMES:-480}

"$jolon" start -w "$name" --without renderer --out out hunter-liggett >started 2>&1
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
used() { # PID...: hundredths of a second of processor time, of all
    for pid; do cut -d' ' -f14,15 "/proc/$pid/stat"; done 2>/dev/null | awk '{ s += $1 + $2 } END { print s }'
}
check "the monitors run behind the frame loop" behind_loop "${pids[1]}" 10
loop() { used "$(pid mover)" "$(pid collider)"; }
before=$(used "${pids[@]}") loop_before=$(loop)
time_begins
sleep $((frames / 60))
check "the simulation keeps its time: no more late frames than 1 in 100" in_time "frames / 100"
sed -n '/^#/p' check
of_all=$(($(used "${pids[@]}") - before)) of_loop=$(($(loop) - loop_before))
echo "# processor time of all: $of_all hundredths of a second in $((frames / 60)) s, of the frame loop $of_loop"
# On a quiet machine ten monitors take less. Beside other tests the caches are cold at each wake.
check "five monitors take no more processor time than the frame loop" [ $((of_all * 5)) -le $((of_loop * monitors)) ]
# shellcheck disable=SC2046 # a file each
awk '/^Pss:/ { pss += $2 } /^Private_/ { private += $2 } END { printf "# memory of a monitor: %.1f MB of its own, %.1f MB with its share\n", private / 1024 / n1, pss / 1024 / n1 }' \
    n1="$monitors" $(printf '/proc/%s/smaps_rollup ' "${pids[@]}") 2>/dev/null
end_monitors
check "the world goes on when all monitors are killed" bash -c "a=\$('$bin/jolon-world' frame --world $name); sleep 0.5; [ \$('$bin/jolon-world' frame --world $name) -gt \$a ]"
done_testing
