# random_graphs.awk - oracles for prove.sh: up to 200 nodes each, shared nodes, names and order shuffled.
# Usage: awk -v seed=1 -v count=100 -f random_graphs.awk; or -v exactly=1000: one graph of so many nodes.
# More of the language comes in here: a kind of argument in value(), a branch beside node(). A graph of a
# given size has neither computed arguments nor branches.
# SPDX-License-Identifier: MIT

function pick(n) { return int(rand() * n) }

function target(i,  far) {
    if (exactly && i + 1 < nodes && !linked[i]++)
        return "n" name[i + 1] # all are reached
    if (i + 1 >= nodes || pick(6) == 0)
        return pick(3) == 0 ? "split" : pick(2) ? "keep" : "drop"
    far = nodes - i - 1
    return "n" name[i + 1 + pick(far < 6 || pick(8) == 0 ? far : 6)]
}

function computed(type) {
    if (type == "flux")
        return pick(2) ? "max(lamp * 2 + pf" pick(2) ", 0.25)" : "lamp * max(0, size." (pick(2) ? "rough" : "fine") ") + glow / " 1 + pick(9)
    if (type == "count")
        return pick(2) ? "min(100, right.depth * 2 + 1)" : "max(1, min(pc, right.depth))"
    return pick(2) ? "max(0, min(1, size.fine - pr / 3))" : "min(1, abs(times - sqrt(left.area / right.area)))"
}

function value(type) {
    if (!exactly && pick(4) == 0)
        return computed(type)
    if (type == "flux")
        return pick(2) ? "pf" pick(2) : pick(2) ? "1e-300" : pick(1000) / 8
    if (type == "count")
        return pick(2) ? "pc" : 1 + pick(100)
    return pick(2) ? "pr" : pick(1001) / 1000
}

function node(i,  tool) {
    tool = pick(exactly ? 4 : 5)
    if (tool == 0)
        return "look() { left -> " target(i) "; right -> " target(i) "; neither -> " target(i) "; }"
    if (tool == 1)
        return "weigh(most = " value("flux") ", share = " value("ratio") ") { light -> " target(i) "; heavy -> " target(i) "; }"
    if (tool == 2)
        return "tally(upto = " value("count") (pick(2) ? ", scale = " value("ratio") : "") ") { few -> " target(i) (pick(3) ? "; some -> " target(i) "; many -> " target(i) "; }" : "; otherwise -> " target(i) "; }")
    if (tool == 4)
        return "halves(x = " value("flux") (pick(2) ? ", s = " value("ratio") : "") ") { yes -> " target(i) "; no -> " target(i) "; }"
    return "measure() { done -> " target(i) "; }"
}

function oracle(number,  i, j, t) {
    nodes = exactly ? exactly : 1 + pick(number % 4 == 0 ? 200 : 40)
    for (i = 0; i < nodes; i++)
        name[i] = line[i] = i
    for (i = nodes - 1; i > 0; i--) {
        j = pick(i + 1); t = name[i]; name[i] = name[j]; name[j] = t
        j = pick(i + 1); t = line[i]; line[i] = line[j]; line[j] = t
    }
    print "oracle g" number " {"
    print "  param pf0 : flux = 0.3 in [0, 5]; param pf1 : flux = 0.4 in [0, 9]; param pr : ratio = 0.7 in [0, 1]; param pc : count = 9 in [2, 99];"
    print "  start n" name[0] ";"
    for (i = 0; i < nodes; i++)
        print "  node n" name[line[i]] " = " node(line[i])
    print "}"
}

BEGIN {
    srand(seed)
    if (!exactly) {
        print "extern glow(where, size >= rough) : flux in [0, inf] \"it shines\";"
        print "graph halves(x : flux in [0, inf], s : ratio = 0.5 in [0, 1]) exits (yes, no) {"
        print "  start w; node w = weigh(most = x * 2, share = s) { light -> yes; heavy -> l; }"
        print "  node l = look() { left -> no; right -> inner; neither -> drop; }"
        print "  node inner = weigh(most = x + glow, share = 1 - s) { light -> keep; heavy -> no; } }"
    }
    for (n = 0; n < (exactly ? 1 : count); n++)
        oracle(n)
}
