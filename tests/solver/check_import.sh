#!/bin/sh
# check_import.sh - damaged scene files on which the import library crashes, hangs or takes all memory: one line that names the
# file, exit status 1, within 10 seconds of a processor. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# FILE: what the command said of it is in FILE.err, its exit status in FILE.status.
try() {
    { timeout 60 sh -c 'ulimit -t 10; exec "$0" "$@"' "$radiosity" solve "$1" -q >"$1.out" 2>"$1.err"; echo $? >"$1.status"; }
}
# FILE TEXT...: it said one line with one of the texts.
refused() {
    count=$((count + 1))
    file=$1
    shift
    [ "$(cat "$file.status")" = 1 ] && [ "$(wc -l <"$file.err")" = 1 ] && [ ! -s "$file.out" ] || {
        failed "$file: exit $(cat "$file.status")"
        head -n 5 "$file.err"
        return
    }
    for text; do
        case $(cat "$file.err") in "$file:"*" error: "*"$text"*) return ;; esac
    done
    failed "$file: not a word of $*: $(cat "$file.err")"
}

ply_header() {
    printf 'ply\nformat %s 1.0\nelement vertex %s\nproperty float x\nproperty float y\nproperty float z\nelement face %s\nproperty list uchar int vertex_indices\nend_header\n' "$@"
}
collada() {
    printf '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="%s"><input semantic="VERTEX" source="#v" offset="0"/><p>%s</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>\n' "$@"
}
# A file of one triangle whose coordinates are in $1.
gltf() {
    printf '{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"%s"}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}' "$1"
}

# ---- two that hang, which take their time beside all others
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nprop' >cut.ply
try cut.ply &
mkfifo endless.bin
gltf endless.bin >waits.gltf
try waits.gltf &

ply_header binary_little_endian 4000000000 4000000000 >huge.ply
ply_header ascii 4000000000 1 >huge_text.ply
printf 'OFF\n4000000000 4000000000 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n' >huge.off
collada 4000000000 '0 1 2' >huge.dae
collada 1 '0 1.5 2' >fractions.dae
awk 'BEGIN { printf "{\"asset\":{\"version\":\"2.0\"},\"x\":"; for (i = 0; i < 300000; i++) printf "["; for (i = 0; i < 300000; i++) printf "]"; print "}" }' >deep.gltf
awk 'BEGIN { printf "{\"asset\":{\"version\":\"2.0\"},\"nodes\":["; for (i = 0; i < 40; i++) printf "{\"children\":[%d,%d]},", i + 1, i + 1; print "{}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}" }' >doubles.gltf
printf 'map_Kd x.png\nnewmtl a\nKd .5 .5 .5\n' >early.mtl
printf 'mtllib early.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n' >early.model # an OBJ file that Assimp knows by its text
for file in huge.ply huge_text.ply huge.off huge.dae fractions.dae deep.gltf doubles.gltf early.model; do
    try $file
done
# Of files like the first three and of OFF counts others may say more before Assimp sees them.
for file in huge.ply huge_text.ply huge.off; do refused $file "ran out of memory" "truncated" "holds" "fewer" "cut" "ends"; done
# Where a processor is slow the limit of seconds may come before the others.
late="the importer hung: stopped after "
# Sanitizers need more address space than any limit leaves: these files then end by another one.
without=${SANITIZE:+the importer }
for file in huge.dae fractions.dae doubles.gltf; do refused $file "${without:-the importer ran out of memory; the file is damaged}" "$late"; done
for file in deep.gltf early.model; do refused $file "the importer crashed: " "the importer crashed; " "$late"; done

# ---- what is no file, and what is too large
mkfifo pipe.obj pipe.ply pipe.mtl
printf 'mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >library.obj
truncate -s 5G sparse.obj
for file in pipe.obj pipe.ply library.obj sparse.obj; do try $file; done
for file in pipe.obj pipe.ply; do refused $file "cannot read: this is a pipe or a device"; done
printf '%s\n' "$(cat library.obj.err)" >library.obj.err
sed -i 's/^library.obj:1: /library.obj: /' library.obj.err
refused library.obj "pipe.mtl"
refused sparse.obj "too large"

# ---- whole files are read as ever
collada 1 '0 1 2' >good.dae
count=$((count + 1))
"$radiosity" solve good.dae -q --faces faces.csv 2>err && [ ! -s err ] && [ "$(wc -l <faces.csv)" = 2 ] || failed good.dae

# ---- nobody outlives a command that is ended
sh -c 'echo $$ >pid; exec "$0" solve waits.gltf -q' "$radiosity" 2>err &
job=$!
for i in $(seq 300); do
    child=$(ps -o pid= --ppid "$(cat pid 2>/dev/null || echo 0)" 2>/dev/null | tr -d ' ')
    [ -n "$child" ] && break
    sleep 0.1
done
count=$((count + 1))
kill -TERM "$job" 2>/dev/null
wait "$job" 2>/dev/null
for i in $(seq 100); do
    case $(ps -o stat= -p "${child:-0}") in '' | Z*) break ;; esac
    sleep 0.1
done
case $(ps -o stat= -p "${child:-0}") in '' | Z*) ;; *) failed "the importer outlives the command" ;; esac

wait
refused cut.ply "the importer hung: stopped after " "header" "end_header"
refused waits.gltf "the importer hung: it waited"

finish import
