"""``python -m kinefab``."""

from .cli import main

main()
