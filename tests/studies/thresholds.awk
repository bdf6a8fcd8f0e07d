# thresholds.awk - of an oracle's graph, by lines, the parameters that --accuracy scales, as options of solve: `--set NAME=VALUE`
# with the default times SCALE, within its range. The smallest part only falls.
# SPDX-License-Identifier: MIT
/^ *param .* role (link_threshold|relative_error_tolerance|relative_power_tolerance|smallest_part) / {
    name = $2
    sub(/:.*/, "", name)
    line = $0
    sub(/^[^=]*= */, "", line)
    value = line + 0
    range = line
    if (sub(/^[^[]*in \[ */, "", range)) {
        low = range + 0
        sub(/^[^,]*, */, "", range)
        high = range ~ /^inf/ ? 1e300 : range + 0
    } else {
        low = 0
        high = 1e300
    }
    scale = SCALE
    if ($0 ~ / role smallest_part / && scale > 1)
        scale = 1
    value *= scale
    value = value < low ? low : value > high ? high : value
    printf "--set %s=%.6g ", name, value
}
