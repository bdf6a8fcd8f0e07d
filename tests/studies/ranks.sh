#!/usr/bin/env bash
# ranks.sh - what several processes have and tell each other: room_of_boxes.awk from 10,000 faces to LARGEST (100000), as
# `radiosity solve --scale 16` does it, on 1, 2, 4, 8 and 16 ranks of one machine. Time says little where ranks share a
# processor, so work, traffic and memory are counted. From these: a model of more faces on more machines (LogP: Culler et al.
# 1993), with what it assumes. LIMIT: seconds for one run (3600). Needs a command made by `make MPI=1`.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-3600}
. "$(dirname "$0")/../support/mpi.sh"
command -v mpirun >/dev/null || fail "mpirun is missing: apt-get install openmpi-bin"
! mpirun -n 2 "$radiosity" --version 2>&1 | grep -q 'built without MPI' || fail "$radiosity was built without MPI: make MPI=1"
rows_open ranks scene,ranks,binary faces,elements,links,pairs,rays,sweeps,passes,links_most,links_mean,pairs_most,ghosts_most,elements_most,memory_mb,splits,link_bytes,sweep_bytes,values,particles,fingerprint

solve() { # FACES RANKS
    [ -s "$tmp/$1.obj" ] || awk -v FACES="$1" -v MATERIALS="$tmp/$1.mtl" -f "$studies/room_of_boxes.awk" >"$tmp/$1.obj"
    timeout "$LIMIT" mpirun -n "$2" "$radiosity" solve "$tmp/$1.obj" --scale 16 -q --threads 1 --json "$tmp/json" >"$tmp/said" 2>&1 || return
    awk -f "$tables/json.awk" "$tmp/json" | awk -v ranks="$2" '
        function most(name) { return v["ranks.." name] + 0 }
        /^ranks\./ { if ($2 + 0 > v[$1] + 0) v[$1] = $2; all_of[$1] += $2; next }
        { v[$1] = $2 }
        END {
            split("faces elements links pairs rays", all, " ")
            for (i = 1; i in all; i++) print all[i], v[all[i]]
            print "sweeps", v["iterations"]; print "passes", v["passes"]
            print "links_most", (ranks > 1 ? most("links") : v["links"])
            print "links_mean", (ranks > 1 ? all_of["ranks..links"] / ranks : v["links"]); print "pairs_most", (ranks > 1 ? most("pairs") : v["pairs"])
            print "ghosts_most", most("ghosts"); print "elements_most", (ranks > 1 ? most("elements") : v["elements"])
            print "memory_mb", (ranks > 1 ? most("memory_mb") : v["peak_memory_mb"])
            print "splits", most("bytes_sent.splits"); print "link_bytes", most("bytes_sent.links"); print "sweep_bytes", most("bytes_sent.sweeps")
            print "values", most("bytes_sent.values"); print "particles", most("bytes_sent.particles")
            # of 64 bits the lower 48, which a number holds: equal, or the run is wrong
            hex = substr(v["link_fingerprint"], 5); n = 0
            for (i = 1; i <= length(hex); i++) n = 16 * n + index("0123456789abcdef", substr(hex, i, 1)) - 1
            printf "fingerprint %.0f\n", n
        }'
}
for faces in 10000 31623 100000 316228 1000000; do
    [ $faces -le "${LARGEST:-100000}" ] || continue
    for ranks in 1 2 4 8 16; do
        measure "boxes_$faces,$ranks,$binary" solve $faces $ranks
    done
    rm -f "$tmp/$faces.obj" "$tmp/$faces.mtl"
done
rows_of_binary "$pages/ranks.csv"
for faces in 10000 100000 1000000; do # what Embree itself says that it takes
    awk -v FACES=$faces -v MATERIALS="$tmp/mtl" -f "$studies/room_of_boxes.awk" | "$build/bin/embree_bytes" || fail "embree_bytes failed"
done | paste -d ' ' - - - >"$tmp/embree"

# ---- the page
{
    page_head "Ranks" "What do several processes have, and what do they tell each other? One room, half of its faces in walls and half in boxes
(\`tests/studies/room_of_boxes.awk\`), \`mpirun -n N radiosity solve --scale 16\`. The links of a scene are the same to the bit on any
number of ranks. \"Most\" is the rank that has most, over the mean of ranks; links that a cluster of several receives are held by each of them. Bytes are those that one rank, the busiest, has sent in the whole run;
\"a sweep\" is what it sends while sweeps go on, over their number."
    echo "| faces | ranks | links | most | discussions, most | MB held | elements of others, most | splits KB | links MB | a sweep KB | values MB | particles MB |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["faces"] == "-" { printf "| %s | %d | too long | | | | | | | | | |\n", substr($1, 7), $2; next }
        { n = $at["ranks"]
          if (!($1 in first)) first[$1] = $at["fingerprint"]
          if (first[$1] != $at["fingerprint"]) { print "ranks.csv: " $1 ": other links on " n " ranks" >"/dev/stderr"; exit 1 }
          printf "| %d | %d | %d | %.2f | %.2f | %.0f | %d | %.1f | %.2f | %.0f | %.1f | %.0f |\n", $at["faces"], n, $at["links"],
              $at["links_most"] / $at["links_mean"], $at["pairs_most"] * n / $at["pairs"], $at["memory_mb"], $at["ghosts_most"],
              $at["splits"] / 1e3, $at["link_bytes"] / 1e6, $at["sweep_bytes"] / $at["sweeps"] / 1e3, $at["values"] / 1e6, $at["particles"] / 1e6 }' "$pages/ranks.csv"
    cat <<'END'

What follows.

- **Links and discussions** are shared out. The first pass goes by numbers of faces, later ones by links.
- **Memory falls** as far as it is quarters that particles are counted on, and what is counted: a rank has quarters of its own faces
  (264 bytes each, and the numbers that go with them), counts of its own faces and of these, and what it takes to mend them; of others'
  quarters it has what their numbers are. What does not fall: elements that links know of, and Embree's structure over all
  faces. Embree keeps pointers in its structure, so processes cannot share it: give a machine one rank, with threads. A mesh of the solution, a picture, particles that are split for dim polygons and errors of surfaces need all
  quarters: then all ranks get them. Of a gridroom of 150,196 faces one process takes 1110 MB and
  each of 4 ranks 420 to 429, in a run apart from this table.
- **A sweep tells of nearly every face**, not of the surface between parts: groups are linked far and wide, and each link weighs the faces
  of a group by where they stand to it, so that a sum serves no other. What groups alone take is told once a sweep, in single precision.
  Its bytes grow with the faces, and with the ranks that each is told to.
- **Particles** cost most: what lands on others' faces is told to them, 4 bytes and 4 a band for each landing. That grows with the
  particles and not with the faces: of 150,196 faces a rank of 4 tells 245 MB, where sums of all counts took 633; of 14,936, which get
  as many particles, it is 223, where sums took 102.

## More faces, more machines

LogP: a message takes latency + 2 overheads (3 us together), a byte 1 / (12.5 GB/s), as a 100 Gb/s network is sold. Assumed: one rank a
machine; per face as many elements of all and of one rank, links, passes, sweeps and bytes as in the last row of one rank and of two above; counts of particles and values of
elements in a ring (each rank sends and receives all once), a sweep in 16 exchanges with every other rank. What fits does so with 295
bytes a face of geometry besides.
END
    echo
    echo "| faces | machines | GB of elements and counts a machine | a sweep: s to send | its messages: s | values and counts: s | fits in 256 GB |"
    echo "|---|---|---|---|---|---|---|"
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        # held by 2 ranks and by 4: what all have, and what they have parts of
        $at["faces"] != "-" && $at["ranks"] == 4 { own = 4 * (two - $at["elements_most"] / $at["faces"]); all = two - own / 2 }
        $at["faces"] != "-" && $at["ranks"] == 2 { two = $at["elements_most"] / $at["faces"]; sweep = $at["sweep_bytes"] / $at["sweeps"] / $at["faces"] * 2; particles = $at["particles"] / $at["faces"]; values = $at["values"] / $at["faces"] * 2 }
        END { for (f = 1e8; f <= 1e9; f *= 10) for (n = 64; n <= 1024; n *= 16) {
            held = f * ((all + own / n) * (264 + 3 * 8 * 2) + (all + own) * 4 + (all + own / n) * 3 * 8 + 16 * 3 * 8 / n) / 1e9
            printf "| %.0e | %d | %.0f | %.1f | %.3f | %.1f | %s |\n", f, n, held, sweep * f * (n - 1) / n / 12.5e9, 16 * (n - 1) * 3e-6, (2 * particles + values) * f / 12.5e9, held + f * 295 / 1e9 < 256 ? "yes" : "no" } }' "$pages/ranks.csv"
    cat <<'END'

## Where one machine does not hold it

Geometry and Embree's structure stand once a machine when there is one rank on each, with threads for its processors. What a face takes:

END
    echo "| of a face | bytes | who has it now | who has to |"
    echo "|---|---|---|---|"
    awk -F , -v element=264 -v face=112 -v link=16 'FNR == NR { split($0, e, " "); held = e[4] / e[2]; most = e[6] / e[2]; next }
        FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["faces"] != "-" && $at["ranks"] == 1 { n = $at["faces"]; elements = $at["elements"] / n; links = $at["links"] / n }
        END { printf "| corners, material | %d | all | whoever casts rays at it |\n| Embree: held, while it is built | %.0f, %.0f | all | the same |\n", face, held, most
              printf "| %.1f elements of %d bytes, most of them quarters that particles are counted on | %.0f | quarters the owner of the face, others all | of links, who names them |\n", elements, element, elements * element
              printf "| radiosity and irradiance of them, three bands | %.0f | the same | the same |\n| counts of particles, in 16 groups; of quarters 24 bytes each | %d | the owner | the owner |\n", elements * 48, 16 * 3 * 8
              printf "| %.1f links | %.0f | the owner | the owner |\n", links, links * link }' "$tmp/embree" "$pages/ranks.csv"
    echo
    echo "Embree, by its own account (\`embree_bytes\`: the monitor of its device), over the same rooms:"
    awk '{ printf "%s%d faces %.1f MB, %.1f while it is built", (NR > 1 ? "; " : ""), $2, $4 / 1e6, $6 / 1e6 } END { print "." }' "$tmp/embree"
    cat <<'END'

So the plan, in the order in which it pays:

1. **Elements by stretch**, as quarters are by now: a rank splits and keeps the faces that it owns, and of others those elements that its links name. Their path
   is their name (`element.id`), so they are made without asking.
2. **Geometry** stays whole on each machine as long as corners and Embree fit:
END
    awk '{ held = 112 + $4 / $2; most = 112 + $6 / $2 } END { printf "   %.0f bytes a face while it is built, %.0f after: 1e8 faces take %.0f GB, 1e9 %.0f GB.\n", most, held, most / 10, most }' "$tmp/embree"
    cat <<'END'
3. **Beyond that, rays go to the geometry**: each machine has Embree over its stretch, and over the boxes of the others' parts of the tree. A ray that
   meets such a box goes to its owner, many in one message, 24 bytes there and a bit back.
END
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next } $at["faces"] != "-" && $at["ranks"] == 1 { rays = $at["rays"] / $at["faces"] }
        END { printf "   %.0f rays a face of links: 1e9 faces on 1024 machines are %.0f GB a machine for each stretch that a ray passes, %.1f s at 12.5 GB/s; none is needed\n   before 2.\n", rays, rays * 24 * 1e9 / 1024 / 1e9, rays * 24 * 1e9 / 1024 / 12.5e9 }' "$pages/ranks.csv"
    cat <<'END'

What limits it is how much links name. In a room of 10036 faces in which all sees all, with fine links (`--no-correct`, 176 a face), each of 2 ranks
names 4341 and 4298 elements of others and clusters, each of 8 ranks 4128 to 4603 (`named` in `--json`): .43 of the faces, and no fewer with more
ranks. Shut rooms side by side would name less; that is not measured.

It stops where one machine no longer holds the elements that links know of. Before that, a sweep's bytes do not fall
with more machines, since each is told of nearly all faces. Elements have one cure: stretches, as links and quarters are, with those of
others only where a link needs them. Links, decisions and numbers do not stand in the way: refinement asks nobody, indices depend on
what is split alone, and random numbers on a path's index. For sweeps, links of groups would have to take few numbers of a group,
the same for all links.
END
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/ranks.md"
say "$pages/ranks.md"
