#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# roslaunch, rosrun and `rosbag record -a` work from the devel space and from an install space.
# usage: spaces.sh BUILD_DIR DEVEL_DIR
set -euo pipefail
build=$1 devel=$2
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib.sh"
source "$root/scripts/processes.sh"
clean_up_at_exit

unset ROS_PACKAGE_PATH CMAKE_PREFIX_PATH

# All that follows has to work for whoever sources SETUP, wherever this source tree is.
try_space() { # NAME SETUP
  local name=$1 station recorder
  source_space "$2"
  cd "$logs"
  [[ $(roslaunch --files ergotic station.launch) == *station.launch ]] ||
    die "$name: roslaunch does not find station.launch"
  [[ $'\n'$(roslaunch --nodes ergotic station.launch)$'\n' == *$'\n'/station$'\n'* ]] ||
    die "$name: station.launch starts no /station"
  local library
  for library in $(sed -n 's/.*<library path="\([^"]*\)".*/\1/p' "$(rospack find ergotic)"/*_plugins.xml); do
    [ -e "$(dirname "$2")/$library.so" ] || die "$name: there is no $library, which a plugin is in"
  done
  local model
  model="$(rospack find ergotic)/models/string.yaml"
  rosrun ergotic check "$model" >/dev/null || die "$name: check refuses the default model"
  rosrun ergotic render "$model" --seconds 0.1 --out "$logs/$name.wav" ||
    die "$name: render does not render"
  [ -s "$logs/$name.wav" ] || die "$name: render wrote nothing"

  start_private_master || die "$name: no ROS master"
  spawn "$name-bag" rosbag record --all --output-name="$logs/$name.bag"
  recorder=$spawned
  spawn "$name-station" roslaunch ergotic station.launch rviz:=false jack:=none \
    record:="$logs/$name's \"a\" take"
  station=$spawned
  plays() { timeout 10 rostopic echo -n 1 /station/gesture/first_tick; }
  wait_until 40 plays || die "$name: the station does not tick"
  local maps
  maps="/proc/$(rosnode info /station | sed -n 's/^Pid: *//p')/maps"
  grep -q libergotic_priority_inheritance "$maps" || die "$name: the locks of the station do not inherit priority"
  grep -q libmimalloc "$maps" || die "$name: the station does not use mimalloc"
  sleep 2
  stop_group "$recorder" 20
  stop_group "$station" 25
  stop_all
  [[ $(rosbag info "$logs/$name.bag") == *ergotic/GestureBlock* ]] ||
    die "$name: the bag holds no gesture"
  compgen -G "$logs/$name*take_*.bag" >/dev/null || die "$name: record:= wrote no bag of its name"
  rosrun ergotic render --gesture "$logs/$name.bag" --out "$logs/$name-replay.wav" ||
    die "$name: the bag cannot be played again"
  say "$name: works"
}

(try_space devel "$devel/setup.bash")

prefix=$(sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' "$build/CMakeCache.txt")
DESTDIR="$logs/installed" cmake --install "$build" >/dev/null
installed="$logs/installed$prefix"
if grep -rqsF "$root" "$installed/share/ergotic/launch" "$installed/share/ergotic/rviz"; then
  die "the install space refers to the source tree"
fi
(try_space install "$installed/setup.bash")
