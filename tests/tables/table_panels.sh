#!/bin/sh
# table_panels.sh - a scene that links get wrong, as they leave it and mended: the lines that tell of it.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
solve_lines tests/runtime/panels.obj --oracle bf_guarded --basis constant --no-correct
printf '\nWithout `--no-correct` it is mended, whatever the oracle:\n\n'
solve_lines tests/runtime/panels.obj --oracle bf_guarded --basis constant
