#!/usr/bin/env bash
# bare.sh [SUITE [ROOT [COMMAND...]]]: runs the README's two commands, or the given ones, in a bare Debian, on a clone of
# this repository's last commit. SUITE: bookworm (12, the default), trixie (13) or sid. ROOT: where the system of
# that suite is built and kept for the next time; a temporary folder that is removed by default. Needs root, debootstrap and
# git. Exit status 0 if all commands succeed, 1 if one does not, 2 for a wrong call or a system that cannot be built.
set -euo pipefail
sources=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
    echo "bare.sh: error: $*" >&2
    exit 2
}

# Mounts of its own: nobody else sees them, and they end with this process however it ends. Left in a root that someone then
# removes, /dev would be gone for the whole system.
if [ -z "${WEDGE_BARE_MOUNTS:-}" ] && [ "$(id -u)" -eq 0 ]; then
    command -v unshare >/dev/null || fail "unshare is missing: install util-linux first"
    exec env WEDGE_BARE_MOUNTS=own unshare --mount --propagation private "${BASH_SOURCE[0]}" "$@"
fi

suite=${1:-bookworm}
case $suite in bookworm | trixie | sid) ;; *) fail "unknown suite: $suite: choose bookworm, trixie or sid" ;; esac
root=${2:-}
shift $(($# < 2 ? $# : 2))
commands=("$@")
[ ${#commands[@]} -gt 0 ] || commands=(./demo.sh ./test.sh)

[ "$(id -u)" -eq 0 ] || fail "debootstrap and chroot need root: run this as root"
for tool in debootstrap git chroot mountpoint; do
    command -v "$tool" >/dev/null || fail "$tool is missing: install it first"
done
if [ -z "$root" ]; then
    root=$(mktemp -d)
    remove=$root
fi

mounted=(proc sys dev dev/pts)
cleanUp() {
    local i
    for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do
        ! mountpoint -q "$root/${mounted[i]}" || umount "$root/${mounted[i]}" || return
    done
    [ -z "${remove:-}" ] || rm -rf --one-file-system "$remove"
}
trap cleanUp EXIT

# The packages come from where this system's own come, a mirror or a proxy included.
mirror=$(apt-get indextargets --format '$(REPO_URI)' 2>/dev/null | grep -v security | sort | uniq -c | sort -rn | awk 'NR == 1 { print $2 }') || mirror=
if [ ! -e "$root/bare.complete" ]; then # what an interrupted call left is no system
    echo "== building $suite in $root"
    mkdir -p "$root"
    debootstrap --variant=minbase "$suite" "$root" ${mirror:+"$mirror"} >"$root.log" 2>&1 ||
        fail "debootstrap failed: $(tail -n 1 "$root.log"): see $root.log"
    rm -f "$root.log"
    echo "$suite" >"$root/bare.complete"
fi
# A root of another suite would say ok for what it did not run.
built=$(<"$root/bare.complete")
[ -n "$built" ] ||
    fail "the system in ROOT is of an older version of this script, which did not say of which suite: $root: remove it to build it again"
[ "$built" = "$suite" ] || fail "the system in ROOT is $built, not $suite: $root: name another folder, or remove this one"
[ ! -e /etc/resolv.conf ] || cp /etc/resolv.conf "$root/etc/resolv.conf"
[ ! -d /etc/apt/apt.conf.d ] || cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
for point in "${mounted[@]}"; do
    mkdir -p "$root/$point"
    mountpoint -q "$root/$point" || mount --bind "/$point" "$root/$point"
done
rm -rf "$root/src/wedge"
git clone -q "$sources" "$root/src/wedge" || fail "git cannot clone $sources"
mapfile -t proxies < <(env | grep -iE '^(http|https|no)_proxy=' || true)

status=0
for command in "${commands[@]}"; do
    log=$root/src/$(basename "${command%% *}").log
    start=$SECONDS
    if env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM=dumb LC_ALL=C.UTF-8 "${proxies[@]}" \
        chroot "$root" bash -c "cd /src/wedge && $command" >"$log" 2>&1 </dev/null; then
        echo "$suite: $command: ok in $((SECONDS - start)) s"
    else
        status=1
        echo "$suite: $command: FAILED after $((SECONDS - start)) s:"
        tail -n 30 "$log"
    fi
done
exit $status
