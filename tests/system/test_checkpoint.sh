#!/usr/bin/env bash
# Runs continued from an image have the digests of the undisturbed run. Tests branches, refusals,
# and the repetition of a frame from a dump. SEED seeds RANDOM.
. "$(dirname "$0")/lib.sh"
world=$bin/jolon-world
RANDOM=${SEED:=$((RANDOM))}
echo "# SEED=$SEED"

# Runs mover and collider until the run's last frame.
run_roles() {
    "$bin/jolon-collider" --world "$1" 2>>roles.log &
    local collider=$!
    "$bin/jolon-mover" --world "$1" 2>>roles.log && wait $collider
}
digest() { "$world" digest --world "$1"; }
drop() { "$world" remove --world "$1"; }
reached() { [ "$("$world" frame --world "$name")" -ge "$1" ]; }
moved() { "$world" save --inputs moved.image --world "$name" | grep -q 'and the inputs of the next'; }
remove_both() {
    local left
    for left in "$name" "$name-b"; do "$world" remove --force --world "$left" >/dev/null 2>&1; done
}
trap 'remove_both; at_end' EXIT

# --- a world from an image --------------------------------------------------------------------------
"$world" create --world "$name" --set world.frames=900 --set world.pace=max >/dev/null
run_roles "$name"
calm=$(digest "$name")
drop "$name"

"$world" create --world "$name" --set world.frames=900 >/dev/null
"$bin/jolon-collider" --world "$name" 2>>roles.log &
collider=$!
"$bin/jolon-mover" --world "$name" 2>>roles.log &
mover=$!
eventually reached 100
check "an image of the running world" "$world" save mid.image --world "$name"
kill $mover $collider
wait
drop "$name" # only the file is left, as after a reboot
made=$("$world" create --from mid.image --set world.pace=max --world "$name")
went_on=$made
check "a world made from the image continues there" grep -q 'frame [1-9][0-9]* of mid.image, goes on from there' <<<"$made"
echo "# $made"
check "check finds that world good" "$world" check --world "$name"
check "its run ends with 0" run_roles "$name"
check "its digests are those of the undisturbed run" equal "$(digest "$name")" "$calm"
first=$("$world" events --json --world "$name" | head -1 | json frame)
check "its first event is one after the image" [ "$first" -gt 100 ]
check "no event is counted as lost" bash -c "! '$world' events --world $name | grep -q lost"

# --- adoption ---------------------------------------------------------------------------------------
made=$("$world" create --adopt --from mid.image --set world.pace=max --world "$name")
check "adoption continues a dead set's world where it is" \
    grep -q 'left it at frame 900; goes on' <<<"$made"
"$world" save late.image --world "$name" >/dev/null
made=$("$world" create --adopt --from late.image --set world.frames=1000 --world "$name")
check "a world with another last frame is made again from the image" grep -q 'frame 900 of late.image, goes on' <<<"$made"
check "so is a world with another seed" grep -q 'branched off' <<<"$("$world" create --adopt --from late.image \
    --set world.frames=920 --set world.seed=7 --world "$name")"
drop "$name"

# --- branches ---------------------------------------------------------------------------------------
soon=$(($(sed 's/.*frame \([0-9]*\) of mid.*/\1/' <<<"$went_on") + 20))
branch() { # setting... ; vehicles cruise only with the method "swept"
    local settings=(--set world.pace=max --set "world.frames=$soon" --set world.cruise=false) setting
    for setting; do settings+=(--set "$setting"); done
    "$world" create --from mid.image "${settings[@]}" --world "$name-b" >/dev/null
    run_roles "$name-b"
    digest "$name-b"
    drop "$name-b"
}
straight=$(branch collision.method=swept)
check "another seed gives another run" [ "$(branch world.seed=7)" != "$straight" ]
check "another method that finds the same collisions gives the same run" \
    equal "$(branch collision.method=occupancy)" "$straight"

places() { # setting: where the vehicles are when the world has been made with it
    "$world" create --from mid.image --set "$1" --world "$name-b" >/dev/null
    "$world" dump --world "$name-b" --json | grep -o '"position":[^]]*]'
    drop "$name-b"
}
places=$(places world.frames=0)
check "a branch begins with every vehicle where it is, those that cruise too" [ -n "$places" ]
for setting in world.cruise=false world.hz=30 collision.method=occupancy; do
    check "... with $setting" [ "$(places "$setting")" = "$places" ]
done

# --- refusals ---------------------------------------------------------------------------------------
create=("$world" create --world "$name")
refuses "another capacity" 1 'world.capacity = 9: cannot change.*world.seed' \
    "${create[@]}" --from mid.image --set world.capacity=9
refuses "other ground" 1 'terrain.source = flat: cannot change' \
    "${create[@]}" --from mid.image --set terrain.source=flat
refuses "a run that is over" 1 'ends with frame 900.*world.frames=N' "${create[@]}" --from late.image
refuses "both an image and a scenario" 2 'leave one of them out' "${create[@]}" --from mid.image hunter-liggett
refuses "an image that does not exist" 1 'no.image: cannot open' "${create[@]}" --from no.image
refuses "a program instead of an image" 1 'magic|too small' "${create[@]}" --from "$bin/jolon"
ln -s mid.image link.image
refuses "a symbolic link" 1 'link.image: is a symbolic link' "${create[@]}" --from link.image
head -c 5000000 mid.image >cut.image
refuses "an image that was cut off" 1 'cut.image: size 5000000; .*cut off' "${create[@]}" --from cut.image
python3 - <<'P'
data = bytearray(open("mid.image", "rb").read())
data[len(data) // 2] ^= 4
open("flipped.image", "wb").write(data)
P
refuses "a flipped bit" 1 'flipped.image: packed hash' "${create[@]}" --from flipped.image
refuses "a flipped bit in a dump" 1 'packed hash' "$world" replay-frame flipped.image
refuses "an image of no world" 1 'there is no world' "$world" save new.image --world "$name"

# --- a frame repeated from a dump -------------------------------------------------------------------
"$world" create --world "$name" --set world.frames=1 --set world.pace=max >/dev/null
"$world" save before.image --world "$name" >/dev/null
(ulimit -f 100; "$world" save before.image --world "$name" 2>err)
check "save without room on the disk is refused with one line" equal "$? $(grep -c 'no room to write it' err) $(wc -l <err)" "1 1 1"
"$bin/jolon-mover" --world "$name" 2>>roles.log & # alone: the frame is moved and not collided
mover=$!
check "the dump holds the inputs of the frame in progress" eventually moved
"$bin/jolon-collider" --world "$name" 2>>roles.log
wait $mover
made=$(digest "$name")
drop "$name"
check "replay-frame computes the same frame from them" \
    grep -q "frame 1: collided, digest ${made%% *}" <<<"$("$world" replay-frame moved.image 2>/dev/null)"
check "replay-frame computes the frame without them" \
    grep -q "frame 1: moved and collided, digest ${made%% *}" \
    <<<"$("$world" replay-frame before.image 2>/dev/null)"

# --- a set that writes checkpoints ------------------------------------------------------------------
options=(-w "$name" --frames 900 --json --out out --without renderer --without reporter)
"$jolon" run "${options[@]}" --checkpoint set.image --every 30 >set.json 2>err &
set=$!
check "a set writes its checkpoints" eventually [ -s set.image ]
kill -KILL $set
{ wait $set; } 2>/dev/null
check "the set's world is removed, as by a reboot" eventually "$world" remove --world "$name"
# The writer may be a zombie for long, outside of the next set's sandbox.
python3 - <<'P' &
import os, time
pid = os.fork()
if pid:
    open(f"set.image.new-{pid}", "w").close()
    open("zombie", "w").close()
    time.sleep(60)
P
parent=$!
check "a zombie leaves an unfinished image" eventually [ -e zombie ]
"$jolon" run "${options[@]}" --pace max --from set.image --checkpoint set.image --every 300 >set.json 2>err
check "another set continues from the last checkpoint" grep -q 'frame [1-9][0-9]* of set.image, goes on from there' err
check "that set ends with the digests of the undisturbed run" \
    equal "$(json digest <set.json) $(json event_digest <set.json) frame 900" "$calm"
kill $parent
check "that set removes the images that killed processes did not finish" equal "$(find . -name "*.new-*")" ""
check "that set writes checkpoints of its own" grep -aq 'checkpoint set.image: frame' out/jolon.log

# --- kills while a checkpoint is written ------------------------------------------------------------
"$world" create --from mid.image --world "$name" >/dev/null
cp mid.image kept.image
whole=0
for _ in 1 2 3 4; do
    "$world" save kept.image --world "$name" >/dev/null 2>&1 &
    saver=$!
    sleep "0.$((RANDOM % 25 + 100))"
    kill -KILL $saver 2>/dev/null
    { wait $saver; } 2>/dev/null
    "$world" replay-frame kept.image >/dev/null 2>&1 && whole=$((whole + 1))
done
check "the image is whole after each killed save" equal $whole 4
"$world" save kept.image --world "$name" >/dev/null
check "unfinished images are removed" bash -c '! ls | grep -q new-'
drop "$name"
check "nothing is left" nothing_left "$name"
done_testing
