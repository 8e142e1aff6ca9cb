#!/bin/sh
# Runs the rows of a study under GNU parallel, one for each core, and merges what they print.
#
#   sh data/engines/parallel.sh STUDY DIR [ARGUMENTS OF THE STUDY]
#   sh data/engines/parallel.sh stability out/stability --scene gravity
#
# STUDY is trade, gamma or stability. Wants lme-mpm on the PATH.
set -eu
study=$1 dir=$2
shift 2
rm -rf "$dir/rows"
mkdir -p "$dir/rows"
lme-mpm "$study" "$@" --list > "$dir/rows.sh"
parallel --halt now,fail=1 '{}' '>' "$dir/rows/{#}.csv" < "$dir/rows.sh"
lme-mpm "$study" "$@" --out "$dir" --merge "$dir"/rows/*.csv
