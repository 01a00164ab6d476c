#!/usr/bin/env bash
# A world of 130 km with 4,161 x 4,161 posts, which are in a file beside the ground file: digests on 1 and 2
# threads, replay, checkpoints, and what happens when one of the two files is missing or damaged.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
mkdir -m 700 "$JOLON_RUNTIME_DIR"
if [ ! -x "$bin/jolon-ground" ] || ! command -v gdal_create >/dev/null; then
    skip "large worlds" "jolon-ground or gdal_create is missing; make ground and the package gdal-bin bring them"
    done_testing
fi
world=$bin/jolon-world
# Hills: two maps, of which the finer one is a plateau in the middle.
gdal_create -q -outsize 300 300 -a_ullr 19 12 22 9 -a_srs EPSG:4326 -ot Float32 -burn 300 wide.tif
gdal_create -q -outsize 400 400 -a_ullr 20.3 10.7 20.7 10.3 -a_srs EPSG:4326 -ot Float32 -burn 450 plateau.tif
check "a ground of 130 km is made" eval '"$bin/jolon-ground" make --center 10.5,20.5 --side 130000 --posts 31.25 --out x.ground wide.tif plateau.tif 2>err'
cat >scene.cfg <<'END'
world = { capacity = 128; };
terrain = { source = "file"; file = "x.ground"; };
vehicles = ( { kind = "tank"; count = 20; force = "blue"; behaviour = "patrol"; area = [100000.0, 100000.0, 130000.0, 130000.0]; },
             { kind = "tank"; count = 20; force = "red"; behaviour = "patrol"; area = [126000.0, 126000.0, 130000.0, 130000.0]; },
             { kind = "tank"; at = [65000.0, 65000.0]; name = "MIDDLE"; stand = true; } );
END
run() { "$jolon" run -w "$name" --frames 300 --pace max --without renderer --json "$@" scene.cfg 2>/dev/null; }
for threads in 1 2; do
    run --threads $threads --out out$threads >told$threads
done
check "the digest is the same on 1 and 2 threads" eval '[ -s told1 ] && [ "$(json digest <told1)" = "$(json digest <told2)" ]'
check "the posts are in a file" eval '[ "$(stat -c %s x.ground.posts)" -gt $((4161 * 4161 * 5)) ] && [ ! -e x.ground.posts.new ]'
check "a replay has the same digest" eval '"$jolon" replay out1/commands.log | grep -q "equal to the run"'

"$world" create --world "$name" scene.cfg >/dev/null
check "the ground in the middle is that of the finer map" eval '"$world" dump --world "$name" --terrain 65000,65000,65000,65000,1 | tee heights | tail -n 1 | grep -q "450"'
check "a check reads the posts" eval '"$world" check --world "$name" | grep -q good'
check "the world has little memory of its own" [ "$("$world" info --world "$name" --json | json bytes)" -lt 20000000 ]
"$world" remove --world "$name" >/dev/null
sed 's/65000.0, 65000.0/130001.0, 65000.0/' scene.cfg >far.cfg
refuses "a place beyond the edge" 1 'each 0..130000 m' "$world" create --world "$name" far.cfg

# --- the posts are taken away ----------------------------------------------------------------------
"$jolon" run -w "$name" --set world.pace=real --set world.frames=100000 --without renderer --without reporter --out out4 scene.cfg >stdout 2>told &
run=$!
goes_on() { [ "$("$world" frame --world "$name")" -gt 60 ]; }
eventually goes_on
cp x.ground.posts kept && truncate -s 70000 x.ground.posts
wait $run
status=$?
mv kept x.ground.posts
check "a set whose posts are cut off gives up" [ $status = 1 ] || [ $status = 3 ]
check "the set names the file" grep -q 'x.ground.posts: was made shorter while a world runs on it; jolon world create on .*x.ground makes it again' told out4/jolon.log
check "nothing of it is left" nothing_left "$name"

# --- checkpoints ----------------------------------------------------------------------------------
"$jolon" run -w "$name" --frames 200 --pace max --without renderer --out out3 --checkpoint half.image --every 150 scene.cfg >/dev/null 2>&1
check "a checkpoint holds no posts" eval '[ -s half.image ] && [ "$(stat -c %s half.image)" -lt 3000000 ]'
rm x.ground.posts
check "a world from a checkpoint makes the posts again" eval '"$world" create --world "$name" --set world.frames=400 --from half.image >/dev/null && [ -s x.ground.posts ]'
"$world" remove --world "$name" >/dev/null
mv x.ground away.ground
check "with the posts the ground file is not needed" "$world" create --world "$name" --set world.frames=400 --from half.image
rm x.ground.posts
check "a program without the posts says what is missing" eval '! "$world" digest --world "$name" 2>why && grep -q "x.ground.posts: No such file or directory; jolon world create on .*x.ground makes it" why'
check "a world without its posts can be removed" "$world" remove --world "$name"
refuses "a checkpoint without both files" 1 'x.ground: No such file or directory' "$world" create --world "$name" --set world.frames=400 --from half.image
"$bin/jolon-ground" make --center 10.5,20.5 --side 130000 --posts 31.25 --out x.ground wide.tif 2>/dev/null >&2
refuses "a checkpoint on another ground" 1 'x.ground: has the hash [0-9a-f]*; the world needs the ground' "$world" create --world "$name" --set world.frames=400 --from half.image
done_testing
