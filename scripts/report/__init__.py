# SPDX-License-Identifier: BSD-3-Clause
"""Measures a recorded performance: its sound, its gesture, its pictures."""
