#!/usr/bin/env bash
# install_dependencies.sh [build] [test] [develop]: installs what is missing of these groups of Debian packages, and
# nothing else. Without a group: build. What each package is for is in docs/dependencies.md as well.
set -euo pipefail

# group    package                 why
# A|B: the first of these that is installed, or else that the system has: names change from release to release.
# ?A: left out where the system does not have it; what wants it says so.
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
build    libtinyobjloader-dev    vertices and faces of Wavefront OBJ meshes
build    libglm-dev              transforms of the scene
build    libcli11-dev            the command line
build    libfmt-dev              text
build    libkissfft-dev          the spectrum of an environment map
build    nlohmann-json3-dev      reports
build    doctest-dev             the tests; configuring looks for it
build    ?libembree-dev          what benchmarks measure rays and builds against
test     clang-15|clang-19|clang front end of three GPU targets, lints the kernels; compiles the fuzzing targets
test     ?libfuzzer-15-dev|libfuzzer-19-dev            drives the fuzzing targets
test     ?libclang-common-15-dev|libclang-rt-19-dev    sanitizers of that clang, for the same
test     ?oclgrind               runs kernels and reports bad accesses and races
test     ?mesa-opencl-icd        a second OpenCL driver, of another vendor
develop  clang-format            lays out the sources
develop  clang-tidy              looks for mistakes in the sources
develop  python3-matplotlib      plots of the benchmarks
'

fail() {
    echo "install_dependencies.sh: error: $*" >&2
    exit 1
}

# The packages of the given groups, one a line, as the list has them.
wanted() {
    local group
    for group in "$@"; do
        awk -v group="$group" '$1 == group { print $2 }' <<<"$packages"
    done
}

# Which of the packages are installed, one a line.
installed() {
    # Fails if it does not know some package, and lists the others all the same.
    dpkg-query --show --showformat='${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | awk '$2 == "installed" { print $1 }'
}

# Which of the packages apt can install, one a line.
available() {
    apt-cache policy "$@" 2>/dev/null | awk '/^[^ ].*:$/ { name = substr($1, 1, length($1) - 1) }
        $1 == "Candidate:" && $2 != "(none)" { print name }'
}

# Of those that the list asks for, what is not there in any of its forms, as the list has them.
missing() {
    local entry names
    for entry in "$@"; do
        names=${entry#\?}
        # shellcheck disable=SC2086
        [ -n "$(installed ${names//|/ })" ] || echo "$entry"
    done
}

# The packages to install for these entries of the list, one a line: the first form that apt has. Says what it leaves out.
chosen() {
    local entry names name known
    for entry in "$@"; do
        names=${entry#\?}
        names=${names//|/ }
        # shellcheck disable=SC2086
        known=$(available $names)
        for name in $names; do
            grep -qxF "$name" <<<"$known" && break
            name=
        done
        if [ -n "$name" ]; then
            echo "$name"
        elif [ "${entry:0:1}" = "?" ]; then
            echo "this system has no package $names: what wants it will say that it is left out" >&2
        else
            echo "${names%% *}" # apt says what is wrong with it
        fi
    done
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

    local -a entries absent names
    mapfile -t entries < <(wanted "$@")
    mapfile -t absent < <(missing "${entries[@]}")
    # Where all that is absent is optional and known not to exist, there is nothing to do, and nothing to say again.
    if [ ${#absent[@]} -eq 0 ] || { [ -n "$(available g++)" ] && [ -z "$(chosen "${absent[@]}" 2>/dev/null)" ]; }; then
        return 0
    fi

    local -a root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "packages are missing: ${absent[*]}: run this as root, or install sudo"
        root=(sudo)
    fi
    local -a apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet --quiet)
    "${apt[@]}" update || fail "apt-get update failed: see above: check the network and /etc/apt"
    mapfile -t names < <(chosen "${absent[@]}")
    [ ${#names[@]} -gt 0 ] || return 0
    echo "installing ${names[*]}"
    "${apt[@]}" install --yes --no-install-recommends "${names[@]}" >/dev/null ||
        fail "apt-get could not install: ${names[*]}: see above"
}

# For systems without apt, where the packages came by other ways.
[ "${WEDGE_INSTALL:-yes}" = no ] || main "$@"
