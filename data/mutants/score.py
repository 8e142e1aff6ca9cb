"""Counts, module by module, how many mutants of the code the tests have found.

    cargo install cargo-mutants
    cargo mutants -o target/mutants/1
    cargo mutants -o target/mutants/2 -F 'some of them, with other tests'
    python3 data/mutants/score.py target/mutants/*

Each argument is a folder with `mutants.out` in it; a mutant that was found in one of
them is found. Writes `scores.csv` beside this file. Survivors stand in
`survivors.csv` with the reason; one that does not, or a row that is no survivor, is
named, and nothing is written.
"""
import csv
import pathlib
import subprocess
import sys

home = pathlib.Path(__file__).parent
root = home.parent.parent
found = {}
for folder in sys.argv[1:]:
    for verdict in ("missed", "unviable", "timeout", "caught"):
        file = pathlib.Path(folder) / "mutants.out" / f"{verdict}.txt"
        for name in file.read_text().splitlines():
            found.setdefault(name, set()).add(verdict)


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
    verdicts = found.get(name, set())
    if verdicts & {"caught", "timeout"}:
        score["found"] += 1
    elif "unviable" in verdicts:
        continue  # it does not compile
    elif "missed" in verdicts:
        score["survived"] += 1
        seen.add(place(name))
        if place(name) not in explained:
            faults.append(f"survived without a reason: {name}")
    else:
        faults.append(f"not tried: {name}")
    score["mutants"] += 1
faults += [f"no survivor: {row}" for row in sorted(explained - seen)]
if faults:
    sys.exit("\n".join(faults))
with open(home / "scores.csv", "w", newline="") as table:
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["module", "mutants", "found", "survived", "found in percent"])
    for module, score in sorted(scores.items()):
        writer.writerow([module, *score.values(), f"{100 * score['found'] / score['mutants']:.1f}"])
