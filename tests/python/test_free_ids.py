"""Ids that are given out once: which numbers they get, and how many are tried."""

from __future__ import annotations

import random

import pytest
from kinefab.model import IN_BRACKETS, FreeIds


@pytest.mark.parametrize("form", ["{}#{}", IN_BRACKETS])
def test_an_id_gets_the_first_number_from_two_on_that_is_free(form):
    """As a search from 2 on finds it each time, also where ids with numbers were taken before or are wanted themselves."""
    chosen = random.Random(7)
    names = ["a", "b", *(form.format("a", n) for n in range(2, 9)), form.format(form.format("a", 3), 2)]
    for _ in range(50):
        taken = set(chosen.sample(names, 4))
        free_ids = FreeIds(taken, form)
        for wanted in chosen.choices(names, k=30):
            expected, number = wanted, 2
            while expected in taken:
                expected, number = form.format(wanted, number), number + 1
            taken.add(expected)
            assert free_ids.take(wanted) == expected


def test_an_id_that_thousands_want_is_not_searched_from_the_start():
    """All numbers that were given out were tried again for each, the square of their count: two for each at most are."""
    tried = []

    class Counting(str):
        def format(self, *parts):
            tried.append(parts)
            return str.format(self, *parts)

    free_ids = FreeIds((f"Bolt#{n}" for n in range(2, 5_000)), Counting("{}#{}"))
    assert [free_ids.take("Bolt") for _ in range(5_000)][-1] == "Bolt#9998"
    assert len(tried) == 9_997
