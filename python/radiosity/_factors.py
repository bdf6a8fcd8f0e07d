"""View factors of a scene as a sparse matrix.

The engine writes a row at a time, with a place for each face; rows are filled by several threads, each of which
keeps what is not zero. So memory is that of the entries, not that of n^2.
SPDX-License-Identifier: MIT
"""
import contextlib
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import scipy.sparse

from ._device import InvalidInput, RadiosityError, as_namespace, choose
from ._engine import ffi, lib
from ._state import State

CLOSURES = {"none": lib.RAD_CLOSURE_NONE, "rows": lib.RAD_CLOSURE_ROWS, "reciprocal": lib.RAD_CLOSURE_RECIPROCAL}
ROWS = 64  # that a thread fills at a time


class ViewFactors:
    """F_ij: the share of what leaves face i evenly that meets face j.

    matrix: scipy.sparse, compressed by rows. row_sums: of its rows; what lacks of 1 meets no face, or a black back.
    areas: m2, of both sides of a face that has two, as both send: areas times F is the same both ways.
    names: of rows, where they are groups; else None.
    report: what the computation found (struct RadExchangeReport of radiosity.h), before any closure.
    """

    def __init__(self, matrix, row_sums, areas, report, names=None, groups=None):
        self.matrix, self.row_sums, self.areas, self.report = matrix, row_sums, areas, report
        self.names, self._groups = names, groups

    def __len__(self):
        return len(self.areas)

    def by(self, groups=None):
        """The factors between groups of faces: a label for each face; None: those of the scene.

        Of groups that each leave light evenly: F_IJ is the mean over I, by area, of the sums over J. Rows are in the
        order of the labels, which are `names`.
        """
        groups = self._groups if groups is None else np.asarray(groups)
        if groups is None or groups.shape != (len(self),):
            raise InvalidInput(f"groups must be a label for each of the {len(self)} faces")
        try:
            names, number = np.unique(groups, return_inverse=True)
        except TypeError:
            raise InvalidInput("groups has labels of several kinds, which have no order; give numbers alone, or "
                               "text alone") from None
        member = scipy.sparse.csr_matrix((np.ones(len(self)), (number, np.arange(len(self)))))
        areas = member @ self.areas
        share = np.divide(1.0, areas, out=np.zeros_like(areas), where=areas > 0)
        weights = scipy.sparse.diags(share) @ member @ scipy.sparse.diags(self.areas)
        matrix = (weights @ self.matrix @ member.T).tocsr()
        return ViewFactors(matrix, weights @ self.row_sums, areas, self.report, names)


def compute_factors(scene, tolerance, closure, progress, resume):
    options = ffi.new("struct RadExchangeOptions *")
    options.tolerance = tolerance
    options.closure = choose("closure", closure, CLOSURES)
    with State(resume) if resume is not None else contextlib.nullcontext() as state:
        options.state = state.host if state else ffi.NULL
        exchange = scene._device.call(lib.radNewExchange, scene._handle, ffi.NULL, options, progress=progress,
                                      release=lib.radReleaseExchange, resume=state)
    count = len(scene)

    def fill(first):
        row = np.empty(count)
        into = ffi.from_buffer("double[]", row)
        columns, values, lengths, sums = [], [], [], []
        for i in range(first, min(first + ROWS, count)):
            total = lib.radGetExchangeRow(exchange, i, into)
            if total < 0:
                raise RadiosityError(f"row {i} of the view factors cannot be computed")
            there = np.flatnonzero(row)
            columns.append(there.astype(np.int32))
            values.append(row[there])
            lengths.append(len(there))
            sums.append(total)
        return np.concatenate(columns), np.concatenate(values), lengths, sums

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        parts = list(pool.map(fill, range(0, count, ROWS)))
    columns, values, lengths, sums = map(list, zip(*parts))
    del parts
    data = np.concatenate(values)
    del values  # of large matrices there are never two
    indices = np.concatenate(columns)
    del columns
    ends = np.concatenate([[0], np.cumsum(np.concatenate(lengths))])
    matrix = scipy.sparse.csr_matrix((data, indices, ends), shape=(count, count))
    report = ffi.new("struct RadExchangeReport *")
    lib.radGetExchangeReport(exchange, report)
    if state:
        state.remove()
    return ViewFactors(matrix, np.concatenate(sums), scene.areas * scene._sides, as_namespace(report[0]),
                       groups=scene.groups)
