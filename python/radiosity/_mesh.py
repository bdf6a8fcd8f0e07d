"""Faces of a meshio mesh. meshio itself is not needed: a mesh is whatever has points, cells and cell_data.

SPDX-License-Identifier: MIT
"""
import numpy as np

from ._device import InvalidInput


def _corners(kind):
    """How many corners a cell of this kind has as a face, 0: all there are, None: it is none."""
    if kind.startswith("polygon"):
        return 0
    for name, corners in (("triangle", 3), ("quad", 4)):
        if kind.startswith(name) and (kind == name or kind[len(name):].isdigit()):
            return corners
    return None


def read(mesh, group):
    """Vertices (n, 3), a list of faces, and the label of each face or None."""
    points = np.asarray(mesh.points)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.hstack([points, np.zeros((len(points), 1), points.dtype)])
    labels = None
    if group is not None:
        if group not in mesh.cell_data:
            there = ", ".join(sorted(mesh.cell_data)) or "none"
            raise InvalidInput(f"the mesh has no cell data {group!r}; it has {there}")
        labels = mesh.cell_data[group]
    faces, groups, other = [], [], set()
    for i, block in enumerate(mesh.cells):
        corners = _corners(block.type)
        if corners is None:
            other.add(block.type)
            continue
        faces += [np.asarray(cell)[: corners or None] for cell in block.data]
        if labels is not None:
            groups += np.asarray(labels[i]).tolist()
    if not faces:
        raise InvalidInput("the mesh has no triangles, quads or polygons" +
                           (f", only {', '.join(sorted(other))}; extract its surface first" if other else ""))
    if labels is None:
        return points, faces, None
    # meshio's field_data: the name of a physical group -> its number and dimension
    names = {int(value[0]): name for name, value in getattr(mesh, "field_data", {}).items()
             if len(value) > 1 and int(value[1]) == 2}
    named = [names.get(label, label) for label in groups]
    return points, faces, np.array([str(n) for n in named] if names else named)


def by_label(name, values, groups):
    """A value for each face, from a dict by label."""
    if groups is None:
        raise InvalidInput(f"{name} is by label, and the mesh is read without: name its cell data by group=")
    labels = groups.tolist()
    missing = sorted({str(label) for label in labels if label not in values})
    unknown = sorted({str(label) for label in values} - {str(label) for label in labels})
    if missing or unknown:
        raise InvalidInput(f"{name} has " + " and ".join(
            ([f"no value for {', '.join(missing)}"] if missing else []) +
            ([f"one for {', '.join(unknown)}, which no face is in"] if unknown else [])))
    return np.array([values[label] for label in labels])
