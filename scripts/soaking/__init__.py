# SPDX-License-Identifier: BSD-3-Clause
"""What `scripts/soak` does to a station, and what it says of it."""
