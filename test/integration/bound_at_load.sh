#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Each of these libraries and programs has all its symbols looked up when it is loaded, and no memory of
# its own for threads that would be allocated when one first looks at it.
# usage: bound_at_load.sh FILE...
set -euo pipefail

[ $# -gt 0 ] || { echo "no files" >&2; exit 1; }
status=0
for file in "$@"; do
  own_of_threads='DTPMOD|TLSDESC'
  if readelf --wide --relocs "$file" | grep -E "$own_of_threads" | grep -vq '@'; then
    echo "$file allocates memory of threads while it runs" >&2; status=1
  fi
  dynamic=$(readelf --dynamic "$file")
  [[ $dynamic == *"(FLAGS)"*BIND_NOW* ]] || { echo "$file looks symbols up while it runs" >&2; status=1; }
done
exit "$status"
