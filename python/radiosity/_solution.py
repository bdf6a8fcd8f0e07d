"""The light in a scene, and how far it is from the truth.

The error is measured by particles that no part of the solution comes from (radMeasureError of radiosity.h).
SPDX-License-Identifier: MIT
"""
import numbers
import os

import numpy as np

from ._device import InvalidInput, as_namespace, choose
from ._engine import ffi, lib

BASES = {"linear": lib.RAD_BASIS_LINEAR, "constant": lib.RAD_BASIS_CONSTANT}
CLOSURES = {"none": lib.RAD_CLOSURE_NONE, "rows": lib.RAD_CLOSURE_ROWS}


class Solution:
    """Area means over each face, (n,), or (n, 3) where reflectances or exitances have colours.

    radiosity, irradiance: B and H, W/m2. report: counts and powers (struct RadReport of radiosity.h).
    error, deviation: B less the truth, as measured, and the standard error of that, W/m2. measured: the error of the
    whole as shares of the reflected light (struct RadErrorReport): .l1_faces and .power have .value and .low and
    .high, a 95 % interval; where .unseen (W) is above 0 no particle was reflected: no more light than that is, and
    .high is inf. All three are None until the error is measured. links: how many were made, where that was chosen
    (struct RadChoice of radiosity.h): .no_links is 1 where there are none, .scale the thresholds' scale.
    """

    def __init__(self, device, handle, count):
        self._device, self._handle, self._count = device, handle, count
        report = ffi.new("struct RadReport *")
        lib.radGetReport(handle, report)
        self.report = as_namespace(report[0])
        self.radiosity, self.irradiance = self._values(lib.radGetPolygonValues)
        self.error = self.deviation = self.measured = self.links = None

    def measure_error(self, rays=0, stream=0, *, surfaces=False, progress=None):
        """Measure the error; returns `measured`.

        rays: how many to cast, about; 0: as the engine thinks fit. stream: which random numbers; measurements of
        different ones are independent. surfaces: errors over the surfaces, .l2 and .p999, too.
        """
        options = ffi.new("struct RadMeasureOptions *")
        for name, count, bits in (("rays", rays, 64), ("stream", stream, 31)):
            if not isinstance(count, numbers.Integral) or not 0 <= count < 2**bits:
                raise InvalidInput(f"{name} is {count!r}; it must be a whole number, 0 or more, below 2^{bits}")
        options.rays, options.stream, options.surfaces = int(rays), int(stream), int(surfaces)
        report = ffi.new("struct RadErrorReport *")
        self._device.call(lib.radMeasureError, self._handle, options, report, progress=progress)
        self.measured = as_namespace(report[0])
        if not surfaces:
            del self.measured.l2, self.measured.p999
        self.error, self.deviation = self._values(lib.radGetPolygonErrors)
        return self.measured

    def _values(self, function):
        """The two arrays that a function writes for each band."""
        bands = self.report.bands
        both = np.zeros((2, bands, self._count))
        for band in range(bands):
            self._device.call(function, self._handle, band, *(ffi.from_buffer("double[]", one[band]) for one in both))
        return (both[:, 0] if bands == 1 else both.transpose(0, 2, 1)).copy()


def oracles():
    """The names of the built-in oracles."""
    names, i = lib.radGetOracleNames(), 0
    while names[i] != ffi.NULL:
        i += 1
    return [ffi.string(names[k]).decode() for k in range(i)]


def _open_oracle(device, oracle, parameters):
    name = ffi.string(lib.radGetDefaultOracle()) if oracle is None else os.fsencode(oracle)
    if b"\0" in name:
        raise InvalidInput(f"the oracle's name {oracle!r} has a NUL in it")
    if name.endswith(b".dag"):
        handle = device.call(lib.radLoadOracle, device.handle, name, ffi.NULL, lib.RAD_RELEASE_DAG,
                             release=lib.radReleaseOracle)
    elif os.fsdecode(name) not in oracles():
        raise InvalidInput(f"there is no built-in oracle {os.fsdecode(name)!r}; give the name of a .dag file, or one "
                           "of " + ", ".join(oracles()))
    else:
        handle = device.call(lib.radNewOracle, device.handle, name, lib.RAD_RELEASE_FLAT,
                             release=lib.radReleaseOracle)
    for parameter, value in (parameters or {}).items():
        if not isinstance(parameter, str) or not isinstance(value, numbers.Real):
            raise InvalidInput(f"parameters has {value!r} for {parameter!r}; it must be a number for a name")
        device.call(lib.radSetOracleParameter, handle, parameter.encode(), value)
    return handle


def compute_solution(scene, oracle, parameters, basis, closure, tolerance, correct, measure, progress):
    device = scene._device
    options = ffi.new("struct RadSolveOptions *")
    options.tolerance = tolerance
    options.basis = choose("basis", basis, BASES)
    options.closure = choose("closure", closure, CLOSURES)
    if parameters is not None and not hasattr(parameters, "items"):
        raise InvalidInput("parameters must be a dict, a value for each name")
    asked = _open_oracle(device, oracle, parameters)
    choice = None
    if correct and oracle is None and not parameters:
        choice = ffi.new("struct RadChoice *")
        handle = device.call(lib.radSolveScene, scene._handle, asked, options, ffi.NULL, choice, progress=progress,
                             release=lib.radReleaseSolution)
    else:
        handle = device.call(lib.radNewSolution, scene._handle, asked, options, release=lib.radReleaseSolution)
        device.call(lib.radSolve, handle, progress=progress)
    if correct:
        device.call(lib.radCorrect, handle, ffi.NULL, ffi.NULL, progress=progress)
    solution = Solution(device, handle, len(scene))
    solution.links = None if choice is None else as_namespace(choice[0])
    if measure:
        solution.measure_error(progress=progress)
    return solution
