# The FreeCAD workbench, in Debian's FreeCAD 0.20: without a window, and in one under Xvfb.

begin "FreeCAD"
# All at once, if anything is missing; Mesa draws where there is no graphics card.
freecad_packages=(freecad freecad-python3 python3-numpy xvfb xauth imagemagick libgl1-mesa-dri)
if ! { command -v freecadcmd && command -v xvfb-run && command -v xauth && command -v import &&
    dpkg -s libgl1-mesa-dri; } >/dev/null 2>&1 && [ "$(id -u)" = 0 ]; then
    apt-get -o DPkg::Lock::Timeout=300 update -qq &&
        DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -qq -y \
            --no-install-recommends "${freecad_packages[@]}" >/dev/null
fi
install freecadcmd "${freecad_packages[@]}"
install xvfb-run "${freecad_packages[@]}"
install import "${freecad_packages[@]}"
freecad_scratch=$scratch/freecad
freecad_pictures=target/freecad-pictures
mkdir -p "$freecad_scratch" $freecad_pictures
rm -f $freecad_pictures/*.png
# The portable library inside, as a user drops it into Mod.
check python3 plugins/freecad/build.py --out target/freecad
check cargo build --release --quiet --package wovenfit
check target/release/wovenfit sample elbow --triangles 6000 --out "$freecad_scratch/elbow.obj"
check target/release/wovenfit sample elbow --triangles 30000 --out "$freecad_scratch/large.obj"

# The package's environment has the linter; these checks are no pytest.
if [ -x "${packaged:-none}/bin/ruff" ]; then
    check $packaged/bin/ruff check --quiet --config plugins/python/pyproject.toml \
        --ignore PT017,PT018,RUF059 plugins/freecad tests/hosts/freecad
    check $packaged/bin/ruff format --quiet --check --config plugins/python/pyproject.toml \
        plugins/freecad tests/hosts/freecad
fi

# freecad_home FOLDER: a home of FreeCAD's with the workbench and without splash and start page.
freecad_home() {
    mkdir -p "$1/Mod"
    cp -r target/freecad/Wovenfit "$1/Mod/"
    cp tests/hosts/freecad/user.cfg "$1/user.cfg"
}

# freecad_checks SECONDS NAME COMMAND...: the checks of a script; the file that they write counts, for
# FreeCAD ends well whatever a script raises.
freecad_checks() {
    local seconds=$1 name=$2 told=$freecad_scratch/$2.told
    shift 2
    freecad_home "$freecad_scratch/home-$name"
    rm -f "$told"
    env TESTS="$PWD/tests/hosts/freecad" SCRATCH="$freecad_scratch" CHECKS="$told" \
        PICTURES="$PWD/$freecad_pictures" PROGRAM="$PWD/target/release/wovenfit" \
        FREECAD_USER_HOME="$freecad_scratch/home-$name" \
        timeout "$seconds" "$@" </dev/null >"$freecad_scratch/$name.log" 2>&1
    local code=$? counts
    if [ -f "$told" ] && read -ra counts <<<"$(tail -n 1 "$told" |
        sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p')" && [ ${#counts[@]} = 2 ]; then
        grep -v '^passed: ' "$told"
        group_passed=$((group_passed + counts[0]))
        group_failed=$((group_failed + counts[1]))
    else
        echo "FAILED: FreeCAD's $name broke off with $code:"
        [ -f "$told" ] && cat "$told"
        tail -n 30 "$freecad_scratch/$name.log"
        group_failed=$((group_failed + 1))
    fi
}

freecad_checks 240 headless freecadcmd tests/hosts/freecad/headless.py
freecad_checks 240 beyond freecadcmd tests/hosts/freecad/beyond.py
freecad_checks 120 beside freecadcmd tests/hosts/freecad/beside.py
grep -A 3 '^elbow, ' "$freecad_scratch/beside.log" && grep '^seconds: ' "$freecad_scratch/beside.log"

# The example, by what its page says; a scan that cannot be makes it fail.
freecad_home "$freecad_scratch/home-batch"
echo "solid nothing" >"$freecad_scratch/broken.stl"
freecad_batch=(env FREECAD_USER_HOME="$freecad_scratch/home-batch" DESIGN="$freecad_scratch/elbow.design.json"
    OUT="$freecad_scratch/patterns")
check "${freecad_batch[@]}" SCANS="$freecad_scratch/elbow.obj" \
    freecadcmd target/freecad/Wovenfit/examples/batch.py </dev/null >"$freecad_scratch/batch.log" 2>&1
# FreeCAD's progress shares the line, each step after a carriage return.
tr '\r' '\n' <"$freecad_scratch/batch.log" >"$freecad_scratch/batch.lines"
check grep -q '^[[:space:]]*elbow.obj: 254\.[0-9] mm by 263\.[0-9] mm, all pressures met' "$freecad_scratch/batch.lines"
check test -s "$freecad_scratch/patterns/elbow/pattern.svg" -a -s "$freecad_scratch/patterns/elbow/elbow.FCStd"
refused 1 "${freecad_batch[@]}" SCANS="$freecad_scratch/broken.stl" \
    freecadcmd target/freecad/Wovenfit/examples/batch.py </dev/null

# The inner limit ends FreeCAD, so that its display ends, too.
freecad_checks 330 window xvfb-run -a -s "-screen 0 1600x1000x24" timeout 300 freecad \
    tests/hosts/freecad/window.py
echo "pictures of the window: $freecad_pictures"
end
