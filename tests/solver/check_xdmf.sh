#!/usr/bin/env bash
# check_xdmf.sh - solve -o FILE.xdmf, for ParaView: the text is XML and says of each table what the .h5 beside it holds; cells are
# those of .ply, corner by corner; what stands on them sums up to the rows of --faces; a disk that is full leaves what was there.
# Values are read by h5dump (package hdf5-tools), a reader that is not ours.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
quietly=into_files
scene=$scenes/cornell.obj
"$radiosity" solve "$scene" -q -o a.xdmf --faces a.csv >out 2>err
status=$?
if grep -q "built without HDF5: make HDF5=1, package libhdf5-dev" err; then
    check "without HDF5: 2" [ $status = 2 ]
    check "and nothing is written" [ ! -e a.xdmf -a ! -e a.h5 -a ! -e a.csv ]
    echo "xdmf: skipped: built without HDF5 (make HDF5=1)"
    finish xdmf
    exit
fi
check "it is written" [ $status = 0 -a -s a.xdmf -a -s a.h5 ]
check "and nothing else" [ "$(ls a.*)" = "a.csv
a.h5
a.xdmf" ]
check "the same as .ply" "$radiosity" solve "$scene" -q -o a.ply
cat >judge.py <<'PY'
import csv, os, struct, subprocess, sys
import xml.etree.ElementTree as tree

def table(name, item):  # as the text says that it is, in the .h5
    subprocess.run(["h5dump", "-d", "/" + name, "-b", "NATIVE", "-o", "table.bin", "a.h5"], check=True, stdout=subprocess.DEVNULL)
    kind = {("Float", "8"): "d", ("UInt", "4"): "I"}[item.get("NumberType"), item.get("Precision")]
    size = [int(n) for n in item.get("Dimensions").split()]
    data = open("table.bin", "rb").read()
    assert len(data) == (size[0] * (size[1] if len(size) > 1 else 1)) * struct.calcsize(kind), name
    values = struct.unpack("=%d%s" % (len(data) // struct.calcsize(kind), kind), data)
    return [values[i:i + size[1]] for i in range(0, len(values), size[1])] if len(size) > 1 else list(values)

root = tree.parse("a.xdmf").getroot()
assert root.tag == "Xdmf" and len(root.findall("Domain/Grid")) == 1
grid = root.find("Domain/Grid")
def read(item):
    file, name = item.text.strip().split(":/")
    assert file == "a.h5" and item.get("Format") == "HDF", item.text
    return table(name, item)
vertices = read(grid.find("Geometry/DataItem"))
words, cells, at = read(grid.find("Topology/DataItem")), [], 0
assert grid.find("Geometry").get("GeometryType") == "XYZ" and grid.find("Topology").get("TopologyType") == "Mixed"
while at < len(words):
    count = {4: 3, 5: 4}.get(words[at])
    if count is None:
        assert words[at] == 3
        at, count = at + 1, words[at + 1]
    cells.append(tuple(words[at + 1:at + 1 + count]))
    at += 1 + count
assert len(cells) == int(grid.find("Topology").get("NumberOfElements"))
value = {}
for a in grid.findall("Attribute"):
    value[a.get("Name")] = read(a.find("DataItem"))
    assert len(value[a.get("Name")]) == {"Node": len(vertices), "Cell": len(cells)}[a.get("Center")], a.get("Name")
wanted = {"face", "area", "material"} | {n + "_%d" % k for k in range(3) for n in ("radiosity", "radiosity_mean", "irradiance", "error")}
assert set(value) == wanted, set(value) ^ wanted

data = open("a.ply", "rb").read()  # the same mesh, in floats
head, data = data.split(b"end_header\n", 1)
assert b"element vertex %d\n" % len(vertices) in head and b"element face %d\n" % len(cells) in head
single = lambda x: struct.unpack("<f", struct.pack("<f", x))[0]
for i, v in enumerate(vertices):
    p = struct.unpack_from("<3f3B3f", data, i * 27)
    assert p[:3] == tuple(map(single, v)) and p[6:] == tuple(single(value["radiosity_%d" % k][i]) for k in range(3)), i
at = 27 * len(vertices)
for c in cells:
    n = struct.unpack_from("<I", data, at)[0]
    assert struct.unpack_from("<%dI" % n, data, at + 4) == c
    at += 4 + 4 * n

rows = list(csv.DictReader(open("a.csv")))
error = [0.0, 0.0]
for i, row in enumerate(rows):
    mine = [c for c in range(len(cells)) if value["face"][c] == i]
    area = sum(value["area"][c] for c in mine)
    assert abs(area - float(row["area"])) <= 1e-9 * area, i
    for k in range(3):
        mean = lambda what: sum(value["area"][c] * value[what + "_%d" % k][c] for c in mine) / area
        h, rho, e = (float(row["%s_%d" % (q, k)]) for q in ("H", "rho", "E"))
        assert abs(mean("irradiance") - h) <= 1e-9 * h, (i, k)
        if i > 0:  # boxes stand on the floor
            assert abs(mean("radiosity_mean") - e - rho * h) <= 1e-9 * (e + rho * h), (i, k)
print(len(cells), "cells")
PY
if command -v h5dump >/dev/null && command -v python3 >/dev/null; then
    check "what it says and holds" python3 judge.py
    # the test itself
    sed 's/irradiance_0<.DataItem>/irradiance_1<\/DataItem>/' a.xdmf >b.xdmf && mv a.xdmf good.xdmf && mv b.xdmf a.xdmf
    check "another table is found out" bash -c '! python3 judge.py'
    mv good.xdmf a.xdmf
else
    echo "xdmf: skipped: h5dump (package hdf5-tools) or python3"
fi

# ---- names: with what XML has words for, in another folder
mkdir 'a&b'
check "a name with & and <" "$radiosity" solve "$scene" -q --no-errors -o 'a&b/x<&.xdmf'
check "beside it" [ -s 'a&b/x<&.h5' ]
check "and in the text" grep -q '>x&lt;&amp;.h5:/vertices<' 'a&b/x<&.xdmf'

# ---- what would be lost is kept
cp a.h5 own.h5
"$radiosity" solve "$scene" -q -o own.xdmf >out 2>said
check "what is beside and not ours: 2" [ $? = 2 ]
check "it says so" grep -q "^own.h5: error: is written beside own.xdmf, but is there already" said
cp a.xdmf full.xdmf && cp a.h5 full.h5
(ulimit -f 200; trap '' XFSZ; exec timeout 60 "$radiosity" solve "$scene" -q -o full.xdmf >out 2>said)
check "a full disk: 1" [ $? = 1 ]
check "it says so: $(head -n 2 said)" grep -q "^full.h5: error: cannot write: " said
check "what was there stays" cmp a.h5 full.h5
check "and its text" cmp a.xdmf full.xdmf
check "and nothing else: $(ls full*)" [ "$(ls full* | wc -l)" = 2 ]

finish xdmf
