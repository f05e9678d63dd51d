"""Many blind sets: what was hidden against what was found, false alarms, coverage of intervals, power.

Usage: python tests/bench/bench_blind.py --sets 20 [--effects slip thickness null-scatter] [--jobs 2]
           [--noise 1 2] [--points 50 200] [--results blind.jsonl] [--report]
A line per set is appended to the results file as it is done; sets that are in it already are not done again, so a
run can be stopped and taken up. --report prints the tables of the file and runs nothing. A set takes 5 to 60 s.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from collections import Counter, defaultdict
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

NULLS = {
    "null-noise": {"effect": "none", "scatter": 0.0, "outliers": 0.0},
    "null-scatter": {"effect": "none", "scatter": 0.5, "outliers": 0.0},
    "null-placement": {"effect": "placement", "scatter": 0.0, "outliers": 0.0},
    "null-outliers": {"effect": "none", "scatter": 0.0, "outliers": 0.04},
}
"""Sets without an effect, by what could be taken for one."""
KEY = ("kind", "seed", "noise", "points")


def run_set(kind, seed, noise, points):
    """Make a set, diagnose it, grade it: the row of the results file."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    import geomdrap as gd
    from geomdrap.blind import grade, make, parameters, read_seal, unseal
    from geomdrap.cli.blind import _read

    options = NULLS.get(kind, {"effect": kind})
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        path = make(seed, folder=folder, noise=noise, points=points, **options)
        made = time.process_time() - start
        seal = read_seal(path)
        solved = gd.diagnose(**_read(path))
        diagnosis = solved.as_dict()
        truth = unseal(path)
    told = grade(truth["answer"], diagnosis["verdict"], diagnosis["candidates"])
    return {
        **dict(zip(KEY, (kind, seed, noise, points), strict=True)),
        "seal": seal,
        "part": truth["part"],
        "hidden": truth["answer"],
        "signal_to_noise": truth["signal_to_noise"],
        "scatter": truth["scatter"],
        "outliers": len(truth["outliers"]),
        "marks": truth["marks"],
        "found": diagnosis["verdict"],
        "candidates": diagnosis["candidates"],
        "confidence": diagnosis["confidence"],
        "grade": told,
        "error": round(solved.steps[-1].error, 3),
        "noise_floor": diagnosis["noise_floor"],
        "leftover": diagnosis["leftover"],
        "parameters": parameters(truth, diagnosis),
        "make_s": round(made, 2),
        "solve_s": round(time.process_time() - start - made, 2),
    }


def failed(key, error):
    """The row of a set that could not be made or diagnosed: it counts, as an error."""
    row = dict(zip(KEY, key, strict=True))
    return {**row, "hidden": row["kind"], "found": "error", "grade": "error", "error": f"{type(error).__name__}: {error}"}


def read_rows(path):
    """The rows of the results file, without a last line that was cut off."""
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            rows.append(json.loads(line))
        except json.JSONDecodeError:
            print(f"{path}: a line was cut off and is done again", file=sys.stderr)
    return rows


def run(keys, jobs, path):
    """Do the sets ``keys`` in worker processes and append their rows."""
    done = {tuple(row[name] for name in KEY) for row in read_rows(path)}
    left = [key for key in keys if key not in done]
    print(f"{len(keys) - len(left)} of {len(keys)} sets are done already", file=sys.stderr)
    start = time.monotonic()
    with ProcessPoolExecutor(jobs) as pool, path.open("a", encoding="utf-8") as file:
        tasks = {pool.submit(run_set, *key): key for key in left}
        for n, task in enumerate(as_completed(tasks), 1):
            try:
                row = task.result()
            except Exception as error:
                row = failed(tasks[task], error)
            file.write(json.dumps(row) + "\n")
            file.flush()
            rest = (time.monotonic() - start) / n * (len(left) - n)
            print(f"{n}/{len(left)} {row['kind']} {row['seed']}: {row['found']}, {row['grade']}; {rest:.0f} s left", file=sys.stderr)


def confusion(rows):
    """Table of hidden against found."""
    found = sorted({row["found"] for row in rows})
    counts = defaultdict(Counter)
    for row in rows:
        counts[row["kind"]][row["found"]] += 1
    width = max(map(len, counts)) + 2
    lines = ["hidden".ljust(width) + "  ".join(found)]
    for kind in sorted(counts):
        lines.append(kind.ljust(width) + "  ".join(str(counts[kind][f] or ".").rjust(len(f)) for f in found))
    return lines


def shares(rows, by, good):
    """Lines: value of ``by(row)``, sets, and the share for which ``good(row)``."""
    groups = defaultdict(list)
    for row in rows:
        groups[by(row)].append(good(row))
    return [f"  {key!s:34} {len(group):4}  {sum(group) / len(group):6.1%}" for key, group in sorted(groups.items())]


def is_right(row):
    """Whether the verdict was right, or ambiguous with the truth among its candidates."""
    return row["grade"] in ("right", "among the candidates")


def strength(row):
    """The signal-to-noise ratio in classes a factor of two wide."""
    edges = [0, 5, 10, 20, 40, 80, 160]
    low = max(e for e in edges if e <= row["signal_to_noise"])
    return f"{low:4} to {2 * low or 5}" if low < edges[-1] else f"{low:4} and more"


def report(rows):
    """All tables as text."""
    solved = [row for row in rows if row["grade"] != "error"]
    nulls = [row for row in rows if row["kind"] in NULLS]
    effects = [row for row in solved if row["kind"] not in NULLS and row["signal_to_noise"] > 0.0]
    covered = [p for row in effects if is_right(row) for p in row["parameters"] if p["off"] is not None]
    lines = [f"{len(rows)} sets, {len(rows) - len(solved)} errors", "", *confusion(rows), "", "right, or ambiguous with the truth"]
    lines += shares(rows, lambda row: row["kind"], is_right)
    lines += ["", "false alarms (an effect named, or offered as a candidate)"]
    lines += shares(nulls, lambda row: row["kind"], lambda row: row["grade"] == "false alarm")
    lines += ["", "wrong effect named where one was hidden"]
    lines += shares(effects, lambda row: "all", lambda row: row["grade"] in ("wrong", "partly"))
    lines += ["", "truth within the 95 % interval, of what was found"]
    lines += shares(covered, lambda p: f"{p['effect']}: {p['parameter']}", lambda p: abs(p["off"]) <= 1.96)
    for title, by in (("signal to noise", strength), ("noise", lambda r: r["noise"]), ("marks asked for", lambda r: r["points"] or 0)):
        lines += ["", f"power by {title}", *shares(effects, by, is_right)]
    seconds = [[row[name] for row in solved] for name in ("make_s", "solve_s")]
    if solved:
        lines += ["", "CPU s per set: make {:.1f} (most {:.1f}), solve {:.1f} (most {:.1f})".format(
            *(f for s in seconds for f in (sum(s) / len(s), max(s)))
        )]
    return "\n".join(lines)


def main():
    """Read the options, run what is not done, print the tables."""
    from geomdrap.blind import HIDDEN

    kinds = [*NULLS, *HIDDEN]
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--sets", type=int, default=5, help="sets of each kind (default 5)")
    options.add_argument("--effects", nargs="+", choices=kinds, default=kinds, metavar="KIND", help=", ".join(kinds))
    options.add_argument("--noise", nargs="+", type=float, default=[1.0])
    options.add_argument("--points", nargs="+", type=int, default=[None])
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--first-seed", type=int, default=1000)
    options.add_argument("--results", type=Path, default=Path("blind.jsonl"))
    options.add_argument("--report", action="store_true", help="print the tables of the results file alone")
    asked = options.parse_args()
    seeds = range(asked.first_seed, asked.first_seed + asked.sets)
    keys = [(k, s, n, p) for s in seeds for n in asked.noise for p in asked.points for k in asked.effects]
    if not asked.report:
        run(keys, asked.jobs, asked.results)
    print(report(read_rows(asked.results)))


if __name__ == "__main__":
    main()
