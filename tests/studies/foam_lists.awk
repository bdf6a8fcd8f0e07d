# foam_lists.awk - a list of lists as OpenFOAM writes it in ascii, a line of numbers per list; 3{.5} is .5 three times.
# SPDX-License-Identifier: MIT
{ gsub(/[(){}]/, " & ") }
!inside { inside = /^[0-9 ]+$/; next } # the number of lists ends the head
{
    for (i = 1; i <= NF; i++) {
        if ($i == "(") deep++
        else if ($i == "{") times = word
        else if ($i == "}") {
            line = ""
            for (; times; times--) line = line word (times > 1 ? " " : "")
            print line
            line = ""
        } else if ($i == ")") {
            deep--
            if (deep == 1) { print line; line = "" }
            if (!deep) exit
        } else {
            if (deep == 2) line = line (line == "" ? "" : " ") $i
            word = $i
        }
    }
}
