"""What the scripts of results/ share: runs (geoprior_results, which also stands alone), and files of their own."""

import hashlib
import os
import signal
import sys
import traceback
from pathlib import Path

from geoprior_results import reading
from geoprior_results.folder import RunError as RunFileError
from geoprior_results.folder import path_below, require_regular_file
from geoprior_results.model import WHOLE_PROCESS, Claim, Ratio, Study  # noqa: F401
from geoprior_results.reading import text  # noqa: F401
from geoprior_results.texts import printable

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def read_run(place, force=False, claims_cases=False):
    """As `geoprior_results.open_run`, but without the cases that are there for claims only."""
    return reading.read_run(place, force, claims_cases, forced_by="--force")


def read_artifact(run, name, sha256):
    """The bytes of a recorded file, which are what was recorded unless the run is read with force.
    Raises RunFileError naming the file."""
    path = path_below(run.folder, name)
    require_regular_file(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise RunFileError(f"{path}: cannot be read ({error.strerror})") from error
    if not run.force and hashlib.sha256(content).hexdigest() != sha256:
        raise RunFileError(f"{path}: is damaged or another file: its SHA-256 is not the recorded one "
                           "(allowed: the file as the run wrote it, or --force)")
    return content


def write_atomically(path, content):
    """Writes text or bytes as temporary + rename; what stands at either name is not written through."""
    path = Path(path)
    require_regular_file(path)  # a pipe or a device would be replaced by a file
    temporary = path.with_name(path.name + ".geoprior-tmp")
    try:
        temporary.unlink(missing_ok=True)
        with temporary.open("xb") as file:
            file.write(content if isinstance(content, bytes) else content.encode("utf-8", errors="backslashreplace"))
        temporary.replace(path)
    except OSError as error:
        raise RunFileError(f"{path}: cannot be written ({error.strerror or error})") from error
    finally:  # also when a signal ends the script
        temporary.unlink(missing_ok=True)


def defect_line(error):
    """One line of what broke a script that should have refused its input: on which files, where."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    reason = " ".join(str(error).split())
    files = ", ".join(a for a in sys.argv[1:] if not a.startswith("-"))
    return (f"{files}: cannot be shown ({type(error).__name__}{': ' if reason else ''}{reason}, at "
            f"{Path(place.filename).name}:{place.lineno}; GEOPRIOR_DEBUG=1 shows the whole trace)")


def add_force(parser):
    parser.add_argument("--force", action="store_true",
                        help="read a run whose checksum is missing or wrong")


def run_main(main):
    """Runs a script's main: one line on stderr and exit code 2 for whatever breaks it, and no file
    left half-written by a signal."""
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    sys.stdout.reconfigure(errors="backslashreplace")
    try:
        sys.exit(main(sys.argv[1:]))
    except RunFileError as error:
        print(printable(str(error)), file=sys.stderr)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
    except Exception as error:
        if os.environ.get("GEOPRIOR_DEBUG"):
            raise
        print(printable(defect_line(error)), file=sys.stderr)
    sys.exit(2)
