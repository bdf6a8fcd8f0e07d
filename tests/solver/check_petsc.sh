#!/usr/bin/env bash
# check_petsc.sh - --solver petsc: the answer of Gauss-Seidel's sweeps to the tolerance, the exact one where it is known; on any
# number of ranks, by GMRES and by Bi-CGStab, the same links, particles and radiosities to the bit; by other methods to the
# tolerance; what PETSc's options cannot mean ends with a message. Needs a command built by `make PETSC=1`; without it, that the
# solver is refused is all that is checked. THOROUGH: more scenes and more ranks.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/support/mpi.sh
. "$top/tests/support/mpi.sh"
unset PETSC_OPTIONS
cube=$scenes/furnace.obj cornell=$scenes/cornell.obj

"$radiosity" solve "$cube" --solver petsc -q --json one.json >said 2>&1
status=$?
if grep -q 'built without PETSc' said; then
    check "without PETSc: status $status" [ "$status" = 2 ]
    check "without PETSc something is written" [ ! -e one.json ]
    echo "skipped: the command was built without PETSc (make PETSC=1 builds it)"
    finish petsc
    exit
fi

near() { within "$1" "$2" 2e-8; }
solve() { # NAME SCENE ARGUMENTS...: NAME.json and NAME.csv
    local name=$1
    shift
    "$radiosity" solve "$@" -q --basis constant --json "$name.json" --faces "$name.csv" >said 2>&1
}
method() { sed -n 's/^    "method": "\(.*\)",/\1/p' "$1"; }

# ---- the same answer as by sweeps, to the tolerance
agree() { # SCENE ARGUMENTS...
    local scene=$1
    shift
    solve sweeps "$scene" --tolerance 1e-8 --no-correct --no-errors "$@"
    solve petsc "$scene" --tolerance 1e-8 --iterations 3000 --no-correct --no-errors --solver petsc "$@"
    check "$(basename "$scene") $*: status $?, $(head -n 3 said)" [ -s petsc.csv ]
    check "$(basename "$scene") $*: solved by $(method petsc.json)" [ "$(method petsc.json)" = petsc ]
    check "$(basename "$scene") $*: $(value petsc.json converged)" [ "$(value petsc.json converged)" = true ]
    check "$(basename "$scene") $*: other links" alike "$(value petsc.json link_fingerprint)" "$(value sweeps.json link_fingerprint)"
    # The tolerance is of the mean: a face may be off by more of its own light.
    check "$(basename "$scene") $*: other light than by sweeps" same_faces sweeps.csv petsc.csv 2e-7
    check "$(basename "$scene") $*: other power than by sweeps" near "$(value sweeps.json power_absorbed)" "$(value petsc.json power_absorbed)"
    rm -f sweeps.* petsc.*
}
agree "$cornell"
agree "$scenes/room.obj"
agree "$scenes/td.obj"
agree "$cornell" --oracle clusters
agree "$cornell" --projection collocation
agree "$scenes/room.obj" --closure rows
[ -z "${THOROUGH:-}" ] || { agree "$scenes/maze_16.obj"; agree "$scenes/sejour.obj"; }

# ---- a closed form: in a furnace B = E / (1 - rho) everywhere; rows that sum to 1 leave nothing but the solver's error
sed 's/^Kd .*/Kd .96 .96 .96/' "${cube%.obj}.mtl" >white.mtl
sed 's/^mtllib .*/mtllib white.mtl/' "$cube" >white.obj
for scene in "$cube:2" white.obj:25; do
    solve petsc "${scene%:*}" --closure rows --tolerance 1e-10 --no-correct --no-errors --solver petsc
    check "${scene%:*}: B is not ${scene#*:}" awk -F, -v b="${scene#*:}" \
        'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^B/) at[i] } NR > 1 { n++; for (i in at) { d = $i - b; if (d < 0) d = -d; if (d > 1e-9 * b) exit bad = 1 } } END { exit bad || n != 6 }' petsc.csv
done
# Where light is reflected many times, a Krylov method takes fewer sweeps by far: one wall of a whiter cube shines. 31: a third of
# what Gauss-Seidel took before its guesses were good.
sed 's/^Kd .*/Kd .99 .99 .99/; s/^newmtl .*/newmtl lamp_1s/' white.mtl >lamp.mtl
{ cat lamp.mtl; sed 's/^newmtl .*/newmtl wall_1s/; s/^Ke .*/Ke 0 0 0/' lamp.mtl; } >lit.mtl
awk '/^mtllib/ { $0 = "mtllib lit.mtl" } /^usemtl/ { $0 = "usemtl lamp_1s" } { print } /^f / && !n++ { print "usemtl wall_1s" }' white.obj >lit.obj
solve sweeps lit.obj --tolerance 1e-8 --no-correct --no-errors
solve petsc lit.obj --tolerance 1e-8 --no-correct --no-errors --solver petsc
check "white: $(value petsc.json iterations) sweeps, Gauss-Seidel $(value sweeps.json iterations)" \
    [ "$(value petsc.json iterations)" -lt 31 -a "$(value petsc.json iterations)" -lt "$(value sweeps.json iterations)" ]
check "white: other light" same_faces sweeps.csv petsc.csv 2e-7

# ---- what PETSc's options say
scene=$cornell
by() { # OPTIONS ARGUMENTS...
    PETSC_OPTIONS=$1 "$radiosity" solve "$scene" --solver petsc -q --no-correct --no-errors "${@:2}" >said 2>&1
}
by "-ksp_monitor"
check "PETSC_OPTIONS are not read: $(head -n 3 said)" grep -q 'KSP Residual norm' said
# After a solution that is exact enough one sweep says so; where groups are linked there are rough solves besides, of sweeps alone.
after() { # SWEEPS ARGUMENTS...
    by "-ksp_monitor -ksp_convergence_test default -ksp_rtol 1e-10" --json petsc.json --tolerance 1e-6 --basis constant "${@:2}"
    local steps=$(($(grep -c 'KSP Residual norm' said) - $(grep -c '^ *0 KSP Residual norm' said)))
    check "${*:2}: $(value petsc.json iterations) sweeps, of which $steps of PETSc's" \
        [ "$(($(value petsc.json iterations) - steps))" -le "$1" -a "$steps" -gt 0 ]
}
after 4 --oracle bf_guarded
after 4 --oracle bf_guarded --projection collocation
after 4 --oracle bf_guarded --closure rows
scene=$scenes/room.obj
after 16
after 12 --oracle clusters --closure rows
scene=$cornell
refused() { # OPTIONS TEXT
    by "$1" --json refused.json
    local status=$?
    check "$1: status $status" [ "$status" = 1 ]
    check "$1: $(head -n 3 said)" [ "$(grep -c 'error' said)" = 1 -a "$(grep -c "error: PETSc cannot solve: $2.*$1" said)" = 1 ]
    check "$1: a report" [ ! -e refused.json ]
}
refused "-ksp_type nonsense" "Unable to find requested KSP type"
refused "-ksp_rtol x" "Input string x has no numeric value"
refused "-pc_type ilu" "Could not locate a solver type"
solve sweeps "$cornell" --tolerance 1e-8 --no-correct --no-errors
for how in "-ksp_type bcgs" "-ksp_type richardson" "-ksp_type tfqmr" "-ksp_type pipecg" "-ksp_type gmres -ksp_gmres_restart 3"; do
    # The last two would do badly: sweeps do what is left.
    by "$how" --tolerance 1e-8 --basis constant --json petsc.json --faces petsc.csv
    check "$how: status $?, $(head -n 3 said)" [ "$(value petsc.json converged)" = true ]
    check "$how: other light" same_faces sweeps.csv petsc.csv 2e-7
    check "$how: $(value petsc.json iterations) sweeps" [ "$(value petsc.json iterations)" -lt 1000 ]
    rm -f petsc.*
done
by "" --iterations 2 --tolerance 1e-8
check "2 sweeps do, status $?" [ $? = 3 ]

# ---- any number of ranks
if ! command -v mpirun >/dev/null; then
    echo "skipped: no mpirun"
    finish petsc
    exit
fi
ranks() { # SCENE RANKS ARGUMENTS...: in one process and in several
    local scene=$1 n name
    name=$(basename "$scene" .obj)
    solve one "$scene" --threads 2 --solver petsc "${@:3}"
    check "$name ${*:3} alone: $(head -n 3 said)" [ -s one.csv ]
    for n in $2; do
        timeout 300 mpirun -n "$n" "$radiosity" solve "$scene" -q --threads $((n % 2 + 1)) --basis constant --solver petsc \
            --json several.json --faces several.csv "${@:3}" >said 2>&1
        check "$name ${*:3} on $n ranks: exit status $?: $(head -n 3 said)" [ -s several.json ]
        for key in link_fingerprint particle_fingerprint links iterations; do
            check "$name ${*:3} on $n ranks: $key $(value several.json $key), alone $(value one.json $key)" \
                alike "$(value several.json $key)" "$(value one.json $key)"
        done
        # Mending adds up what ranks have of their own: last bits are others.
        check "$name ${*:3} on $n ranks: power_absorbed $(value several.json power_absorbed), alone $(value one.json power_absorbed)" \
            awk -v a="$(value several.json power_absorbed)" -v b="$(value one.json power_absorbed)" 'BEGIN { d = a - b; exit !(d * d <= 1e-24 * a * a) }'
        check "$name ${*:3} on $n ranks: other light on faces" same_faces one.csv several.csv
        rm -f several.*
    done
}
ranks "$cornell" "1 2 3 4" --tolerance 1e-8
ranks "$scenes/td.obj" "2 3"
# What it found, before a sweep or mending takes last bits away: each number, in whatever order.
for n in 1 2 3; do
    rm -f found
    PETSC_OPTIONS="-ksp_view_solution binary:found" timeout 300 mpirun -n $n "$radiosity" solve "$scenes/td.obj" -q --threads 1 \
        --basis constant --solver petsc --no-correct --no-errors >said 2>&1
    od -An -v -t x8 -j 8 -w8 found | sort >"found$n"
    check "td on $n ranks: other bits" cmp found1 "found$n"
done
check "td: nothing was found" [ "$(wc -l <found1)" -gt 10000 ]
ranks "$scenes/room.obj" "4" --oracle clusters --tolerance 1e-8
export PETSC_OPTIONS="-ksp_type bcgs"
ranks "$cornell" "3"
[ -z "${THOROUGH:-}" ] || { ranks "$scenes/td.obj" "2 4 7" --tolerance 1e-8; ranks "$scenes/sejour.obj" "2 3"; }
export PETSC_OPTIONS="-ksp_type nonsense"
timeout 300 mpirun -n 3 "$radiosity" solve "$cornell" -q --solver petsc --json several.json >said 2>&1
check "nonsense on 3 ranks: status $?" [ $? = 1 ]
check "nonsense on 3 ranks: $(head -n 3 said)" [ "$(grep -c 'error: PETSc cannot solve' said)" = 1 -a ! -e several.json ]
finish petsc
