#!/usr/bin/env bash
# bare_root.sh BARE: scripts/bare.sh takes no root of another suite for the one that was asked for. Nothing is built or
# mounted: the tools that would do it fail here. Exit status 77 where it cannot be tried.
set -euo pipefail
bare=$1

[ "$(id -u)" -eq 0 ] || exit 77 # bare.sh goes no further
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/tools" "$folder/root"
for tool in debootstrap git chroot mount mountpoint; do
    printf '#!/bin/sh\nexit 1\n' >"$folder/tools/$tool"
    chmod +x "$folder/tools/$tool"
done
printf '#!/bin/sh\nshift 3 # --mount --propagation private\nexec "$@"\n' >"$folder/tools/unshare"
chmod +x "$folder/tools/unshare"

# expect CONTENT SUITE TEXT: what bare.sh says of a root with that content of bare.complete.
expect() {
    local said status=0
    printf '%s' "$1" >"$folder/root/bare.complete"
    said=$(PATH=$folder/tools:$PATH bash "$bare" "$2" "$folder/root" true 2>&1) || status=$?
    if [ "$status" -ne 2 ] || [[ $said != "bare.sh: error: "*"$3"* ]]; then
        echo "a root of '$1', asked for $2: status $status: $said"
        exit 1
    fi
}

expect trixie bookworm "the system in ROOT is trixie, not bookworm: $folder/root: name another folder"
expect bookworm sid "the system in ROOT is bookworm, not sid"
expect "" bookworm "of an older version of this script"

# The one that was asked for gets to the tools.
echo bookworm >"$folder/root/bare.complete"
mkdir "$folder/root/etc"
if said=$(PATH=$folder/tools:$PATH bash "$bare" bookworm "$folder/root" true 2>&1) || [[ $said == *"in ROOT"* ]]; then
    echo "a root of bookworm, asked for bookworm: $said"
    exit 1
fi
