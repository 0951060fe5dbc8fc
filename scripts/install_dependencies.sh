#!/usr/bin/env bash
# install_dependencies.sh [build] [test] [develop]: installs what is missing of these groups of Debian packages, and
# nothing else. Without a group: build. What each package is for is in docs/dependencies.md as well.
set -euo pipefail

# group    package                 why
readonly packages='
build    g++                     the compiler, C++20: 12 or newer
build    cmake                   the build: 3.25 or newer, for the presets
build    ninja-build             runs the build
build    ocl-icd-opencl-dev      the OpenCL loader to link with
build    opencl-headers          the C interface of OpenCL
build    opencl-clhpp-headers    opencl.hpp, its C++ interface with exceptions
build    pocl-opencl-icd         an OpenCL device that needs no GPU: PoCL on the CPU
build    libtbb-dev              oneTBB: builds the hierarchy in parallel
build    libopenexr-dev          OpenEXR images with layers
build    libpng-dev              PNG images
build    libjpeg62-turbo-dev     JPEG images as textures
build    libtomlplusplus-dev     scene files, with line and column of every key
build    libtinyobjloader-dev    meshes and their materials
build    libglm-dev              transforms of the scene
build    libcli11-dev            the command line
build    libfmt-dev              text
build    nlohmann-json3-dev      reports
build    doctest-dev             the tests; configuring looks for it
build    libembree-dev           what benchmarks measure rays and builds against; configuring looks for it
test     clang-15                front end of three GPU targets, lints the kernels
test     oclgrind                runs kernels and reports bad accesses and races
test     mesa-opencl-icd         a second OpenCL driver, of another vendor
develop  clang-format            lays out the sources
develop  clang-tidy              looks for mistakes in the sources
develop  python3-matplotlib      plots of the benchmarks
'

fail() {
    echo "install_dependencies.sh: error: $*" >&2
    exit 1
}

# The packages of the given groups, one a line.
wanted() {
    local group
    for group in "$@"; do
        awk -v group="$group" '$1 == group { print $2 }' <<<"$packages"
    done
}

installed() {
    # Fails if it does not know some package, and lists the others all the same.
    dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | awk '$2 == "installed" { print $1 }'
}

main() {
    [ $# -gt 0 ] || set -- build
    local group
    for group in "$@"; do
        [ -n "$(wanted "$group")" ] || fail "no such group: $group: choose among build, test, develop"
    done
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        fail "no apt on this system: install by hand what these are here: $(wanted "$@" | xargs); then set WEDGE_INSTALL=no"
    fi

    local -a names missing
    mapfile -t names < <(wanted "$@")
    mapfile -t missing < <(comm -23 <(printf '%s\n' "${names[@]}" | sort -u) <(installed "${names[@]}" | sort -u))
    [ ${#missing[@]} -gt 0 ] || return 0

    local -a root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "packages are missing: ${missing[*]}: run this as root, or install sudo"
        root=(sudo)
    fi
    echo "installing ${missing[*]}"
    local -a apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet --quiet)
    "${apt[@]}" update || fail "apt-get update failed: see above: check the network and /etc/apt"
    "${apt[@]}" install --yes --no-install-recommends "${missing[@]}" >/dev/null ||
        fail "apt-get could not install: ${missing[*]}: see above"
}

# For systems without apt, where the packages came by other ways.
[ "${WEDGE_INSTALL:-yes}" = no ] || main "$@"
