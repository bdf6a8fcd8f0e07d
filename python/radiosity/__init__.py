"""View factors and radiosity of polygons, what stands between them included, with measured error.

    import radiosity

    scene = radiosity.Scene.from_arrays(vertices, faces, reflectance=0.5, exitance=emitted)
    factors = scene.view_factors()          # .matrix (scipy.sparse), .row_sums, .areas, .report
    solution = scene.solve()                # .radiosity, .irradiance, .error, .deviation, .measured

Metres and W/m2; faces count from 0 as they were given, and each is one row. A face has one side, the one from which
its corners run counter-clockwise; its back is black, unless it is `two_sided`. What cannot be computed is an
exception with the engine's own sentence (`RadiosityError`), what the engine mended on its way a `RadiosityWarning`.
Any thread may call; a scene does one thing at a time, others wait. Other Python threads run meanwhile, and Ctrl-C
ends a computation.
SPDX-License-Identifier: MIT
"""
from ._engine import ffi, lib
from ._device import Cancelled, InvalidInput, OutOfMemory, RadiosityError, RadiosityWarning
from ._factors import ViewFactors
from ._scene import Scene
from ._solution import Solution, oracles

__version__ = ffi.string(lib.RADIOSITY_VERSION).decode()
del ffi, lib
__all__ = ["Cancelled", "InvalidInput", "OutOfMemory", "RadiosityError", "RadiosityWarning", "Scene", "Solution",
           "ViewFactors", "oracles"]
