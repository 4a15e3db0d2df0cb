"""A program over COM (pywin32): attached to, never started; busy answers are asked again.  Windows only.

Objects are bound late: a cache of one version's members must not be asked of another's.  What late binding leaves to its caller is
here: objects that a member without arguments has already answered, members that are found by their number alone, and answers that
come back in arrays which the caller hands over (``Handed``).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, cast

from ..diagnostics import KinefabError, Report
from .channel import SET, Live, plainly

NOT_RUNNING = -2147221021
"""MK_E_UNAVAILABLE."""
BUSY = frozenset({-2147418111, -2147417846})
"""RPC_E_CALL_REJECTED and RPC_E_SERVERCALL_RETRYLATER: refused before anything was done."""
PATIENCE, FIRST_PAUSE = 20.0, 0.05
"""Seconds that a busy program is waited for, and before the first try again."""
READ = 2
"""DISPATCH_PROPERTYGET, and the bit of it in a function's INVOKEKIND."""
BY_REFERENCE, VARTYPES = 0x4000, {"long": 3, "longs": 0x2003, "doubles": 0x2005}
"""VT_BYREF; VT_I4, and SAFEARRAYs (VT_ARRAY) of VT_I4 and VT_R8."""
Handed = Mapping[str, tuple[str, ...]]
"""Of a method whose last arguments are where it writes its answer: what each of these is, a word of ``VARTYPES``."""


def attached(
    program: str,
    identifier: str,
    methods: frozenset[str],
    report: Report,
    moniker: str = "",
    handed: Handed | None = None,
    numbers: Mapping[str, int] | None = None,
) -> Live:
    """The running program.  identifier: its ProgID.  moniker: how its name in the table of running objects begins, of a program that
    is there under no ProgID.  handed, numbers: see ``Late``.  Raises KinefabError where there is none."""
    try:
        bridge: Any = import_module("win32com.client.dynamic")
        com: Any = import_module("pythoncom")
    except ImportError:
        place = "" if sys.platform == "win32" else "; it runs on Windows alone"
        raise KinefabError([report.add("CAPTURE_LIBRARY", program=program, place=place)]) from None
    com.CoInitialize()
    try:
        running = com.GetActiveObject(identifier).QueryInterface(com.IID_IDispatch)
    except com.com_error as error:
        running = _listed(com, moniker) if moniker else None
        if running is None:
            detail = "it is not running" if error.hresult == NOT_RUNNING else str(error)
            found = report.add("CAPTURE_NOT_RUNNING", program=program, detail=detail)
            raise KinefabError([found]) from None
    late = Late(bridge.Dispatch, com, handed or {}, numbers or {})
    return Live(bridge.Dispatch(running), methods, patient(com.com_error, time.sleep, late))


def _listed(com: Any, moniker: str) -> Any:
    """The first running object whose name begins so; None where there is none."""
    try:
        table, context = com.GetRunningObjectTable(), com.CreateBindCtx(0)
        for entry in table.EnumRunning():
            if str(entry.GetDisplayName(context, None)).startswith(moniker):
                return table.GetObject(entry).QueryInterface(com.IID_IDispatch)
    except com.com_error:
        return None
    return None


@dataclass(slots=True)
class Late:
    """How members of late bound objects are asked.

    wrap: makes an object of what a call by number returns.  com: the module of pywin32 that has ``Missing``.
    numbers: DISPIDs of members that some objects do not name.
    """

    wrap: Callable[[Any], Any] = field(default=lambda found: found)
    com: Any = None
    handed: Handed = field(default_factory=dict[str, "tuple[str, ...]"])
    numbers: Mapping[str, int] = field(default_factory=dict[str, int])

    def ask(self, target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
        """A member's answer, out of the VARIANT that it may come in."""
        found = self._asked(target, name, arguments)
        return found.value if type(found).__name__ == "VARIANT" else found

    def _asked(self, target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
        if name.endswith(SET):
            return plainly(target, name, arguments)
        try:
            member = getattr(target, name)
        except AttributeError:
            if arguments is not None:
                raise
            return self._by_number(target, name)
        if arguments is None:
            return member
        if not arguments and (hasattr(member, "_oleobj_") or not callable(member)):
            return (
                member  # a method without arguments may be asked as if it were a property: this is its answer
            )
        return self._filled(member, name, arguments) if name in self.handed else member(*arguments)

    def _by_number(self, target: Any, name: str) -> Any:
        """A property by its DISPID, which the object's own type information has, else a known one.  Raises AttributeError."""
        held = cast(Any, getattr(target, "_oleobj_", None))
        if held is None or (number := self._number(held, name)) is None:
            raise AttributeError(name)
        found: Any = held.Invoke(number, 0, READ, True)
        return self.wrap(found) if hasattr(found, "QueryInterface") else found

    def _number(self, held: Any, name: str) -> int | None:
        try:
            info = held.GetTypeInfo()
            for index in range(info.GetTypeAttr().cFuncs):
                described = info.GetFuncDesc(index)
                if described.invkind & READ and info.GetNames(described.memid)[0] == name:
                    return int(described.memid)
        except Exception:  # whatever an object without type information raises
            pass
        return self.numbers.get(name)

    def _filled(self, member: Any, name: str, arguments: tuple[Any, ...]) -> Any:
        """A method that writes its answer into arguments: by its type information, else into variants handed over by reference."""
        words = self.handed[name]
        try:
            empty: list[Any] = [[] if word.endswith("s") else self.com.Missing for word in words]
            return member(*arguments, *empty)
        except Exception as error:
            if getattr(error, "hresult", None) in BUSY:
                raise
        variant: Any = import_module("win32com.client").VARIANT
        starts: list[Any] = [[] if word.endswith("s") else 0 for word in words]
        variants = [variant(BY_REFERENCE | VARTYPES[word], start) for word, start in zip(words, starts)]
        member(*arguments, *variants)
        values = tuple(entry.value for entry in variants)
        return values[0] if len(values) == 1 else values


def patient(
    failure: type[Exception], sleep: Callable[[float], None], late: Late | None = None
) -> Callable[[Any, str, tuple[Any, ...] | None], Any]:
    """How a member is asked: a call that the program rejects while it is busy is made again, ever more slowly."""
    bound = late or Late()

    def call(target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
        pause, waited = FIRST_PAUSE, 0.0
        while True:
            try:
                return bound.ask(target, name, arguments)
            except failure as error:
                if getattr(error, "hresult", None) not in BUSY or waited >= PATIENCE:
                    raise
                sleep(pause)
                waited, pause = waited + pause, min(1.0, pause * 2.0)

    return call
