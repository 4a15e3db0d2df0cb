"""The program: ``kinefab``, and ``python -m kinefab``."""

from __future__ import annotations

import signal


def main() -> None:
    """Entry point.  Until all is imported there is nothing to be put in order, and Ctrl+C ends the process at once."""
    # A job in the background has it ignored.
    taken = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if taken:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .cli import main as run

    if taken:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    run()


if __name__ == "__main__":
    main()
