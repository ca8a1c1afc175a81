# SPDX-License-Identifier: BSD-3-Clause
# What the scripts of this folder share. To be sourced, by bash, after `set -euo pipefail`.

# Debian's python first: another one on the path knows nothing of catkin.
export PATH="/usr/bin:/bin:$PATH"
export PYTHONDONTWRITEBYTECODE=1
unset PYTHONHOME CDPATH
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)  # CMake and ROS must see one name for it

say() { printf '%s\n' "$*"; }
warn() { printf 'warning: %s\n' "$*" >&2; }
die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# From here on ROS finds the package of a devel or install space.
source_space() { # SETUP_FILE
  [ -f "$1" ] || die "$1 is not there: run scripts/build first"
  set +eu  # catkin's file knows neither
  # shellcheck disable=SC1090
  source "$1"
  set -eu
}

# Installs and builds what plays, and lets ROS find it. ERGOTIC_SPACE is the setup.bash of a space that is
# to be taken as it is.
prepare_space() {
  if [ -z "${ERGOTIC_SPACE:-}" ]; then
    "$root/scripts/install_deps"
    "$root/scripts/build" --target play
  fi
  source_space "${ERGOTIC_SPACE:-$root/devel/setup.bash}"
}

# Waits until a command succeeds. Each try has to be short; returns 1 when the time is over.
wait_until() { # SECONDS COMMAND...
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || return 1
    sleep 0.2
  done
}
