# SPDX-License-Identifier: BSD-3-Clause
"""What a batch costs beside the same calls in C++."""

from bench import compared
from problem import Problem


def test_a_pair_of_a_batch_costs_little_more_than_in_cpp(loop, tmp_path):
    # By turns, the least of each: whoever else uses the machine disturbs both alike.
    problem = Problem(1, shapes=200, pairs=10_000, room=0.5)
    for _ in range(5):
        python, cpp = compared(loop, problem, tmp_path, rounds=3)
        if python <= 1.3 * cpp:
            break
    assert python <= 1.3 * cpp
