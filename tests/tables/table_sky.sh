#!/bin/sh
# table_sky.sh - a room under a sky, which paths tell for less than particles.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
solve_lines tests/runtime/sky_room.obj
