"""Scenes from arrays and meshes.

Arrays are copied by the commit, which from_arrays ends with: a scene never changes, and what was given may.
SPDX-License-Identifier: MIT
"""
import warnings

import numpy as np

from . import _mesh
from ._device import Device, InvalidInput, RadiosityWarning, as_namespace
from ._engine import ffi, lib
from ._factors import compute_factors
from ._solution import compute_solution


class Scene:
    """Polygons and what they reflect and emit.

    areas: of one side of each face (m2), 0 of faces without area and of those that others cover.
    report: what the engine made of the faces (struct RadSceneReport of radiosity.h).
    groups: a label for each face, where the scene was made with some; else None.
    """

    def __init__(self):
        raise TypeError("a scene is made by Scene.from_arrays or Scene.from_mesh")

    @classmethod
    def from_arrays(cls, vertices, faces, materials=None, *, reflectance=0.0, exitance=0.0, two_sided=False,
                    groups=None, threads=0):
        """A scene of polygons.

        vertices: (n, 3), m. Those of float32 are taken to be as exact as that.
        faces: indices of vertices, (m, k), or m sequences of 3 corners or more, counter-clockwise from the front.
        reflectance (0 <= rho < 1), exitance (W/m2), two_sided: one number for all faces or one for each, the
        first two also with three columns, red, green and blue; (1, 3) is one colour for all.
        materials: a number for each face; then the three have a row for each material instead.
        groups: a label for each face, for ViewFactors.by. threads: 0 means all processors.
        """
        vertices, single = _vertices(vertices)
        indices, sizes = _faces(faces, len(vertices))
        number, rows = _materials(len(sizes), materials, reflectance, exitance, two_sided)
        if groups is not None:
            groups = np.asarray(groups)
            if groups.shape != (len(sizes),):
                raise InvalidInput(f"groups has shape {groups.shape}; give one label for each of the "
                                   f"{len(sizes)} faces")
        device = Device(_whole("threads", threads))
        handle = device.call(lib.radNewScene, device.handle, release=lib.radReleaseScene)
        table = ffi.new("struct RadMaterial[]", len(rows))
        for material, row in zip(table, rows):
            material.reflectance = row[0:3].tolist()
            material.exitance = row[3:6].tolist()
            material.two_sided = int(row[6])
        device.call(lib.radSetSceneMaterials, handle, table, len(rows))
        polygons = ffi.new("struct RadPolygons *")
        polygons.positions = ffi.from_buffer("double[]", vertices)
        polygons.position_count = len(vertices)
        polygons.indices = ffi.from_buffer("uint32_t[]", indices)
        polygons.sizes = ffi.from_buffer("uint32_t[]", sizes)
        polygons.materials = ffi.from_buffer("uint32_t[]", number)
        polygons.count = len(sizes)
        polygons.single_precision = single
        device.call(lib.radSetSceneSharedPolygons, handle, polygons)
        device.call(lib.radCommitScene, handle)
        report = ffi.new("struct RadSceneReport *")
        device.call(lib.radGetSceneReport, handle, report)
        scene = object.__new__(cls)
        scene._device, scene._handle = device, handle
        scene.report, scene.groups = as_namespace(report[0]), groups
        areas = lib.radGetScenePolygonAreas(handle)
        scene.areas = np.frombuffer(ffi.buffer(areas, 8 * len(sizes)), dtype=float).copy()
        scene._sides = 1 + rows[number, 6]
        _warn(scene.report)
        return scene

    @classmethod
    def from_mesh(cls, mesh, *, group=None, **surfaces):
        """A scene of the faces of a meshio mesh: triangles, quads, polygons; of those of higher order the corners.

        group: the name of cell data, such as "gmsh:physical"; it becomes `groups`, numbers replaced by the mesh's
        own names for them where it has such. reflectance, exitance and two_sided may then be dicts by label.
        """
        vertices, faces, groups = _mesh.read(mesh, group)
        for name in ("reflectance", "exitance", "two_sided"):
            if isinstance(surfaces.get(name), dict):
                surfaces[name] = _mesh.by_label(name, surfaces[name], groups)
        return cls.from_arrays(vertices, faces, groups=groups, **surfaces)

    def __len__(self):
        return len(self.areas)

    def view_factors(self, tolerance=0.0, closure="none", *, progress=None, resume=None):
        """View factors between all faces, as ViewFactors.

        tolerance: the error of a row's sum to work for; 0: 3e-4. closure: "none"; "rows", rows of a closed scene sum
        to 1; "reciprocal", they do, and A_i F_ij = A_j F_ji. progress: called with .phase, .share, .links and
        others now and then; something true that it returns ends the work (Cancelled). resume: the name of a file for
        long work. What ends it, Ctrl-C and exceptions of progress among them, then waits until it can be put down,
        about a second, and leaves it there, as does every 10 s; the same call goes on from it, to the same bits, on any
        number of threads (closure may be another), and removes the file when the factors are done.
        """
        return compute_factors(self, tolerance, closure, progress, resume)

    def solve(self, oracle=None, *, parameters=None, basis="linear", closure="none", tolerance=0.0, correct=True,
              measure=True, progress=None):
        """The light in the scene, as Solution.

        oracle: the name of a built-in one, or a .dag file; None: the default, over as many links as pay. parameters:
        a dict of its own.
        basis: "linear" or "constant" on each element. closure: "none" or "rows". tolerance: what iteration may
        leave; 0: a tenth of what the elements leave. correct: mend the solution by particles. measure: measure its
        error by others. progress: as of view_factors.
        """
        return compute_solution(self, oracle, parameters, basis, closure, tolerance, correct, measure, progress)


def _whole(name, value):
    try:
        whole = int(value)
    except (TypeError, ValueError, OverflowError):  # None, nan, inf
        whole = -1
    if whole != value or not 0 <= whole < 2**31:
        raise InvalidInput(f"{name} is {value!r}; it must be a whole number, 0 or more")
    return whole


def _vertices(vertices):
    given = np.asarray(vertices)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iuf":
        raise InvalidInput(f"vertices has shape {given.shape} of {given.dtype}; it must be numbers, (n, 3)")
    if len(given) == 0:
        raise InvalidInput("there are no vertices; give those that faces are made of")
    if not np.isfinite(given).all():
        at = int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])
        raise InvalidInput(f"vertex {at} is {given[at].tolist()}; coordinates must be finite")
    return np.ascontiguousarray(given, dtype=np.float64), int(given.dtype == np.float32)


def _faces(faces, vertices):
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        indices = faces.reshape(-1)
        sizes = np.full(len(faces), faces.shape[1])
    else:
        each = [np.asarray(face) for face in faces]
        for i, face in enumerate(each):
            if face.ndim != 1 or (len(face) and face.dtype.kind not in "iu"):
                raise InvalidInput(f"face {i} is {face.tolist()!r}; it must be a list of whole numbers")
        sizes = np.array([len(face) for face in each], dtype=np.int64)
        indices = np.concatenate([face.astype(np.int64) for face in each]) if each else np.zeros(0, int)
    if len(sizes) == 0:
        raise InvalidInput("there are no faces; give one at least")
    if indices.dtype.kind not in "iu":
        raise InvalidInput(f"faces is of {indices.dtype}; it must be indices of vertices, whole numbers")
    wrong = (indices < 0) | (indices >= vertices)
    if wrong.any():
        at = int(np.argmax(wrong))
        face = int(np.searchsorted(np.cumsum(sizes), at, side="right"))
        raise InvalidInput(f"face {face} has the corner {int(indices[at])}; vertices count from 0 to {vertices - 1}")
    return np.ascontiguousarray(indices, dtype=np.uint32), np.ascontiguousarray(sizes, dtype=np.uint32)


def _column(name, value, count, rows):
    """(count, 3) of one number, a row each, or one row for all."""
    given = np.asarray(value)
    if given.dtype.kind not in "biuf":
        raise InvalidInput(f"{name} is of {given.dtype}; it must be numbers")
    if given.ndim == 1:
        given = given[:, None]
    if given.ndim > 2 or (given.ndim == 2 and (given.shape[0] not in (1, count) or given.shape[1] not in (1, 3))):
        raise InvalidInput(f"{name} has shape {np.shape(value)}; it must be one number, or ({count},) or ({count}, 3), "
                           f"a row for each of the {rows}")
    return np.broadcast_to(given, (count, 3)).astype(float)


def _sides(two_sided, count, rows):
    """A column of 0 and 1. Numbers of sides, 1 and 2, would all be true, and so would NaN."""
    given = np.asarray(two_sided)
    if given.ndim > 1 and given.shape[1:] != (1,):
        raise InvalidInput(f"two_sided has shape {given.shape}; it must be one number, or ({count},), one for each of "
                           f"the {rows}")
    column = _column("two_sided", two_sided, count, rows)[:, :1]
    wrong = ~((column == 0) | (column == 1))
    if wrong.any():
        row = int(wrong.argmax())
        raise InvalidInput(f"{rows[:-1]} {row} has two_sided {column[row, 0]:.6g}; it must be 0 or 1")
    return column


def _materials(faces, materials, reflectance, exitance, two_sided):
    """Rows of rho, E and two_sided, and the row of each face."""
    count, rows = faces, "faces"
    if materials is not None:
        materials = np.asarray(materials)
        if materials.shape != (faces,) or materials.dtype.kind not in "iu" or (materials < 0).any():
            raise InvalidInput(f"materials must be a whole number, 0 or more, for each of the {faces} faces")
        given = [len(v) for v in map(np.asarray, (reflectance, exitance, two_sided)) if v.ndim and len(v) > 1]
        if not given: # all alike, whatever the numbers are
            materials = np.unique(materials, return_inverse=True)[1].reshape(-1)
        count, rows = max(given, default=int(materials.max()) + 1), "materials"
        face = int(materials.argmax())
        if materials[face] >= count:
            raise InvalidInput(f"face {face} has material {materials[face]}, but there are {count} rows, from 0")
    table = np.hstack([_column("reflectance", reflectance, count, rows), _column("exitance", exitance, count, rows),
                       _sides(two_sided, count, rows)])
    if materials is not None:
        return np.ascontiguousarray(materials, dtype=np.uint32), table
    # The engine would name a material, which the caller has not numbered.
    most = np.finfo(np.float32).max
    for name, unit, wrong in (("reflectance", "", ~((table[:, :3] >= 0) & (table[:, :3] < 1))),
                              ("exitance", " W/m2", ~((table[:, 3:6] >= 0) & (table[:, 3:6] <= most)))):
        if wrong.any():
            face, band = np.argwhere(wrong)[0]
            value = table[face, band + 3 * (name == "exitance")]
            raise InvalidInput(f"face {face} has {name} {value:.6g}{unit}; it must be 0 or more and " +
                               ("below 1" if name == "reflectance" else "finite, 3.4e38 at most"))
    table, number = np.unique(table, axis=0, return_inverse=True)
    return np.ascontiguousarray(number.reshape(-1), dtype=np.uint32), table


def _warn(report):
    """What of the faces does not take part as given."""
    said = []
    if report.dropped:
        said.append(f"{report.dropped} of {report.polygons} faces have no area and are left out")
    if report.overlaps:
        said.append(f"{report.overlaps} faces lie on others in one plane, with the same side in front, and lose what "
                    f"is covered, {report.overlap_area:.6g} m2")
    if report.crossing:
        said.append(f"the outlines of {report.crossing} faces cross themselves; each is taken for all that its "
                    "outline goes round")
    for text in said:
        warnings.warn(text, RadiosityWarning, stacklevel=3)
