# json.awk - numbers of a JSON file as the commands write it, an item a line: "path value", "error.power.value 0.01".
# SPDX-License-Identifier: MIT
{
    line = $0
    sub(/^ +/, "", line)
    sub(/,$/, "", line)
    if (line ~ /^[]}]/) {
        depth--
        next
    }
    key = ""
    if (match(line, /^"[^"]*": /)) {
        key = substr(line, 2, RLENGTH - 4)
        line = substr(line, RLENGTH + 1)
    }
    if (line ~ /[[{]$/) {
        path[++depth] = key
        next
    }
    name = key
    for (i = depth; i > 1; i--) # the first is the file's own brace
        name = path[i] "." name
    gsub(/"/, "", line)
    if (line != "null")
        print name, line
}
