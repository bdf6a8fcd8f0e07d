#!/bin/sh
# table_accuracy.sh - what a run says that was asked for an accuracy.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
solve_lines tests/runtime/panels.obj --accuracy 0.5%
