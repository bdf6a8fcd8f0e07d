"""factor_formats.py - reads the matrices that check_factor_formats.sh has written, by the rules of their formats alone, and
holds them against the csv.

    factor_formats.py equal      f.csv against f.coo f.mtx f.npz f.view3d f.idf foam/F, names of f.names
    factor_formats.py sky        f.csv against f.coo f.mtx f.npz, with two more columns; all rows sum to 1
    factor_formats.py sums WHAT  rows of WHAT.csv are sums over the faces of f.csv by f.parts

Prints what is wrong; nothing when all is well. NumPy and SciPy are asked, too, where they are.
SPDX-License-Identifier: MIT"""

import csv
import re
import struct
import sys
import zipfile


def wrong(what):
    print(what)


def rows_of(name):
    with open(name, newline="") as file:
        return [[float(x) for x in row] for row in csv.reader(file)]


def table_of(name):
    with open(name, newline="") as file:
        return list(csv.DictReader(file))


def compare(what, found, right, most=0.0):
    if len(found) != len(right):
        return wrong(f"{what}: {len(found)} rows, not {len(right)}")
    for i, (x, y) in enumerate(zip(found, right)):
        if len(x) != len(y):
            return wrong(f"{what}: row {i} has {len(x)} columns, not {len(y)}")
        for j, (a, b) in enumerate(zip(x, y)):
            if abs(a - b) > most * max(1, abs(b)):
                return wrong(f"{what}: {i},{j} is {a!r}, not {b!r}")


def dense(like, entries):
    rows = [[0.0] * len(row) for row in like]
    for i, j, value in entries:
        rows[i][j] += value
    return rows


def array(data):
    """An array as NumPy writes it: type and numbers or bytes."""
    assert data[:8] == b"\x93NUMPY\x01\x00" and data[-1:] is not None
    length = 10 + struct.unpack("<H", data[8:10])[0]
    header = data[10:length].decode()
    assert length % 64 == 0 and header.endswith("\n")
    kind, shape = re.match(r"\{'descr': '(.*?)', 'fortran_order': False, 'shape': \((.*?)\), \}\s*$", header).groups()
    sizes = [int(n) for n in shape.replace(" ", "").split(",") if n]
    size, body = int(kind[2:]), data[length:]
    count = 1
    for n in sizes:
        count *= n
    assert len(body) == count * size, (kind, shape, len(body))
    if kind[1] == "S":
        return [body[i * size : (i + 1) * size].rstrip(b"\0").decode() for i in range(count)]
    return list(struct.unpack("<%d%s" % (count, {"i4": "i", "i8": "q", "f8": "d"}[kind[1:]]), body))


def check_npz(right, areas, names):
    with zipfile.ZipFile("f.npz") as archive:
        if archive.testzip():
            return wrong("npz: a checksum is wrong")
        parts = {name[:-4]: array(archive.read(name)) for name in archive.namelist()}
    # Headers of the files say the same as the list at the end, for readers that have only those.
    with open("f.npz", "rb") as file, zipfile.ZipFile("f.npz") as archive:
        for info in archive.infolist():
            file.seek(info.header_offset)
            head = struct.unpack("<IHHHHHIIIHH", file.read(30))
            if head[6:9] != (info.CRC, info.file_size, info.file_size):
                return wrong(f"npz: header of {info.filename}")
    count = len(right)
    if parts["format"] != ["csr"] or parts["shape"] != [count, len(right[0])]:
        return wrong("npz: format or shape")
    entries = [
        (i, parts["indices"][k], parts["data"][k])
        for i in range(count)
        for k in range(parts["indptr"][i], parts["indptr"][i + 1])
    ]
    if len(entries) != len(parts["data"]) or len(entries) != len(parts["indices"]):
        wrong("npz: not all entries are in a row")
    compare("npz", dense(right, entries), right, 1e-11)
    compare("npz: areas", [parts["areas"]], [areas], 1e-11)
    if parts["names"] != names:
        wrong(f"npz: names {parts['names']}")
    try:
        import scipy.sparse
    except ImportError:
        return
    compare("scipy", scipy.sparse.load_npz("f.npz").toarray().tolist(), right, 1e-11)


def numbers(text):
    return [float(x) for x in text.split()]


def check_view3d(right, areas):
    with open("f.view3d") as file:
        lines = file.read().split("\n")
    count = len(right)
    if len(lines[0]) != 30 or not re.match(r"View3D \S+ 0 [01] 0 %d *$" % count, lines[0]) or lines[-1]:
        wrong(f"view3d: {lines[0]!r}")
    compare("view3d: areas", [numbers(lines[1])], [areas], 1e-11)
    compare("view3d", [numbers(line) for line in lines[2 : 2 + count]], right)
    if len(numbers(lines[2 + count])) != count or not all(0 <= x <= 1 for x in numbers(lines[2 + count])):
        wrong("view3d: emissivities")


def check_energyplus(right, names):
    with open("f.idf") as file:
        text = re.sub("!.*", "", file.read())
    if text.count(";") != 1 or not text.rstrip().endswith(";"):
        return wrong("energyplus: the object does not end once")
    fields = [field.strip() for field in text.rstrip()[:-1].split(",")]
    names = [re.sub("[,;!]", "_", name) for name in names]
    if fields[0].lower() != "zoneproperty:userviewfactors:bysurfacename" or len(fields) != 2 + 3 * len(names) ** 2:
        return wrong(f"energyplus: {len(fields)} fields of {fields[0]}")
    number = {name: i for i, name in enumerate(names)}
    triples = [fields[k : k + 3] for k in range(2, len(fields), 3)]
    compare("energyplus", dense(right, [(number[a], number[b], float(f)) for a, b, f in triples]), right)


def foam(name, kind):
    with open(name) as file:
        text = file.read()
    head, body = re.match(r"FoamFile\s*\{(.*?)\}\s*(.*)$", text, re.S).groups()
    said = dict(re.findall(r"(\w+)\s+(\S+);", head))
    if said["class"] != kind or said["format"] != "ascii" or said["object"] != name.split("/")[-1]:
        wrong(f"openfoam: {said}")
    count, lists = re.match(r"(\d+)\s*\((.*)\)\s*$", body, re.S).groups()
    rows = []
    for size, values in re.findall(r"(\d+)\(([^)]*)\)", lists):
        rows.append(numbers(values))
        if len(rows[-1]) != int(size):
            wrong(f"openfoam: {name} counts {size}")
    if len(rows) != int(count):
        wrong(f"openfoam: {name} counts {count} rows")
    return rows


def check_foam(right):
    factors, faces = foam("foam/F", "scalarListList"), foam("foam/globalFaceFaces", "labelListList")
    entries = [(i, int(j), f) for i, row in enumerate(factors) for j, f in zip(faces[i], row)]
    if [len(row) for row in factors] != [len(row) for row in faces]:
        wrong("openfoam: F and globalFaceFaces differ")
    compare("openfoam", dense(right, entries), right)
    with open("foam/mapDist") as file:
        said = re.sub(r"\s+", " ", file.read().split("}", 1)[1]).strip()
    every = f"1( {len(right)}({' '.join(map(str, range(len(right))))}) )"
    if said != f"{len(right)} {every} {every} 0 0 0() 0()":
        wrong(f"openfoam: mapDist says {said}")


def check_equal(sky):
    right, table = rows_of("f.csv"), table_of("f.names.csv")
    areas, names = [float(row["area_m2"]) for row in table], [row["name"] for row in table]
    count = len(right)
    with open("f.names", newline="\n") as file:
        if file.read() != "".join(name + "\n" for name in names):
            wrong("the two files of names differ")
    with open("f.coo") as file:
        entries = [(int(i), int(j), float(f)) for i, j, f in csv.reader(file)]
    compare("coo", dense(right, entries), right)
    with open("f.mtx") as file:
        lines = [line for line in file if not line.startswith("%")]
    if lines[0].split() != [str(count), str(len(right[0])), str(len(entries))]:
        wrong(f"mtx: {lines[0]}")
    compare("mtx", dense(right, [(int(i) - 1, int(j) - 1, float(f)) for i, j, f in map(str.split, lines[1:])]), right)
    check_npz(right, areas, names)
    if sky:
        if len(right[0]) != count + 2 or not any(row[-2] > 0.01 for row in right) or not any(row[-1] > 0.01 for row in right):
            wrong("nothing goes to the sky, or to backs")
        return compare("sums", [[sum(row)] for row in right], [[1.0]] * count, 2e-3)
    check_view3d(right, areas)
    check_energyplus(right, names)
    check_foam(right)


def check_sums(what):
    faces, areas = rows_of("f.csv"), [float(row["area_m2"]) for row in table_of("f.names.csv")]
    with open(what + ".parts") as file:
        of = file.read().split("\n")[: len(faces)]
    table = table_of(what + ".names.csv")
    names = [row["name"] for row in table]
    if sorted(names) != sorted(set(of)):
        return wrong(f"{what}: rows are {names}, not {sorted(set(of))}")
    right = []
    for g in names:
        mine = [i for i in range(len(faces)) if of[i] == g]
        area = sum(areas[i] for i in mine)
        right.append([sum(areas[i] * faces[i][j] for i in mine for j in range(len(faces)) if of[j] == h) / area for h in names])
        if abs(area - float(table[names.index(g)]["area_m2"])) > 1e-9 * area:
            wrong(f"{what}: area of {g}")
    compare(what, rows_of(what + ".csv"), right, 1e-11)


check_sums(sys.argv[2]) if sys.argv[1] == "sums" else check_equal(sys.argv[1] == "sky")
