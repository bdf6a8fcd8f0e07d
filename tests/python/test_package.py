"""test_package.py - the Python package against closed forms, and what it does with bad input, threads and signals.

Closed forms: squares that face each other and that share an edge (Howell, C-11 and C-14); the white furnace; for a cube
whose ceiling emits, the continuous solution (tests/check_install.sh). Run alone: each function that begins with
test_ is one, in pytest, too.
SPDX-License-Identifier: MIT
"""
import gc
import os
import re
import signal
import sys
import tempfile
import threading
import time
import types
import warnings
import weakref

import numpy as np

import radiosity

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
# Ceiling, floor, walls, counter-clockwise as seen from inside.
CUBE = np.array([[4, 7, 6, 5], [0, 1, 2, 3], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]])
FACING = (np.log(4 / 3) / 2 + 2 * np.sqrt(2) * np.arctan(np.sqrt(.5)) - np.pi / 2) * 2 / np.pi
BESIDE = (1 - FACING) / 4
EXACT = np.full((6, 6), BESIDE)
for a, b in ((0, 1), (2, 4), (3, 5)):
    EXACT[a, b] = EXACT[b, a] = FACING
EXACT -= np.diag(np.diag(EXACT))


def triangles(quads):
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3)


def near(got, wanted, within):
    off = np.abs(np.asarray(got) - wanted).max()
    assert off <= within, f"{got} is off {wanted} by {off:.3g}"


def raises(kind, text, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except kind as error:
        assert text in str(error), f"{error!r} does not say {text!r}"
        return error
    raise AssertionError(f"no {kind.__name__} about {text!r}")


def test_cube():
    factors = radiosity.Scene.from_arrays(CORNERS, CUBE).view_factors()
    near(factors.matrix.toarray(), EXACT, 1e-7)
    near(factors.row_sums, 1, 1e-6)
    near(factors.areas, 1, 1e-12)
    assert factors.matrix.format == "csr" and factors.matrix.nnz == 30 and factors.matrix.has_sorted_indices
    assert factors.report.rows_closed == 6 and factors.report.rows_open == 0 and len(factors) == 6


def test_two_sides_in_groups():
    """A screen that halves a room sends from both sides, and counts with both where it shares a group with a wall."""
    corners = np.vstack([CORNERS, [[.5, 0, 0], [.5, 1, 0], [.5, 1, 1], [.5, 0, 1]]])
    scene = radiosity.Scene.from_arrays(corners, np.vstack([CUBE, [[8, 9, 10, 11]]]), two_sided=[False] * 6 + [True])
    factors = scene.view_factors()
    near(scene.areas, 1, 1e-12)
    near(factors.areas, [1] * 6 + [2], 1e-12)
    groups = factors.by(list("abcdefa"))  # the screen and the ceiling
    near(groups.areas, [3, 1, 1, 1, 1, 1], 1e-12)
    for of in factors, groups:
        sent = of.areas[:, None] * of.matrix.toarray()
        near(sent, sent.T, 1e-12)
        near(of.row_sums, 1, 3e-4)


def test_triangles():
    labels = np.repeat(np.arange(6), 2)
    factors = radiosity.Scene.from_arrays(CORNERS, triangles(CUBE), groups=labels).view_factors()
    of_faces = factors.by()
    near(of_faces.matrix.toarray(), EXACT, 1e-4)
    near(of_faces.areas, 1, 1e-12)
    near(of_faces.row_sums, 1, 3e-4)
    both_ways = factors.areas[:, None] * factors.matrix.toarray()
    near(both_ways, both_ways.T, 1e-12)
    assert list(factors.by(np.array(list("abcdef"))[labels]).names) == list("abcdef")
    raises(radiosity.InvalidInput, "each of the 12 faces", factors.by, [1, 2])
    raises(radiosity.InvalidInput, "each of the 12 faces", radiosity.Scene.from_arrays(
        CORNERS, triangles(CUBE)).view_factors().by)


def plates(n):
    """Two squares that face each other at their side's distance, of n x n faces each: vertices, faces."""
    at = np.linspace(0, 1, n + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    floor = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    cell = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    up = np.stack([cell, cell + n + 1, cell + n + 2, cell + 1], axis=-1)
    return np.concatenate([floor, floor + [0, 0, 1]]), np.concatenate([up, up[:, ::-1] + len(floor)])


def test_many_rows():  # more than one thread fills
    scene = radiosity.Scene.from_arrays(*plates(13), groups=np.repeat(["floor", "roof"], 169))
    factors = scene.view_factors()
    assert factors.matrix.shape == (338, 338)
    near(factors.by().matrix.toarray(), [[0, FACING], [FACING, 0]], 1e-5)
    near(np.asarray(factors.matrix.sum(axis=1)).ravel(), factors.row_sums, 1e-9)
    assert (factors.row_sums < .5).all()


def test_polygons_of_all_sizes():
    faces = [list(face) for face in CUBE]
    faces[1:2] = [[0, 1, 2], (0, 2, 3)]
    factors = radiosity.Scene.from_arrays(CORNERS, faces).view_factors(closure="reciprocal")
    merged = factors.by(["ceiling", "floor", "floor", "w1", "w2", "w3", "w4"])
    near(merged.matrix.toarray()[0, 1], FACING, 1e-4)
    near(factors.row_sums, 1, 1e-9)


def test_float32_and_views():
    backwards = CORNERS[::-1]  # not contiguous
    factors = radiosity.Scene.from_arrays(backwards.astype(np.float32)[::1], (7 - CUBE).astype(np.int8)).view_factors()
    near(factors.matrix.toarray(), EXACT, 1e-6)
    given = CORNERS.copy()
    scene = radiosity.Scene.from_arrays(given, CUBE)
    given[:] = 0  # was copied
    near(scene.view_factors().matrix.toarray(), EXACT, 1e-7)


def test_mesh():
    block = types.SimpleNamespace
    mesh = block(points=CORNERS, cells=[block(type="line", data=np.array([[0, 1]])),
                                        block(type="quad", data=CUBE[:2]),
                                        block(type="triangle6", data=np.hstack([triangles(CUBE[2:])] * 2))],
                 cell_data={"gmsh:physical": [np.array([9]), np.array([7, 8]), np.full(8, 5)]},
                 field_data={"ceiling": np.array([7, 2]), "floor": np.array([8, 2]), "walls": np.array([5, 2])})
    scene = radiosity.Scene.from_mesh(mesh, group="gmsh:physical", exitance={"ceiling": 1, "floor": 0, "walls": 0})
    assert list(scene.groups[:3]) == ["ceiling", "floor", "walls"] and len(scene) == 10
    factors = scene.view_factors().by()
    near(factors.matrix.toarray(), [[0, FACING, 4 * BESIDE], [FACING, 0, 4 * BESIDE], [BESIDE, BESIDE, FACING + 2 * BESIDE]],
         1e-4)
    read = radiosity.Scene.from_mesh
    raises(radiosity.InvalidInput, "it has gmsh:physical", read, mesh, group="tags")
    raises(radiosity.InvalidInput, "no value for walls and one for wall,", read, mesh, group="gmsh:physical",
           reflectance={"ceiling": 0, "floor": 0, "wall": 0})
    mesh.cells = mesh.cells[:1] + [block(type="tetra", data=np.array([[0, 1, 2, 4]]))]
    raises(radiosity.InvalidInput, "only line, tetra; extract its surface", read, mesh)


def test_white_furnace():
    solution = radiosity.Scene.from_arrays(CORNERS, CUBE, reflectance=.5, exitance=1).solve()
    near(solution.radiosity, 2, 2e-3)
    near(solution.irradiance, 2, 4e-3)
    rho, emitted = np.array([[.2, .5, .8]]), np.array([[1., 2., 3.]])
    colours = radiosity.Scene.from_arrays(CORNERS, CUBE, reflectance=rho, exitance=emitted).solve(closure="rows")
    assert colours.radiosity.shape == (6, 3)
    near(colours.radiosity / (emitted / (1 - rho)), 1, 4e-3)


def test_lamp():
    truth = np.array([1.1043616, .1712161] + [.1811056] * 4)
    scene = radiosity.Scene.from_arrays(CORNERS, CUBE, [0, 1, 1, 1, 1, 1], reflectance=.5, exitance=[1, 0])
    solution = scene.solve()
    near(solution.radiosity, truth, .0064)
    near(solution.irradiance, (truth - [1, 0, 0, 0, 0, 0]) / .5, .0128)
    # The measured error is the error, but for its noise.
    assert (np.abs(solution.error - (solution.radiosity - truth)) < 5 * solution.deviation + 1e-4).all()
    assert (solution.deviation > 0).all() and (solution.deviation < .01).all()
    assert 0 <= solution.measured.l1_faces.low <= solution.measured.l1_faces.high < .05
    assert not hasattr(solution.measured, "l2") and solution.measure_error(stream=1, surfaces=True).l2.high > 0
    # A coarse one is wrong, and the measurement says by how much.
    coarse = scene.solve("bf", parameters={"relative": 2}, basis="constant", correct=False, measure=False)
    assert coarse.error is None and coarse.measured is None and coarse.report.links < solution.report.links
    raises(radiosity.InvalidInput, "rays is -5; it must be a whole number", coarse.measure_error, -5)
    raises(radiosity.InvalidInput, "stream is 0.5; it must be a whole number", coarse.measure_error, 0, .5)
    coarse.measure_error(rays=400000)
    off = coarse.radiosity - truth
    assert np.abs(off).max() > .003
    assert (np.abs(coarse.error - off) < 5 * coarse.deviation + 1e-4).all(), (coarse.error, off)


def test_links_that_pay():
    solution = radiosity.Scene.from_arrays(CORNERS, CUBE, [0, 1, 1, 1, 1, 1], reflectance=.5, exitance=[1, 0]).solve()
    assert solution.links.no_links == 0 and solution.links.rays > 0 and solution.report.links > 0
    # Boxes that hang in rows below a small lamp: particles alone take less.
    corners, faces = [CORNERS * [6, 6, 3]], [CUBE]
    for at in np.ndindex(7, 7, 4):
        corners.append(CORNERS * [.37, .37, .3] + [.3 + .77 * at[0], .3 + .77 * at[1], .3 + .6 * at[2]])
        faces.append(CUBE[:, ::-1] + 8 * len(faces))
    corners.append(CORNERS * [.2, .2, .05] + [2.9, 2.9, 2.9])
    faces.append(CUBE[:, ::-1] + 8 * len(faces))
    lamp = np.zeros(6 * len(faces), int)
    lamp[-6:] = 1
    scene = radiosity.Scene.from_arrays(np.concatenate(corners), np.concatenate(faces), lamp, reflectance=[.7, 0],
                                        exitance=[0, 10])
    solution = scene.solve()
    assert solution.links.no_links == 1 and solution.report.links == 0
    assert solution.measured.l1_faces.value < .01 and abs(solution.measured.power.value) < .01
    linked = scene.solve(parameters={"energy": 1e-3}, correct=False, measure=False)
    assert linked.links is None and linked.report.links > 0


def test_errors():
    make, wrong = radiosity.Scene.from_arrays, radiosity.InvalidInput
    assert issubclass(wrong, ValueError) and issubclass(wrong, radiosity.RadiosityError)
    for text, arguments, named in (
            ("(n, 3)", (CORNERS[:, :2], CUBE), {}),
            ("vertex 1 is [nan, 0.0, 0.0]", (
                                             np.where(np.arange(24).reshape(8, 3) == 3, np.nan, CORNERS), CUBE), {}),
            ("face 1 has the corner 8; vertices count from 0 to 7", (CORNERS, [[0, 1, 2], [0, 1, 8]]), {}),
            ("face 0 has the corner -1", (CORNERS, [[-1, 1, 2]]), {}),
            ("whole numbers", (CORNERS, CUBE * 1.0), {}),
            ("face 1 is [0.5", (CORNERS, [[0, 1, 2], [.5, 1, 2]]), {}),
            ("no faces", (CORNERS, []), {}),
            ("all of its 1 faces are degenerate", (CORNERS, [[0, 1, 1]]), {}),
            ("face 3 has reflectance 1;", (CORNERS, CUBE), {"reflectance": [0, 0, 0, 1, 0, 0]}),
            ("face 0 has exitance -1 W/m2", (CORNERS, CUBE), {"exitance": -1}),
            ("face 0 has exitance 1e+300 W/m2; it must be 0 or more and finite, 3.4e38", (CORNERS, CUBE), {"exitance": 1e300}),
            ("face 2 has two_sided 2; it must be 0 or 1", (CORNERS, CUBE), {"two_sided": [1, 1, 2, 1, 1, 1]}),
            ("material 1 has two_sided nan; it must be 0 or 1", (CORNERS, CUBE, [0, 1] * 3), {"two_sided": [0, np.nan]}),
            ("two_sided has shape (6, 3); it must be one number, or (6,), one for each of the faces", (CORNERS, CUBE),
             {"two_sided": np.ones((6, 3))}),
            ("material 1 has reflectance 2", (CORNERS, CUBE, [0, 1] * 3), {"reflectance": [0, 2]}),
            ("reflectance has shape (2,)", (CORNERS, CUBE), {"reflectance": [0, 0]}),
            ("materials must be", (CORNERS, CUBE, [0, 1]), {}),
            ("face 5 has material 1000000000, but there are 2 rows", (CORNERS, CUBE, [0, 0, 0, 0, 1, 10**9]),
             {"reflectance": [[0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]}),
            ("threads is -1", (CORNERS, CUBE), {"threads": -1}),
            ("threads is nan; it must be a whole number", (CORNERS, CUBE), {"threads": np.nan}),
            ("threads is inf; it must be a whole number", (CORNERS, CUBE), {"threads": np.inf}),
            ("threads is None; it must be a whole number", (CORNERS, CUBE), {"threads": None}),
            ("there are no vertices", (np.zeros((0, 3)), [[0, 1, 2]]), {}),
            ("one label for each of the 6 faces", (CORNERS, CUBE), {"groups": "a"})):
        raises(wrong, text, make, *arguments, **named)
    scene = make(CORNERS, CUBE)
    raises(wrong, "'rows', 'reciprocal'", scene.view_factors, closure="all")
    raises(wrong, "tolerance is -1", scene.view_factors, tolerance=-1)
    raises(wrong, "no built-in oracle 'none'; give", scene.solve, "none")
    raises(wrong, "cannot read none.dag", scene.solve, "none.dag")
    raises(wrong, "cannot read none.dag", scene.solve, b"none.dag")
    raises(wrong, "cannot read \ufffd.dag", scene.solve, "\udce4.dag")  # a file's name that is no UTF-8
    raises(wrong, "has a NUL in it", scene.solve, "power\0.dag")
    raises(wrong, "no parameter 'x'; it has energy", scene.solve, parameters={"x": 1})
    raises(wrong, "'a' for 'energy'; it must be a number", scene.solve, parameters={"energy": "a"})
    raises(wrong, "2 for 1; it must be a number for a name", scene.solve, parameters={1: 2})
    raises(TypeError, "from_arrays", radiosity.Scene)
    factors = scene.view_factors()
    near(factors.matrix.toarray(), EXACT, 1e-7)  # as good as before
    raises(wrong, "labels of several kinds", factors.by, np.array([None, 1, "a", "a", 2, 2], dtype=object))
    assert "power" in radiosity.oracles()


def test_report():
    """All that the header has of the report."""
    header = os.path.join(os.path.dirname(__file__), "..", "..", "runtime", "radiosity.h")
    with open(header, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)
    inside = re.search(r"struct RadExchangeReport \{(.*?)\n\};", text, re.S).group(1)
    nested = re.search(r"struct \{(.*?)\} seconds;", inside, re.S)
    names = [re.findall(r"\w+(?=[,;])", part) for part in (inside.replace(nested.group(0), ""), nested.group(1))]
    report = radiosity.Scene.from_arrays(CORNERS, CUBE).view_factors().report
    assert len(names[0]) > 15 and set(names[0]) | {"seconds"} == set(vars(report)), (names, report)
    assert set(names[1]) == set(vars(report.seconds)) and report.seconds.refine >= 0, report
    assert 0 <= report.entry_error < 1 and report.rows_backs == 0 and report.worst <= report.defect_most, report


def test_warnings():
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        scene = radiosity.Scene.from_arrays(CORNERS, [*CUBE.tolist(), [0, 1, 1, 0], [0, 1, 2, 3]])
    assert [w.category for w in said] == [radiosity.RadiosityWarning] * 2 and said[0].filename == __file__, said
    assert "1 of 8 faces have no area" in str(said[0].message) and "lie on others" in str(said[1].message)
    factors = scene.view_factors()
    near(factors.matrix.toarray()[:6, :6], EXACT, 1e-7)
    near(factors.areas[6:], 0, 0)
    assert factors.matrix[6:].nnz == 0


def long_work():
    """A scene whose factors take seconds: triangles in the air."""
    some = np.random.default_rng(1)
    where = some.uniform(0, 10, (1500, 1, 3)) + some.uniform(-1, 1, (1500, 3, 3))
    return radiosity.Scene.from_arrays(where.reshape(-1, 3), np.arange(4500).reshape(-1, 3), two_sided=True)


def test_progress_and_signals():
    scene = long_work()
    told = []
    raises(radiosity.Cancelled, "progress", scene.view_factors, progress=lambda p: told.append(p) or len(told) > 2)
    assert len(told) == 3 and told[0].phase in ("refine", "factors"), told
    raises(ZeroDivisionError, "", scene.view_factors, progress=lambda p: 1 / 0)
    raises(radiosity.RadiosityError, "cannot ask the scene", scene.view_factors,
           progress=lambda p: scene.view_factors())
    # Ctrl-C, and other threads run meanwhile.
    beats = []
    threading.Timer(.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    stop = threading.Event()
    beat = threading.Thread(target=lambda: [beats.append(time.sleep(.01)) for _ in iter(stop.is_set, True)])
    beat.start()
    begun = time.monotonic()
    raises(KeyboardInterrupt, "", scene.view_factors)
    stop.set()
    beat.join()
    assert time.monotonic() - begun < 3 and len(beats) > 5, (time.monotonic() - begun, len(beats))


def long_factors(threads):
    """A second of half shadow: three boxes stand in a cube whose walls are of 8 x 8 squares."""
    corners, faces = (half[:len(half) // 2] for half in plates(8))
    vertices, squares = [], []
    for axis in range(3):
        for far in (0, 1):
            squares.append((faces[:, ::-1] if far else faces) + len(corners) * len(vertices))
            vertices.append(np.roll(corners + [0, 0, far], axis, axis=1))
    for at in ((.2, .2), (.6, .3), (.35, .65)):
        squares.append(CUBE[:, ::-1] + sum(map(len, vertices)))
        vertices.append(CORNERS * [.2, .2, .5] + [*at, .1])
    return radiosity.Scene.from_arrays(np.concatenate(vertices), np.concatenate(squares), threads=threads)


def test_resume():
    whole = long_factors(1).view_factors(closure="rows")
    near(whole.row_sums, 1, 1e-6)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "state")
        phases = []

        def stop(progress):  # as soon as the first factors, or the next ones, are there
            phases.append((progress.phase, progress.share))
            return progress.phase == "factors" and progress.share > 0

        def interrupt(progress):
            if stop(progress):
                os.kill(os.getpid(), signal.SIGINT)

        def break_down(progress):
            if stop(progress):
                raise ZeroDivisionError
        for kind, progress in ((radiosity.Cancelled, stop), (KeyboardInterrupt, interrupt),
                               (ZeroDivisionError, break_down)):
            raises(kind, "", long_factors(2).view_factors, progress=progress, resume=path)
            assert os.listdir(folder) == ["state"]  # and nothing beside it
        begun = [share for phase, share in phases if phase == "resumed"]
        assert len(begun) == 2 and 0 < begun[0] <= begun[1], phases
        raises(radiosity.InvalidInput, "state: it is of another scene", radiosity.Scene.from_arrays(
            CORNERS, CUBE).view_factors, resume=path)
        raises(radiosity.InvalidInput, "of another tolerance", long_factors(1).view_factors, .01, resume=path)
        with open(path, "r+b") as file:
            file.seek(200)
            was = file.read(1)
            file.seek(200)
            file.write(bytes([was[0] ^ 1]))
        raises(radiosity.InvalidInput, "remove it to start anew", long_factors(1).view_factors, resume=path)
        with open(path, "r+b") as file:
            file.seek(200)
            file.write(was)
        phases.clear()
        factors = long_factors(1).view_factors(
            closure="rows", progress=lambda p: phases.append((p.phase, p.share)), resume=path)
        assert phases[0][0] == "resumed" and phases[0][1] > 0 and os.listdir(folder) == [], phases[0]
        assert (factors.matrix != whole.matrix).nnz == 0 and (factors.row_sums == whole.row_sums).all()
        raises(TypeError, "float", long_factors(1).view_factors, resume=3.5)
        raises(IsADirectoryError, folder, long_factors(1).view_factors, resume=folder)
        raises(radiosity.InvalidInput, "an empty name", long_factors(1).view_factors, resume="")
        told = []
        raises(FileNotFoundError, "none", long_factors(1).view_factors, progress=told.append,
               resume=os.path.join(folder, "none", "state"))
        assert told == [], told  # refused before there was work
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            there = os.path.join(folder, "there")
            os.mkdir(there)
            raises(radiosity.Cancelled, "", long_factors(1).view_factors,
                   progress=lambda p: os.path.exists(there) and os.rmdir(there) or stop(p),
                   resume=os.path.join(there, "state"))
        assert len(said) == 1 and "cannot be written" in str(said[0].message), said


def test_handles_are_released():
    scene = radiosity.Scene.from_arrays(CORNERS, CUBE, exitance=1)
    solution, factors = scene.solve(correct=False, measure=False), scene.view_factors()
    gone = [weakref.ref(one) for one in (scene, solution, scene._device)]
    del scene
    solution.measure_error()  # keeps alive what it needs
    near(factors.areas, 1, 1e-12)
    del solution
    gc.collect()
    assert [one() for one in gone] == [None] * 3
    resident = []
    for rounds in (4, 12):
        for _ in range(rounds):
            scene = radiosity.Scene.from_arrays(*plates(13), exitance=1)
            scene.view_factors()
            scene.solve(correct=False, measure=False)
        with open("/proc/self/statm") as file:
            resident.append(int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
    assert resident[1] - resident[0] < 3e6, resident


def test_one_thing_at_a_time():
    """A second thread waits until the scene has done what it does."""
    scene = long_work()
    order, others = [], []

    def second():
        try:
            scene.view_factors(progress=lambda p: order.append("second") or True)
        except radiosity.Cancelled:
            order.append("second cancelled")

    def first(_progress):
        if not others:
            others.append(threading.Thread(target=second))
            others[0].start()
            others[0].join(.3)
        order.append("first")
        return len(order) > 3
    raises(radiosity.Cancelled, "", scene.view_factors, progress=first)
    others[0].join()
    assert order == ["first"] * 4 + ["second", "second cancelled"], order


def test_threads():
    """Scenes at the same time, and one scene asked by many."""
    results = []
    shared = radiosity.Scene.from_arrays(CORNERS, CUBE)

    def work():
        for scene in (shared, radiosity.Scene.from_arrays(CORNERS, CUBE)):
            results.append(scene.view_factors().matrix.toarray())
    workers = [threading.Thread(target=work) for _ in range(6)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(results) == 12 and all((one == results[0]).all() for one in results)
    near(results[0], EXACT, 1e-7)


if __name__ == "__main__":
    failed, tests = 0, [(name, one) for name, one in list(globals().items()) if name.startswith("test_")]
    for name, one in tests:
        begun = time.monotonic()
        try:
            one()
        except BaseException as error:  # a KeyboardInterrupt that nobody caught, too
            failed += 1
            print(f"failed: {name}: {type(error).__name__}: {error}")
            import traceback
            traceback.print_exc(limit=-2, file=sys.stdout)
        if "-v" in sys.argv:
            print(f"{time.monotonic() - begun:6.2f} s {name}")
    print(f"package: {len(tests)} checks, {failed} failed")
    sys.exit(failed > 0)
