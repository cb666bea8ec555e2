# SPDX-License-Identifier: BSD-3-Clause
"""Studies: one simulated cell, run thousands of times with varied numbers, and what held."""
