#!/bin/sh
# packages.sh - see to the packages the build needs: install what is missing when allowed to, else say how.
# SPDX-License-Identifier: MIT
set -eu
command -v apt-get >/dev/null 2>&1 || exit 0 # not a Debian: the compiler will name what is missing
packages="gcc make pkg-config libc6-dev libassimp-dev libexpat1-dev libjansson-dev libpng-dev zlib1g-dev liblapacke-dev check gnuplot-nox graphviz ${PACKAGES_MORE-}"
missing=
for p in $packages; do
    dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'install ok installed' || missing="$missing $p"
done
embree() { echo "#include <embree$1/rtcore.h>" | cc -E -x c - >/dev/null 2>&1; } # of whichever version, wherever it is
embree 3 || embree 4 || missing="$missing libembree-dev"
[ -n "$missing" ] || exit 0
if [ "$(id -u)" = 0 ]; then
    sudo=
elif sudo -n true 2>/dev/null; then
    sudo=sudo
else
    echo "These packages are missing; install them and try again:" >&2
    echo "    sudo apt-get update && sudo apt-get install$missing" >&2
    exit 1
fi
echo "installing:$missing"
$sudo env DEBIAN_FRONTEND=noninteractive apt-get update -qq
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
