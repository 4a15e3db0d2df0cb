"""The program: its commands, and how it ends where nobody takes its output."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
from typing import Any, NoReturn

import typer
import typer.core

from .. import __version__
from . import console
from .analyse import analyse
from .batch import batch
from .bundle import bundle_commands
from .capture import capture_commands
from .export import export
from .inspect import inspect
from .mates import mates
from .views import draw, report, view

# typer before 0.12 dresses help and errors in rich's boxes wherever rich is there, whatever rich_markup_mode says: sentences
# end in the middle, and a shell cannot search them.
if hasattr(typer.core, "rich"):
    typer.core.rich = None

app = typer.Typer(
    name="kinefab",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # importing rich for the help alone takes longer than all the rest
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(asked: bool) -> None:
    if asked:
        typer.echo(f"kinefab {__version__}")
        raise typer.Exit()


@app.callback()
def _common(
    version: bool = typer.Option(
        False, "--version", callback=_show_version, is_eager=True, help="Show the version."
    ),
    verbose: bool = typer.Option(
        False, "--verbose", "-v", help="Show remarks too, not only warnings and errors."
    ),
    quiet: bool = typer.Option(False, "--quiet", "-q", help="Show errors only."),
) -> None:
    """Carry a mechanism out of CAD into Unity, moving as it moved in CAD."""
    console.verbosity = 1 if verbose else -1 if quiet else 0


for command in (export, analyse, mates, inspect, draw, report, view, batch):
    app.command()(command)
app.add_typer(capture_commands())
app.add_typer(bundle_commands())


def _start_light() -> None:
    """Leave out what would be a sixth of a small export's time, and brings nothing to a process that does one thing and ends."""
    # Matrices are small here, and BLAS starts and ends its threads whether it has work for them or not.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Nearly all that imports make stays: it need not be searched for cycles again and again, nor at the end.
    gc.set_threshold(50_000, 20, 50)
    atexit.register(gc.freeze)


def _end(number: int, _: object) -> NoReturn:
    sys.exit(128 + number)


def _end_in_order() -> None:
    """Whoever presses Ctrl+C, stops a job in CI or closes a terminal: what is half written goes, and what works beside."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        taken = (signal.SIG_DFL, signal.default_int_handler)  # Python's own for Ctrl+C ends in click's exit status 1
        if number is not None and signal.getsignal(number) in taken:  # nohup has it ignored
            signal.signal(number, _end)


def main() -> None:
    """The program, once all is imported."""
    _start_light()
    _end_in_order()
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        # Closed by whoever started this; each takes the number of its own again.
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))
    reconfigure: Any = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:  # a name may hold letters that a terminal has not
        reconfigure(errors="backslashreplace")
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except BrokenPipeError:  # whoever reads has enough; nothing more is to be flushed at the end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        typer.echo(f"kinefab: the output cannot be written: {error.strerror or error}", err=True)
        sys.exit(1)
