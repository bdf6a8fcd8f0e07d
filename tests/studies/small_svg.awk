# small_svg.awk - a chart as gnuplot writes it, in a quarter of the bytes: what is said of style again and again becomes classes,
# empty groups go, a series of points becomes a line with a marker at each corner, lengths have a tenth of a unit (the chart is
# about 1000 wide), symbols that nothing uses go. Ink (#111111 or black) and paper (#fefefe) follow the reader's light or dark.
# SPDX-License-Identifier: MIT
BEGIN {
    RS = "<"
    properties = split("fill color stroke opacity stroke-width stroke-linecap stroke-linejoin stroke-dasharray " \
        "font-family font-size text-anchor", property, " ")
}
function value(name, n, at, quote, rest) { # of an attribute of the element
    n = match(element, "[ \t\n]" name "=[\"']")
    if (!n) return ""
    rest = substr(element, RSTART + RLENGTH)
    quote = substr(element, RSTART + RLENGTH - 1, 1)
    return substr(rest, 1, index(rest, quote) - 1)
}
# Numbers in a text to a tenth; a line's letters only where they are needed.
function tenths(text, out) {
    gsub(/[ \t\n]+/, " ", text)
    gsub(/ *L */, " ", text)
    while (match(text, /[0-9]+\.[0-9]+/)) {
        out = out substr(text, 1, RSTART - 1) sprintf("%.10g", int(10 * substr(text, RSTART, RLENGTH) + .5) / 10)
        text = substr(text, RSTART + RLENGTH)
    }
    out = out text
    gsub(/ *M */, "M", out)
    gsub(/\) +/, ")", out)
    sub(/ +$/, "", out)
    return out
}
# Of a path: a step along one axis says one number.
function steps(text, n, i, k, piece, corner, x, y, out, was_x, was_y) {
    n = split(tenths(text), piece, "M")
    for (i = 2; i <= n; i++) {
        out = out "M"
        for (k = 1; k <= split(piece[i], corner, " "); k++) {
            x = corner[k] + 0
            y = substr(corner[k], index(corner[k], ",") + 1) + 0
            if (k > 1 && y == was_y) out = out "h" sprintf("%.10g", int(10 * (x - was_x) + (x < was_x ? -.5 : .5)) / 10)
            else if (k > 1 && x == was_x) out = out "v" sprintf("%.10g", int(10 * (y - was_y) + (y < was_y ? -.5 : .5)) / 10)
            else out = out (k == 1 ? "" : out ~ /[hv][-0-9.]*$/ ? "L" : " ") corner[k]
            was_x = x
            was_y = y
        }
    }
    return out
}
function colour(c) {
    gsub(/ /, "", c)
    return c
}
# The class of what is said of style in the element, and of what stands around it (a class, or "").
function class_of(around, i, n, v, css, night, part, said) {
    n = split(css_of[around], part, ";")
    for (i = 1; i < n; i++) said[substr(part[i], 1, index(part[i], ":") - 1)] = substr(part[i], index(part[i], ":") + 1)
    for (i = 1; i <= properties; i++) {
        v = colour(value(property[i]))
        if (v != "") said[property[i]] = property[i] == "font-size" ? v + 0 "px" : v
        if (!(property[i] in said)) continue
        v = said[property[i]]
        css = css property[i] ":" v ";"
        if (property[i] == "fill" && v == "#fefefe") night = night "fill:#0d1117;"
        else if (property[i] ~ /^(fill|color|stroke)$/ && (v == "black" || v == "rgb(17,17,17)")) night = night property[i] ":#e6edf3;"
    }
    if (css == "") return ""
    if (!(css in class)) {
        class[css] = "c" ++classes
        css_of[class[css]] = css
        night_of[class[css]] = night
    }
    return class[css]
}
function classed(name) {
    if (name == "") return ""
    used[name] = 1
    return " class=\"" name "\""
}
function put(text) {
    out[++lines] = text
    lone[lines] = ""
}
# The points that wait: one stands by itself, more are a line's corners.
function end_points(key, part) {
    if (!waiting) return
    key = point_of
    if (!(key in marker)) {
        marker[key] = "m" ++markers
        split(key, part, SUBSEP)
        needed[part[1]] = 1
        marks = marks "<marker id=\"" marker[key] "\" overflow=\"visible\" markerUnits=\"userSpaceOnUse\"><g transform=\"scale(" part[2] \
            ")\" fill=\"none\" color=\"" part[3] "\"><use xlink:href=\"#" part[1] "\"/></g></marker>\n"
        if (part[3] ~ /^(black|rgb\(17,17,17\))$/) night_rules = night_rules "#" marker[key] " g{color:#e6edf3}\n"
    }
    # a line of one corner has no length: the corner twice
    put("<path class=\"" marker[key] "\" d=\"M" points (waiting == 1 ? " " points : "") "\"/>")
    waiting = 0
    points = ""
}
NR == 1 { next } # before the first element
{
    end = index($0, ">")
    element = substr($0, 1, end)
    text = substr($0, end + 1)
    sub(/^[ \t\n]+$/, "", text)
    tag = element
    sub(/[ \t\n\/>].*/, "", tag)
    if (substr(element, 1, 1) == "/") tag = "/" substr(element, 2, length(element) - 2)
}
tag == "?xml" { put("<" element); next }
tag == "svg" { gsub(/[ \t\n]+/, " ", element); put("<" element); next }
tag == "desc" || tag == "/desc" || tag == "style" || tag == "/style" { next }
tag == "title" && !named++ { skip_title = 1; next } # the document's: "Gnuplot"
tag == "/title" && skip_title { skip_title = 0; next }
tag == "defs" { in_defs = 1; next }
tag == "/defs" { in_defs = 0; next }
in_defs { # symbols, one element each; filters are for boxed texts, which our charts have none of
    id = value("id")
    if (id ~ /^gpPt/) {
        gsub(/[ \t\n]+/, " ", element)
        symbol[id] = "<" element
        uses[id] = tag == "use" ? substr(value("xlink:href"), 2) : ""
    }
    next
}
tag == "use" {
    at = value("transform")
    scale = at
    sub(/.*scale\(/, "", scale)
    sub(/\).*/, "", scale)
    sub(/translate\(/, "", at)
    sub(/\).*/, "", at)
    key = substr(value("xlink:href"), 2) SUBSEP scale + 0 SUBSEP colour(value("color"))
    if (waiting && key != point_of) end_points()
    point_of = key
    points = points (waiting ? " " : "") tenths(at)
    waiting++
    next
}
{ end_points() }
tag == "g" {
    at = value("transform")
    style[++depth] = class_of("")
    put("<g" classed(style[depth]) (at != "" ? " transform=\"" tenths(at) "\"" : "") ">" text)
    open[depth] = lines
    bare[depth] = at == "" && text == ""
    next
}
tag == "/g" {
    inner = out[lines]
    if (open[depth] == lines && inner ~ /^<g[^>]*>$/) lines-- # nothing in it
    else if (lines == open[depth] + 1 && inner ~ /^<text>/ && !bare[depth]) {
        # a text alone says itself where it stands
        out[lines - 1] = "<text" substr(out[lines - 1], 3) substr(inner, 7)
        lines--
    } else if (lines == open[depth] + 1 && bare[depth] && lone[lines] != "") {
        # a line alone says all of its style
        element = lone[lines]
        out[lines - 1] = "<path" classed(class_of(style[depth])) substr(inner, index(inner, " d="))
        lone[lines - 1] = ""
        lines--
    } else out[lines] = inner "</g>"
    depth--
    next
}
tag == "path" { put("<path" classed(class_of("")) " d=\"" steps(value("d")) "\"/>"); lone[lines] = element; next }
tag == "rect" || tag == "polygon" || tag == "circle" {
    line = "<" tag classed(class_of(""))
    n = split("x y width height points cx cy r", plain, " ")
    for (i = 1; i <= n; i++) if (value(plain[i]) != "") line = line " " plain[i] "=\"" tenths(value(plain[i])) "\""
    put(line "/>")
    next
}
tag == "title" { out[lines] = out[lines] "<title>" text; next }
tag == "text" { put("<text>" text); next }
tag == "tspan" { # in the font of the rest
    gsub(/ font-family="sans-serif"/, "", element)
    gsub(/ +>/, ">", element)
    out[lines] = out[lines] (element == "tspan>" ? "" : "<" element) text
    plain_span = element == "tspan>"
    next
}
tag == "/tspan" { out[lines] = out[lines] (plain_span ? "" : "</tspan>") text; next }
tag == "/text" || tag == "/title" { out[lines] = out[lines] "<" element text; next }
tag == "/svg" {
    for (id in needed) # a symbol may be made of another
        for (of = uses[id]; of != ""; of = uses[of]) needed[of] = 1
    for (i = 1; i <= 2; i++) print out[i]
    print "<style>"
    for (i = 1; i <= classes; i++) {
        if (!("c" i in used)) continue
        printf ".c%d{%s}\n", i, css_of["c" i]
        if (night_of["c" i] != "") night_rules = night_rules ".c" i "{" night_of["c" i] "}\n"
    }
    for (i = 1; i <= markers; i++) printf ".m%d{fill:none;stroke:none;marker:url(#m%d)}\n", i, i
    printf "@media (prefers-color-scheme: dark){\n%s}\n</style>\n<defs>\n", night_rules
    for (i = 0; i <= 20; i++) if ("gpPt" i in needed) print symbol["gpPt" i]
    printf "%s</defs>\n", marks
    for (i = 3; i <= lines; i++) print out[i]
    print "</svg>"
    next
}
{
    print "small_svg.awk: error: unknown element <" tag ">" >"/dev/stderr"
    exit 1
}
