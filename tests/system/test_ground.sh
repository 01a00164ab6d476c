#!/usr/bin/env bash
# Ground files: made from a real tile of heights and from maps that are wrong, compared with the tile,
# and run: digests on 1, 2 and 4 threads, replay, another file refused.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/lib.sh"
ground=$bin/jolon-ground
mkdir -m 700 "$JOLON_RUNTIME_DIR"
if [ ! -x "$ground" ]; then
    skip "ground files" "there is no jolon-ground here; make ground builds it"
    done_testing
fi
make() { "$ground" make --center "$center" --side "${side:-50000}" --posts "${posts:-125}" --out "${out:-x.ground}" "$@"; }
hash_of() { "$ground" info --json "$1" | json hash; }
# refuses_map NAME PATTERN ARGUMENT...: make refuses in one line, and leaves no file.
refuses_map() {
    local what=$1 pattern=$2
    shift 2
    rm -f x.ground
    refuses "$what" 1 "$pattern" make "$@"
    check "$what: nothing is left" [ -z "$(find . -name "*ground*")" ]
}

# --- maps that are made here, and are wrong ---------------------------------------------------------------
# map FILE WEST NORTH EAST SOUTH [OPTION...]: a raster of one value, at 0.001 degrees
map() {
    local file=$1 size
    size=$(awk "BEGIN { printf \"%.0f %.0f\", ($4 - $2) * 1000, ($3 - $5) * 1000 }")
    local place=(-a_ullr "$2" "$3" "$4" "$5")
    shift 5
    # shellcheck disable=SC2086 # two numbers
    gdal_create -q -outsize $size "${place[@]}" -a_srs EPSG:4326 "$@" "$file" 2>/dev/null
}
if command -v gdal_create >/dev/null; then
    side=1000 posts=125 center=10.5,20.5
    map level.tif 20 11 21 10 -ot Float32 -burn 300
    check "a level map becomes a level ground" eval 'make level.tif 2>err && "$ground" info --json x.ground | tee info | json lowest_m | grep -qx -- 300'
    check "without a map of cover, the file says that its cover is guessed" eval '[ "$(json cover_guessed <info)" = True ] && grep -q "guessed from slope" err'
    check "the warning counts the posts" grep -q '81 of 81 posts' err

    # 10.5,20.5 in other forms
    center=10.5N,20.5E
    check "a middle in degrees with letters is the same" eval 'make level.tif 2>/dev/null && "$ground" info --json x.ground | json hash | grep -qx -- "$(json hash <info)"'
    center=34PDS4528760739
    check "a middle by the MGRS lies within a metre" eval 'make level.tif 2>/dev/null && "$ground" info --json x.ground | json latitude_deg | grep -Eq "^10\.(50000|49999)"'
    center=10.5,20.5
    map sea.tif 20 11 21 10 -ot Int16 -burn -430
    check "ground below the sea level is kept" eval 'make sea.tif 2>/dev/null && "$ground" info --json x.ground | json highest_m | grep -qx -- -430'
    map feet.tif 20 11 21 10 -ot Int16 -burn 14505
    refuses_map "heights above 9,000 m" 'feet.tif: has the height 14505 m in column [0-9]+, row [0-9]+.*--feet' feet.tif
    check "heights in feet become metres" eval 'make --feet feet.tif 2>/dev/null && "$ground" info --json x.ground | json highest_m | grep -q "^4421.1"'
    map huge.tif 20 11 21 10 -ot Float32 -burn 1e38
    refuses_map "a map of 1e38" 'no height at latitude 10\.50.* 81 of 81 posts' huge.tif
    map nan.tif 20 11 21 10 -ot Float32 -burn nan
    refuses_map "a map of NaN" 'no height at latitude 10\.50.* 81 of 81 posts' nan.tif
    check "voids are filled from a coarser map" eval 'make nan.tif level.tif 2>/dev/null && "$ground" info --json x.ground | json lowest_m | grep -qx -- 300'
    awk 'BEGIN { print "ncols 9\nnrows 9\nxllcorner 20.491\nyllcorner 10.491\ncellsize 0.002"
        for (i = 1; i <= 81; i++) printf "%s%s", (i == 41 ? "1e38" : "300.5"), (i % 9 ? " " : "\n") }' >hole.asc
    gdal_translate -q -a_srs EPSG:4326 hole.asc hole.tif
    check "a pixel of 1e38 is mended, with the map, the number and the place" eval \
        'make hole.tif 2>err && grep -Eq "hole.tif: [0-9]+ posts without a height were interpolated; the first at latitude 10.501[0-9]{2}, longitude 20.498[0-9]{2}$" err'
    # The same holes as a mark of voids, and with 0 m below a mask within, beside and as a second band.
    python3 - <<'P'
import random
draw = random.Random(17)
rows = [[0 if abs(r - 150) < 4 and abs(c - 150) < 4 else draw.randint(290, 310) for c in range(300)] for r in range(300)]
head = "ncols 300\nnrows 300\nxllcorner 20.49\nyllcorner 10.49\ncellsize 0.0000666666666666\n"
for name, of in (("void.asc", lambda v: v), ("shown.asc", lambda v: 255 if v else 0)):
    open(name, "w").write(head + "\n".join(" ".join(str(of(v)) for v in row) for row in rows) + "\n")
P
    gdal_translate -q -a_srs EPSG:4326 -ot Int16 -a_nodata none void.asc zero.tif
    gdal_translate -q -a_srs EPSG:4326 -ot Int16 -a_nodata 0 void.asc marked.tif
    gdal_translate -q -a_srs EPSG:4326 -ot Int16 -a_nodata none shown.asc shown.tif
    gdalbuildvrt -q -separate both.vrt zero.tif shown.tif
    gdal_translate -q --config GDAL_TIFF_INTERNAL_MASK YES -b 1 -mask 2 both.vrt within.tif
    gdal_translate -q --config GDAL_TIFF_INTERNAL_MASK NO -b 1 -mask 2 both.vrt beside.tif
    gdal_translate -q -ot UInt16 -colorinterp gray,alpha both.vrt alpha.tif
    gdal_translate -q -colorinterp gray,alpha both.vrt other.tif
    refuses_map "a band of transparency that GDAL does not heed" 'other.tif: has 2 bands; .* -b 1 -mask 2 other.tif' other.tif
    for posts in 5 25; do
        make marked.tif >/dev/null 2>&1 && hash_of x.ground >marked
        for file in within beside alpha; do
            check "heights under a mask ($file, posts of $posts m) are voids" eval 'make $file.tif 2>err && grep -q "$file.tif: [0-9]* posts without a height" err && equal "$(hash_of x.ground)" "$(cat marked)"'
        done
    done
    gdal_translate -q -b 2 -mask 2 both.vrt shown-alone.tif
    echo '255 forest' >shown.txt
    check "cover under a mask is guessed" eval 'make --cover shown-alone.tif --classes ./shown.txt marked.tif 2>err && grep -q "no map of cover for 4 of 1681 posts" err'
    posts=125
    gdal_translate -q -a_srs EPSG:4326 -tr 0.006 0.006 hole.tif coarse.tif
    check "of several maps the finest is named" eval 'make coarse.tif hole.tif 2>err && grep -q "hole.tif and the coarser maps there: " err'
    map void.tif 20 11 21 10 -ot Int16 -burn -32768 -a_nodata -32768
    refuses_map "a map of voids" 'no height at' void.tif
    map away.tif 40 11 41 10 -ot Int16 -burn 5
    refuses_map "a map that lies elsewhere" 'away.tif.*the files have latitude 10.0000 to 11.0000, longitude 40.0000 to 41.0000' away.tif
    center=20.5,10.5
    refuses_map "a middle with its longitude first" 'longitude 20.0000 to 21.0000. Is --center LONGITUDE,LATITUDE instead of LATITUDE,LONGITUDE\?$' level.tif
    center=10.999,20.5
    refuses_map "a map of half of the square" 'level.tif.*nor within 500 m' level.tif
    map turned.tif 287.5 45 288.5 44 -ot Int16 -burn 5
    center=44.999,-72
    refuses_map "a map of 0 to 360 degrees has its longitudes told from -180 to 180" \
        'turned.tif: no height at latitude 45.00[0-9]+, longitude -72.00.* latitude 44.0000 to 45.0000, longitude -72.5000 to -71.5000' turned.tif
    center=10.5,20.5
    map colours.tif 20 11 21 10 -ot Byte -bands 3 -burn 1 -burn 2 -burn 3
    refuses_map "a picture" 'colours.tif: has 3 bands' colours.tif
    gdal_create -q -outsize 100 100 -burn 5 nowhere.tif
    refuses_map "a map without a place" 'nowhere.tif: does not say where on the earth' nowhere.tif
    gdal_create -q -outsize 100 100 -a_ullr 500000 200000 600000 100000 -a_srs EPSG:4326 -burn 5 metres.tif
    refuses_map "metres that are called degrees" 'metres.tif: its corner .* lies nowhere on the earth' metres.tif
    gdal_create -q -outsize 100 100 -a_ullr 20 11 21 10 -burn 5 bare.tif
    refuses_map "a map without a projection" 'bare.tif: does not say its projection.*-a_srs' bare.tif
    gdal_create -q -outsize 1 1 -a_ullr 20 11 21 10 -a_srs EPSG:4326 -burn 5 one.tif
    refuses_map "a map of one pixel" 'one.tif: has 1 x 1 pixels' one.tif
    echo text >words.txt
    refuses_map "a text" 'words.txt: GDAL cannot read it' words.txt
    refuses_map "no file" 'missing.tif: GDAL cannot read it as a raster: No such file or directory' missing.tif
    refuses_map "a folder" '\.: GDAL cannot read it as a raster: it is a folder' .
    : >empty.tif
    refuses_map "an empty file" 'empty.tif: GDAL cannot read it as a raster: it is empty' empty.tif
    refuses_map "no map of roads" 'missing.osm: GDAL cannot read it as a map of points, lines and areas: No such file' --roads missing.osm level.tif
    gdal_translate -q -of ENVI level.tif raw.bil && head -c 2000000 raw.bil >part.bil && mv part.bil raw.bil
    refuses_map "a raw map that is shorter than its header says" 'raw.bil: has 2000000 bytes; its 1000 x 1000 pixels take 4000000 at least' raw.bil
    gdal_translate -q -a_srs EPSG:4979 level.tif ellipsoid.tif
    check "heights above the ellipsoid are told" eval 'make ellipsoid.tif 2>err && grep -q "ellipsoid.tif: says that its heights are above the ellipsoid" err'

    for datum in EPSG:4326+5773 EPSG:4326+3855 EPSG:32634+5773; do
        gdal_translate -q -a_srs $datum level.tif sea-level.tif
        [ $datum = EPSG:32634+5773 ] && gdalwarp -q -overwrite -s_srs EPSG:4326 -t_srs EPSG:32634 level.tif utm.tif && gdal_translate -q -a_srs $datum utm.tif sea-level.tif
        check "heights above the sea level of $datum are not warned of" eval 'make sea-level.tif 2>err && ! grep -q ellipsoid err'
    done
    for form in GTiff VRT; do # with a unit of the band, and without one
        gdal_translate -q -of $form -a_srs EPSG:4269+6360 level.tif survey
        check "feet of a vertical datum become metres ($form)" eval 'make survey 2>err && ! grep -q ellipsoid err && "$ground" info --json x.ground | json highest_m | grep -qx -- 91.4375'
    done
    # What is made replaces ground files alone: no map that is read, no pipe, no folder.
    for file in level.tif ./level.tif; do
        out=$file refuses "a ground over its map" 1 'level.tif: is read, and what is made would replace it' make level.tif
    done
    ln level.tif link.ground
    out=link.ground refuses "a ground over another name of its map" 1 'link.ground: is read' make level.tif
    cp level.tif cover.tif
    out=cover.tif refuses "a ground over its cover" 1 'cover.tif: is read' make --cover cover.tif level.tif
    check "the maps are left" cmp level.tif cover.tif
    rm link.ground cover.tif
    mkfifo pipe && out=pipe refuses "a ground over a pipe" 1 'pipe: is a pipe or a device, not a file' make level.tif
    make level.tif >/dev/null 2>&1 && cp x.ground kept
    for verb in show export; do
        refuses "$verb over its ground" 1 'x.ground: is read' "$ground" $verb x.ground x.ground
        refuses "$verb over a pipe" 1 'pipe: is a pipe' "$ground" $verb x.ground pipe
    done
    for input in pipe "--cover pipe level.tif" "--roads pipe level.tif" "--features pipe level.tif" "--cover level.tif --classes ./pipe level.tif"; do
        # shellcheck disable=SC2086 # options and their values
        refuses "a pipe as an input: $input" 1 'pipe: is a pipe or a device, which cannot be read as a map' timeout 10 "$ground" make --center $center --side 1000 --posts 125 --out none.ground $input
    done
    check "the ground and the pipe are left" eval 'cmp x.ground kept && [ -p pipe ]'
    rm -f kept pipe
    check "info tells the side of a world on it" eval '"$ground" info x.ground | grep -q "^side  *1 km, in the middle of a world of 50 km$" && [ "$("$ground" info --json x.ground | json world_side_m)" = 50000 ]'
    head -c 30000 level.tif >cut.tif
    refuses_map "a map that is cut off" 'cut.tif: ' cut.tif
    gdal_create -q -outsize 100 100 -a_ullr 20 11 21 10 -a_srs EPSG:4326 -ot Int16 -burn 5 wide.tif
    python3 - <<'P' # 20,000 columns instead of 100
data = bytearray(open("wide.tif", "rb").read())
first = int.from_bytes(data[4:8], "little")
entry = next(at for at in range(first + 2, len(data), 12) if data[at:at + 2] == b"\0\x01")
data[entry + 8:entry + 10] = (20000).to_bytes(2, "little")
open("wide.tif", "wb").write(data)
P
    refuses_map "a TIFF whose header lies" 'wide.tif: its first block has [0-9]+ bytes; 20000 columns take [0-9]+' wide.tif

    # The same heights in another projection, and beyond the date line.
    gdal_create -q -outsize 100 100 -a_ullr -6000000 6000000 6000000 -6000000 -a_srs '+proj=laea +lat_0=90 +datum=WGS84' -ot Int16 -burn 77 pole.tif
    center=83,-179.9
    check "a map around the pole" eval 'make pole.tif 2>/dev/null && "$ground" info --json x.ground | json lowest_m | grep -qx -- 77'
    center=30,0 refuses_map "a map around the pole is said to reach it" 'the files have latitude [0-9.]+ to 90.0000, longitude -180.0000 to 180.0000$' pole.tif
    center=90,0 refuses "a square at the pole" 2 'too near the pole' make pole.tif
    map west.tif 179.5 1 180 -1 -ot Int16 -burn 40
    map east.tif -180 1 -179.5 -1 -ot Int16 -burn 40
    center=0,179.9999
    check "a square across the date line" eval 'side=20000 make west.tif east.tif 2>err && "$ground" info --json x.ground | json highest_m | grep -qx -- 40'
    check "the date line has one hash from both sides" eval 'for center in 0,180 0,-180; do side=20000 make west.tif east.tif >/dev/null 2>&1 && hash_of x.ground; done | uniq -c | grep -q "^ *2 "'
    check "both maps count there" eval '! grep -q "no post" err && [ "$("$ground" info x.ground | grep -c ^heights:)" = 2 ]'
    map equator.tif -1 1 1 -1 -ot Int16 -burn 40
    check "a place on the equator and the first meridian has one hash" eval 'for center in 0,0 -0.0,-0 0S,0W 0N,0E; do make equator.tif >/dev/null 2>&1 && hash_of x.ground; done | uniq -c | grep -q "^ *4 "'

    # One band of the earth, from other beginnings: around the earth, with one column twice, and in parts.
    python3 - <<'P'
def band(name, west, columns, value=lambda row, column: (row * 37 + column % 360 * 101) % 97):
    with open(name + ".asc", "w", encoding="ascii") as file:
        file.write(f"ncols {columns}\nnrows 8\nxllcorner {west}\nyllcorner -4\ncellsize 1\n")
        file.writelines(" ".join(str(value(row, west + k)) for k in range(columns)) + "\n" for row in range(8))
    with open(name + ".prj", "w", encoding="ascii") as file:
        file.write('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
band("world", -180, 360)
band("round", 0, 360)
band("part", 90, 180)
band("middle", -90, 180)
band("more", -200, 361)
band("west_half", -180, 180)
band("classes", -180, 360, lambda row, column: 80 if column < 0 else 10)
P
    has_hash() { # HASH MAP...
        side=300000 posts=2000 make "${@:2}" && equal "$(hash_of x.ground)" "$1"
    }
    for place in '0.2,180 part' '0.2,-179.99 part' '0.2,0 middle' '0.2,-0.01 middle' '0.2,160 part'; do
        center=${place% *}
        side=300000 posts=2000 make "${place#* }.asc" >/dev/null 2>&1
        as_it_is=$(hash_of x.ground)
        for map in world.asc round.asc more.asc "west_half.asc world.asc"; do
            # shellcheck disable=SC2086 # some are two maps
            check "a square about $center in $map, which goes round the earth" has_hash "$as_it_is" $map
        done
    done
    center=0,180
    check "classes of cover go round the earth" eval 'side=20000 make --cover classes.asc world.asc 2>err && [ ! -s err ] &&
        "$ground" check x.ground | grep -q "forest 49.7 %, lake 50.3 %"'

    # Classes of cover.
    center=10.5,20.5
    map water.tif 20 11 21 10 -ot Byte -burn 80
    check "classes become cover" eval 'make --cover water.tif level.tif 2>err && "$ground" check x.ground | grep -q "lake 100.0 %" && [ ! -s err ]'
    map strange.tif 20 11 21 10 -ot Byte -burn 77
    refuses_map "a class that the table does not know" 'strange.tif: has class 77 at latitude 10\.5.*--classes' --cover strange.tif level.tif
    echo '77 forest # of my own' >own.txt
    check "a table of one's own" eval 'make --cover strange.tif --classes ./own.txt level.tif && "$ground" check x.ground | grep -q "forest 100.0 %"'
    map codes.tif 20 11 21 10 -ot Int16 -burn 312
    check "CORINE's classes have codes, too" eval 'make --cover codes.tif --classes corine level.tif && "$ground" check x.ground | grep -q "forest 100.0 %"'
    map half.tif 20 11 20.5 10 -ot Byte -burn 10
    refuses_map "an unknown class in the second map" 'strange.tif: has class 77 at' --cover half.tif --cover strange.tif level.tif
    echo '77 wood' >own
    refuses_map "a table of this folder with a wrong word" 'ground: own:1: wood: no such cover' --cover strange.tif --classes own level.tif
    mv own own.txt
    refuses_map "a table with a wrong word" 'own.txt:1: wood: no such cover; allowed: grass' --cover strange.tif --classes ./own.txt level.tif
    printf '10 forest\n77 rock\n10 grass\n' >twice.txt
    refuses_map "a table with a class twice" 'twice.txt:3: class 10 has a cover already' --cover strange.tif --classes ./twice.txt level.tif
    refuses "trees without a map of woods" 2 '--trees and --seed go with --features' make --trees 5 level.tif
    refuses "a seed of trees without a map of woods" 2 '--trees and --seed go with --features' make --seed 5 level.tif
    refuses "a table without a map of cover" 2 '--classes goes with --cover' make --classes nlcd level.tif
    refuses_map "no table" 'nolist: no such table' --cover strange.tif --classes nolist level.tif
    rm -f ./*.ground
else
    skip "maps that are wrong" "no gdal_create here"
fi
center=44,7
side=50001 refuses "a side that is no multiple of 125 m" 2 'side 50001: must be a multiple of 125 m' make x.tif
side=1000 posts=300 refuses "posts that do not divide the side" 2 'posts 300: the side, 1000 m' make x.tif
side=900 refuses "a side that is too short" 2 '1000 to 500000|1000..500000' make x.tif
for center in here 100,200 44.5,71.5,3; do
    refuses "a middle at $center" 2 'center .*: must be LATITUDE,LONGITUDE in degrees, south and west negative.*or a reference of the MGRS' make x.tif
done
center=44,7
refuses "a place that is none" 2 'center' "$ground" make --center 44 --side 1000 --out x.ground x.tif

# --- a real tile -------------------------------------------------------------------------------------------
find_source_dir
tile=$source_dir/../shared/data/terrain/N44W072.hgt
[ -e "$tile" ] || tile=$source_dir/../../shared/data/terrain/N44W072.hgt
if [ ! -e "$tile" ]; then
    skip "a ground from a real tile" "the tile of heights N44W072.hgt is not here"
    done_testing
fi
center=44.45,-71.45 side=50000 posts=31.25
for threads in 1 2 4; do
    out=t$threads.ground make --threads $threads "$tile" >/dev/null 2>&1
done
check "the file is the same on 1, 2 and 4 threads" eval 'cmp t1.ground t2.ground && cmp t1.ground t4.ground'
gdal_translate -q "$tile" tile.tif
gdal_translate -q -outsize 50% 50% -r average "$tile" coarse.tif
out=tif.ground make tile.tif >/dev/null 2>&1
check "a GeoTIFF of the same heights gives the same hash" equal "$(hash_of tif.ground)" "$(hash_of t1.ground)"
out=both.ground make coarse.tif "$tile" >/dev/null 2>&1
check "the finest map counts" equal "$(hash_of both.ground)" "$(hash_of t1.ground)"
out=turned.ground make "$tile" coarse.tif >/dev/null 2>&1
check "the order of the files does not matter" equal "$(hash_of turned.ground)" "$(hash_of both.ground)"
gdal_translate -q -srcwin 0 0 700 1201 "$tile" half-west.tif
gdal_translate -q -srcwin 700 0 501 1201 "$tile" half-east.tif
out=halves.ground make half-east.tif half-west.tif >/dev/null 2>&1
check "two halves of a map join without a seam" equal "$(hash_of halves.ground)" "$(hash_of t1.ground)"
check "every block is good" "$ground" check t1.ground
cp "$tile" mountains.hgt
out=none.ground refuses "a tile whose name says no place" 1 'mountains.hgt: is as long as a tile of heights, but its name does not say where' make mountains.hgt
rm mountains.hgt
mkdir cut && head -c 2000000 "$tile" >cut/N44W072.hgt
out=cut/x.ground refuses "a tile that is cut off" 1 'N44W072.hgt: has 2000000 bytes; a tile of heights has 2884802' make cut/N44W072.hgt
python3 - "$tile" <<'TEXT'
import sys
data = open(sys.argv[1], "rb").read()
open("flipped.bin", "wb").write(b"".join(data[i * 2402:(i + 1) * 2402] for i in reversed(range(1201))))
TEXT
step=0.00083333333333333333
cat >flipped.vrt <<TEXT
<VRTDataset rasterXSize="1201" rasterYSize="1201"><SRS>EPSG:4326</SRS>
<GeoTransform>-72.000416666666666667,$step,0,43.999583333333333333,0,$step</GeoTransform>
<VRTRasterBand dataType="Int16" band="1" subClass="VRTRawRasterBand"><NoDataValue>-32768</NoDataValue>
<SourceFilename relativeToVRT="1">flipped.bin</SourceFilename><ByteOrder>MSB</ByteOrder></VRTRasterBand></VRTDataset>
TEXT
out=flipped.ground make flipped.vrt >/dev/null 2>&1
check "a map upside down gives the same hash" equal "$(hash_of flipped.ground)" "$(hash_of t1.ground)"
gdal_create -q -outsize 100000 100000 -ot Float32 -co SPARSE_OK=TRUE -co BIGTIFF=YES -co TILED=YES -a_srs EPSG:4326 -a_ullr -72 45 -71 44 -a_nodata 7 sparse.tif
out=sparse.ground make sparse.tif "$tile" >/dev/null 2>&1
check "a map of 40 GB without heights changes nothing" equal "$(hash_of sparse.ground)" "$(hash_of t1.ground)"
head -c 1000000 t1.ground >cut.ground
refuses "a file that is cut off" 1 'cut.ground: has 1000000 bytes, and its header says' "$ground" check cut.ground

# A kill leaves the old file, whenever it comes; the next make removes what the killed one left aside.
cp t1.ground old.ground
killed=0
for after in 0.05 0.2 0.4 0.8 1.6; do
    posts=12.5 out=old.ground
    "$ground" make --center $center --side $side --posts $posts --out $out "$tile" >/dev/null 2>&1 &
    sleep $after
    kill -KILL $! 2>/dev/null
    wait $! 2>/dev/null
    [ $? = 137 ] || { cp t1.ground old.ground && break; } # it had ended before
    killed=$((killed + 1))
    cmp -s old.ground t1.ground || break
done
posts=31.25
check "a kill leaves the old file" eval "cmp old.ground t1.ground && [ $killed -gt 1 ]"
out=old.ground make "$tile" >/dev/null 2>&1
check "nothing is left aside" [ -z "$(find . -name '.old.ground*')" ]

"$ground" export t1.ground t1.tif && gdal_translate -q -of ENVI t1.tif t1.raw
python3 "$here/ground.py" heights "$tile" t1.raw $side 1601 44.45 -71.45 >spread
# Between posts a plane stands for the map's curved surface; at posts the step of 1/64 m is left.
check "heights are those of the tile: rms below 0.5 m" awk 'NR == 1 { exit !($1 < 0.5) }' spread
check "at the posts they are the same within 2 cm" awk 'NR == 2 { exit !($2 < 0.02) }' spread
sed 's/^/# root of the mean square, largest difference [m]: /' spread
"$ground" show --grey --size 1601 t1.ground grey.png
gdaldem hillshade -q t1.tif hill.tif
gdal_translate -q -of ENVI grey.png grey.raw
gdal_translate -q -of ENVI hill.tif hill.raw
check "the shade is that of gdaldem hillshade, within 1 of 255" python3 -c '
a, b = (open(name, "rb").read() for name in ("grey.raw", "hill.raw"))
side = 1601
inner = [i for i in range(side * side) if 0 < i % side < side - 1 and 0 < i // side < side - 1]
worst = max(abs(a[i] - b[i]) for i in inner)
print(worst)
raise SystemExit(worst > 1)'

# --- roads ---------------------------------------------------------------------------------------------------
# A road to the east, a road to the south through a node of it, a footway, a way of one node, and one with a
# node that is missing.
python3 - >roads.osm <<'TEXT'
east = [(1 + k, 44.45 + 0.002 * (k * 7 % 3 - 1), -71.75 + 0.006 * k) for k in range(101)]
south = [(201 + k, 44.25 + 0.004 * k, -71.45 + 0.001 * (k * 5 % 3 - 1)) for k in range(101)]
south[50] = east[50]
ways = [(east, "primary"), (south, "secondary"), (east[:3], "footway"), (east[7:8], "primary"),
        ([east[8], (9999, 0, 0), east[9]], "tertiary")]
print('<osm version="0.6">')
for number, latitude, longitude in sorted(set(east + south)):
    print(f'<node id="{number}" lat="{latitude:.7f}" lon="{longitude:.7f}" version="1"/>')
for number, (way, word) in enumerate(ways):
    nodes = "".join(f'<nd ref="{node[0]}"/>' for node in way)
    print(f'<way id="{number + 1}" version="1">{nodes}<tag k="highway" v="{word}"/></way>')
print("</osm>")
TEXT
out=roads.ground make --roads roads.osm "$tile" >/dev/null 2>&1
check "roads of OpenStreetMap are kept, footways are not" eval '"$ground" info roads.ground | grep -q "^roads: 3, 103.3 of 103.3 km"'
check "posts beside them are road" eval '"$ground" check roads.ground | grep -q "road 0.2 %"'
ogr2ogr -f GeoJSON roads.geojson roads.osm lines >/dev/null 2>&1
out=lines.ground make --roads roads.geojson "$tile" >/dev/null 2>&1
check "GeoJSON with the same lines gives the same hash" equal "$(hash_of lines.ground)" "$(hash_of roads.ground)"
out=none.ground refuses "roads from a text" 1 'words.txt: GDAL cannot read it as a map of points, lines and areas' make --roads words.txt "$tile"
cat >convoy.cfg <<'TEXT'
world = { name = "white-mountains"; seed = 7; };
terrain = { source = "file"; file = "roads.ground"; };
vehicles = ( { kind = "jeep"; count = 4; force = "blue"; formation = "column"; roads = true;
               route = ( [24000.0, 25000.0], [26500.0, 25000.0], [25000.0, 27000.0] ); } );
TEXT
"$jolon" run -w "$name" --frames 6000 --pace max --without renderer --out convoy --checkpoint convoy.img convoy.cfg >/dev/null 2>&1
"$bin/jolon-world" create --world "$name" --set world.frames=0 --from convoy.img >/dev/null 2>&1
"$bin/jolon-world" dump --json --world "$name" >places
"$bin/jolon-world" remove --world "$name" >/dev/null 2>&1
check "a convoy is on a road after 100 s" python3 "$here/ground.py" convoy places roads.osm 44.45 -71.45 50000 12

# --- a world on it -----------------------------------------------------------------------------------------
cat >scene.cfg <<'TEXT'
world = { name = "white-mountains"; seed = 7; };
terrain = { source = "file"; file = "x.ground"; };
vehicles = ( { kind = "tank"; count = 60; force = "blue"; behaviour = "patrol"; area = [20000, 20000, 24000, 24000]; },
             { kind = "jeep"; count = 60; force = "red"; behaviour = "patrol"; area = [20000, 20000, 24000, 24000]; },
             { kind = "helicopter"; count = 10; force = "red"; behaviour = "patrol"; area = [20000, 20000, 24000, 24000]; } );
TEXT
mv t1.ground x.ground
run() { "$jolon" run -w "$name" --frames 600 --pace max --without renderer --json "$@" scene.cfg 2>/dev/null; }
for threads in 1 2 4; do
    run --threads $threads --out out$threads >told$threads
done
check "the digest is the same on 1, 2 and 4 threads" eval \
    '[ -s told1 ] && [ "$(json digest <told1)" = "$(json digest <told2)" ] && [ "$(json digest <told1)" = "$(json digest <told4)" ]'
check "a replay has the same digest" eval '"$jolon" replay out1/commands.log | grep -q "equal to the run"'
check "every frame is sound" "$jolon" replay out1/commands.log --physics
check "the log has the hash of the ground" grep -q "\"ground=$(hash_of x.ground) $PWD/x.ground\"" out1/commands.log
check "a path from the command line" eval 'mv x.ground y.ground && run --set terrain.file=y.ground --out out5 >told5 && [ -s told5 ]'
check "another name is the same ground" equal "$(json digest <told5)" "$(json digest <told1)"
refuses "the replay without the file" 1 'terrain.file = x.ground: no such file' "$jolon" replay out1/commands.log
out=x.ground make --posts 62.5 "$tile" >/dev/null 2>&1
refuses "a replay on another ground" 1 "was recorded on the ground $(hash_of y.ground) .*x.ground now has another" "$jolon" replay out1/commands.log
side=60000 posts=125 center=44.5,-71.5 out=x.ground make "$tile" >/dev/null 2>&1
refuses "a world smaller than its square" 1 'terrain.file = x.ground: its square has a side of 60000 m, and terrain.side_m is 50000' \
    "$jolon" run -w "$name" --set terrain.side_m=50000 scene.cfg
check "a larger square has a world of its own side" eval 'run --frames 60 --out out6 >told6 && [ -s told6 ]'
mv cut.ground x.ground
refuses "a world on a file that is cut off" 1 'x.ground: has 1000000 bytes' "$jolon" run -w "$name" scene.cfg
refuses "a file without its source" 1 'terrain.file = y.ground: needs terrain.source = "file"' \
    "$jolon" run -w "$name" --set terrain.source=flat --set terrain.file=y.ground scene.cfg
done_testing
