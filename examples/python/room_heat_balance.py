"""room_heat_balance.py - the radiative heat balance of a room: Scene, view factors, T^4, a table.

A room of 4 x 5 x 2.5 m with a warm floor, a cold window and a cabinet that stands between the two. Floor and window
have known temperatures; all other surfaces are insulated and find theirs: what they give off as radiation they take
from the air of the room. The air finds its own, too: some of it is exchanged for air from outside. Cells (# %%) run one by one in Spyder, VS Code or Jupyter (jupytext), or all at once:

    python3 examples/python/room_heat_balance.py

SPDX-License-Identifier: MIT
"""
# %% The room: patches of half a metre, counter-clockwise as seen from inside
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import radiosity

STEP = 0.5
vertices, faces, names = [], [], []


def add(name, corner, along, up, without=None):
    """Patches of a rectangle whose front is where along x up points; but for those whose middle is in `without`."""
    corner, along, up = np.array(corner, float), np.array(along, float), np.array(up, float)
    m, n = round(np.linalg.norm(along) / STEP), round(np.linalg.norm(up) / STEP)
    for i in range(m):
        for j in range(n):
            four = [corner + (i + a) / m * along + (j + b) / n * up for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if without and without(np.mean(four, axis=0)):
                continue
            faces.append(np.arange(4) + len(vertices))
            vertices.extend(four)
            names.append(name)


def under_cabinet(p):
    return 1 < p[0] < 2 and 1 < p[1] < 3


def in_window(p):
    return 1 < p[0] < 3 and 1 < p[2] < 2


add("floor", (0, 0, 0), (4, 0, 0), (0, 5, 0), under_cabinet)
add("ceiling", (0, 0, 2.5), (0, 5, 0), (4, 0, 0))
add("outer wall", (0, 0, 0), (0, 0, 2.5), (4, 0, 0), in_window)
add("window", (1, 0, 1), (0, 0, 1), (2, 0, 0))
add("walls", (0, 5, 0), (4, 0, 0), (0, 0, 2.5))
add("walls", (0, 0, 0), (0, 5, 0), (0, 0, 2.5))
add("walls", (4, 0, 0), (0, 0, 2.5), (0, 5, 0))
add("cabinet", (1, 1, 0), (1, 0, 0), (0, 0, 2))  # its sides face the room
add("cabinet", (2, 3, 0), (-1, 0, 0), (0, 0, 2))
add("cabinet", (1, 3, 0), (0, -2, 0), (0, 0, 2))
add("cabinet", (2, 1, 0), (0, 2, 0), (0, 0, 2))
add("cabinet", (1, 1, 2), (1, 0, 0), (0, 2, 0))
names = np.array(names)

scene = radiosity.Scene.from_arrays(np.array(vertices), np.array(faces), groups=names)
print(f"{len(scene)} patches, {scene.areas.sum():.2f} m2")

# %% View factors, closed: rows sum to 1 and A_i F_ij = A_j F_ji, so that no heat is lost on the way
factors = scene.view_factors(closure="reciprocal")
F, A = factors.matrix, factors.areas
print(f"rows summed to {factors.report.low:.6f} .. {factors.report.high:.6f}, "
      f"now to {factors.row_sums.min():.6f} .. {factors.row_sums.max():.6f}; {F.nnz} entries\n")

groups = factors.by()
print("from \\ to  " + "".join(f"{name:>12}" for name in groups.names))
for name, row in zip(groups.names, groups.matrix.toarray()):
    print(f"{name:11}" + "".join(f"{value:12.4f}" for value in row))

# %% Heat: q = sigma R T^4 is what each patch gives off by radiation, W/m2; h (T_air - T) is what the air gives it
SIGMA, H = 5.670374419e-8, 3.0  # W/(m2 K4), W/(m2 K)
OUTSIDE, EXCHANGE = 273.15, 0.5 * 46 * 1.2 * 1005 / 3600  # K, W/K: half of 46 m3 of air an hour
emissivity = np.select([names == "window", names == "cabinet"], [0.84, 0.80], 0.92)
known = np.select([names == "floor", names == "window"], [27.0 + 273.15, 6.0 + 273.15], np.nan)
free = np.isnan(known)

# J = eps sigma T^4 + (1 - eps) F J is the radiosity; q = J - F J.
one = sparse.identity(len(A), format="csc")
system = scipy.sparse.linalg.splu((one - sparse.diags(1 - emissivity) @ F).tocsc())
R = (one - F) @ system.solve(np.diag(emissivity))

# Newton on T of the free patches and of the air.
T, air = np.where(free, 293.15, known), 293.15
for iteration in range(1, 21):
    missing = np.append((H * (air - T) - SIGMA * R @ T**4)[free],
                        (A * H * (T - air)).sum() + EXCHANGE * (OUTSIDE - air))
    if np.abs(missing).max() < 1e-8:
        break
    slope = np.block([[SIGMA * R[np.ix_(free, free)] * (4 * T[free] ** 3) + H * np.eye(free.sum()),
                       -H * np.ones((free.sum(), 1))],
                      [-H * A[None, free], np.array([[H * A.sum() + EXCHANGE]])]])
    step = np.linalg.solve(slope, missing)
    T[free] += step[:-1]
    air += step[-1]
print(f"\nheat balance: {iteration} steps of Newton, {np.abs(missing).max():.0e} W left; "
      f"the air has {air - 273.15:.2f} deg C")

# %% The table: heat that comes into the room from behind each surface, and how it goes on
radiates, warms = A * SIGMA * (R @ T**4), A * H * (T - air)
print(f"\n{'surface':11}{'area':>9}{'T mean':>9}{'T least':>9}{'T most':>9}{'radiates':>11}{'warms air':>11}{'brings':>11}")
print(f"{'':11}{'m2':>9}{3 * 'deg C'.rjust(9)}{3 * 'W'.rjust(11)}")
for name in groups.names:
    here = names == name
    mean = (A * T)[here].sum() / A[here].sum()
    by = radiates[here].sum(), warms[here].sum()
    print(f"{name:11}{A[here].sum():9.2f}{mean - 273.15:9.2f}{T[here].min() - 273.15:9.2f}{T[here].max() - 273.15:9.2f}"
          f"{by[0]:11.2f}{by[1]:11.2f}{round(sum(by), 2) + 0.0:11.2f}")
fresh = EXCHANGE * (OUTSIDE - air)
print(f"{'fresh air':11}{'':36}{'':11}{fresh:11.2f}{fresh:11.2f}")
total = radiates.sum(), warms.sum() + fresh
print(f"{'all':11}{A.sum():9.2f}{'':27}" + "".join(f"{round(w, 2) + 0.0:11.2f}" for w in (*total, sum(total))))
