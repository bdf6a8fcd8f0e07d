# other_input.awk - an OBJ scene (v, f; other lines are passed over) as other programs of view factors read it:
#
#     awk -v AS=view3d -f other_input.awk scene.obj >scene.vs3
#     awk -v AS=openfoam -v CASE=folder -f other_input.awk scene.obj
#
# View3D: no enclosure is assumed, so rows are not scaled to 1; single precision in binary as output. OpenFOAM: a case of one cell,
# with all faces in its one patch (whose fronts look into the cell: corners turned), each face by itself in finalAgglom, and room for the rays of all pairs. The
# folders CASE/0, CASE/constant/polyMesh and CASE/system must be there.
# SPDX-License-Identifier: MIT
function head(file, class, object) {
    print "FoamFile { version 2.0; format ascii; class " class "; object " object "; }" >file
}
function list(file, class, object, count, values, i) {
    head(file, class, object)
    print count "\n(" >file
    for (i = 0; i < count; i++) print values[i] >file
    print ")" >file
}
$1 == "v" { corner[corners++] = $2 " " $3 " " $4 }
$1 == "f" {
    for (i = 2; i <= NF; i++) {
        sub(/\/.*/, "", $i)
        $i = $i < 0 ? corners + $i : $i - 1
    }
    face[faces++] = substr($0, 3)
}
END {
    if (AS == "view3d") {
        print "T faces\nC encl=0 out=1\nF 3"
        for (i = 0; i < corners; i++) print "V", i + 1, corner[i]
        for (i = 0; i < faces; i++) {
            split(face[i] " -1", c, " ")
            print "S", i + 1, c[1] + 1, c[2] + 1, c[3] + 1, c[4] + 1, 0, 0, ".5", "f" i
        }
        print "End of data"
        exit
    }
    for (i = 0; i < corners; i++) corner[i] = "(" corner[i] ")"
    for (i = 0; i < faces; i++) {
        n = split(face[i], c, " ")
        face[i] = n "("
        for (k = n; k; k--) face[i] = face[i] c[k] (k > 1 ? " " : ")")
        own[i] = i
    }
    mesh = CASE "/constant/polyMesh/"
    list(mesh "points", "vectorField", "points", corners, corner)
    list(mesh "faces", "faceList", "faces", faces, face)
    head(mesh "owner", "labelList", "owner")
    print faces "{0}" >mesh "owner"
    head(mesh "neighbour", "labelList", "neighbour")
    print "0()" >mesh "neighbour"
    head(mesh "boundary", "polyBoundaryMesh", "boundary")
    print "1\n(\nwalls { type wall; inGroups 1(viewFactorWall); nFaces " faces "; startFace 0; }\n)" >mesh "boundary"
    file = CASE "/constant/finalAgglom"
    head(file, "labelListList", "finalAgglom")
    print "1\n(\n" faces "\n(" >file
    for (i = 0; i < faces; i++) print i >file
    print ")\n)" >file
    file = CASE "/constant/viewFactorsDict"
    head(file, "dictionary", "viewFactorsDict")
    print "writeViewFactorMatrix true;\nwriteFacesAgglomeration false;\nmaxDynListLength " faces * faces + 1000 ";" >file
    file = CASE "/0/qr"
    head(file, "volScalarField", "qr")
    print "dimensions [1 0 -3 0 0 0 0];\ninternalField uniform 0;\nboundaryField { walls { type fixedValue; value uniform 0; } }" >file
    file = CASE "/system/controlDict"
    head(file, "dictionary", "controlDict")
    print "startFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\nwritePrecision 9;" >file
    file = CASE "/system/fvSchemes"
    head(file, "dictionary", "fvSchemes")
    print "ddtSchemes { }\ngradSchemes { }\ndivSchemes { }\nlaplacianSchemes { }\ninterpolationSchemes { }\nsnGradSchemes { }" >file
    head(CASE "/system/fvSolution", "dictionary", "fvSolution")
}
