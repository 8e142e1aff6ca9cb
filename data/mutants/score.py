"""Counts, module by module, how many mutants of the code are found.

    cargo install cargo-mutants
    cargo mutants -o target/mutants/1 -- -- --skip stability::
    cargo mutants -o target/mutants/1 --iterate
    python3 data/mutants/score.py target/mutants/*

Each argument is a folder with `mutants.out` in it. A mutant is found if in one of them
a test failed, or never ended, or if it does not compile. Writes `scores.csv` beside
this file. Survivors stand in `survivors.csv` with the reason; one that does not, a row
that is no survivor, and a mutant that was not tried are named, and nothing is written.
"""
import csv
import pathlib
import subprocess
import sys

home = pathlib.Path(__file__).parent
root = home.parent.parent
found, missed = set(), set()
for folder in sys.argv[1:]:
    for file in (pathlib.Path(folder) / "mutants.out").glob("*.txt"):
        (missed if file.stem == "missed" else found).update(file.read_text().splitlines())


def place(name):
    """(file, line of code, what is done to it) of a mutant's name."""
    file, line, _, what = name.split(":", 3)
    return file, (root / file).read_text().splitlines()[int(line) - 1].strip(), what.strip()


listed = subprocess.run(
    ["cargo", "mutants", "--list"], cwd=root, capture_output=True, text=True, check=True
).stdout.splitlines()
with open(home / "survivors.csv", newline="") as table:
    explained = {(row["file"], row["code"], row["mutant"]) for row in csv.DictReader(table)}
scores, seen, faults = {}, set(), []
for name in listed:
    module = pathlib.Path(name.split(":")[0]).relative_to("src").parts[0].removesuffix(".rs")
    score = scores.setdefault(module, {"mutants": 0, "found": 0, "survived": 0})
    score["mutants"] += 1
    if name in found:
        score["found"] += 1
    elif name in missed:
        score["survived"] += 1
        seen.add(place(name))
        if place(name) not in explained:
            faults.append(f"survived without a reason: {name}")
    else:
        faults.append(f"not tried: {name}")
faults += [f"no survivor: {row}" for row in sorted(explained - seen)]
if faults:
    sys.exit("\n".join(faults))
with open(home / "scores.csv", "w", newline="") as table:
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["module", "mutants", "found", "survived", "found in percent"])
    for module, score in sorted(scores.items()):
        writer.writerow([module, *score.values(), f"{100 * score['found'] / score['mutants']:.1f}"])
