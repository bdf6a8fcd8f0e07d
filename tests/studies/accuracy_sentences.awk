# accuracy_sentences.awk - two sentences from a Pareto front and from all points, "seconds error method run" each, errors in
# percent: which method is the fastest for which error; and what the default's own error takes by other methods, read off
# between two of their runs on logarithmic scales.
# SPDX-License-Identifier: MIT
function called(method) {
    if (method == "particles" || method == "paths") return method " alone"
    if (method ~ /_chosen$/) return "the default"
    if (sub(/_mended$/, "", method)) return "`" method "` mended"
    if (sub(/_asked$/, "", method)) return "`" method " --accuracy`"
    return "links of `" method "` alone"
}
FNR == NR {
    n++; time[n] = $1; error[n] = $2; method[n] = $3
    next
}
{
    m++; s[m] = $1; e[m] = $2; by[m] = $3; run[m] = $4
}
# The least time in which a method has an error of at most `wanted`; "" if none of its runs has.
function time_for(name, wanted, i, best, k, t) {
    best = ""
    for (i = 1; i <= m; i++)
        if (by[i] == name && e[i] <= wanted && (best == "" || s[i] < s[best])) best = i
    if (best == "") return ""
    # between the slowest cheaper run that is worse, and that one
    k = ""
    for (i = 1; i <= m; i++)
        if (by[i] == name && e[i] > wanted && s[i] < s[best] && (k == "" || s[i] > s[k])) k = i
    if (k == "" || e[k] == e[best]) return s[best]
    t = log(e[k] / wanted) / log(e[k] / e[best])
    return exp(log(s[k]) + t * (log(s[best]) - log(s[k])))
}
function best_of(name, i, best) {
    for (i = 1; i <= m; i++) if (by[i] == name && (!best || e[i] < e[best])) best = i
    return best
}
function beside(name, wanted, t, best) {
    best = best_of(name)
    t = time_for(name, wanted)
    return called(name) (t == "" ? (best ? sprintf(" %.2g %% at best (%.2g s)", e[best], s[best]) : " has no run that ended") \
        : sprintf(" %.2g s", t))
}
function add(to, at) {
    if (at) text = text (text == "" ? "" : ", ") "down to " to " % " called(method[at]) sprintf(" (%.2g s)", time[at])
}
END {
    if (!n || !m) exit
    # the first of the front that is good enough is the fastest of all
    targets = split("20 10 5 2 1 .5 .2 .1", target, " ")
    for (k = 1; k <= targets; k++) {
        for (i = 1; i <= n && error[i] > target[k]; i++);
        if (i > n) break
        if (k > 1 && method[i] != method[was]) add(to, was)
        to = target[k] + 0
        was = i
    }
    add(to, was)
    if (text == "") printf "Nothing has an error of %s of 20 %% or less yet: the least, %.2g %%, is by %s in %.2g s.\n", what, error[n], called(method[n]), time[n]
    else printf "The fastest, by the error of %s: %s; the least of all, %.2g %%, is by %s in %.2g s.\n", what, text, error[n],
        called(method[n]), time[n]
    for (i = 1; i <= m; i++)
        if (by[i] == own "_chosen") {
            printf "The %.2g %% that the default reaches in %.2g s take, by others: %s, %s, %s.\n", e[i], s[i],
                beside("particles", e[i]), beside("paths", e[i]), beside(own "_asked", e[i])
            exit
        }
    printf "The default has no run here that ended, so nothing can be said of what its error takes by others.\n"
}
