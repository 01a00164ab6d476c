#!/usr/bin/env bash
# Buildings, woods, water and poles of maps: what becomes of them in a ground file and in a world, maps that are
# broken, and digests on them on 1, 2 and 4 threads, after kills and in a replay.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
ground=$bin/jolon-ground
mkdir -m 700 "$JOLON_RUNTIME_DIR"
if [ ! -x "$ground" ] || ! command -v gdaltransform >/dev/null; then
    skip "objects of ground files" "there is no jolon-ground or no gdaltransform here; make ground builds it"
    done_testing
fi
make() { "$ground" make --center 44.5,-71.5 --side 50000 --posts 25 --out "${out:-x.ground}" "$@" level.asc; }
info() { "$ground" info --json "$1" | json "$2"; }
printf 'ncols 4\nnrows 4\nxllcorner -73\nyllcorner 43\ncellsize 1\n%s' "$(yes '80 80 80 80' | head -n 4)" >level.asc
echo 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]' >level.prj

# --- a village, and each thing that can be wrong ------------------------------------------------------------
python3 "$here/ground_features.py" maps 44.5 -71.5 50000 || exit 1
check "a village becomes a ground" eval 'make --features village.geojson --roads village.geojson 2>err && "$ground" check x.ground'
check "every house is a building" eval '[ "$(info x.ground buildings)" = 121 ]'
check "the only warning is of the cover" eval '! grep -v "no map of cover" err'
check "it has trees and poles" eval '[ "$(info x.ground objects)" -gt 1000 ]'
check "it says so" eval '"$ground" info x.ground | grep -q "^features: 121 buildings"'
on_a_terminal() { # what make shows there while it reads a map
    script -qec "'$ground' make --center 44.5,-71.5 --side 50000 --posts 25 --out terminal.ground --roads village.geojson \
        --features village.geojson level.asc" shown >/dev/null </dev/null && grep -q 'village.geojson, [a-z]*: 0' shown
}
check "a terminal shows which map is read" on_a_terminal
out=again.ground make --features village.geojson --roads village.geojson --threads 1 2>/dev/null >/dev/null
check "made on one thread, it has the same hash" equal "$(info again.ground hash)" "$(info x.ground hash)"
out=halves.ground make --features east.geojson --features west.geojson --roads village.geojson >/dev/null 2>&1
check "made from two maps, it has the same hash" equal "$(info halves.ground hash)" "$(info x.ground hash)"
out=halves.ground make --features west.geojson --features village.geojson --features east.geojson --roads village.geojson >/dev/null 2>&1
check "what several maps have counts once" equal "$(info halves.ground hash)" "$(info x.ground hash)"
ogr2ogr -q -f GPKG village.gpkg village.geojson -nln village -dialect SQLite -sql 'SELECT * FROM village' 2>/dev/null
out=gpkg.ground make --features village.gpkg --roads village.geojson >/dev/null 2>&1
check "a GeoPackage of the same features gives the same hash" equal "$(info gpkg.ground hash)" "$(info x.ground hash)"
sed '0,/"properties": {/s//"properties": {"Building": null, /' village.geojson >twice.geojson
out=twice.ground make --features twice.geojson --roads village.geojson >/dev/null 2>&1
check "a field of the same name with a capital letter changes nothing" eval 'grep -q Building twice.geojson && equal "$(info twice.ground hash)" "$(info x.ground hash)"'
out=other.ground make --features village.geojson --roads village.geojson --seed 7 >/dev/null 2>&1
check "another seed gives other woods" eval '[ "$(info other.ground hash)" != "$(info x.ground hash)" ]'
out=bare.ground make --features village.geojson --trees 0 >/dev/null 2>&1
check "no trees are planted if none are wanted" eval '[ "$(info bare.ground objects)" -lt 40 ]'
"$ground" show --size 500 x.ground x.png && gdal_translate -q -of ENVI -co INTERLEAVE=BIP x.png x.raw
"$ground" show --size 500 --at 25100,25000 --metres 499 x.ground near.png && gdal_translate -q -of ENVI -co INTERLEAVE=BIP near.png near.raw
check "the picture has the lake, the road and the village" python3 "$here/ground_features.py" picture x.raw 0 0 100.2004008 lake village road
check "the picture of half a kilometre has a building to its corner" python3 "$here/ground_features.py" picture near.raw 24850.5 24750.5 1 corner
refuses "a picture of a place in another country" 2 'show: --at: that place is [0-9]+ km from the middle' "$ground" show --at 48N,11E --metres 500 x.ground near.png
"$ground" make --center 44.5,-71.5 --side 2000 --posts 12.5 --out small.ground --features village.geojson --roads village.geojson level.asc >/dev/null 2>&1
"$ground" show --size 500 --at 25100,25000 --metres 499 small.ground small.png && gdal_translate -q -of ENVI -co INTERLEAVE=BIP small.png small.raw
check "metres are those of a scenario in a small square, too" python3 "$here/ground_features.py" picture small.raw 24850.5 24750.5 1 corner
refuses "a picture of a place beyond a small square" 2 'show: --at 20000,25000: lies beyond the square of the file, which goes from 24000,24000 to 26000,26000 in a world of 50 km' \
    "$ground" show --at 20000,25000 --metres 500 small.ground near.png
refuses "a picture about a place without its size" 2 '--at goes with --metres' "$ground" show --at 25000,25000 x.ground near.png

check "broken features are mended or left out" eval 'out=broken.ground make --features broken.geojson --roads broken.geojson 2>err && "$ground" check broken.ground'
for words in '1 outlines cross themselves, and were mended; the first at latitude 44.499' '3 outlines are open, and were closed; the first at' \
    '[0-9]+ buildings or woods that are points or lines are left out' '1 buildings across the edge of the square are left out' \
    '4 buildings have a height that is no number from 0 to 500 m, and was not used; the first at' \
    '1 woods or waters have outlines that cross, or holes outside of them: .*; the first at latitude 44.4[0-9]*, longitude -71.4' '1 outlines are too small for buildings' '5 features with too few places, or with one that is none' \
    '1 lines of one point or none, or with a place that is none, are no roads'; do
    check "told: $words" grep -Eq "broken.geojson: $words" err
done
check "what is good in a broken map is kept" eval '[ "$(info broken.ground buildings)" = 8 ]'
python3 "$here/ground_features.py" maps 46 8 50000 && mkdir alps && mv ./*.geojson ./*.osm alps
python3 "$here/ground_features.py" maps 44.5 -71.5 50000
check "a map that lies elsewhere is told, for each use" eval 'out=none.ground make --features alps/village.geojson --roads alps/village.geojson 2>err &&
    grep -q "alps/village.geojson: nothing of it is used: within the square it has no lines, of which roads could be made$" err &&
    grep -q "alps/village.geojson: nothing of it is used: within the square it has no points, lines or areas that become features$" err'
check "OpenStreetMap with missing nodes" eval 'out=osm.ground make --features broken.osm 2>err && [ "$(info osm.ground buildings)" = 2 ]'
check "told: nodes of outlines and lines, ways and a road of one point that the map lacks" eval 'grep -Eq "broken.osm: 4 ways have nodes that the map lacks, and are made of the others; the first at latitude 44\.[0-9]+, longitude -71\.[0-9]+ is number 2$" err &&
    grep -q "broken.osm: 3 ways have fewer than two nodes in the map, and are left out; the first is number 13$" err &&
    grep -q "broken.osm: 1 areas have ways that the map lacks, and are left out; the first is number 15$" err &&
    grep -q "osmium extract --strategy smart" err'
check "a map that is read for two purposes has its gaps once" eval 'out=osm.ground make --features broken.osm --roads broken.osm 2>err && grep -q "broken.osm: 3 ways have fewer than two nodes" err'
check "closed ways of OpenStreetMap are outlines, unless they are lines" eval 'out=closed.ground make --trees 0 --features closed.osm --roads closed.osm 2>err && "$ground" info closed.ground | grep -q "^features: 2 buildings, 5 plants and poles, 2 areas, 1 rivers$" &&
    "$ground" info closed.ground | grep -q "^roads: 1, "'
# is_open GROUND X HOLE_X HOLE_Z WALL_X WALL_Z: of 100 m around X, 25000, has the hole [m] the colour of the field, and the wall another?
is_open() {
    "$ground" show --size 100 --at "$2,25000" --metres 100 "$1" open.png && gdal_translate -q -of ENVI -co INTERLEAVE=BIP open.png open.raw && python3 -c '
import sys
data, at = open("open.raw", "rb").read(), list(map(int, sys.argv[1:]))
field, hole, wall = (data[3 * (z * 100 + x):][:3] for x, z in ((5, 5), at[:2], at[2:]))
raise SystemExit(field != hole or field == wall)' "${@:3}"
}
"$ground" make --center 44.5,-71.5 --side 2000 --posts 12.5 --out rings.ground --trees 0 --features rings.osm level.asc >/dev/null 2>&1
check "a lake has its island if its outer way has the words, and a building with a courtyard counts once" eval \
    '"$ground" info rings.ground | grep -q "^features: 1 buildings, 0 plants and poles, 1 areas" && "$ground" check rings.ground | grep -q "lake 3\.2 %"'
sed -E 's/(id|ref)="/&-/g' rings.osm >below.osm
{ grep -v '<node\|</osm\|<way\|<relation' rings.osm; grep '<node' rings.osm | sort -r; grep '<way\|<relation\|</osm' rings.osm; } >turned.osm
for map in below turned; do
    "$ground" make --center 44.5,-71.5 --side 2000 --posts 12.5 --out $map.ground --trees 0 --features $map.osm level.asc >/dev/null 2>&1
    check "numbers below zero and nodes in any order make the same ground ($map)" equal "$(info $map.ground hash)" "$(info rings.ground hash)"
done
check "the courtyard of such a building is open" is_open rings.ground 25300 50 50 35 50
"$ground" make --center 44.5,-71.5 --side 2000 --posts 12.5 --out notched.ground --trees 0 --features notched.osm level.asc >/dev/null 2>notched
check "holes on the outline of a lake and a building are cut out" eval \
    '"$ground" info notched.ground | grep -q "^features: 1 buildings, 0 plants and poles, 1 areas" && "$ground" check notched.ground | grep -q "lake 3\.[0-2] %"'
check "they are told, with the place" eval 'grep -Eq "notched.osm: 1 holes touch the outline around them, and are cut out of it; the first at latitude 44\.[0-9]+, longitude -71\.[0-9]+ is number 10$" notched &&
    grep -Eq "notched.osm: 1 outlines cross themselves, and were mended; the first at latitude 44\.[0-9]+, longitude -71\.[0-9]+ is number 9$" notched'
check "the building is open where its hole is" is_open notched.ground 25000 40 53 60 53
check "a river with a width that is none is told" grep -Eq "closed.osm: 1 rivers have a width that is no number from 0 to 2000 m, and was not used; the first at latitude 44\.[0-9]+, longitude -71\.[0-9]+ is number 5$" err
for order in 'over under' 'under over'; do
    out=overlap.ground make --features "${order% *}.geojson" --features "${order#* }.geojson" >/dev/null 2>&1
    info overlap.ground hash
done >hashes
check "areas of two maps that overlap make the same ground in any order" eval '[ "$(uniq hashes | wc -l)" = 1 ] && [ "$(wc -l <hashes)" = 2 ]'
out=none.ground refuses "features from a text" 1 'level.prj: GDAL cannot read it as a map' make --features level.prj
out=none.ground refuses "no such map" 1 'missing.osm: GDAL cannot read it' make --features missing.osm
cp x.ground damaged.ground
printf 'damage' | dd of=damaged.ground bs=1 seek=$(($(wc -c <damaged.ground) - 200)) conv=notrunc status=none
refuses "a damaged list of buildings" 1 'damaged.ground: block [0-9]+ is damaged' "$ground" check damaged.ground

# --- the town that comes with Jolon ---------------------------------------------------------------------------
find_source_dir
check "the town can be made" "$source_dir/config/grounds/make-town" "$ground" town.ground
check "it is the one that comes with Jolon" equal "$(info town.ground hash)" "$(info "$source_dir/config/grounds/town.ground" hash)"

# --- the White Mountains that come with Jolon ----------------------------------------------------------------
check "the White Mountains are sound, and below 5 MB" eval '"$ground" check "$source_dir/config/grounds/white-mountains.ground" && [ "$(wc -c <"$source_dir/config/grounds/white-mountains.ground")" -lt 5000000 ]'
check "they say where they are from" eval '"$ground" info "$source_dir/config/grounds/white-mountains.ground" | grep -q "^licence: heights: SRTM .*public domain"'
check "Mount Washington is the highest" eval '"$ground" info "$source_dir/config/grounds/white-mountains.ground" | grep -q "heights  *212.344 to 1906.31 m"'
"$jolon" run -w "$name" --frames 3600 --pace max --without renderer --json --out up --checkpoint up.img mount-washington >told 2>/dev/null
check "a minute of the convoy has no collision" eval '[ "$(json collisions <told)" = 0 ]'
"$bin/jolon-world" create --world "$name" --from up.img --set world.frames=0 >/dev/null 2>&1
"$bin/jolon-world" dump --json --world "$name" >convoy.json
"$bin/jolon-world" remove --world "$name" >/dev/null 2>&1
check "its trucks drive up the valley" python3 "$here/ground_features.py" convoy convoy.json

# --- a corner, and a shore ---------------------------------------------------------------------------------
cat >corner.cfg <<'TEXT'
terrain = { source = "file"; file = "x.ground"; };
world = { capacity = 64; };
vehicles = ( { kind = "truck"; name = "T1"; at = [24940.0, 25000.0]; heading_deg = 90.0; speed_mps = 12.0; behaviour = "hold"; } );
TEXT
strikes() { "$jolon" run -w "$name" --frames 600 --pace max --without renderer --events events.json corner.cfg >/dev/null 2>&1; }
strikes
check "a truck strikes the corner of a building within a millimetre of its outline" python3 "$here/ground_features.py" corner events.json
sed -i 's/"truck"/"tank"/' corner.cfg
strikes
check "the gun of a tank strikes the wall behind it within a millimetre" python3 "$here/ground_features.py" wall events.json
"$ground" make --center 44.5,-71.5 --side 2000 --posts 12.5 --out small.ground --features village.geojson level.asc >/dev/null 2>&1
sed 's/"tank"/"truck"/; s/x.ground/small.ground/' corner.cfg >small.cfg
mv small.cfg corner.cfg
strikes
check "in a square of 2 km the corner is at the same place" python3 "$here/ground_features.py" corner events.json
cat >shore.cfg <<'TEXT'
terrain = { source = "file"; file = "x.ground"; };
world = { capacity = 64; };
vehicles = ( { kind = "tank"; name = "T2"; at = [20250.0, 30000.0]; heading_deg = 90.0; } );
TEXT
"$jolon" start -w "$name" --without renderer shore.cfg >/dev/null 2>&1
"$jolon" ctl -w "$name" scale 4 >/dev/null 2>&1
"$jolon" ctl -w "$name" drive T2 --throttle 1 --lease 100 >/dev/null 2>&1
sleep 8
"$bin/jolon-world" dump --json --world "$name" >places
sleep 2
"$bin/jolon-world" dump --json --world "$name" >later
"$jolon" stop -w "$name" >/dev/null 2>&1
check "a lake stops a tank at full throttle at its shore" python3 "$here/ground_features.py" shore places later

# --- a road over water ------------------------------------------------------------------------------------------
drive() { # frames name: runs name.cfg for so long, and writes where its vehicles are to places
    "$jolon" run -w "$name" --frames "$1" --pace max --without renderer --out "$2" --checkpoint "$2.img" "$2.cfg" >/dev/null 2>&1
    "$bin/jolon-world" create --world "$name" --set world.frames=0 --from "$2.img" >/dev/null 2>&1
    "$bin/jolon-world" dump --json --world "$name" >places
    "$bin/jolon-world" remove --world "$name" >/dev/null 2>&1
}
for posts in 12.5 25 125; do
    "$ground" make --center 44.5,-71.5 --side 2000 --posts $posts --out crossing.ground --roads crossing.geojson --features crossing.geojson level.asc >/dev/null 2>&1
    cat >crossing.cfg <<'TEXT'
terrain = { source = "file"; file = "crossing.ground"; };
world = { capacity = 64; };
vehicles = ( { kind = "tank"; name = "T3"; at = [24250.0, 24342.0]; roads = true; route = ( [24250.0, 24342.0], [25780.0, 25633.0] ); } );
TEXT
    drive 7800 crossing
    check "at posts of $posts m a tank drives along a road through a lake and over a river" python3 "$here/ground_features.py" crossed places
done

# A lake with cliffs of 10 m: columns of pixels of 10 m.
{
    printf 'ncols 240\nnrows 240\nxllcorner -1200\nyllcorner -1200\ncellsize 10\n'
    awk 'BEGIN { for (i = 0; i < 240 * 240; i++) printf "%d%s", (i % 240 >= 110 && i % 240 < 130 ? 70 : 80), (i % 240 == 239 ? "\n" : " ") }'
} >cliff.asc
gdal_translate -q -a_srs '+proj=tmerc +lat_0=44.5 +lon_0=-71.5 +datum=WGS84' cliff.asc cliff.tif
for posts in 12.5 25; do
    "$ground" make --center 44.5,-71.5 --side 2000 --posts $posts --out cliff.ground --roads gorge.geojson --features gorge.geojson cliff.tif >/dev/null 2>&1
    cat >cliff.cfg <<'TEXT'
terrain = { source = "file"; file = "cliff.ground"; };
world = { capacity = 64; };
vehicles = ( { kind = "truck"; name = "T3"; at = [24110.0, 25329.0]; roads = true; route = ( [24110.0, 25329.0], [25890.0, 24671.0] ); } );
TEXT
    drive 9000 cliff
    check "at posts of $posts m a truck crosses a lake 10 m below its banks" python3 "$here/ground_features.py" crossed places
done

# --- coastlines -------------------------------------------------------------------------------------------------
coast() { "$ground" make --center 44.5,-71.5 --side 2000 --posts 10 --out coast.ground --features "$1.geojson" level.asc 2>err; }
covers() { # at places on the way from the north-west corner, in steps of 10 m: land, bay, land, sea, island, sea
    "$ground" export --cover coast.ground coast.tif && gdal_translate -q -of XYZ coast.tif coast.xyz &&
        for at in '20 20' '40 40' '70 110' '140 180' '160 130' '180 130' '5 195' '195 5'; do
            set -- $at
            awk -v n=$(($2 * 201 + $1 + 1)) 'NR == n { printf "%s", ($3 == 6 ? "s" : "l") }' coast.xyz
        done
}
check "coastlines part land and sea" eval 'coast coast && [ "$(covers)" = lslslsll ] && ! grep -q coastlines err'
check "the file says how much is sea" eval '"$ground" info coast.ground | grep -Eq "^sea: [0-9]+ posts beyond coastlines"'
check "a coastline is no river" eval '"$ground" info coast.ground | grep -Eq "^features: .* 0 rivers$"'
check "coastlines that contradict each other are told" eval \
    'coast torn && grep -q "coastlines contradict each other at [0-9]* places .* the first at latitude 44.50" err'
check "a coastline between two rows of posts parts land and sea" eval \
    'coast beach && [ "$(covers)" = ssllllls ] && "$ground" info coast.ground | grep -q "^sea: 20301 posts" && ! grep -q coastlines err'
check "a strait from west to east is sea" eval 'coast strait && "$ground" info coast.ground | grep -q "^sea: 159[78][09] posts" && ! grep -q coastlines err'
check "coastlines from west to east that contradict each other are told, with the place" eval \
    'coast turned && grep -q "coastlines contradict each other at 1 places .* the first at latitude 44.4971., longitude -71.512" err'
check "coastlines that make no sea are told" eval \
    'coast islet && grep -q "coastlines make no post sea, the first at latitude 44\.[0-9]*, longitude -71\." err'

# --- out again -----------------------------------------------------------------------------------------------
cat >craters.cfg <<'TEXT'
terrain = { source = "file"; file = "small.ground"; };
world = { capacity = 64; };
fires = ( { at_s = 0.5; munition = "artillery"; point = [24700.0, 24700.0]; }, { at_s = 0.5; munition = "bomb"; point = [24720.0, 24710.0]; } );
TEXT
"$jolon" run -w "$name" --frames 900 --pace max --without renderer --checkpoint craters.img craters.cfg >/dev/null 2>&1
"$bin/jolon-world" create --world "$name" --set world.frames=0 --from craters.img >/dev/null 2>&1
check "the ground of a world is exported" "$ground" export --world "$name" --area 24680,24680,24740,24730 --step 0.5 craters.tif
"$bin/jolon-world" dump --world "$name" --terrain 24680,24680,24740,24730,0.5 >craters.csv
corner_at() { # EAST NORTH: the place so many metres from the middle, in degrees with letters
    echo "$1 $2" | gdaltransform -s_srs '+proj=tmerc +lat_0=44.5 +lon_0=-71.5 +datum=WGS84' -t_srs EPSG:4326 |
        awk '{ printf "%.9fN,%.9fW", $2, -$1 }'
}
for area in 24740,24730,24680,24680 "$(corner_at -320 320),$(corner_at -259.8 269.8)"; do
    "$ground" export --world "$name" --area "$area" --step 0.5 corners.tif
    check "the corners $area are the same area" eval 'gdalinfo -json corners.tif | json size | grep -q "\[121, 101\]" &&
        gdalinfo -json corners.tif | json geoTransform.0 | grep -Eq "^-320\.2[45]" && gdalinfo -json corners.tif | json geoTransform.3 | grep -Eq "^320\.2[45]"'
done
"$ground" export --world "$name" --cover all.tif
refuses_export() { # PATTERN OPTION...: in one line, with status 2
    local pattern=$1
    shift
    "$ground" export --world "$name" "$@" x.tif 2>err
    [ $? = 2 ] && [ "$(wc -l <err)" = 1 ] && grep -Eq -- "$pattern" err
}
check "an area of one corner is refused" refuses_export 'area 10,20: must be X0,Z0,X1,Z1 .* two places' --area 10,20
check "an area beyond the world is refused" refuses_export 'area 0,0,60000,10: must be X0,Z0,X1,Z1' --area 0,0,60000,10
check "too fine a step is refused" refuses_export 'step 0.5: makes 100001 x 100001 points' --step 0.5
"$bin/jolon-world" remove --world "$name" >/dev/null 2>&1
refuses "no such world" 1 "there is no world" "$ground" export --world "$name" x.tif
gdal_translate -q -of ENVI craters.tif craters.raw
check "it has the craters of the world" python3 "$here/ground_features.py" craters craters.csv craters.raw
check "it lies where the world does" eval 'gdalinfo -json craters.tif | json coordinateSystem.wkt | grep -q "44.5" && gdalinfo -json all.tif | json size | grep -q "4001, 4001"'

# --- digests -------------------------------------------------------------------------------------------------
cat >scene.cfg <<'TEXT'
world = { name = "village"; seed = 7; };
terrain = { source = "file"; file = "x.ground"; };
vehicles = ( { kind = "tank"; count = 40; force = "blue"; engage = "free"; behaviour = "patrol"; area = [24600, 24600, 25600, 25600]; },
             { kind = "jeep"; count = 40; force = "red"; behaviour = "patrol"; area = [24600, 24600, 25600, 25600]; },
             { kind = "helicopter"; count = 8; force = "red"; behaviour = "patrol"; area = [24000, 24000, 26000, 26000]; } );
TEXT
run() { "$jolon" run -w "$name" --frames 900 --pace max --without renderer --json "$@" scene.cfg 2>/dev/null; }
for threads in 1 2 4; do
    run --threads $threads --out out$threads >told$threads
done
check "they fight" eval '[ "$(json detonations <told1)" -gt 0 ]'
check "the digest is the same on 1, 2 and 4 threads" eval \
    '[ -s told1 ] && [ "$(json digest <told1)" = "$(json digest <told2)" ] && [ "$(json digest <told1)" = "$(json digest <told4)" ]'
run --pace real --out killed >toldk &
# On a busy machine a world is made in seconds; a kill before its first frame would be none.
for ((i = 0; i < 300; i++)); do
    [ "$(frame 2>/dev/null || echo 0)" -lt 10 ] || break
    sleep 0.1
done
for role in mover collider mover collider mover collider; do
    sleep 1
    "$jolon" kill -w "$name" $role KILL >/dev/null 2>&1
done
wait $!
check "the digest is the same after kills" eval '[ "$(json restarts <toldk)" -ge 3 ] && equal "$(json digest <toldk)" "$(json digest <told1)"'
check "a replay has the same digest" eval '"$jolon" replay out1/commands.log | grep -q "equal to the run"'
check "every frame is sound" "$jolon" replay out1/commands.log --physics
"$jolon" run -w "$name" --frames 1 --pace max --without renderer --set objects.source=none --json scene.cfg >bare 2>/dev/null
check "a scenario can leave the objects out" eval '[ "$(json fixed_objects <bare)" = 0 ]'
refuses "objects of a file without the file" 1 'objects.source = file: needs terrain.source = "file"' \
    "$jolon" run -w "$name" --set objects.source=file duel
done_testing
