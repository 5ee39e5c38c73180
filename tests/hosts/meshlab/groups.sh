# MeshLab: the filters in Debian's 2020.09 (its scripts, its window) and in PyPI's pymeshlab 2025.7.
# tests/run sources this and lends its functions.

meshlab_tests=tests/hosts/meshlab
meshlab_python=target/meshlab/python
meshlab_home=$scratch/meshlab-home
mkdir -p "$meshlab_home"

# What a Debian 12 needs, in one go.
if ! command -v meshlabserver >/dev/null 2>&1 || ! command -v xvfb-run >/dev/null 2>&1 ||
    ! command -v cmake >/dev/null 2>&1 || ! command -v ninja >/dev/null 2>&1 ||
    [ ! -d /usr/include/eigen3 ] || [ ! -f /usr/include/GL/glew.h ] ||
    ! ls /usr/lib/*/cmake/Qt5OpenGL >/dev/null 2>&1; then
    if [ "$(id -u)" = 0 ]; then
        apt-get -o DPkg::Lock::Timeout=300 update -qq
        DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -qq -y \
            --no-install-recommends meshlab xvfb xauth libgl1-mesa-dri cmake ninja-build g++ \
            qtbase5-dev libqt5opengl5-dev libglew-dev libeigen3-dev >/dev/null
    fi
fi
install meshlabserver meshlab
install xvfb-run xvfb xauth

# The tests' Python: pymeshlab, and the wovenfit package from the checkout with the library built here.
if ! cmp -s $meshlab_tests/requirements.txt $meshlab_python/requirements.txt; then
    python3 -m venv --clear $meshlab_python &&
        $meshlab_python/bin/pip install --quiet -r $meshlab_tests/requirements.txt &&
        cp $meshlab_tests/requirements.txt $meshlab_python/
fi

# meshlab_pytests BUILD ARGUMENTS...: pytest on a plugin that was built; every test counts.
meshlab_pytests() {
    local build=$1 kept=$packaged
    shift
    packaged=$meshlab_python
    HOME=$meshlab_home PYTHONPATH=$PWD/plugins/python WOVENFIT_LIBRARY=$PWD/target/release/libwovenfit.so \
        WOVENFIT_MESHLAB_BUILD=$build pytests -q -p no:cacheprovider "$@" </dev/null
    packaged=$kept
}

begin "MeshLab 2020.09"
for ruff in "check --quiet" "format --quiet --check"; do
    # shellcheck disable=SC2086
    check $meshlab_python/bin/ruff $ruff --config plugins/python/pyproject.toml --no-cache \
        plugins/meshlab $meshlab_tests
done
check cargo build --release --quiet --package wovenfit
check cargo build --release --quiet --package wovenfit-ffi
check timeout 600 python3 plugins/meshlab/install.py --build-only --tests </dev/null
meshlab_pytests "$PWD/target/meshlab/build-2020.09-float" $meshlab_tests/test_meshlabserver.py
# One command installs it: into a folder here.
mkdir -p "$scratch/meshlab-plugins"
check timeout 600 python3 plugins/meshlab/install.py --plugins "$scratch/meshlab-plugins" </dev/null
check test -f "$scratch/meshlab-plugins/libfilter_wovenfit.so"
end

begin "MeshLab's window"
meshlab_pytests "$PWD/target/meshlab/build-2020.09-float" $meshlab_tests/test_window.py
end

# The headers of today's MeshLab are those of Debian's newest sources, which move on. A host that did
# not run has not passed: then the group is not counted, and it is said.
timeout 600 python3 plugins/meshlab/install.py --pymeshlab $meshlab_python/bin/python --build-only --tests \
    </dev/null >"$scratch/meshlab-build" 2>&1
case $? in
0)
    begin "pymeshlab 2025.7"
    meshlab_pytests "$PWD/target/meshlab/build-2025.07d-double" $meshlab_tests/test_pymeshlab.py
    echo "-- MeshLab's own parametrizations beside the pattern"
    check timeout 300 env HOME="$meshlab_home" PYTHONPATH="$PWD/plugins/python" \
        WOVENFIT_LIBRARY="$PWD/target/release/libwovenfit.so" \
        WOVENFIT_MESHLAB_BUILD="$PWD/target/meshlab/build-2025.07d-double" \
        $meshlab_python/bin/python $meshlab_tests/side_by_side.py </dev/null
    end
    ;;
3)
    echo
    echo "== pymeshlab 2025.7: SKIPPED, NOT TESTED: $(cat "$scratch/meshlab-build")"
    summary+=("pymeshlab 2025.7             SKIPPED: its headers cannot be had")
    ;;
*)
    begin "pymeshlab 2025.7"
    cat "$scratch/meshlab-build"
    check false
    end
    ;;
esac
