"""Counts, module by module, how many mutants of the code are found.

    cargo install cargo-mutants
    cargo mutants -o target/mutants/1 -- -- --skip convergence:: --skip stability:: --skip conservation::
    cargo mutants -o target/mutants/1 --iterate
    python3 data/mutants/score.py target/mutants/*

Each argument is a folder with `mutants.out` in it. A mutant is found if in one of them
a test failed or never ended; one that does not compile counts neither as found nor as
survived. Writes `scores.csv` beside this file. Survivors stand in `survivors.csv` with the reason; one that does not, a row
that is no survivor, and a mutant that was not tried are named, and nothing is written.
"""
import csv
import pathlib
import subprocess
import sys

home = pathlib.Path(__file__).parent
root = home.parent.parent
tried = {"caught": set(), "timeout": set(), "unviable": set(), "missed": set()}
for folder in sys.argv[1:]:
    for outcome, names in tried.items():
        names.update((pathlib.Path(folder) / "mutants.out" / f"{outcome}.txt").read_text().splitlines())


def place(name):
    """(file, line of code, what is done to it) of a mutant's name."""
    file, line, _, what = name.split(":", 3)
    return file, (root / file).read_text().splitlines()[int(line) - 1].strip(), what.strip()


listed = subprocess.run(
    ["cargo", "mutants", "--list"], cwd=root, stdout=subprocess.PIPE, text=True, check=True
).stdout.splitlines()
with open(home / "survivors.csv", newline="") as table:
    explained = {(row["file"], row["code"], row["mutant"]) for row in csv.DictReader(table)}
scores, seen, faults = {}, set(), []
for name in listed:
    module = pathlib.Path(name.split(":")[0]).relative_to("src/method").parts[0].removesuffix(".rs")
    score = scores.setdefault(module, dict.fromkeys(["caught", "timeout", "unviable", "missed"], 0))
    outcome = next((outcome for outcome in tried if name in tried[outcome]), None)
    if outcome is None:
        faults.append(f"not tried: {name}")
        continue
    score[outcome] += 1
    if outcome == "missed":
        seen.add(place(name))
        if place(name) not in explained:
            faults.append(f"survived without a reason: {name}")
faults += [f"no survivor: {row}" for row in sorted(explained - seen)]
if faults:
    sys.exit("\n".join(faults))
with open(home / "scores.csv", "w", newline="") as table:
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["module", "mutants", "a test fails", "never ends", "does not compile",
                     "survived", "found in percent"])
    for module, score in sorted(scores.items()):
        found, total = score["caught"] + score["timeout"], sum(score.values())
        percent = 100 * found / (total - score["unviable"])
        writer.writerow([module, total, *score.values(), f"{percent:.1f}"])
