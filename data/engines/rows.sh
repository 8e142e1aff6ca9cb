#!/bin/sh
# Runs the rows of a study under an engine, waits for them, and merges what they print.
#
#   sh data/engines/rows.sh ENGINE STUDY DIR [ARGUMENTS OF THE STUDY]
#   sh data/engines/rows.sh slurm stability out/stability --scene gravity
#
# ENGINE is parallel, for GNU parallel with a row on each core, or slurm, for one job array of
# Slurm: then every node must see DIR, and SBATCH_PARTITION and so on choose where the jobs
# run. STUDY is trade, choose, methods, gamma, orders or stability. Wants lme-mpm on the PATH. When a
# row fails, nothing is merged; with Slurm its message stands in DIR/rows.
set -eu
engine=$1 study=$2 dir=$3
shift 3
case $engine in
  parallel | slurm) ;;
  *) echo "error: no engine \`$engine\`; allowed: parallel, slurm" >&2; exit 2 ;;
esac
rm -rf "$dir/rows"
mkdir -p "$dir/rows"
lme-mpm "$study" "$@" --list > "$dir/rows.sh"
case $engine in
  parallel) parallel --halt now,fail=1 '{}' '>' "$dir/rows/{#}.csv" < "$dir/rows.sh" ;;
  slurm)
    sbatch --wait --array="1-$(wc -l < "$dir/rows.sh")" --ntasks=1 --job-name="lme-mpm-$study" \
      --output="$dir/rows/%a.csv" --error="$dir/rows/%a.err" \
      --wrap "sed -n \"\${SLURM_ARRAY_TASK_ID}p\" '$dir/rows.sh' | sh"
    ;;
esac
lme-mpm "$study" "$@" --out "$dir" --merge "$dir"/rows/*.csv
