# SPDX-License-Identifier: BSD-3-Clause
"""Studies: one simulated cell, run thousands of times with varied numbers, and what held."""

from .plan import Study, load_study

__all__ = ["Study", "load_study"]
