#!/bin/sh
# check_options.sh - what radiosity says to options that are empty, huge or malformed, and to outputs that cannot be written:
# one line, at once, and nothing is left behind. RADIOSITY names the command.
# Once is enough: it is about words, and what is read is read by other suites, too.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# STATUS TEXT ARGUMENT...: ends with this status, and says one line with this text and no word about anything empty.
says() {
    wanted=$1 text=$2
    shift 2
    count=$((count + 1))
    "$radiosity" "$@" >out 2>err
    status=$?
    if [ $status != "$wanted" ] || [ "$(wc -l <err)" != 1 ] || ! grep -qF -- "$text" err || grep -qE "not;|''|^:" err || [ -s out ]; then
        failed "radiosity $*: exit $status, not $wanted with: $text"
        head -n 3 out
    fi
    rm -f out err
    if [ -n "$(ls -A)" ]; then
        failed "radiosity $* left $(ls -A)"
        rm -rf ./*
    fi
}

# ---- no value, or one that is none: wrong usage, exit 2
scene=$scenes/furnace.obj
for option in --oracle --release --set --params --tolerance --iterations --solver --projection --closure --statistics --threads -o --image --image-error --size --view --faces --json; do
    says 2 "$option takes" solve "$scene" "$option" ""
done
for option in --only -o --threads; do says 2 "$option takes" study stability "$option" ""; done
for option in --samples --csv --chart; do says 2 "$option takes" study arvo "$option" ""; done
for value in 63 4097 1.5 x; do says 2 "--samples takes a whole number from 64 to 4096" study arvo --samples $value; done
for option in --thresholds --rays --chart -o; do says 2 "$option takes" study visibility "$scene" "$option" ""; done
says 2 "--repeats takes" compare "$scene" --repeats ""
says 2 "--oracle takes" solve "$scene" --oracle=
says 2 "no command" ""
says 2 "scene's name" solve ""
says 2 "study what?" study ""
says 2 "a table's name is empty" error ""
says 2 "the table's name is missing: -o FILE.csv" reference "$scene"
says 2 "-o takes a file named .csv, not x" reference "$scene" -o x
for option in -o --accuracy --json; do says 2 "$option takes" reference "$scene" "$option" ""; done
for value in 0 0% 1 100% -1% nan inf 1%% x %; do says 2 "--accuracy takes a share" reference "$scene" -o x.csv --accuracy $value; done
says 2 "this is the scene, which would be lost" reference "$scene" -o x.csv --json "$scene"
says 2 "two tables are needed" error a.csv
says 2 "two tables are needed" error
says 2 "more than two tables: c.csv" error a.csv b.csv c.csv
for option in --worst --json; do says 2 "$option takes" error a.csv b.csv "$option" ""; done
for value in -1 100001 1.5 x; do says 2 "--worst takes a whole number" error a.csv b.csv --worst $value; done
says 2 "a value is missing after --image" solve "$scene" --image
for value in 0 1 -1 nan inf 1e-400 x 1e-3x; do says 2 "--tolerance takes a number above 0 and below 1" solve "$scene" --tolerance $value; done
for value in 0 -3 1.5 99999999999 x; do
    says 2 "--iterations takes" solve "$scene" --iterations $value
    says 2 "--threads takes" solve "$scene" --threads $value
    says 2 "--repeats takes" compare "$scene" --repeats $value
done
for value in x 1x x1 0x1 1x0 20000x1 99999999999999999999x2 1x2x3 1 4294967297x1; do says 2 "--size takes WxH" solve "$scene" --size $value; done
for value in x -1 1.5 1000001 16x; do says 2 "--gather takes a whole number from 0 to 1000000, not $value" solve "$scene" --image x.png --gather $value; done
for value in 1 0,0,0 0,0,0:0,0,0 0,0,0:1,1,1: 0,0,0:1,1,1:200 inf,0,0:1,1,1 1e308,0,0:-1e308,0,0 nan,0,0:1,1,1; do
    says 2 "--view takes" solve "$scene" --view $value
done
for value in 1e308 inf nan 0 -1 5,5 5,3 5, ,5 x 1,,2; do says 2 "--thresholds takes rising numbers from 1e-300 to 1e300" study visibility "$scene" --thresholds $value; done
for value in 15 0 -1 1e6 x 2000000001; do says 2 "--rays takes a whole number from 16 to 2000000000" study causes "$scene" --rays $value; done
for value in 3 4,4 16,4 1e308 x 4, 4096; do says 2 "--rays takes some of 4,16,64,256,1024" study visibility "$scene" --rays $value; done
for value in -1 1 100% 2x x nan 1e400; do
    says 2 "--reflectance-error takes a number from 0, below 1, or percent" solve "$scene" --errors=all --reflectance-error $value
    says 2 "--exitance-error takes a number from 0, below 1, or percent" solve "$scene" --errors=all --exitance-error $value
done
says 2 "--errors takes all, or no value, not x" solve "$scene" --errors=x
says 2 "--errors takes all, or no value, not an empty value" solve "$scene" --errors=
says 2 "for the account of error: add --errors=all" solve "$scene" --reflectance-error 2%
says 2 "for the account of error: add --errors=all" solve "$scene" --errors --exitance-error 0.1
says 2 "named .ply, .gltf, .glb, .obj or .xdmf, not x" solve "$scene" -o x
says 2 "--release takes flat, dag, hand or wave, not x" solve "$scene" --release x
says 2 "--solver takes gauss-seidel, jacobi, southwell, lu or petsc, not x" solve "$scene" --solver x
says 2 "--projection takes galerkin or collocation, not x" compare "$scene" --projection x
says 1 "LU solves for at most 5000 leaves, and there are" solve "$scenes/room.obj" --solver lu --set bend=1e-6
says 2 "--closure takes none or rows, not reciprocal" solve "$scene" --closure reciprocal
says 2 "--basis takes constant or linear, not quadratic" solve "$scene" --basis quadratic
says 2 "--closure takes none, rows or reciprocal, not x" viewfactors "$scene" --closure x
says 2 "--clusters takes sah, embree, octree, kd or halves, not x" solve "$scene" --clusters x
says 2 "--only takes sah, embree" study clustering "$scene" --only x
says 2 "--format takes csv, coo, mtx, npz, view3d, energyplus or openfoam, not x" viewfactors "$scene" --format x
says 2 "--by takes face, material, group or object, not x" viewfactors "$scene" --by x
says 2 "--format is about the matrix, which is written nowhere: add -o FILE" viewfactors "$scene" --format npz
says 2 "--sky is about the matrix" viewfactors "$scene" --sky
says 2 "--by is about the matrix" viewfactors "$scene" --by material
# what sensors see is exact, and has names of its own
says 2 "--sensor writes a table of exact cuts: it does not go with --tolerance" viewfactors "$scene" --sensor x --tolerance 1e-3
says 2 "--sensor's file names the rows itself: it does not go with --names" viewfactors "$scene" --sensor x --names y
says 2 "-o takes a file named .csv or .md, not x" study stability -o x
says 2 "--chart takes a file named .svg or .png, not x.svgz" study visibility "$scene" --chart x.svgz

# ---- which option, and whose
says 2 "solve has no option --repeats; compare has; see radiosity solve --help" solve "$scene" --repeats 3
says 2 "compare has no option -o; solve has" compare "$scene" -o x.ply
says 2 "study stability has no option --set; solve has" study stability --set relative=1
says 2 "oracles has no option -q" oracles -q
says 2 "unknown option --nix" solve "$scene" --nix
says 2 "unknown option -x" solve "$scene" -x
says 2 "unknown option --=1" solve "$scene" --=1
says 2 "no value goes with --mesh" solve "$scene" --mesh=1
says 2 "more than one scene: b.obj" solve a.obj b.obj
says 2 "more than one scene: -b.obj" solve a.obj -- -b.obj
says 2 "no scene is given; see radiosity compare --help" compare -q
says 2 "no scene is given; see radiosity study causes --help" study causes -q
says 2 "the scene's name is empty" study causes "$scene" ""
says 2 "this is a scene, which would be lost" study causes none.obj "$scene" --json "$scene"
says 2 "study stability takes no scene, but got x.obj" study stability x.obj
says 2 "study arvo takes no scene, but got x.obj" study arvo x.obj
says 2 "oracles takes no scene, but got power; it tells of all oracles, \`radiosity draw NAME\` shows one" oracles power
says 2 "unknown command nix; see radiosity --help" nix
says 2 "there is no study nix; see radiosity study --help" study nix
says 2 "unknown command nix; see radiosity --help" help nix
says 2 "there is no study nix; see radiosity study --help" help study nix
# A slip of the fingers is known for one.
says 2 "unknown option --imgae=i.png (did you mean --image?); see radiosity solve --help" solve "$scene" --imgae=i.png
says 2 "unknown command solv (did you mean solve?); see radiosity --help" solv "$scene"
says 2 "unknown command stdy (did you mean study?); see radiosity --help" stdy arvo
says 2 "there is no study stabilty (did you mean stability?); see radiosity study --help" study stabilty
says 2 "a command comes first, not --image" --image x solve "$scene"
says 2 "--mesh is for a picture: add --image FILE.png or --image-error FILE.png" solve "$scene" --mesh
says 2 "--size is for a picture: add --image FILE.png or --image-error FILE.png" solve "$scene" --size 100x100
says 2 "--gather is for a picture: add --image FILE.png" solve "$scene" --gather 4
says 2 "--no-errors and --image-error contradict each other" solve "$scene" --no-errors --image-error x.png
says 2 "takes no --release but dag" solve "$scene" --statistics - --release flat
# An abbreviation is good as long as it is clear, with --name=value as well; one that is not names what it could be.
says 2 "--tolerance takes a number above 0 and below 1, not 7" solve "$scene" --tol 7
says 2 "--tolerance takes a number above 0 and below 1, not 7" solve "$scene" --tol=7
says 2 "--s could be --set, --scale, --solver, --size, --statistics" solve "$scene" --s 7
says 2 "--t could be --tolerance, --two-sided, --threads, --trace" solve "$scene" --t=7
# Options may stand before and behind the scene, whatever POSIX says of others.
count=$((count + 1))
POSIXLY_CORRECT=1 "$radiosity" solve none.obj --tolerance 7 2>&1 | grep -q "tolerance takes" || failed "POSIXLY_CORRECT"
says 1 "none.obj: error" solve -q none.obj
says 1 "none.obj: error" solve -qo x.ply none.obj

# ---- help: of 24 lines of 80 columns, on standard output, with an example that the parser takes
for command in "" solve compare viewfactors reference error tune study "study stability" "study visibility" "study clustering" "study form-factors" "study arvo" "study causes" "study greedy" draw panel oracles explain; do
    for help in --help -h; do
        count=$((count + 1))
        # shellcheck disable=SC2086
        if ! "$radiosity" $command $help >out 2>err || [ -s err ] || [ "$(wc -l <out)" -gt 24 ] ||
            [ "$(wc -L <out)" -gt 80 ] || ! grep -q "^usage: radiosity $command" out; then
            failed "radiosity $command $help: $(wc -l <out) lines of $(wc -L <out) columns"
        fi
    done
    count=$((count + 1))
    # shellcheck disable=SC2086
    "$radiosity" help $command | cmp -s - out || failed "radiosity help $command is not radiosity $command --help"
    count=$((count + 1))
    example=$(sed -n 's/^    radiosity \(.*\)/\1/p' out | sed 's/\([a-z]*\)\.obj/none.obj/; s/faces\.csv/none.obj/; s/room\.json/none.obj/; s/mine\.dag/bf/; s/-o bf/-o x.dag/')
    # shellcheck disable=SC2086
    case $command in
    study | "study stability" | "study arvo" | "study greedy" | oracles) ;;
    *) "$radiosity" $example >out 2>err; grep -q "^none.obj: error" err || failed "$example" ;;
    esac
    rm -f out err
done
for command in solve compare viewfactors reference error tune "study stability" "study visibility" "study clustering" "study form-factors" "study arvo" "study causes" "study greedy" draw panel; do
    # shellcheck disable=SC2086
    "$radiosity" $command --help=all | sed -n 's/^  \(-[^ ]*\).*/\1/p' | sort | uniq -d | grep . && failed "twice in $command --help"
done

# ---- parameters and oracles: exit 1
says 1 "energy has no value" solve "$scene" --set energy=
says 2 "--set takes PARAM=VALUE, not =1" solve "$scene" --set =1
says 2 "--set takes PARAM=VALUE, not energy" solve "$scene" --set energy
says 1 "'0x10' is not a number" solve "$scene" --set energy=0x10
says 2 "--tolerance takes " solve "$scene" --tolerance 0x1p-9
says 1 "nosuch.dag: error: cannot read the oracle: No such file or directory; check the name" solve "$scene" --oracle nosuch.dag
says 1 "'x' is not a number" solve "$scene" --set energy=x
says 1 "'nan' is not a number" solve "$scene" --set energy=nan
says 1 "out of range; energy takes 0 to inf" solve "$scene" --set energy=-1
says 1 "energy=1e999: too large to be a number" solve "$scene" --set energy=1e999
says 1 "rays takes whole numbers from 4 to 64" solve "$scene" --oracle bf_guarded --set rays=16.5
says 1 "rays takes whole numbers from 4 to 64" solve "$scene" --oracle bf_guarded --set rays=1e30
says 1 "has no parameter 'no'; it has energy" solve "$scene" --set no=1
says 1 "no such oracle" solve "$scene" --oracle nix
says 1 "gap: error: no hand-written release of this oracle; use --release flat, wave or dag, or --oracle bf or --oracle bf_guarded or --oracle power" \
    solve "$scene" --oracle gap --release hand

# ---- outputs that cannot be written are told before the scene is read, which is not there
says 1 "nowhere/x.ply: error: cannot write: No such file or directory; make the folder first" solve none.obj -o nowhere/x.ply
for option in --faces --json --statistics; do
    says 1 "make the folder first" solve none.obj $option nowhere/x
    says 1 "give the name of a file, not of a folder" solve none.obj $option /
done
for option in --image --image-error; do
    says 1 "make the folder first" solve none.obj $option nowhere/x.png
    for name in x x.jpg x.png.bmp .svg -; do says 2 "$option takes a file named .png, not $name" solve none.obj $option $name; done
done
says 2 "--faces takes FILE.csv, not -" solve none.obj --faces -
says 2 "-o takes FILE, not -" viewfactors none.obj -o -
says 2 "--names takes FILE, not -" viewfactors none.obj --names -
says 2 "-o takes a file named .ply" solve none.obj -o -
says 1 "make the folder first" compare none.obj --json nowhere/x
says 1 "make the folder first" viewfactors none.obj -o nowhere/x.csv
says 1 "make the folder first" reference none.obj -o nowhere/x.csv
says 1 "make the folder first" viewfactors none.obj --json nowhere/x
says 1 "make the folder first" viewfactors none.obj --names nowhere/x
says 1 "make the folder first" study stability -o nowhere/x.csv
says 1 "make the folder first" study arvo --csv nowhere/x.csv
says 1 "make the folder first" study visibility none.obj -o nowhere/x.csv
says 1 "make the folder first" study causes none.obj --json nowhere/x.json
says 1 "make the folder first" study visibility none.obj --chart nowhere/x.svg
says 1 "make the folder first" draw bf -o nowhere/x.svg
says 2 "draw has no option --threads" draw bf -o x.svg --threads 2
says 2 "-o takes a file named .svg, not x.png" draw bf -o x.png
says 2 "more than one oracle: gap" draw bf gap -o x.svg
says 2 "two outputs would go there" solve none.obj --faces x --json x
says 2 "two outputs would go there" viewfactors none.obj -o x --names x
says 2 "two outputs would go there" reference none.obj -o x.csv --json ./x.csv.state
says 2 "standard output: error: two outputs would go there" solve none.obj --statistics - --json -
if [ "$(id -u)" != 0 ]; then
    mkdir "$tmp-closed" && chmod 555 "$tmp-closed"
    says 1 "choose a place where you may write" solve none.obj --faces "$tmp-closed/x"
    rmdir "$tmp-closed"
fi
# What could be written is neither made nor touched when the run fails for another reason.
says 1 "none.obj: error" solve none.obj --faces x.csv --json y.json --image z.png
echo precious >../"$(basename "$tmp").kept"
says 1 "none.obj: error" solve none.obj --faces ../"$(basename "$tmp").kept"
count=$((count + 1))
[ "$(cat ../"$(basename "$tmp").kept")" = precious ] || failed "an output was lost with the run"
rm -f ../"$(basename "$tmp").kept"
# The scene is no output, whatever its name is there.
mkdir "$tmp.scene" && cp "$scenes"/furnace.* "$tmp.scene" && ln -s furnace.obj "$tmp.scene/link.obj"
for option in -o --faces --json --statistics; do
    says 2 "this is the scene, which would be lost" solve "$tmp.scene/furnace.obj" $option "$tmp.scene/link.obj"
done
# Nor is what it names, nor what else is read; and a mesh brings a file with it.
ln -s furnace.mtl "$tmp.scene/link.mtl" && echo >"$tmp.scene/p.html" && ln -s p.html "$tmp.scene/link.html"
ln "$tmp.scene/furnace.mtl" "$tmp.scene/hard.mtl"
for name in furnace.mtl ./furnace.mtl link.mtl hard.mtl; do
    says 2 "this is a material file of the scene, which would be lost" solve "$tmp.scene/furnace.obj" --json "$tmp.scene/$name"
done
says 2 "this is a material file of the scene" solve "$tmp.scene/furnace.obj" -o "$tmp.scene/furnace.OBJ"
says 2 "this is a material file of the scene" compare "$tmp.scene/furnace.obj" --json "$tmp.scene/link.mtl"
says 2 "this is a material file of the scene" viewfactors "$tmp.scene/furnace.obj" --names "$tmp.scene/link.mtl"
# mtllib names one file, with blanks or a comment behind it, or several: the reader's way of telling is the guard's.
libraries() { # LINE NAME...: of these files that are there, the scene's
    { echo "mtllib $1"; grep -v mtllib "$scenes/furnace.obj"; } >"$tmp.scene/named.obj"
    shift
    for name; do says 2 "$name: error: this is a material file of the scene" solve "$tmp.scene/named.obj" --json "$tmp.scene/$name"; done
}
cp "$scenes/furnace.mtl" "$tmp.scene/a.mtl" && cp "$scenes/furnace.mtl" "$tmp.scene/b.mtl"
libraries "a.mtl b.mtl" a.mtl b.mtl
libraries "a.mtl	b.mtl # both" a.mtl b.mtl
libraries "a.mtl # warm" a.mtl
libraries "missing.mtl b.mtl"
says 1 "cannot read the material library '$tmp.scene/missing.mtl b.mtl'" solve "$tmp.scene/named.obj" --json "$tmp.scene/b.mtl"
cp "$scenes/furnace.mtl" "$tmp.scene/a.mtl b.mtl" && cp "$scenes/furnace.mtl" "$tmp.scene/a.mtl # warm"
libraries "a.mtl b.mtl # one" "a.mtl b.mtl"
echo "mtllib a.mtl b.mtl" >"$tmp.scene/named.obj" # a.mtl alone is none of it
says 1 "named.obj: error: there is no face" solve "$tmp.scene/named.obj" --json "$tmp.scene/a.mtl"
libraries "a.mtl # warm" "a.mtl # warm"
mv "$tmp.scene/named.obj" "$tmp.scene/named.Obj"
says 2 "this is a material file of the scene" solve "$tmp.scene/named.Obj" --json "$tmp.scene/a.mtl # warm"
cp "$tmp.scene/furnace.obj" "$tmp.scene/other.obj"
rm "$tmp.scene/furnace.obj"
says 2 "furnace.mtl: error: this is a material file of the scene" solve "$tmp.scene/other.obj" -o "$tmp.scene/furnace.obj"
mv "$tmp.scene/other.obj" "$tmp.scene/furnace.obj"
echo theirs >"$tmp.scene/alone.mtl"
says 2 "alone.mtl: error: is written beside" solve "$tmp.scene/furnace.obj" -o "$tmp.scene/alone.obj"
mkdir "$tmp.scene/folder.bin"
says 2 "folder.bin: error: is written beside" solve "$tmp.scene/furnace.obj" -o "$tmp.scene/folder.gltf"
says 2 "two outputs would go there" solve "$scene" -o "$tmp.scene/x.obj" --json "$tmp.scene/folder.bin/../x.mtl"
says 2 "two outputs would go there" solve "$scene" --faces x.csv --json ./x.csv
printf '{"buffers":[{"uri" : "x.json"}]}' >"$tmp.scene/x.gltf"
echo data >"$tmp.scene/x.json"
says 2 "this is a file of the scene, which would be lost" solve "$tmp.scene/x.gltf" --json "$tmp.scene/x.json"
cp "$top/examples/oracles/bf.dag" "$tmp.scene/bf.dag"
says 2 "this is the oracle, which would be lost" solve "$scene" --oracle "$tmp.scene/bf.dag" --json "$tmp.scene/bf.dag"
cp "$top/examples/oracles/common.dag" "$tmp.scene/common.dag"
says 2 "this is a file that the oracle imports, which would be lost" solve "$scene" --oracle "$tmp.scene/bf.dag" --json "$tmp.scene/./common.dag"
says 2 "this is a file that the oracle imports, which would be lost" tune "$tmp.scene/bf.dag" "$scene" -o "$tmp.scene/common.dag"
ln "$tmp.scene/common.dag" "$tmp.scene/common.svg"
says 2 "this is a file that the oracle imports, which would be lost" draw "$tmp.scene/bf.dag" -o "$tmp.scene/common.svg"
echo 'int a;' >"$tmp.scene/p.c"
says 2 "this is a plugin, which would be lost" explain "$scene" --pair 0,1 --plugin "$tmp.scene/p.c" --json "$tmp.scene/p.c"
says 2 "this is the file of parameters, which would be lost" solve "$scene" --params "$tmp.scene/x.json" --faces "$tmp.scene/x.json"
says 2 "this is the file of statistics, which would be lost" panel bf --statistics "$tmp.scene/p.html" -o "$tmp.scene/link.html"
says 2 "this is the scene, which would be lost" viewfactors "$tmp.scene/furnace.obj" -o "$tmp.scene/../${tmp##*/}.scene/furnace.obj"
says 2 "two outputs would go there" solve none.obj --faces "$tmp.scene/link.obj" --json "$tmp.scene/furnace.obj"
count=$((count + 1))
cmp -s "$tmp.scene/furnace.obj" "$scenes/furnace.obj" || failed "the scene was lost"
rm -rf "$tmp.scene"
# Standard output that is full or closed is told.
for arguments in oracles --help "solve $scenes/furnace.obj"; do
    count=$((count + 2))
    "$radiosity" $arguments >/dev/full 2>err
    [ $? = 1 ] && grep -q "^standard output: error: cannot write: No space left" err || failed "$arguments to a full device"
    "$radiosity" $arguments >&- 2>err
    [ $? = 1 ] && grep -q "^standard output: error: cannot write: Bad file" err || failed "$arguments without standard output"
    rm -f err
done
# A file that may not grow is told, too; the signal that comes with it ends nobody, and nothing is left.
count=$((count + 1))
(ulimit -f 1; exec "$radiosity" solve "$scenes/cornell.obj" -q -o small.ply --no-correct --no-errors 2>err)
[ $? = 1 ] && grep -q "^small.ply: error: cannot write: File too large; allow larger files" err && [ "$(ls -A)" = err ] ||
    failed "a file that may not grow: $(ls -A)"
rm -f err
# So is a file, whoever writes it and however long ago the write was that failed.
for format in ply obj gltf glb; do
    count=$((count + 1))
    ln -s /dev/full full.$format
    "$radiosity" solve "$scenes/cornell.obj" -q -o full.$format --no-correct --no-errors >out 2>err
    [ $? = 1 ] && grep -q "^full.$format: error: cannot write: No space left on device; free" err && [ "$(wc -l <err)" = 1 ] ||
        failed "a full disk, .$format: $(cat err)"
    rm -f full.$format out err
done
count=$((count + 1))
"$radiosity" solve "$scenes/furnace.obj" -q --json - >/dev/full 2>err
[ $? = 1 ] && grep -q "^standard output: error: cannot write: No space left" err && [ "$(wc -l <err)" = 1 ] || failed "--json - to a full device: $(cat err)"
says 1 "File name too long; give it a shorter name" solve "$scene" --json "$(printf '%0300d' 0)"
# A format that is known, and a file that holds nothing of it.
mkdir "$tmp.damaged"
: >"$tmp.damaged/empty.glb" && says 1 "empty.glb: error: cannot be read as a scene: it is empty or damaged" solve "$tmp.damaged/empty.glb"
head -c 300 /dev/zero >"$tmp.damaged/zero.glb" && says 1 "zero.glb: error: cannot be read as a scene: it is empty or damaged" solve "$tmp.damaged/zero.glb"
: >"$tmp.damaged/empty.foo" && says 1 "a format that is not known here" solve "$tmp.damaged/empty.foo"
rm -r "$tmp.damaged"
# A pipe nobody reads must not be waited for.
count=$((count + 1))
mkfifo pipe && timeout 20 "$radiosity" solve none.obj --faces pipe >out 2>err
[ $? = 1 ] && grep -q none.obj err || failed "a pipe as output"

# ---- examples of help and man page that need no other file run as they stand
mkdir examples && (
    cd examples && cp "$scenes"/cornell.obj room.obj && cp "$scenes"/cornell.* . || exit
    { "$radiosity" solve --help; "$radiosity" study causes --help; cat "$top/solver/man/radiosity.1"; } |
        sed -En 's/^ *(radiosity (solve|study causes) room.obj .*)/\1/p' | grep -v mine | sort -u >all
)
count=$((count + 1))
[ "$(wc -l <examples/all)" -ge 6 ] || failed "fewer examples than there were"
while read -r line; do
    count=$((count + 1))
    # shellcheck disable=SC2086
    (cd examples && "$radiosity" ${line#radiosity } -q >../out 2>../err) || failed "$line"
done <examples/all
rm -rf examples

# ---- numbers that documents tell of are those of the headers
# told NAME VALUE HEADER WORDS FILE...: the header defines NAME as VALUE, and each file says so by these words.
told() {
    count=$((count + 1))
    name=$1 value=$2 header=$top/$3 words=$4
    shift 4
    grep -qxF "#define $name $value" "$header" || failed "$name is no longer $value, as these say: $*"
    for file; do
        tr '\n*' '  ' <"$top/$file" | tr -s ' ' | grep -qF -- "$words" || failed "$file does not say: $words"
    done
}
api=runtime/radiosity.h constants=runtime/kernel/constants.h page=solver/man/radiosity.1
error=examples/measured_error.md factors=examples/viewfactors.md
told RAD_CORRECT_PLACES 0.065 $api "6.5 %, root mean square" $error $page
told RAD_CORRECT_PLACES 0.065 $api "6.5 % on places of 1e-4" README.md
told RAD_CORRECT_NOISE 0.0065 $api ".65 % of the light per face" $error
told RAD_CORRECT_NOISE 0.0065 $api ".65 % of noise per face" README.md
told RAD_CORRECT_LEFT 0.0085 $api "is at most .85 %" $error
told RAD_CORRECT_POWER 0.0039 $api "at most .39 %" $error
told RAD_CORRECT_LEAST "(1u << 17)" $api "131,072" $error
told RAD_CORRECT_OF_ONE 6400u $api "6,400 for each face" $error README.md
told RAD_MEASURE_SURFACES 250000u $api "250,000 at least" $error
told PATHS_CHEAPER 2.0 $constants "less than half of the rays" $error $page $api
told LIMIT_DEPTH 16 $constants "(16 splits" $api
told SIGHT_FEW_POLYGONS 24 $constants "24 polygons" $factors $page $api
told SIGHT_FLOOR_MANY 4.0 $constants "four over the root of the number of faces" $factors $page $api

# ---- the picture of the error takes what that of the light takes, and both come from one run
count=$((count + 1))
"$radiosity" solve "$scene" -q --image-error e.png --mesh --view 0.5,0.5,0.5:1,0.5,0.5 --size 60x40 >out 2>err &&
    "$radiosity" solve "$scene" -q --image i.png --image-error e.png --size 60x40 >>out 2>>err && [ -s i.png ] && [ -s e.png ] &&
    [ ! -s err ] && [ ! -s out ] || failed "--image-error"
rm -f out err i.png e.png

# ---- a camera that sees no face leaves a picture of nothing, and that is said
count=$((count + 1))
"$radiosity" solve "$scene" --no-errors --image i.png --view 9,9,9:10,10,10 --size 6x4 >out 2>err && [ -s i.png ] && [ "$(wc -l <err)" = 1 ] &&
    grep -q '^i.png: warning: no face shows its front to the eye at 9,9,9, so the picture is empty; the scene reaches from 0,0,0 to 1,1,1: give another --view' err &&
    "$radiosity" solve "$scene" -q --image i.png --view 9,9,9:10,10,10 --size 6x4 2>err && [ ! -s err ] &&
    "$radiosity" solve "$scene" --no-errors --image i.png --view 9,9,9:1,1,1:1 --size 1x1 >out 2>err && [ ! -s err ] || failed "an empty picture"
rm -f out err i.png

# ---- an OBJ in coordinates of a map loses decimetres, and that is said, but not where -q is
count=$((count + 1))
sed 's/^v 0/v 5000000/; s/^v 1/v 5000001/' "$scene" >far.obj && cp "${scene%.obj}.mtl" . &&
    "$radiosity" solve far.obj --no-errors -o moved.obj >out 2>err && grep -q '^moved.obj: warning: single precision moves corners by up to 0\.[0-9]* m' err &&
    "$radiosity" solve far.obj -q -o moved.obj 2>err && [ ! -s err ] || failed "-q and an OBJ far away"
rm -f out err far.obj moved.* furnace.mtl

# ---- a scene without a lamp is dark, and that is said
sed 's/^Ke .*/Ke 0 0 0/' "${scene%.obj}.mtl" >furnace.mtl && cp "$scene" dark.obj
count=$((count + 1))
"$radiosity" solve dark.obj >out 2>err && [ "$(wc -l <err)" = 1 ] && grep -q '^dark.obj: warning: no face emits, so all is dark; give ' err || failed "no lamp"
# a lamp that looks into a box with its fronts outside
{
    printf 'newmtl w\nKd .5 .5 .5\nnewmtl lamp\nKe 100 100 100\n' >shut.mtl
    printf 'mtllib shut.mtl\nusemtl w\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n'
    printf 'usemtl lamp\nv .3 .3 .5\nv .7 .3 .5\nv .7 .7 .5\nv .3 .7 .5\nf -4 -3 -2 -1\n'
} >shut.obj
"$radiosity" solve shut.obj >out 2>err && grep -q '^shut.obj: warning: all that emits is shut in by the backs of faces' err && ! grep -q 'inf\|no face emits' out err || failed "a lamp that is shut in"
rm -f out err dark.obj furnace.mtl

# ---- a chart of a single threshold draws without a word
if ! command -v gnuplot >/dev/null; then
    failed "no chart can be looked at without gnuplot; install it (gnuplot-nox)"
else
    count=$((count + 1))
    "$radiosity" study visibility "$scenes/cornell.obj" --thresholds 5 --rays 4 --set unit_share=1e-3 --set reference=64 --set min_share=1e-3 --chart one.svg -q >out 2>err &&
        [ -s one.svg ] && [ ! -s err ] && [ ! -s out ] || failed "a chart of one threshold"
fi

finish options
