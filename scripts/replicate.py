#!/usr/bin/python3
"""Makes the figures of the thesis again, one after the other, and writes down what became of each.

    scripts/replicate.py                        every experiment that is of a figure (docs/replicability.md)
    scripts/replicate.py 3.2 sketch/boot        the experiments of a figure, or these
    scripts/replicate.py --quick --out DIR      the small versions; default of DIR: build/replicated

DIR/<experiment>/ is the folder of the run; DIR/replicate.md and DIR/replicate.json say of each its command, exit code, times,
peak memory, content_sha256, and which claims held. What fails is written down, and the next one begins. Ctrl-C ends it: the
same command goes on where it stopped, and leaves what is done. Needs the program (scripts/setup.sh, scripts/build.sh).

Exit codes: 0 all done, 1 a claim fell short, 2 wrong use, or stopped, 3 a run failed.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.dont_write_bytecode = True  # no __pycache__ in the clone
sys.path.insert(0, str(REPOSITORY / "results"))

import records  # noqa: E402
from geoprior_results import RunError, open_run  # noqa: E402
from markdown_text import code, table  # noqa: E402
from replicability import figure_key  # noqa: E402
from runfile import run_main, write_atomically  # noqa: E402
from wording import outcome_words, with_unit  # noqa: E402

FINISHED = (0, 1)  # exit codes of `geoprior run`: 1 where a claim fell short


class Stop:
    """Ctrl-C or a termination asks the running program to stop, which leaves a run that can be resumed."""

    def __init__(self):
        self.asked, self.child = False, None
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self.ask)

    def ask(self, number, frame):
        self.asked = True
        if self.child:
            self.child.send_signal(signal.SIGINT)


def experiments_of_figures(program):
    """(figure, experiment) of all that the program has, in the order of the thesis."""
    try:
        listed = subprocess.run([program, "list", "--json"], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise RunError(f"{program}: does not list its experiments ({error}; scripts/build.sh release geoprior makes it, "
                       "--geoprior names another)") from error
    found = [(e["figure"], e["id"]) for e in json.loads(listed)["experiments"] if e["figure"]]
    return sorted(found, key=lambda pair: (figure_key(pair[0]), pair[1]))


def chosen_of(known, names):
    """Those that are named by figure (3.11 is both of its sides) or identifier; without names all."""
    for name in names:
        if not any(name in (figure, figure.split()[0], experiment) for figure, experiment in known):
            raise RunError(f"'{name}' is no figure with an experiment, and no experiment of a figure (allowed: "
                           f"{', '.join(dict.fromkeys(figure for figure, _ in known))}, or an identifier)")
    return [(figure, experiment) for figure, experiment in known
            if not names or any(name in (figure, figure.split()[0], experiment) for name in names)]


def require_writable(folder):
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f"replicate-{os.getpid()}.geoprior-tmp"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise RunError(f"{folder}: cannot be written into ({error.strerror}; allowed: a folder, with --out)") from error


def outcome_of(folder, published):
    """What the run says of itself, or why it says nothing."""
    try:
        run = open_run(folder)
    except RunError as error:
        return {"problem": str(error)}
    return {"content_sha256": run.content_sha256, "as_published": run.content_sha256 == published,
            "commit": run.provenance.get("git_commit", ""), "processor": run.provenance.get("cpu", ""),
            "claims": outcome_words(run.claims),
            "not_held": sorted({claim.text for claim in run.claims if claim.outcome != "holds"})}


def replicate(command, folder, stop):
    """Runs the command; its exit code and what it used, with the runs that it made first."""
    resume = ["--resume"] if (folder / "journal.jsonl").exists() else []
    begin = time.monotonic()
    with open(folder.with_name(folder.name + ".txt"), "wb") as said:  # a session of its own: one Ctrl-C, from Stop
        child = stop.child = subprocess.Popen(command + resume, stdout=said, stderr=said, start_new_session=True)
        if stop.asked:
            child.send_signal(signal.SIGINT)
        _, status, usage = os.wait4(child.pid, 0)
        stop.child = None
        child.returncode = os.waitstatus_to_exitcode(status)
    return {"exit_code": child.returncode, "wall_s": round(time.monotonic() - begin, 2), "resumed": bool(resume),
            "processor_s": round(usage.ru_utime + usage.ru_stime, 2), "peak_memory_bytes": usage.ru_maxrss * 1024}


def read_log(path, quick):
    """experiment: its entry of an earlier call, of runs of that size."""
    if not path.exists():
        return {}
    try:
        log = json.loads(path.read_text(encoding="utf-8"))
        if log["quick"] != quick:
            raise RunError(f"{path}: is of {'quick' if log['quick'] else 'full'} runs (allowed: a folder of its own for "
                           "each size, with --out)")
        return {entry["experiment"]: entry for entry in log["runs"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise RunError(f"{path}: is no log of replicate.py ({type(error).__name__}: {error})") from error


def markdown(entries):
    head = ["figure", "command", "exit code", "wall time", "processor time", "peak memory", "claims", "content_sha256"]
    rows = [[e["figure"], code(" ".join(e["command"])), str(e["exit_code"]), with_unit(e["wall_s"], "s"),
             with_unit(e["processor_s"], "s"), with_unit(e["peak_memory_bytes"], "B"), e.get("claims", e.get("problem", "")),
             f"`{e['content_sha256'][:12]}`" + (" as published" if e["as_published"] else "") if "claims" in e else "–"]
            for e in entries]
    missed = [f"- `{e['experiment']}`: {text}" for e in entries for text in e.get("not_held", [])]
    return "\n".join(["# What was replicated", "", *table(head, rows), "",
                      *(["Claims that fall short, or are not told apart, in a case at least:", "", *missed] if missed else [])])


def write_log(out, quick, entries):
    ordered = sorted(entries.values(), key=lambda e: (figure_key(e["figure"]), e["experiment"]))
    log = {"schema_version": 1, "quick": quick, "runs": ordered}
    write_atomically(out / "replicate.json", json.dumps(log, indent=1, ensure_ascii=False) + "\n")
    write_atomically(out / "replicate.md", markdown(ordered) + "\n")


def is_done(entry, folder):
    return entry is not None and entry["exit_code"] in FINISHED and (folder / "run.h5").is_file()


def replicate_all(chosen, options, entries, stop):
    """Runs what is not done; writes the log after each."""
    published = {name: record.content_sha256 for name, record in records.read_records(REPOSITORY).items()}
    for i, (figure, experiment) in enumerate(chosen):
        folder = options.out / experiment
        place = f"[{i + 1}/{len(chosen)}] {figure:12} {experiment}"
        if is_done(entries.get(experiment), folder):
            print(f"{place}: done before", flush=True)
            continue
        print(f"{place} …", flush=True)
        folder.parent.mkdir(parents=True, exist_ok=True)
        command = [str(options.geoprior), "run", experiment, *(["--quick"] if options.quick else []), "--out", str(folder)]
        entry = {"figure": figure, "experiment": experiment, "command": command, **replicate(command, folder, stop)}
        if entry["exit_code"] in FINISHED:
            entry |= outcome_of(folder, published.get(experiment))
        else:
            entry["problem"] = "stopped" if stop.asked else f"failed: {folder}.txt has its words"
        entries[experiment] = entry
        write_log(options.out, options.quick, entries)
        print(f"    {entry.get('claims', entry.get('problem'))}: {with_unit(entry['wall_s'], 's')}, "
              f"{with_unit(entry['peak_memory_bytes'], 'B')}", flush=True)
        if stop.asked:
            return


def exit_code_of(codes):
    """That of the worst: a failed run before a claim that fell short."""
    return 3 if any(code not in FINISHED for code in codes) else max(codes, default=0)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="figure or experiment (default: all)")
    parser.add_argument("--quick", action="store_true", help="the small versions, as tests run them")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build/replicated", help="where runs and log lie")
    parser.add_argument("--geoprior", type=Path, default=REPOSITORY / "build/release/geoprior", help="the program")
    options = parser.parse_args(arguments)
    chosen = chosen_of(experiments_of_figures(options.geoprior), options.names)
    require_writable(options.out)
    entries, stop = read_log(options.out / "replicate.json", options.quick), Stop()
    replicate_all(chosen, options, entries, stop)
    print(options.out / "replicate.md")
    if stop.asked:
        print("stopped: the same command goes on", file=sys.stderr)
        return 2
    return exit_code_of([entries[experiment]["exit_code"] for _, experiment in chosen])


if __name__ == "__main__":
    run_main(main)
