#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Each of these libraries and programs has all its symbols looked up when it is loaded.
# usage: bound_at_load.sh FILE...
set -euo pipefail

[ $# -gt 0 ] || { echo "no files" >&2; exit 1; }
status=0
for file in "$@"; do
  dynamic=$(readelf --dynamic "$file")
  [[ $dynamic == *"(FLAGS)"*BIND_NOW* ]] || { echo "$file looks symbols up while it runs" >&2; status=1; }
done
exit "$status"
