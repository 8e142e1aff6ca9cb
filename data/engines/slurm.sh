#!/bin/sh
# Runs the rows of a study as one job array of Slurm, waits for it, and merges what they print.
#
#   sh data/engines/slurm.sh STUDY DIR [ARGUMENTS OF THE STUDY]
#   sh data/engines/slurm.sh stability out/stability --scene gravity
#
# STUDY is trade, gamma or stability. Wants lme-mpm on the PATH, and DIR where every node
# sees it. SBATCH_PARTITION and so on choose where the jobs run. A row that fails leaves its
# message in DIR/rows, and then nothing is merged.
set -eu
study=$1 dir=$2
shift 2
rm -rf "$dir/rows"
mkdir -p "$dir/rows"
lme-mpm "$study" "$@" --list > "$dir/rows.sh"
count=$(wc -l < "$dir/rows.sh")
sbatch --wait --array="1-$count" --ntasks=1 --job-name="lme-mpm-$study" \
  --output="$dir/rows/%a.csv" --error="$dir/rows/%a.err" \
  --wrap "sed -n \"\${SLURM_ARRAY_TASK_ID}p\" '$dir/rows.sh' | sh"
lme-mpm "$study" "$@" --out "$dir" --merge "$dir"/rows/*.csv
