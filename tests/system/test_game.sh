#!/usr/bin/env bash
# Two players and a program control vehicles while the set's processes are killed. Nothing may be
# lost or done twice, and a replay has the same digest. tests/game/README.md explains the printed
# results. SECONDS_OF_GAME=n and SEED=n choose others.
game=$(cd "$(dirname "$0")/../game" && pwd)/game
. "$(dirname "$0")/lib.sh"
seconds=${SECONDS_OF_GAME:-20}
seed=${SEED:-$RANDOM}

python3 "$game" --bin "$bin" --seconds "$seconds" --seed "$seed" --world "$name" --out "$folder/out" >account 2>err
status=$?
sed 's/^/# /' account
check "a game of $seconds s, seed $seed: nothing is lost" equal $status 0
[ $status = 0 ] || { tail -n 5 err; tail -n 10 "$folder/out/jolon.log"; } | sed 's/^/# /'
check "roles were killed during the game" grep -Eq 'kills +[1-9]' account
check "nothing is left" eventually nothing_left "$name"
done_testing
