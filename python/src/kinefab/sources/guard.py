"""What a file can make crash, never end or take all memory, in a process of its own, and takes only that process along:
OpenCASCADE, assimp, xacro with the Python in its files.

The child answers piece by piece, so that the caller knows how far it came.  It stays for the next question, since
loading such a library takes longer than a small file.
"""

from __future__ import annotations

import atexit
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from importlib import import_module
from typing import IO, Any

LOADING = 120.0
"""Seconds that a library may take until it is there: the first time, on a busy machine, longer than many a file."""
MOST_QUESTIONS = 200
"""After so many the child is replaced: what a library never frees must not add up."""
GRACE_SECONDS = 2.0
"""After a question's time the child ends by itself, if nobody has ended it."""


class GuardedCrash(Exception):
    """The child ended before it had answered; the text says how."""


class GuardedError(Exception):
    """The question raised an exception in the child; the text is the exception's."""


def command(module: str, function: str) -> list[str]:
    """What starts another Python on a function of a module; it looks for modules where this one does.

    ``-m`` looks in the working folder first, and would run a ``numpy.py`` that came there with somebody's files.
    """
    paths = [entry or "." for entry in sys.path]
    call = f"import sys; sys.path[:] = {paths!a}; from {module} import {function}; {function}()"
    return [sys.executable, "-c", call]


class _Child:
    def __init__(self) -> None:
        self.process = subprocess.Popen(
            command(__name__, serve.__name__),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self.questions = 0

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()


_idle: list[_Child] = []


def guarded(module: str, function: str, *arguments: object, seconds: float) -> Iterator[Any]:
    """What the generator ``module.function(*arguments)`` yields, run in the child.

    module: dotted, absolute.  arguments and answers are pickled.  seconds: for all answers together, from when the module
    is loaded.
    Raises GuardedError where the generator raises, GuardedCrash where the child dies or takes longer.
    """
    child = _idle.pop() if _idle else _Child()
    late = threading.Event()

    def stop() -> None:
        late.set()
        child.process.kill()

    def timed(limit: float) -> threading.Timer:
        timer = threading.Timer(limit, stop)
        timer.daemon = True
        timer.start()
        return timer

    limit = LOADING
    timer = timed(limit)
    answered = False
    try:
        sent, received = child.process.stdin, child.process.stdout
        assert sent is not None and received is not None
        pickle.dump((seconds, module, function, arguments), sent)
        sent.flush()
        while True:
            word, value = pickle.load(received)
            if word == "loaded":
                timer.cancel()
                limit = seconds
                timer = timed(limit)
                continue
            if word == "answer":
                yield value
                continue
            answered = True
            if word == "error":
                raise GuardedError(value)
            return
    except (EOFError, OSError, pickle.UnpicklingError):
        code = child.process.wait()
        detail = f"it took longer than {limit:g} s" if late.is_set() else f"it ended with code {code}"
        raise GuardedCrash(detail) from None
    finally:
        timer.cancel()
        child.questions += 1
        if answered and not late.is_set() and child.questions < MOST_QUESTIONS:
            _idle.append(child)
        else:
            child.end()


@atexit.register
def end_idle() -> None:
    """End the children that wait for a question; the next one starts anew."""
    while _idle:
        _idle.pop().end()


def _answer(questions: IO[bytes], answers: IO[bytes]) -> None:
    """The child's life: questions until there are no more."""
    while True:
        try:
            seconds, module, function, arguments = pickle.load(questions)
        except EOFError:
            return
        _end_after(LOADING + GRACE_SECONDS)
        try:
            asked = getattr(import_module(module), function)
            _end_after(seconds + GRACE_SECONDS)
            pickle.dump(("loaded", None), answers)
            answers.flush()
            for value in asked(*arguments):
                pickle.dump(("answer", value), answers, pickle.HIGHEST_PROTOCOL)
                answers.flush()
            last = ("end", None)
        except MemoryError:
            last = ("error", "out of memory")
        # Whatever the library raises is an answer, of which the caller makes a finding.
        except Exception as error:
            sentence = isinstance(error, ValueError) and str(error)  # what a reader itself refuses
            last = ("error", sentence or f"{type(error).__name__}: {error}")
        pickle.dump(last, answers)
        answers.flush()
        _end_after(0.0)


def _end_after(seconds: float) -> None:
    """Have the system end this process, even amid a native call: whoever asked may be gone by then.  0: have it live on."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds)


def serve() -> None:
    """What the child runs."""
    # Libraries print on standard output: the answers get a descriptor of their own.
    answers = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    _answer(sys.stdin.buffer, answers)
