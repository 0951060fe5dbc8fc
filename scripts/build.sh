#!/usr/bin/env bash
# build.sh GROUPS [TARGET...]: installs what is missing of the groups of packages (separated by commas), configures
# build/release and builds the targets, or everything. Takes a second when nothing changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

groups=${1:?build.sh: error: no groups of packages: name build, or build,test}
shift

bash scripts/install_dependencies.sh ${groups//,/ }

# A build folder that was made elsewhere, or for another checkout, cannot be used again.
cache=build/release/CMakeCache.txt
if [ -f "$cache" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$(pwd -P)" "$cache"; then
    echo "build/release belongs to another checkout: making it anew"
    rm -rf build/release
fi
# Written last of all, so its absence also tells of an interrupted configuration. Later changes are Ninja's to notice.
if [ ! -f build/release/build.ninja ]; then
    # Whoever only builds has a compiler that nobody here has seen: what it warns of must not stop it.
    cmake --preset release --log-level=WARNING ${CI:+-DWEDGE_WERROR=ON}
fi
cmake --build --preset release ${1:+--target "$@"}
