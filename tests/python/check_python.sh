#!/bin/sh
# check_python.sh - `pip install .`, and the package from where that put it: its own tests, and the example.
# DAGC names the command, in the build folder whose libradiosity.a the extension is made of. PYTHON is Debian's unless given.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../dagc/lib.sh"
build=$(dirname "$(dirname "$dagc")")
python=${PYTHON:-/usr/bin/python3}

"$python" -c 'import setuptools, wheel, cffi, numpy, scipy, pip; assert int(setuptools.__version__.split(".")[0]) >= 61, "setuptools is old"' 2>said || {
    echo "skipped: no Debian Python with numpy, scipy and cffi ($(tail -n 1 said))"
    exit 0
}
[ -z "${SANITIZE-}" ] || {
    echo "skipped: Python is not built with sanitizers, and cannot load what is"
    exit 0
}
unset MAKEFLAGS MFLAGS MAKELEVEL DAGC RADIOSITY OPT WARN CFLAGS CPPFLAGS LDFLAGS
unset PYTHONPATH
check "pip install" env BUILD="$build" "$python" -m pip install --no-index --no-build-isolation --no-deps \
    --disable-pip-version-check --root-user-action=ignore --no-warn-script-location --target "$tmp/site" "$top"
[ -d site/radiosity ] || { echo "python: nothing to go on with"; exit 1; }
PYTHONPATH=$tmp/site
PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH PYTHONDONTWRITEBYTECODE
check "nothing is left in the tree" sh -c "! find '$top' -path '$top/.git' -prune -o \( -name '*.egg-info' -o -name __pycache__ \) -print | grep -v -e '/build'"
check "one extension, which needs no libradiosity" sh -c "objdump -p site/radiosity/_engine*.so >needs && grep -q NEEDED needs && ! grep 'NEEDED.*radiosity' needs"
version=$(sed -n 's/^.define RADIOSITY_VERSION "\(.*\)"/\1/p' "$top/runtime/radiosity.h")
check "its version is the library's" "$python" -c "from importlib.metadata import version; import radiosity; assert version('radiosity') == radiosity.__version__ == '$version'"
check "the package" timeout 120 "$python" -W error::ResourceWarning "$top/tests/python/test_package.py"
grep '^package: ' out
# The example's balance: what floor, window and fresh air bring is nothing in all; insulated surfaces bring nothing.
check "the example runs" sh -c "'$python' '$top/examples/python/room_heat_balance.py' >table"
check "its table balances" awk '/ brings$/ { on = 1; next }
    on && $1 != "all" && $1 != "m2" && NF > 4 || /^fresh air/ { sum += $NF; rows++ }
    $1 == "floor" { floor = $NF }  $1 == "walls" { walls = $NF }
    END { print sum, rows, floor, walls
          exit !(rows == 7 && sum < .03 && sum > -.03 && floor > 445 && floor < 465 && walls == 0) }' table
finish python
