"""The command line: a thin layer, a file a command, over what scripts call too.

Logs go to stderr, data to stdout; exit 0 done, 1 errors found, 2 wrong usage.  What takes long to import is imported
inside the commands.
"""

from __future__ import annotations

from .program import app, main

__all__ = ["app", "main"]
