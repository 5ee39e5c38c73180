# The Blender add-on: built, validated, installed and used in the Blenders that are there. Sourced by
# tests/run, whose functions it uses.

blender_tests=tests/hosts/blender
blender_work=target/hosts/blender
blender_pictures=$blender_work/pictures

# blender_needs: what Blender and its Python module need of Debian, in one go.
blender_needs() {
    command -v blender >/dev/null 2>&1 && command -v xvfb-run >/dev/null 2>&1 &&
        /usr/bin/python3 -c 'import numpy' 2>/dev/null && return
    if command -v apt-get >/dev/null 2>&1 && [ "$(id -u)" = 0 ]; then
        apt-get -o DPkg::Lock::Timeout=300 update -qq &&
            DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -qq -y \
                --no-install-recommends blender python3-numpy python3-venv xvfb xauth \
                libgl1-mesa-dri libegl1 libsm6 libxi6 libxxf86vm1 libxkbcommon0 >/dev/null
    fi
    command -v blender >/dev/null 2>&1 && command -v xvfb-run >/dev/null 2>&1 ||
        fatal "Blender is missing: install blender, python3-numpy and xvfb and run this again"
}

# python_of VERSION: an interpreter of this version, from the path or from pyenv; nothing if none.
python_of() {
    local candidate
    for candidate in "python$1" python3 "$HOME"/.pyenv/versions/"$1".*/bin/python3; do
        if "$candidate" -c "import sys; sys.exit('%d.%d' % sys.version_info[:2] != '$1')" \
            2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

# bpy_of PYTHON VERSION: an environment with PyPI's bpy of this version under target/.
bpy_of() {
    local interpreter environment=target/hosts/bpy-$2
    [ -x "$environment/bin/python" ] && "$environment/bin/python" -c 'import bpy' 2>/dev/null && return
    interpreter=$(python_of "$1")
    [ -n "$interpreter" ] || return 1
    "$interpreter" -m venv --clear "$environment" &&
        "$environment/bin/pip" install --quiet "bpy==$2"
}

# counted COMMAND...: a program whose last line says "N passed, M failed"; each counts.
counted() {
    timeout 400 "$@" </dev/null 2>&1 | tee "$log" | grep -v '^Info: \|^Warning: '
    local code=${PIPESTATUS[0]} counts
    read -ra counts <<<"$(sed -n 's/.*: \([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$log" | tail -1)"
    group_passed=$((group_passed + ${counts[0]:-0}))
    group_failed=$((group_failed + ${counts[1]:-0}))
    # One that breaks off has not said so.
    if [ "$code" != 0 ] && [ "${counts[1]:-0}" = 0 ]; then
        echo "FAILED: $* ended with $code"
        group_failed=$((group_failed + 1))
    fi
}

# blender_home NAME: an empty home for one Blender.
blender_home() {
    rm -rf "$scratch/blender-$1"
    mkdir -p "$scratch/blender-$1/scripts/addons" "$scratch/blender-$1/config"
    echo "$scratch/blender-$1"
}

begin "the Blender add-on's packages"
blender_needs
mkdir -p $blender_work $blender_pictures
rm -rf $blender_work/packages
# Blender's own tool, which the wheel carries, validates the extension.
bpy_of 3.11 5.0.1
blender_tool=$(echo target/hosts/bpy-5.0.1/lib/python3.11/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py)
check test -f "$blender_tool"
check python3 plugins/blender/build.py --out $blender_work/packages --tool "$blender_tool"
# Loadable where glibc is of 2012.
check python3 $blender_tests/packages.py $blender_work/packages "$blender_tool"
check cargo build --release --quiet --package wovenfit
check $packaged/bin/ruff check --quiet --config plugins/blender/ruff.toml plugins/blender $blender_tests
check $packaged/bin/ruff format --quiet --check --config plugins/blender/ruff.toml plugins/blender \
    $blender_tests
check target/release/wovenfit sample elbow --triangles 6000 --out $blender_work/elbow.obj
blender_env=(
    env -u WOVENFIT_LIBRARY -u WOVENFIT_ONLY
    WOVENFIT_PACKAGES="$PWD/$blender_work/packages"
    WOVENFIT_LIMB="$PWD/$blender_work/elbow.obj"
    WOVENFIT_PROGRAM="$PWD/target/release/wovenfit"
    WOVENFIT_SCRATCH="$scratch/blender-files"
    WOVENFIT_PICTURES="$PWD/$blender_pictures"
)
mkdir -p "$scratch/blender-files"
end

begin "the add-on in Debian's Blender"
home=$(blender_home debian)
counted "${blender_env[@]}" HOME="$home" BLENDER_USER_SCRIPTS="$home/scripts" \
    BLENDER_USER_CONFIG="$home/config" \
    blender -b --factory-startup --python-exit-code 1 --python $blender_tests/run.py
end

for one in 3.11:4.5.15 3.11:5.0.1 3.13:5.2.3; do
    if bpy_of "${one%%:*}" "${one##*:}"; then
        begin "the add-on in Blender ${one##*:}"
        home=$(blender_home "${one##*:}")
        counted "${blender_env[@]}" HOME="$home" BLENDER_USER_RESOURCES="$home" \
            "target/hosts/bpy-${one##*:}/bin/python" $blender_tests/run.py
        end
    elif [ "${one%%:*}" = 3.13 ] && [ -z "$(python_of 3.13)" ]; then
        # Debian 12 has Python 3.11 alone.
        summary+=("SKIPPED: the add-on in Blender ${one##*:}, which needs a Python ${one%%:*}")
        echo "== SKIPPED: Blender ${one##*:} needs a Python ${one%%:*}, and there is none"
    else
        begin "the add-on in Blender ${one##*:}"
        check false "Blender ${one##*:} could not be installed"
        end
    fi
done

begin "the add-on in Blender's window"
home=$(blender_home window)
rm -f $blender_pictures/*.png
counted "${blender_env[@]}" HOME="$home" BLENDER_USER_SCRIPTS="$home/scripts" \
    BLENDER_USER_CONFIG="$home/config" \
    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \
    --python-exit-code 1 -p 0 0 1280 900 --python $blender_tests/window.py
check test -s $blender_pictures/9-cancelled.png
echo "pictures: $blender_pictures"
end

begin "beside Blender's own unwrap"
home=$(blender_home unwrap)
counted "${blender_env[@]}" HOME="$home" BLENDER_USER_RESOURCES="$home" \
    target/hosts/bpy-5.0.1/bin/python $blender_tests/unwrap.py
end
