"""A program over COM (pywin32): attached to, never started; busy answers are asked again.  Windows only."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any

from ..diagnostics import KinefabError, Report
from .channel import SET, Live, plainly

NOT_RUNNING = -2147221021
"""MK_E_UNAVAILABLE."""
BUSY = frozenset({-2147418111, -2147417846})
"""RPC_E_CALL_REJECTED and RPC_E_SERVERCALL_RETRYLATER: refused before anything was done."""
PATIENCE, FIRST_PAUSE = 20.0, 0.05
"""Seconds that a busy program is waited for, and before the first try again."""


def attached(program: str, identifier: str, methods: frozenset[str], report: Report) -> Live:
    """The running program.  identifier: its ProgID.  Raises KinefabError where there is none."""
    try:
        bridge: Any = import_module("win32com.client.dynamic")
        com: Any = import_module("pythoncom")
    except ImportError:
        place = "" if sys.platform == "win32" else ", on Windows"
        raise KinefabError([report.add("CAPTURE_LIBRARY", program=program, place=place)]) from None
    com.CoInitialize()
    try:
        running = com.GetActiveObject(identifier).QueryInterface(com.IID_IDispatch)
    except com.com_error as error:
        detail = "it is not running" if error.hresult == NOT_RUNNING else str(error)
        found = report.add("CAPTURE_NOT_RUNNING", program=program, detail=detail)
        raise KinefabError([found]) from None
    return Live(bridge.Dispatch(running), methods, patient(com.com_error, time.sleep))


def patient(
    failure: type[Exception], sleep: Callable[[float], None]
) -> Callable[[Any, str, tuple[Any, ...] | None], Any]:
    """How a member is asked: a call that the program rejects while it is busy is made again, ever more slowly."""

    def call(target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
        pause, waited = FIRST_PAUSE, 0.0
        while True:
            try:
                if arguments is None or name.endswith(SET):
                    return plainly(target, name, arguments)
                # Bound late, a method without arguments is asked as if it were a property.
                member = getattr(target, name)
                return member(*arguments) if callable(member) else member
            except failure as error:
                if getattr(error, "hresult", None) not in BUSY or waited >= PATIENCE:
                    raise
                sleep(pause)
                waited, pause = waited + pause, min(1.0, pause * 2.0)

    return call
