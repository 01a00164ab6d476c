#!/usr/bin/env bash
# Damaged worlds: flipped bits, wrong objects under the world's name, memory that is taken away.
# Each damage is either refused with one line, or the world goes on unharmed. Nothing is left
# behind.
. "$(dirname "$0")/lib.sh"

cat >good.cfg <<'C'
world = { seed = 3; capacity = 256; pace = "max"; };
terrain = { source = "flat"; spacing_m = 125.0; };
collision = { shape = "sphere"; };
objects = ( { kind = "tree"; at = [25120.0, 25120.0]; } );
vehicles = ( { kind = "tank"; count = 12; force = "blue"; fire_at_will = true; area = [25000.0, 25000.0, 25150.0, 25150.0]; },
             { kind = "jeep"; count = 12; force = "red"; fire_at_will = true; area = [25100.0, 25100.0, 25300.0, 25300.0]; } );
fires = ( { at_s = 0.5; munition = "artillery"; point = [25100.0, 25100.0]; } );
C
world() { "$bin/jolon-world" "$@"; }
create() { # sets $shm to the object's path
    world create --world "$name" "$@" good.cfg || return
    shm=$(path_of object)
}
remove() { world remove --world "$name"; }

# Runs the world's mover and collider to the end of the run, or until the mover refuses.
roles() {
    "$bin/jolon-collider" --world "$name" 2>>log &
    local collider=$! status
    "$bin/jolon-mover" --world "$name" 2>>log
    status=$?
    [ $status = 0 ] || kill $collider 2>/dev/null
    wait $collider && return $status
}

# Like refuses of lib.sh, for a world that exists and stays.
refused() {
    local what=$1 pattern=$2 got
    shift 2
    "$@" >stdout 2>stderr </dev/null
    got=$?
    # A role's first line says that it has started.
    grep -v ' info frame 0: ' stderr >said
    mv said stderr
    if [ $got = 1 ] && [ "$(wc -l <stderr)" = 1 ] && grep -Eq -- "$pattern" stderr; then ok "$what"; else
        not_ok "$what"
        echo "# exit $got, wanted 1 and $pattern"
        sed 's/^/# /' stderr
    fi
}

# flip OFFSET: flips one bit of the byte at the offset.
flip() {
    python3 - "$shm" "$1" <<'P'
import sys
with open(sys.argv[1], "r+b", buffering=0) as world:
    world.seek(int(sys.argv[2]))
    byte = world.read(1)[0]
    world.seek(int(sys.argv[2]))
    world.write(bytes([byte ^ 16]))
P
}

# Prints where the rows of this frame's buffer begin. Its head begins a page and holds the frame's
# number.
buffer_of() {
    python3 - "$shm" "$1" <<'P'
import struct, sys
data = open(sys.argv[1], "rb").read()
frame = int(sys.argv[2])
for at in range(0, len(data), 4096): # a head begins: frame, tick, ...; the commit word's page does not
    words = struct.unpack_from("<4Q", data, at)
    if words[0] == frame and words[1] == frame and words[3] != 0:
        print(at + 512 + 64)
        break
P
}

# --- the undisturbed run --------------------------------------------------------------------------
check "an undamaged world is made" create --set world.frames=300
check "the world runs" roles
right=$(world digest --world "$name")
check "check finds the world good" world check --world "$name"
remove

# --- bits of the body -----------------------------------------------------------------------------
create --set world.frames=150 >/dev/null
roles
hash_at=$(buffer_of 150)
check "the last frame's buffer is found" [ -n "$hash_at" ]
flip "$hash_at"
refused "check finds a flipped bit of the last frame" 'frame.* checksum.*repair' world check --world "$name"
check "repair goes back one frame" world repair --world "$name"
world repair --world "$name" >told 2>&1
check "repair then finds the world good" grep -q 'good at frame 149' told
roles
check "the roles compute the frame again" equal "$(world frame --world "$name")" 150
flip "$hash_at"
flip "$(buffer_of 149)"
refused "repair refuses two damaged buffers and names both" 'both buffers: .*world [AB].*world [AB]' world repair --world "$name"
refused "adoption refuses a world with two damaged buffers" 'both buffers.*jolon clean' create --set world.frames=150 --adopt
check "the refused world still exists" [ -e "$shm" ]
remove

# A set dies, a bit is flipped, and the next start ends the run as the undisturbed one did.
"$jolon" run -w "$name" --frames 300 --set world.pace=real --without renderer --without reporter --out out good.cfg >/dev/null 2>&1 &
run=$!
far() { [ "$(world frame --world "$name")" -ge 60 ]; }
eventually far
shm=$(path_of object)
kill -KILL $run
wait $run 2>/dev/null
unheld() { ! world pid --world "$name" mover && ! world pid --world "$name" collider; }
check "the roles die with their supervisor" eventually unheld
frame=$(world frame --world "$name")
flip "$(buffer_of "$frame")"
refused "a mover that takes over finds the flipped bit" "is damaged: frame $frame fails its checksum" "$bin/jolon-mover" --world "$name"
"$jolon" run -w "$name" --frames 300 --set world.pace=real --without renderer --without reporter --out out good.cfg >stdout 2>told
check "adoption reports that it goes back one frame" grep -q "frame $frame fails its checksum.*goes on from frame $((frame - 1))" told
check "the adopted run ends" grep -q 'digest' stdout
check "the digest is that of the undisturbed run" grep -q "digest ${right%% *}" stdout
check "nothing is left" nothing_left "$name"

# --- bits of the header and of the constant regions -----------------------------------------------
create >/dev/null
flip 12
refused "a flipped bit of the header is named" 'header is damaged' world check --world "$name"
refused "adoption refuses a damaged header" 'header is damaged' create --adopt
flip 12
flip $((65536 + 48))
refused "a flipped bit of the parameters is named" 'params are damaged' world status --world "$name"
flip $((65536 + 48))
flip $((65536 * 2 + 100))
refused "a flipped bit of the kinds is named" 'kinds' world check --world "$name"
refused "repair refuses damaged kinds" 'kinds' world repair --world "$name"
flip $((65536 * 2 + 100))
check "check finds the world good when the bit is restored" world check --world "$name"

# --- objects that are not worlds ------------------------------------------------------------------
chmod 644 "$shm"
refused "an object with another mode" 'mode 644' create --adopt
chmod 600 "$shm"
if [ "$UID" = 0 ]; then
    chown 12345 "$shm"
    refused "an object of another owner" 'belongs to user 12345' create --adopt
    chown 0 "$shm"
else
    skip "an object of another owner" "only root can give a file away"
fi
truncate -s 4096 "$shm"
refused "a shorter object" 'size 4096' create --adopt
remove
create >/dev/null
truncate -s +4096 "$shm"
refused "a longer object" 'size [0-9]+; its counts need' create --adopt
remove
create >/dev/null && mv "$shm" "$folder/elsewhere" && ln -s "$folder/elsewhere" "$shm"
refused "a symbolic link" 'cannot open' create --adopt
rm "$shm"
mkdir "$shm"
refused "a folder" 'no shared-memory object|cannot open' create --adopt
rmdir "$shm"
mkfifo "$shm"
refused "a pipe" 'no shared-memory object' create --adopt
rm "$shm"
remove
# An object that no build of Jolon can use is replaced: it was never finished, or belongs to another
# build.
head -c 100000 /dev/zero >"$shm"
chmod 600 "$shm"
ln -s "$shm" "$JOLON_RUNTIME_DIR/$name"
check "an object without the magic is replaced" create --adopt
remove
for kind in mkdir mkfifo 'ln -s /nonexistent'; do
    $kind "$(path_of lock)"
    refused "a lock that is no file ($kind)" '\.lock: (cannot open|is no plain file)' create
    [ "$kind" = mkdir ] && rmdir "$(path_of lock)" || rm "$(path_of lock)"
    check "the refusal leaves nothing behind" nothing_left "$name"
done
for kind in mkdir touch 'ln -s /etc/passwd'; do
    $kind "$JOLON_RUNTIME_DIR/$name"
    refused "a name that is no link to an object ($kind)" 'is no link to a world.s object.*remove it' create
    [ "$kind" = mkdir ] && rmdir "$JOLON_RUNTIME_DIR/$name" || rm "$JOLON_RUNTIME_DIR/$name"
    check "the refusal leaves nothing behind" nothing_left "$name"
done
ln -s "/dev/shm/jolon.$UID.$name.00000000000000000000000000000000" "$JOLON_RUNTIME_DIR/$name"
check "a name that a killed creator left is reused" create
remove
check "nothing is left" nothing_left "$name"

# --- memory that is taken away --------------------------------------------------------------------
"$jolon" run -w "$name" --set world.pace=real --without renderer --without reporter --out out good.cfg >stdout 2>told &
run=$!
eventually far
truncate -s 0 "$(path_of object)"
wait $run
status=$?
check "a set whose memory is taken away gives up" [ $status = 1 ] || [ $status = 3 ]
check "the set reports it" grep -q 'memory went away' told out/jolon.log
check "nothing is left" nothing_left "$name"
done_testing
