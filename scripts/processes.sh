# SPDX-License-Identifier: BSD-3-Clause
# Starting JACK, ROS and the like, and leaving none of it behind. To be sourced, after lib.sh.
#
# Everything started here, and what that starts in turn, carries ERGOTIC_SESSION in its
# environment: also what has left its parent can be found and ended.

export ERGOTIC_SESSION="$$-$(date +%s%N)"
logs=$(mktemp --directory --tmpdir ergotic.XXXXXX)
started=()  # process groups, in the order of their starts

# Starts a command in a process group of its own; $spawned is its id. Its output goes to
# $logs/NAME.out and $logs/NAME.log (errors), shown if something goes wrong.
spawn() { # NAME COMMAND...
  setsid env --default-signal=INT,QUIT "${@:2}" \
    </dev/null >"$logs/$1.out" 2>"$logs/$1.log" &
  spawned=$!
  started+=("$spawned")
}

# The same with the output of this script.
spawn_visibly() { # COMMAND...
  setsid env --default-signal=INT,QUIT "$@" </dev/null &
  spawned=$!
  started+=("$spawned")
}

is_running() { kill -0 "$1" 2>/dev/null; }
has_ended() { ! is_running "$1"; }

# Asks a process group to end, more and more firmly; returns when its first process has.
stop_group() { # GROUP [SECONDS TO END BY ITSELF]
  local signal
  for signal in INT TERM KILL; do
    kill -s "$signal" -- "-$1" 2>/dev/null || return 0
    ! wait_until "${2:-10}" has_ended "$1" || return 0
  done
}

# Whatever is left of this session, this script excepted.
session_members() {
  local file pid
  for file in /proc/[0-9]*/environ; do
    pid=${file//[^0-9]/}
    if [ "$pid" != "$$" ] && [ "$pid" != "$BASHPID" ] &&
      grep -qsz "^ERGOTIC_SESSION=$ERGOTIC_SESSION\$" "$file"; then
      printf '%s\n' "$pid"
    fi
  done
}

stop_all() {
  local i pids
  for ((i = ${#started[@]} - 1; i >= 0; --i)); do
    stop_group "${started[i]}" 25  # roslaunch gives its nodes 15 s
  done
  started=()
  for signal in TERM KILL; do
    mapfile -t pids < <(session_members)
    [ ${#pids[@]} -eq 0 ] || kill -s "$signal" "${pids[@]}" 2>/dev/null || true
    [ ${#pids[@]} -eq 0 ] || sleep 1
  done
}

show_logs() {
  local log
  for log in "$logs"/*.out "$logs"/*.log "$logs"/ros/latest/*-stdout.log; do
    [ ! -s "$log" ] || { say "--- the end of ${log#"$logs"/}:" && tail -n 25 "$log"; } >&2
  done
}

# Call it first of all: at the end, however it comes, everything is stopped; if it comes by a
# failure, the logs are shown.
clean_up_at_exit() {
  trap 'on_exit $?' EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP
}
on_exit() { # STATUS
  trap '' INT TERM HUP
  [ "$1" -eq 0 ] || [ "$1" -ge 128 ] || show_logs
  stop_all
  rm -rf "$logs"
  exit "$1"
}

warned_of_realtime=''
may_be_realtime() { chrt --fifo 70 true 2>/dev/null; }

# The first sound card that can play, as ALSA numbers them; nothing if there is none.
playback_card() {
  local pcm
  for pcm in /proc/asound/card[0-9]*/pcm*p; do
    [ -e "$pcm" ] || continue
    pcm=${pcm#/proc/asound/card}
    say "${pcm%%/*}"
    return
  done
}

jack_runs() { [[ $(timeout 10 jack_wait --check 2>/dev/null) == running* ]]; }

# Starts the server named by JACK_DEFAULT_SERVER. \return 1 if it does not run within ten seconds
# The dummy driver runs in synchronous mode: else the server tells a client that comes late the time
# of the next period, and the sound of that period goes where nobody can find it.
start_jack() { # BACKEND OPTIONS...
  local options=(--realtime --realtime-priority 70)
  if ! may_be_realtime; then
    [ -n "$warned_of_realtime" ] ||
      warn "real-time scheduling is not permitted (README, \"Real time\"): sound may crackle"
    warned_of_realtime=yes
    options=(--no-realtime)
  fi
  [ "$1" != dummy ] || options+=(--sync)
  spawn jackd jackd "${options[@]}" --name "${JACK_DEFAULT_SERVER:-default}" -d "$@"
  local jackd=$spawned
  jack_or_death() { jack_runs || has_ended "$jackd"; }
  wait_until 10 jack_or_death && jack_runs
}
start_dummy_jack() { # [PERIOD [RATE]]
  start_jack dummy --rate "${2:-44100}" --period "${1:-256}" --capture 12 --playback 24
}

# A ROS master of our own, for this machine only, that leaves nothing in the home folder.
# \return 1 if it does not run within half a minute
start_private_master() {
  local port
  port=$(/usr/bin/python3 -c \
    'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI="http://localhost:$port" ROS_IP=127.0.0.1
  export ROS_HOME="$logs/ros_home" ROS_LOG_DIR="$logs/ros"
  unset ROS_HOSTNAME ROS_NAMESPACE
  spawn master roscore -p "$port"
  master_runs() { timeout 10 rosnode list; }
  wait_until 30 master_runs
}

# A display in memory, drawn by the processor. \return 1 if there is none within 15 seconds
start_display() {
  spawn xvfb Xvfb -displayfd 1 -screen 0 1280x800x24 -nolisten tcp
  has_display() { [ -s "$logs/xvfb.out" ]; }
  wait_until 15 has_display || return 1
  DISPLAY=":$(<"$logs/xvfb.out")"
  export DISPLAY LIBGL_ALWAYS_SOFTWARE=1 QT_QPA_PLATFORM=xcb XDG_RUNTIME_DIR="$logs"
}
