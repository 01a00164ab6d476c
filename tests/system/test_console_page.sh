#!/usr/bin/env bash
# The console's page in a real browser (headless Chromium). Screenshots of the page stay in
# build/tests/browser/.
. "$(dirname "$0")/lib.sh"
root=$(dirname "$(dirname "$bin")")
here=$root/tests/browser
work=$root/build/tests/browser
[ -z "${JOLON_SANITIZER-}" ] || { skip "the page" "the browser is tried with the plain build"; done_testing; }

# --- required programs ------------------------------------------------------------------------------
"$root/supervisor/install-packages" "$here/packages.txt" >install.log 2>&1 ||
    { skip "the page" "node, npm or chromium cannot be installed here"; done_testing; }
mkdir -p "$work"
if ! cmp -s "$here/package-lock.json" "$work/installed"; then
    cp "$here/package.json" "$here/package-lock.json" "$work/"
    (cd "$work" && npm ci --ignore-scripts --no-audit --no-fund) >npm.log 2>&1 ||
        { skip "the page" "playwright-core cannot be installed here"; done_testing; }
    cp "$here/package-lock.json" "$work/installed"
fi

# --- the sources --------------------------------------------------------------------------------------
whole() { # a module by its ending, also for a node that takes .js for a script
    local file
    for file in "$root"/clients/console/page/*.js "$here"/*.mjs; do
        cp "$file" "$folder/module.mjs"
        node --check "$folder/module.mjs" || { echo "$file"; return 1; }
        [ "$(wc -l <"$file")" -lt 400 ] || { echo "$file is too long"; return 1; }
    done
}
check "every module is well-formed and within the size limit" whole
check "the page loads nothing from other servers" eval '! grep -nE "https?://" "$root"/clients/console/page/* | grep -v www.w3.org'
check "the page has nothing that the server's content rules forbid" \
    eval '! grep -nE "<script>|<style|style=|onclick=" "$root"/clients/console/page/index.html'

# --- the page -----------------------------------------------------------------------------------------
cat >people.cfg <<'C'
world = { name = "people"; seed = 7; capacity = 128; };
terrain = { source = "generated"; };
objects = { source = "none"; };
vehicles = (
    { name = "Alpha";   kind = "tank";  force = "blue";    at = [27000.0, 21000.0]; heading_deg = 90.0; },
    { name = "Bravo";   kind = "tank";  force = "blue";    at = [27000.0, 21120.0]; heading_deg = 90.0; },
    { name = "Charlie"; kind = "truck"; force = "neutral"; at = [26900.0, 21060.0]; heading_deg = 0.0; },
    { name = "Delta";   kind = "jeep";  force = "blue";    at = [26880.0, 21200.0]; heading_deg = 45.0; },
    { name = "Echo";    kind = "helicopter"; force = "red"; at = [27900.0, 20600.0]; heading_deg = 200.0; altitude_m = 60.0; },
    { name = "Foxtrot"; kind = "carrier"; force = "red";   at = [29500.0, 21500.0]; heading_deg = 270.0; }
);
C
check "a world starts" "$jolon" start -w "$name" --out "$folder/out" --set renderer.width=320 \
    --set renderer.height=180 "$folder/people.cfg"
"$jolon" console -w "$name" --port 0 >url 2>console.err &
console=$!
check "a console starts" eventually grep -q '#token=' url
URL=$(head -n 1 url) BROWSER=$(command -v chromium) MODULES=$work JOLON_BIN=$bin WORLD=$name SHOTS=$work \
    timeout 900 node "$here/console.mjs" >tap 2>browser.err
while IFS= read -r line; do
    case $line in
    "ok "*) ok "${line#* - }" ;;
    "not ok "*) not_ok "${line#* - }" ;;
    *) echo "$line" ;;
    esac
done <tap
check "the browser's tests reach their end" grep -q '^# the end' tap
grep -q '^# the end' tap || sed 's/^/# /' browser.err console.err | tail -n 30
kill -TERM $console 2>/dev/null
check "the console ends at its signal" wait $console
done_testing
